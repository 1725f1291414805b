"""Calibrations in Python are the files of the program, byte by byte."""

import json
import unittest

import numpy as np
import stipple
from program import ProgramTest

SIZE = (24, 32)
BENT = {"device_id": 4, "response_loss": 0.16}


class CalibrateTest(ProgramTest):
    def program_calibrates(self, *arguments):
        """Its file and its figures."""
        self.succeed("calibrate", *arguments, "-o", "program.stcal", "--json", "figures.json", "--force")
        return (self.folder / "program.stcal").read_bytes(), json.loads((self.folder / "figures.json").read_text())

    def python_calibrates(self, **arguments):
        output = self.folder / "python.stcal"
        figures = stipple.calibrate(output, force=True, **arguments)
        return output.read_bytes(), figures

    def stream(self, name, light, slots=120):
        video = np.full((slots, *SIZE), light, np.float32)
        return stipple.emulate(video, stipple.Sensor("t6", BENT), "tiled", seed=8, output=self.folder / f"{name}.stipple")

    def test_an_emulated_series(self):
        keys = [word for key, value in BENT.items() for word in ("--set", f"sensor.{key}={value}")]
        command = ("--sensor", "t6", *keys, "--size", "32x24", "--seed", 3)
        told = []
        made = self.python_calibrates(sensor=stipple.Sensor("t6", BENT), size=SIZE, seed=3,
                                      progress=lambda *now: told.append(now))
        self.assertEqual(made, self.program_calibrates(*command))
        self.assertFalse(made[1]["response"]["linear"])
        self.assertEqual(told[-1][0], told[-1][1])
        made = self.python_calibrates(sensor=stipple.Sensor("t6", BENT), size=SIZE, seed=3, levels=0, flats=30, darks=20)
        self.assertEqual(made, self.program_calibrates(*command, "--levels", 0, "--flats", 30, "--darks", 20))
        self.assertIsNone(made[1]["response"])

    def test_streams_of_a_chip(self):
        dark, dim, bright = self.stream("dark", 0), self.stream("dim", 0.3), self.stream("bright", 1.4)
        made = self.python_calibrates(dark=dark, flat=[dim, self.folder / "bright.stipple"])
        self.assertEqual(made, self.program_calibrates("--dark", "dark.stipple", "--flat", "dim.stipple", "--flat",
                                                       "bright.stipple"))
        with self.assertWarnsRegex(UserWarning, "PRNU 6 %"):
            plain = stipple.decode(bright, "naive")
        corrected = stipple.decode(bright, "naive", calibration=self.folder / "python.stcal")
        self.assertLess(corrected.std(), plain.std() / 2)

    def test_images_of_a_camera(self):
        self.succeed("characterize", "--sensor", "grasshopper", "-o", "series")
        descriptor = self.folder / "series/emva1288_data.txt"
        made = self.python_calibrates(images=descriptor, dark_current=False)
        self.assertEqual(made, self.program_calibrates("--series", descriptor, "--no-dark-current"))

    def test_a_scene(self):
        self.stream("scene", 0.4, 30)
        made = self.python_calibrates(scene=self.folder / "scene.stipple", method="naive", prnu=0.05)
        self.assertEqual(made, self.program_calibrates("--scene", "scene.stipple", "--method", "naive", "--prnu", 0.05))

    def test_what_cannot_be_calibrated_is_named(self):
        output = self.folder / "none.stcal"
        dark = self.stream("dark", 0)
        other = stipple.emulate(np.full((40, *SIZE), 0.4, np.float32), output=self.folder / "other.stipple")
        for message, arguments in (
                ("sensor: one of sensor, images, scene, and dark with flat is needed", {}),
                ("sensor: one of", {"sensor": "t6", "size": SIZE, "dark": dark}),
                ("flat: streams without light and of uniform light are both needed", {"dark": dark}),
                (r"size: \(rows, columns\) of the array are needed", {"sensor": "t6"}),
                ("flats: 0 is outside 1..65535", {"sensor": "t6", "size": SIZE, "flats": 0}),
                (r"size: \(0, 8\) is outside", {"sensor": "t6", "size": (0, 8)}),
                ("prnu: 2 is outside", {"scene": dark, "prnu": 2}),
                ("does not tell how much the gains", {"scene": other}),
                ("other.stipple: is of another sensor", {"dark": dark, "flat": other})):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                stipple.calibrate(output, **arguments)
        with self.assertRaises(FileNotFoundError):
            stipple.calibrate(output, dark=dark, flat=self.folder / "missing.stipple")
        self.assertFalse(output.exists())
        output.touch()
        with self.assertRaises(FileExistsError):
            stipple.calibrate(output, sensor="t6", size=SIZE)

    def test_progress_may_end_it(self):
        def stop(done, total):
            raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            stipple.calibrate(self.folder / "none.stcal", sensor="t6", size=SIZE, progress=stop)
        self.assertFalse((self.folder / "none.stcal").exists())


if __name__ == "__main__":
    unittest.main()
