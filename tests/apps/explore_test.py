"""Tables of many trials."""

import csv
import os
import re
import resource
import signal
import time
import unittest
from collections import Counter

import numpy as np
from program import DEVICE, INPUT, STOPPED, USAGE, ProgramTest

SPACE = """
[axes]
sensor = ["paper", "lux1310"]
schedule = ["random", "full1x"]
method = "naive"
[clip]
frames = 16
rows = 32
cols = 32
"""

SYSTEM = """
[[systems]]
name = "a"
schedule = "random"
method = "naive"
set = { "sensor.bit_depth" = 10 }
"""


class ExploreTest(ProgramTest):
    def write_space(self, text=SPACE):
        (self.folder / "space.toml").write_text(text)
        return "space.toml"

    def explore(self, text=SPACE, *more):
        return self.figures("explore", self.write_space(text), "-o", "results", *more)

    def rows(self):
        with open(self.folder / "results" / "table.csv", newline="") as table:
            return list(csv.DictReader(table))

    def test_each_combination_is_a_row_with_the_figures_of_the_commands(self):
        self.assertEqual(self.explore(), {"points": 4, "run": 4, "known": 0, "failed": 0})
        rows = self.rows()
        self.assertEqual([(row["sensor"], row["schedule"]) for row in rows],
                         [(sensor, schedule) for sensor in ("paper", "lux1310")
                          for schedule in ("random", "full1x")])
        self.succeed("synth", "pan", "-o", "colour.npy", "--frames", 16, "--size", "32x32")
        light = self.array("colour.npy")
        self.write_array("light.npy", light @ np.float32([0.2126, 0.7152, 0.0722]))
        # The scene in grey is the luminance of that in colour, up to rounding.
        emulated = self.figures("emulate", "light.npy", "-o", "clip.stipple")
        self.succeed("decode", "clip.stipple", "-o", "decoded.npy", "--method", "naive")
        quality = self.figures("compare", "decoded.npy", "light.npy", "--max-value", 2, "--margin", 4)
        self.assertAlmostEqual(float(rows[0]["light_throughput"]), emulated["light_throughput"], places=6)
        self.assertAlmostEqual(float(rows[0]["psnr_db"]), quality["psnr_db"], delta=0.1)
        self.assertAlmostEqual(float(rows[0]["pu21_psnr_db"]), quality["pu21_psnr_db"], delta=0.1)
        # Paper: slots of 5 ms; 2000 e in one slot, against 10 e and steps of 2000 / 255 e in eight.
        self.assertEqual((float(rows[0]["slots_per_second"]), rows[0]["limited_by"]), (200, "slot"))
        noise_e = np.hypot(10, 2000 / 255 / np.sqrt(12))
        self.assertAlmostEqual(float(rows[0]["sample_range_stops"]), np.log2(2000 / (noise_e / 8)), places=6)
        self.assertEqual(rows[0]["energy_uj_per_slot"], "")
        self.assertEqual((rows[3]["limited_by"], float(rows[3]["slots_per_second"])), ("slot", 2000))

    def test_rate_and_energy_are_those_of_the_window_that_is_read(self):
        self.explore(SPACE + "[set]\n\"sensor.slot_us\" = 100\n[readout]\nrows = 1024\ncols = 1280\n")
        for row in self.rows()[2:]:
            timing = self.figures("timing", "--sensor", "lux1310", "--schedule", row["schedule"], "--seed", 1)
            self.assertAlmostEqual(float(row["slots_per_second"]), timing["coded_readout_hz"], places=6)
            self.assertEqual(row["limited_by"], timing["limited_by"])
            self.assertAlmostEqual(float(row["energy_uj_per_slot"]), timing["slot_energy_uj"], places=6)

    def test_a_second_run_does_only_what_is_new(self):
        self.explore()
        table = (self.folder / "results" / "table.csv").read_bytes()
        self.assertEqual(self.explore(), {"points": 4, "run": 0, "known": 4, "failed": 0})
        self.assertEqual((self.folder / "results" / "table.csv").read_bytes(), table)
        more = SPACE.replace('["paper", "lux1310"]', '["paper", "ideal"]')
        self.assertEqual(self.explore(more), {"points": 4, "run": 2, "known": 2, "failed": 0})
        other = SPACE.replace("frames = 16", "frames = 20")
        self.assertEqual(self.explore(other)["known"], 0)
        self.assertEqual(self.explore(SPACE, "--force")["run"], 4)
        trial = sorted((self.folder / "results" / "trials").iterdir())[0]
        trial.write_text(trial.read_text()[:100])
        self.explore(SPACE.replace("16", "20"))
        self.assertLessEqual(self.explore()["run"], 1)

    def test_changed_footage_is_run_again(self):
        space = SPACE.replace("[axes]", '[axes]\nfootage = "light.npy"')
        self.write_flat("light.npy", slots=20)
        self.assertEqual(self.explore(space)["run"], 4)
        self.write_flat("light.npy", slots=20, light=0.3)
        self.assertEqual(self.explore(space)["run"], 4)
        self.assertEqual(self.explore(space)["run"], 0)

    def test_all_that_determines_a_figure_makes_another_trial(self):
        self.explore()
        for old, new in (("rows = 32", "rows = 24"), ("cols = 32", "cols = 24"), ("frames = 16", "frames = 20"),
                         ("[clip]", "[clip]\nplanes = 3"), ("[clip]", "[clip]\ncompared = [4, 10]"),
                         ("[clip]", "[readout]\nrows = 64\ncols = 32\n[clip]"),
                         ("[clip]", '[readout]\nsensor = "lux2100"\n[clip]'), ("[axes]", "[axes]\nseed = 2"),
                         ("[axes]", "[axes]\nbinning = 2"), ("[axes]", "[axes]\nwindow_rows = 0.5"),
                         ("[axes]", '[axes]\nfootage = "roll"'), ('"naive"', '"fast"'),
                         ("[clip]", '[set]\n"sensor.read_noise_e" = 11\n[clip]'),
                         ("[clip]", '[set]\n"schedule.period_slots" = 30\n[clip]')):
            with self.subTest(new=new):
                figures = self.explore(SPACE.replace(old, new))
                self.assertEqual((figures["known"], figures["run"] + figures["failed"]), (0, 4))

    def test_lists_and_ranges_of_keys(self):
        space = SPACE.replace('["paper", "lux1310"]', '"paper"').replace('["random", "full1x"]', '"random"') + """
[set]
"schedule.exposure_slots" = [[1], [1, 2, 4]]
"sensor.photons_per_unit" = { from = 10, to = 1000, count = 3, log = true }
"sensor.read_noise_e" = { from = 0.5, to = 1.5, count = 3 }
"""
        self.assertEqual(self.explore(space)["run"], 18)
        rows = self.rows()
        self.assertEqual([row["sensor.photons_per_unit"] for row in rows[0:9:3]], ["10", "100", "1000"])
        self.assertEqual([row["sensor.read_noise_e"] for row in rows[:3]], ["0.5", "1", "1.5"])
        # A length of exposure twice as long adds a stop.
        stops = [float(row["sample_range_stops"]) for row in rows]
        self.assertAlmostEqual(stops[9] - stops[0], 2, places=9)

    def test_a_point_that_fails_is_a_row(self):
        space = SPACE.replace('"lux1310"', '"nosuch", "paper"') + '[set]\n"sensor.bit_depth" = [8, 99]\n'
        figures = self.explore(space)
        self.assertEqual((figures["points"], figures["failed"], figures["run"]), (12, 8, 2))
        rows = self.rows()
        self.assertIn("bit_depth", rows[1]["problem"])
        self.assertIn("nosuch", next(row["problem"] for row in rows if row["sensor"] == "nosuch"))
        self.assertEqual((rows[1]["psnr_db"], rows[0]["problem"]), ("", ""))

    def test_each_reason_is_told_with_the_number_of_its_points(self):
        space = SPACE.replace('"lux1310"', '"nosuch"') + '[set]\n"sensor.bit_depth" = [8, 99]\n'
        told = self.succeed("explore", self.write_space(space), "-o", "results")
        problems = Counter(row["problem"] for row in self.rows() if row["problem"])
        self.assertEqual(sorted(problems.values()), [2, 4])
        for problem, count in problems.items():
            text = re.escape(problem.removeprefix("'"))
            self.assertRegex(told, rf'\n{count} points failed, first ".*": {text}\n')

    def test_the_table_for_people_has_the_figures_of_the_rows(self):
        self.write_space()
        told = self.succeed("explore", "space.toml", "-o", "results").splitlines()
        head = next(number for number, line in enumerate(told) if line.endswith("decode s        MB"))
        for row, line in zip(self.rows(), told[head + 1:]):
            figures = line.removeprefix(f"{row['sensor']}, {row['schedule']}").split()
            self.assertEqual(figures[4], f"{float(row['psnr_db']):.2f}")
            self.assertEqual(figures[-2], f"{float(row['decode_seconds']):.1f}")
            memory = row["decode_megabytes"]
            self.assertEqual(figures[-1], f"{float(memory):.0f}" if memory else "-")

    def test_many_reasons_are_told_in_part(self):
        names = ", ".join(f'"none{i}"' for i in range(11))
        told = self.succeed("explore", self.write_space(SPACE.replace('"lux1310"', names)), "-o", "results")
        self.assertEqual(told.count("\n2 points failed, first "), 8)
        self.assertIn('\n3 reasons more in the column "problem" of table.csv\n', told)

    def test_systems_set_values_that_belong_together(self):
        rows = self.systems_rows("""
[[systems]]
name = "flutter"
schedule = "pixel_flutter"
method = "naive"
set = { "schedule.code_slots" = 4, "schedule.open_slots" = 2 }
[[systems]]
name = "frames"
schedule = "full1x"
method = "fast"
""")
        self.assertEqual([(row["system"], row["schedule"], row["method"]) for row in rows],
                         [("flutter", "pixel_flutter", "naive"), ("frames", "full1x", "fast")])
        self.assertEqual([row["schedule.code_slots"] for row in rows], ["4", ""])
        # Half of the slots are open; one in four.
        self.assertEqual([float(row["light_throughput"]) for row in rows], [0.5, 0.25])
        self.assertEqual([row["problem"] for row in rows], ["", ""])

    def systems_rows(self, systems):
        self.explore('[axes]\nsensor = "paper"\n' + systems + SPACE[SPACE.index("[clip]"):])
        return self.rows()

    def test_the_clocks_of_another_sensor_time_the_readout(self):
        space = SPACE.replace('["paper", "lux1310"]', '"paper"') + '[readout]\nsensor = "lux1310"\n'
        self.explore(space)
        for row in self.rows():
            timing = self.figures("timing", "--sensor", "lux1310", "--schedule", row["schedule"], "--seed", 1)
            self.assertAlmostEqual(float(row["readout_slots_per_second"]), timing["coded_readout_hz"], places=6)
            self.assertEqual((float(row["slots_per_second"]), row["limited_by"]), (200, "slot"))
        self.assertEqual(self.run_program("explore", self.write_space(space.replace("lux1310", "t6")), "-o",
                                          "results").returncode, INPUT)
        self.assertIn("readout.sensor t6", self.rows()[0]["problem"])

    def test_a_stopped_run_goes_on(self):
        space = self.write_space(SPACE.replace("frames = 16", "frames = 64") + "[set]\n"
                                 '"sensor.read_noise_e" = { from = 1, to = 100, count = 100 }\n')
        stored = 0
        for which in (signal.SIGKILL, signal.SIGINT):
            program = self.start_program("explore", space, "-o", "results", "--quiet", "--no-sync")
            deadline = time.monotonic() + 60
            while (program.poll() is None and time.monotonic() < deadline
                   and len(list(self.folder.glob("results/trials/[!.]*.json"))) < stored + 5):
                time.sleep(0.001)
            program.send_signal(which)
            program.communicate(timeout=60)
            self.assertIn(program.returncode, (-signal.SIGKILL, STOPPED, 0))
            stored = len(list(self.folder.glob("results/trials/[!.]*.json")))
        self.assertEqual(len(self.rows()), stored)
        hidden = [name for name in os.listdir(self.folder / "results" / "trials") if name.startswith(".")]
        self.assertEqual(hidden, [])

    def test_no_figure_depends_on_whether_it_was_known(self):
        """Of an ideal sensor at full light some figures are infinite or absent."""
        space = SPACE.replace('["paper", "lux1310"]', '["ideal", "lux1310"]').replace("[axes]", '[axes]\nfootage = "light.npy"')
        self.write_flat("light.npy", slots=16, light=0)
        self.explore(space)
        table = (self.folder / "results" / "table.csv").read_bytes()
        self.assertEqual(self.explore(space)["known"], 4)
        self.assertEqual((self.folder / "results" / "table.csv").read_bytes(), table)
        self.assertEqual((self.rows()[0]["psnr_db"], self.rows()[0]["energy_uj_per_slot"]), ("inf", ""))

    def test_the_page_can_be_left_out(self):
        self.explore(SPACE, "--no-report")
        self.assertFalse((self.folder / "results/report.html").exists())
        self.explore()
        page = (self.folder / "results/report.html").read_text()
        self.assertIn("full1x", page)
        self.assertLess(len(page), 1e6)

    def test_a_run_without_any_figures_fails_after_the_table_is_written(self):
        self.write_space(SPACE.replace("full1x", "nosuch").replace("random", "none"))
        done = self.run_program("explore", "space.toml", "-o", "results")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn('results/table.csv: no point could be run; the first: "none"', done.stderr)
        self.assertTrue(all(row["problem"] and not row["psnr_db"] for row in self.rows()))

    def test_a_budget_drops_the_worse_half_after_each_rung(self):
        space = SPACE.replace('["paper", "lux1310"]', '"paper"').replace('["random", "full1x"]', '"random"') \
            .replace("frames = 16", "frames = 48") + '[set]\n"sensor.read_noise_e" = [300, 1, 100, 3, 30, 10]\n'
        figures = self.explore(space, "--budget", 100, "--rank", "psnr_db")
        # 6 points with 12 slots, the best 3 of them with 24, the best 2 of these with 48.
        self.assertEqual((figures["run"], figures["rung_slots"], figures["spent"]), (11, [12, 24, 48], 1.5 + 1.5 + 2))
        rungs = {row["sensor.read_noise_e"]: (row["rung"], row["slots"]) for row in self.rows()}
        self.assertEqual(rungs, {"300": ("1", "12"), "100": ("1", "12"), "30": ("1", "12"), "10": ("2", "24"),
                                 "3": ("3", "48"), "1": ("3", "48")})
        table = (self.folder / "results" / "table.csv").read_bytes()
        self.assertEqual(self.explore(space, "--budget", 100, "--rank", "psnr_db")["known"], 11)
        told = self.succeed("explore", "space.toml", "-o", "results", "--budget", 100, "--rank", "psnr_db")
        self.assertRegex(told, r"\n3 +100 .*\n30 +dropped after 12 slots\n10 +dropped after 24 slots\n")
        self.assertEqual((self.folder / "results" / "table.csv").read_bytes(), table)
        # A rung's share is what is left over the rungs that are left.
        self.assertEqual(self.explore(space, "--budget", 3, "--rank", "psnr_db")["spent"], 1.5 + 0.5 + 1)
        tight = self.explore(space, "--budget", 1, "--rank", "psnr_db")
        self.assertEqual((tight["spent"], tight["failed"]), (1, 2))
        self.assertIn("the budget was spent", self.rows()[5]["problem"])
        # Without a budget the trials of the last rung are known.
        self.assertEqual(self.explore(space)["known"], 2)

    def test_a_rank_by_what_should_be_little_keeps_the_least(self):
        space = SPACE.replace('["paper", "lux1310"]', '"lux1310"').replace("frames = 16", "frames = 48") \
            .replace('["random", "full1x"]', '["random", "single_bump", "full1x", "tiled"]')
        self.explore(space, "--budget", 100, "--rank", "energy_uj_per_slot")
        by_energy = sorted(self.rows(), key=lambda row: float(row["energy_uj_per_slot"]))
        rungs = [int(row["rung"]) for row in by_energy]
        self.assertEqual((rungs, by_energy[0]["schedule"]), (sorted(rungs, reverse=True), "full1x"))
        self.assertGreater(rungs[0], rungs[-1])

    def test_a_budget_of_time_ends(self):
        space = SPACE + '[set]\n"sensor.read_noise_e" = { from = 1, to = 100, count = 100 }\n'
        figures = self.explore(space, "--budget", "0.001s")
        self.assertGreaterEqual(figures["spent"], 0.001)
        self.assertGreater(figures["failed"], 100)
        for text in ("0", "-3", "ten", "3d", "nan"):
            self.fails(USAGE, ["--budget"], "explore", "space.toml", "-o", "results", "--budget", text)
        self.fails(USAGE, ["--rank"], "explore", "space.toml", "-o", "results", "--rank", "psnr_db")
        self.fails(USAGE, ["--rank"], "explore", "space.toml", "-o", "results", "--budget", 3, "--rank", "beauty")

    def test_a_killed_run_with_a_budget_goes_on_to_the_same_table(self):
        space = self.write_space(SPACE.replace("frames = 16", "frames = 48") + "[set]\n"
                                 '"sensor.read_noise_e" = { from = 1, to = 100, count = 10 }\n')
        whole = self.figures("explore", space, "-o", "whole", "--budget", 20, "--no-sync")
        for stored in (20, 45):
            program = self.start_program("explore", space, "-o", "results", "--budget", "20", "--quiet", "--no-sync")
            while program.poll() is None and len(list(self.folder.glob("results/trials/[!.]*.json"))) < stored:
                time.sleep(0.001)
            program.kill()
            program.communicate(timeout=60)
        figures = self.figures("explore", space, "-o", "results", "--budget", 20, "--no-sync")
        self.assertEqual(figures["run"] + figures["known"], whole["run"])
        self.assertGreater(figures["known"], 0)

        def table(folder):
            with open(self.folder / folder / "table.csv", newline="") as file:
                return [{**row, "decode_seconds": None, "decode_megabytes": None} for row in csv.DictReader(file)]

        self.assertEqual(table("results"), table("whole"))

    def test_results_that_cannot_be_written(self):
        self.write_space()
        limit = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300))}
        (self.folder / "results").mkdir()  # it would be new otherwise
        done = self.run_program("explore", "space.toml", "-o", "results", **limit)
        self.assertEqual(done.returncode, DEVICE, done.stderr)
        self.assertIn("cannot be written", done.stderr)
        self.assertEqual(list(self.folder.glob("results/trials/*")), [])
        self.assertEqual(self.explore()["run"], 4)  # the disk has room again

    @unittest.skipIf(os.geteuid() != 0, "only root can become somebody who may not write")
    def test_a_folder_that_may_not_be_written(self):
        self.explore()
        self.folder.chmod(0o755)
        nobody = {"preexec_fn": lambda: os.setuid(65534)}
        for name, mode in (("sealed", 0o555), ("locked", 0)):
            (self.folder / name).mkdir(mode=mode)
        for results in ("results", "new", "sealed", "sealed/new", "locked", "locked/new"):
            done = self.run_program("explore", "space.toml", "-o", results, **nobody)
            self.assertEqual(done.returncode, DEVICE, done.stderr)
            self.assertIn(results, done.stderr)
            self.assertIn("Permission denied", done.stderr)
            self.assertEqual(done.stderr.count("stipple: "), 1)

    def test_bad_spaces_are_refused_before_anything_is_written(self):
        for text, part in [("", "axes.sensor: is missing"), ("[axes]\nsensor = []", "is an empty list"),
                           ("[axes", "space.toml:1"), ("axes = 3", "is not a section"),
                           ('[axes]\nsensor = "paper"\nlens = 1', "axes.lens: is unknown"),
                           ('[axes]\nsensor = "paper"\n[set]\nsensor.bit_depth = 8', "put it into quotes"),
                           ('[axes]\nsensor = "paper"\n[clip]\nframes = 0', "clip.frames"),
                           ('[axes]\nsensor = "paper"\nseed = { from = 1 }', "is not a range such as"),
                           ('[axes]\nsensor = "paper"\nseed = { from = 0, to = 9, count = 3, log = true }',
                            "is not a range"),
                           ('[axes]\nsensor = 1979-05-27', "not a number, text"),
                           ('[axes]\nsensor = ""', "is an empty text"),
                           ('systems = 3\n[axes]\nsensor = "paper"', "systems: is not a list of tables"),
                           ('[axes]\nsensor = "paper"\n[[systems]]\nname = "a"', "systems.1.schedule: is missing"),
                           ('[axes]\nsensor = "paper"\nmethod = "fast"\n' + SYSTEM, "axes.method: is set by each"),
                           ('[axes]\nsensor = "paper"\n' + SYSTEM.replace("method", 'rig = "flutter"\nmethod'),
                            "systems.1.rig: stands beside a schedule"),
                           ('[axes]\nsensor = "paper"\nrig = "flutter"\nschedule = "random"',
                            "axes.rig: stands beside a schedule"),
                           ('[axes]\nsensor = "paper"\n' + SYSTEM.replace('schedule = "random"', 'rig = "flutter"')
                            .replace("sensor.bit_depth", "schedule.open_slots"),
                            "systems.1.set.schedule.open_slots: is a key of one sensor"),
                           ('[axes]\nsensor = "paper"\n' + SYSTEM.replace("sensor.bit_depth", "rig.one.share"),
                            "systems.1.set.rig.one.share: is a key of a rig"),
                           ('[axes]\nsensor = "paper"\n' + SYSTEM + SYSTEM, 'two of the name "a"'),
                           ('[axes]\nsensor = "paper"\n[set]\n"sensor.bit_depth" = 8\n' + SYSTEM,
                            "set.sensor.bit_depth: is set by a system too"),
                           (".".join("a" * 40) + " = 1", "space.toml:1: a key has more than 32")]:
            with self.subTest(text):
                self.fails(INPUT, [part], "explore", self.write_space(text), "-o", "results")
        seeds = "{ from = 1, to = 1000, count = 1000 }"
        self.write_space(f'[axes]\nsensor = "paper"\nseed = {seeds}\n[set]\n"sensor.read_noise_e" = {seeds}\n'
                         f'"sensor.slot_us" = {seeds}\n')
        self.fails(INPUT, ["has 1000000000 points"], "explore", "space.toml", "-o", "results")

    def test_results_of_another_version_or_another_folder_are_refused(self):
        self.explore()
        (self.folder / "results" / "version.txt").write_text("0.0.1\n")
        self.fails(INPUT, ["results of another version"], "explore", "space.toml", "-o", "results")
        (self.folder / "letters").mkdir()
        (self.folder / "letters" / "a.txt").touch()
        self.fails(INPUT, ["is not a folder of results"], "explore", "space.toml", "-o", "letters")


if __name__ == "__main__":
    unittest.main()
