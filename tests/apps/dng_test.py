""".dng images of cameras: the light of each number, what the camera tells, what is refused."""

import shutil
import struct
import subprocess
import unittest
import zlib

import numpy as np
from camera_files import MOSAIC, CameraFilesTest, msb_packed
from program import INPUT

SHORT, LONG, RATIONAL, BYTE, SRATIONAL, UNDEFINED = 3, 4, 5, 1, 10, 7
SIZES = {SHORT: "H", LONG: "I", RATIONAL: "2I", BYTE: "B", SRATIONAL: "2i", UNDEFINED: "B"}
JPEG = {259: (SHORT, [7])}
GRBG = {33421: (SHORT, [2, 2]), 33422: (BYTE, [1, 0, 2, 1])}


def lossless_jpeg(values, bits, components=2, predictor=1, shift=0):
    """A lossless JPEG file (ITU-T T.81, annex H) of samples (row, col), of which `components` neighbours are a pixel."""
    rows, cols = values.shape[0], values.shape[1] // components
    samples = (np.asarray(values, np.int64) >> shift).reshape(rows, cols, components)
    string = ""
    for row in range(rows):
        for col in range(cols):
            for part in range(components):
                at = lambda y, x: int(samples[y, x, part])
                if row == 0 and col == 0:
                    guess = 1 << (bits - shift - 1)
                elif row == 0:
                    guess = at(0, col - 1)
                elif col == 0:
                    guess = at(row - 1, 0)
                else:
                    a, b, c = at(row, col - 1), at(row - 1, col), at(row - 1, col - 1)
                    guess = (a, b, c, a + b - c, a + (b - c >> 1), b + (a - c >> 1), a + b >> 1)[predictor - 1]
                difference = (at(row, col) - guess + 32768) % 65536 - 32768
                category = abs(difference).bit_length()
                # Of the Huffman table below: codes of 5 bits, in order.
                string += f"{category:05b}"
                if 0 < category < 16:
                    string += f"{difference if difference > 0 else difference + 2 ** category - 1:0{category}b}"
    string += "1" * (-len(string) % 8)
    data = bytes(int(string[i:i + 8], 2) for i in range(0, len(string), 8)).replace(b"\xff", b"\xff\0")
    segment = lambda kind, content: struct.pack(">BBH", 255, kind, 2 + len(content)) + content
    table = b"\0" + bytes([0, 0, 0, 0, 17] + 11 * [0]) + bytes(range(17))
    frame = struct.pack(">BHHB", bits, rows, cols, components) + b"".join(bytes([i, 0x11, 0]) for i in range(components))
    scan = bytes([components]) + b"".join(bytes([i, 0]) for i in range(components)) + bytes([predictor, 0, shift])
    return b"\xff\xd8" + segment(0xC4, table) + segment(0xC3, frame) + segment(0xDA, scan) + data + b"\xff\xd9"


class Dng:
    """Writes a DNG of one raw image, in the first directory or in one below a small preview."""

    def __init__(self, order="<"):
        self.order = order
        self.content = bytearray((b"II" if order == "<" else b"MM") + struct.pack(order + "HI", 42, 0))

    def add(self, data):
        self.content += bytes(len(self.content) % 2)
        self.content += data
        return len(self.content) - len(data)

    def add_directory(self, tags):
        """Its offset. Values of more than 4 bytes lie before it."""
        entries = b""
        for tag, (kind, values) in sorted(tags.items()):
            form = f"{self.order}{len(values)}{SIZES[kind]}" if kind not in (RATIONAL, SRATIONAL) else \
                f"{self.order}{len(values)}{SIZES[kind][1]}"
            data = struct.pack(form, *values)
            count = len(values) // 2 if kind in (RATIONAL, SRATIONAL) else len(values)
            field = data.ljust(4, b"\0") if len(data) <= 4 else struct.pack(self.order + "I", self.add(data))
            entries += struct.pack(self.order + "HHI", tag, kind, count) + field
        return self.add(struct.pack(self.order + "H", len(tags)) + entries + bytes(4))

    def finish(self, directory):
        struct.pack_into(self.order + "I", self.content, 4, directory)
        return bytes(self.content)


def dng(values, bits=16, tags=None, order="<", below=False, exif=None, tile=None, packed=zlib.compress):
    """The file of an image (row, col). `below`: after a preview; `exif`: tags of that directory; `tile`: its side."""
    tags = dict(tags or {})
    file = Dng(order)
    rows, cols = values.shape
    pieces = [values]
    if tile:
        padded = np.pad(values, [(0, -rows % tile), (0, -cols % tile)])
        pieces = [padded[y:y + tile, x:x + tile] for y in range(0, rows, tile) for x in range(0, cols, tile)]
    data = [piece.astype(order + "u2").tobytes() if bits == 16 else piece.astype("u1").tobytes() if bits == 8 else
            msb_packed(piece, bits) for piece in pieces]
    if tags.get(259, (SHORT, [1]))[1] == [8]:
        data = [packed(part) for part in data]
    if tags.get(259, (SHORT, [1]))[1] == [7]:
        data = [packed(piece) for piece in pieces]
    offsets = [file.add(part) for part in data]
    where = {322: (SHORT, [tile]), 323: (SHORT, [tile]), 324: (LONG, offsets), 325: (LONG, [len(part) for part in data])} \
        if tile else {273: (LONG, offsets), 278: (LONG, [rows]), 279: (LONG, [len(data[0])])}
    raw = {254: (LONG, [0]), 256: (LONG, [cols]), 257: (LONG, [rows]), 258: (SHORT, [bits]), 259: (SHORT, [1]),
           262: (SHORT, [32803 if 33422 in tags else 1]), 277: (SHORT, [1]), **where}
    first = {tag: tags.pop(tag) for tag in (51044, 33434) if tag in tags}
    if exif:
        first[34665] = (LONG, [file.add_directory(exif)])
    raw.update(tags)
    if not below:
        return file.finish(file.add_directory({**raw, **first}))
    preview = {254: (LONG, [1]), 256: (LONG, [1]), 257: (LONG, [1]), 258: (SHORT, [8, 8, 8]), 262: (SHORT, [2]),
               277: (SHORT, [3]), 273: (LONG, [file.add(bytes(3))]), 278: (LONG, [1]), 279: (LONG, [3]),
               330: (LONG, [file.add_directory(raw)])}
    return file.finish(file.add_directory({**preview, **first}))


class DngTest(CameraFilesTest):
    def dng(self, *arguments, name="clip.dng", **options):
        return self.write(name, dng(*arguments, **options))

    def test_depths_and_layouts(self):
        for bits in (8, 10, 12, 14, 16):
            for options in ({}, {"order": ">"}, {"below": True}, {"tile": 16}, {"tags": {259: (SHORT, [8])}}):
                with self.subTest(bits=bits, **options):
                    values = MOSAIC[0] % 2 ** bits
                    self.assert_light([values / (2 ** bits - 1)], self.dng(values, bits, **options))
                    self.assertEqual(self.said, "")

    def test_a_folder_is_footage(self):
        for slot in range(4):
            self.dng(MOSAIC[slot], 12, name=f"clip/frame_{slot:06}.DNG")
        self.assert_light(MOSAIC / 4095, "clip")
        self.assert_light(MOSAIC / 4095, "clip/frame_%06d.DNG")

    def test_levels_table_and_active_area(self):
        dn = MOSAIC[1]
        black = np.array([[10, 20], [30, 40.5]])
        levels = {50713: (SHORT, [2, 2]), 50714: (RATIONAL, [10, 1, 20, 1, 30, 1, 81, 2]), 50717: (LONG, [4000])}
        pattern = np.tile(black, (3, 4))
        self.assert_light([np.maximum(dn - pattern, 0) / (4000 - pattern)], self.dng(dn, 12, levels))
        area = {**levels, 50829: (LONG, [1, 2, 5, 7])}
        inner = np.tile(black, (2, 3))[:, :5]
        self.assert_light([np.maximum(dn[1:5, 2:7] - inner, 0) / (4000 - inner)], self.dng(dn, 12, area))
        table = {50712: (SHORT, list(range(0, 3000, 3))), 50717: (SHORT, [2997])}
        self.assert_light([np.minimum(MOSAIC[0] // 10 * 3, 2997) / 2997], self.dng(MOSAIC[0] // 10, 12, table))

    def test_black_levels_of_rows_and_columns(self):
        dn, rows, cols = MOSAIC[1], np.array([5, 0, -3, 9, 1, 2]), np.arange(8) * 1.5
        levels = {50713: (SHORT, [1, 2]), 50714: (SHORT, [100, 50]), 50717: (SHORT, [4000]),
                  50715: (SRATIONAL, [value for col in cols for value in (int(2 * col), 2)]),
                  50716: (SRATIONAL, [value for row in rows for value in (int(row), 1)])}
        black = np.tile([100, 50], (6, 4)) + rows[:, None] + cols
        self.assert_light([np.maximum(dn - black, 0) / (4000 - black)], self.dng(dn, 12, levels))

    def test_lossless_jpeg(self):
        """Of each predictor, as tiles and strips, with one and two components, as cameras and PiDNG write it."""
        values = np.random.default_rng(3).integers(0, 4096, (20, 26)) // np.array([[1], [64]] * 10)
        for predictor in range(1, 8):
            for tile, components in ((None, 1), (16, 2)):
                with self.subTest(predictor=predictor, tile=tile):
                    packed = lambda piece: lossless_jpeg(piece, 12, components, predictor)
                    self.assert_light([values / 4095], self.dng(values, 12, {**JPEG, **GRBG}, tile=tile, packed=packed))
        for bits in (8, 10, 14, 16):
            values = np.random.default_rng(bits).integers(0, 2 ** bits, (12, 16))
            values[0, :4] = 0, 2 ** bits - 1, 0, 2 ** (bits - 1)
            packed = lambda piece: lossless_jpeg(piece, bits)
            self.assert_light([values / (2 ** bits - 1)], self.dng(values, bits, JPEG, packed=packed))
        packed = lambda piece: lossless_jpeg(piece, 12, shift=2)
        self.assert_light([(MOSAIC[0] >> 2 << 2) / 4095], self.dng(MOSAIC[0], 12, JPEG, packed=packed))

    def test_damaged_lossless_jpeg(self):
        whole = lossless_jpeg(MOSAIC[0], 12)
        for length in (0, 1, 3, 20, 60, len(whole) - 20):
            with self.subTest(length=length):
                self.refuse(["damaged"], self.dng(MOSAIC[0], 12, JPEG, packed=lambda piece: whole[:length]))
        for part, old, new in (("not lossless", b"\xff\xc3", b"\xff\xc0"), ("in place of 48", b"\0\6\0\4", b"\0\6\0\3"),
                               ("restart intervals", b"\xff\xda", b"\xff\xdd\0\4\0\1\xff\xda"),
                               ("subsampled", b"\2\0\x11", b"\2\0\x21"), ("damaged", b"\0\0\0\0\x11", b"\xff\0\0\0\x11"),
                               ("damaged", b"\1\0\1\0\0", b"\1\0\0\0\0")):
            with self.subTest(part=part, new=new):
                self.assertEqual(whole.count(old), 1)
                changed = whole.replace(old, new)
                self.refuse([part], self.dng(MOSAIC[0], 12, JPEG, packed=lambda piece: changed))

    def test_corrections_that_are_not_applied_are_told(self):
        opcodes = lambda *codes: (UNDEFINED, list(struct.pack(">I", len(codes)) + b"".join(
            struct.pack(">IIII", code, 0x01030000, 1, 8) + bytes(8) for code in codes)))
        for tags, part in (({51009: opcodes(9, 9, 9, 9), 51022: opcodes(1)}, "not applied: GainMap, WarpRectilinear"),
                           ({51008: opcodes(99)}, "not applied: opcode 99"),
                           ({50718: (RATIONAL, [2, 1, 1, 1])}, "pixels 2 times as wide as high"),
                           ({50830: (LONG, [0, 0, 6, 2])}, "masked areas, but declares no black level")):
            with self.subTest(part=part):
                self.light(self.dng(MOSAIC[0], 12, tags))
                self.assertIn(part, self.said)
        for tags in ({51009: opcodes()}, {50718: (RATIONAL, [1, 1, 1, 1])},
                     {50830: (LONG, [0, 0, 6, 2]), 50714: (SHORT, [4])}, {51009: (UNDEFINED, [0, 0, 0, 1, 0, 0])}):
            self.light(self.dng(MOSAIC[0], 12, tags))
            self.assertEqual(self.said, "")

    def test_unequal_exposures_are_told(self):
        for slot in range(4):
            self.dng(MOSAIC[slot], 12, {33434: (RATIONAL, [slot + 1, 1000])}, name=f"clip/{slot}.dng")
        self.light("clip")
        self.assertIn("clip: its frames were exposed for 1000 to 4000 us, for which their light is not corrected", self.said)

    def test_rate_exposure_and_mosaic(self):
        camera = {**GRBG, 51044: (SRATIONAL, [1000, 1])}
        for options in ({"tags": {**camera, 33434: (RATIONAL, [1, 4000])}},
                        {"tags": camera, "exif": {33434: (RATIONAL, [1, 4000])}}):
            for below in (False, True):
                self.light(self.dng(MOSAIC[0], 12, below=below, **options))
                for part in ("has 1000 frames/s, but a slot", "exposed for 250 of 1000 us", "grbg"):
                    self.assertIn(part, self.said)
        physical = ("--set", "sensor.mode=physical", "--set", "sensor.cfa=grbg", "--set", "sensor.slot_us=1000")
        self.assert_light([MOSAIC[0] / 4095], self.dng(MOSAIC[0], 12, camera), *physical)
        self.assertEqual(self.said, "")

    def test_images_of_two_mosaics(self):
        self.dng(MOSAIC[0], 12, GRBG, name="clip/0.dng")
        self.dng(MOSAIC[0], 12, {**GRBG, 33422: (BYTE, [0, 1, 1, 2])}, name="clip/1.dng")
        self.fails(INPUT, ["1.dng: has another colour filter array than the first"], "emulate", "clip", "-o", "x.stipple")

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_ffmpeg_reads_the_same_light(self):
        self.assert_as_ffmpeg()
        self.assert_as_ffmpeg(JPEG, tile=16, packed=lambda piece: lossless_jpeg(piece, 16))

    def assert_as_ffmpeg(self, tags=None, **options):
        levels = {**GRBG, 50706: (BYTE, [1, 4, 0, 0]), 50714: (SHORT, [64]), 50717: (SHORT, [4000])}
        values = np.tile(MOSAIC[2], (8, 8))
        name = self.dng(values, 16, {**levels, **(tags or {})}, **options)
        frame = subprocess.run(["ffmpeg", "-v", "error", "-i", name, "-f", "rawvideo", "-pix_fmt", "bayer_grbg16le",
                                "-"], cwd=self.folder, capture_output=True, check=True).stdout
        light = np.minimum(self.light(name)[0], 1)
        np.testing.assert_allclose(light, np.frombuffer(frame, "<u2").reshape(light.shape) / 65535, atol=2 / 65535)

    def test_kinds_that_are_not_read(self):
        for part, bits, tags in (("is compressed (kind 34892)", 16, {259: (SHORT, [34892])}),
                                 ("rows or columns in another order (tag 50975)", 16, {50975: (SHORT, [2])}),
                                 ("rows or columns in another order (tag 50974)", 16, {50974: (LONG, [2, 2])}),
                                 ("other colours than red", 16, {**GRBG, 50710: (BYTE, [3, 4, 5])}),
                                 ("1 samples of 4 bits", 4, {}), ("2 samples of 16", 16, {277: (SHORT, [2])}),
                                 ("(format 2)", 16, {339: (SHORT, [2])}),
                                 ("orientation 6", 16, {274: (SHORT, [6])}),
                                 ("none of RGGB", 16, {**GRBG, 33422: (BYTE, [0, 1, 2, 1])}),
                                 ("none of RGGB", 16, {**GRBG, 33421: (SHORT, [4, 1])}),
                                 ("staggered", 16, {**GRBG, 50711: (SHORT, [2])}),
                                 ("neither grey", 16, {262: (SHORT, [2])}),
                                 ("black levels that do not suit", 16, {50714: (SHORT, [70]), 50717: (SHORT, [70])}),
                                 ("black levels that do not suit", 16, {50713: (SHORT, [2, 2]), 50714: (SHORT, [7])}),
                                 ("do not suit its area", 16, {50716: (SRATIONAL, [1, 1] * 5)}),
                                 ("black levels that do not suit", 16, {50716: (SRATIONAL, [1, 1] * 5 + [70, 1]),
                                                                        50717: (SHORT, [70])}),
                                 ("active area outside", 16, {50829: (LONG, [0, 0, 7, 8])})):
            with self.subTest(part=part):
                self.refuse([part], self.dng(MOSAIC[0] % 16 if bits == 4 else MOSAIC[0], bits, tags))

    def test_damage(self):
        whole = dng(np.tile(MOSAIC[0], (4, 4)), 12)
        for length in (0, 7, 100, len(whole) // 2, len(whole) - 30):
            with self.subTest(length=length):
                self.refuse(["damaged"], self.write("clip.dng", whole[:length]))
        self.refuse(["announces an image of 480000000 bytes"], self.dng(
            MOSAIC[0], 16, {256: (LONG, [60000]), 257: (LONG, [4000])}))
        self.refuse(["outside 1..65535"], self.dng(MOSAIC[0], 16, {256: (LONG, [70000])}))
        self.refuse(["damaged"], self.dng(MOSAIC[0], 16, {259: (SHORT, [8])}, packed=lambda data: data))


if __name__ == "__main__":
    unittest.main()
