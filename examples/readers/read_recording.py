#!/usr/bin/python3
"""A reader of recordings of cameras, written from docs/recording_format.md alone, with Python's standard library and
libxxhash.

usage: read_recording.py FILE      prints the recording as JSON, in the layout of the page's section "Test files" """

import json
import struct
import sys
from pathlib import Path

from crc32c import crc32c
from recording_frame import read_frame

SYNC, SESSION, FRAME, END = b"\xc5FRM", 1, 2, 3
KEYS = {SESSION: ("camera", "settings", "host", "started_realtime_ns"),
        END: ("reason", "frames", "incomplete", "payload_bytes", "lost", "transport", "clocks")}


class Recording:
    """What the bytes of a file hold."""

    def __init__(self, data):
        self.data, self.next = data, 0
        self.session = self.end = None
        self.frames, self.damage = [], []
        self.missing_blocks = self.tail_bytes = 0

    def note(self, offset, skipped, cause):
        self.damage.append({"offset": offset, "bytes": skipped, "cause": cause})

    def header(self, at):
        """(kind, number, r, p, CRC of the record) of a good header, or None."""
        block = self.data[at:at + 32]
        if len(block) < 32 or block[:4] != SYNC or crc32c(block[:28]) != struct.unpack_from("<I", block, 28)[0]:
            return None
        fields = struct.unpack_from("<IIIQI", block, 4)
        return fields if fields[2] <= 2**26 and fields[3] <= 2**32 else None

    def find(self, at):
        while (at := self.data.find(SYNC, at)) >= 0:
            if self.header(at):
                return at
            at += 1
        return len(self.data)

    def read(self):
        at, begun = 16, False
        while True:
            header = self.header(at)
            end = at + 32 + (header[2] + header[3] if header else 0)
            cut, after_end = end > len(self.data), self.end and not header and at < len(self.data)
            last = cut and not after_end and self.find(at + 1) == len(self.data)
            if not begun and (last or (header and header[0] != SESSION)):
                begun = True
                self.note(at, 0, "there is no session at the beginning")
            if last:
                self.tail_bytes = len(self.data) - at
                return
            fault = "no whole block" if cut or not header else self.block(at, *header)
            if fault:
                end = self.find(at + 1)
                self.note(at, end - at, fault)
            at, begun = end, begun or not fault

    def block(self, at, kind, number, record_bytes, payload_bytes, crc):
        """Takes a block. Returns its fault, or None."""
        record = self.data[at + 32:at + 32 + record_bytes]
        payload = self.data[at + 32 + record_bytes:at + 32 + record_bytes + payload_bytes]
        fault = None if crc32c(record) == crc else "the CRC of the record is wrong"
        if kind == FRAME and not fault:
            content, fault = read_frame(record, payload)
        elif kind in KEYS and not fault:
            content, fault = read_json(record, KEYS[kind])
        if fault:
            return fault
        missing, self.next = (number - self.next) % 2**32, number + 1
        if missing:
            self.note(at, 0, "blocks are missing, or come twice")
            self.missing_blocks += missing if missing < 2**31 else 0
        if kind == FRAME:
            self.frames.append(content)
        elif kind == SESSION:
            self.session = content
        elif kind == END:
            self.end = content
        else:
            self.note(at, 32 + record_bytes + payload_bytes, "a block of an unknown kind")
        return None


def read_json(record, keys):
    """(object, None) or (None, fault)"""
    try:
        content = json.loads(record)
    except ValueError:
        return None, "no JSON"
    return (content, None) if isinstance(content, dict) and content.keys() >= set(keys) else (None, "keys are missing")


def read_recording(data):
    """The recording in the layout of the page's section "Test files"."""
    if len(data) < 16 or data[:8] != b"\x89STR\r\n\x1a\n" or struct.unpack_from("<I", data, 8)[0] != 1:
        return {"error": "byte 0: not a recording of version 1"}
    recording = Recording(data)
    recording.read()
    keys = ("session", "end", "frames", "missing_blocks", "tail_bytes", "damage")
    return {"error": None, **{key: getattr(recording, key) for key in keys}}


if __name__ == "__main__":
    print(json.dumps(read_recording(Path(sys.argv[1]).read_bytes())))
