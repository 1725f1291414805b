"""Ctrl-C leaves a valid, shorter output."""

import signal
import subprocess
import time
import unittest

import numpy as np
from program import STOPPED, ProgramTest


class InterruptsTest(ProgramTest):
    def interrupt(self, *arguments, when):
        """Runs the program, and interrupts it once `when()` is true."""
        program = self.start_program(*arguments, stdout=subprocess.DEVNULL)
        try:
            deadline = time.monotonic() + 60
            while not when() and program.poll() is None and time.monotonic() < deadline:
                time.sleep(0.01)
            program.send_signal(signal.SIGINT)
            message = program.communicate(timeout=60)[1]
        finally:
            program.kill()
        self.assertEqual(program.returncode, STOPPED, message)
        self.assertIn("stopped", message)

    def partial_bytes(self, ending):
        return sum(path.stat().st_size for path in self.folder.rglob(f".*.partial{ending}"))

    def test_synth_leaves_the_frames_that_are_done(self):
        self.interrupt("synth", "roll", "-o", "out.npy", "--frames", 1000000, "--size", "64x48",
                       when=lambda: self.partial_bytes(".npy") > 200000)
        self.assertEqual(self.names(), ["out.npy"])
        slots = len(self.array("out.npy"))
        self.assertGreater(slots, 0)
        self.succeed("synth", "roll", "-o", "again.npy", "--frames", slots, "--size", "64x48")
        np.testing.assert_array_equal(self.array("again.npy"), self.array("out.npy"))

    def test_emulate_leaves_a_stream_of_the_slots_that_are_done(self):
        np.lib.format.open_memmap(self.folder / "light.npy", "w+", np.uint8, (1000000, 32, 32))
        self.interrupt("emulate", "light.npy", "-o", "clip.stipple",
                       when=lambda: self.partial_bytes(".stipple") > 200000)
        self.assertEqual(self.names(), ["clip.stipple", "light.npy"])
        report = self.figures("info", "clip.stipple")
        self.assertIn(report["slots"], range(1, 1000000))
        self.assertEqual(report["packets"], report["slots"])

    def test_decode_leaves_the_frames_that_are_done(self):
        self.write_stream(slots=6000)

        def frames():
            return len(list(self.folder.rglob("frame_*.exr")))

        self.interrupt("decode", "clip.stipple", "-o", "out", "--method", "naive",
                       when=frames)
        self.assertIn(frames(), range(1, 6000))
        self.assertEqual(len(list((self.folder / "out").iterdir())), frames())

    def test_compare_has_nothing_to_leave(self):
        np.lib.format.open_memmap(self.folder / "light.npy", "w+", np.uint8, (1000000, 64, 64))
        started = time.monotonic()
        self.interrupt("compare", "light.npy", "light.npy", "--json", "figures.json",
                       when=lambda: time.monotonic() > started + 0.5)
        self.assertEqual(self.names(), ["light.npy"])


if __name__ == "__main__":
    unittest.main()
