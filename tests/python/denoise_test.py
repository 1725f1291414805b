"""The method plug_and_play with a denoiser in Python, and the denoiser of best."""

import gc
import os
import signal
import sys
import unittest

import numpy as np
import stipple
from onnx_file import convolution
from program import ProgramTest

SHORT = {"iterations": 7, "motion_every": 4, "match_every": 3, "mosaic.iterations": 4,
         "mosaic.near_iterations": 2, "direct.iterations": 4, "noise_free.iterations": 4}


def clip(slots=20, planes=None, rows=24, cols=32):
    """A bar that moves a pixel a slot."""
    frames = np.full((slots, rows, cols), 0.2, np.float32)
    for slot in range(slots):
        frames[slot, :, slot % cols] = 0.9
    if planes:
        frames = np.stack([frames, frames[:, ::-1], frames / 2], axis=3)
    return frames


def decode(stream, denoiser, options={}, **others):
    return stipple.decode(stream, "plug_and_play", {**SHORT, **options}, denoiser=denoiser, **others)


def smooth(video, sigma):
    """Of the frames before and after a third each."""
    before, after = np.roll(video, 1, axis=0), np.roll(video, -1, axis=0)
    return (before + video + after) / 3


class PlugAndPlayTest(unittest.TestCase):
    def test_the_filter_of_best_has_its_bits(self):
        cases = {
            "two blocks": stipple.emulate(clip(70)),
            "colour": stipple.emulate(clip(planes=3)),
            "mosaic": stipple.emulate(clip(planes=3), stipple.Sensor("t6")),
            "frames of a slot": stipple.emulate(clip(), schedule="full1x"),
            "without noise": stipple.emulate(clip(), "ideal"),
        }
        for name, stream in cases.items():
            with self.subTest(name):
                np.testing.assert_array_equal(decode(stream, stipple.denoise), stipple.decode(stream, "best", SHORT))

    def test_it_has_so_by_arrays(self):
        """Not by a short cut: what goes through Python may be changed there."""
        stream = stipple.emulate(clip())
        best = stipple.decode(stream, "best", SHORT)

        def through(video, sigma, step):
            return np.array(stipple.denoise(video.astype(np.float64), sigma, step))

        def halved(video, sigma, step):
            return stipple.denoise(video, sigma / 2, step)

        np.testing.assert_array_equal(decode(stream, through), best)
        self.assertFalse(np.array_equal(decode(stream, halved), best))

    def test_a_denoiser_that_knows_the_truth_gives_it_back(self):
        """The last iteration ends with it: x = z^2 / 4 - offset."""
        for planes in (None, 3):
            truth = clip(planes=planes)
            stabilised = 2 * np.sqrt(truth + 0.5)
            if planes:  # to luma and two opponents
                matrix = np.array([[1, 1, 1], [1, 0, -1], [1, -2, 1]]) / np.sqrt([[3], [2], [6]])
                stabilised = stabilised @ matrix.T
            result = decode(stipple.emulate(truth), lambda video, sigma: stabilised, {"light_offset": 0.5})
            np.testing.assert_allclose(result, truth, atol=3e-6)

    def test_what_it_sees(self):
        """The estimate of step.light on the scale 2 sqrt(light + offset); sigma falls geometrically."""
        sigmas, memories, pilots = [], [], []

        def look(video, sigma, step):
            self.assertEqual((video.dtype, sigma), (np.float32, step.sigma))
            np.testing.assert_allclose(video, 2 * np.sqrt(np.maximum(step.light, 0) + 0.5), rtol=1e-6)
            memories.append(step.memory.setdefault("first", step.iteration))
            if step.iteration == 0:
                np.testing.assert_array_equal(step.pilot, video)
            else:
                np.testing.assert_array_equal(step.pilot, pilots[-1])
            sigmas.append(sigma)
            pilots.append(smooth(video, sigma))
            return pilots[-1]

        options = {"light_offset": 0.5, "first_sigma": 0.4, "last_noise": 0, "min_sigma": 0.025, "iterations": 5}
        decode(stipple.emulate(clip(70)), look, options)
        np.testing.assert_allclose(sigmas, 2 * [0.4, 0.2, 0.1, 0.05, 0.025], atol=2.0**-20)  # two blocks
        self.assertEqual(memories, 10 * [0])

    def test_the_video_is_the_denoisers_own(self):
        stream = stipple.emulate(clip())
        kept = []

        def in_place(video, sigma):
            kept.append(video)
            result = smooth(video, sigma)
            video[:] = np.nan
            return result

        np.testing.assert_array_equal(decode(stream, in_place), decode(stream, smooth))
        self.assertTrue(all(np.isnan(video).all() for video in kept))

    def test_the_same_bits_for_any_number_of_threads(self):
        stream = stipple.emulate(clip())
        for denoiser in (smooth, stipple.denoise):
            np.testing.assert_array_equal(decode(stream, denoiser, threads=1), decode(stream, denoiser, threads=3))

    def test_what_it_raises_ends_the_decoding(self):
        stream = stipple.emulate(clip())

        class OwnError(Exception):
            pass

        def fails(video, sigma, step):
            if step.iteration == 2:
                raise OwnError("in iteration 2")
            return video

        def stops(video, sigma):
            raise KeyboardInterrupt

        def signalled(video, sigma):
            os.kill(os.getpid(), signal.SIGINT)
            return video

        for denoiser, error in ((fails, OwnError), (stops, KeyboardInterrupt), (signalled, KeyboardInterrupt)):
            references = sys.getrefcount(denoiser)
            with self.subTest(denoiser.__name__), self.assertRaises(error):
                decode(stream, denoiser)
            gc.collect()
            self.assertEqual(sys.getrefcount(denoiser), references)
        self.assertEqual(decode(stream, smooth).shape, (20, 24, 32))

    def test_refuses_what_is_no_video(self):
        stream = stipple.emulate(clip())
        shape = r"denoiser: gives the shape \(1, 24, 32\), not \(20, 24, 32\)"
        for result, message in (
                (lambda video: video[:1], shape),
                (lambda video: None, "denoiser: gives NoneType"),
                (lambda video: video.astype(int), "denoiser: gives values of int64"),
                (lambda video: video * 1j, "denoiser: gives values of complex64"),
                (lambda video: video * np.nan, "denoiser: its result has the value nan in slot 0, row 0"),
                (lambda video: video * np.float32(1e20), "denoiser: its result has the value .* at most 1e9")):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                decode(stream, lambda video, sigma: result(video))
        last = np.zeros((20, 24, 32))
        last[19, 23, 31] = np.inf
        with self.assertRaisesRegex(ValueError, "value inf in slot 19, row 23, column 31"):
            decode(stream, lambda video, sigma: last)

    def test_refuses_other_arguments(self):
        stream = stipple.emulate(clip())
        with self.assertRaisesRegex(ValueError, "denoiser: plug_and_play needs one"):
            stipple.decode(stream, "plug_and_play")
        with self.assertRaisesRegex(ValueError, "denoiser: 3 is not a function"):
            decode(stream, 3)
        with self.assertRaisesRegex(ValueError, "denoiser: is for the method plug_and_play, not for best"):
            stipple.decode(stream, "best", denoiser=smooth)
        with self.assertRaisesRegex(ValueError, "iteration"):
            decode(stream, smooth, {"iteration": 5})

    def test_a_step_ends_with_its_call(self):
        steps = []

        def keep(video, sigma, step):
            steps.append(step)
            return video

        decode(stipple.emulate(clip()), keep)
        for ask in (lambda: steps[0].light, lambda: steps[0].iteration,
                    lambda: stipple.denoise(clip(), 0.1, steps[0])):
            with self.assertRaisesRegex(ValueError, "step: belongs to a call that has ended"):
                ask()

    def test_a_step_is_of_its_video(self):
        def other(video, sigma, step):
            return stipple.denoise(video[:5], sigma, step)

        with self.assertRaisesRegex(ValueError, "video: has another shape than that of the step"):
            decode(stipple.emulate(clip()), other)


class NetworkTest(ProgramTest):
    def test_a_network_is_as_its_function(self):
        """Three frames and the noise map through 3 x 3 weights; sides are filled up to 24 x 32."""
        weights = np.random.default_rng(5).normal(0, 0.02, (1, 4, 3, 3)).astype(np.float32)
        weights[0, 1, 1, 1] += 0.9
        (self.folder / "net.onnx").write_bytes(convolution(weights))

        def network(video, sigma):
            slots, rows, cols = video.shape
            channels = np.pad(video, ((1, 1), (0, 24 - rows), (0, 32 - cols)), mode="edge")
            channels = np.pad(channels.astype(np.float64), ((0, 0), (1, 1), (1, 1)))
            noise = np.pad(np.full((24, 32), sigma), 1)
            result = np.zeros((slots, rows, cols))
            for row, col in np.ndindex(3, 3):
                for frame in range(3):
                    result += weights[0, frame, row, col] * channels[frame:frame + slots, row:row + rows, col:col + cols]
                result += weights[0, 3, row, col] * noise[row:row + rows, col:col + cols]
            return result

        for planes in (None, 3):
            stipple.emulate(clip(planes=planes, rows=20, cols=27), output=self.folder / "clip.stipple", force=True)
            settings = [f"decoder.{key}={value}" for key, value in SHORT.items()]
            self.succeed("decode", "clip.stipple", "-o", "net.npy", "--force", "--method", "plug_and_play",
                         *(word for setting in [*settings, "decoder.denoiser=net.onnx", "decoder.denoiser_frames=3"]
                           for word in ("--set", setting)))

            def planewise(video, sigma):
                return np.stack([network(video[..., plane], sigma) for plane in range(3)], axis=3)

            result = decode(self.folder / "clip.stipple", planewise if planes else network)
            np.testing.assert_allclose(self.array("net.npy"), result, rtol=1e-3, atol=1e-4)
            options = {**SHORT, "denoiser": str(self.folder / "net.onnx"), "denoiser_frames": 3}
            np.testing.assert_array_equal(
                stipple.decode(self.folder / "clip.stipple", "plug_and_play", options), self.array("net.npy"))
        with self.assertRaisesRegex(ValueError, "denoiser: is given twice"):
            stipple.decode(self.folder / "clip.stipple", "plug_and_play", options, denoiser=network)


class DenoiseTest(unittest.TestCase):
    def test_takes_noise_out(self):
        for planes in (None, 3):
            truth = clip(planes=planes)
            noisy = truth + 0.1 * np.random.default_rng(3).standard_normal(truth.shape).astype(np.float32)
            result = stipple.denoise(noisy, 0.1)
            self.assertEqual((result.dtype, result.shape), (np.float32, truth.shape))
            self.assertLess(np.mean((result - truth) ** 2), 0.1 * np.mean((noisy - truth) ** 2))
            np.testing.assert_array_equal(stipple.denoise(noisy, 0.1, threads=1), result)

    def test_refuses(self):
        for video, sigma, message in (
                (np.zeros((2, 8, 8), int), 1, "video: has dtype int64"),
                (np.zeros((8, 8)), 1, "video: has the shape"),
                (np.zeros((0, 8, 8)), 1, "video: has the shape"),
                (np.full((2, 8, 8), np.nan), 1, "video: has values that are not finite"),
                (np.zeros((2, 5, 8)), 1, "video: has 8 x 5 pixels"),
                (np.zeros((2, 8, 8)), 0, "sigma: 0 is not above 0"),
                (np.zeros((2, 8, 8)), np.nan, "sigma: nan is not above 0")):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                stipple.denoise(video, sigma)
        with self.assertRaisesRegex(ValueError, "passes: 0 is not above 0"):
            stipple.denoise(np.zeros((2, 8, 8)), 1, passes=0)


if __name__ == "__main__":
    unittest.main()
