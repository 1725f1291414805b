"""Ctrl-C leaves a valid, shorter output."""

import signal
import subprocess
import time
import unittest
from pathlib import Path

import numpy as np
from program import STOPPED, ProgramTest


def catches_interrupts(process):
    """Whether the program has come so far that Ctrl-C does not end it at once."""
    for line in Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("SigCgt:"):
            return int(line.split()[1], 16) >> (signal.SIGINT - 1) & 1
    return False


class InterruptsTest(ProgramTest):
    def interrupt(self, *arguments, when=lambda: True):
        """Runs the program, and interrupts it once it listens and `when()` is true."""
        program = self.start_program(*arguments, stdout=subprocess.DEVNULL)
        try:
            deadline = time.monotonic() + 60
            while (program.poll() is None and time.monotonic() < deadline
                   and not (catches_interrupts(program) and when())):
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
        self.interrupt("compare", "light.npy", "light.npy", "--json", "figures.json")
        self.assertEqual(self.names(), ["light.npy"])


if __name__ == "__main__":
    unittest.main()
