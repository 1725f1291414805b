"""What the network of the methods learned and learned_fast was trained on: training/."""

import os
import sys
import unittest
from pathlib import Path

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


if __name__ == "__main__":
    unittest.main()
