"""Emulating in Python makes the bytes of the program."""

import os
import tempfile
import threading
import unittest
import unittest.mock
import warnings

import numpy as np
import stipple
from program import ProgramTest


def light(slots=30, rows=12, cols=20, planes=None):
    """Light that differs from value to value."""
    shape = (slots, rows, cols) if planes is None else (slots, rows, cols, planes)
    return np.random.default_rng(7).random(shape, dtype=np.float32)


class EmulateTest(ProgramTest):
    def program_makes(self, *arguments):
        self.succeed("emulate", *arguments, "-o", "program.stipple", "--force")
        return (self.folder / "program.stipple").read_bytes()

    def same_samples(self, a, b):
        self.assertEqual(a.slots(), b.slots())
        self.assertEqual(a.exposures().tolist(), b.exposures().tolist())
        for slot in range(a.slots()):
            np.testing.assert_array_equal(a.samples(slot), b.samples(slot))

    def test_a_path_gives_the_bytes_of_the_program(self):
        self.write_array("light.npy", light())
        wanted = self.program_makes("light.npy", "--set", "sensor.read_noise_e=5", "--seed", 9,
                                    "--schedule", "tiled", "--set", "schedule.tile_rows=8")
        path = self.folder / "light.npy"
        sensor = stipple.Sensor("paper", {"read_noise_e": 5})
        schedule = stipple.Schedule("tiled", {"tile_rows": 8}, size=(12, 20), seed=9)
        file = self.folder / "python.stipple"
        stream = stipple.emulate(path, sensor, schedule, 9, output=file)
        self.assertEqual(stream.path, file)
        self.assertEqual(file.read_bytes(), wanted)

        stipple.emulate(str(path), sensor, schedule, 9).save(self.folder / "copy.stipple")
        self.assertEqual((self.folder / "copy.stipple").read_bytes(), wanted)

    def test_a_folder_and_how_its_numbers_are_read_are_those_of_the_program(self):
        for frame in range(20):
            self.write_png(f"video/{frame}.png", np.full((8, 8, 3), (10 * frame, 20, 30)))
        wanted = self.program_makes("video", "--transfer", "srgb", "--luminance", "--max-value", "0.5")
        stream = stipple.emulate(self.folder / "video", transfer="srgb", luminance=True, max_value=0.5)
        stream.save(self.folder / "python.stipple")
        self.assertEqual((self.folder / "python.stipple").read_bytes(), wanted)

    def test_loads_the_light_that_the_program_emulates(self):
        self.write_array("light.npy", light(planes=3))
        for options, arguments in (((), {}), (("--luminance", "--max-value", 0.4, "--transfer", "srgb"),
                                              dict(luminance=True, max_value=0.4, transfer="srgb"))):
            self.program_makes("light.npy", "--truth", "truth.npy", *options)
            np.testing.assert_array_equal(stipple.load(self.folder / "light.npy", **arguments), self.array("truth.npy"))

    def test_an_array_gives_the_samples_of_its_file(self):
        colour = light(planes=3)
        arrays = {"mono": light(), "colour": colour, "double": light().astype(np.float64),
                  "half": light().astype(np.float16), "bytes": (255 * light()).astype(np.uint8),
                  "words": (65535 * colour).astype(np.uint16),
                  "swapped": light().astype(">f4"), "backwards": light()[::-1, ::-1, ::-1],
                  "planar": np.moveaxis(light(planes=3).copy(), 0, 0)[..., ::-1],
                  "crop": np.pad(light(), ((0, 0), (2, 1), (3, 4)))[:, 2:-1, 3:-4],
                  "planar crop": np.pad(colour.transpose(0, 3, 1, 2), ((0, 0), (0, 0), (2, 1), (3, 4)))
                  .transpose(0, 2, 3, 1)[:, 2:-1, 3:-4],
                  "every other plane": np.repeat(colour.transpose(0, 3, 1, 2), 2, axis=1)
                  .transpose(0, 2, 3, 1)[..., ::2]}
        for name, array in arrays.items():
            with self.subTest(name):
                self.write_array("light.npy", array, array.dtype.newbyteorder("="))
                self.program_makes("light.npy", "--transfer", "gamma22", "--max-value", "0.7")
                self.same_samples(stipple.emulate(array, transfer="gamma22", max_value=0.7),
                                  stipple.Stream.open(self.folder / "program.stipple"))

    def test_planes_one_after_the_other_are_the_same_light(self):
        pixels = light(planes=3)
        planes = np.ascontiguousarray(pixels.transpose(0, 3, 1, 2)).transpose(0, 2, 3, 1)
        self.same_samples(stipple.emulate(planes, "ideal"), stipple.emulate(pixels, "ideal"))

    def test_leaves_the_array_as_it_is(self):
        for array in (light(), light(planes=3)):
            before = array.copy()
            array.flags.writeable = False
            stipple.emulate(array, transfer="srgb", max_value=0.5)
            np.testing.assert_array_equal(array, before)

    def test_a_schedule_of_ones_own_is_that_of_its_file(self):
        exposures = [(0, 0, 0, 0b1), (0, 0, 1, 0b111), (0, 1, 2, 0b1011)]
        schedule = stipple.Schedule.from_exposures(exposures, (1, 2), 6, size=(12, 20))
        self.assertEqual(schedule.exposures().tolist(), exposures)
        self.assertEqual((schedule.tile, schedule.period_slots), ((1, 2), 6))
        schedule.save(self.folder / "mine.toml")
        self.write_array("light.npy", light())
        self.program_makes("light.npy", "--schedule", "mine.toml")
        self.same_samples(stipple.emulate(light(), schedule=schedule),
                          stipple.Stream.open(self.folder / "program.stipple"))

    def test_weights_are_those_of_its_file(self):
        exposures = [(0, 0, 0, 0b1), (0, 0, 1, 0b111), (0, 1, 2, 0b1011)]
        closed = stipple.Schedule.from_exposures(exposures, (1, 2), 6)
        self.assertFalse(closed.weighted)
        np.testing.assert_array_equal(closed.weights()[:, 0, :].T, [[1, 1, 1, 1, 0, 0], [0, 0, 1, 1, 0, 1]])
        weights = np.round(closed.weights() * np.linspace(0.2, 1, 6)[:, None, None] * 65535) / 65535
        schedule = stipple.Schedule.from_exposures(exposures, (1, 2), 6, weights=weights, size=(12, 20))
        self.assertTrue(schedule.weighted)
        np.testing.assert_allclose(schedule.weights(), weights, rtol=1e-6)
        self.assertAlmostEqual(schedule.light_throughput, weights.mean(), places=6)
        self.assertEqual(schedule.exposures().tolist(), exposures)
        schedule.save(self.folder / "grey.toml")
        self.write_array("light.npy", light())
        self.program_makes("light.npy", "--schedule", "grey.toml")
        stream = stipple.emulate(light(), schedule=schedule)
        self.same_samples(stream, stipple.Stream.open(self.folder / "program.stipple"))
        np.testing.assert_array_equal(stream.weights(), schedule.weights())
        for wrong, message in ((weights[:5], "6 x 1 x 2"), (weights + 0.1, "pixel .* slot"), (weights * np.nan, "nan"),
                               (weights * 2, "is above 1")):
            with self.assertRaisesRegex(ValueError, message):
                stipple.Schedule.from_exposures(exposures, (1, 2), 6, weights=wrong)

    def test_figures_are_those_of_the_program(self):
        self.write_array("light.npy", light())
        for sensor, overrun in (("paper", "stretch"), ("lux1310", "stretch"), ("lux1310", "drop")):
            with self.subTest(sensor, overrun=overrun):
                settings = {} if sensor == "paper" else {"slot_us": 3}
                told = self.figures("emulate", "light.npy", "-o", "program.stipple", "--force", "--sensor", sensor,
                                    "--overrun", overrun, *(("--set", "sensor.slot_us=3") if settings else ()))
                stream = stipple.emulate(self.folder / "light.npy", stipple.Sensor(sensor, settings), overrun=overrun)
                self.assertEqual(stream.figures, {key: told[key] for key in stream.figures})
                self.assertEqual(set(told) - set(stream.figures), {"slots_per_second", "samples_per_second"})
                if overrun == "drop":
                    self.assertGreater(stream.figures["readout"]["dropped_samples"], 0)
        self.assertIsNone(stipple.Stream.open(self.folder / "program.stipple").figures)

    def test_memory_is_limited(self):
        video = np.broadcast_to(np.float32(0.2), (2, 600, 800))
        with self.assertRaisesRegex(ValueError, r'more than the 1 MiB that MaxMemory says; stipple.MaxMemory\("\d'):
            with stipple.MaxMemory("1M"):
                stipple.decode(stipple.emulate(video), "naive")
        stipple.decode(stipple.emulate(video), "naive")
        with self.assertRaisesRegex(ValueError, '"lots" is not a size'):
            stipple.MaxMemory("lots")

    def test_leaves_no_temporary_file(self):
        folder = self.folder / "tmp"
        folder.mkdir()
        tempfile.tempdir = str(folder)  # of Python, which has looked at TMPDIR before
        self.addCleanup(setattr, tempfile, "tempdir", None)
        with unittest.mock.patch.dict(os.environ, TMPDIR=str(folder)):
            stream = stipple.emulate(light())
            self.assertEqual(list(folder.iterdir()), [])
            with self.assertRaises(ValueError):
                stipple.emulate(np.concatenate([light(), -light()]))
            schedule = stipple.Schedule.from_exposures([(0, 0, 0, 1)], (1, 1), 2)
            self.assertEqual(len(list(folder.iterdir())), 1)
            del schedule
            self.assertEqual(list(folder.iterdir()), [])
            with self.assertRaises(ValueError):
                stipple.Schedule.from_exposures([(0, 0, 0, 1)], (1, 1), 2, name="x" * 65)
            self.assertEqual(list(folder.iterdir()), [])
        self.assertEqual(stream.slots(), 30)

    def test_refuses_what_the_program_refuses(self):
        for message, arguments in {
                "light is negative": dict(video=-light()),
                "light is not a number": dict(video=np.full((3, 4, 5), np.nan)),
                "has 2 axes": dict(video=np.ones((3, 4))),
                "holds no frame": dict(video=light()[:0]),
                "has 2 planes": dict(video=np.ones((3, 4, 5, 2))),
                "has dtype int64": dict(video=np.ones((3, 4, 5), int)),
                'did you mean "paper"': dict(video=light(), sensor="papr"),
                "was made for 480 x 640 pixels": dict(video=light(), schedule=stipple.Schedule()),
                "is none of stretch, drop": dict(video=light(), overrun="bend"),
                "is none of linear, gamma22, srgb": dict(video=light(), transfer="log"),
                "scale: 1e[+]300 is outside 1.2e-38..3.4e[+]38": dict(video=light(), scale=1e300),
                "scale: 0 is outside": dict(video=light(), scale=0),
                "max_value: -1 is not above 0": dict(video=light(), max_value=-1),
                "max_value: 1e-50 is not above 0": dict(video=light(), max_value=1e-50)}.items():
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                stipple.emulate(**arguments)

    def test_names_in_messages_are_those_that_were_given(self):
        self.write_array("light.npy", light())
        for name in ("shot--force.npy", "run --scale2.npy", "--force", "a --frames-hz.npy", "a --transfer srgb b", "unit_cd_per_m2"):
            for call in (stipple.load, stipple.decode,
                         lambda file: stipple.decode("light.npy", "hitomi2011", {"dictionary": file}),
                         lambda file: stipple.emulate(light(), file + ".toml")):
                with self.subTest(name), self.assertRaises(FileNotFoundError) as raised:
                    call(name)
                self.assertTrue(str(raised.exception).startswith(name), raised.exception)
            (self.folder / f"c {name}.stipple").touch()
            with self.subTest(name), self.assertRaisesRegex(FileExistsError, f"c {name}.stipple: exists already.* force=True"):
                stipple.emulate(light(), output=self.folder / f"c {name}.stipple")
        self.write_array("shot--force.npy", 1000 * light())
        with self.assertWarnsRegex(UserWarning, "shot--force.npy: "):
            stipple.load(self.folder / "shot--force.npy")

    def test_masked_values_are_refused(self):
        light = np.ma.array(np.full((2, 4, 4), 0.5), mask=False)
        self.assertEqual(stipple.load(light).shape, (2, 4, 4))
        light[1, 2, 3] = np.ma.masked
        with self.assertRaisesRegex(ValueError, "video: has masked values.*filled"):
            stipple.load(light)

    def test_a_file_whose_name_is_not_UTF_8_is_named(self):
        with self.assertRaisesRegex(OSError, "\udcff.npy: there is no such file"):
            stipple.load(os.fsdecode(b"\xff.npy"))

    def test_an_output_has_no_name_of_another_kind_of_file(self):
        stream = stipple.emulate(light())
        schedule = stipple.Schedule("random")
        for create, name in ((lambda file: stipple.emulate(light(), output=file), "x.mp4"), (stream.save, "x.npy"),
                             (lambda file: stipple.emulate(light(), output=file, force=True), ".stipple"),
                             (schedule.save, "x.stipple")):
            with self.assertRaisesRegex(ValueError, f"{name}: .* extension"):
                create(self.folder / name)
            self.assertFalse((self.folder / name).exists())
        stipple.emulate(light(), output=self.folder / "plain")
        stream.save(self.folder / "X.STIPPLE")

    def test_what_is_wrong_with_files_is_an_OSError(self):
        file = self.folder / "clip.stipple"
        stipple.emulate(light(), output=file)
        with self.assertRaisesRegex(FileExistsError, "exists already"):
            stipple.emulate(light(), output=file)
        stipple.emulate(light(), output=file, force=True)
        with self.assertRaisesRegex(FileNotFoundError, "there is no folder"):
            stipple.emulate(light(), output=self.folder / "none/clip.stipple")
        with self.assertRaises(FileNotFoundError):
            stipple.emulate(self.folder / "none.npy")
        with self.assertRaisesRegex(FileNotFoundError, "there is no such file"):
            stipple.emulate(light(), "none.toml")
        self.assertEqual(self.names(), ["clip.stipple"])

    def test_digital_numbers_as_light_are_warned_of(self):
        with self.assertWarnsRegex(UserWarning, "frame 0"):
            stipple.emulate(1000 * light())
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            stipple.emulate(light())

    def test_progress_is_told_and_may_end_it(self):
        told = []
        stipple.emulate(light(), progress=lambda done, total: told.append((done, total)))
        self.assertEqual(told[-1], (30, 30))

        def stop(done, total):
            raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            stipple.emulate(light(), output=self.folder / "clip.stipple", progress=stop)
        self.assertEqual(self.names(), [])

    def test_other_threads_run_meanwhile(self):
        """Two streams are made at once, by threads that wait for each other."""
        meet = threading.Barrier(2, timeout=60)
        streams = {}

        def run(seed):
            meet.wait()
            streams[seed] = stipple.emulate(light(), seed=seed, progress=lambda *_: meet.wait())

        threads = [threading.Thread(target=run, args=(seed,)) for seed in (1, 2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for seed, stream in streams.items():
            self.same_samples(stream, stipple.emulate(light(), seed=seed))


if __name__ == "__main__":
    unittest.main()
