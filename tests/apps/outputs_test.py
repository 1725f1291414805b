"""Outputs appear complete or not at all, and never in the place of something else."""

import os
import resource
import unittest

from program import DEVICE, INPUT, PROGRAM, USAGE, ProgramTest

SYNTH = ["synth", "roll", "--frames", "3", "--size", "64x48", "-o"]


def small_files():
    """As on a full disk: what fits is stored, then writing fails."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))


class OutputsTest(ProgramTest):
    def test_an_existing_output_is_kept_unless_forced(self):
        for name in ("out.npy", "out.mp4"):
            (self.folder / name).write_text("precious")
            self.fails(INPUT, [name, "exists already", "--force"], *SYNTH, name)
            self.assertEqual((self.folder / name).read_text(), "precious")
            self.succeed(*SYNTH, name, "--force")
            self.assertNotEqual((self.folder / name).read_bytes(), b"precious")

    def test_an_existing_stream_or_report_is_kept_unless_forced(self):
        emulate = ["emulate", self.write_flat("light.npy"), "-o", self.write_stream()]
        self.fails(INPUT, ["clip.stipple", "exists already"], *emulate)
        self.succeed(*emulate, "--force")
        (self.folder / "figures.json").touch()
        self.fails(INPUT, ["figures.json", "exists already"], "emulate", "light.npy", "-o",
                   "other.stipple", "--json", "figures.json")

    def test_an_output_that_is_an_input_is_refused_even_if_forced(self):
        self.write_stream("clip.stipple")
        self.write_flat("light.npy")
        (self.folder / "linked.npy").symlink_to("light.npy")
        emulate = ["emulate", "light.npy", "-o"]
        for words, line in (
                (["--output", "FOOTAGE"], [*emulate, "light.npy"]),
                (["--output", "FOOTAGE"], [*emulate, "./linked.npy"]),
                (["--truth", "FOOTAGE"], [*emulate, "a.stipple", "--truth", "light.npy"]),
                (["--json", "STREAM"], ["decode", "clip.stipple", "-o", "b.npy", "--json", "clip.stipple"]),
                (["--json", "RESULT"], ["compare", "light.npy", "linked.npy", "--json", "light.npy"]),
                (["--output", "ADDRESS"], ["capture", "live", "replay:light.npy", "-o", "light.npy"]),
                (["--output", "--json"], [*emulate, "a.y", "--json", "a.y"]),
                (["--vcd", "--output"], [*emulate, "a.x", "--vcd", "./a.x", "--sensor", "lux1310"])):
            before = (self.folder / "light.npy").read_bytes(), (self.folder / "clip.stipple").read_bytes()
            self.fails(USAGE, [*words, "another name"], *line, "--force")
            self.assertEqual(((self.folder / "light.npy").read_bytes(),
                              (self.folder / "clip.stipple").read_bytes()), before)
        self.succeed("emulate", "light.npy", "-o", "paper", "--sensor", "paper")  # a name, no file

    def test_an_output_whose_name_was_taken_meanwhile_is_kept_under_another(self):
        run = self.start_program("synth", "roll", "--frames", 80, "--size", "128x96", "-o", "out.npy")
        self.addCleanup(run.kill)
        while run.poll() is None and not list(self.folder.glob(".out.*")):
            pass
        (self.folder / "out.npy").write_text("precious")
        message = run.communicate(timeout=100)[1]
        self.assertEqual(run.returncode, DEVICE)
        self.assertIn("out_2.npy", message)
        self.assertEqual(self.array("out_2.npy").shape, (80, 96, 128, 3))
        self.assertEqual((self.folder / "out.npy").read_text(), "precious")

    def test_a_folder_with_other_things_in_it_is_kept_even_if_forced(self):
        self.succeed(*SYNTH, "out")
        self.fails(INPUT, ["out", "exists already"], *SYNTH, "out")
        self.succeed(*SYNTH, "out", "--force")
        (self.folder / "out/thesis.txt").touch()
        self.fails(INPUT, ["out", "thesis.txt"], *SYNTH, "out", "--force")

    def test_an_empty_folder_is_filled(self):
        (self.folder / "out").mkdir()
        self.succeed(*SYNTH, "out")
        self.assertEqual(self.names(), ["out", *(f"out/frame_000{slot}.exr" for slot in range(3))])
        (self.folder / "shown").mkdir()
        self.succeed("demo", "--frames", 6, "--size", "16x16", "-o", "shown")
        self.fails(INPUT, ["shown", "exists already"], "demo", "--frames", 6, "-o", "shown")

    def test_an_output_in_a_folder_that_does_not_exist(self):
        self.fails(INPUT, ["nowhere/out.npy", "nowhere"], *SYNTH, "nowhere/out.npy")

    def test_an_output_that_names_no_file(self):
        self.write_flat("light.npy")
        (self.folder / "clip").mkdir()
        for name in (".", "clip/"):
            self.fails(INPUT, [f'output "{name}"', "name"], "emulate", "light.npy", "-o", name)

    def test_a_video_of_any_shape(self):
        for rows, cols in ((1, 1), (1, 40), (40, 1), (40, 2), (40, 3), (5, 7)):
            self.write_stream(f"{rows}x{cols}.stipple", slots=4, rows=rows, cols=cols)
            self.succeed("decode", f"{rows}x{cols}.stipple", "-o", f"{rows}x{cols}.mp4",
                         "--method", "naive")
            (self.folder / "light.npy").unlink()

    def test_an_output_under_the_name_of_another_kind(self):
        light = self.write_flat("light.npy")
        emulate = ["emulate", light, "-o"]
        make = ["schedule", "make", "random", "-o"]
        record = ["capture", "record", f"replay:{light}", "-o"]
        for option, kind, line in (
                ("--output", "a video is a .npy, .mp4, .mkv, .y4m or .tif, or by a name without", [*SYNTH, "out.avi"]),
                ("--output", "a sample stream is a .stipple, or", [*emulate, "out.mp4"]),
                ("--output", "a sample stream is a .stipple, or", [*emulate, "out.npy", "--force"]),
                ("--truth", "a video is", [*emulate, "out", "--truth", "out.stipple"]),
                ("--vcd", "a waveform is a .vcd or .fst", ["timing", "--sensor", "vita", "--vcd", "out.txt"]),
                ("--output", "a sample stream is", ["capture", "live", f"replay:{light}", "-o", "out.strec"]),
                ("--output", "a recording is a .strec, or", [*record, "out.mp4"]),
                ("--output", "a sample stream is", [*record, "out.strec", "--coded"]),
                ("--output", "a video is", ["capture", "replay", "a.strec", "-o", "out.strec"]),
                ("--output", "a schedule is a .toml, or", [*make, "out.txt"]),
                ("--output", "a schedule is a .toml", ["schedule", "import", light, "-o", "out.npz"]),
                ("--output", "a memory image is a .mem or a .hex", ["schedule", "compile", "random", "-o", "out"]),
                ("--output", "a diagram is a .png or a .svg", ["schedule", "show", "random", "-o", "out.pdf"])):
            self.fails(USAGE, [f"{option}: out", kind], *line)
        for line in ([*SYNTH, ".npy"], [*emulate, ".STIPPLE"], ["schedule", "show", "random", "-o", ".png"]):
            self.fails(USAGE, ["--output: ." + line[-1][1:], "is an extension only"], *line)
        self.succeed(*emulate, "upper.STIPPLE")
        self.succeed(*emulate, "bare")
        self.succeed(*make, "schedule", "--size", "8x8")
        self.succeed("schedule", "compile", "tiled", "-o", "tiled.MEM")
        self.succeed(*emulate, "compiled.stipple", "--schedule", "tiled.MEM")
        os.mkfifo(self.folder / "pipe.mp4")
        self.fails(INPUT, ["pipe.mp4", "exists already"], *emulate, "pipe.mp4")

    def test_a_full_disk_is_said_and_leaves_nothing(self):
        for name in ("out", "out.npy", "out.mp4"):
            self.fails(DEVICE, [name], *SYNTH, name, preexec_fn=small_files)
        self.write_flat("light.npy", rows=64, cols=64)
        self.fails(DEVICE, ["clip.stipple", "too large"], "emulate", "light.npy", "-o",
                   "clip.stipple", preexec_fn=small_files)
        self.write_stream()
        self.fails(DEVICE, ["out.npy", "too large"], "decode", "clip.stipple", "-o", "out.npy",
                   "--method", "naive", preexec_fn=small_files)

    def test_a_full_disk_behind_standard_output_is_an_error(self):
        stream = self.write_stream()
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = self.start_program("info", stream, stdout=full)
            self.assertIn("No space left", done.communicate()[1])
        self.assertEqual(done.returncode, DEVICE, PROGRAM)

    def test_a_camera_whose_address_cannot_be_told_ends(self):
        self.succeed(*SYNTH, "light.npy")
        with open("/dev/full", "w", encoding="utf-8") as full:
            camera = self.start_program("capture", "serve", "light.npy", "--address", "127.7.7.7", stdout=full)
            self.assertIn("standard output", camera.communicate(timeout=60)[1])
        self.assertEqual(camera.returncode, DEVICE)

    def test_a_link_in_a_folder_that_the_program_fills_is_neither_followed_nor_replaced(self):
        self.write_stream(slots=64)
        (self.folder / "space.toml").write_text('[axes]\nsensor = ["paper"]\nschedule = ["tiled"]\n'
                                                'method = ["naive"]\n[clip]\nframes = 12\n')
        (self.folder / "home").mkdir()
        explore = ("explore", "space.toml", "-o", "results")
        runs = {"windows": ("decode", "clip.stipple", "-o", "windows", "--part", "1/1", "--method", "naive"),
                "pieces": ("emulate", "light.npy", "-o", "pieces", "--part", "1/1"),
                "results": explore, "results/trials": explore,
                "stages": ("decode", "clip.stipple", "-o", "out.npy", "--stages", "stages", "--method", "portz2013",
                           "--force"),
                "demo": ("demo", "-o", "demo", "--size", "48x40", "--frames", "20", "--force")}
        for folder, run in runs.items():
            self.run_program(*run)
            for path in sorted((self.folder / folder).iterdir()):
                kept = self.folder / "home" / path.name
                path.rename(kept)
                path.symlink_to(kept)
                home = {file: file.read_bytes() for file in (self.folder / "home").rglob("*") if file.is_file()}
                for more in (), ("--force",):
                    if more and "--force" in run:
                        continue
                    with self.subTest(path.name, more=more):
                        self.fails(INPUT, [f"{path.name}: is a link", "remove it"], *run, *more)
                self.assertTrue(path.is_symlink())
                self.assertEqual({file: file.read_bytes() for file in home}, home)
                path.unlink()
                kept.rename(path)
        (self.folder / "windows" / "window_000000.npy").rename(self.folder / "home" / "window.npy")
        (self.folder / "windows" / "window_000000.npy").symlink_to("../home/window.npy")
        self.fails(INPUT, ["window_000000.npy: is a link"], "join", "windows", "-o", "joined.npy")


if __name__ == "__main__":
    unittest.main()
