"""EMVA 1288: a series of the emulated sensor gives back what it is configured to."""

import json
import os
import resource
import shutil
import struct
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from program import DEVICE, INPUT, OK, PROGRAM, USAGE, ProgramTest

# What has to hold, relative.
BOUNDS = {"gain_dn_per_e": 0.02, "quantum_efficiency": 0.02, "dark_noise_e": 0.03,
          "saturation_e": 0.08, "dsnu_e": 0.04, "dsnu_high_pass_e": 0.04, "prnu": 0.04, "prnu_high_pass": 0.04}


def small_files():
    """A disk that is full soon."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (9000, 9000))


class CharacterizeTest(ProgramTest):
    made = None

    def series_of_t6(self):
        """What a run on t6 leaves: the folder "series", and its figures. It runs once for all tests."""
        if CharacterizeTest.made is None:
            folder = Path(self.enterClassContext(tempfile.TemporaryDirectory(prefix="stipple_")))
            text = self.succeed("characterize", "--sensor", "t6", "-o", folder / "series", "--json", folder / "figures.json")
            (folder / "text").write_text(text)
            CharacterizeTest.made = folder
        shutil.copytree(self.made / "series", self.folder / "series")
        return json.loads((self.made / "figures.json").read_text())

    def characterize(self, sensor, *settings):
        arguments = [word for setting in settings for word in ("--set", f"sensor.{setting}")]
        return self.figures("characterize", "--sensor", sensor, "-o", "series", *arguments)

    def test_without_a_folder_the_figures_are_the_same_and_no_file_stays(self):
        figures = self.series_of_t6()
        (self.folder / "tmp").mkdir()
        done = self.run_program("characterize", "--sensor", "t6", "--json", "-",
                                env=os.environ | {"TMPDIR": str(self.folder / "tmp")})
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertEqual(json.loads(done.stdout), figures)
        self.assertEqual(list((self.folder / "tmp").iterdir()), [])

    def test_what_is_printed_are_the_figures(self):
        figures = self.series_of_t6()
        lines = (self.made / "text").read_text().splitlines()
        for name, key, scale in (("system gain K", "gain_dn_per_e", 1), ("quantum efficiency", "quantum_efficiency", 100),
                                 ("dark noise", "dark_noise_e", 1), ("saturation capacity", "saturation_e", 1),
                                 ("PRNU", "prnu", 100), ("sensitivity threshold", "sensitivity_threshold_p", 1)):
            line, = (line for line in lines if line.startswith(name + " "))
            values = [float(value) for value in line[len(name):].split()[:3]]
            measured, configured = (scale * figures[part][key] for part in ("measured", "configured"))
            self.assertAlmostEqual(values[0] / measured, 1, 3, name)
            self.assertAlmostEqual(values[1] / configured, 1, 3, name)
            self.assertAlmostEqual(values[2], 100 * (measured / configured - 1), delta=0.006, msg=name)

    def expect_configured(self, figures, keys):
        self.assertFalse(figures["biased"])
        for key in keys:
            measured, configured = figures["measured"][key], figures["configured"][key]
            self.assertLess(abs(measured / configured - 1), BOUNDS[key], key)

    def test_a_camera_is_what_it_is_configured_to(self):
        figures = self.characterize("grasshopper")
        self.expect_configured(figures, BOUNDS)
        self.assertAlmostEqual(figures["configured"]["gain_dn_per_e"], 0.280, 5)
        self.assertEqual(figures["configured"]["quantum_efficiency"], 0.45)
        self.assertLess(figures["measured"]["linearity_error"], 0.002)
        self.expect_a_series_for_other_programs(figures)

    def expect_a_series_for_other_programs(self, figures):
        lines = (self.folder / "series/emva1288_data.txt").read_text().split("\n")
        self.assertEqual(lines[:3], ["v 4.0", "n 12 320 240", "d 5000000"])
        self.assertEqual(sum(line.startswith("i ") for line in lines), 302)
        self.assertEqual(sum(line.startswith("b ") for line in lines), 51)
        head = (self.folder / "series/image_0302.png").read_bytes()[:25]
        self.assertEqual(struct.unpack_from(">IIB", head, 16), (320, 240, 16))
        self.expect_charts("series")
        again = self.figures("characterize", "--evaluate", "series/emva1288_data.txt")
        self.assertEqual(again["measured"], figures["measured"])
        self.assertNotIn("configured", again)
        self.assertEqual(again["notes"], [])  # of no configured saturation, and of no row noise
        self.succeed("characterize", "--evaluate", "series/emva1288_data.txt", "-o", "charts")
        self.expect_charts("charts")

    def test_a_descriptor_of_each_version_has_the_same_figures(self):
        """The reference data sets have version 3.0, or no line of it."""
        measured = self.series_of_t6()["measured"]
        text = (self.folder / "series/emva1288_data.txt").read_text()
        for name, head in ("v3", "v 3.0\n"), ("v41", "v 4.1\n"), ("nov", ""):
            (self.folder / f"series/{name}.txt").write_text(text.replace("v 4.0\n", head))
            self.assertEqual(self.figures("characterize", "--evaluate", f"series/{name}.txt")["measured"], measured)
        (self.folder / "series/non.txt").write_text(text.replace("n 12 320 240\n", ""))
        self.fails(INPUT, ["non.txt", 'no line "n bits width height"'], "characterize", "--evaluate", "series/non.txt")

    def expect_charts(self, folder):
        """Of each point of the series a mark."""
        drawn = ElementTree.parse(self.folder / folder / "photon_transfer.svg").getroot()
        self.assertTrue(drawn.tag.endswith("svg"), drawn.tag)
        png = (self.folder / folder / "photon_transfer.png").read_bytes()
        self.assertEqual((png[:8], png[-8:-4]), (b"\x89PNG\r\n\x1a\n", b"IEND"))

    def test_a_noisy_chip_is_what_it_is_configured_to(self):
        settings = ["prnu=0.01", "dsnu_e=20", "dead_pixel_fraction=0"]
        self.expect_configured(self.characterize("t6", *settings), BOUNDS)

    def test_pixels_that_differ_much_saturate_early(self):
        """With PRNU of 6 % the variance falls where the first pixels are full: 10 to 15 % low."""
        figures = self.series_of_t6()
        self.expect_configured(figures, set(BOUNDS) - {"saturation_e", "dsnu_e", "dsnu_high_pass_e"})
        low = figures["measured"]["saturation_e"] / figures["configured"]["saturation_e"]
        self.assertTrue(0.85 < low < 0.92, low)
        self.assertIn("below the configured one by definition", figures["notes"][0])

    def test_rows_that_seem_to_differ_more_than_the_pixels_have_a_note(self):
        """t6 has row noise, of which the mean of 100 images keeps a tenth, and no DSNU."""
        figures = self.series_of_t6()
        self.assertGreater(figures["measured"]["dsnu_row_e"], figures["measured"]["dsnu_e"])
        self.assertIn("of rows contain the row noise", figures["notes"][1])
        told = self.succeed("characterize", "--evaluate", "series/emva1288_data.txt")
        self.assertIn("of rows contain the row noise", told)
        self.assertNotIn("below the configured one", told)

    def test_dark_current_and_temperature_are_part_of_the_dark_noise(self):
        """400 e/s at 44 degrees are 3200 e/s: 16 e in 5 ms."""
        figures = self.characterize("grasshopper", "dark_current_e_per_s=400", "temperature_c=44")
        self.assertAlmostEqual(figures["configured"]["dark_noise_e"], (10.9**2 + 16) ** 0.5, 6)
        self.expect_configured(figures, BOUNDS)
        self.assertAlmostEqual(figures["dark_mean_dn"], 64 + 16 * 0.28, delta=0.05)

    def test_the_pattern_of_columns_is_told_from_that_of_pixels(self):
        """DSNU of 5 e and columns of 3 e; 320 columns scatter by 4 %, so 4 of that. No rows differ."""
        figures = self.characterize("grasshopper", "dsnu_e=5", "column_noise_e=3")
        measured, configured = figures["measured"], figures["configured"]
        self.assertEqual((configured["dsnu_pixel_e"], configured["dsnu_column_e"]), (5, 3))
        self.assertAlmostEqual(measured["dsnu_pixel_e"], (25 - 9 / 320) ** 0.5, delta=0.05)
        self.assertAlmostEqual(measured["dsnu_column_e"], 3, delta=0.48)
        self.assertLess(measured["dsnu_row_e"], 0.1)
        self.assertAlmostEqual(measured["prnu_pixel"], configured["prnu_pixel"], delta=4e-4)
        self.assertLess(measured["prnu_column"], 2e-3)

    def test_a_curve_of_the_converter_is_a_linearity_error(self):
        """Noise changes means of 2 images of 76800 pixels by 1e-4 at most, and the error by less."""
        for peak_dn in (40, -80):
            figures = self.figures("characterize", "--sensor", "grasshopper", "--set", f"sensor.inl_dn={peak_dn}")
            photons, mean_dn = np.array(figures["photon_transfer"])[:, :2].T
            level = (64 + 0.28 * 0.45 * photons) / 4095
            signal = 0.28 * 0.45 * photons + 4 * peak_dn * (level * (1 - level) - 64 / 4095 * (1 - 64 / 4095))
            saturation = mean_dn[figures["saturation_point"]]
            used = (signal >= 0.05 * saturation) & (signal <= 0.95 * saturation)
            line = np.stack([1 / signal[used], photons[used] / signal[used]], axis=1)
            fit = line @ np.linalg.lstsq(line, np.ones(len(line)), rcond=None)[0]
            self.assertAlmostEqual(figures["measured"]["linearity_error"], abs(1 / fit - 1).mean(), delta=1e-4)

    def test_without_black_level_the_evaluation_is_biased_and_says_so(self):
        """Eq. 1 cuts the noise off at 0: mean 0.40 sigma, deviation 0.58 sigma of 10 e."""
        text = self.succeed("characterize", "--sensor", "paper", "-o", "series",
                            "--set", "sensor.bit_depth=12", "--json", "figures.json")
        self.assertNotIn("black level", text)
        done = self.run_program("characterize", "--evaluate", "series/emva1288_data.txt", "-q")
        self.assertEqual((done.returncode, done.stdout), (OK, ""))
        self.assertIn("black level is too low", done.stderr)
        figures = json.loads((self.folder / "figures.json").read_text())
        self.assertTrue(figures["biased"])
        sigma_dn = 10 * 4095 / 2000
        self.assertAlmostEqual(figures["dark_mean_dn"] / sigma_dn, 0.399, delta=0.005)
        self.assertAlmostEqual(figures["dark_deviation_dn"] / sigma_dn, 0.584, delta=0.005)
        ratio = figures["measured"]["dark_noise_e"] / 10
        self.assertTrue(0.4 < ratio < 0.65, ratio)

    def test_a_black_level_of_four_sigma_removes_the_bias(self):
        figures = self.characterize("paper", "mode=physical", "bit_depth=12", "prnu=0.01",
                                    "dsnu_e=3")
        self.expect_configured(figures, BOUNDS)

    def with_gnuplot(self, script, *arguments):
        """A run that finds this gnuplot, or with no script none."""
        tools = self.folder / "tools"
        shutil.rmtree(tools, ignore_errors=True)
        tools.mkdir()
        if script:
            (tools / "gnuplot").write_text("#!/bin/sh\n" + script)
            (tools / "gnuplot").chmod(0o755)
        return self.run_program(*arguments, env=dict(os.environ, PATH=str(tools)))

    def test_charts_that_cannot_be_drawn_cost_nothing_else(self):
        images = ["image_0001.png", "image_0302.png", "emva1288_data.txt"]
        for script, code, said in (("", OK, "no charts are drawn: gnuplot: No such file"),
                                   ("echo full >&2; exit 1", DEVICE, "gnuplot: failed: full")):
            done = self.with_gnuplot(script, "characterize", "--sensor", "t6", "-o", "series", "--force")
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(said, done.stderr)
            self.assertIn("system gain K", done.stdout)
            names = {path.name for path in (self.folder / "series").iterdir()}
            self.assertEqual(len(names), 304)
            self.assertIn("report.html", names)
            self.assertTrue(names.issuperset(images))
        done = self.with_gnuplot("", "characterize", "--evaluate", "series/emva1288_data.txt", "-o", "none")
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertEqual([path.name for path in (self.folder / "none").iterdir()], ["report.html"])

    def test_a_run_may_replace_its_own_folder_only(self):
        if shutil.which("gnuplot") is None:
            self.skipTest("gnuplot is not installed")
        self.series_of_t6()
        camera = ["characterize", "--sensor", "t6", "-o", "series", "--force"]
        evaluate = ["characterize", "--evaluate", "series/emva1288_data.txt", "--force", "-o"]
        for line in (camera, [*evaluate, "charts"], [*evaluate, "charts"]):
            self.succeed(*line)
        self.fails(INPUT, ["series", "is not replaced"], *evaluate, "series")
        (self.folder / "series/thesis.txt").touch()
        self.fails(INPUT, ['"thesis.txt"', "is not replaced"], *camera)

    def test_a_chart_is_whole_or_absent(self):
        if shutil.which("gnuplot") is None:
            self.skipTest("gnuplot is not installed")
        for name in ("r.png", "r.svg"):
            self.fails(DEVICE, [name, "cannot be written"], "schedule", "show", "random", "-o", name,
                       "--slots", 30, preexec_fn=small_files)
        done = self.with_gnuplot("echo half; echo full >&2; exit 1", "schedule", "show", "random", "-o",
                                 "r.png")
        self.assertEqual((done.returncode, done.stdout), (DEVICE, ""), PROGRAM)
        self.assertFalse((self.folder / "r.png").exists())
        self.succeed("schedule", "show", "random", "-o", "r.png")
        self.assertEqual((self.folder / "r.png").read_bytes()[-8:-4], b"IEND")

    def test_charts_on_a_full_disk_leave_the_table(self):
        if shutil.which("gnuplot") is None:
            self.skipTest("gnuplot is not installed")
        self.series_of_t6()
        done = self.run_program("characterize", "--evaluate", "series/emva1288_data.txt", "-o", "charts",
                                preexec_fn=small_files)
        self.assertEqual(done.returncode, DEVICE, done.stderr)
        self.assertIn("system gain K", done.stdout)
        self.assertIn("charts/photon_transfer", done.stderr)
        for path in (self.folder / "charts").glob("photon_transfer.*"):
            self.assertTrue(path.read_bytes().rstrip().endswith((b"\xaeB`\x82", b"</svg>")), path)

    def test_a_full_disk_is_told_by_the_name_of_the_output(self):
        said = self.fails(DEVICE, ["stipple: error: series/image_0001.png: cannot be written"], "characterize", "--sensor",
                          "t6", "-o", "series", preexec_fn=small_files)
        self.assertNotIn("partial", said)

    def test_what_cannot_be_used_is_named(self):
        self.fails(INPUT, ["unequal transmittance"], "characterize", "--sensor", "ideal", "-o", "a",
                   "--set", "sensor.transmittance=[0.5]")
        self.fails(USAGE, ["schedule"], "characterize", "-o", "a", "--set", "schedule.tile_rows=3")
        self.fails(INPUT, ["a/emva1288_data.txt", "more light"], "characterize", "--sensor", "ideal", "-o", "a")
        self.fails(INPUT, ["none.txt"], "characterize", "--evaluate", "none.txt")
        (self.folder / "a.txt").write_text("v 4.0\nn 8 4 4\nd 1\ni a.png\ni b.png\n")
        self.fails(INPUT, ["a.png"], "characterize", "--evaluate", "a.txt")
        self.write_png("a.png", [[1, 2], [3, 4]])
        self.fails(INPUT, ["a.png", "2 x 2", "4 x 4"], "characterize", "--evaluate", "a.txt")
        (self.folder / "a.txt").write_text("v 4.0\nn 2 2 2\nd 1\ni a.png\ni a.png\n")
        self.fails(INPUT, ["a.png", "DN 4", "2 bits"], "characterize", "--evaluate", "a.txt")
        (self.folder / "a.txt").write_text("v 4.0\nn 8 2 2\nd 1\ni a.png\ni a.png\nq\n")
        self.fails(INPUT, ["a.txt:6"], "characterize", "--evaluate", "a.txt")


if __name__ == "__main__":
    unittest.main()
