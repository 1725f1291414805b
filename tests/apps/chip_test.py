"""`stipple chip`: an emulated chip that is driven through its registers, by text and by firmware in C."""

import re
import shutil
import signal
import subprocess
import unittest

import numpy as np
import sample_stream
from program import INPUT, OK, PROGRAM, STOPPED, USAGE, ProgramTest, project_path

FIRMWARE = project_path("docs/examples/firmware")
ROWS, COLS, TILE = 8, 12, 4
SENSOR = ("--sensor", FIRMWARE / "chip.toml")
SCHEDULE = ("--schedule", "tiled", "--set", "schedule.tile_rows=4", "--set", "schedule.tile_cols=4")


class ChipFolder(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write_array("light.npy", np.random.default_rng(1).random((9, ROWS, COLS)))
        self.write_array("long.npy", np.tile(self.array("light.npy"), (20, 1, 1)))

    def chip(self, *options):
        return ("chip", "light.npy", "-o", "clip.stipple", *SENSOR, *SCHEDULE, *options)

    def samples(self, name):
        packets = sample_stream.samples((self.folder / name).read_bytes())
        return [packet for packet in packets if packet[4] == 1]

    def write_text(self, name, text):
        (self.folder / name).write_text(text)


class ChipTest(ChipFolder):
    def ask(self, *requests, options=(), warnings=()):
        """The answers to these requests."""
        done = self.run_program(*self.chip(*options), input="".join(line + "\n" for line in requests))
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), len(warnings), done.stderr)
        for text in warnings:
            self.assertIn(text, done.stderr)
        return done.stdout.splitlines()

    def test_the_preset_chip_is_the_emulated_sensor(self):
        answers = self.ask("r ID", "w SLOTS 30", "w CONTROL 1", "r STATUS", "t 100000", "r STATUS", "r SLOT_COUNT",
                           "r PACKET_COUNT", "r SAMPLE_COUNT", "r OVERRUN_COUNT", "r ERROR")
        self.assertEqual(answers[:6], ["0x53504C31", "ok", "ok", "0x00000001", "ok", "0x00000000"])
        figures = self.figures("emulate", "long.npy", "-o", "expected.stipple", "--frames", ":30", *SENSOR, *SCHEDULE)
        self.assertEqual([int(answer, 16) for answer in answers[6:]],
                         [30, 30, figures["samples"], figures["readout"]["overrun_slots"], 0])
        self.assertGreater(figures["readout"]["overrun_slots"], 0)
        self.assertEqual(self.samples("clip.stipple"), self.samples("expected.stipple"))

    def test_a_swapped_chip_is_the_switched_sensor(self):
        """Bank 1 gets the frames of two slots that all pixels share, a word for each row and slot."""
        words = [f"w MEMORY_DATA {word}" for word in [0] * TILE + [15] * TILE]
        answers = self.ask("w MEMORY_ADDRESS 0x80000000", *words, "w BANK_PERIOD[1] 2", "w CONTROL 1", "t 4000",
                           "w CONTROL 4", "t 4000", "r SWAP_SLOT", "r STATUS", "w CONTROL 2", "t 4000", "r SLOT_COUNT")
        swap, slots = int(answers[-5], 16), int(answers[-1], 16)
        self.assertEqual(answers[-4], "0x0000000B")
        program = "\n".join(["// stipple sequencer program, version 1", "// tile_rows = 1", "// tile_cols = 1",
                             "// period_slots = 2", "// bits_per_pixel = 1", "@0", *("01" if swap % 2 == 0 else "10")])
        self.write_text("other.mem", program + "\n")
        self.succeed("emulate", "long.npy", "-o", "expected.stipple", "--frames", f":{slots}", *SENSOR, *SCHEDULE,
                     "--switch", f"{swap}:schedule={self.folder}/other.mem")
        self.assertEqual(self.samples("clip.stipple"), self.samples("expected.stipple"))

    def test_the_end_of_the_requests_stops_a_capture(self):
        self.ask("w CONTROL 1", "t 5000")
        self.assertIn("complete", self.succeed("info", "clip.stipple"))
        self.ask("w CONTROL 1", options=("--force",))

    def test_a_signal_does_too(self):
        chip = self.start_program(*self.chip(), stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        for request in ("w CONTROL 1", "t 5000"):
            chip.stdin.write(request + "\n")
            chip.stdin.flush()
            self.assertEqual(chip.stdout.readline(), "ok\n")  # at once
        chip.send_signal(signal.SIGINT)
        self.assertEqual(chip.wait(60), STOPPED)
        chip.communicate()
        self.assertIn("complete", self.succeed("info", "clip.stipple"))

    def test_requests_that_are_wrong_are_answered(self):
        for request, text in (("r STAUS", 'did you mean "STATUS"?'), ("r BANK_PERIOD[2]", "has the places 0 to 1"),
                              ("w ROWS", "is not r REGISTER, w REGISTER VALUE or t CLOCKS"), ("", "is not r REGISTER"),
                              ("w ROWS x", "is not a number of 32 bits"), ("w ROWS 70000", "has 16 bits, at most 65535"),
                              ("w ID 1", "is read-only"), ("r 0x800", "is not a register"), ("x" * 5000, "is not r REGISTER"),
                              ("w MEMORY_ADDRESS 64", "ok")):
            answer = self.ask(request)[0]
            self.assertIn(text, answer)
            self.assertEqual(answer.startswith("error "), text != "ok")

    def test_a_command_that_is_refused_says_why(self):
        answers = self.ask("w ROWS 9", "w CONTROL 1", "r ERROR", "w ERROR 0x20", "r ERROR",
                           warnings=["START: ROWS: 9 is not 1 to 8"])
        self.assertEqual(answers, ["ok", "ok", "0x00000020", "ok", "0x00000000"])

    def test_what_the_chip_cannot_be_is_refused(self):
        self.fails(INPUT, ["[timing]"], "chip", "light.npy", "-o", "a.stipple")
        self.fails(INPUT, ["does not divide", "5 x 4"], *self.chip("--tile", "5x4"))
        self.fails(INPUT, ["are more than the 2 of a bank"], *self.chip("--depth", 2))
        self.fails(USAGE, ["--pixel-bits", "4"], *self.chip("--pixel-bits", 4))
        self.fails(USAGE, ["--json", "standard output"], *self.chip("--json", "-"))
        two = ("chip", "light.npy", "-o", "a.stipple", *SENSOR, "--schedule", "two_bucket")
        self.fails(INPUT, ["charge store"], *two)

    def test_a_second_file_is_refused_unless_forced(self):
        self.write_text("clip.stipple", "")
        done = self.run_program(*self.chip(), input="w CONTROL 1\n")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("clip.stipple", done.stderr)


class FirmwareTest(ChipFolder):
    """The example in C: a period of 4 slots in bank 0, of 2 in bank 1; see firmware.c."""

    def setUp(self):
        super().setUp()
        compiler = shutil.which("cc") or self.skipTest("no C compiler")
        subprocess.run([compiler, "-std=c11", "-D_POSIX_C_SOURCE=200809L", "-Wall", "-Wextra", "-Wpedantic", "-Werror",
                        "-I", project_path("readout"), *sorted(FIRMWARE.glob("*.c")), "-o", self.folder / "firmware"],
                       check=True)

    def program(self, name, period, first):
        """Slot t of the stream is slot (t + first) mod period of the firmware's program."""
        words = [sum(((slot + first + row + col) % period == period - 1) << col for col in range(TILE))
                 for slot in range(period) for row in range(TILE)]
        sizes = [f"// tile_rows = {TILE}", f"// tile_cols = {TILE}", f"// period_slots = {period}", "// bits_per_pixel = 1"]
        self.write_text(name, "\n".join(["// stipple sequencer program, version 1", *sizes, "@0",
                                         *(f"{word:x}" for word in words)]) + "\n")
        return self.folder / name

    def expected_samples(self, slots, swap):
        """Of slots that are all before the swap, or all but the first ones."""
        rows, cols = np.indices((ROWS, COLS))
        early = [((slot + rows + cols) % 4 == 3) & (slot >= 3) for slot in range(min(slots, swap))]
        return sum(map(np.sum, early)) + sum(np.sum((slot - swap + rows + cols) % 2 == 1) for slot in range(swap, slots))

    def run_firmware(self, *options):
        done = subprocess.run([self.folder / "firmware", "--", PROGRAM, *self.chip("--blank", *options)],
                              cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (OK, ""), done.stdout)
        return done.stdout

    def test_its_transcript_and_files_are_those_of_the_model(self):
        for options in ((), ("--pixel-bits", "2"), ("--tile", "12x8", "--force")):
            said = self.run_firmware(*options, "--force")
            numbers = re.search(r"capture: (\d+) slots, \1 packets, (\d+) samples, (\d+) overruns, swap at slot (\d+)", said)
            slots, samples, overruns, swap = map(int, numbers.groups())
            self.assertEqual(said.splitlines()[:2],
                             ["chip: 12 x 8 pixels, 2 channels, 10 bits",
                              "single shot: 1 slots, 1 packets, 0 samples, 0 overruns, swap at slot 0"])
            self.assertEqual(said.splitlines()[3:], ["bank 1, errors 0x00"])
            self.assertGreater(slots, swap + 3)
            self.assertEqual(samples, self.expected_samples(slots, swap))
            figures = self.figures(
                "emulate", "long.npy", "-o", "expected.stipple", "--frames", f":{slots}", *SENSOR, "--force",
                "--schedule", self.program("first.mem", 4, 0),
                "--switch", f"{swap}:schedule={self.program('second.mem', 2, -swap % 2)}")
            self.assertEqual(overruns, figures["readout"]["overrun_slots"])
            self.assertEqual(self.samples("clip-2.stipple"), self.samples("expected.stipple"))
            self.assertEqual(len(self.samples("clip.stipple")), 1)

    def test_it_says_what_is_wrong(self):
        done = subprocess.run([self.folder / "firmware", "--", "cat"], cwd=self.folder, capture_output=True, text=True,
                              timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertIn("ID is 0x00000000", done.stdout)


if __name__ == "__main__":
    unittest.main()
