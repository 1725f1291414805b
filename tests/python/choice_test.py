"""Sensors and schedules are those of config/, with settings as on the command line."""

import os
import pickle
import unittest

import numpy as np
import stipple
from program import ProgramTest


class ChoiceTest(ProgramTest):
    def test_names_are_those_of_the_program(self):
        for names, kind in ((stipple.Sensor.names(), "sensors"), (stipple.Schedule.names(), "schedules")):
            listed = self.succeed("list", kind)
            self.assertTrue(names)
            for name in names:
                self.assertIn(name, listed)

    def test_settings_change_keys(self):
        sensor = stipple.Sensor("paper", {"read_noise_e": np.float64(2.5), "bit_depth": np.int64(10),
                                          "shot_noise": False, "name": "mine"})
        self.assertEqual((sensor.read_noise_e, sensor.bit_depth, sensor.shot_noise, sensor.name),
                         (2.5, 10, False, "mine"))
        self.assertAlmostEqual(sensor.gain_e_per_dn, sensor.full_scale_e / 1023)
        schedule = stipple.Schedule("tiled", {"exposure_slots": np.array([1, 3])})
        self.assertEqual(schedule.period_slots, 4)
        with self.assertRaisesRegex(ValueError, 'did you mean "read_noise_e"'):
            stipple.Sensor("paper", {"read_nois_e": 5})
        with self.assertRaises(TypeError):
            stipple.Sensor("paper", {"read_noise_e": object()})

    def test_exposures_are_the_codes_of_the_program(self):
        schedule = stipple.Schedule("two_bucket", size=(32, 32), seed=5)
        self.succeed("schedule", "make", "two_bucket", "--size", "32x32", "--seed", 5, "-o", "program.toml")
        schedule.save(self.folder / "python.toml")
        self.assertEqual((self.folder / "python.toml").read_text(), (self.folder / "program.toml").read_text())
        exposures = schedule.exposures()
        light = sum(int(mask).bit_count() for mask in exposures["open_slots"])
        rows, cols = schedule.tile
        self.assertAlmostEqual(light / (rows * cols * schedule.period_slots), schedule.light_throughput)
        self.assertAlmostEqual(len(exposures) / (rows * cols * schedule.period_slots),
                               schedule.samples_per_pixel_slot)
        self.assertEqual(schedule.charge_stores, 2)

    def test_check_says_what_the_program_says(self):
        schedule = stipple.Schedule("two_bucket")
        problem = schedule.check("paper")
        self.assertIn(problem, self.fails(1, [], "schedule", "check", "two_bucket"))
        self.assertIsNone(schedule.check(stipple.Sensor("paper", {"charge_stores": 2})))

    def test_a_schedule_for_a_sensor_suits_its_columns(self):
        light = np.full((20, 32, 64), 0.2)
        made = stipple.Schedule("hardware_tiled", size=(32, 64), sensor="lux1310")
        stream = stipple.emulate(light, "lux1310", made)
        self.assertEqual(stream.exposures().tolist(), made.exposures().tolist())

    def test_exposures_of_ones_own_must_be_legal(self):
        for message, exposures in {"exposures: give a list of at least one": [], "share|already open": [(0, 0, 0, 0b11), (0, 0, 1, 0b1)],
                                   "outside the tile": [(1, 0, 0, 1)], "period": [(0, 0, 0, 2**20 - 1)],
                                   "": [(0, 0, 0, 0b10)]}.items():
            with self.subTest(exposures), self.assertRaisesRegex(ValueError, message):
                stipple.Schedule.from_exposures(exposures, (1, 1), 6)

    def test_a_schedule_shows_itself_with_its_period(self):
        for slots, period in ((1, "1 slot"), (2, "2 slots")):
            schedule = stipple.Schedule.from_exposures([(0, 0, 0, 1)], (1, 1), slots, name="mine")
            self.assertEqual(repr(schedule), f"<stipple.Schedule mine: tile 1 x 1, period {period}>")

    def test_rows_of_exposures_are_whole_numbers_of_their_ranges(self):
        for row in ((0, 0, 0, 1.5), (0, 0, 0, -1), (0, 0, 0, 2**64), (0, 0, 2**32, 1), (2**16, 0, 0, 1), (0, 0),
                    ("a", 0, 0, 1), 3):
            with self.subTest(row), self.assertRaisesRegex(ValueError, "exposures: .* whole numbers"):
                stipple.Schedule.from_exposures([row], (1, 1), 6)
        rows = stipple.Schedule.from_exposures([(0, 0, 0, np.uint64(3))], (1, 1), 6).exposures()
        self.assertEqual(rows.tolist(), [(0, 0, 0, 3)])
        again = stipple.Schedule.from_exposures(rows, (1, 1), 6).exposures()
        self.assertEqual(again.tolist(), rows.tolist())

    def test_a_name_that_no_stream_takes_is_refused(self):
        for name in ("x" * 65, "a\nb"):
            with self.subTest(name), self.assertRaisesRegex(ValueError, "name: give at most 64 bytes"):
                stipple.Schedule.from_exposures([(0, 0, 0, 1)], (1, 1), 6, name=name)

    def test_whole_numbers_have_their_range(self):
        light = np.zeros((2, 8, 8), np.float32)
        calls = {"emulate": lambda seed: stipple.emulate(light, seed=seed), "Schedule": lambda seed: stipple.Schedule(seed=seed),
                 "timing": lambda seed: stipple.timing("lux1310", seed=seed),
                 "characterize": lambda seed: stipple.characterize(seed=seed),
                 "live": lambda seed: stipple.capture.live("replay:a.npy", seed=seed)}
        for seed in (-1, 2**64):
            for name, call in calls.items():
                with self.subTest(name), self.assertRaisesRegex(ValueError, rf"seed: {seed} is outside 0\.\.2\^64 - 1"):
                    call(seed)
        self.assertEqual(stipple.emulate(light, seed=np.uint64(2**64 - 1)).slots(), 2)
        with self.assertRaisesRegex(ValueError, "size: -1 is outside"):
            stipple.Schedule(size=(-1, 4))

    def test_values_that_no_setting_takes_are_told_as_what_they_are(self):
        for value in (float("nan"), np.float32("inf")):
            with self.assertRaisesRegex(ValueError, "read_noise_e: (?!.*is text)"):
                stipple.Sensor("paper", {"read_noise_e": value})
        for value in (10**400, 2**63, -2**63 - 1, [10**400]):
            with self.assertRaisesRegex(ValueError, r"setting bit_depth: -?\d+( [.]{3})? is outside -2\^63"):
                stipple.Sensor("paper", {"bit_depth": value})
        for value in (None, {"a": 1}, [1, None]):
            with self.assertRaisesRegex(TypeError, "setting bit_depth: .* is not a text, a number, True"):
                stipple.Sensor("paper", {"bit_depth": value})

    def test_a_size_that_no_array_has_is_a_ValueError(self):
        for size in ((0, 4), (70000, 4), (65535, 65535), (2**40, 4)):
            for make in (lambda size: stipple.Schedule.from_exposures([(0, 0, 0, 1)], (1, 1), 1, size=size),
                         lambda size: stipple.Schedule("a_rather_long_folder_name/a_long_file.toml", size=size)):
                with self.subTest(size), self.assertRaisesRegex(ValueError, "size: a frame of"):
                    make(size)

    def test_a_pickled_sensor_has_its_settings(self):
        sensor = stipple.Sensor("lux1310", {"read_noise_e": 2.5, "name": "a=b", "timing.addressing": "group"})
        again = pickle.loads(pickle.dumps(sensor))
        self.assertEqual((repr(again), again.name, again.read_noise_e), (repr(sensor), "a=b", 2.5))
        (self.folder / "mine.toml").write_text("bit_depth = 11\n")
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        pickled = pickle.dumps(stipple.Sensor("mine.toml"))
        os.chdir("/")
        self.assertEqual(pickle.loads(pickled).bit_depth, 11)

    def test_a_pickled_schedule_makes_the_same_stream(self):
        light = np.random.default_rng(1).random((20, 32, 64), dtype=np.float32)
        mine = stipple.Schedule.from_exposures([(0, 0, 0, 0b1011), (0, 1, 1, 1)], (1, 2), 4, name="mine", size=(32, 64))
        grey = stipple.Schedule.from_exposures(mine.exposures(), (1, 2), 4, weights=mine.weights() / 3, size=(32, 64))
        for schedule, sensor in ((mine, "paper"), (stipple.Schedule("random", size=(32, 64), seed=3), "paper"),
                                 (stipple.Schedule("hardware_tiled", {"tile_rows": 8}, (32, 64), 3, "lux1310"), "lux1310"),
                                 (grey, "paper")):
            with self.subTest(schedule):
                expected = stipple.emulate(light, sensor, schedule, 3)
                pickled = pickle.dumps(schedule)
                again = pickle.loads(pickled)
                self.assertEqual((again.name, again.size), (schedule.name, schedule.size))
                stream = stipple.emulate(light, sensor, again, 3)
                self.assertEqual(stream.header["schedule"], expected.header["schedule"])
                np.testing.assert_array_equal(stream.weights(), expected.weights())
                for slot in range(20):
                    np.testing.assert_array_equal(stream.samples(slot), expected.samples(slot))
        pickled = pickle.dumps(mine)
        del mine  # and its file
        self.assertEqual(pickle.loads(pickled).exposures().tolist(), [(0, 0, 0, 0b1011), (0, 1, 1, 1)])

    def test_what_is_no_name_is_a_TypeError(self):
        for message, call in {"sensor: 3 is neither": lambda: stipple.Sensor(3),
                              "schedule: None is neither": lambda: stipple.Schedule(None),
                              "key 1 of a setting": lambda: stipple.Sensor("paper", {1: 2}),
                              "setting read_noise_e: <object": lambda: stipple.Sensor("paper", {"read_noise_e": object()}),
                              r"(?s)path: array\(.* [.]{3} is neither": lambda: stipple.decode(np.zeros((9, 9, 9))),
                              "path: 3 is neither": lambda: stipple.Recording.open(3),
                              "seed: 1.5 is not a whole": lambda: stipple.emulate(np.zeros((2, 8, 8)), seed=1.5),
                              "seed: 'a' is not a whole": lambda: stipple.Schedule(seed="a"),
                              "size: '8x8' is not": lambda: stipple.Schedule(size="8x8"),
                              "method: 2 is not a text": lambda: stipple.decode("clip.stipple", 2),
                              "size: 1.5 is not a whole": lambda: stipple.timing("lux1310", size=(8, 1.5)),
                              r"video: 'a\\x00": lambda: stipple.load("a\0")}.items():
            with self.subTest(message), self.assertRaisesRegex(TypeError, message):
                call()


if __name__ == "__main__":
    unittest.main()
