"""Tables of many trials: those of the program, in one process and on workers."""

import csv
import time
import unittest
from unittest import mock

import stipple
import stipple.dask
from dask_test import PickledTasks
from program import ProgramTest

SPACE = """
[axes]
sensor = ["paper", "lux1310", "nosuch"]
schedule = ["random", "full1x"]
method = "naive"
[set]
"sensor.read_noise_e" = [1, 2.5]
[clip]
frames = 24
rows = 16
cols = 16
"""


class ExploreTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write_space(SPACE)

    def write_space(self, text):
        (self.folder / "space.toml").write_text(text)

    def table_of_program(self, *more):
        self.succeed("explore", "space.toml", "-o", "program", "--no-sync", *more)
        with open(self.folder / "program" / "table.csv", newline="") as table:
            return list(csv.DictReader(table))

    def expect_same(self, rows, table):
        self.assertEqual(len(rows), len(table))
        for row, line in zip(rows, table):
            self.assertEqual(list(row), list(line))
            for name, text in line.items():
                if name in ("decode_seconds", "decode_megabytes"):
                    continue
                if row[name] is None:
                    self.assertEqual(text, "")
                elif isinstance(row[name], float):
                    self.assertEqual(f"{row[name]:.12g}", text)
                else:
                    self.assertEqual(str(row[name]), text)

    def test_rows_are_those_of_the_program(self):
        rows = stipple.explore(self.folder / "space.toml", self.folder / "results")
        self.expect_same(rows, self.table_of_program())
        self.assertEqual((rows[1]["sensor.read_noise_e"], rows[1]["sensor"]), (2.5, "paper"))
        self.assertTrue((self.folder / "results/report.html").is_file())
        # The trials are the program's too.
        self.assertEqual(self.figures("explore", "space.toml", "-o", "results")["known"], 8)

    def test_workers_make_the_same_table(self):
        for more in ({}, {"budget": "6"}):
            with self.subTest(more):
                rows = stipple.dask.explore(self.folder / "space.toml", self.folder / "results", PickledTasks(), **more)
                self.expect_same(rows, self.table_of_program(*(["--budget", 6] if more else [])))
        pictures = [sorted(path.read_bytes() for path in (self.folder / results / "trials").glob("*.png"))
                    for results in ("results", "program")]
        self.assertEqual(*pictures)

    def test_trials_on_workers_are_known_afterwards(self):
        stipple.dask.explore(self.folder / "space.toml", self.folder / "results", PickledTasks(), report=False)
        self.assertFalse((self.folder / "results/report.html").exists())
        clients = PickledTasks()
        with mock.patch.object(clients, "submit") as submit:
            stipple.dask.explore(self.folder / "space.toml", self.folder / "results", clients)
        submit.assert_not_called()

    def test_a_worker_with_another_stipple_is_refused(self):
        here = stipple.dask.check_workers(PickledTasks())
        for there, message in ((here._replace(version="0.0.1"), "second:2 has Stipple 0.0.1, this process "),
                               (here._replace(decode_sha256="00"), "second:2 decodes a small clip to other bits")):
            with self.subTest(message), self.assertRaisesRegex(RuntimeError, message):
                stipple.dask.explore(self.folder / "space.toml", self.folder / "results", PickledTasks(there))
        self.assertFalse((self.folder / "results").exists())

    def test_a_worker_that_comes_later_is_refused_too(self):
        clients = PickledTasks()
        submit = clients.submit

        def submit_from_elsewhere(function, caller, *arguments, pure):
            return submit(function, caller._replace(version="0.0.1"), *arguments, pure=pure)

        clients.submit = submit_from_elsewhere
        with self.assertRaisesRegex(RuntimeError, "a worker has Stipple"):
            stipple.dask.explore(self.folder / "space.toml", self.folder / "results", clients)

    def test_a_worker_with_other_footage_is_refused(self):
        self.write_space(SPACE.replace("[axes]", f'[axes]\nfootage = "{self.folder}/light.npy"'))
        self.write_flat("light.npy", slots=24, rows=16, cols=16)
        clients = PickledTasks()
        submit = clients.submit

        def submit_elsewhere(*arguments, pure):
            self.write_flat("light.npy", slots=24, rows=16, cols=16, light=0.7)
            return submit(*arguments, pure=pure)

        clients.submit = submit_elsewhere
        with self.assertRaisesRegex(ValueError, "a worker has other footage"):
            stipple.dask.explore(self.folder / "space.toml", self.folder / "results", clients)

    def test_progress_ends_the_run_and_what_is_done_stays(self):
        class Enough(Exception):
            pass

        def tell(done, trials):
            self.assertEqual(trials, 12)
            if done >= 3:
                raise Enough

        class Slow(stipple._stipple.Exploration):
            def run(self, number):
                time.sleep(0.11)  # progress is told every 0.1 s at most
                super().run(number)

        with mock.patch("stipple._stipple.Exploration", Slow), self.assertRaises(Enough):
            stipple.explore(self.folder / "space.toml", self.folder / "results", progress=tell)
        self.assertIn(len([*(self.folder / "results/trials").glob("*.png")]), (3, 4))

    def test_bad_input(self):
        self.write_space("[axes]\n")
        with self.assertRaisesRegex(ValueError, "axes.sensor: is missing"):
            stipple.explore(self.folder / "space.toml", self.folder / "results")
        self.write_space(SPACE)
        with self.assertRaisesRegex(ValueError, "budget: \"soon\" is neither a time"):
            stipple.explore(self.folder / "space.toml", self.folder / "results", budget="soon")
        with self.assertRaisesRegex(ValueError, "^rank: \"beauty\" is none of slots_per_second"):
            stipple.explore(self.folder / "space.toml", self.folder / "results", rank="beauty")
        with self.assertRaisesRegex(TypeError, "client is a NoneType.*python3-distributed"):
            stipple.dask.explore(self.folder / "space.toml", self.folder / "results", None)
        self.assertFalse((self.folder / "results").exists())

    def test_a_cluster_of_dask_gives_the_same(self):
        try:
            from distributed import Client, LocalCluster
        except ImportError as reason:
            self.skipTest(f"no Dask: {reason}")
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            with Client(cluster) as client:
                rows = stipple.dask.explore(self.folder / "space.toml", self.folder / "results", client)
        self.expect_same(rows, self.table_of_program())


if __name__ == "__main__":
    unittest.main()
