""".dng images of cameras: the light of each number, what the camera tells, what is refused."""

import shutil
import struct
import subprocess
import unittest
import zlib

import numpy as np
from camera_files import MOSAIC, CameraFilesTest, msb_packed
from program import INPUT

SHORT, LONG, RATIONAL, BYTE, SRATIONAL = 3, 4, 5, 1, 10
SIZES = {SHORT: "H", LONG: "I", RATIONAL: "2I", BYTE: "B", SRATIONAL: "2i"}
GRBG = {33421: (SHORT, [2, 2]), 33422: (BYTE, [1, 0, 2, 1])}


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
        levels = {**GRBG, 50706: (BYTE, [1, 4, 0, 0]), 50714: (SHORT, [64]), 50717: (SHORT, [4000])}
        values = np.tile(MOSAIC[2], (8, 8))
        name = self.dng(values, 16, levels)
        frame = subprocess.run(["ffmpeg", "-v", "error", "-i", name, "-f", "rawvideo", "-pix_fmt", "bayer_grbg16le",
                                "-"], cwd=self.folder, capture_output=True, check=True).stdout
        light = np.minimum(self.light(name)[0], 1)
        np.testing.assert_allclose(light, np.frombuffer(frame, "<u2").reshape(light.shape) / 65535, atol=2 / 65535)

    def test_kinds_that_are_not_read(self):
        for part, bits, tags in (("is compressed (kind 7)", 16, {259: (SHORT, [7])}),
                                 ("1 samples of 4 bits", 4, {}), ("2 samples of 16", 16, {277: (SHORT, [2])}),
                                 ("(format 2)", 16, {339: (SHORT, [2])}),
                                 ("orientation 6", 16, {274: (SHORT, [6])}),
                                 ("none of RGGB", 16, {**GRBG, 33422: (BYTE, [0, 1, 2, 1])}),
                                 ("none of RGGB", 16, {**GRBG, 33421: (SHORT, [4, 1])}),
                                 ("staggered", 16, {**GRBG, 50711: (SHORT, [2])}),
                                 ("neither grey", 16, {262: (SHORT, [2])}),
                                 ("black levels that do not suit", 16, {50714: (SHORT, [70]), 50717: (SHORT, [70])}),
                                 ("black levels that do not suit", 16, {50713: (SHORT, [2, 2]), 50714: (SHORT, [7])}),
                                 ("for each row or column", 16, {50716: (SRATIONAL, [1, 1] * 6)}),
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
