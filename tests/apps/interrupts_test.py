"""Ctrl-C leaves a valid, shorter output."""

import os
import signal
import subprocess
import time
import unittest
from pathlib import Path

import numpy as np
from program import INPUT, PROGRAM, STOPPED, ProgramTest

FRAME_BYTES = 64 * 48 * 3 * 4  # of `synth --size 64x48`


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
        return message

    def partial_bytes(self, ending):
        return sum(path.stat().st_size for path in self.folder.rglob(f".*.partial{ending}"))

    def test_synth_leaves_the_frames_that_are_done(self):
        self.interrupt("synth", "roll", "-o", "out.npy", "--frames", 1000000, "--size", "64x48",
                       when=lambda: self.partial_bytes(".npy") > 200000)
        self.assertEqual(self.names(), ["out.npy"])
        slots = len(self.array("out.npy"))
        self.assertGreaterEqual(slots, 200000 // FRAME_BYTES)
        self.succeed("synth", "roll", "-o", "again.npy", "--frames", slots, "--size", "64x48")
        np.testing.assert_array_equal(self.array("again.npy"), self.array("out.npy"))

    def test_synth_stops_within_a_frame(self):
        self.interrupt("synth", "pan", "-o", "out.npy", "--frames", 1, "--size", "4096x4096", "--threads", 1)
        self.assertEqual(self.names(), [])

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

    def test_decode_that_has_no_frame_yet_says_that_nothing_is_written(self):
        self.write_stream(slots=40, rows=160, cols=160)
        started = time.monotonic()
        message = self.interrupt("decode", "clip.stipple", "-o", "out.npy", "--method", "best",
                                 when=lambda: self.partial_bytes(".npy") or
                                 time.monotonic() > started + 1)
        self.assertIn("stopped; nothing is written", message)
        self.assertEqual(self.names(), ["clip.stipple", "light.npy"])

    def test_the_search_for_cameras_ends_without_a_word_of_its_libraries(self):
        message = self.interrupt("capture", "list", when=lambda: True)
        self.assertEqual(message.strip().splitlines()[1:], ["stipple: stopped"])

    def endless(self, **options):
        """A run that goes on until it is told to stop, once it listens and has written something."""
        program = self.start_program("synth", "roll", "-o", "out.npy", "--frames", 1000000, "--size",
                                     "64x48", **options)
        self.addCleanup(program.kill)
        deadline = time.monotonic() + 60
        while not (catches_interrupts(program) and self.partial_bytes(".npy") > 50000):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)
        return program

    def test_signals_that_come_together_are_one(self):
        # `timeout` signals the program, then the group that it is in. Several threads handle the
        # signals at once, the first one slowest.
        program = self.endless(env=os.environ | {"LD_PRELOAD": os.environ["SLOW_HANDLER_LIBRARY"]})
        for number in (signal.SIGTERM, signal.SIGTERM, signal.SIGINT):
            program.send_signal(number)
            time.sleep(0.05)
        message = program.communicate(timeout=60)[1]
        self.assertIn(program.returncode, (STOPPED, 143), message)
        self.assertGreaterEqual(len(self.array("out.npy")), 50000 // FRAME_BYTES)

    def test_the_message_names_the_second_signal_that_stops_at_once(self):
        for number, said in ((signal.SIGTERM, "stipple: stopping when this step is done; a second signal stops at once\n"),
                             (signal.SIGINT, "\nstipple: stopping when this step is done; a second Ctrl-C stops at once\n")):
            program = self.endless()
            program.send_signal(number)
            message = program.communicate(timeout=60)[1]
            self.assertTrue(message.startswith(said), message)
            (self.folder / "out.npy").unlink()

    def test_a_terminal_that_closes_leaves_a_shorter_output_too(self):
        program = self.endless()
        program.send_signal(signal.SIGHUP)
        message = program.communicate(timeout=60)[1]
        self.assertEqual(program.returncode, 129, message)
        self.assertEqual(self.names(), ["out.npy"])

    def test_a_second_signal_ends_the_run_and_says_where_its_data_are(self):
        # One frame takes seconds, and only between frames does the run look for a signal.
        np.lib.format.open_memmap(self.folder / "light.npy", "w+", np.uint8, (4, 8000, 8000))
        program = self.start_program("emulate", "light.npy", "-o", "out.stipple", "--schedule", "full1x", "--set",
                                     "schedule.period_slots=1", "--threads", 1, "--max-memory", "8G")
        self.addCleanup(program.kill)
        deadline = time.monotonic() + 60
        while not (catches_interrupts(program) and list(self.folder.glob(".out.*"))):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)
        time.sleep(0.5)  # the first frame has begun
        program.send_signal(signal.SIGINT)
        time.sleep(0.7)
        program.send_signal(signal.SIGINT)
        message = program.communicate(timeout=60)[1]
        self.assertEqual(program.returncode, -signal.SIGINT, message)
        partial = next(self.folder.glob(".out.*.partial.stipple")).name
        self.assertIn(f"what was written so far: {partial}", message.replace("./", ""))

    def test_standard_error_that_cannot_be_written_ends_no_run(self):
        colour = self.write_png("f.png", np.full((8, 8, 3), 99))
        self.assertIn("looks gamma-coded", self.run_program("emulate", colour, "-o", "heard.stipple").stderr)
        for screen in ("full", "closed", "unread"):
            with self.subTest(screen):
                reader, writer = os.pipe()
                os.close(reader)
                closed = {"preexec_fn": lambda: os.close(2)}
                with open("/dev/full", "w") as full, os.fdopen(writer, "w") as unread:
                    options = {"full": {"stderr": full}, "unread": {"stderr": unread}, "closed": closed}
                    done = subprocess.run([PROGRAM, "emulate", colour, "-o", f"{screen}.stipple"],
                                          cwd=self.folder, timeout=120, check=False,
                                          stdout=subprocess.DEVNULL, **options[screen])
                    self.assertEqual(done.returncode, 0)
                    self.assertEqual((self.folder / f"{screen}.stipple").read_bytes(),
                                     (self.folder / "heard.stipple").read_bytes())
                    missing = subprocess.run([PROGRAM, "info", "missing"], cwd=self.folder, timeout=60,
                                             check=False, **options[screen])
                    self.assertEqual(missing.returncode, INPUT)

    def test_compare_has_nothing_to_leave(self):
        np.lib.format.open_memmap(self.folder / "light.npy", "w+", np.uint8, (1000000, 64, 64))
        self.interrupt("compare", "light.npy", "light.npy", "--json", "figures.json")
        self.assertEqual(self.names(), ["light.npy"])


if __name__ == "__main__":
    unittest.main()
