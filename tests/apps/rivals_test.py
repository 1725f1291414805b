"""Coded exposure and its rivals on a scene."""

import csv
import unittest

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
        self.assertAlmostEqual(coded["dynamic_range_stops"] - frames["dynamic_range_stops"], 3, places=9)

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
        self.fails(INPUT, ['system "film": is none of coded, frames, buckets'], "rivals", "pan", "-o", "r",
                   "--space", "space.toml", "--system", "film")
        self.fails(INPUT, ["is neither a file nor one of the spaces"], "rivals", "pan", "-o", "r", "--space", "nosuch")

    def test_the_systems_of_the_program_have_the_same_bandwidth(self):
        rows = self.figures("rivals", "pan", "-o", "results", "--system", "coded fast", "--system", "1x naive",
                            "--system", "4x naive")["systems"]
        for row in rows:
            self.assertEqual(row["problem"], "")
            self.assertAlmostEqual(row["megabits_per_second"], rows[1]["megabits_per_second"],
                                   delta=0.07 * rows[1]["megabits_per_second"])


if __name__ == "__main__":
    unittest.main()
