"""The chip behind its registers, in Python as in the program."""

import unittest
import warnings

import numpy as np
import stipple
from program import OK, ProgramTest, project_path

SENSOR = project_path("docs/examples/firmware/chip.toml")


class ChipTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.light = np.random.default_rng(1).random((9, 8, 12)).astype(np.float32)
        self.schedule = stipple.Schedule("tiled", {"tile_rows": 4, "tile_cols": 4}, size=(8, 12))

    def chip(self, name, **options):
        return stipple.Chip(self.light, self.folder / name, SENSOR, self.schedule, **options)

    def test_a_capture_is_the_emulated_stream(self):
        with self.chip("clip.stipple") as chip:
            chip.write("SLOTS", 30)
            chip.write("CONTROL", 1)
            self.assertEqual(chip.read("STATUS"), 1)
            chip.wait(100000)
            self.assertEqual((chip.read(0x44), chip.read("SLOT_COUNT")), (0, 30))
            samples = chip.read("SAMPLE_COUNT")
            self.assertEqual(chip.clocks, 100000 + 2 * 6)
        self.assertEqual(chip.outputs, [self.folder / "clip.stipple"])
        stream = stipple.Stream.open(self.folder / "clip.stipple")
        wanted = stipple.emulate(np.tile(self.light, (4, 1, 1))[:30], SENSOR, self.schedule)
        for slot in range(30):
            np.testing.assert_array_equal(stream.samples(slot), wanted.samples(slot))
        self.assertEqual(samples, sum(len(wanted.samples(slot)) for slot in range(30)))

    def test_it_has_the_clocks_of_the_program(self):
        with self.chip("a.stipple") as chip:
            chip.write("CONTROL", 1)
            chip.wait(3000)
            counts = chip.read("SLOT_COUNT"), chip.read("PACKET_COUNT")
        np.save(self.folder / "light.npy", self.light)
        done = self.run_program("chip", "light.npy", "-o", "b.stipple", "--sensor", SENSOR, "--schedule", "tiled",
                                "--set", "schedule.tile_rows=4", "--set", "schedule.tile_cols=4",
                                input="w CONTROL 1\nt 3000\nr SLOT_COUNT\nr PACKET_COUNT\n")
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertEqual(counts, tuple(int(line, 16) for line in done.stdout.split()[2:]))

    def test_errors_and_sizes(self):
        chip = self.chip("a.stipple", blank=True, tile=(8, 12), depth=20, pixel_bits=2)
        self.assertEqual([chip.read(name) for name in ("TILE_ROWS", "TILE_COLS", "DEPTH", "PIXEL_BITS", "ROWS")],
                         [8, 12, 20, 2, 0])
        for access, text in ((lambda: chip.read("STAUS"), "STATUS"), (lambda: chip.read(0x800), "is not a register"),
                             (lambda: chip.write("ID", 1), "read-only"), (lambda: chip.write("ROWS", 70000), "16 bits"),
                             (lambda: chip.write("ROWS", 1 << 32), "32 bits"), (lambda: chip.read(-1), "register"),
                             (lambda: self.chip("b.stipple", tile=(5, 4)), "divide"),
                             (lambda: stipple.Chip(self.light, "b.stipple", "paper"), "timing")):
            with self.assertRaisesRegex(ValueError, text):
                access()
        with self.assertWarnsRegex(UserWarning, "START: "):
            chip.write("CONTROL", 1)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(chip.read("ERROR"), 0x60)
            chip.finish()


if __name__ == "__main__":
    unittest.main()
