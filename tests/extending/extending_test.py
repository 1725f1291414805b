"""The five changes of docs/extending.md, applied to a copy of the project, build, and work."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
PARTS = os.environ["STIPPLE_READS"].split(":")  # what the program is built of


class ExtendingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="stipple_")))
        cls.copy = cls.folder / "stipple"
        for part in map(Path, PARTS):
            if ROOT not in part.parents or ROOT / "build" in part.parents:
                continue
            target = cls.copy / part.relative_to(ROOT)
            target.parent.mkdir(parents=True, exist_ok=True)
            (shutil.copytree if part.is_dir() else shutil.copy)(part, target)
        for diff in sorted(cls.copy.glob("docs/extending/*.diff")):
            subprocess.run(["git", "apply", diff], cwd=cls.copy, check=True)
        environment = os.environ | ({"CMAKE_CXX_COMPILER_LAUNCHER": "ccache"} if shutil.which("ccache") else {})
        for command in (["cmake", "--preset", "release", "-DSTIPPLE_TESTS=OFF", "-DSTIPPLE_BENCH=OFF"],
                        ["scripts/build", "release", "stipple"]):
            subprocess.run(command, cwd=cls.copy, check=True, env=environment)
        cls.run_copy("synth", "still", "-o", "clip.npy", "--frames", 24, "--size", "48x32")

    @classmethod
    def run_copy(cls, *arguments):
        """The figures of a run."""
        done = subprocess.run([cls.copy / "build/release/stipple", *map(str, arguments), "--json", "-"],
                              cwd=cls.folder, capture_output=True, text=True, timeout=120)
        if done.returncode != 0:
            raise AssertionError(done.stderr)
        return json.loads(done.stdout)

    def test_a_schedule(self):
        figures = self.run_copy("emulate", "clip.npy", "-o", "schedule.stipple", "--schedule", "short_long")
        # In 8 slots a pixel of each pair reads 8 samples or 1: 4.5 on average.
        self.assertAlmostEqual(figures["compression_ratio"], 8 / 4.5)

    def test_a_sensor_key(self):
        whole = ("emulate", "clip.npy", "--sensor", "ideal", "--schedule", "tiled", "-o")
        quarter = (*whole, "quarter.stipple", "--set", "sensor.fill_factor=0.25")
        self.run_copy(*quarter)
        self.run_copy(*whole, "whole.stipple")
        per_unit = [self.run_copy("info", name)["calibration"]["electrons_per_unit"]
                    for name in ("quarter.stipple", "whole.stipple")]
        self.assertAlmostEqual(per_unit[0], per_unit[1] / 4)
        self.assertIn("sensor.fill_factor=0.25", self.run_copy("info", "quarter.stipple")["command"])

    def test_a_decoding_method(self):
        still = np.full((16, 24, 40), 0.5, np.float32)
        np.save(self.folder / "still.npy", still)
        self.run_copy("emulate", "still.npy", "-o", "still.stipple", "--sensor", "ideal")
        self.run_copy("decode", "still.stipple", "-o", "mean.npy", "--method", "mean")
        np.testing.assert_allclose(np.load(self.folder / "mean.npy"), still, atol=1e-3)

    def test_a_kind_of_camera(self):
        self.run_copy("capture", "record", "pattern:64x48", "--frames", 5, "-o", "ramp.strec")
        self.run_copy("emulate", "ramp.strec", "-o", "ramp.stipple", "--truth", "ramp.npy")
        ramp = np.arange(64) + np.arange(5)[:, None]
        np.testing.assert_allclose(np.load(self.folder / "ramp.npy")[:, 7], ramp / 255, rtol=1e-6)

    def test_a_command(self):
        self.run_copy("emulate", "clip.npy", "-o", "command.stipple")
        self.assertAlmostEqual(self.run_copy("duration", "command.stipple")["duration_s"], 24 * 5e-3)


if __name__ == "__main__":
    unittest.main()
