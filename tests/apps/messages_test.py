"""What the program says of command lines and inputs that cannot be meant: the fault, and what was meant."""

import os
import shutil
import subprocess
import unittest

import numpy as np

from program import INPUT, PROGRAM, USAGE, ProgramTest


class UsageTest(ProgramTest):
    def test_a_misspelt_name_is_answered_with_what_was_meant(self):
        for wrong, meant, line in (
                ("synht", '"synth"', ["synht"]), ("lst", '"list"', ["capture", "lst"]),
                ("shwo", '"show"', ["schedule", "shwo"]), ("pna", '"pan"', ["synth", "pna", "-o", "x"]),
                ("nave", '"naive"', ["decode", "a", "-o", "x", "--method", "nave"]),
                ("SRGB", '"srgb"', ["emulate", "a", "-o", "x", "--transfer", "SRGB"]),
                ("sensor", '"sensors"', ["list", "sensor"])):
            said = self.fails(USAGE, [f'"{wrong}"', f"did you mean {meant}?"], *line)
            self.assertRegex(said, r'^stipple: error: .*\nsee "stipple[a-z ]* --help" for details\n$')
        light = self.write_flat("light.npy")
        for option, wrong, meant in (("--sensor", "papre", "paper"), ("--schedule", "randm", "random")):
            self.fails(INPUT, [f'"{wrong}"', f'did you mean "{meant}"?'], "emulate", light, "-o", "x",
                       option, wrong)

    def test_a_misspelt_option_is_named_before_what_is_missing(self):
        for wrong, meant, line in (
                ("--shcedule", "--schedule", ["emulate", "--shcedule", "foo"]),
                ("--frmes", "--frames", ["synth", "pan", "-o", "x", "--frmes", "3"]),
                ("--lum", "--luminance", ["emulate", "a", "--lum=1"]),
                ("--Frames", "--frames", ["capture", "record", "a", "--Frames", "3"])):
            command = " ".join(["stipple", *line[:2 if line[0] == "capture" else 1]])
            said = self.fails(USAGE, [f"stipple: error: {wrong} is not an option of {command}; did you mean {meant}?"],
                              *line)
            self.assertNotIn("required", said)
        self.fails(USAGE, ["-v is not an option of stipple\n"], "-v")
        self.assertNotIn("mean", self.fails(USAGE, ["--version is not an option"], "emulate", "--version"))
        self.fails(USAGE, ['--threads is not an option of stipple; write it behind "stipple synth"'],
                   "--threads", 3, "synth", "pan", "-o", "x")

    def test_words_that_are_too_many_are_named_in_their_order(self):
        self.fails(USAGE, ['"more" is more than stipple info takes'], "info", "a", "more", "words")
        self.fails(USAGE, ['"-o" is not an option behind "--"'], "emulate", "--", "s.npy", "-o", "x")
        for name in ("a.png", "b.png", "c.png"):
            self.write_png(name, [[1]])
        self.fails(USAGE, ['"b.png"', "name their folder"], "emulate", "a.png", "b.png", "c.png", "-o", "x")

    def test_options_that_are_given_wrong(self):
        self.fails(USAGE, ["--frames is given 2 times; give it once"], "synth", "pan", "-o", "x",
                   "--frames", 2, "--frames", 3)
        self.fails(USAGE, ["--output needs a value"], "synth", "pan", "--output")
        self.fails(USAGE, ["18446744073709551615 is the most"], "synth", "pan", "-o", "x", "--seed", 2**64)
        self.fails(USAGE, ["--timeout", "--follow"], "decode", "a", "-o", "x", "--timeout", 3)
        self.fails(USAGE, ["--json", "is empty"], "info", "a", "--json", "")
        self.fails(USAGE, ["FILE", "/dev/stdin"], "info", "-")
        self.fails(USAGE, ["--output", "standard output"], "emulate", "a", "-o", "-")
        self.fails(USAGE, ["--name", "64"], "schedule", "import", "a.npy", "-o", "x", "--name", "n" * 65)

    def test_ranges_are_told_as_far_as_they_go(self):
        for line, range_ in ((("synth", "pan", "-o", "x", "--seed", "x"), "whole number of 0 or more"),
                             (("capture", "replay", "x", "-o", "x.npy", "--black-level", "x"), "number of 0 or more"),
                             (("synth", "pan", "-o", "x", "--threads", "x"), "whole number from 0 to 1024"),
                             (("decode", "x", "-o", "x.npy", "--timeout", "x"), "number from 0 to 1000000")):
            self.fails(USAGE, [f'{line[-2]}: "x" is not a {range_}\n'], *line)

    def test_files_that_another_command_or_a_loop_takes(self):
        self.write_stream()
        self.fails(INPUT, ["name one of its sample streams, as ./clip.stipple"], "info", ".")
        self.fails(USAGE, ['"clip.stipple" is more than stipple decode takes; run it once for each file'], "decode",
                   "a.stipple", "clip.stipple", "-o", "x")
        self.fails(INPUT, ["none.npy: cannot be read: No such file"], "import", "none.npy", "-o", "x")

    def test_slots_in_another_unit_are_asked_about(self):
        said = self.run_program("emulate", self.write_flat("light.npy"), "-o", "clip.stipple", "--set",
                                "sensor.slot_us=0.005").stderr
        self.assertIn("slots of 0.005 us are 2e+08 a second; is slot_us in microseconds?", said)

    def test_subcommands_that_are_missing(self):
        self.fails(USAGE, ['"stipple" needs a subcommand: synth, emulate'])
        self.fails(USAGE, ['"stipple capture" needs a subcommand: list, features'], "capture")

    def test_a_full_standard_error_changes_no_exit_code(self):
        for line in (["--frmes"], ["synth", "--size", "3"], ["dance"], []):
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run([PROGRAM, *line], stderr=full, timeout=60, check=False)
            self.assertEqual(done.returncode, USAGE)


class InputTest(ProgramTest):
    def test_a_sensor_without_timing_is_told_with_those_that_have_it(self):
        light = self.write_flat("light.npy")
        for option in (["--overrun", "drop"], ["--vcd", "a.vcd"]):
            said = self.fails(INPUT, [option[0], "no section [timing]", "lux1310, "], "emulate", light, "-o",
                              "x", *option)
            self.assertNotIn("stipple timing", said)

    def test_footage_that_is_too_large_is_told_what_takes_it(self):
        for name, rows, cols in (("big.npy", 3072, 4096), ("wide.npy", 1200, 2000)):
            np.lib.format.open_memmap(self.folder / name, "w+", np.uint8, (2, rows, cols))
        self.fails(INPUT, ["4096 x 3072 pixels", "give --schedule tiled\n"], "emulate", "big.npy", "-o", "x.stipple")
        wide = ("emulate", "wide.npy", "-o", "x.stipple", "--sensor", "imx273")
        self.fails(INPUT, ["2000 x 1200 pixels (width x height)", "array of 1408 x 1080", "--crop takes a part"], *wide)
        self.succeed(*wide, "--crop", "1408x1080")

    def test_luminance_is_no_advice_where_sizes_differ(self):
        for rows, advised in ((8, True), (6, False)):
            self.write_array("a.npy", np.zeros((3, rows, 8, 3)))
            self.write_flat("b.npy", slots=3)
            said = self.fails(INPUT, ["a.npy", "b.npy"], "compare", "a.npy", "b.npy")
            self.assertEqual("--luminance" in said, advised, said)

    def test_a_file_of_another_kind_is_told_what_it_is(self):
        (self.folder / "empty.strec").touch()
        self.fails(INPUT, ["empty.strec", "empty"], "emulate", "empty.strec", "-o", "x")
        stream = self.write_stream()
        self.fails(INPUT, [stream, "stipple decode"], "emulate", stream, "-o", "x")
        self.succeed("capture", "record", "replay:light.npy", "-o", "b.strec", "--set",
                     "camera.AcquisitionFrameRate=0")
        self.fails(INPUT, ["b.strec", "recording of a camera", "capture replay"],
                   "decode", "b.strec", "-o", "x.npy")

    def test_a_file_that_may_not_be_read_is_an_input_error(self):
        folder = self.folder / "locked"
        folder.mkdir()
        shutil.copy(self.folder / self.write_flat("light.npy"), folder / "light.npy")
        folder.chmod(0)
        self.addCleanup(folder.chmod, 0o700)
        self.folder.chmod(0o777)
        options = {"user": 65534, "group": 65534} if os.getuid() == 0 else {}
        for line in (["emulate", "locked/light.npy", "-o", "x"],
                     ["capture", "serve", "locked/light.npy", "--address", "127.9.9.9"]):
            said = self.fails(INPUT, ["locked/light.npy: ", "Permission denied"], *line, **options)
            self.assertNotIn("filesystem error", said)

    def test_a_folder_that_does_not_exist_is_no_file(self):
        light = self.write_flat("light.npy")
        for line in (["emulate", light], ["capture", "record", f"replay:{light}"]):
            self.fails(INPUT, ["newdir/", "names a folder that does not exist"], *line, "-o", "newdir/")

    def test_a_stream_that_was_cut_off_is_told_so(self):
        stream = self.folder / self.write_stream(slots=12)
        whole = stream.read_bytes()
        stream.write_bytes(whole[:whole.rindex(b"\xc5SPK") + 20])
        for line in (["info", stream.name], ["decode", stream.name, "-o", "x.npy", "--force"]):
            done = self.run_program(*line)
            self.assertEqual(done.returncode, INPUT)
            self.assertIn("cut off", done.stderr)
            self.assertNotIn("0 of", done.stderr)

    def test_a_demo_that_is_too_short_for_a_sample_has_no_nan(self):
        text = self.succeed("demo", "--frames", 2, "--size", "32x24")
        self.assertNotIn("nan", text)
        self.assertNotIn("inf", text)
        self.assertIn("no sample", text)

    def test_a_diagram_shows_no_pixel_beyond_the_array(self):
        for size, pixels in (("1x1", 1), ("3x1", 3), ("640x480", 10)):
            text = self.succeed("schedule", "show", "random", "--size", size)
            self.assertEqual(text.count("("), pixels, text)
        self.assertEqual(self.succeed("schedule", "show", "full4x", "--size", "4x9").count("("), 4)


class TerminalTest(ProgramTest):
    def test_what_controls_a_terminal_is_shown_as_its_code(self):
        for text, shown in (("\x1b[31m", r"\u001b[31m"), ("\x7f", r"\u007f"), ("\u009b31m", r"\u009b31m"),
                            ("\u202e", r"\u202e"), ("\u2069", r"\u2069"), ("\u2028", r"\u2028"),
                            ("\r", r"\u000d"), ("Größe 大小 ☀", "Größe 大小 ☀")):
            done = self.run_program("info", f"a{text}b.stipple")
            self.assertEqual(done.returncode, INPUT)
            self.assertIn(f"a{shown}b.stipple: ", done.stderr)
            said = self.succeed("synth", "roll", "--frames", 3, "--size", "16x8", "-o", f"c{text}d.npy")
            self.assertIn(f"c{shown}d.npy: 3 frames of 16 x 8", said)
        done = subprocess.run([PROGRAM, "info", b"\xe9\x9b.stipple"], capture_output=True, timeout=60, check=False)
        self.assertIn(rb"\xe9\x9b.stipple: ", done.stderr)

    def test_what_a_file_says_does_not_reach_the_terminal_or_json_as_it_is(self):
        (self.folder / "s.toml").write_text('kind = "\\u001b[31m\\u202e"\n')
        done = self.run_program("schedule", "show", "s.toml")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn(r"\u001b[31m\u202e", done.stderr)
        self.write_flat("a\u202eb.npy")
        self.succeed("emulate", "a\u202eb.npy", "-o", "clip.stipple")
        self.assertIn(r"a\u202eb.npy", self.succeed("info", "clip.stipple"))
        text = self.succeed("info", "clip.stipple", "--json", "-")
        self.assertNotIn("\u202e", text)
        self.assertIn("a\u202eb.npy", self.figures("info", "clip.stipple")["provenance"])


if __name__ == "__main__":
    unittest.main()
