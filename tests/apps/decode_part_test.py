"""Parts of a decoding, in windows that are joined: the bytes of one run."""

import json
import signal
import time
import unittest

import numpy as np
from program import INPUT, USAGE, ProgramTest

NAIVE = ("--method", "naive")


class DecodePartTest(ProgramTest):
    def decode_part(self, part, *more, stream="clip.stipple"):
        return self.figures("decode", stream, "-o", "windows", "--part", part, *NAIVE, *more)

    def expect_bytes_of_one_run(self, *method, stream="clip.stipple"):
        self.succeed("decode", stream, "-o", "whole.npy", *(method or NAIVE))
        self.succeed("join", "windows", "-o", "joined.npy")
        self.assertEqual((self.folder / "joined.npy").read_bytes(), (self.folder / "whole.npy").read_bytes())

    def test_parts_in_any_order_make_the_bytes_of_one_run(self):
        # 160 slots: two windows of 48 and a last one of 64, as a remainder of 16 belongs to it.
        self.write_stream(slots=160, rows=20, cols=28)
        for method in ("naive", "fast"):
            with self.subTest(method):
                for part in ("3/3", "1/3", "2/3"):
                    self.succeed("decode", "clip.stipple", "-o", "windows", "--part", part, "--method", method)
                self.assertEqual(sorted(path.name for path in (self.folder / "windows").iterdir()),
                                 ["decoding.json"] + [f"window_{i:06d}.npy" for i in range(3)])
                self.assertEqual([len(self.array(f"windows/window_{i:06d}.npy")) for i in range(3)], [48, 48, 64])
                self.expect_bytes_of_one_run("--method", method)
                for name in ("windows", "joined.npy", "whole.npy"):
                    (self.folder / name).rename(self.folder / f"{method}_{name}")

    def test_the_joined_video_has_any_format(self):
        # In colour: a window has its planes last, as a .npy of footage.
        self.succeed("synth", "pan", "-o", "light.npy", "--frames", 70, "--size", "32x24")
        self.succeed("emulate", "light.npy", "-o", "clip.stipple")
        self.decode_part("1/1")
        self.expect_bytes_of_one_run()
        self.succeed("join", "windows", "-o", "joined", "--images", "tiff")
        self.succeed("decode", "clip.stipple", "-o", "whole", *NAIVE, "--images", "tiff")
        for path in (self.folder / "whole").iterdir():
            self.assertEqual((self.folder / "joined" / path.name).read_bytes(), path.read_bytes())

    def test_killed_at_any_moment_it_goes_on_where_it_was(self):
        self.write_stream(slots=960, rows=48, cols=48)
        for windows in (0, 1, 3, 8, 14):
            program = self.start_program("decode", "clip.stipple", "-o", "windows", "--part", "1/1", *NAIVE)
            deadline = time.monotonic() + 60
            while (program.poll() is None and time.monotonic() < deadline
                   and len(list(self.folder.glob("windows/window_*.npy"))) < windows):
                time.sleep(0.0005)
            program.send_signal(signal.SIGKILL)
            program.communicate(timeout=60)
        kept = len(list(self.folder.glob("windows/window_*.npy")))
        self.assertGreaterEqual(kept, 14)
        figures = self.decode_part("1/1")
        self.assertEqual(figures["windows"], 20)
        self.assertEqual(figures["windows_decoded"], 20 - kept)
        self.assertEqual([name for name in self.names() if ".partial" in name and "window_" in name], [])
        self.expect_bytes_of_one_run()

    def test_only_missing_and_broken_windows_are_decoded_again(self):
        self.write_stream(slots=480)
        self.assertEqual(self.decode_part("1/1")["windows_decoded"], 10)
        self.assertEqual(self.decode_part("1/1")["windows_decoded"], 0)
        windows = self.folder / "windows"
        (windows / "window_000002.npy").unlink()
        (windows / "window_000007.npy").write_bytes((windows / "window_000007.npy").read_bytes()[:-1])
        (windows / "window_000009.npy").write_bytes(b"")
        self.fails(INPUT, ["lacks 3 of its 10 windows: window_000002.npy, window_000007.npy, window_000009.npy",
                           "decode again"], "join", "windows", "-o", "joined.npy")
        self.assertEqual(self.decode_part("1/1")["windows_decoded"], 3)
        self.assertEqual(self.decode_part("1/1", "--force")["windows_decoded"], 10)
        self.expect_bytes_of_one_run()

    def test_more_parts_than_windows_leave_some_parts_without(self):
        self.write_stream(slots=100)
        decoded = [self.decode_part(f"{part}/5")["windows"] for part in range(1, 6)]
        self.assertEqual(sorted(decoded), [0, 0, 0, 1, 1])
        self.expect_bytes_of_one_run()

    def test_a_stream_without_end_is_decoded_as_far_as_it_goes(self):
        self.write_stream(slots=200)
        content = (self.folder / "clip.stipple").read_bytes()
        (self.folder / "cut.stipple").write_bytes(content[:len(content) * 3 // 4])
        for part in ("2/2", "1/2"):
            self.decode_part(part, stream="cut.stipple")
        self.run_program("decode", "cut.stipple", "-o", "whole.npy", *NAIVE)
        self.succeed("join", "windows", "-o", "joined.npy")
        self.assertEqual((self.folder / "joined.npy").read_bytes(), (self.folder / "whole.npy").read_bytes())

    def test_damage_costs_its_samples_and_is_told(self):
        self.write_stream(slots=200)
        self.change_byte("clip.stipple", (self.folder / "clip.stipple").stat().st_size // 3)
        first = self.run_program("decode", "clip.stipple", "-o", "windows", "--part", "1/1", *NAIVE)
        self.assertEqual(first.returncode, INPUT)
        self.assertIn("damage", first.stderr)
        self.run_program("decode", "clip.stipple", "-o", "whole.npy", *NAIVE)
        self.succeed("join", "windows", "-o", "joined.npy")
        self.assertEqual((self.folder / "joined.npy").read_bytes(), (self.folder / "whole.npy").read_bytes())

    def test_windows_of_another_decoding_are_not_mixed_in(self):
        self.write_stream(slots=100)
        self.decode_part("1/2")
        decode = ("decode", "clip.stipple", "-o", "windows", "--part", "2/2")
        self.fails(INPUT, ["windows", "another decoding", 'method is "naive" there and "fast" here'],
                   *decode, "--method", "fast")
        self.fails(INPUT, ["fill_gaps is false there and true here"], *decode, *NAIVE, "--fill-gaps")
        self.write_stream("other.stipple", slots=101)
        self.fails(INPUT, ["another decoding: stream_bytes"], "decode", "other.stipple", "-o", "windows", "--part",
                   "2/2", *NAIVE)
        self.fails(INPUT, ["lacks 1 of its 2 windows: window_000001.npy"], "join", "windows", "-o", "joined.npy")
        identity = self.folder / "windows" / "decoding.json"
        described = json.loads(identity.read_text())
        identity.write_text(json.dumps(described | {"version": "0.0.1"}))
        self.fails(INPUT, ['version is "0.0.1" there'], *decode, *NAIVE)
        self.fails(INPUT, ["another version"], "join", "windows", "-o", "joined.npy")

    def test_a_window_from_elsewhere_is_refused_wherever_it_has_the_size(self):
        self.write_stream(slots=200)
        self.write_stream("other.stipple", slots=200, light=0.4)
        self.decode_part("1/1")
        windows = self.folder / "windows"
        own = (windows / "window_000001.npy").read_bytes()
        windows.rename(self.folder / "kept")
        self.decode_part("1/1", stream="other.stipple")
        windows.rename(self.folder / "other")
        (self.folder / "kept").rename(windows)
        array = self.array("windows/window_000001.npy")
        np.save(self.folder / "plain.npy", array)  # as of an earlier version, without a mark
        np.save(self.folder / "wide.npy", array.astype(np.float64))
        for foreign in ("other/window_000001.npy", "windows/window_000002.npy", "plain.npy", "wide.npy"):
            (windows / "window_000001.npy").write_bytes((self.folder / foreign).read_bytes())
            with self.subTest(foreign):
                parts = ["window_000001.npy", "is not this window", "remove it, and decode again"]
                self.fails(INPUT, parts, "join", "windows", "-o", "joined.npy")
                self.fails(INPUT, parts, "decode", "clip.stipple", "-o", "windows", "--part", "1/1", *NAIVE)
        self.decode_part("1/1", "--force")
        self.assertEqual((windows / "window_000001.npy").read_bytes(), own)
        self.expect_bytes_of_one_run()

    def test_a_window_of_the_same_decoding_in_another_folder_is_taken(self):
        self.write_stream(slots=100)
        self.decode_part("1/2")
        (self.folder / "windows").rename(self.folder / "first")
        self.decode_part("2/2")
        for path in (self.folder / "first").glob("window_*"):
            path.rename(self.folder / "windows" / path.name)
        self.expect_bytes_of_one_run()

    def test_a_refused_part_leaves_nothing(self):
        self.write_stream(slots=100)
        decode = ("decode", "clip.stipple", "-o", "windows", "--part", "1/1")
        self.fails(INPUT, ["interpolated"], *decode, "--method", "interpolated")
        self.fails(INPUT, ["no folder to make it in"], *decode[:3], "none/windows", "--part", "1/1", *NAIVE)
        (self.folder / "letter").touch()
        self.fails(INPUT, ["is not a folder"], *decode[:3], "letter", "--part", "1/1", *NAIVE)
        self.succeed(*decode[:3], "windows/", "--part", "1/1", *NAIVE)
        self.expect_bytes_of_one_run()

    def test_a_folder_that_holds_something_else_is_refused(self):
        self.write_stream()
        (self.folder / "windows").mkdir()
        (self.folder / "windows" / "letter.txt").touch()
        self.fails(INPUT, ["holds letter.txt"], "decode", "clip.stipple", "-o", "windows", "--part", "1/2")
        self.fails(INPUT, ["has no decoding.json"], "join", "windows", "-o", "joined.npy")
        good = {"version": "x"}
        for text in ("", "[]", "{", "null", json.dumps(good)):
            (self.folder / "windows" / "decoding.json").write_text(text)
            self.fails(INPUT, ["does not describe a decoding"], "join", "windows", "-o", "joined.npy")

    def test_sizes_that_no_video_has_are_refused(self):
        self.write_stream()
        self.decode_part("1/1")
        identity = self.folder / "windows" / "decoding.json"
        described = json.loads(identity.read_text())
        for key, value in (("slots", 0), ("slots", -5), ("slots", 1e300), ("rows", 0), ("cols", 1 << 40),
                           ("planes", 2)):
            identity.write_text(json.dumps(described | {key: value}))
            with self.subTest(key, value=value):
                self.fails(INPUT, ["decoding.json"], "join", "windows", "-o", "joined.npy")

    def test_wrong_parts_and_options_are_usage_errors(self):
        self.write_stream()
        decode = ("decode", "clip.stipple", "-o", "windows")
        for part in ("0/2", "3/2", "1", "1/", "/2", "a/b", "1/0", "-1/2", "1/2000000", "1/2/3", " 1/2"):
            self.fails(USAGE, ["--part", "1/16"], *decode, f"--part={part}")
        for option in (("--until", "5"), ("--follow",), ("--check-schedule",), ("--images", "png")):
            self.fails(USAGE, [option[0]], *decode, "--part", "1/2", *option)
        self.fails(USAGE, ["no extension"], "decode", "clip.stipple", "-o", "out.npy", "--part", "1/2")
        self.fails(INPUT, ["needs a file"], "decode", "/dev/null", "-o", "windows", "--part", "1/2")


if __name__ == "__main__":
    unittest.main()
