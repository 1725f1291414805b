"""decode --check-schedule: a chip that ran its schedule with a shift that the header does not know."""

import unittest

import numpy as np
from program import INPUT, USAGE, ProgramTest
from sample_stream import parts, sealed

SLOTS, ROWS, COLS = 40, 48, 64


class ScheduleCheckTest(ProgramTest):
    def setUp(self):
        super().setUp()
        random = np.random.default_rng(1)
        lengths = np.stack([random.permutation([1, 2, 4, 8]) for _ in range(64)], 1)
        self.lengths = lengths.reshape(4, 8, 8)
        slot, row, col = np.mgrid[:SLOTS, :ROWS, :COLS]
        self.write_array("light.npy", 0.3 + 0.2 * np.sin(0.3 * (col - 0.5 * slot)) * np.cos(0.2 * row))

    def record(self, name, lengths, light="light.npy"):
        """A stream with this schedule, under the same name of it."""
        self.write_array("lengths.npy", lengths)
        self.succeed("schedule", "import", "lengths.npy", "-o", "code.toml", "--lengths", "--force")
        self.succeed("emulate", light, "-o", name, "--schedule", "code.toml")
        return name

    def exchange_headers(self, header, samples, name):
        """A stream with the header of one and the packets of the other."""
        stated, run = (parts((self.folder / file).read_bytes()) for file in (header, samples))
        self.assertEqual(len(stated[0]), len(run[0]))
        (self.folder / name).write_bytes(sealed(stated[0], *run[1:]))
        return name

    def decode(self, stream, out, *arguments):
        return ("decode", stream, "-o", out, "--method", "naive", *arguments)

    def shifted_stream(self):
        self.record("stated.stipple", self.lengths)
        self.record("run.stipple", np.roll(self.lengths, (-1, 2), axis=(1, 2)))
        return self.exchange_headers("stated.stipple", "run.stipple", "clip.stipple")

    def test_a_shift_is_named_and_nothing_written(self):
        self.fails(INPUT, ["clip.stipple", "shifted by +0 slots, +1 rows, -2 columns",
                           "--check-schedule=fix"],
                   *self.decode(self.shifted_stream(), "out.npy", "--check-schedule"))

    def test_fix_decodes_with_the_shift(self):
        figures = self.figures(*self.decode(self.shifted_stream(), "out.npy",
                                            "--check-schedule=fix"))
        check = figures["schedule_check"]
        self.assertEqual((check["verdict"], check["slot_shift"], check["row_shift"],
                          check["col_shift"]), ("shifted", 0, 1, -2))
        self.assertLess(check["best_residual"], check["header_residual"] / 2)
        self.succeed(*self.decode("run.stipple", "true.npy"))
        np.testing.assert_array_equal(self.array("out.npy"), self.array("true.npy"))

    def test_the_right_schedule_is_decoded(self):
        self.record("clip.stipple", self.lengths)
        text = self.succeed(*self.decode("clip.stipple", "out.npy", "--check-schedule"))
        self.assertIn("follow the schedule", text)

    def warning_of_flat(self, level):
        self.write_flat("flat.npy", SLOTS, ROWS, COLS, level)
        self.record("clip.stipple", self.lengths, "flat.npy")
        done = self.run_program(*self.decode("clip.stipple", "out.npy", "--check-schedule"))
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr

    def test_the_dark_does_not_tell(self):
        self.assertIn("cannot tell", self.warning_of_flat(0))

    def test_saturated_samples_do_not_tell(self):
        warning = self.warning_of_flat(100)
        self.assertIn("cannot tell", warning)
        self.assertIn("saturated", warning)

    def test_another_schedule_is_refused_with_where_to_look(self):
        self.record("stated.stipple", self.lengths)
        self.record("run.stipple", self.lengths[::-1])
        stream = self.exchange_headers("stated.stipple", "run.stipple", "clip.stipple")
        self.fails(INPUT, ["do not follow the schedule", "contradict"],
                   *self.decode(stream, "out.npy", "--check-schedule"))
        done = self.run_program(*self.decode(stream, "out.npy"))
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("--check-schedule", done.stderr)

    def test_only_fix_can_be_asked_for(self):
        self.fails(USAGE, ["--check-schedule"],
                   *self.decode("clip.stipple", "out.npy", "--check-schedule=mend"))


if __name__ == "__main__":
    unittest.main()
