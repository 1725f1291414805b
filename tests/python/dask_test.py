"""Decoding on several workers gives the bits of one process."""

import pickle
import unittest
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import stipple
import stipple.dask
from program import ProgramTest


class PickledTasks:
    """The part of a Dask client that is used. Tasks and results cross a border of processes, as bytes."""

    def __init__(self, second=None):
        self.pool = ThreadPoolExecutor(2)
        self.second = second  # what the second worker tells of itself, where it differs

    def submit(self, function, *arguments, pure):
        assert not pure
        task = pickle.dumps((function, arguments))

        def work():
            called, values = pickle.loads(task)
            return pickle.dumps(called(*values))

        return self.pool.submit(work)

    def gather(self, futures):
        return [pickle.loads(future.result()) for future in futures]

    def run(self, function, *, on_error):
        assert on_error == "return"
        return {"tcp://first:1": function(), "tcp://second:2": self.second or function()}


class DaskTest(ProgramTest):
    def write_clip(self, slots, planes=()):
        light = np.random.default_rng(1).uniform(0, 1, (slots, 20, 24, *planes)).astype(np.float32)
        stipple.emulate(light, output=self.folder / "clip.stipple")
        return self.folder / "clip.stipple"

    def test_blocks_make_the_bits_of_one_process(self):
        for slots, planes in ((10, ()), (64, ()), (65, ()), (150, (3,))):
            with self.subTest(slots=slots):
                clip = self.write_clip(slots, planes)
                for method in ("naive", "fast"):
                    np.testing.assert_array_equal(stipple.dask.decode(clip, PickledTasks(), method),
                                                  stipple.decode(clip, method))
                clip.unlink()

    def test_options_reach_the_workers(self):
        clip = self.write_clip(100)
        result = stipple.dask.decode(clip, PickledTasks(), "fast", {"rounds": 1})
        np.testing.assert_array_equal(result, stipple.decode(clip, "fast", {"rounds": 1}))
        with self.assertRaisesRegex(ValueError, "iteration"):
            stipple.dask.decode(clip, PickledTasks(), "fast", {"iteration": 3})

    def test_a_worker_with_another_stipple_is_refused(self):
        here = stipple.dask.check_workers(PickledTasks())
        self.assertEqual(here.version, stipple.__version__)
        for there, message in ((here._replace(version="0.0.1"), "second:2 has Stipple 0.0.1, this process "),
                               (here._replace(decode_sha256="00"), "second:2 decodes a small clip to other bits"),
                               (ModuleNotFoundError("No module named 'stipple'"), "second:2 cannot run Stipple")):
            with self.subTest(message), self.assertRaisesRegex(RuntimeError, message):
                stipple.dask.decode("none.stipple", PickledTasks(there))
        with self.assertRaisesRegex(RuntimeError, "a worker has Stipple"):
            stipple.dask.require_same(here._replace(version="0.0.1"))

    def test_a_client_that_takes_no_tasks_is_refused(self):
        with self.assertRaisesRegex(TypeError, "client is a NoneType.*python3-distributed"):
            stipple.dask.decode(self.write_clip(10), None)
        with self.assertRaises(FileNotFoundError):
            stipple.dask.decode("none.stipple", PickledTasks())

    def test_a_cluster_of_dask_gives_the_same(self):
        try:
            from distributed import Client, LocalCluster
        except ImportError as reason:
            self.skipTest(f"no Dask: {reason}")
        clip = self.write_clip(150)
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            with Client(cluster) as client:
                result = stipple.dask.decode(clip, client, "naive")
        np.testing.assert_array_equal(result, stipple.decode(clip, "naive"))


if __name__ == "__main__":
    unittest.main()
