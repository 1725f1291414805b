"""Comparison of videos: overlap, figures of each frame, difference, choice of figures."""

import csv
import json
import math
import resource
import shutil
import unittest

import numpy as np
from program import DEVICE, INPUT, OK, USAGE, ProgramTest

DEFAULT = ["psnr_db", "psnr_gamma_db", "psnr_frame_mean_db", "pu21_psnr_db", "ssim"]


class CompareTest(ProgramTest):
    def setUp(self):
        super().setUp()
        random = np.random.default_rng(5)
        self.light = 0.2 + random.random((6, 16, 20))
        self.noisy = self.light + random.normal(0, 0.01, self.light.shape)
        self.write_array("light.npy", self.light)
        self.write_array("noisy.npy", self.noisy)

    def table(self, name):
        with open(self.folder / name, newline="", encoding="ascii") as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def test_negative_light_of_the_result_counts_in_linear_light_alone(self):
        """A display shows it as 0."""
        for name, light in {"negative.npy": -0.1, "dark.npy": 0, "reference.npy": 0.1}.items():
            self.write_flat(name, slots=2, rows=16, cols=16, light=light)
        negative, dark = (self.figures("compare", name, "reference.npy") for name in ("negative.npy", "dark.npy"))
        self.assertAlmostEqual(negative["psnr_db"], -20 * math.log10(0.2), 4)
        self.assertAlmostEqual(dark["psnr_db"], 20, 4)
        self.assertAlmostEqual(negative["psnr_gamma_db"], 20 / 2.2, 4)
        for key in ("psnr_gamma_db", "pu21_psnr_db", "ssim"):
            self.assertEqual(negative[key], dark[key], key)
        self.fails(INPUT, ["negative.npy", "row 0, column 0", "light is negative"], "compare", "dark.npy",
                   "negative.npy")

    def test_videos_of_unequal_length_are_compared_where_both_have_frames(self):
        same = self.figures("compare", "noisy.npy", "light.npy", "--until", 4)
        self.assertEqual((same["frames"], same["longer"]), (4, None))
        self.write_array("short.npy", self.noisy[:4])
        done = self.run_program("compare", "short.npy", "light.npy", "--json", "a.json")
        self.assertEqual(done.returncode, OK)
        warning = 'short.npy: ends after 4 frames, before "light.npy" does; these are compared'
        self.assertEqual(done.stderr, f"stipple: warning: {warning}\n")
        self.assertEqual(self.figures("compare", "short.npy", "light.npy"),
                         same | {"longer": "reference", "warnings": [warning]})
        self.write_array("short.npy", self.light[:4])
        self.assertEqual(self.figures("compare", "noisy.npy", "short.npy"),
                         same | {"longer": "result", "warnings": [warning.replace("light", "noisy")]})
        self.fails(INPUT, ["short.npy: ends after 4 frames, before --until 5"], "compare", "noisy.npy", "short.npy",
                   "--until", 5)
        self.fails(INPUT, ["margin", "none of 4"], "compare", "noisy.npy", "short.npy", "--margin", 2)

    def test_results_may_have_a_transfer_function(self):
        light = self.write_array("light.npy", np.full((2, 8, 8), (100 / 255) ** 2.2))
        (self.folder / "result").mkdir()
        for frame in range(2):
            self.write_png(f"result/{frame}.png", np.full((8, 8, 3), 100))
        self.write_array("colour.npy", np.repeat(self.array(light)[..., np.newaxis], 3, axis=3))
        done = self.run_program("compare", "result", "colour.npy", "--json", "-")
        self.assertIn("give --result-transfer", done.stderr)
        done = self.run_program("compare", "result", "colour.npy", "--result-transfer", "gamma22", "--json", "-")
        self.assertEqual(done.stderr, "")
        self.assertGreater(json.loads(done.stdout)["psnr_db"], 100)
        # --transfer is of the reference alone.
        self.write_array("coded.npy", np.full((2, 8, 8), 100 / 255))
        self.assertGreater(self.figures("compare", light, "coded.npy", "--transfer", "gamma22")["psnr_db"], 100)

    def test_the_table_has_the_figures_of_each_frame(self):
        self.noisy[2] = self.light[2]
        self.write_array("noisy.npy", self.noisy)
        whole = self.figures("compare", "noisy.npy", "light.npy", "--margin", 1, "--csv", "frames.csv", "--metric",
                             "psnr,ssim,pu21-psnr", "--metric", "psnr-frames,pu21-ssim,pu21-csf-psnr")
        rows = self.table("frames.csv")
        self.assertEqual([row["frame"] for row in rows], [1, 2, 3, 4])
        self.assertEqual(list(rows[0]), ["frame", "psnr_db", "pu21_psnr_db", "ssim", "pu21_ssim", "pu21_csf_psnr_db"])
        for row in rows:
            frame = int(row["frame"])
            self.write_array("a.npy", self.noisy[frame:frame + 1])
            self.write_array("b.npy", self.light[frame:frame + 1])
            alone = self.figures("compare", "a.npy", "b.npy", "--metric",
                                 "psnr,ssim,pu21-psnr,pu21-ssim,pu21-csf-psnr")
            for key in list(row)[1:]:
                self.assertEqual(row[key], math.inf if alone[key] is None else alone[key], key)
        self.assertEqual(rows[1]["psnr_db"], math.inf)
        self.assertAlmostEqual(whole["ssim"], np.mean([row["ssim"] for row in rows]), 9)
        self.assertAlmostEqual(whole["pu21_ssim"], np.mean([row["pu21_ssim"] for row in rows]), 9)
        self.assertAlmostEqual(whole["psnr_db"],
                               -10 * np.log10(np.mean([10 ** (-row["psnr_db"] / 10) for row in rows])), 6)

    def test_noise_of_known_strength(self):
        figures = self.figures("compare", "noisy.npy", "light.npy", "--metric", "psnr")
        error = np.float32(self.noisy).astype(float) - np.float32(self.light)
        self.assertAlmostEqual(figures["psnr_db"], -10 * math.log10(np.mean(error**2)), 6)
        # sigma = 0.01 is 40 dB; of 1920 draws the mean square is off by 3 sqrt(2 / 1920) = 10 % at most.
        self.assertAlmostEqual(figures["psnr_db"], 40, delta=0.45)

    def test_noise_is_seen_less_than_a_constant_error_of_the_same_strength(self):
        metrics = ("--metric", "pu21-psnr,pu21-csf-psnr")
        self.write_array("flat.npy", np.full((2, 32, 32), 0.5))
        self.write_array("brighter.npy", np.full((2, 32, 32), 0.51))
        noise = np.random.default_rng(6).choice([-0.01, 0.01], (2, 32, 32))
        self.write_array("grainy.npy", 0.5 + noise)
        constant = self.figures("compare", "brighter.npy", "flat.npy", *metrics)
        self.assertAlmostEqual(constant["pu21_csf_psnr_db"], constant["pu21_psnr_db"], 3)
        self.assertEqual(constant["pixels_per_degree"], 60)
        seen = [self.figures("compare", "grainy.npy", "flat.npy", *metrics, "--pixels-per-degree",
                             pixels)["pu21_csf_psnr_db"] for pixels in (5, 30, 60, 120)]
        self.assertAlmostEqual(seen[0], constant["pu21_psnr_db"], delta=0.1)  # near: all of it
        self.assertEqual(seen, sorted(seen))
        self.assertGreater(seen[2], seen[0] + 6)

    def test_figures_are_chosen_by_name(self):
        self.assertEqual(list(self.figures("compare", "noisy.npy", "light.npy")),
                         [*DEFAULT, "peak", "cd_per_unit", "frames", "longer"])
        figures = self.figures("compare", "noisy.npy", "light.npy", "--metric", "pu21-ssim")
        self.assertEqual(list(figures), ["pu21_ssim", "peak", "cd_per_unit", "frames", "longer"])
        said = self.succeed("compare", "noisy.npy", "light.npy", "--metric", "ssim,pu21-ssim")
        self.assertEqual([line.split()[0] for line in said.splitlines()], ["SSIM", "PU21-SSIM"])
        self.fails(USAGE, ["--metric", "vmaf"], "compare", "noisy.npy", "light.npy", "--metric", "vmaf")

    def test_the_difference_is_that_of_the_light(self):
        self.write_array("bright.npy", self.light * 2)
        line = ("compare", "bright.npy", "light.npy", "--max-value", 1.5, "--difference")
        expected = np.abs(np.minimum(np.float32(self.light * 2), 1.5) - np.minimum(np.float32(self.light), 1.5))
        self.succeed(*line, "d.npy")
        np.testing.assert_allclose(self.array("d.npy"), expected, atol=1e-6)
        self.succeed(*line, "frames")
        self.assertEqual(len([name for name in self.names() if name.startswith("frames/")]), 6)
        self.assertAlmostEqual(self.figures("info", "frames")["mean_light"], expected.mean(), 5)
        self.succeed(*line, "rms.png")
        rms = np.sqrt((expected**2).mean(axis=0))
        shown = rms * (1 + rms / 16) / (1 + rms)  # io/tone_map.h
        self.assertAlmostEqual(self.figures("info", "rms.png")["mean_light"], (shown ** (1 / 2.2)).mean(),
                               delta=0.5 / 255)
        self.fails(INPUT, ["d.npy", "--force"], *line, "d.npy")
        self.fails(USAGE, ["--difference", "a difference is"], *line, "d.mp4")
        self.fails(DEVICE, ["stipple: error: full.png: cannot be written"], *line, "full.png",
                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100)))

    def test_the_chart_is_a_picture(self):
        done = self.run_program("compare", "noisy.npy", "light.npy", "--chart", "frames.svg")
        if "gnuplot" in done.stderr:
            self.skipTest(done.stderr)
        self.assertEqual(done.returncode, OK, done.stderr)
        content = (self.folder / "frames.svg").read_text(encoding="utf-8")
        for part in ("<svg", "PU21-PSNR", "SSIM", "similarity"):
            self.assertIn(part, content)
        self.assertNotIn("PSNR frames", content)

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed")
    def test_the_chart_of_equal_frames_or_of_one_frame_is_a_picture_too(self):
        self.write_array("one.npy", self.light[:1])
        self.write_array("tiny.npy", self.light[:, :4, :4])
        for number, (result, reference) in enumerate((("light.npy", "light.npy"), ("noisy.npy", "one.npy"),
                                                      ("tiny.npy", "tiny.npy"))):
            self.succeed("compare", result, reference, "--chart", f"{number}.svg", "-q")
            self.assertIn("<svg", (self.folder / f"{number}.svg").read_text(encoding="utf-8"))

    def test_without_gnuplot_all_but_the_chart_is_there(self):
        done = self.run_program("compare", "noisy.npy", "light.npy", "--csv", "a.csv", "--chart", "a.png", "--difference",
                                "d.npy", "--json", "a.json", env={"PATH": str(self.folder)})
        self.assertEqual(done.returncode, DEVICE, done.stderr)
        self.assertIn("gnuplot", done.stderr)
        self.assertIn("SSIM", done.stdout)
        self.assertEqual(self.names(), ["a.csv", "a.json", "d.npy", "light.npy", "noisy.npy"])

    def test_figures_of_the_whole_video_make_no_table(self):
        for option, name in (("--csv", "frames.csv"), ("--chart", "frames.svg")):
            self.fails(INPUT, [f"{option}: shows figures of each frame"], "compare", "noisy.npy", "light.npy", "--metric",
                       "psnr-frames", option, name)


if __name__ == "__main__":
    unittest.main()
