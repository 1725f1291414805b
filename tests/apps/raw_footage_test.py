"""Footage without a header, and .y4m: the light of each number, and what is refused."""

import shutil
import subprocess
import unittest

import numpy as np
from camera_files import MOSAIC, CameraFilesTest, lsb_packed, msb_packed
from program import INPUT, USAGE


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
        self.assertIn("--set sensor.slot_us=1000", self.said)
        self.assert_light(MOSAIC / 4095, name, "--raw", "8x6:mono12:offset=100:black=0")
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
        for text, part in (("8x6", "give width x height"), ("8:mono8", "give width x height"),
                           ("8x6:mono13p", "\"mono13p\" is not a supported pixel format"), ("8x6:msb", "\"msb\" is not"),
                           ("0x6:mono8", "outside 1..65535"), ("70000x1:mono8", "outside 1..65535"),
                           ("8x6:mono8:black=255", "black=255"), ("8x6:mono8:black=nan", "black=nan"),
                           ("8x6:mono8:hz=0", "hz=0"), ("8x6:mono8:offset=-1", "offset=-1"),
                           ("8x6:mono8:stride=47", "stride=47: give a number of bytes, at least the 48 of a frame"),
                           ("8x6:mono8:frames=0", "frames=0"),
                           ("8x6:mono8:fps=3", "\"fps\" is an unknown key")):
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

    def test_frames_with_gaps_and_bytes_behind_them(self):
        """As SER (times behind the frames) and Norpix .seq (frames at multiples of a block)."""
        frames = [frame.astype("<u2").tobytes() for frame in MOSAIC]
        count, size = len(frames), len(frames[0])
        ser = self.write("clip.ser", bytes(178) + b"".join(frames) + b"\xff" * 8 * count)
        self.assert_light(MOSAIC / 4095, ser, "--raw", f"8x6:mono12:offset=178:frames={count}")
        seq = self.write("clip.seq", bytes(1024) + b"".join(frame.ljust(160, b"\xff") for frame in frames))
        self.assert_light(MOSAIC / 4095, seq, "--raw", "8x6:mono12:offset=1024:stride=160")
        self.assert_light(MOSAIC[:2] / 4095, seq, "--raw", "8x6:mono12:offset=1024:frames=2:stride=160")
        cut = self.write("cut.seq", (self.folder / seq).read_bytes()[:size - 160])
        self.assert_light(MOSAIC / 4095, cut, "--raw", "8x6:mono12:offset=1024:stride=160")
        self.assert_light(MOSAIC[1:2] / 4095, cut, "--raw", "8x6:mono12:offset=1024:stride=160", "--frames", "1:2")

    def test_a_length_that_does_not_fit_names_values_that_do(self):
        size = 48
        raw = "8x6:mono8:offset=10"
        name = self.write("clip.raw", bytes(10 + 5 * size + 40))
        self.refuse(["add frames=5, which leaves 40 bytes at the end", "stride=56, which makes 5 frames"], name, "--raw", raw)
        for more in (":frames=5", ":stride=56", ":stride=56:frames=4"):
            self.light(name, "--raw", raw + more)
        self.refuse(["which are 5.09091 frames of 8 x 6 Mono8 (48 bytes each, stride 55)",
                     "frames=5, which leaves 12 bytes"], name, "--raw", raw + ":stride=55")
        self.refuse(["has 290 bytes, 280 from byte 10 on, which is room for 5 of frames=6"], name, "--raw", raw + ":frames=6")
        for huge in (2**63, 2**64 - 1):
            self.refuse(["room for 5 of", f"frames={huge}"], name, "--raw", f"{raw}:frames={huge}")
            self.refuse(["room for 1 of frames=2"], name, "--raw", f"{raw}:frames=2:stride={huge}")

    def test_without_raw_the_option_is_named(self):
        self.refuse(["a file without a header needs --raw"], self.write("clip.raw", bytes(96)))


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
        for length, frame in ((len(whole) // 2, 1), (len(whole) - 1, 2), (len(whole) - 1024, 2),
                              (len(whole) - 1028, 2)):
            with self.subTest(length=length):
                self.refuse([f"ends within frame {frame}"], self.write("cut.y4m", whole[:length]))


if __name__ == "__main__":
    unittest.main()
