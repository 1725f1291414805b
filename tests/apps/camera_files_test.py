"""Files of high-speed cameras: the light of each number, what the camera says of itself, what is refused."""

import shutil
import struct
import subprocess
import unittest

import numpy as np
from program import INPUT, OK, USAGE, ProgramTest

MOSAIC = np.arange(4 * 6 * 8).reshape(4, 6, 8) * 21  # up to 4011


def lsb_packed(values, bits):
    """Rows of samples as a bit string each, from the lowest bit on (PFNC "p")."""
    string = (np.asarray(values)[..., None] >> np.arange(bits)) & 1
    return np.packbits(string.reshape(*values.shape[:-1], -1), axis=-1, bitorder="little").tobytes()


def msb_packed(values, bits):
    """The same from the highest bit on."""
    string = (np.asarray(values)[..., None] >> np.arange(bits)[::-1]) & 1
    return np.packbits(string.reshape(*values.shape[:-1], -1), axis=-1).tobytes()


class CameraFilesTest(ProgramTest):
    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
        return name

    def light(self, footage, *options):
        """The light that was emulated. What was said stands in self.said."""
        done = self.run_program("emulate", footage, "-o", "clip.stipple", "--truth", "light.npy", "--force", "-q",
                                *options)
        self.assertEqual(done.returncode, OK, done.stderr)
        self.said = done.stderr
        return self.array("light.npy")

    def assert_light(self, expected, footage, *options):
        np.testing.assert_allclose(self.light(footage, *options), np.asarray(expected), rtol=1e-6, atol=1e-9)

    def refuse(self, parts, footage, *options):
        self.fails(INPUT, [f"stipple: {footage}: ", *parts], "emulate", footage, "-o", "x.stipple", *options)


class RawTest(CameraFilesTest):
    def test_formats_of_each_packing(self):
        values = MOSAIC % 1024
        for name, content, bits in (("mono8", (values % 256).astype("u1").tobytes(), 8),
                                    ("Mono10", values.astype("<u2").tobytes(), 10),
                                    ("mono16", values.astype("<u2").tobytes(), 16),
                                    ("MONO16BE", values.astype(">u2").tobytes(), 16),
                                    ("mono10p", lsb_packed(values, 10), 10),
                                    ("mono12p", lsb_packed(MOSAIC, 12), 12),
                                    ("mono10msb", msb_packed(values, 10), 10),
                                    ("Mono12MSB", msb_packed(MOSAIC, 12), 12)):
            with self.subTest(format=name):
                expected = (MOSAIC if bits == 12 else values % 2 ** bits) / (2 ** bits - 1)
                self.assert_light(expected, self.write("clip.bin", content), "--raw", f"8x6:{name}")
                self.assertEqual(self.said, "")

    def test_colour_is_interleaved(self):
        values = np.arange(2 * 4 * 6 * 3, dtype=np.uint8).reshape(2, 4, 6, 3)
        self.assert_light(values / 255, self.write("clip.raw", values.tobytes()), "--raw", "6x4:rgb8")

    def test_offset_black_level_and_rate(self):
        name = self.write("clip.raw", bytes(100) + MOSAIC.astype("<u2").tobytes())
        self.assert_light(np.maximum(MOSAIC - 64, 0) / (4095 - 64), name, "--raw",
                          "8x6:mono12:offset=100:black=64:hz=1000")
        self.assertIn("clip.raw: has 1000 frames/s, but a slot of sensor \"paper\" takes 5000 us", self.said)
        self.assertIn("slot_us=1000 of the sensor", self.said)
        self.light(name, "--raw", "8x6:mono12:offset=100:hz=1000", "--set", "sensor.slot_us=1000")
        self.assertEqual(self.said, "")

    def test_a_mosaic_goes_to_the_sensor_with_the_same_filters(self):
        name = self.write("clip.raw", lsb_packed(MOSAIC, 12))
        raw = ("--raw", "8x6:bayergr12p")
        self.assert_light(MOSAIC / 4095, name, *raw)
        self.assertIn("grbg", self.said)
        self.assert_light(MOSAIC / 4095, name, *raw, "--set", "sensor.mode=physical", "--set", "sensor.cfa=grbg")
        self.assertEqual(self.said, "")
        self.fails(INPUT, ["grbg"], "emulate", name, "-o", "x.stipple", *raw, "--set", "sensor.mode=physical",
                   "--set", "sensor.cfa=rggb")
        self.refuse(["mosaic", "--luminance"], name, *raw, "--luminance")

    def test_the_stream_tells_how_to_make_it_again(self):
        name = self.write("clip.raw", MOSAIC.astype("<u2").tobytes())
        self.light(name, "--raw", "8x6:mono12")
        self.assertIn("--raw 8x6:mono12", self.succeed("info", "clip.stipple"))

    def test_a_reference_and_a_served_camera_may_be_raw(self):
        name = self.write("clip.raw", MOSAIC.astype("<u2").tobytes())
        light = self.write_array("own.npy", MOSAIC / 4095)
        self.assertIn("PSNR", self.succeed("compare", light, name, "--raw", "8x6:mono12"))

    def test_what_is_no_description_is_wrong_usage(self):
        name = self.write("clip.raw", bytes(96))
        for text, part in (("8x6", "give columns x rows"), ("8:mono8", "give columns x rows"),
                           ("8x6:mono13p", "\"mono13p\" is no pixel format"), ("8x6:msb", "\"msb\" is no"),
                           ("0x6:mono8", "outside 1..65535"), ("70000x1:mono8", "outside 1..65535"),
                           ("8x6:mono8:black=255", "black=255"), ("8x6:mono8:black=nan", "black=nan"),
                           ("8x6:mono8:hz=0", "hz=0"), ("8x6:mono8:offset=-1", "offset=-1"),
                           ("8x6:mono8:fps=3", "\"fps\" is no key")):
            with self.subTest(text=text):
                said = self.fails(USAGE, [f"--raw: {text}: ", part], "emulate", name, "-o", "x.stipple", "--raw", text)
                self.assertEqual(said.count("--raw: "), 1)

    def test_lengths_that_are_not_of_whole_frames(self):
        self.refuse(["has 95 bytes, which are 1.97917 frames of 8 x 6 Mono8 (48 bytes each)"],
                    self.write("clip.raw", bytes(95)), "--raw", "8x6:mono8")
        self.refuse(["95 from byte 5 on"], self.write("clip.raw", bytes(100)), "--raw", "8x6:mono8:offset=5")
        self.refuse(["has 0 bytes"], self.write("clip.raw", b""), "--raw", "8x6:mono8")
        self.refuse(["0 from byte 200 on"], self.write("clip.raw", bytes(96)), "--raw", "8x6:mono8:offset=200")
        self.refuse(["No such file"], "none.raw", "--raw", "8x6:mono8")
        (self.folder / "frames").mkdir()
        self.refuse(["directory"], "frames", "--raw", "8x6:mono8")

    def test_without_raw_the_option_is_named(self):
        self.refuse(["a file without a header needs --raw"], self.write("clip.raw", bytes(96)))


class Cine:
    """Writes .cine files of Phantom cameras by the offsets of FFmpeg's reader (libavformat/cinedec.c)."""

    def __init__(self, frames, **what):
        self.slots, self.rows, self.cols = frames.shape
        self.bits, self.packing, self.real_bits, self.compression = 16, 0, 12, 0
        self.filter, self.flip, self.levels, self.hz, self.exposure_ns = 0, 0, (0, 0), 5000, 190000
        self.annotation, self.setup_bytes, self.images = 8, 5740, self.slots
        self.__dict__.update(what)
        rows = frames if self.packing else frames[:, ::-1]
        if self.flip:
            rows = rows[:, ::-1]
        pack = {256: 10, 1024: 12}
        self.payload = [msb_packed(frame, pack[self.packing]) if self.packing else
                        frame.astype("u1" if self.bits == 8 else "<u2").tobytes() for frame in rows]

    def content(self):
        setup = bytearray(self.setup_bytes)
        for offset, form, value in ((140, "2s", b"ST"), (142, "H", self.setup_bytes), (760, "I", self.flip),
                                    (768, "I", self.hz), (808, "I", self.filter), (896, "I", self.real_bits),
                                    (1568, "I", self.exposure_ns), (5732, "2i", self.levels)):
            if offset + 8 <= len(setup) or offset < 5732:
                struct.pack_into("<" + form, setup, offset, *(value if isinstance(value, tuple) else (value,)))
        bitmap = struct.pack("<IiiHHIIiiII", 40, self.cols, self.rows, 1, self.bits, self.packing,
                             len(self.payload[0]), 0, 0, 0, 0)
        offsets_at = 84 + len(setup)
        offsets, records = [], b""
        for payload in self.payload:
            offsets.append(offsets_at + 8 * self.slots + len(records))
            records += struct.pack("<I", self.annotation) + bytes(self.annotation - 8)
            records += struct.pack("<I", len(payload)) + payload
        header = struct.pack("<2sHHHiIiIIIIQ", b"CI", 44, self.compression, 1, -7, self.images, -7, self.images, 44, 84,
                             offsets_at, 0)
        return header + bitmap + bytes(setup) + struct.pack(f"<{self.slots}Q", *offsets) + records


class CineTest(CameraFilesTest):
    def cine(self, frames=MOSAIC, **what):
        return self.write("clip.cine", Cine(frames, **what).content())

    def test_depths_and_packings(self):
        for most, what in ((255, {"bits": 8, "real_bits": 8}), (4095, {}), (65535, {"real_bits": 16}),
                           (4095, {"packing": 1024, "bits": 12}), (4095, {"annotation": 24}), (4095, {"flip": 1}),
                           (4095, {"packing": 1024, "flip": 1}), (4095, {"setup_bytes": 1572})):
            with self.subTest(**what):
                values = MOSAIC % (most + 1)
                self.assert_light(values / most, self.cine(values, **what), "--set", "sensor.slot_us=200")
                self.assertEqual(self.said, "")

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_ffmpeg_reads_the_same_numbers(self):
        for pixels, what in (("gray16le", {}), ("gray16le", {"flip": 1}), ("gray", {"bits": 8, "real_bits": 8}),
                             ("bayer_gbrg16le", {"compression": 2, "filter": 3}),
                             ("bayer_rggb16le", {"compression": 2, "filter": 4})):
            with self.subTest(**what):
                values = MOSAIC % 256 if pixels == "gray" else MOSAIC
                name = self.cine(values, **what)
                frames = subprocess.run(["ffmpeg", "-v", "error", "-i", name, "-f", "rawvideo", "-pix_fmt", pixels, "-"],
                                        cwd=self.folder, capture_output=True, check=True).stdout
                read = np.frombuffer(frames, "u1" if pixels == "gray" else "<u2").reshape(values.shape)
                # ffmpeg shifts 12 bits to the top of 16.
                self.assert_light(read / 255 if pixels == "gray" else (read >> 4) / 4095, name)

    def test_levels_that_the_file_declares(self):
        self.assert_light(np.maximum(MOSAIC - 100, 0) / 3900, self.cine(levels=(100, 4000)))
        for levels in ((100, 100), (-5, 4000), (0, 5000)):  # of no use
            self.assert_light(MOSAIC / 4095, self.cine(levels=levels))

    def test_ten_bits_are_companded_by_the_published_table(self):
        # Of 12 bits, black 64 and white 4064 (pycine).
        table = {64: 64, 96: 94, 160: 156, 256: 290, 384: 578, 512: 998, 768: 2267, 896: 3130, 1008: 4014, 1014: 4064}
        light = self.light(self.cine(np.array([[[0, 1, *table]]]), packing=256, bits=10)).ravel()
        np.testing.assert_allclose(light[2:], (np.array(list(table.values())) - 64) / 4000, atol=1.3 / 4000)
        self.assertEqual(list(light[:2]), [0, 0])

    def test_rate_and_exposure(self):
        self.light(self.cine(hz=1000, exposure_ns=990000))
        self.assertIn("has 1000 frames/s, but a slot of sensor \"paper\" takes 5000 us", self.said)
        self.assertNotIn("exposed", self.said)
        self.light(self.cine(hz=1000, exposure_ns=250000), "--set", "sensor.slot_us=1000")
        self.assertIn("its frames were exposed for 250 of 1000 us each", self.said)
        self.light(self.cine(hz=0, exposure_ns=0))
        self.assertEqual(self.said, "")

    def test_a_mosaic_keeps_its_filters(self):
        name = self.cine(compression=2, filter=3, hz=200, exposure_ns=0)
        self.assert_light(MOSAIC / 4095, name, "--set", "sensor.mode=physical", "--set", "sensor.cfa=gbrg")
        self.assertEqual(self.said, "")
        self.refuse(["no --luminance"], name, "--luminance")

    def test_kinds_that_are_not_read(self):
        for parts, what in ((["is compressed (kind 1)"], {"compression": 1}),
                            (["24 bits per pixel in packing 0"], {"bits": 24}), (["packing 77"], {"packing": 77}),
                            (["says that 8 of 16 bits"], {"real_bits": 8}),
                            (["colour filter array of kind 1"], {"compression": 2, "filter": 1}),
                            (["holds no frame"], {"images": 0})):
            with self.subTest(**what):
                content = Cine(MOSAIC, **{key: what[key] for key in what if key not in ("packing", "bits")})
                content.__dict__.update(what)
                self.refuse(parts, self.write("clip.cine", content.content()))
        self.refuse(["end within a byte"], self.cine(MOSAIC[:, :, :7], packing=1024, bits=12))
        self.refuse(["does not begin with"], self.write("clip.cine", bytes(100)))
        self.fails(INPUT, ["clip.cine: byte 84: is no SETUP"], "emulate", self.write(
            "clip.cine", Cine(MOSAIC).content().replace(b"ST", b"XX")), "-o", "x.stipple")

    def test_damage(self):
        whole = Cine(MOSAIC).content()
        for length in (0, 43, 60, 100, 5000, 5830, len(whole) - 1):
            with self.subTest(length=length):
                said = self.fails(INPUT, ["clip.cine: "], "emulate", self.write("clip.cine", whole[:length]), "-o", "x")
                self.assertIn("damaged or cut short", said)
        self.refuse(["announces 4000000000 frames"], self.cine(images=4_000_000_000))
        start = len(whole) - 4 * (8 + 96)
        for field, value in ((0, 7), (0, 2 ** 32 - 1), (4, 95)):
            content = bytearray(whole)
            struct.pack_into("<I", content, start + field, value)
            with self.subTest(field=field, value=value):
                self.fails(INPUT, ["clip.cine"], "emulate", self.write("clip.cine", content), "-o", "x.stipple")


@unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
class Y4mTest(CameraFilesTest):
    def write_y4m(self, pixels):
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i", "testsrc2=s=32x16:r=250", "-frames:v", "3",
                        "-pix_fmt", pixels, "-strict", "-1", "clip.y4m"], cwd=self.folder, check=True)
        header, frames = (self.folder / "clip.y4m").read_bytes().split(b"\n", 1)
        return header, frames

    def test_grey_of_12_bits_is_linear_light(self):
        header, frames = self.write_y4m("gray12le")
        self.assertIn(b"Cmono12", header)
        values = np.frombuffer(frames.replace(b"FRAME\n", b""), "<u2").reshape(3, 16, 32)
        self.assert_light(values / 4095, "clip.y4m", "--set", "sensor.slot_us=4000")
        self.assertEqual(self.said, "")

    def test_luma_of_10_bits_is_gamma_coded(self):
        header, frames = self.write_y4m("yuv420p10le")
        self.assertIn(b"C420p10", header)
        luma = np.frombuffer(frames, np.uint8).reshape(3, -1)[:, 6:6 + 1024].copy().view("<u2").reshape(3, 16, 32)
        light = self.light("clip.y4m")
        self.assertIn("looks gamma-coded", self.said)
        self.assertIn("has 250 frames/s", self.said)
        self.assertEqual(light.shape, (3, 16, 32, 3))
        grey = np.clip((luma - 64) / 876, 0, 1)  # of limited range
        inside = np.all((light > 0) & (light < 1), axis=-1)
        np.testing.assert_allclose((light @ [0.299, 0.587, 0.114])[inside], grey[inside], atol=1e-5)

    def test_one_that_ends_early(self):
        self.write_y4m("gray12le")
        whole = (self.folder / "clip.y4m").read_bytes()
        self.fails(INPUT, ["cut.y4m: "], "emulate", self.write("cut.y4m", whole[:9]), "-o", "x.stipple")
        for length, frame in ((len(whole) // 2, 1), (len(whole) - 1, 2), (len(whole) - 1024, 2), (len(whole) - 1028, 2)):
            with self.subTest(length=length):
                self.refuse([f"ends within frame {frame}"], self.write("cut.y4m", whole[:length]))


if __name__ == "__main__":
    unittest.main()
