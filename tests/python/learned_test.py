"""The methods learned and learned_fast with a refiner in Python."""

import unittest

import numpy as np
import stipple


def keep(inputs):
    return inputs[0]


class RefinerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.video = stipple.synth("pan", frames=12, size=(32, 40), luminance=True)
        cls.stream = stipple.emulate(cls.video, schedule="tiled")

    def fails(self, parts, method="learned_fast", options={}, error=ValueError, **given):
        with self.assertRaises(error) as caught:
            stipple.decode(self.stream, method, options, **given)
        for part in parts:
            self.assertIn(part, str(caught.exception))

    def test_one_that_keeps_the_estimate_leaves_it(self):
        for method, base in (("learned", "best"), ("learned_fast", "fast")):
            np.testing.assert_allclose(stipple.decode(self.stream, method, refiner=keep),
                                       stipple.decode(self.stream, base), atol=1e-6)

    def test_it_sees_each_plane_of_each_slot(self):
        colour = stipple.emulate(np.repeat(self.video[..., np.newaxis], 3, axis=3), schedule="tiled")
        shapes = []

        def refiner(inputs):
            shapes.append(inputs.shape)
            return inputs[0] + 0.01

        result = stipple.decode(colour, "learned_fast", refiner=refiner)
        self.assertEqual(shapes, [(15, 32, 40)] * 36)
        # (v + 0.01)^2 = v^2 + 0.02 v + 0.0001: too little for most samples to contradict it
        self.assertGreater(np.median(result - stipple.decode(colour, "fast")), 1e-4)

    def test_wrong_ones_are_named(self):
        self.fails(["refiner: 3 is not a function"], refiner=3)
        self.fails(["refiner: gives the shape (15, 32, 40), not (32, 40)"], refiner=lambda inputs: inputs)
        self.fails(["refiner: gives values of int64"], refiner=lambda inputs: np.zeros((32, 40), np.int64))
        self.fails(["refiner: ", "slot 0", "finite"], refiner=lambda inputs: inputs[0] * np.nan)
        self.fails(["mine"], error=KeyError, refiner=lambda inputs: {}["mine"])
        self.fails(["refiner: is for the methods learned"], method="best", refiner=keep)

    def test_weights_that_are_not_there_are_named(self):
        self.fails(["nosuch.safetensors: there is no such network"], options={"model": "nosuch.safetensors"},
                   error=FileNotFoundError)


if __name__ == "__main__":
    unittest.main()
