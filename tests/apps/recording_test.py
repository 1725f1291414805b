"""Recordings of cameras: what docs/recording_format.md says of them, and what is made of them."""

import json
import re
import signal
import subprocess
import sys
import time
import unittest

import numpy as np
from program import DEVICE, INPUT, PROGRAM, STOPPED, ProgramTest, project_path
from sample_stream import crc32c, samples

DOCUMENT = project_path("docs/recording_format.md")
FAST = ("--set", "camera.AcquisitionFrameRate=0", "--buffers", "1024")


def lines_of_the_document():
    return re.search(r"```python\n(.*?)```", DOCUMENT.read_text(), re.S)[1]


class RecordingTest(ProgramTest):
    def setUp(self):
        super().setUp()
        random = np.random.default_rng(5)
        self.dn = random.integers(0, 65536, (6, 5, 8), dtype=np.uint16)
        np.save(self.folder / "light.npy", self.dn)

    def record(self, *more):
        """A recording, whose samples are self.dn."""
        return self.figures("capture", "record", "replay:light.npy", "-o", "clip.strec", *FAST,
                            "--frames", len(self.dn), *more)

    def test_the_python_of_the_document_reads_every_frame(self):
        lines = lines_of_the_document()
        self.assertLessEqual(len([line for line in lines.splitlines() if line.strip()]), 12)
        self.record()
        check = lines + "\n".join((
            "images = [np.frombuffer(pixels, '<u2').reshape(record['height'], -1)"
            "[:, :record['width']] for record, pixels in frames]",
            "np.save(sys.argv[2], np.array(images))",
            "assert session['camera']['transport'] == 'replay'",
            "assert [int(record['id']) for record, _ in frames] == list(range(6))",
            "assert all(record['format'] == b'Mono16' for record, _ in frames)",
            "assert frames[1][0]['device_ns'] - frames[0][0]['device_ns'] == 5000000"))
        done = subprocess.run([sys.executable, "-c", check, "clip.strec", "read.npy"],
                              cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        np.testing.assert_array_equal(self.array("read.npy"), self.dn)

    def test_the_session_says_what_was_asked_for(self):
        self.record()
        content = (self.folder / "clip.strec").read_bytes()
        for word in (b'"AcquisitionFrameRate"', b'"kernel"', b'"stipple"', b'"reason": "stopped"'):
            self.assertIn(word, content)

    def test_the_rate_is_that_of_the_periods_between_frames(self):
        for rate in (50, 400):
            for frames in (2, 3, 6):
                done = self.figures("capture", "record", "replay:light.npy", "-o", "clip.strec",
                                    "--set", f"camera.AcquisitionFrameRate={rate}", "--frames", frames,
                                    "--force")
                self.assertAlmostEqual(done["frames_hz"], rate, places=6)

    def test_a_single_frame_has_no_rate(self):
        record = ("capture", "record", "replay:light.npy", "-o", "clip.strec", *FAST, "--frames", 1,
                  "--force")
        self.assertIsNone(self.figures(*record)["frames_hz"])
        self.assertIn("1 frame, 0.0 MB\nlost: ", self.succeed(*record))
        live = ("capture", "live", "replay:light.npy", "-o", "a.stipple", *FAST, "--frames", 1)
        figures = self.figures(*live)
        for key in ("slots_per_second", "samples_per_second", "frames_hz"):
            self.assertIsNone(figures[key], key)
        self.assertNotIn("slots/s", self.succeed(*live, "--force"))

    def test_the_emulator_says_that_a_recording_has_another_rate_than_slots(self):
        self.write_flat("video.npy", 12)
        for rate, slot_us, said in ((50, 5000, True), (50, 20000, False), (200, 5000, False)):
            self.succeed("capture", "record", "replay:video.npy", "-o", "video.strec", "--set",
                         f"camera.AcquisitionFrameRate={rate}", "--force")
            done = self.run_program("emulate", "video.strec", "-o", "a.stipple", "--force", "-q",
                                    "--set", f"sensor.slot_us={slot_us}")
            self.assertEqual(done.returncode, 0, done.stderr)
            if not said:
                self.assertEqual(done.stderr, "")
                continue
            for part in ("video.strec: the camera sent 50 frames/s", "takes 5000 us (200 a second)",
                         "--set sensor.slot_us=20000"):
                self.assertIn(part, done.stderr)

    def test_the_emulator_says_that_a_video_has_another_rate_than_slots(self):
        self.succeed("synth", "pan", "-o", "video.mp4", "--size", "32x32", "--frames", 4)
        emulate = ("emulate", "video.mp4", "-o", "a.stipple", "--force", "-q", "--transfer", "srgb")
        done = self.run_program(*emulate)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        for part in ("video.mp4: has 30 frames/s", "6.67x as fast", "--set sensor.slot_us=33333 keeps the speed; --resample flow"):
            self.assertIn(part, done.stderr)
        self.assertEqual(self.run_program(*emulate, "--set", "sensor.slot_us=33333").stderr, "")

    def test_a_recording_comes_back_as_the_light_it_was_made_of(self):
        self.record()
        figures = self.figures("capture", "replay", "clip.strec", "-o", "again.npy")
        self.assertEqual(figures, {"slots": 6, "held_slots": 0, "missing_frames": 0, "gaps": [],
                                   "damaged_places": 0, "cut_off": False})
        np.testing.assert_array_equal(self.array("again.npy"),
                                      (self.dn / 65535).astype(np.float32))

    def test_the_emulator_takes_a_recording_as_footage(self):
        self.record()
        self.succeed("emulate", "clip.strec", "-o", "a.stipple")
        self.succeed("capture", "replay", "clip.strec", "-o", "again.npy")
        (self.folder / "again.npy").rename(self.folder / "clip.npy")
        self.succeed("emulate", "clip.npy", "-o", "b.stipple")
        a, b = ((self.folder / name).read_bytes() for name in ("a.stipple", "b.stipple"))
        self.assertEqual(samples(a), samples(b))

    def test_an_emulator_beside_a_camera_gives_the_same_stream(self):
        self.record()
        self.succeed("emulate", "clip.strec", "-o", "a.stipple")
        figures = self.figures("capture", "live", "replay:clip.strec", "-o", "b.stipple", *FAST)
        self.assertEqual((figures["frames"], figures["held_slots"], figures["slots"]), (6, 0, 6))
        self.assertEqual((self.folder / "a.stipple").read_bytes(),
                         (self.folder / "b.stipple").read_bytes())

    def record_incomplete(self, *incomplete):
        """A recording of which these frames say that packets of them are missing."""
        self.record()
        clip = self.folder / "clip.strec"
        content = bytearray(clip.read_bytes())
        starts = [found.start() for found in re.finditer(rb"\xc5FRM", content)][1:]  # of frames
        for block in (starts[frame] for frame in incomplete):
            content[block + 32 + 121] = 1  # status: packets are missing
            content[block + 24:block + 28] = crc32c(content[block + 32:block + 32 + 160]).to_bytes(4, "little")
            content[block + 28:block + 32] = crc32c(content[block:block + 28]).to_bytes(4, "little")
        clip.write_bytes(content)

    def test_incomplete_frames_are_no_light_live_either(self):
        self.record_incomplete(2, 3)
        self.succeed("emulate", "clip.strec", "-o", "a.stipple")
        figures = self.figures("capture", "live", "replay:clip.strec", "-o", "b.stipple", *FAST)
        self.assertEqual((figures["frames"], figures["incomplete"], figures["held_slots"], figures["slots"]),
                         (4, 2, 2, 6))
        self.assertEqual(figures["transport"]["packets_missing"], 0)
        self.assertEqual((self.folder / "a.stipple").read_bytes(), (self.folder / "b.stipple").read_bytes())

    def test_frames_that_are_left_out_are_told_with_their_cause(self):
        for incomplete, line, gaps, after_last in (
                ((2, 3), "missing      2 frames in 1 places\n             2 before frame 4: ", 1, 0),
                ((4, 5), "missing      0 frames in 0 places, and 2 after the last frame\n", 0, 2)):
            self.record_incomplete(*incomplete)
            record = ("capture", "record", "replay:clip.strec", "-o", "kept.strec", *FAST, "--force")
            done = self.run_program(*record, "--fail-on-loss")
            self.assertEqual(done.returncode, DEVICE, done.stderr)
            self.assertIn("kept.strec: 2 lost, 0 incomplete; the file is kept", done.stderr)
            lost = self.figures(*record, "--incomplete", "drop")["lost"]
            cause, = (name for name, frames in lost.items() if frames == 2)
            said = self.succeed("info", "kept.strec")
            self.assertIn(line.replace("4: ", f"4: {cause}\n"), said + "\n")
            told = self.figures("info", "kept.strec")
            self.assertEqual((len(told["gaps"]), told["missing_after_last"]), (gaps, after_last))
            (self.folder / "clip.strec").unlink()

    def test_so_many_gaps_are_shown_and_further_ones_counted(self):
        self.dn = np.tile(self.dn, (4, 1, 1))
        np.save(self.folder / "light.npy", self.dn)
        for gaps in 10, 11:
            self.record_incomplete(*range(1, 2 * gaps, 2))
            self.succeed("capture", "record", "replay:clip.strec", "-o", "kept.strec", *FAST, "--force", "--incomplete",
                         "drop")
            said = self.succeed("info", "kept.strec")
            self.assertIn(f"missing      {gaps} frames in {gaps} places\n", said)
            self.assertEqual(said.count(" before frame "), 10)
            self.assertEqual(re.findall("and .* more", said), ["and 1 more"] if gaps > 10 else [])
            (self.folder / "clip.strec").unlink()

    def test_live_counts_frames_from_its_first_slot_on(self):
        self.record_incomplete(0, 3, 5)
        figures = self.figures("capture", "live", "replay:clip.strec", "-o", "b.stipple", *FAST)
        self.assertEqual((figures["frames"], figures["incomplete"], figures["held_slots"], figures["slots"]),
                         (3, 2, 2, 5))

    def test_ctrl_c_leaves_a_whole_stream(self):
        self.record()
        live = self.start_program("capture", "live", "replay:clip.strec", "-o", "a.stipple",
                                  "--set", "camera.Loop=1", "--set", "camera.AcquisitionFrameRate=100")
        for _ in range(6000):  # until some slots are in the file that is not yet in place
            if any(path.stat().st_size > 4000 for path in self.folder.glob(".*stipple*")):
                break
            time.sleep(0.01)
        live.send_signal(signal.SIGINT)
        _, message = live.communicate(timeout=60)
        self.assertEqual(live.returncode, STOPPED, message)
        content = (self.folder / "a.stipple").read_bytes()
        self.assertGreater(len(content), 4000)
        self.assertEqual(self.figures("info", "a.stipple")["slots"], len(samples(content)))

    def test_a_recording_that_was_cut_off_is_readable(self):
        self.record()
        content = (self.folder / "clip.strec").read_bytes()
        last = content.rindex(b"\xc5FRM", 0, content.rindex(b"\xc5FRM"))
        (self.folder / "clip.strec").write_bytes(content[:last + 100])
        figures = self.figures("capture", "replay", "clip.strec", "-o", "again.npy")
        self.assertEqual((figures["slots"], figures["cut_off"]), (5, True))

    def test_a_replay_says_that_its_recording_was_cut_off(self):
        self.record()
        clip = self.folder / "clip.strec"
        whole = clip.read_bytes()
        for content, said in ((whole, ""), (whole[:-10], "clip.strec: was cut off")):
            clip.write_bytes(content)
            for command, output in (("live", "a.stipple"), ("record", "b.strec")):
                done = self.run_program("capture", command, "replay:clip.strec", "-o", output,
                                        "--force", "-q")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(done.stderr.count("was cut off"), 1 if said else 0, done.stderr)
                self.assertIn(said, done.stderr)

    def test_a_damaged_recording_is_replayed_and_told_even_if_quiet(self):
        self.record()
        clip = self.folder / "clip.strec"
        whole = clip.read_bytes()
        starts = [found.start() for found in re.finditer(rb"\xc5FRM", whole)][1:]  # of frames
        flipped = bytearray(whole)
        flipped[starts[3] - 1] ^= 0xFF  # the last sample of frame 2
        for content, code, parts in (
                (flipped, INPUT, ["clip.strec: 1 frame missing or incomplete: 1 at slot 2",
                                  "the recording is damaged\n  byte ", "contains the undamaged part"]),
                (whole[:starts[4] + 100], 0, ["clip.strec: was cut off before its end"])):
            clip.write_bytes(content)
            done = self.run_program("capture", "replay", "clip.strec", "-o", "again.npy", "-q", "--force",
                                    "--json", "figures.json")
            self.assertEqual((done.returncode, done.stdout), (code, ""), done.stderr)
            for part in parts:
                self.assertIn(part, done.stderr)
            (self.folder / "figures.json").rename(self.folder / f"{code}.json")
        self.assertEqual(len(self.array("again.npy")), 4)
        gaps = json.loads((self.folder / "1.json").read_text())["gaps"]
        self.assertEqual(gaps, [{"slot": 2, "frames": 1}])

    def test_light_that_a_camera_cannot_hold_is_told_by_its_share(self):
        light = np.full((3, 8, 8, 3), 0.5, np.float32)
        light[0, :2] = 4.5
        np.save(self.folder / "hdr.npy", light)
        done = self.run_program("capture", "record", "replay:hdr.npy", "-o", "a.strec", *FAST, "-q")
        self.assertEqual(done.returncode, 0, done.stderr)
        for part in ("hdr.npy: its first frame has light up to 4.5", "25 % of it is clipped to 1.0",
                     "RGB8", "1/255"):
            self.assertIn(part, done.stderr)
        np.save(self.folder / "hdr.npy", light[1:])
        done = self.run_program("capture", "record", "replay:hdr.npy", "-o", "b.strec", *FAST, "-q")
        self.assertEqual(done.stderr, "")

    def test_what_the_emulator_finds_missing_in_a_recording_is_said(self):
        self.record()
        clip, whole = self.folder / "clip.strec", (self.folder / "clip.strec").read_bytes()
        starts = [found.start() for found in re.finditer(rb"\xc5FRM", whole)][1:]  # of frames

        def emulate(content):
            clip.write_bytes(content)
            done = self.run_program("emulate", "clip.strec", "-o", "a.stipple", "--truth", "a.npy",
                                    "--force", "-q")
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stderr

        self.assertEqual(emulate(whole), "")
        self.assertIn("clip.strec: was cut off", emulate(whole[:starts[4] + 100]))
        self.assertEqual(len(self.array("a.npy")), 4)
        flipped = bytearray(whole)
        flipped[starts[3] - 1] ^= 0xFF  # the last sample of frame 2
        said = emulate(flipped)
        self.assertIn("clip.strec: is damaged (1 of its blocks cannot be read), has 1 missing or incomplete frame", said)
        light = (self.dn / 65535).astype(np.float32)
        light[2] = light[1]  # the frame before stands in
        np.testing.assert_array_equal(self.array("a.npy"), light)
        (self.folder / "none.strec").write_bytes(whole[:starts[0] + 50])
        self.fails(INPUT, ["none.strec", "no frame"], "emulate", "none.strec", "-o", "x.stipple")

    def test_a_full_disk_keeps_what_was_recorded(self):
        shell = 'ulimit -f 3 && exec "$0" "$@"'  # 3 blocks of 1024 bytes: two frames or so
        done = subprocess.run(["bash", "-c", shell, PROGRAM, "capture", "record",
                               "replay:light.npy", "-o", "clip.strec", *FAST], cwd=self.folder,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, DEVICE, done.stderr)
        self.assertIn("clip.strec: cannot be written: File too large", done.stderr)
        figures = self.figures("capture", "replay", "clip.strec", "-o", "again.npy")
        self.assertGreaterEqual(figures["slots"], 1)
        self.assertRegex(done.stderr, rf"clip\.strec: {figures['slots']} frames? kept\n")
        np.testing.assert_array_equal(
            self.array("again.npy"), (self.dn / 65535).astype(np.float32)[:figures["slots"]])

    def test_footage_that_breaks_off_is_bad_input_and_keeps_what_came_before(self):
        light = np.full((6, 5, 8), 0.5, np.float32)
        light[3, 1, 2] = np.nan
        np.save(self.folder / "nan.npy", light)
        for verb, output in (("record", "a.strec"), ("live", "a.stipple")):
            done = self.run_program("capture", verb, "replay:nan.npy", "-o", output, *FAST)
            self.assertEqual(done.returncode, INPUT, done.stderr)
            self.assertIn("nan.npy: frame 3", done.stderr)
            self.assertNotIn("camera", done.stderr)
        self.assertEqual(self.figures("info", "a.stipple")["slots"], 3)
        replayed = self.figures("capture", "replay", "a.strec", "-o", "again.npy")
        self.assertEqual((replayed["slots"], replayed["cut_off"]), (3, False))

    def test_a_recording_without_a_frame_is_no_success(self):
        self.fails(DEVICE, ["replay:light.npy: no frame came"], "capture", "record",
                   "replay:light.npy", "-o", "x.strec", "--seconds", 1e-9)

    def test_other_files_are_refused(self):
        self.fails(INPUT, ["light.npy", "not a recording"], "capture", "replay", "light.npy", "-o",
                   "again.npy")
        self.record()
        self.fails(INPUT, ["clip.strec", "numbers are linear"], "emulate", "clip.strec", "-o",
                   "a.stipple", "--luminance")


if __name__ == "__main__":
    unittest.main()
