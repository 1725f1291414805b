"""`stipple decode --method plug_and_play` with a network. The Python module's test compares it with a function."""

import unittest

import numpy as np

from onnx_file import convolution
from program import INPUT, ProgramTest


class PlugAndPlayTest(ProgramTest):
    DECODE = ["decode", "clip.stipple", "--method", "plug_and_play", "--set", "decoder.iterations=3"]
    NET = ["--set", "decoder.denoiser=net.onnx"]

    def write_network(self, weights, name="net.onnx", **shape):
        (self.folder / name).write_bytes(convolution(np.asarray(weights, np.float32), **shape))

    def write_clip(self, rows=20, cols=28, slots=20):
        rng = np.random.default_rng(1)
        self.write_array("light.npy", 0.2 + 0.6 * rng.random((slots, rows, cols)))
        self.succeed("emulate", "light.npy", "-o", "clip.stipple")

    def test_a_network_has_the_same_bits_for_any_number_of_threads(self):
        self.write_clip()
        self.write_network(np.full((1, 2, 5, 5), 0.02))
        for threads in (1, 3):
            self.succeed(*self.DECODE, *self.NET, "-o", f"{threads}.npy", "--threads", threads)
        np.testing.assert_array_equal(self.array("1.npy"), self.array("3.npy"))
        self.assertTrue(np.all(np.isfinite(self.array("1.npy"))))

    def test_parts_are_of_one_network(self):
        self.write_clip()
        part = [*self.DECODE, *self.NET, "-o", "windows", "--part", "1/1"]
        self.write_network([[[[0.9]], [[0.0]]]])
        self.succeed(*part)
        self.write_network([[[[0.8]], [[0.0]]]])
        self.fails(INPUT, ["windows", "another decoding"], *part)

    def test_what_is_no_denoiser(self):
        self.write_clip()
        decode = [*self.DECODE, "-o", "out.npy"]
        self.fails(INPUT, ["plug_and_play: has no denoiser", "decoder.denoiser"], *decode)
        self.fails(INPUT, ["net.onnx: there is no such network"], *decode, *self.NET)
        for content in (b"", b"no network", convolution(np.ones((1, 2, 3, 3)))[:-30]):
            (self.folder / "net.onnx").write_bytes(content)
            said = self.fails(INPUT, ["net.onnx: is not a network in ONNX that OpenCV reads"], *decode, *self.NET)
            self.assertEqual(said.count("\n"), 1, said)
        self.fails(INPUT, ["denoiser_frames", "2 is even"], *decode, *self.NET, "--set",
                   "decoder.denoiser_frames=2")

    def test_a_network_of_other_shapes_is_told_what_is_wanted(self):
        self.write_clip()
        decode = [*self.DECODE, "-o", "out.npy", *self.NET]
        wanted = "net.onnx: as a denoiser takes 1 x 2 x 24 x 32 (1 frame and the noise map, rows, columns)"
        for weights, shape, reason in (
                (np.ones((1, 4, 3, 3)), {}, "decoder.denoiser_frames"),    # sees three frames
                (np.ones((2, 2, 3, 3)), {}, "it gives 1 x 2 x 24 x 32"),   # gives two
                (np.ones((1, 2, 2, 2)), {}, "it gives 1 x 1 x 25 x 33")):
            self.write_network(weights, **shape)
            said = self.fails(INPUT, [wanted, reason], *decode)
            self.assertEqual(said.count("\n"), 1, said)
        self.write_network(np.full((1, 4, 1, 1), 0.25))
        self.succeed(*decode, "--set", "decoder.denoiser_frames=3")

    def test_values_that_are_not_finite_end_it(self):
        self.write_clip()
        self.write_network([[[[np.nan]], [[0.0]]]])
        self.fails(INPUT, ["denoiser: its result has the value nan in slot 0, row 0, column 0"], *self.DECODE,
                   *self.NET, "-o", "out.npy")


if __name__ == "__main__":
    unittest.main()
