#!/usr/bin/python3
"""A reader of sample streams, written from docs/stream_format.md alone, with Python's standard library.

usage: read_stream.py FILE      prints the stream as JSON (the page's section "Test files"); about a second per MB"""

import json
import struct
import sys
from pathlib import Path

from crc32c import crc32c
from stream_header import FormatError, read_header
from stream_packets import index_fault, sample_fault, unpack

PACKET, END = b"\xc5SPK", b"\xc5END"


class Stream:
    """What a tolerant reader finds in the bytes of a file."""

    def __init__(self, data):
        self.data = data
        self.head, self.begin, crc, version = read_header(data)
        self.seed, self.end_bytes = (crc, 20) if version == 2 else (0, 16)
        self.checksum, self.vain_bytes, self.index_at = self.seed, 0, None
        self.next, self.counted = (0, 0), 0  # slot and row that are due; slots below are counted if they miss rows
        self.packets, self.damage = [], []
        self.slots = self.missing_slots = self.tail_bytes = 0

    def note(self, offset, skipped, cause):
        self.damage.append({"offset": offset, "bytes": skipped, "cause": cause})

    def start(self, at):
        """What begins here: "packet", "end", "cut" (one of them, but the file ends within it) or ""."""
        for sync, size, what in ((PACKET, 36, "packet"), (END, self.end_bytes, "end")):
            if not sync.startswith(self.data[at:at + 4]):
                continue
            if len(self.data) - at < size:
                return "cut"
            crc, = struct.unpack_from("<I", self.data, at + size - 4)
            too_long = what == "packet" and self.payload_bytes(at) > 2**29
            return what if crc32c(self.data[at:at + size - 4], self.seed) == crc and not too_long else ""
        return ""

    def payload_bytes(self, at):
        return struct.unpack_from("<I", self.data, at + 24)[0]

    def find(self, at):
        """The next whole start from here on; the length of the file if there is none."""
        while (at := self.data.find(b"\xc5", at)) >= 0:
            if self.start(at) in ("packet", "end"):
                return at
            at += 1
        return len(self.data)

    def search(self, at, cause):
        found = self.find(at + 1)
        self.note(at, found - at, cause)
        return found

    def read(self):
        at = self.begin
        while at < len(self.data):
            if (what := self.start(at)) == "end":
                return self.end_marker(at)
            if what == "":
                at = self.search(at, "no packet begins here")
            elif what == "cut" or at + 36 + self.payload_bytes(at) > len(self.data):
                if self.find(at + 1) == len(self.data):
                    self.tail_bytes = len(self.data) - at
                    return
                at = self.search(at, "bytes of a packet are missing")
            else:
                at = self.packet(at)

    def packet(self, at):
        kind, flags, reserved, slot, row, rows, samples, size, crc = struct.unpack_from("<4xBBHQHHIII", self.data, at)
        end = at + 36 + size
        payload = self.data[at + 36:end]
        if crc32c(payload) != crc:
            self.vain_bytes += size
            if self.vain_bytes > 2**32 + 16 * at:
                raise FormatError(f"byte {at}: too many damaged packets overlap")
            return self.search(at, "the payload is damaged")
        self.checksum = crc32c(self.data[at + 32:at + 36], self.checksum)
        if self.index_at is not None:
            fault = "a packet after the index"
        elif kind == 1:
            early = (slot, row) < self.next
            fault = sample_fault(self.head, (flags, reserved, slot, row, rows, samples), early, payload)
        elif kind == 3:
            fault = self.index_fault(at, (flags, reserved, row, rows), slot, samples, payload)
        else:
            fault = f"kind {kind}"
        if fault:
            self.note(at, end - at, fault)
        elif kind == 3:
            self.index_at, self.slots = at, slot
            self.skip_to(at, slot, 0)
        else:
            self.skip_to(at, slot, row)
            self.next = (slot, row + rows) if row + rows < self.head["rows"] else (slot + 1, 0)
            self.slots = slot + 1
            self.packets.append({"slot": slot, "first_row": row, "rows": rows, "flags": flags,
                                 "dn": unpack(payload, samples, self.head["bit_depth"])})
        return end

    def index_fault(self, at, fields, slots, count, payload):
        intact = not self.damage and (slots, 0) == self.next
        fault = index_fault(fields, slots, count, payload, early=(slots, 0) < self.next, limit=at if intact else 2**64)
        for slot, offset in struct.iter_unpack("<QQ", payload) if intact and not fault else ():
            if self.start(offset) != "packet" or struct.unpack_from("<B3xQH", self.data, offset + 4) != (1, slot, 0):
                fault = "the index does not lead to a slot"
        return fault

    def skip_to(self, at, slot, row):
        if (slot, row) == self.next:
            return
        self.note(at, 0, "slots or rows are missing")
        end = slot + (row > 0)
        self.missing_slots += max(end - max(self.next[0], self.counted), 0)
        self.counted, self.next = max(self.counted, end), (slot, row)

    def end_marker(self, at):
        end = at + self.end_bytes
        index_at, checksum = struct.unpack_from("<QI", self.data, at + 4)  # in version 1 there is no checksum
        if not self.damage and index_at != self.index_at:
            self.note(at, self.end_bytes, "the end marker does not lead to the index")
        elif not self.damage and self.end_bytes == 20 and checksum != self.checksum:
            self.note(at, 0, "other packets than those that were recorded")
        if end < len(self.data):
            self.note(end, len(self.data) - end, "bytes after the end marker")


def read_stream(data):
    """The stream in the layout of the page's section "Test files"."""
    try:
        stream = Stream(data)
        stream.read()
    except FormatError as error:
        return {"strict_error": str(error), "error": str(error)}
    tail = [{"offset": len(data) - stream.tail_bytes, "cause": "the file is cut"}] if stream.tail_bytes else []
    first = [f"byte {place['offset']}: {place['cause']}" for place in stream.damage + tail][:1]
    keys = ("packets", "slots", "missing_slots", "tail_bytes", "damage")
    return {"strict_error": first[0] if first else None, "error": None, "header": stream.head,
            **{key: getattr(stream, key) for key in keys}}


if __name__ == "__main__":
    print(json.dumps(read_stream(Path(sys.argv[1]).read_bytes())))
