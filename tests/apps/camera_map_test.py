"""tests/bench/docs/camera_map.py: its scene, its lens and its verdict."""

import importlib.machinery
import importlib.util
import unittest
from unittest import mock

import numpy as np

from program import project_path

LOADER = importlib.machinery.SourceFileLoader("camera_map", str(project_path("tests/bench/docs/camera_map.py")))
camera_map = importlib.util.module_from_spec(importlib.util.spec_from_loader("camera_map", LOADER))
LOADER.exec_module(camera_map)


@mock.patch.object(camera_map, "SLOTS", 4)
class CameraMapTest(unittest.TestCase):
    def test_motion_has_its_root_mean_square_and_a_common_half(self):
        velocity = camera_map.velocities(3, 100000, np.random.default_rng(1))
        self.assertAlmostEqual(np.mean(np.sum(velocity ** 2, axis=1)), 9, delta=0.1)
        self.assertAlmostEqual(np.sum(np.mean(velocity, axis=0) ** 2), 4.5, delta=0.1)

    def test_still_leaves_do_not_change_and_moving_ones_do(self):
        still = camera_map.leaves(0, 1)
        np.testing.assert_allclose(still[1:], still[:-1])
        self.assertGreater(np.mean(np.diff(camera_map.leaves(2, 1), axis=0) != 0), 0.5)

    def test_the_lens_has_the_transfer_function_of_a_gaussian(self):
        """A grating of 8 pixels: exp(-2 pi^2 sigma^2 f^2)."""
        points = np.arange(camera_map.TORUS * camera_map.FINE)
        grating = np.cos(2 * np.pi * points / (8 * camera_map.FINE))
        video = np.broadcast_to(grating, (camera_map.SLOTS, len(points), len(points)))
        sharp, soft = (np.ptp(camera_map.filmed(video, blur)) for blur in (0, 1))
        self.assertAlmostEqual(soft / sharp, np.exp(-2 * np.pi ** 2 / 64), places=5)

    def test_the_verdict_is_that_of_paired_differences(self):
        systems = {name: np.zeros(5) for name in camera_map.CODED + camera_map.FRAMES}
        systems["hardware best"] = np.array([31.0, 32, 33, 34, 35])
        systems["1x vbm4d"] = np.array([30.0, 30, 32, 32, 34])  # 1, 2, 1, 2, 1 below: variance 0.3
        verdict = camera_map.verdict(systems)
        self.assertEqual(verdict[:2], ("hardware best", "1x vbm4d"))
        self.assertAlmostEqual(verdict[2], 1.4)
        self.assertAlmostEqual(verdict[3], 2.776 * np.sqrt(0.3 / 5))
        self.assertEqual(camera_map.told(verdict), "hardware best 1.4 ± 0.7")
        self.assertEqual(camera_map.told(("a", "b", -0.3, 0.5)), "(b 0.3 ± 0.5)")


if __name__ == "__main__":
    unittest.main()
