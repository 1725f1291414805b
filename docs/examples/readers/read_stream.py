"""Reads sample streams as docs/stream_format.md defines them; (Words) are sections of that page.
Of step 7 of (Reading) and of (Kind 4) it checks schedule CRC and weights. read_stream.py FILE
prints samples."""
import functools, re, struct, sys
from itertools import accumulate, product
VALUES = """black_level_dn gain_e_per_dn read_noise_e full_well_e electrons_per_unit rounding random
    n crc""".split()  # of a switch
NAMES = """rows cols planes cfa bit_depth rounding slot_us black_level_dn gain_e_per_dn read_noise_e
    full_well_e electrons_per_unit n p s random calibrated weighted noise_free crc""".split()
CRC_TABLE = range(256)
for _ in range(8): CRC_TABLE = [crc >> 1 ^ 0x82F63B78 * (crc & 1) for crc in CRC_TABLE]

def crc32c(data, other=0):  # continued from the CRC `other`
    def step(crc, byte): return crc >> 8 ^ CRC_TABLE[(crc ^ byte) & 0xFF]
    return functools.reduce(step, data, other ^ 0xFFFFFFFF) ^ 0xFFFFFFFF

def read_header(data):  # (Reading), steps 1 to 6, then the fields of (Header)
    version, size = struct.unpack_from("<H2xI", data.ljust(16, b"\0"), 8)
    crc = int.from_bytes(data[size - 4:size], "little")
    for good, offset, fault in (
            (data[:8] == b"\x89STPL\r\n\x1a"[:len(data)], 0, "not a sample stream"),
            (len(data) >= 16, len(data), "header cut"), (1 <= version <= 4, 8, "unknown version"),
            (97 <= size <= 605028524, 12, "header bytes"), (len(data) >= size, len(data), "cut"),
            (crc32c(data[:size - 4]) == crc, size - 4, "the header is damaged")):
        if not good: raise ValueError(f"byte {offset}: {fault}")
    head = dict(zip(NAMES, struct.unpack_from("<2H4B6d3I4BI", data, 16)))
    text, section, end = accumulate((92 + head["n"], head["p"], head["s"]))
    head.update(schedule_name=data[92:text].decode(), provenance=data[text:section].decode())
    head["schedule"] = read_schedule(data[section:end], head)
    *_, period, tile = head["schedule"].values()
    if version == 4 and head["weighted"]: raise ValueError("byte 86: weights in version 4")
    if version == 4 and interleaved(head): raise ValueError("byte 8: interleaved exposures")
    weights_at = size - 4 - 4 * head["weighted"] * period * len(tile)  # (Weights section)
    head["weights"] = [w for w, in struct.iter_unpack("<f", data[weights_at:size - 4])]
    for w, (slot, exposures) in zip(head["weights"], product(range(period), tile)):
        is_open = any(m >> (slot - f) % period & 1 for f, m in exposures)
        if not is_open * 2**-20 <= w <= is_open * 2**20: raise ValueError(f"byte {weights_at}: {w}")
    if head["calibrated"]:  # (Calibration section)
        head["dark_e_per_slot"], *tile = struct.unpack_from("<d2H", data, end)
        head["calibration_tile"] = tile + list(struct.iter_unpack("<2d", data[end + 12:weights_at]))
    return head, version, size, crc

def read_schedule(section, head):  # (Schedule section)
    def varint(n): return bytes([n]) if n < 128 else bytes([n % 128 + 128]) + varint(n >> 7)
    if head["random"]:
        rows, cols, period = head["rows"], head["cols"], sum(section[9:])
        tile = [random_exposures(section, pixel) for pixel in range(rows * cols)]
    else:
        rows, cols, period = struct.unpack_from("<3H", section)
        varints = re.findall(rb"[\x80-\xff]*[\0-\x7f]", section[6:])
        ints = iter([sum(byte % 128 << 7 * i for i, byte in enumerate(v)) for v in varints])
        tile = [[(next(ints), next(ints)) for _ in range(next(ints))] for _ in range(rows * cols)]
    explicit = (n for exposures in tile for n in (len(exposures), *sum(exposures, ())))
    form = struct.pack("<3H", rows, cols, period) + b"".join(map(varint, explicit))
    if crc32c(form) != head["crc"]: raise ValueError("byte 88: wrong schedule CRC")
    return {"tile_rows": rows, "tile_cols": cols, "period_slots": period, "exposures": tile}

def interleaved(head):  # if an exposure begins before the last one of its pixel has ended
    *_, period, tile = head["schedule"].values()
    following = [[f for f, _ in e[1:]] + [f + period for f, _ in e[:1]] for e in tile]
    return any(f + m.bit_length() > begin for exposures, begins in zip(tile, following)
               for (f, m), begin in zip(exposures, begins))

def random_exposures(section, pixel):  # (Schedule section), kind 1
    def draw(i, n):
        c0, c1, c2, c3, (k0, k1) = pixel, i, 1, 1, struct.unpack_from("<2I", section)
        for _ in range(10):  # Philox4x32-10
            a, b = 0xD2511F53 * c0, 0xCD9E8D57 * c2
            c0, c1, c2, c3 = b >> 32 ^ c1 ^ k0, b % 2**32, a >> 32 ^ c3 ^ k1, a % 2**32
            k0, k1 = (k0 + 0x9E3779B9) % 2**32, (k1 + 0xBB67AE85) % 2**32
        return c0 * n >> 32
    order = list(section[9:])
    for i in reversed(range(1, len(order))):
        j = draw(i, i + 1)
        order[i], order[j] = order[j], order[i]
    slots = accumulate(order, initial=draw(0, sum(order)))
    return sorted((slot % sum(order), 2**length - 1) for slot, length in zip(slots, order))

class Stream:  # what a tolerant reader finds, by the keys of (Test files)
    def __init__(self, data):
        self.data, self.packets, self.damage, self.index_at = data, [], [], None
        self.slots = self.missing_slots = self.tail_bytes = self.counted = 0
        self.head, version, at, crc = read_header(data)
        self.switching, self.packet = version == 4, None  # the last switch packet
        self.parts = [self.head | {"slot": 0, "number": 0, "follows": True}]  # of the schedule
        self.crcs = self.seed = crc if version > 1 else 0  # packet checksum, first CRC
        self.next = (0, 0)  # slot and row that shall come; slots below `counted` are counted
        self.layouts = {b"\xc5SPK": struct.Struct("<4xBBHQHHIIII"),  # (Packet), (End marker)
                        b"\xc5END": struct.Struct("<4xQII" if version > 1 else "<4xQI")}
        while at < len(data): at = self.read(at)

    def skip(self, at, end, cause):
        self.damage.append({"offset": at, "bytes": end - at, "cause": cause})
        return end

    def start(self, at):  # 9 fields of a packet header, 1 or 2 of an end marker, () if cut, or None
        for sync, layout in self.layouts.items():
            if sync.startswith(self.data[at:at + 4]):
                if at + layout.size > len(self.data): return ()
                *fields, crc = layout.unpack_from(self.data, at)
                good = crc == crc32c(self.data[at:at + layout.size - 4], self.seed)
                return fields if good and (len(fields) < 9 or fields[7] <= 2**29) else None

    def read(self, at):  # (Reading): the steps at one position; returns the next position
        data, fields = self.data, self.start(at)
        if fields and len(fields) < 9: return self.end_marker(at, *fields)
        end = at + 36 + fields[7] if fields else at  # fields 7, 8: bytes and CRC of the payload
        cut = fields == () or end > len(data)
        if fields and not cut and crc32c(data[at + 36:end]) == fields[8]:
            good = self.take(at, data[at + 36:end], *fields)
            return end if good else self.skip(at, end, "this packet breaks a rule")
        found = next((i for i in range(at + 1, len(data)) if self.start(i)), len(data))
        if not cut or found < len(data): return self.skip(at, found, "no whole packet begins here")
        self.tail_bytes = found - at
        return found

    def part(self, slot):  # the schedule of a slot
        return next(part for part in reversed(self.parts) if part["slot"] <= slot)

    def doing(self, slot, row, col):  # if a pixel is open in a slot, and if it is read at its end
        part = self.part(slot)
        tile_rows, tile_cols, period, tile = part["schedule"].values()
        exposures = tile[row % tile_rows * tile_cols + col % tile_cols]
        ages = [((slot - first) % period, open_slots) for first, open_slots in exposures]
        rests = [open_slots >> age for age, open_slots in ages if part["slot"] or age <= slot]
        return any(rest & 1 for rest in rests), 1 in rests

    def exposure(self, slot, row, col):  # (Kind 4): open slots since the last readout
        open_slots = [slot]
        for before in range(slot - 1, max(slot - 64, -1), -1):
            after = self.part(before + 1)
            if after["slot"] == before + 1 and not after["follows"]: return None, None
            is_open, is_read = self.doing(before, row, col)
            if is_read: break
            open_slots += [before] * is_open
        return open_slots[-1], sum(1 << t - open_slots[-1] for t in open_slots)

    def due(self, slot, band):  # (Kind 1): row, column, plane, first slot and open slots of samples
        if self.switching:
            for row, col in product(band, range(self.head["cols"])):
                if self.doing(slot, row, col)[1]:
                    exposure = self.exposure(slot, row, col)
                    for plane in range(self.head["planes"]): yield (row, col, plane, *exposure)
            return
        tile_rows, tile_cols, period, tile = self.head["schedule"].values()
        for row, col, plane in product(band, range(self.head["cols"]), range(self.head["planes"])):
            for first, open_slots in tile[row % tile_rows * tile_cols + col % tile_cols]:
                before = open_slots.bit_length() - 1
                if slot >= before and slot % period == (first + before) % period:
                    yield row, col, plane, slot - before, open_slots

    def switch(self, at, payload, number, slot):  # (Kind 4)
        last, packet = self.parts[-1], self.data[at:at + 36 + len(payload)]
        if packet != self.packet:
            pixels = self.head["rows"] * self.head["cols"]
            if (number <= last["number"] or slot <= last["slot"] or (slot, 0) < self.next
                    or slot >= 2**53 or pixels * number > 2**32): return False
            try:
                part = self.head | dict(zip(VALUES, struct.unpack_from("<5d2BHI", payload)))
                section, part["schedule_name"] = 48 + part["n"], payload[48:48 + part["n"]].decode()
                part["schedule"] = read_schedule(payload[section:], part)
            except (ValueError, struct.error, StopIteration, RuntimeError): return False
            if interleaved(part): return False
            follows = number == last["number"] + 1
            self.parts.append(part | {"slot": slot, "number": number, "follows": follows})
            self.packet = packet
        self.crcs = crc32c(self.data[at + 32:at + 36], self.crcs)
        return True

    def take(self, at, payload, kind, flags, switches, slot, first_row, rows, samples, *_):
        begin, end_row, depth = (slot, first_row), first_row + rows, self.head["bit_depth"]
        if kind == 4 and self.switching and not self.index_at:
            return not flags | end_row | samples and self.switch(at, payload, switches, slot)
        last = self.parts[-1]
        good = switches >= last["number"] if kind == 3 else (
            switches == last["number"] and slot >= last["slot"])
        if self.index_at or not good or not self.switching and switches: return False
        if slot >= 2**53 or begin < self.next: return False
        if kind == 1:  # (Rules of a packet), 2
            due = 0 if flags & 2 else len(list(self.due(slot, range(first_row, end_row))))
            bits = int.from_bytes(payload, "little")
            if (flags > 3 or not first_row < end_row <= self.head["rows"] or samples != due
                    or len(payload) != -(-due * depth // 8) or bits >> due * depth): return False
            dn = [bits >> i * depth & 2**depth - 1 for i in range(samples)]
            self.packets.append(dict(slot=slot, first_row=first_row, rows=rows, flags=flags, dn=dn))
        elif kind == 3 and flags == end_row == 0 and len(payload) == 16 * (samples + switches):  # 3
            entries = list(struct.iter_unpack("<2Q", payload))  # (Kind 3): slot, offset
            entries, changes = entries[:samples], entries[samples:]
            whole = not self.damage and self.next == begin
            following = [*entries[1:], (slot, at if whole else 2**64)]
            good = all(a < c and b < d for (a, b), (c, d) in zip(entries, following))
            leads = (([1, entry, 0], self.start(offset) or []) for entry, offset in entries)
            good &= not whole or all(got[:1] + got[3:5] == wanted for wanted, got in leads)
            following = [*changes[1:], (slot + 1, at if whole else 2**64)]
            good &= all(a < c and b < d for (a, b), (c, d) in zip(changes, following))
            places = [[part["slot"], part["number"]] for part in self.parts[1:]]
            leads = [(self.start(offset) or []) for _, offset in changes]
            found = [[got[3], got[2]] for got in leads if got and got[0] == 4]
            good &= not whole or found == places == [[s, i + 1] for i, (s, _) in enumerate(changes)]
            if not good: return False
            self.index_at = at
        else: return False
        if begin > self.next:
            first, self.counted = max(self.next[0], self.counted), slot + (first_row > 0)
            self.missing_slots += self.counted - first
            self.skip(at, at, "rows before this packet are missing")
        self.next = (slot + 1, 0) if end_row == self.head["rows"] else (slot, end_row)
        self.slots, self.crcs = slot + (kind == 1), crc32c(self.data[at + 32:at + 36], self.crcs)
        return True

    def end_marker(self, at, index_at, *checksum):  # (Damage)
        end = at + self.layouts[b"\xc5END"].size
        if not self.damage and index_at != self.index_at: self.skip(at, end, "no index there")
        elif not self.damage and checksum not in ((), (self.crcs,)): self.skip(at, at, "exchanged")
        return end if end == len(self.data) else self.skip(end, len(self.data), "bytes after it")

if __name__ == "__main__":
    stream = Stream(open(sys.argv[1], "rb").read())
    for slot, first_row, rows, _, dn in map(dict.values, stream.packets):
        for place, value in zip(stream.due(slot, range(first_row, first_row + rows)), dn):
            print(slot, *place, value)  # slot, row, column, plane, first slot, open slots, DN
