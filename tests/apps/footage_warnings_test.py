"""What is said of footage that may not be what it seems."""

import struct
import unittest

import numpy as np
from program import INPUT, OK, USAGE, ProgramTest

CODED = "looks gamma-coded: add --transfer srgb, or --transfer linear if its numbers are linear light"


class FootageWarningsTest(ProgramTest):
    def said(self, footage, *options):
        """Standard error of an emulation, with -q: warnings remain."""
        done = self.run_program("emulate", footage, "-o", "clip.stipple", "--force", "-q", *options)
        self.assertEqual(done.returncode, OK, done.stderr)
        return done.stderr

    def said_of_png(self, values, chunks=(), *options):
        return self.said(self.write_png("f.png", values, chunks), *options)

    def test_images_that_say_that_they_are_coded(self):
        grey = np.full((8, 8), 99)
        gamma = [(b"gAMA", struct.pack(">I", 45455))]
        linear = [(b"gAMA", struct.pack(">I", 100000))]
        line = f"stipple: warning: f.png: {CODED}\n"
        self.assertEqual(self.said_of_png(grey), "")
        self.assertEqual(self.said_of_png(grey, gamma), line)
        self.assertEqual(self.said_of_png(grey, [(b"sRGB", b"\0")]), line)
        self.assertEqual(self.said_of_png(grey, linear), "")

    def test_colour_of_8_bits_unless_the_transfer_is_given(self):
        colour = np.full((8, 8, 3), 99)
        self.assertEqual(self.said_of_png(colour), f"stipple: warning: f.png: {CODED}\n")
        for transfer in ("linear", "srgb", "gamma22"):
            self.assertEqual(self.said_of_png(colour, (), "--transfer", transfer), "")
        self.assertEqual(self.said_of_png(colour, [(b"gAMA", struct.pack(">I", 100000))]), "")

    def test_a_replay_says_the_same(self):
        def said(footage, verb="record"):
            done = self.run_program("capture", verb, f"replay:{footage}", "-o", "clip", "--set",
                                    "camera.AcquisitionFrameRate=0", "--force", "-q")
            self.assertEqual(done.returncode, OK, done.stderr)
            return done.stderr

        colour = self.write_png("f.png", np.full((8, 8, 3), 99))
        for verb in ("record", "live"):
            self.assertIn("stipple: warning: f.png: looks gamma-coded, and is played as linear light; emulation and "
                          "served cameras have --transfer\n", said(colour, verb))
        self.assertIn("its alpha channel is left out", said(self.write_png("a.png", np.full((8, 8, 2), 99))))
        for number in (0, 1, 3):
            self.write_png(f"gap/f{number}.png", np.zeros((8, 8)))
        self.assertEqual(said("gap"), "stipple: warning: gap/f2.png is missing: the frames after it move one slot "
                         "forward\n")
        dn = self.write_array("dn.npy", np.full((4, 8, 8), 117.0))
        self.assertEqual(said(dn).count("the mean light is 117"), 1)
        self.assertEqual(said(self.write_flat("light.npy")), "")

    def test_alpha(self):
        for channels in (2, 4):
            self.assertEqual(self.said_of_png(np.full((8, 8, channels), 99), (), "--transfer", "srgb"),
                             "stipple: warning: f.png: its alpha channel is left out\n")

    def test_a_transfer_of_floating_point_images(self):
        self.succeed("synth", "pan", "-o", "scene", "--frames", "2", "--size", "32x32")
        self.assertEqual(self.said("scene"), "")
        self.assertIn("scene: holds floating-point numbers, which are linear light as a rule; "
                      "--transfer srgb", self.said("scene", "--transfer", "srgb"))

    def test_light_far_above_one(self):
        dn = self.write_array("dn.npy", np.full((4, 8, 8), 117.0))
        self.assertIn("dn.npy: frame 0: the mean light is 117", self.said(dn))
        self.assertEqual(self.said(dn, "--max-value", "2"), "")
        self.assertEqual(self.said(self.write_array("hdr.npy", np.full((4, 8, 8), 7.0))), "")

    def test_missing_numbers_of_a_folder(self):
        for number in (0, 1, 2, 4, 5):
            self.write_png(f"gap/f{number:03}.png", np.full((8, 8), 99))
        self.assertEqual(self.said("gap"), "stipple: warning: gap/f003.png is missing: the frames after it move "
                         "one slot forward\n")
        self.fails(INPUT, ["gap/f003.png: is missing"], "emulate", "gap/f%03d.png", "-o", "x.stipple")

    def test_images_that_a_pattern_leaves_out(self):
        for number in range(7, 13):
            self.write_png(f"num/f{number}.png", np.full((8, 8), 99))
        self.assertIn("num/f%02d.png: takes f10.png to f12.png; left out are 3 images",
                      self.said("num/f%02d.png"))
        self.assertEqual(self.said("num/f%d.png"), "")

    def test_a_tone_mapped_result_is_no_linear_light(self):
        told = self.succeed("synth", "pan", "-o", "s.mp4", "--frames", "4", "--size", "32x32")
        self.assertIn("tone-mapped", told)
        self.assertNotIn("linear light", told)
        self.assertIn("linear light", self.succeed("synth", "pan", "-o", "s.npy", "--frames", "4",
                                                   "--size", "32x32"))
        mapped = self.run_program("compare", "s.mp4", "s.npy", "--luminance")
        self.assertIn("s.mp4: is not linear light, as RESULT has to be", mapped.stderr)
        self.assertEqual(self.run_program("compare", "s.npy", "s.npy").stderr, "")

    def test_peak_and_luminance_of_a_comparison(self):
        a = self.write_array("a.npy", np.full((4, 16, 16), 0.6))
        b = self.write_array("b.npy", np.full((4, 16, 16), 0.5))
        usual = self.figures("compare", a, b)
        self.assertAlmostEqual(usual["psnr_db"], 20, 4)
        self.assertEqual((usual["peak"], usual["cd_per_unit"]), (1, 100))
        bright = self.figures("compare", a, b, "--peak", "2", "--cd-per-unit", "1000")
        self.assertAlmostEqual(bright["psnr_db"], 20 + 20 * np.log10(2), 4)
        self.assertNotAlmostEqual(bright["pu21_psnr_db"], usual["pu21_psnr_db"], 1)
        self.assertIn("peak 2", self.succeed("compare", a, b, "--peak", "2"))
        for option in ("--peak", "--cd-per-unit"):
            for value in ("0", "-1", "nan", "inf"):
                self.fails(USAGE, [option], "compare", a, b, option, value)

    def test_a_sensor_or_a_schedule_without_keys(self):
        (self.folder / "empty.toml").write_text("# nothing\n")
        light = self.write_flat("light.npy")
        for option in ("--sensor", "--schedule"):
            self.fails(INPUT, ["empty.toml: holds no keys"], "emulate", light, "-o", "x.stipple", option,
                       "empty.toml")


if __name__ == "__main__":
    unittest.main()
