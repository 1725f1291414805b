"""A frame of a recording, read as docs/recording_format.md says, with Python's standard library and libxxhash."""

import ctypes
import ctypes.util
import re
import struct
import sys

FIELDS = ("id wire_id lost_before device_ns host_monotonic_ns host_realtime_ns exposure_us gain black_level_dn "
          "bytes_received payload_hash stride_bytes epoch offset_x offset_y width height holes cause status "
          "stamp_source packing filter planes bits_per_pixel significant_bits format").split()
LAYOUT = "<QQQqqqdddQQQIIIIIIBBBBBBBB32s"
FILTERS = {"Mono": 0, "BayerRG": 1, "BayerGR": 2, "BayerGB": 3, "BayerBG": 4}


XXHASH = ctypes.util.find_library("xxhash")
if not XXHASH:
    sys.exit("libxxhash is missing; on Debian: apt-get install libxxhash0")
xxh3 = ctypes.CDLL(XXHASH).XXH3_64bits
xxh3.restype, xxh3.argtypes = ctypes.c_uint64, (ctypes.c_char_p, ctypes.c_size_t)


def pixel_format(name):
    """(packing, filter, planes, bits_per_pixel, significant_bits) of a format, or None."""
    if name == "RGB8":
        return 0, 0, 3, 24, 8
    match = re.fullmatch(r"(Mono|Bayer(?:RG|GR|GB|BG))(8|10|12|14|16)(BE|p|Packed|MIPI|)", name)
    if not match:
        return None
    colours, bits, suffix = match[1], int(match[2]), match[3]
    known = {"": True, "BE": name == "Mono16BE", "p": bits in (10, 12, 14), "Packed": bits in (10, 12),
             "MIPI": bits == 10 or (bits in (12, 14) and colours != "Mono")}
    in_memory = {"": 8 if bits == 8 else 16, "BE": 16, "Packed": 12}.get(suffix, bits)
    packing = ("", "BE", "p", "Packed", "MIPI").index(suffix)
    return (packing, FILTERS[colours], 1, in_memory, bits) if known[suffix] else None


def bit_string(data, count, bits):
    number = int.from_bytes(data, "little")
    return [number >> i * bits & (1 << bits) - 1 for i in range(count)]


def row_bytes(frame):
    count, bits = frame["width"] * frame["planes"], frame["significant_bits"]
    group = 2 if bits == 12 else 4
    return (count if bits == 8 else 2 * count, 2 * count, (count * bits + 7) // 8, (12 * count + 7) // 8,
            -(-count // group) * group * bits // 8)[frame["packing"]]


def samples_of(row, frame):
    packing, bits, count = frame["packing"], frame["significant_bits"], frame["width"] * frame["planes"]
    if packing in (0, 1):
        return list(row[:count]) if bits == 8 else list(struct.unpack(f"{'<>'[packing]}{count}H", row))
    if packing == 2:
        return bit_string(row, count, bits)
    if packing == 3:
        low = [row[i // 2 * 3 + 1] >> (i % 2 * 4) & (1 << bits - 8) - 1 for i in range(count)]
        return [row[i // 2 * 3 + i % 2 * 2] << bits - 8 | low[i] for i in range(count)]
    group = 2 if bits == 12 else 4
    samples = []
    for at in range(0, len(row), group * bits // 8):
        low = bit_string(row[at + group:at + group * bits // 8], group, bits - 8)
        samples += [row[at + i] << bits - 8 | low[i] for i in range(group)]
    return samples[:count]


def read_frame(record, payload):
    """(frame, None) or (None, fault)"""
    if len(record) < 160:
        return None, "a short frame record"
    frame = dict(zip(FIELDS, struct.unpack_from(LAYOUT, record)))
    name = frame["format"].rstrip(b"\0").decode("ascii", "replace")
    described = tuple(frame[key] for key in ("packing", "filter", "planes", "bits_per_pixel", "significant_bits"))
    holes = list(struct.iter_unpack("<QQ", record[160:])) if len(record) % 16 == 0 else []
    ends = [0] + [end for _, end in holes]
    height, stride = frame["height"], frame["stride_bytes"]
    if described != pixel_format(name) or not (1 <= frame["width"] <= 65535 and 1 <= height <= 65535):
        return None, "another format, or size"
    if frame["cause"] > 5 or frame["status"] > 3 or frame["stamp_source"] > 4 or not (
            row_bytes(frame) <= stride <= 2**32 // height and frame["width"] * height * frame["planes"] <= 2**28):
        return None, "a field is outside its limits"
    if len(record) != 160 + 16 * frame["holes"] or frame["holes"] > 65536 or any(
            begin < before or end <= begin or end > len(payload) for (begin, end), before in zip(holes, ends)):
        return None, "impossible holes"
    if frame["status"] == 0 and len(payload) < (height - 1) * stride + row_bytes(frame):
        return None, "a complete frame lacks bytes"
    if xxh3(payload, len(payload)) != frame.pop("payload_hash"):
        return None, "the hash is wrong"
    padded = payload.ljust(height * stride, b"\0")
    rows = [padded[y * stride:y * stride + row_bytes(frame)] for y in range(height)]
    frame = {key: None if value != value else value for key, value in frame.items()}
    return frame | {"format": name, "holes": [list(hole) for hole in holes],
                    "samples": [samples_of(row, frame) for row in rows]}, None
