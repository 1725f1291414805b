"""The header of a sample stream, read as docs/stream_format.md says, with Python's standard library."""

import struct
from itertools import accumulate

from crc32c import crc32c

FIELDS = (  # of the header: name, offset, type, least, most
    ("reserved", 10, "H", 0, 0), ("reserved", 86, "H", 0, 0), ("rows", 16, "H", 1, 65535), ("cols", 18, "H", 1, 65535),
    ("planes", 20, "B", 1, 4), ("cfa", 21, "B", 0, 4), ("bit_depth", 22, "B", 1, 16), ("rounding", 23, "B", 0, 1),
    ("slot_us", 24, "d", 1e-12, 1e12), ("black_level_dn", 32, "d", 0, 65535), ("gain_e_per_dn", 40, "d", 1e-12, 1e12),
    ("read_noise_e", 48, "d", 0, 1e12), ("full_well_e", 56, "d", 1e-12, 1e12),
    ("electrons_per_unit", 64, "d", 1e-12, 1e12), ("kind", 84, "B", 0, 1), ("calibrated", 85, "B", 0, 1),
    ("n", 72, "I", 0, 64), ("p", 76, "I", 0, 2**20), ("s", 80, "I", 1, 2**28))


class FormatError(Exception):
    """The fault and its offset."""


def require(condition, offset, fault):
    if not condition:
        raise FormatError(f"byte {offset}: {fault}")


class Section:
    """A part of the header, taken number by number."""

    def __init__(self, data, at, end):
        self.data, self.at, self.end = data, at, end

    def take(self, kind):
        require(self.at + struct.calcsize(kind) <= self.end, self.at, "a section ends too early")
        self.at += struct.calcsize(kind)
        return struct.unpack_from("<" + kind, self.data, self.at - struct.calcsize(kind))[0]

    def varint(self):
        number = shift = 0
        while (byte := self.take("B")) >= 128:
            number |= (byte & 127) << shift
            shift += 7
        number |= byte << shift
        require((byte > 0 or shift == 0) and number < 2**64, self.at, "not the shortest form of 64 bits")
        return number


def explicit_schedule(part):
    """(tile rows, tile columns, period, exposures of each pixel)"""
    rows, cols, period = (part.take("H") for _ in range(3))
    require(min(rows, cols, period) > 0 and rows * cols <= 2**24, part.at, "tile or period out of limits")
    tile = []
    for _ in range(rows * cols):
        count = part.varint()
        require(count <= period, part.at, "more exposures than slots")
        tile.append([[part.varint(), part.varint()] for _ in range(count)])
        check_pixel(tile[-1], period, part)
    require(sum(map(len, tile)) <= 2**24, part.at, "too many exposures")
    return rows, cols, period, tile


def check_pixel(exposures, period, part):
    used = set()
    for i, (first, mask) in enumerate(exposures):
        span, ones = mask.bit_length(), {(first + i) % period for i in range(mask.bit_length()) if mask >> i & 1}
        good = mask & 1 and span <= period and not used & ones and (i == 0 or first > exposures[i - 1][0])
        require(good and first < period, part.at, "impossible exposure")
        used |= ones


def random_schedule(part, rows, cols):
    seed, count = part.take("Q"), part.take("B")
    lengths = [part.take("B") for _ in range(count)]
    require(lengths and rows * cols * count <= 2**25 and all(1 <= n <= 64 for n in lengths), part.at, "lengths")
    period, tile = sum(lengths), []
    for pixel in range(rows * cols):
        order = list(lengths)
        for i in range(count - 1, 0, -1):
            j = draw(seed, pixel, i, i + 1)
            order[i], order[j] = order[j], order[i]
        first = accumulate(order, initial=draw(seed, pixel, 0, period))
        tile.append(sorted([slot % period, 2**length - 1] for slot, length in zip(first, order)))
    return rows, cols, period, tile


def draw(seed, pixel, i, n):
    c, k = (pixel, i, 1, 1), (seed % 2**32, seed >> 32)
    for _ in range(10):  # Philox4x32-10
        a, b = 0xD2511F53 * c[0], 0xCD9E8D57 * c[2]
        c = (b >> 32 ^ c[1] ^ k[0], b % 2**32, a >> 32 ^ c[3] ^ k[1], a % 2**32)
        k = ((k[0] + 0x9E3779B9) % 2**32, (k[1] + 0xBB67AE85) % 2**32)
    return c[0] * n >> 32


def schedule_crc(rows, cols, period, tile):
    def varint(number):
        return bytes([number]) if number < 128 else bytes([number & 127 | 128]) + varint(number >> 7)

    numbers = (number for pixel in tile for number in (len(pixel), *sum(pixel, [])))
    return crc32c(struct.pack("<3H", rows, cols, period) + b"".join(map(varint, numbers)))


def text(data, offset, allowed=""):
    words = data.decode("utf-8", errors="surrogateescape")
    good = all(c in allowed or not (ord(c) < 32 or 127 <= ord(c) < 160 or 0xD800 <= ord(c) < 0xE000) for c in words)
    require(good, offset, "no UTF-8, or control characters")
    return words


def read_header(data):
    """(fields by name, bytes, header CRC, version)"""
    require(data and b"\x89STPL\r\n\x1a".startswith(data[:8]), 0, "not a sample stream")
    require(len(data) >= 16, len(data), "the file ends within its header")
    version, size = struct.unpack_from("<H2xI", data, 8)
    require(version in (1, 2), 8, f"version {version}")
    require(97 <= size <= 336593068, 12, "header bytes")
    require(len(data) >= size, len(data), "the file ends within its header")
    crc, head = *struct.unpack_from("<I", data, size - 4), {}
    require(crc32c(data[:size - 4]) == crc, size - 4, "the header is damaged")
    for name, at, kind, least, most in FIELDS:
        head[name], = struct.unpack_from("<" + kind, data, at)
        require(least <= head[name] <= most, at, f"{name} is outside its limits")
    require(head["rows"] * head["cols"] * head["planes"] <= 2**28, 16, "too many values in a slot")
    require(head["cfa"] == 0 or head["planes"] == 1, 21, "a colour filter array has one plane")
    n, p, s, kind, _ = (head.pop(key) for key in ("n", "p", "s", "kind", "reserved"))
    rest = size - 4 - (92 + n + p + s)
    require(rest >= 0 and (rest > 0) == head["calibrated"], 12, "lengths do not add up")
    head["schedule_name"] = text(data[92:92 + n], 92)
    head["provenance"] = text(data[92 + n:92 + n + p], 92 + n, "\t\n\r")
    part = Section(data, 92 + n + p, 92 + n + p + s)
    made = random_schedule(part, head["rows"], head["cols"]) if kind else explicit_schedule(part)
    require(part.at == part.end, part.at, "bytes are left over")
    rows, cols, period, tile = made
    require(rows * cols * period <= 2**32 and rows * period <= 2**24, part.at, "tile and period are too large")
    require(schedule_crc(*made) == struct.unpack_from("<I", data, 88)[0], 88, "another schedule")
    head["schedule"] = {"tile_rows": rows, "tile_cols": cols, "period_slots": period, "exposures": tile}
    return read_calibration(head, Section(data, part.end, size - 4)), size, crc, version


def read_calibration(head, part):
    head["rounding"] = ("nearest", "floor")[head["rounding"]]
    if cfa := head.pop("cfa"):
        head["cfa"] = ("rggb", "grbg", "gbrg", "bggr")[cfa - 1]
    if head.pop("calibrated"):
        dark, rows, cols = part.take("d"), part.take("H"), part.take("H")
        require(0 <= dark <= 1e12 and rows * cols <= 2**22 and (rows == 0) == (cols == 0), part.at, "calibration")
        require(part.end - part.at == 16 * rows * cols and (dark != 0 or rows), part.at, "calibration")
        pixels = [[part.take("d"), part.take("d")] for _ in range(rows * cols)]
        require(all(1e-6 <= number <= 1e6 for pixel in pixels for number in pixel), part.at, "calibration")
        head["dark_e_per_slot"], head["calibration_tile"] = dark, [rows, cols, *pixels]
    return head
