"""Help, figures, progress, exit codes."""

import os
import pty
import subprocess
import unittest
from concurrent.futures import ThreadPoolExecutor

from program import INPUT, OK, PROGRAM, USAGE, ProgramTest

COMMANDS = ("synth", "emulate", "decode", "compare", "info", "timing", "demo")
SYNTH = ["synth", "still", "--frames", "2", "--size", "32x24"]


def read_to_the_end(screen):
    """All that is written to a terminal until nobody has it open any more."""
    text = b""
    while True:
        try:
            text += os.read(screen, 4096)
        except OSError:
            return text


class CommandLineTest(ProgramTest):
    def test_help_of_every_command_has_examples(self):
        self.assertTrue(all(command in self.succeed("--help") for command in COMMANDS))
        for command in COMMANDS:
            text = self.succeed(command, "--help")
            self.assertIn(f"Examples:\n  stipple {command}", text)
            for option in ("--json", "--threads", "--force", "--quiet"):
                self.assertIn(option, text)

    def test_version(self):
        self.assertRegex(self.succeed("--version"), r"^stipple \d+\.\d+\.\d+\n$")

    def test_wrong_command_lines_exit_with_2(self):
        for line in ([], ["dance"], ["synth"], ["synth", "pan"], ["synth", "tango", "-o", "x"],
                     [*SYNTH, "-o", "x", "--size", "4"], [*SYNTH, "-o", "x", "--size", "7x100"],
                     [*SYNTH, "-o", "x", "--frames", "0"], [*SYNTH, "-o", "x", "--speed", "3"],
                     ["decode", "c.stipple", "-o", "x", "--method", "magic"],
                     ["compare", "a"], ["compare", "a", "b", "--margin", "-1"]):
            self.fails(USAGE, ["--help"], *line)
        for line in (["dance"], ["schedule", "dance"], ["capture", "dance", "--force"]):
            self.fails(USAGE, ['there is no subcommand "dance"', "--help"], *line)

    def test_unusable_inputs_exit_with_1_and_say_which(self):
        self.fails(INPUT, ["stipple: missing.stipple: "], "info", "missing.stipple")

    def test_quiet_says_nothing(self):
        done = self.run_program(*SYNTH, "-o", "out.npy", "--quiet")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (OK, "", ""))

    def test_json_on_standard_output_is_alone_there(self):
        figures = self.figures(*SYNTH, "-o", "out.npy")
        self.assertEqual(figures["slots"], 2)
        self.assertEqual((figures["rows"], figures["cols"], figures["planes"]), (24, 32, 3))

    def test_json_file_holds_the_same_while_people_get_text(self):
        text = self.succeed(*SYNTH, "-o", "out.npy", "--json", "figures.json")
        self.assertIn("2 frames of 32 x 24", text)
        self.assertIn('"slots": 2', (self.folder / "figures.json").read_text())

    def test_progress_is_a_bar_on_a_terminal_only(self):
        self.assertNotIn("[#", self.run_program(*SYNTH, "-o", "plain.npy").stderr)
        screen, terminal = pty.openpty()
        self.addCleanup(os.close, screen)
        longer = ["synth", "still", "--frames", "9", "--size", "320x240"]
        with ThreadPoolExecutor() as reader:
            shown = reader.submit(read_to_the_end, screen)
            with os.fdopen(terminal, "w") as stderr:
                subprocess.run([PROGRAM, *longer, "-o", "out.npy"], cwd=self.folder, timeout=60,
                               stdout=subprocess.DEVNULL, stderr=stderr, check=True)
        text = shown.result().decode()
        self.assertRegex(text, r"\[#+-*\] \d/9 frames, [\d.e+]+ frames/s, \d\d:\d\d:\d\d left")
        self.assertTrue(text.endswith("\r\x1b[K"), "the bar is taken away at the end")


if __name__ == "__main__":
    unittest.main()
