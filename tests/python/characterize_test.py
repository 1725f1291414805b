"""EMVA 1288 figures in Python are those of the program, of the same images."""

import json
import unittest

import numpy as np
import stipple
from program import ProgramTest


def listed(figures):
    """As JSON has them."""
    return figures | {"photon_transfer": figures["photon_transfer"].tolist()}


class CharacterizeTest(ProgramTest):
    def program_characterizes(self, *arguments):
        self.succeed("characterize", *arguments, "-o", "series", "--json", "figures.json")
        return json.loads((self.folder / "figures.json").read_text())

    def test_figures_are_those_of_the_program(self):
        """Emulated, read from the files of the program, and given as arrays."""
        wanted = self.program_characterizes("--sensor", "grasshopper", "--set", "sensor.dsnu_e=4", "--seed", 3)
        sensor = stipple.Sensor("grasshopper", {"dsnu_e": 4})
        told = []
        emulated = stipple.characterize(sensor, 3, progress=lambda *now: told.append(now))
        self.assertEqual(listed(emulated), wanted)
        self.assertEqual(told[-1], (302, 302))

        del wanted["configured"]
        wanted["notes"] = []  # they compare with what is configured
        descriptor = self.folder / "series/emva1288_data.txt"
        self.assertEqual(listed(stipple.characterize_images(descriptor)), wanted)
        self.assertEqual(listed(stipple.characterize_images(self.stacks(descriptor), bits=12)), wanted)

    def stacks(self, descriptor):
        """What a descriptor lists, as arrays. Light is DN / 65535."""
        light = stipple.load(descriptor.parent / "image_%04d.png")
        images = iter(np.rint(light * 65535).astype(np.uint16))
        groups = []
        for line in descriptor.read_text().splitlines()[2:]:
            kind, *words = line.split()
            if kind == "i":
                groups[-1][2].append(next(images))
            else:
                groups.append((float(words[0]), float(words[1]) if kind == "b" else 0.0, []))
        return [(time, photons, np.array(stack)) for time, photons, stack in groups]

    def test_what_cannot_be_evaluated_is_named(self):
        with self.assertRaisesRegex(ValueError, 'sensor "ideal": .*more light'):
            stipple.characterize("ideal")
        with self.assertRaisesRegex(ValueError, "unequal transmittance"):
            stipple.characterize(stipple.Sensor("ideal", {"transmittance": [0.5]}))
        with self.assertRaises(FileNotFoundError):
            stipple.characterize_images(self.folder / "none.txt")
        pair = np.zeros((2, 3, 4), np.uint16)
        for message, images, bits in (
                (r"images\[0\]: is neither uint8 nor uint16", [(1.0, 0.0, pair.astype(int))], 12),
                (r"images\[1\]: is not an array \(image, row, col\)", [(1.0, 0.0, pair), (1.0, 5.0, pair[0])], 12),
                (r"images\[0\]: is not an array", [(1.0, 0.0, pair[:, :0])], 12),
                (r"bits: 17 is outside 1..16", [(1.0, 0.0, pair)], 17),
                (r"images\[0\]\[1\]: holds the DN 300", [(1.0, 0.0, pair + [[[0]], [[300]]])], 8),
                (r"images\[0\]\[0\]: is 4 x 3, but", [(1.0, 0.0, pair), (1.0, 5.0, pair[:, :2])], 8),
                (r"images: ", [], 8)):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                images = [(time, photons, dn if dn.dtype == int and "neither" in message else dn.astype(np.uint16))
                          for time, photons, dn in images]
                stipple.characterize_images(images, bits)

    def test_a_black_level_that_is_too_low_is_a_warning(self):
        """Normal noise of 3 DN around 0 is cut off at 0 in half of the dark values."""
        random = np.random.default_rng(2)

        def images(count, photons):
            electrons = random.poisson(photons, (count, 32, 32)) + random.normal(0, 3, (count, 32, 32))
            return (1.0, float(photons), np.clip(np.rint(electrons), 0, 255).astype(np.uint8))

        series = [images(2, photons) for photons in range(0, 285, 15)]
        series += [images(10, 125), images(10, 0)]
        with self.assertWarnsRegex(UserWarning, "black level is too low"):
            figures = stipple.characterize_images(series, bits=8)
        self.assertTrue(figures["biased"])
        self.assertAlmostEqual(figures["measured"]["gain_dn_per_e"], 1, delta=0.1)
        self.assertAlmostEqual(figures["measured"]["quantum_efficiency"], 1, delta=0.1)

    def test_progress_may_end_it(self):
        def stop(done, total):
            raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            stipple.characterize("grasshopper", progress=stop)


if __name__ == "__main__":
    unittest.main()
