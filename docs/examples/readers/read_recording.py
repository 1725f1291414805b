"""Reads recordings as docs/recording_format.md defines them; (Words) are sections of that page. The
hash comes from libxxhash. read_recording.py FILE prints frames and damage, a line for each."""
import ctypes, ctypes.util, json, struct, sys

SESSION, FRAME, END = 1, 2, 3
KEYS = {SESSION: {"camera", "settings", "host", "started_realtime_ns"},  # (Session and end)
        END: {"reason", "frames", "incomplete", "payload_bytes", "lost", "transport", "clocks"}}
RECORD = struct.Struct("<3Q3q3d3Q6I8B32s")  # (Frame record)
FIELDS = """id wire_id lost_before device_ns host_monotonic_ns host_realtime_ns exposure_us gain
    black_level_dn bytes_received payload_hash stride_bytes epoch offset_x offset_y width height
    holes cause status stamp_source packing filter planes bits_per_pixel significant_bits
    format""".split()
FORMATS = {("Mono16BE", 1, 0, 1, 16, 16), ("RGB8", 0, 0, 3, 24, 8)}
for colour, name in enumerate(("Mono", "BayerRG", "BayerGR", "BayerGB", "BayerBG")):
    rows = [("8", 0, 8, 8), *((f"{n}", 0, 16, n) for n in (10, 12, 14, 16))]  # (Pixel formats)
    rows += [(f"{n}p", 2, n, n) for n in (10, 12, 14)]
    rows += [(f"{n}Packed", 3, 12, n) for n in (10, 12)]
    rows += [(f"{n}MIPI", 4, n, n) for n in ((10, 12, 14) if colour else (10,))]
    FORMATS |= {(name + suffix, packing, colour, 1, *bits) for suffix, packing, *bits in rows}
CRC_TABLE = range(256)
for _ in range(8): CRC_TABLE = [crc >> 1 ^ 0x82F63B78 * (crc & 1) for crc in CRC_TABLE]
library = ctypes.util.find_library("xxhash")
if not library: sys.exit("libxxhash is missing; on Debian: apt-get install libxxhash0")
xxh3 = ctypes.CDLL(library).XXH3_64bits
xxh3.argtypes, xxh3.restype = (ctypes.c_char_p, ctypes.c_size_t), ctypes.c_uint64

def crc32c(data):
    register = 0xFFFFFFFF
    for byte in data:
        register = register >> 8 ^ CRC_TABLE[(register ^ byte) & 0xFF]
    return register ^ 0xFFFFFFFF

def row_bytes(width, planes, packing, bits):  # (Packing)
    n, group = width * planes, 2 if bits == 12 else 4
    mipi = -(-n // group) * group * bits // 8
    return (n if bits == 8 else 2 * n, 2 * n, -(-n * bits // 8), -(-n * 12 // 8), mipi)[packing]

def bit_string(data, bits):
    string = int.from_bytes(data, "little")
    return [string >> at & 2**bits - 1 for at in range(0, 8 * len(data) - bits + 1, bits)]

def row_samples(row, packing, bits):  # (Packing)
    if bits == 8: return list(row)
    if packing < 2: return list(struct.unpack("<>"[packing] + f"{len(row) // 2}H", row))
    if packing == 2: return bit_string(row, bits)
    samples, low = [], bits - 8
    if packing == 3:
        for at in range(0, len(row), 3):
            first, lows, second = row[at:at + 3].ljust(3, b"\0")
            samples += [first << low | lows % 2**low, second << low | (lows >> 4) % 2**low]
        return samples
    group, size = (2, 3) if bits == 12 else (4, bits // 2)
    for at in range(0, len(row), size):
        lows = bit_string(row[at + group:at + size], low)
        samples += [high << low | rest for high, rest in zip(row[at:at + group], lows)]
    return samples

def image(frame):
    """The rows of a frame, each a list of samples. What an incomplete frame lacks is 0."""
    width, height, planes, packing, bits, stride = (frame[key] for key in (
        "width", "height", "planes", "packing", "significant_bits", "stride_bytes"))
    size = row_bytes(width, planes, packing, bits)
    for at in range(0, height * stride, stride):
        row = frame["payload"][at:at + size].ljust(size, b"\0")
        yield row_samples(row, packing, bits)[:width * planes]

def read_frame(record, payload):
    """The frame by the names of (Frame record); None if it breaks a limit or has another hash."""
    if len(record) < RECORD.size: return None
    frame = dict(zip(FIELDS, RECORD.unpack_from(record)), payload=payload)
    frame["format"] = frame["format"].rstrip(b"\0").decode("latin-1")
    packing, _, planes, _, bits = layout = [frame[key] for key in FIELDS[-6:-1]]
    width, height, stride = frame["width"], frame["height"], frame["stride_bytes"]
    if (frame["format"], *layout) not in FORMATS: return None
    size = row_bytes(width, planes, packing, bits)
    if not (1 <= width <= 65535 and 1 <= height <= 65535 and width * height * planes <= 2**28
            and size <= stride <= 2**32 // height and frame["cause"] <= 5 and frame["status"] <= 3
            and frame["stamp_source"] <= 4 and frame["holes"] <= 65536
            and len(record) == 160 + 16 * frame["holes"]
            and (frame["status"] > 0 or len(payload) >= (height - 1) * stride + size)): return None
    frame["holes"] = list(struct.iter_unpack("<2Q", record[160:]))
    edges = [0, *(edge for hole in frame["holes"] for edge in hole), len(payload)]
    apart = edges == sorted(edges) and all(begin < end for begin, end in frame["holes"])
    return frame if apart and xxh3(payload, len(payload)) == frame["payload_hash"] else None

def read_json(record, keys):  # (Session and end)
    try:
        content = json.loads(record)
    except (ValueError, RecursionError):
        return None
    return content if isinstance(content, dict) and content.keys() >= keys else None

class Recording:  # what the bytes of a file hold, by the keys of (Test files)
    def __init__(self, data):
        if len(data) < 16 or data[:12] != b"\x89STR\r\n\x1a\n\1\0\0\0":  # (Magic)
            raise ValueError("byte 0: not a recording of version 1")
        self.data, self.session, self.end, self.frames, self.damage = data, None, None, [], []
        self.number = self.missing_blocks = self.tail_bytes = 0  # number of the next block
        at, self.begun = 16, False
        while at < len(data): at = self.read(at)
        self.expect_session(len(data) - self.tail_bytes)

    def skip(self, at, end, cause):
        self.damage.append({"offset": at, "bytes": end - at, "cause": cause})
        return end

    def expect_session(self, at):
        if not self.begun: self.skip(at, at, "there is no session before")
        self.begun = True

    def header(self, at):
        """Kind, number, r, p and CRC of the record, or None if the header is not good (Damage)."""
        head = self.data[at:at + 32]
        if len(head) < 32 or not head.startswith(b"\xc5FRM"): return None
        *fields, crc = struct.unpack("<4x3IQ2I", head)
        good = crc == crc32c(head[:28]) and fields[2] <= 2**26 and fields[3] <= 2**32
        return fields if good else None

    def read(self, at):  # (Damage): the steps at one position; returns the next position
        data, header = self.data, self.header(at)
        if len(data) - at < 32 and self.end: return self.skip(at, len(data), "bytes after the end")
        if header and header[0] != SESSION: self.expect_session(at)
        end = at + 32 + sum(header[2:4] if header else ())
        if header and end <= len(data):
            kind, number, r, _, crc = header
            record, payload = data[at + 32:at + 32 + r], data[at + 32 + r:end]
            content = (read_frame(record, payload) if kind == FRAME else
                       read_json(record, KEYS[kind]) if kind in KEYS else "unknown kind")
            if crc32c(record) == crc and content is not None:
                return self.take(at, end, kind, number, content)
        found = next((i for i in range(at + 1, len(data)) if self.header(i)), len(data))
        if end <= len(data) or found < len(data): return self.skip(at, found, "no whole block")
        self.tail_bytes = found - at
        return found

    def take(self, at, end, kind, number, content):
        ahead, self.number = (number - self.number) % 2**32, (number + 1) % 2**32
        if ahead: self.skip(at, at, "blocks are missing, come twice or out of order")
        if ahead < 2**31: self.missing_blocks += ahead
        if kind == FRAME: self.frames.append(content)
        elif kind == SESSION: self.session, self.begun = content, True
        elif kind == END: self.end = content
        else: self.skip(at, end, content)
        return end

if __name__ == "__main__":
    recording = Recording(open(sys.argv[1], "rb").read())
    for frame in recording.frames: print(*(f"{key}={frame[key]}" for key in FIELDS))
    for place in recording.damage: print(*place.values())
