"""`stipple explore` and `stipple rivals` with several seeds of a point."""

import csv
import math
import re
import unittest

from program import USAGE, ProgramTest

SPACE = """
[axes]
sensor = "paper"
method = "naive"
schedule = ["random", "full1x"]
[clip]
frames = 16
rows = 32
cols = 32
"""

SYSTEMS = """
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
[clip]
frames = 16
rows = 32
cols = 32
"""


class SeedsTest(ProgramTest):
    def explore(self, space, *more):
        (self.folder / "space.toml").write_text(space)
        return self.figures("explore", "space.toml", "-o", "results", "--no-report", *more)

    def rows(self, name="table.csv"):
        with open(self.folder / "results" / name, newline="") as table:
            return list(csv.DictReader(table))

    def test_means_and_intervals_are_those_of_single_seeds(self):
        self.explore(SPACE.replace("[axes]", "[axes]\nseed = [3, 4, 5]"))
        single = self.rows()
        counts = self.explore(SPACE.replace("[axes]", "[axes]\nseed = 3"), "--seeds", 3)
        self.assertEqual(counts, {"points": 2, "run": 0, "known": 6, "failed": 0, "seeds": 3})
        for row in self.rows():
            for name in ("psnr_db", "psnr_gamma_db", "pu21_psnr_db"):
                samples = [float(other[name]) for other in single if other["schedule"] == row["schedule"]]
                mean = sum(samples) / 3
                deviation = math.sqrt(sum((sample - mean) ** 2 for sample in samples) / 2)
                half = 4.302653 * deviation / math.sqrt(3)  # Student's t, 2 degrees of freedom
                self.assertAlmostEqual(float(row[name]), mean, places=9)
                self.assertAlmostEqual(float(row[name + "_low"]), mean - half, places=5)
                self.assertAlmostEqual(float(row[name + "_high"]), mean + half, places=5)
        self.assertEqual({row["rank"] for row in self.rows()}, {"1", "2"})

    def test_one_seed_changes_nothing(self):
        self.explore(SPACE)
        table = (self.folder / "results/table.csv").read_bytes()
        self.assertEqual(self.explore(SPACE, "--seeds", 1)["known"], 2)
        self.assertEqual((self.folder / "results/table.csv").read_bytes(), table)
        self.assertNotIn(b"_low", table)
        self.assertEqual(self.explore(SPACE, "--seeds", 2)["known"], 2)
        self.fails(USAGE, ["--seeds"], "explore", "space.toml", "-o", "results", "--seeds", 0)

    def test_several_footages_have_a_table_of_their_means(self):
        self.explore(SPACE.replace("[axes]", '[axes]\nfootage = ["pan", "roll"]'), "--seeds", 2)
        rows, means = self.rows(), self.rows("footage.csv")
        self.assertEqual([row["schedule"] for row in means], ["random", "full1x"])
        for i, row in enumerate(means):
            self.assertAlmostEqual(float(row["psnr_db"]), (float(rows[i]["psnr_db"]) + float(rows[i + 2]["psnr_db"])) / 2,
                                   places=9)

    def test_rivals_print_intervals_and_ranks(self):
        (self.folder / "space.toml").write_text(SYSTEMS)
        command = ("rivals", "pan", "-o", "results", "--space", "space.toml")
        text = self.succeed(*command, "--seeds", 3)
        self.assertEqual(len(re.findall(r"\d \+-\d", text)), 6)
        self.assertIn("means of 3 seeds", text)
        systems = self.figures(*command, "--seeds", 3)["systems"]
        self.assertEqual({row["rank"] for row in systems}, {"1", "2"})
        for row in systems:
            self.assertLess(row["psnr_db_low"], row["psnr_db"])
            self.assertLess(row["psnr_db"], row["psnr_db_high"])
            line, = (line for line in text.splitlines() if line.startswith(row["system"] + " "))
            found = re.findall(r" (-?[\d.]+)(?: \+-([\d.]+))?(?= |$)", line)
            columns = [("rank", 1, 0), ("field_of_view", 100, 0), ("samples_per_voxel", 1, 3), ("light_throughput", 100, 0),
                       ("sample_range_stops", 1, 1), ("psnr_db", 1, 2), ("psnr_gamma_db", 1, 2), ("pu21_psnr_db", 1, 2)]
            for (name, scale, digits), (value, half) in zip(columns, found):
                self.assertAlmostEqual(float(value), scale * float(row[name]), delta=0.501 * 10 ** -digits, msg=name)
                if half:
                    self.assertAlmostEqual(float(half), (row[f"{name}_high"] - row[f"{name}_low"]) / 2, delta=0.00501)
        self.assertNotIn("+-", self.succeed(*command))


if __name__ == "__main__":
    unittest.main()
