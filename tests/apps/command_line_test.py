"""Help, figures, progress, exit codes."""

import fcntl
import json
import os
import pty
import re
import signal
import struct
import subprocess
import termios
import unittest
from concurrent.futures import ThreadPoolExecutor

from program import DEVICE, INPUT, OK, PROGRAM, USAGE, ProgramTest, project_path

COMMANDS = ("synth", "emulate", "decode", "compare", "info", "timing", "demo")
SPREAD = [[name] for name in ("synth", "emulate", "decode", "compare", "characterize", "demo")] + [
    ["capture", "live"], ["capture", "serve"]]
UNSPREAD = [[name] for name in ("list", "info", "recover", "timing")] + [
    ["capture", name] for name in ("list", "doctor", "record", "replay")] + [
    ["schedule", name] for name in ("make", "show", "check", "compile", "import")]
LONGER = ["synth", "still", "--frames", "9", "--size", "240x180"]
CLEAR = "\r\x1b[K"
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
            for option in ("--json", "--force", "--quiet"):
                self.assertIn(option, text)

    def test_threads_are_of_commands_that_spread_their_work(self):
        for commands, offered in ((SPREAD, True), (UNSPREAD, False)):
            for command in commands:
                self.assertEqual("--threads" in self.succeed(*command, "--help"), offered, command)
        self.fails(USAGE, ["--threads is not an option of stipple info"], "info", "a", "--threads", 2)
        self.fails(USAGE, ["--threads excludes --evaluate"], "characterize", "--evaluate", "a",
                   "--threads", 2)

    def test_help_has_several_names(self):
        self.assertEqual(self.succeed("help"), self.succeed("--help"))
        wanted = self.succeed("capture", "replay", "--help")
        for line in (["help", "capture", "replay"], ["capture", "replay", "help"]):
            self.assertEqual(self.succeed(*line), wanted)
        self.assertIn("stipple capture record", self.succeed("capture", "--help"))
        self.assertNotIn("stipple demo", self.succeed("schedule", "--help"))

    def test_text_that_cannot_be_written_is_an_error(self):
        for line in (["--help"], ["--version"], ["list", "keys"], ["list", "keys", "--json", "-"], ["completion", "bash"]):
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = self.start_program(*line, stdout=full)
                self.assertEqual(done.communicate()[1], "stipple: error: standard output: No space left on device\n",
                                 line)
            self.assertEqual(done.returncode, DEVICE)

    def test_a_reader_that_has_gone_ends_it_quietly(self):
        stream = self.write_stream()
        for line in (["list", "keys"], ["list", "keys", "--json", "-"], ["--help"], ["info", stream]):
            reader, writer = os.pipe()
            os.close(reader)
            with open(writer, "w", encoding="utf-8") as pipe:
                done = self.start_program(*line, stdout=pipe)
            self.assertEqual(done.communicate()[1], "", line)
            self.assertIn(done.returncode, (128 + signal.SIGPIPE, -signal.SIGPIPE), line)  # a shell's $? is 141

    def test_version(self):
        self.assertRegex(self.succeed("--version"), r"^stipple \d+\.\d+\.\d+\n$")
        self.assertEqual(self.succeed("-V"), self.succeed("--version"))

    def test_names_are_listed_with_a_line_each(self):
        for kind, name in (("sensors", "lux1310"), ("schedules", "two_bucket"), ("scenes", "pan"),
                           ("methods", "naive")):
            names = self.figures("list", kind)[kind]
            self.assertIn(name, [entry["name"] for entry in names])
            lines = self.succeed("list", kind).splitlines()
            self.assertEqual([line.split(maxsplit=1) for line in lines],
                             [[entry["name"], entry["text"]] for entry in names])
            self.assertTrue(all(entry["text"] and "docs/" not in entry["text"] for entry in names))
        folder = project_path("config")
        for kind in ("sensors", "schedules"):
            self.assertEqual([entry["name"] for entry in self.figures("list", kind)[kind]],
                             sorted(path.stem for path in (folder / kind).glob("*.toml")))
        self.fails(USAGE, ["KIND"], "list")

    def test_wrong_command_lines_exit_with_2(self):
        for line in ([], ["dance"], ["synth"], ["synth", "pan"], ["synth", "tango", "-o", "x"],
                     [*SYNTH, "-o", "x", "--size", "4"], [*SYNTH, "-o", "x", "--size", "7x100"],
                     [*SYNTH, "-o", "x", "--frames", "0"], [*SYNTH, "-o", "x", "--speed", "3"],
                     ["decode", "c.stipple", "-o", "x", "--method", "magic"],
                     ["compare", "a"], ["compare", "a", "b", "--margin", "-1"]):
            self.fails(USAGE, ["--help"], *line)
        for line in (["dance"], ["schedule", "dance"], ["capture", "dance", "--force"]):
            self.fails(USAGE, ['there is no subcommand "dance"; known are ', "--help"], *line)

    def test_unusable_inputs_exit_with_1_and_say_which(self):
        self.fails(INPUT, ["stipple: error: missing.stipple: "], "info", "missing.stipple")

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

    def test_json_holds_the_warnings_of_the_run(self):
        self.assertNotIn("warnings", self.figures("emulate", self.write_flat("good.npy"), "-o", "good.stipple"))
        done = self.run_program("emulate", self.write_flat("dark.npy", light=1e-5), "-o", "clip.stipple", "--json", "-")
        warnings = json.loads(done.stdout)["warnings"]
        self.assertEqual(len(warnings), 1)
        self.assertEqual(done.stderr, f"stipple: warning: {warnings[0]}\n")

    def on_a_terminal(self, *line, columns=80, term="xterm", stdout=False, code=OK, **variables):
        """What a terminal shows of a run."""
        screen, terminal = pty.openpty()
        self.addCleanup(os.close, screen)
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("4H", 24, columns, 0, 0))
        with ThreadPoolExecutor() as reader:
            shown = reader.submit(read_to_the_end, screen)
            with os.fdopen(terminal, "w") as stderr:
                done = subprocess.run([PROGRAM, *line], cwd=self.folder, timeout=60, check=False,
                                      stdout=stderr if stdout else subprocess.DEVNULL, stderr=stderr,
                                      env=dict(os.environ, TERM=term, **variables))
            self.assertEqual(done.returncode, code)
        return shown.result().decode()

    def test_progress_is_a_bar_on_a_terminal_only(self):
        self.assertNotIn("[#", self.run_program(*SYNTH, "-o", "plain.npy").stderr)
        text = self.on_a_terminal(*LONGER, "-o", "out.npy")
        self.assertRegex(text, r"\[#+-*\] \d+ %, \d/9 frames,(?: [\d.]+ frames/s,)? \d\d:\d\d:\d\d left")
        for percent, frames in re.findall(r"(\d+) %, (\d)/9 frames", text):
            # Both are cut: the work is from that percentage to the next one.
            self.assertIn(int(frames), (int(percent) * 9 // 100, (int(percent) + 1) * 9 // 100))
        self.assertTrue(text.endswith(CLEAR), "the bar is taken away at the end")

    def test_the_percentage_is_that_of_the_work_which_frames_need(self):
        # Four frames are delivered when their block of 48 slots has been computed.
        stream = self.write_stream(slots=96, rows=64, cols=96)
        text = self.on_a_terminal("decode", stream, "-o", "out.npy", "--method", "best", "--until", "4")
        shown = [int(percent) for percent in re.findall(r"\] (\d+) %, 0/4 frames, \d\d:\d\d:\d\d left", text)]
        self.assertGreater(len(set(shown)), 3)
        self.assertEqual(shown, sorted(shown))
        self.assertLess(shown[len(shown) // 2], 90)

    def test_a_long_decoding_says_first_what_it_takes(self):
        stream = self.write_stream(slots=96, rows=160, cols=160)  # 800 us a voxel: 33 min of one core
        self.addCleanup((program := self.start_program("decode", stream, "-o", "out.npy", "--method", "portz2013",
                                                       "--threads", "1")).kill)
        self.assertRegex(program.stderr.readline(),
                         r"^stipple: decoding takes about 33 min and \d{3,} MB of memory$")
        program.kill()
        program.communicate()

    def test_the_bar_fits_the_terminal(self):
        for columns in (120, 62, 50, 42, 12, 5):
            text = self.on_a_terminal(*LONGER, "-o", f"{columns}.npy", columns=columns)
            lines = [line for line in text.split(CLEAR) if line]
            self.assertTrue(lines)
            for line in lines:
                self.assertLess(len(line), columns, line)
        self.assertNotIn("[", text.replace(CLEAR, ""))

    def test_a_dumb_terminal_gets_no_bar(self):
        text = self.on_a_terminal(*LONGER, "-o", "out.npy", term="dumb")
        self.assertNotIn("\x1b", text)
        self.assertNotIn("[", text)

    def test_a_warning_takes_the_place_of_the_bar(self):
        self.succeed("capture", "record", f"replay:{self.write_flat('light.npy', 100)}", "-o", "cut.strec")
        cut = self.folder / "cut.strec"
        cut.write_bytes(cut.read_bytes()[:-10])
        text = self.on_a_terminal("capture", "record", "replay:cut.strec", "-o", "again.strec")
        self.assertRegex(text, r"recording \d+ frames[^\n]*\r\x1b\[Kstipple: [^:]*warning:\S* cut\.strec: was cut off[^\n\x1b]*\r\n")

    def test_levels_have_colours_on_a_terminal_unless_told_otherwise(self):
        failing = ["info", "none.stipple"]
        self.assertIn("stipple: \x1b[1;31merror:\x1b[0m none.stipple: ", self.on_a_terminal(*failing, code=INPUT))
        warning = ["emulate", self.write_flat("dark.npy", light=1e-5), "--force", "-o", "clip.stipple"]
        self.assertIn("stipple: \x1b[1;33mwarning:\x1b[0m clip.stipple: ", self.on_a_terminal(*warning))
        for plain in ({"NO_COLOR": "1"}, {"term": "dumb"}):
            self.assertIn("stipple: error: none.stipple: ", self.on_a_terminal(*failing, code=INPUT, **plain))
        self.assertIn("\x1b[1;31m", self.on_a_terminal(*failing, code=INPUT, NO_COLOR=""))

    def test_losses_are_shown_while_it_records(self):
        self.succeed("capture", "record", f"replay:{self.write_flat('light.npy', 100)}", "-o", "clip.strec",
                     "--set", "camera.AcquisitionFrameRate=0", "--buffers", 1024)
        clip = self.folder / "clip.strec"
        content = clip.read_bytes()
        starts = [at for at in range(len(content)) if content.startswith(b"\xc5FRM", at)]
        clip.write_bytes(content[:starts[4]] + content[starts[6]:])
        text = self.on_a_terminal("capture", "record", "replay:clip.strec", "-o", "again.strec", "--set",
                                  "camera.AcquisitionFrameRate=200")
        self.assertRegex(text, r"recording \d+ frames, 2 lost, 0 incomplete, [\d.]+ frames/s")

    def test_the_summary_stands_alone_in_its_line(self):
        text = self.on_a_terminal(*LONGER, "-o", "out.npy", stdout=True)
        self.assertIn(CLEAR + "out.npy: 9 frames", text)


if __name__ == "__main__":
    unittest.main()
