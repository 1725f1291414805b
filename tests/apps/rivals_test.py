"""Coded exposure and its rivals on a scene."""

import csv
import unittest

import numpy as np

from program import INPUT, ProgramTest

SPACE = """
[axes]
sensor = "paper"
[[systems]]
name = "coded"
schedule = "random"
method = "naive"
[[systems]]
name = "frames"
schedule = "full1x"
method = "naive"
[[systems]]
name = "buckets"
schedule = "two_bucket"
method = "naive"
set = { "sensor.charge_stores" = 2 }
[[systems]]
name = "impossible"
schedule = "two_bucket"
method = "naive"
[clip]
frames = 16
rows = 32
cols = 32
[readout]
sensor = "lux1310"
"""


class RivalsTest(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "space.toml").write_text(SPACE)

    def rivals(self, footage="pan", *more):
        return self.figures("rivals", footage, "-o", "results", "--space", "space.toml", *more)["systems"]

    def test_each_system_is_a_row_and_one_that_cannot_do_it_says_why(self):
        coded, frames, buckets, impossible = self.rivals()
        self.assertEqual([row["system"] for row in (coded, frames, buckets)], ["coded", "frames", "buckets"])
        self.assertEqual((frames["light_throughput"], buckets["light_throughput"]), (0.25, 1))
        self.assertIsNone(impossible["psnr_db"])
        self.assertIn("charge_stores", impossible["problem"])
        # As bright as in 1 slot, as dark as in 8.
        self.assertAlmostEqual(coded["sample_range_stops"] - frames["sample_range_stops"], 3, places=9)

    def test_the_page_is_headed_by_the_scene(self):
        self.rivals("pan", "--system", "frames")
        page = (self.folder / "results/report.html").read_text()
        self.assertIn("<title>Rivals: pan</title>", page)
        self.assertNotIn("space.toml</", page)

    def test_the_figures_are_those_of_explore(self):
        rows = self.rivals()
        self.figures("explore", "space.toml", "-o", "explored", "--no-report")
        with open(self.folder / "explored" / "table.csv", newline="") as table:
            for rival, row in zip(rows, csv.DictReader(table), strict=True):
                self.assertEqual(rival["system"], row["system"])
                if row["psnr_db"]:
                    self.assertAlmostEqual(rival["psnr_db"], float(row["psnr_db"]), places=9)
                    self.assertAlmostEqual(rival["readout_slots_per_second"],
                                           float(row["readout_slots_per_second"]), places=6)

    def test_footage_sensor_and_systems_are_those_that_are_named(self):
        self.succeed("synth", "still", "-o", "still.npy", "--frames", 8, "--size", "32x32")
        rows = self.rivals("still.npy", "--sensor", "ideal", "--system", "frames")
        self.assertEqual([(row["footage"], row["sensor"], row["system"]) for row in rows],
                         [("still.npy", "ideal", "frames")])
        self.fails(INPUT, ['system "film": is unknown; known are coded, frames, buckets'], "rivals", "pan", "-o", "r",
                   "--space", "space.toml", "--system", "film")
        self.fails(INPUT, ["is neither a file nor one of the spaces"], "rivals", "pan", "-o", "r", "--space", "nosuch")

    def test_all_systems_compare_slots_of_whole_exposures(self):
        self.succeed("synth", "still", "-o", "clip.npy", "--frames", 32, "--size", "32x32")
        (self.folder / "space.toml").write_text(SPACE.replace("[clip]\nframes = 16", """[[systems]]
name = "rig"
rig = "multi_exposure_slow"
method = "naive"
[clip]
frames = 36"""))
        rows = self.rivals("clip.npy", "--luminance")
        # Random exposures of up to 8 slots, then frames of 12 slots, of which the third is cut.
        self.assertEqual([row["compared_slots"] for row in rows], ["7:24"] * 3 + ["", "7:24"])
        row, = self.rivals("clip.npy", "--luminance", "--system", "frames")
        self.assertEqual(row, rows[1])
        self.assertIn("compared: slots 7:24 (first:end) of 32",
                      self.succeed("rivals", "clip.npy", "-o", "results", "--space", "space.toml", "--luminance"))

    def test_other_methods_decode_what_best_decodes(self):
        space = SPACE.replace('"random"\nmethod = "naive"', '"random"\nmethod = "best"').replace("rows = 32", "rows = 16")
        (self.folder / "space.toml").write_text(space)
        rows = self.rivals("pan", "--method", "fast", "--system", "coded")
        self.assertEqual([(row["system"], row["method"]) for row in rows], [("coded", "best"), ("coded fast", "fast")])
        row, = self.rivals("pan", "--method", "fast", "--system", "coded fast")
        self.assertEqual(row["system"], "coded fast")
        self.fails(2, ["slow"], "rivals", "pan", "-o", "more", "--method", "slow")

    def test_rows_of_a_space_without_systems_have_the_values_that_differ(self):
        (self.folder / "space.toml").write_text('[axes]\nsensor = "paper"\nmethod = "naive"\nseed = [7, 8]\n'
                                                'schedule = ["full1x", "full4x"]\n[clip]\nframes = 12\n')
        lines = self.succeed("rivals", "pan", "-o", "results", "--space", "space.toml").splitlines()
        self.assertEqual([line[:9] for line in lines if line.startswith("full")],
                         ["full1x, 7", "full1x, 8", "full4x, 7", "full4x, 8"])

    def test_spaces_have_names(self):
        listed = {space["name"]: space["text"] for space in self.figures("list", "spaces")["spaces"]}
        self.assertEqual(listed["rivals"], "Coded exposure and its rivals at an equal number of samples and aperture")
        self.assertTrue(listed["exposure_lengths"].endswith("have?"), listed)
        self.fails(INPUT, ["nosuch", "one of the spaces", "rivals"], "explore", "nosuch", "-o", "r")

    def test_footage_that_cannot_be_read_is_one_error(self):
        done = self.run_program("rivals", "nosuch", "-o", "r", "--space", "space.toml")
        self.assertEqual((done.returncode, done.stdout.count("nosuch"), done.stderr.count("nosuch")), (INPUT, 0, 1))
        self.assertIn("nosuch: there is no such file or folder", done.stderr)
        self.fails(INPUT, ['did you mean "hardware best"?'], "rivals", "pan", "-o", "r", "--system", "hardwar best")

    def test_the_figures_of_a_rig_are_those_of_the_commands(self):
        (self.folder / "rig.toml").write_text("""
sensors = ["a", "b"]
a = { schedule = "full4x", share = 0.75 }
b = { schedule = "random", share = 0.25, offset_px = [0, 2], phase_slots = 1 }
""")
        system = '[[systems]]\nname = "two"\nrig = "rig.toml"\nmethod = "fast"\n'
        (self.folder / "space.toml").write_text(SPACE.replace("[clip]", system + "[clip]").replace(
            '[readout]\nsensor = "lux1310"\n', ""))
        self.succeed("synth", "pan", "-o", "light.npy", "--frames", 16, "--size", "32x32", "--luminance")
        row, = self.rivals("light.npy", "--system", "two")
        rig = self.figures("emulate", "light.npy", "-o", "rig", "--rig", "rig.toml")
        self.succeed("decode", "rig", "-o", "decoded.npy", "--method", "fast")
        quality = self.figures("compare", "decoded.npy", "light.npy", "--max-value", 2, "--margin", 4)
        self.assertEqual((row["rig"], row["schedule"], row["problem"]), ("rig.toml", "", ""))
        for name in ("psnr_db", "psnr_gamma_db", "pu21_psnr_db"):
            self.assertAlmostEqual(row[name], quality[name], places=9)
        self.assertAlmostEqual(row["light_throughput"], rig["light_collected"], places=9)
        self.assertAlmostEqual(1e6 * row["megabits_per_second"], rig["bits_per_second"], places=3)
        self.assertAlmostEqual(row["samples_per_voxel"], 1 / 4 + 4 / 15, places=9)

    def test_a_rig_of_another_sensor_says_so(self):
        system = '[[systems]]\nname = "splitter"\nrig = "tocci2011"\nmethod = "naive"\n'
        (self.folder / "space.toml").write_text(SPACE.replace("[clip]", system + "[clip]"))
        *_, row = self.rivals("pan", "--system", "frames", "--system", "splitter", "--sensor", "ideal")
        self.assertIn('high.sensor: is "paper", but axes.sensor "ideal"', row["problem"])
        self.assertIsNone(row["psnr_db"])

    def test_the_dictionary_is_named_by_the_space_or_the_option(self):
        names = ("rivals", "pan", "-o", "results", "--system", "single bump hitomi2011")
        done = self.run_program(*names)
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("hitomi2011.npy: there is no such dictionary", done.stderr)
        rng = np.random.default_rng(1)
        atoms = self.write_array("patches.npy", rng.normal(size=(64, 4, 9)))
        row, = self.figures(*names, "--dictionary", atoms)["systems"]
        self.assertEqual((row["problem"], row["decoder.dictionary"]), ("", "patches.npy"))
        trials = len(list(self.folder.glob("results/trials/*.json")))
        (self.folder / "patches.npy").rename(self.folder / "hitomi2011.npy")
        self.assertEqual(self.figures(*names)["systems"][0]["psnr_db"], row["psnr_db"])
        self.assertEqual(len(list(self.folder.glob("results/trials/*.json"))), trials)  # known
        self.write_array("hitomi2011.npy", rng.normal(size=(64, 4, 9)))
        self.assertNotEqual(self.figures(*names)["systems"][0]["psnr_db"], row["psnr_db"])

    def test_the_systems_of_the_program_have_the_same_bandwidth(self):
        rows = self.figures("rivals", "pan", "-o", "results", "--system", "coded fast", "--system", "1x naive",
                            "--system", "4x naive", "--system", "beam splitter naive")["systems"]
        for row in rows:
            self.assertEqual((row["problem"], row["compared_slots"]), ("", rows[1]["compared_slots"]))
            self.assertAlmostEqual(row["megabits_per_second"], rows[1]["megabits_per_second"],
                                   delta=0.07 * rows[1]["megabits_per_second"])


if __name__ == "__main__":
    unittest.main()
