"""Decoding on several workers gives the bits of one process."""

import functools
import logging
import os
import pickle
import random
import shutil
import signal
import threading
import time
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
    def write_clip(self, slots, planes=(), sensor="paper"):
        light = np.random.default_rng(1).uniform(0, 1, (slots, 20, 24, *planes)).astype(np.float32)
        stipple.emulate(light, sensor, output=self.folder / "clip.stipple")
        return self.folder / "clip.stipple"

    def test_blocks_make_the_bits_of_one_process(self):
        for slots, planes in ((10, ()), (64, ()), (65, ()), (150, (3,))):
            with self.subTest(slots=slots):
                clip = self.write_clip(slots, planes)
                for method in ("naive", "fast"):
                    for source in (clip, stipple.Stream.open(clip)):
                        np.testing.assert_array_equal(stipple.dask.decode(source, PickledTasks(), method),
                                                      stipple.decode(clip, method))
                clip.unlink()

    def test_a_stream_without_a_file_is_refused(self):
        stream = stipple.emulate(np.full((5, 6, 10), 0.2))
        for call in (stipple.dask.decode, functools.partial(stipple.dask.decode_to, self.folder / "windows")):
            with self.assertRaisesRegex(ValueError, "stream: is in a temporary file"):
                call(stream, PickledTasks())
        stream.save(self.folder / "clip.stipple")
        stream = stipple.Stream.open(self.folder / "clip.stipple")
        self.assertEqual(stipple.dask.decode_to(self.folder / "windows", stream, PickledTasks(), "naive"), 1)

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

    def test_stored_blocks_are_the_windows_of_the_program(self):
        clip = self.write_clip(150, (3,))
        self.succeed("decode", clip, "-o", "windows", "--part", "1/2", "--method", "fast", "--set", "decoder.rounds=1")
        decode_to = functools.partial(stipple.dask.decode_to, self.folder / "windows", clip, PickledTasks())
        self.assertEqual(decode_to("fast", {"rounds": 1}), 2)  # of three blocks, one was there
        self.assertEqual(decode_to("fast", {"rounds": 1}), 0)
        self.succeed("decode", clip, "-o", "program", "--part", "1/1", "--method", "fast", "--set", "decoder.rounds=1")
        for path in (self.folder / "program").iterdir():
            self.assertEqual((self.folder / "windows" / path.name).read_bytes(), path.read_bytes(), path.name)
        self.assertEqual(len(list((self.folder / "windows").iterdir())), 4)
        with self.assertRaisesRegex(ValueError, 'another decoding: options is "rounds = 1.*" there and "" here'):
            decode_to("fast")

    def test_blocks_of_another_calibration_or_filling_are_refused(self):
        self.succeed("calibrate", "--sensor", "t6", "--size", "24x20", "-o", "chip.stcal")
        decode_to = functools.partial(stipple.dask.decode_to, self.folder / "windows", self.write_clip(10), PickledTasks(),
                                      "naive")
        decode_to()
        with self.assertRaisesRegex(ValueError, "another decoding: calibration_sha256 is"):
            decode_to(calibration=self.folder / "chip.stcal")
        with self.assertRaisesRegex(ValueError, "another decoding: fill_gaps is false there and true here"):
            decode_to(fill_gaps=True)
        (self.folder / "clip.stipple").unlink()
        stipple.emulate(np.zeros((10, 20, 24), np.float32), output=self.folder / "clip.stipple")  # of as many bytes
        with self.assertRaisesRegex(ValueError, "another decoding: stream is"):
            decode_to()

    def test_the_calibration_beside_the_stream_is_used_as_by_one_process(self):
        self.succeed("calibrate", "--sensor", "t6", "--size", "24x20", "-o", "clip.stcal")
        clip = self.write_clip(10, sensor="t6")
        decoded = stipple.dask.decode(clip, PickledTasks(), "naive")
        np.testing.assert_array_equal(decoded, stipple.decode(clip, "naive"))
        without = stipple.dask.decode(clip, PickledTasks(), "naive", calibration="none")
        self.assertFalse(np.array_equal(decoded, without))

    def test_the_program_goes_on_with_stored_blocks(self):
        clip = self.write_clip(150)
        self.assertEqual(stipple.dask.decode_to(self.folder / "windows", clip, PickledTasks(), "naive"), 3)
        (self.folder / "windows" / "window_000001.npy").write_bytes(b"cut off")
        figures = self.figures("decode", clip, "-o", "windows", "--part", "1/1", "--method", "naive")
        self.assertEqual(figures["windows_decoded"], 1)
        (self.folder / "windows" / "window_000002.npy").write_bytes(b"")
        self.assertEqual(stipple.dask.decode_to(self.folder / "windows", clip, PickledTasks(), "naive"), 1)
        self.succeed("join", "windows", "-o", "joined.npy")
        np.testing.assert_array_equal(self.array("joined.npy"), stipple.decode(clip, "naive"))

    def test_a_refused_call_leaves_nothing(self):
        clip = self.write_clip(10)
        for name in ("windows", "film.zarr"):
            with self.assertRaisesRegex(ValueError, "interpolated"):
                stipple.dask.decode_to(self.folder / name, clip, PickledTasks(), "interpolated")
            with self.assertRaisesRegex(FileNotFoundError, "none: there is no such folder"):
                stipple.dask.decode_to(self.folder / "none" / name, clip, PickledTasks())
        self.assertEqual(self.names(), ["clip.stipple"])

    def test_a_window_from_elsewhere_is_refused(self):
        clip = self.write_clip(150)
        decode_to = functools.partial(stipple.dask.decode_to, self.folder / "windows", clip, PickledTasks(), "naive")
        decode_to()
        window = self.folder / "windows" / "window_000001.npy"
        array = np.load(window)
        for foreign in (array, array.astype(np.float64), array[:-1]):
            np.save(window, foreign)
            with self.assertRaisesRegex(ValueError, "window_000001.npy: is not this window of the decoding .* remove it"):
                decode_to()
        window.unlink()
        self.assertEqual(decode_to(), 1)

    def test_a_link_is_neither_followed_nor_replaced(self):
        clip = self.write_clip(10)
        decode_to = functools.partial(stipple.dask.decode_to, self.folder / "windows", clip, PickledTasks(), "naive")
        decode_to()
        window = self.folder / "windows" / "window_000000.npy"
        window.rename(self.folder / "home.npy")
        window.symlink_to("../home.npy")
        with self.assertRaisesRegex(ValueError, "window_000000.npy: is a link"):
            decode_to()

    def test_a_folder_that_holds_something_else_is_refused(self):
        clip = self.write_clip(10)
        (self.folder / "windows").mkdir()
        (self.folder / "windows" / "letter.txt").touch()
        with self.assertRaisesRegex(ValueError, "holds letter.txt"):
            stipple.dask.decode_to(self.folder / "windows", clip, PickledTasks())
        (self.folder / "windows" / "decoding.json").write_text("[]")
        with self.assertRaisesRegex(ValueError, "decoding.json: does not describe a decoding"):
            stipple.dask.decode_to(self.folder / "windows", clip, PickledTasks())

    def test_an_array_of_zarr_has_the_same_bits(self):
        try:
            import zarr
        except ImportError as reason:
            self.skipTest(f"no Zarr: {reason}")
        store = self.folder / "film.zarr"
        for planes in ((), (3,)):
            clip = self.write_clip(160, planes)
            decode_to = functools.partial(stipple.dask.decode_to, store, clip, PickledTasks())
            self.assertEqual(decode_to("naive"), 3)
            whole = stipple.decode(clip, "naive")
            array = zarr.open(str(store), mode="r")
            self.assertEqual(array.chunks, (48, 20, 24, *planes))
            np.testing.assert_array_equal(array[:], whole)
            self.assertEqual(decode_to("naive"), 0)
            for chunk in (1, 3):  # the last block of 64 slots has two chunks
                (store / ".".join([str(chunk), "0", "0", *["0" for _ in planes]])).unlink()
                self.assertEqual(decode_to("naive"), 1)
            np.testing.assert_array_equal(zarr.open(str(store), mode="r")[:], whole)
            with self.assertRaisesRegex(ValueError, 'another decoding: method is "naive" there and "fast" here'):
                decode_to("fast")
            clip.unlink()
            shutil.rmtree(store)

    def test_damage_is_told_to_the_caller(self):
        clip = self.write_clip(100)
        self.change_byte(clip, clip.stat().st_size // 2)
        with self.assertWarnsRegex(UserWarning, "damaged"):
            result = stipple.dask.decode(clip, PickledTasks(), "naive")
        with self.assertWarnsRegex(UserWarning, "damaged"):
            np.testing.assert_array_equal(result, stipple.decode(clip, "naive"))


def pretend_to_be_another_version():
    stipple._stipple.__version__ = "0.0.1"
    stipple.dask._fingerprint.cache_clear()


class DaskClusterTest(ProgramTest):
    """Two workers, each a process of its own."""

    @classmethod
    def setUpClass(cls):
        try:
            from distributed import Client, LocalCluster
        except ImportError as reason:
            raise unittest.SkipTest(f"no Dask: {reason}")
        cls.cluster = cls.enterClassContext(LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None,
                                                         silence_logs=logging.CRITICAL))
        cls.client = cls.enterClassContext(Client(cls.cluster))

    def write_clip(self, slots, rows=20, cols=24):
        light = np.random.default_rng(1).uniform(0, 1, (slots, rows, cols)).astype(np.float32)
        stipple.emulate(light, output=self.folder / "clip.stipple")
        return self.folder / "clip.stipple"

    def test_gives_the_bits_of_one_process(self):
        clip = self.write_clip(150)
        result = stipple.dask.decode(clip, self.client, "naive")
        np.testing.assert_array_equal(result, stipple.decode(clip, "naive"))
        with self.assertRaisesRegex(ValueError, "iteration"):
            stipple.dask.decode(clip, self.client, "fast", {"iteration": 3})

    def test_a_worker_that_is_killed_costs_its_block_only(self):
        clip = self.write_clip(2400, 24, 32)
        seed = random.randrange(1000)
        enough = random.Random(seed).randrange(1, 12)
        workers = self.client.run(os.getpid)
        decoding = threading.Thread(target=stipple.dask.decode_to,
                                    args=(self.folder / "windows", clip, self.client, "fast"))
        decoding.start()
        windows = functools.partial(self.folder.glob, "windows/window_*.npy")
        while len(list(windows())) < enough and decoding.is_alive():
            time.sleep(0.002)
        os.kill(random.Random(seed).choice(list(workers.values())), signal.SIGKILL)
        kept = {path: path.stat().st_mtime_ns for path in windows()}
        decoding.join(timeout=120)
        self.assertLess(len(kept), 50, f"nothing was left to do, seed {seed}")
        self.assertEqual(len(list(windows())), 50, f"seed {seed}")
        for path, written in kept.items():
            self.assertEqual(path.stat().st_mtime_ns, written, f"{path.name} was decoded again, seed {seed}")
        self.succeed("join", "windows", "-o", "joined.npy")
        np.testing.assert_array_equal(self.array("joined.npy"), stipple.decode(clip, "fast"))
        self.assertEqual([name for name in self.names() if "partial" in name], [])

    def test_a_worker_of_another_version_is_refused(self):
        clip = self.write_clip(10)
        first = sorted(self.client.run(os.getpid))[0]
        self.client.run(pretend_to_be_another_version, workers=[first])
        try:
            with self.assertRaisesRegex(RuntimeError, f"worker {first} has Stipple 0.0.1, this process"):
                stipple.dask.decode(clip, self.client, "naive")
        finally:
            self.client.restart()


if __name__ == "__main__":
    unittest.main()
