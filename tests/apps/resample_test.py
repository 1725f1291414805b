"""Slots of footage of another frame rate, and its exposure."""

import unittest

import numpy as np
from program import INPUT, OK, USAGE, ProgramTest

SLOT = ("--set", "sensor.slot_us=1000")


class ResampleTest(ProgramTest):
    def light(self, footage, *options):
        """The light that was emulated. What was said stands in self.said."""
        done = self.run_program("emulate", footage, "-o", "clip.stipple", "--truth", "truth.npy", "--force", "-q",
                                *SLOT, *options)
        self.assertEqual(done.returncode, OK, done.stderr)
        self.said = done.stderr
        return self.array("truth.npy")

    def ramp(self, slots=12):
        """Light that rises by 0.1 in a frame; a frame is its mean light."""
        return self.write_array("ramp.npy", np.broadcast_to(0.05 + 0.1 * np.arange(slots)[:, None, None],
                                                            (slots, 20, 24)))

    def test_twice_the_rate(self):
        light = self.light(self.ramp(), "--frames-hz", 500, "--resample", "hold")[:, 0, 0]
        np.testing.assert_allclose(light, 0.05 + 0.1 * (np.arange(24) // 2), rtol=1e-6)
        for method in ("blend", "flow"):
            light = self.light(self.ramp(), "--frames-hz", 500, "--resample", method)[:, 0, 0]
            self.assertEqual(len(light), 24)
            np.testing.assert_allclose(light[4:-4], (0.1 * (np.arange(24) + 0.5) / 2)[4:-4], rtol=1e-5)
            self.assertEqual(self.said, "")

    def test_half_the_rate_and_rates_without_a_common_divisor(self):
        for method in ("blend", "flow"):
            for hz in (2000, 1700, 3333):
                light = self.light(self.ramp(), "--frames-hz", hz, "--resample", method)[:, 0, 0]
                self.assertEqual(len(light), int(12 * 1000 / hz))
                middles = 0.1 * hz / 1000 * (np.arange(len(light)) + 0.5)
                np.testing.assert_allclose(light[1:-1], middles[1:-1], rtol=1e-5)

    def test_flow_moves_edges(self):
        slots = np.arange(8)[:, None, None]
        cols = np.arange(64)[None, None, :] - 4 * slots
        rows = np.arange(32)[None, :, None]
        texture = lambda shift: 1 + 0.5 * np.sin((cols - shift) / 3 + rows / 5) + 0.3 * np.sin((cols - shift) / 7)
        name = self.write_array("moving.npy", texture(0))
        errors = {}
        for method in ("hold", "blend", "flow"):
            light = self.light(name, "--frames-hz", 500, "--resample", method)
            # The slots 2 j + 1 and 2 j + 2 are a quarter of a frame after the middle of frame j, and three.
            wanted = texture(1)[1:-2]
            errors[method] = np.sqrt(np.mean((light[3:-4:2] - wanted)[:, 6:-6, 10:-10] ** 2))
        self.assertLess(errors["flow"], 0.05)
        self.assertLess(4 * errors["flow"], errors["blend"])

    def test_scale_is_a_factor_on_the_light(self):
        light = self.light(self.ramp(), "--scale", 3, "--max-value", 2)[:, 0, 0]
        np.testing.assert_allclose(light, np.minimum(3 * (0.05 + 0.1 * np.arange(12)), 2), rtol=1e-6)

    def test_the_stream_says_how_it_was_made(self):
        self.light(self.ramp(), "--frames-hz", 500, "--resample", "blend", "--scale", 0.5)
        info = self.figures("info", "clip.stipple")
        self.assertIn("--scale 0.5 --resample blend --frames-hz 500", info["command"])
        first = (self.folder / "clip.stipple").read_bytes()
        self.succeed(*info["command"].split()[1:])
        self.assertEqual((self.folder / "again.stipple").read_bytes(), first)

    def test_what_cannot_be_resampled(self):
        for options, parts in ((["--resample", "blend"], ["ramp.npy: does not declare its frame rate", "--frames-hz"]),
                               (["--resample", "hold", "--frames-hz", 10], None)):
            if parts:
                self.fails(INPUT, parts, "emulate", self.ramp(), "-o", "x.stipple", *SLOT, *options)
        self.fails(INPUT, ["ramp.npy: is shorter than a slot"], "emulate", self.ramp(), "-o", "x.stipple", *SLOT,
                   "--resample", "blend", "--frames-hz", 1e6)
        self.fails(USAGE, ["--resample"], "emulate", self.ramp(), "-o", "x.stipple", "--resample", "cubic")
        self.fails(USAGE, ["--scale"], "emulate", self.ramp(), "-o", "x.stipple", "--scale", 0)

    def test_rates_that_give_no_slots_or_without_end_are_refused(self):
        (self.folder / "clip.raw").write_bytes(bytes(512))
        for method in ("hold", "blend", "flow"):
            for hz in ("1e-300", "1e-3", "1e12", "1e300"):
                with self.subTest(method=method, hz=hz):
                    self.fails(INPUT, ["clip.raw: has ", "frames/s", "--frames-hz"], "emulate", "clip.raw", "--raw",
                               f"16x16:mono8:hz={hz}", "-o", "x.stipple", *SLOT, "--resample", method)

    def test_factors_that_are_no_light_are_refused(self):
        for value in ("1e-50", "1e50", "nan", "1e400"):
            for option in ("--scale", "--max-value"):
                self.fails(USAGE, [option, value], "emulate", self.ramp(), "-o", "x.stipple", option, value)
        self.write_array("bright.npy", np.full((2, 4, 4), 100.0))
        self.fails(INPUT, ["bright.npy: frame 0: light becomes infinite by --scale 1e+37"], "emulate", "bright.npy", "-o",
                   "x.stipple", "--scale", "1e37")

    def test_the_rate_of_the_command_line_replaces_that_of_the_file(self):
        self.light(self.ramp(), "--frames-hz", 500)
        self.assertIn("ramp.npy: has 500 frames/s, but a slot", self.said)
        self.light(self.ramp(), "--frames-hz", 1000)
        self.assertEqual(self.said, "")


if __name__ == "__main__":
    unittest.main()
