"""How fast a sensor reads, in Python as in the program."""

import unittest

import stipple
from program import ProgramTest


class TimingTest(ProgramTest):
    def test_figures_are_those_of_the_program(self):
        sensors = [name for name in stipple.Sensor.names() if stipple.Sensor(name).has_timing]
        self.assertIn("lux1310", sensors)
        for sensor in sensors:
            with self.subTest(sensor):
                self.assertEqual(stipple.timing(sensor, "tiled", size=(64, 128), seed=3),
                                 self.figures("timing", "--sensor", sensor, "--schedule", "tiled", "--roi", "128x64",
                                              "--seed", 3))

    def test_settings_and_the_whole_array(self):
        sensor = stipple.Sensor("lux1310", {"timing.addressing": "group", "slot_us": 2000})
        wanted = self.figures("timing", "--sensor", "lux1310", "--schedule", "hardware_tiled",
                              "--set", "sensor.timing.addressing=group", "--set", "sensor.slot_us=2000")
        self.assertEqual(stipple.timing(sensor, "hardware_tiled"), wanted)

    def test_a_schedule_has_a_size_of_its_own(self):
        schedule = stipple.Schedule("tiled", size=(64, 128))
        self.assertEqual(stipple.timing("lux1310", schedule), stipple.timing("lux1310", "tiled", size=(64, 128)))

    def test_refuses_what_the_program_refuses(self):
        with self.assertRaisesRegex(ValueError, 'sensor "paper": has no section'):
            stipple.timing("paper")
        with self.assertRaisesRegex(ValueError, "5000"):
            stipple.timing("lux1310", "tiled", size=(5000, 64))


if __name__ == "__main__":
    unittest.main()
