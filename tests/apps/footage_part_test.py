"""Frames, area and resolution of footage, alike in emulate, explore and rivals."""

import csv
import shutil
import unittest

import numpy as np
from program import INPUT, OK, USAGE, ProgramTest

SPACE = """
[axes]
sensor = "paper"
footage = "FOOTAGE"
schedule = ["full1x", "random"]
method = "naive"
"""
PART = ("--frames", "2:14", "--crop", "20x16+3+1", "--bin", 2, "--resize", "5x4", "--scale", 0.5)
FIGURES = ("psnr_db", "psnr_gamma_db", "pu21_psnr_db", "light_throughput", "samples_per_voxel")


class FootagePartTest(ProgramTest):
    def setUp(self):
        super().setUp()
        rng = np.random.default_rng(1)
        self.light = rng.uniform(0, 1.5, (16, 18, 24, 3)).astype(np.float32)
        self.write_array("clip.npy", self.light)

    def truth(self, *options):
        self.succeed("emulate", "clip.npy", "-o", "clip.stipple", "--truth", "truth.npy", "--force", "-q", *options)
        return self.array("truth.npy")

    def reduced(self):
        """PART of the luminance."""
        light = 0.5 * self.light[2:14] @ np.float32([0.2126, 0.7152, 0.0722])
        light = light[:, 1:17, 3:23]
        return light.reshape(12, 4, 4, 5, 4).mean(axis=(2, 4))  # of 2 x 2, then 2 x 2

    def explored(self, footage, *options, results="results"):
        (self.folder / "space.toml").write_text(SPACE.replace("FOOTAGE", footage))
        figures = self.figures("explore", "space.toml", "-o", results, "--no-report", *options)
        with open(self.folder / results / "table.csv", newline="") as table:
            return figures, list(csv.DictReader(table))

    def test_the_light_is_the_part_that_is_named(self):
        np.testing.assert_allclose(self.truth("--luminance", *PART), self.reduced(), rtol=1e-5)
        np.testing.assert_array_equal(self.truth("--frames", ":3", "--crop", "2x4"), self.light[:3, 7:11, 11:13])
        np.testing.assert_array_equal(self.truth("--frames", "15:"), self.light[15:])

    def test_provenance_names_the_part_and_repeats_it(self):
        self.truth("--luminance", *PART)
        before = (self.folder / "clip.stipple").read_bytes()
        info = self.figures("info", "clip.stipple")
        for word in ("--frames 2:14", "--crop 20x16+3+1", "--bin 2", "--resize 5x4", "--scale 0.5", "--luminance"):
            self.assertIn(word, info["command"])
        self.succeed(*info["command"].split()[1:])
        self.assertEqual((self.folder / "again.stipple").read_bytes(), before)

    def test_explore_and_rivals_read_footage_as_emulate_does(self):
        self.write_array("part.npy", self.reduced())
        _, rows = self.explored("clip.npy", "--luminance", *PART)
        _, plain = self.explored("part.npy", results="plain")
        for row, other in zip(rows, plain, strict=True):
            for name in FIGURES:
                self.assertAlmostEqual(float(row[name]), float(other[name]), places=3)
            self.assertEqual((row["slots"], row["compared_slots"]), ("12", "4:8"))
        (self.folder / "rivals.toml").write_text(SPACE.replace("FOOTAGE", "pan"))
        rivals = self.figures("rivals", "clip.npy", "-o", "rivals", "--space", "rivals.toml", "--luminance", *PART)
        for row, rival in zip(rows, rivals["systems"], strict=True):
            for name in FIGURES:
                self.assertAlmostEqual(float(row[name]), rival[name], places=9)

    def test_another_part_is_another_trial(self):
        self.assertEqual(self.explored("clip.npy", "--luminance")[0]["run"], 2)
        for option in (("--crop", "8x8"), ("--crop", "8x8+0+0"), ("--bin", 2), ("--resize", "12x9"),
                       ("--frames", "1:"), ("--scale", 2), ("--transfer", "gamma22")):
            figures, _ = self.explored("clip.npy", "--luminance", *option)
            self.assertEqual((figures["run"], figures["known"]), (2, 0), option)
            figures, _ = self.explored("clip.npy", "--luminance", *option)
            self.assertEqual((figures["run"], figures["known"]), (0, 2), option)

    def test_explore_warns_of_gamma_as_emulate_does(self):
        for frame in range(16):
            self.write_png(f"frames/{frame:02}.png", np.full((8, 8, 3), 100))
        (self.folder / "space.toml").write_text(SPACE.replace("FOOTAGE", "frames"))
        for command in (("explore", "space.toml"), ("rivals", "frames", "--space", "space.toml")):
            done = self.run_program(*command, "-o", "results")
            self.assertEqual(done.returncode, OK, done.stderr)
            self.assertEqual(done.stderr.count("looks gamma-coded"), 1)
            done = self.run_program(*command, "-o", "results", "--transfer", "srgb")
            self.assertNotIn("gamma", done.stderr)

    def test_what_does_not_fit_is_one_message(self):
        (self.folder / "space.toml").write_text(SPACE.replace("FOOTAGE", "clip.npy"))
        for option, part in ((("--crop", "30x10"), "has 24 x 18 pixels, in which --crop 30x10 does not lie"),
                             (("--bin", 5), "not a multiple of --bin 5; add --crop 20x15"),
                             (("--resize", "30x10"), "would enlarge"),
                             (("--frames", "9:17"), "has 16 frames, so not all of --frames 9:17")):
            self.fails(INPUT, ["clip.npy: ", part], "emulate", "clip.npy", "-o", "a.stipple", *option)
            done = self.run_program("explore", "space.toml", "-o", "results", *option)
            self.assertEqual(done.returncode, INPUT)
            self.assertIn(part, done.stderr)
            shutil.rmtree(self.folder / "results")
        for option in (("--crop", "3"), ("--bin", 0), ("--bin", 1.5), ("--resize", "0x3"), ("--frames", "3"),
                       ("--frames", "5:5"), ("--scale", 0)):
            self.fails(USAGE, [option[0]], "emulate", "clip.npy", "-o", "a.stipple", *option)
        self.fails(USAGE, ["--bin"], "rivals", "pan", "-o", "r", "--bin", "x")

    def test_a_video_that_ends_early_is_told_at_its_end(self):
        (self.folder / "clip.y4m").write_bytes(b"YUV4MPEG2 W16 H16 F25:1 Cmono\n" + (b"FRAME\n" + bytes(256)) * 4)
        self.assertEqual(self.figures("emulate", "clip.y4m", "-o", "a.stipple", "--transfer", "linear",
                                      "--frames", "1:4")["slots"], 3)
        for frames in ("1:5", "4:", "9:12"):
            self.fails(INPUT, ["clip.y4m: ", "--frames " + frames], "emulate", "clip.y4m", "-o", "b.stipple",
                       "--transfer", "linear", "--frames", frames)

    def test_parts_of_a_stream_are_of_the_part(self):
        self.truth("--luminance", *PART)
        self.succeed("emulate", "clip.npy", "-o", "pieces", "--part", "1/1", "--luminance", *PART)
        self.succeed("join", "pieces", "-o", "joined.stipple")
        self.assertEqual((self.folder / "joined.stipple").read_bytes(), (self.folder / "clip.stipple").read_bytes())

    def test_an_embedded_scene_is_as_the_space_says(self):
        (self.folder / "space.toml").write_text(SPACE.replace("FOOTAGE", "pan"))
        done = self.run_program("explore", "space.toml", "-o", "results", "--bin", 2)
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("pan: is an embedded scene", done.stderr)


if __name__ == "__main__":
    unittest.main()
