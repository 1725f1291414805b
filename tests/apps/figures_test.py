"""tests/bench/docs/figures.py: the images of docs/concept.md come from the program."""

import contextlib
import importlib.machinery
import importlib.util
import io
import shutil
import struct
import unittest
from pathlib import Path

import numpy as np

from program import PROGRAM, ProgramTest, project_path

LOADER = importlib.machinery.SourceFileLoader("figures", str(project_path("tests/bench/docs/figures.py")))
figures = importlib.util.module_from_spec(importlib.util.spec_from_loader("figures", LOADER))
LOADER.exec_module(figures)


class FiguresTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.program = figures.Program(Path(PROGRAM), self.folder)

    def test_exposures_follow_each_other_without_gaps(self):
        self.assertEqual(figures.code_exposures("aAAaa.", 6), [(1, 1), (2, 3)])
        self.assertEqual(figures.code_exposures("aaAaaA", 6), [(2, 3), (5, 3)])
        pixels, period = self.program.exposures("random", "5x3")
        self.assertEqual((len(pixels), period), (15, 15))
        for exposures in pixels:
            self.assertEqual(sorted(slots for _, slots in exposures), [1, 2, 4, 8])
            for (first, slots), (following, _) in zip(exposures, exposures[1:] + exposures[:1]):
                self.assertEqual((first + slots) % period, following)

    def test_the_timing_diagram_in_the_documentation_is_the_program_s(self):
        figures.timing(self.program, self.folder)
        drawn = (self.folder / "timing.svg").read_text()
        self.assertEqual(drawn, (project_path("docs/figures") / "timing.svg").read_text(),
                         "run tests/bench/docs/figures.py timing, and look whether docs/concept.md still says what it shows")

    def test_samples_of_a_slot_are_the_light_of_their_exposures(self):
        # No noise, 8 bits for light 0 to 8 of all slots together: a sample is off by at most half a DN.
        light = np.random.default_rng(1).random((20, 3, 12, 16), np.float32)
        np.save(self.folder / "light.npy", light.transpose(0, 2, 3, 1))
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--set", "sensor.shot_noise=false", "--set",
                     "sensor.read_noise_e=0", "--set", "sensor.full_scale_e=8000")
        figures.SIZE = "16x12"
        samples = figures.samples_of_slot(self.program, "clip.stipple", 15, (12, 16, 3))
        mean = np.cumsum(light[15::-1].transpose(0, 2, 3, 1), 0) / np.arange(1, 17)[:, None, None, None]
        nearest = np.abs(mean[[0, 1, 3, 7]] - samples).min(0)
        read = np.isfinite(samples)
        self.assertTrue(0.15 < read.mean() < 0.4, read.mean())
        self.assertLess(nearest[read].max(), 8 / 255 / 2 + 1e-6)

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_the_strip_has_five_images_and_their_details(self):
        figures.SIZE, figures.FRAMES, figures.SHOWN = "32x24", "12", 8
        figures.CROP, figures.DETAILS = (slice(0, 24), slice(0, 32)), {"red": (slice(8, 14), slice(8, 16))}
        text = io.StringIO()
        with contextlib.redirect_stdout(text):
            figures.strip(self.program, self.folder)
        self.assertEqual(len(text.getvalue().splitlines()), 7)
        head = (self.folder / "strip.png").read_bytes()[:24]
        self.assertEqual(struct.unpack(">II", head[16:]), (5 * (32 + 8) + 8, 44 + 2 * (24 + 8)))


if __name__ == "__main__":
    unittest.main()
