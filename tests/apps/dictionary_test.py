"""`stipple dictionary`, and the method that decodes with what it wrote."""

import unittest

import numpy as np

from program import INPUT, USAGE, ProgramTest


class DictionaryTest(ProgramTest):
    LEARN = ["--slots", 4, "--side", 3, "--atoms", 24, "--iterations", 4, "--patches", 500]

    def moving_waves(self, name, slots=16, phase=0.0):
        """Waves that run over 20 x 24 pixels."""
        slot, row, col = np.mgrid[0:slots, 0:20, 0:24]
        return self.write_array(name, 0.5 + 0.2 * np.sin(0.7 * (col + 0.5 * slot) + phase)
                                + 0.2 * np.cos(0.5 * (row - slot) + phase))

    def test_learns_and_decodes(self):
        self.moving_waves("training.npy")
        self.moving_waves("light.npy", phase=1.0)
        figures = self.figures("dictionary", "training.npy", "-o", "waves.npy", *self.LEARN)
        self.assertEqual((figures["atoms"], figures["slots"], figures["side"]), (24, 4, 3))
        self.assertEqual(figures["patches"], 500)
        self.assertTrue(np.all(np.diff(figures["errors"]) <= 1e-9))
        atoms = self.array("waves.npy")
        self.assertEqual((atoms.shape, atoms.dtype), ((24, 4, 9), np.float32))
        np.testing.assert_allclose(np.sum(atoms.astype(np.float64) ** 2, axis=(1, 2)), 1, rtol=1e-5)

        schedule = ["--schedule", "single_bump", "--set", "schedule.period_slots=4",
                    "--set", "schedule.exposure_slots=2"]
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", *schedule)
        decode = ["decode", "clip.stipple", "--method"]
        self.succeed(*decode, "naive", "-o", "naive.npy")
        dictionary = ["--set", "decoder.dictionary=waves.npy"]
        self.succeed(*decode, "hitomi2011", *dictionary, "-o", "waves_1.npy", "--threads", 1)
        self.succeed(*decode, "hitomi2011", *dictionary, "-o", "waves_3.npy", "--threads", 3)
        np.testing.assert_array_equal(self.array("waves_1.npy"), self.array("waves_3.npy"))
        light = self.array("light.npy")
        error = [np.mean((self.array(name) - light) ** 2) for name in ("naive.npy", "waves_1.npy")]
        self.assertLess(error[1], error[0] / 2)

    def test_the_same_bits_for_any_number_of_threads_and_others_for_another_seed(self):
        self.moving_waves("training.npy")
        for name, options in (("one", ["--threads", 1]), ("three", ["--threads", 3]), ("other", ["--seed", 2])):
            self.succeed("dictionary", "training.npy", "-o", f"{name}.npy", *self.LEARN, *options)
        one, three, other = ((self.folder / f"{name}.npy").read_bytes() for name in ("one", "three", "other"))
        self.assertEqual(one, three)
        self.assertNotEqual(one, other)

    def test_parts_are_of_one_dictionary(self):
        self.moving_waves("light.npy")
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--schedule", "single_bump", "--set",
                     "schedule.period_slots=4", "--set", "schedule.exposure_slots=2")
        part = ["decode", "clip.stipple", "-o", "windows", "--part", "1/1", "--method", "hitomi2011", "--set",
                "decoder.dictionary=atoms.npy"]
        atoms = np.random.default_rng(1).standard_normal((24, 4, 9))
        self.write_array("atoms.npy", atoms)
        self.succeed(*part)
        self.write_array("atoms.npy", atoms[::-1])
        self.fails(INPUT, ["windows", "another decoding"], *part)

    def test_what_cannot_be_learned_from(self):
        self.moving_waves("light.npy", slots=5)
        self.write_flat("flat.npy")
        line = ["-o", "out.npy", "--atoms", 24]
        self.fails(INPUT, ["light.npy", "has 5 frames, a patch 8", "--slots"], "dictionary", "light.npy", *line)
        self.fails(INPUT, ["light.npy", "24 x 20", "21 x 21", "--side"], "dictionary", "light.npy", *line,
                   "--slots", 4, "--side", 21)
        self.fails(INPUT, ["flat.npy", "0 patches with contrast", "24 atoms"], "dictionary", "flat.npy", *line)
        self.fails(INPUT, ["none.npy"], "dictionary", "none.npy", *line)
        self.fails(USAGE, ["--slots"], "dictionary", "light.npy", *line, "--slots", 65)
        self.fails(USAGE, ["a dictionary is a .npy"], "dictionary", "light.npy", "-o", "out.txt")

    def test_what_is_no_dictionary(self):
        self.write_stream()
        decode = ["decode", "clip.stipple", "-o", "out.npy", "--method", "hitomi2011"]
        self.fails(INPUT, ["needs a dictionary", "stipple dictionary"], *decode)
        self.write_array("five.npy", np.ones((2, 4, 5)))
        self.fails(INPUT, ["five.npy", "2 x 4 x 5", "square"], *decode, "--set", "decoder.dictionary=five.npy")
        self.write_array("zero.npy", np.zeros((2, 4, 9)))
        self.fails(INPUT, ["zero.npy", "atom 0", "is 0"], *decode, "--set", "decoder.dictionary=zero.npy")
        self.fails(INPUT, ["none.npy"], *decode, "--set", "decoder.dictionary=none.npy")


if __name__ == "__main__":
    unittest.main()
