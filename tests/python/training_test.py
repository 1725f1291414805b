"""What the network of the methods learned and learned_fast was trained on: training/."""

import os
import sys
import unittest
from importlib.machinery import SourceFileLoader
from importlib.util import find_spec
from pathlib import Path
from unittest import mock

import numpy as np
import stipple

TRAINING = Path(__file__).resolve().parents[2] / "training"
sys.path.insert(0, str(TRAINING))
from frame_hash import frame_hashes, least_distance  # noqa: E402


class FramesTest(unittest.TestCase):
    def test_a_frame_is_known_in_another_size_light_and_noise(self):
        video = stipple.synth("pan", frames=40, size=(128, 192), luminance=True)
        small = video.reshape(40, 64, 2, 96, 2).mean((2, 4))
        random = np.random.default_rng(1)
        hashes = frame_hashes(video)
        for other in (small, 0.25 * video, np.sqrt(video), video + random.normal(0, 0.002, video.shape)):
            self.assertLessEqual(least_distance(hashes[:1], frame_hashes(other[:1])), 3)
        self.assertGreater(least_distance(hashes, frame_hashes(np.flip(video, 2))), 8)

    @unittest.skipUnless(os.environ.get("STIPPLE_FOOTAGE"), "STIPPLE_FOOTAGE is not set")
    def test_no_frame_of_the_evaluation_has_been_trained_on(self):
        trained = np.array([list(bytes.fromhex(line.split()[1]))
                            for line in (TRAINING / "frames.txt").read_text().splitlines()], np.uint8)
        clips = [path.parent for path in Path(os.environ["STIPPLE_FOOTAGE"]).glob("*/meta.json")]
        self.assertGreater(len(clips), 0)
        for clip in clips:
            with self.subTest(clip.name):
                hashes = frame_hashes(stipple.load(clip, luminance=True))
                self.assertEqual(least_distance(hashes, hashes[:1]), 0)
                self.assertGreater(least_distance(hashes, trained), 8)


class Brightening:
    """Scenes of even light that rises with time."""

    def clip(self, random, slots, side):
        return np.repeat(np.linspace(0.1, 0.2, slots, dtype=np.float32), side * side).reshape(slots, side, side)


@unittest.skipUnless(all(map(find_spec, ("torch", "scipy", "PIL"))), "python3-torch, -scipy or -pil is not installed")
class ItemsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.train = SourceFileLoader("train", str(TRAINING.parent / "scripts" / "train")).load_module()
        cls.train.SIDE = 24

    def expect_light_of_inputs(self, item):
        """Light by the first input is the truth, in its unit: of each frame, and of slots amid the others."""
        inputs = item["inputs"].astype(np.float64)
        light = (inputs[:, 0] ** 2 - self.train.offset_of(inputs)).mean((1, 2))
        inner = slice(6, -6) if len(light) == self.train.SLOTS else slice(None)
        np.testing.assert_allclose(light[inner], item["truth"].mean((1, 2))[inner], rtol=0.06)

    def test_the_truth_has_the_unit_of_the_inputs(self):
        for schedule in self.train.SCHEDULES:
            settings = {"SCHEDULES": {schedule: 1}, "SENSORS": {"paper": 1}, "NOISE_FREE": 0, "LIGHT": (0.8, 1.2)}
            with self.subTest(schedule), mock.patch.multiple(self.train, **settings):
                self.expect_light_of_inputs(self.train.make_item(Brightening(), 7))

    def test_also_without_noise(self):
        with mock.patch.object(self.train, "NOISE_FREE", 1):
            self.expect_light_of_inputs(self.train.make_item(Brightening(), 7))


if __name__ == "__main__":
    unittest.main()
