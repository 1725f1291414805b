"""What a run that was killed leaves: how it is found, named and kept."""

import json
import os
import signal
import time
import unittest

import numpy as np
from program import INPUT, USAGE, ProgramTest

PACKET = b"\xc5SPK"


class RecoverTest(ProgramTest):
    def killed(self, *command, size=4000):
        """The hidden file of a run that was killed with so many bytes in it."""
        program = self.start_program(*command)
        for _ in range(6000):
            left = [path for path in self.folder.glob(".*.partial*")
                    if path.stat().st_size > size]
            if left or program.poll() is not None:
                break
            time.sleep(0.01)
        program.kill()
        errors = program.communicate(timeout=60)[1]
        self.assertEqual(program.returncode, -signal.SIGKILL, errors)
        return left[0].name

    def killed_stream(self):
        self.write_flat("light.npy", slots=40)
        return self.killed("capture", "live", "replay:light.npy", "-o", "clip.stipple", "--set",
                           "camera.Loop=1", "--set", "camera.AcquisitionFrameRate=100")

    def killed_recording(self):
        np.save(self.folder / "light.npy",
                np.random.default_rng(1).integers(0, 65536, (20, 6, 8), dtype=np.uint16))
        return self.killed("capture", "record", "replay:light.npy", "-o", "clip.strec", "--set",
                           "camera.Loop=1", "--set", "camera.AcquisitionFrameRate=100")

    def test_a_stream_is_kept_up_to_its_last_whole_packet(self):
        left = self.killed_stream()
        content = (self.folder / left).read_bytes()
        (self.folder / left).write_bytes(content + PACKET + b"\1")  # a packet that had begun
        done = self.run_program("info", left)
        self.assertIn("ends within a packet, of which there are 5 bytes; its run was killed, "
                      f"`stipple recover {left}` keeps it", done.stderr)
        said = self.succeed("recover", left, "--json", "figures.json")
        figures = json.loads((self.folder / "figures.json").read_text())
        (self.folder / "figures.json").unlink()
        self.assertEqual((figures["file"], figures["cut_bytes"]), ("clip.stipple", 5))
        self.assertIn(f"clip.stipple: {figures['whole']} whole slots, 5 bytes of the next one cut off; without an end", said)
        self.assertEqual((self.folder / "clip.stipple").read_bytes(), content)
        info = self.figures("info", "clip.stipple")
        self.assertEqual((info["slots"], info["complete"]), (figures["whole"], False))
        self.assertEqual(self.names(), ["clip.stipple", "light.npy"])

    def test_a_recording_is_kept_up_to_its_last_whole_frame(self):
        left = self.killed_recording()
        content = (self.folder / left).read_bytes()
        last = content.rindex(b"\xc5FRM")
        (self.folder / left).write_bytes(content[:last + 100])
        said = self.succeed("info", left)
        self.assertIn("100 bytes of the next one follow", said)
        self.assertIn(f"its run was killed, `stipple recover {left}` keeps it", said)
        figures = self.figures("recover", left, "-o", "saved.strec")
        self.assertEqual(figures["cut_bytes"], 100)
        self.assertEqual((self.folder / "saved.strec").read_bytes(), content[:last])
        info = self.figures("info", "saved.strec")
        self.assertEqual((info["frames"], info["complete"]), (figures["whole"], False))
        replayed = self.figures("capture", "replay", "saved.strec", "-o", "light2.npy")
        self.assertEqual((replayed["slots"], replayed["cut_off"]), (figures["whole"], True))

    def test_leftovers_are_listed_and_said_to_the_next_run(self):
        left = self.killed_stream()
        for name in (".video.999999999.partial.npy", ".x.partial.npy", "clip.1.partial.npy"):
            (self.folder / name).write_bytes(b"half")
        (self.folder / ".frames.999999998.partial").mkdir()
        listed = self.figures("recover")["left"]
        self.assertEqual(sorted((one["output"], one["kind"]) for one in listed),
                         [("clip.stipple", "stream"), ("frames", None), ("video.npy", None)])
        said = self.succeed("recover", ".")
        self.assertIn(f"{left}: 0.0 MB, a stream that becomes clip.stipple", said)
        self.assertIn("of video.npy, cannot be recovered; delete it", said)
        done = self.run_program("emulate", "light.npy", "-o", "clip.stipple")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (0, 1), done.stderr)
        self.assertIn(f"a run that was killed left {left}", done.stderr)
        done = self.run_program("emulate", "light.npy", "-o", "b.stipple", "--truth", "video.npy")
        self.assertIn("a run that was killed left .video.999999999.partial.npy;", done.stderr)
        (self.folder / "elsewhere").mkdir()
        (self.folder / "elsewhere" / "link.npy").symlink_to("../video.npy")
        done = self.run_program("emulate", "light.npy", "-o", "c.stipple", "--force", "--truth",
                                "elsewhere/link.npy")
        self.assertIn("a run that was killed left .video.999999999.partial.npy;", done.stderr)
        synth = ("synth", "pan", "--size", "8x8", "--frames", 2, "-q", "-o")
        done = self.run_program(*synth, "frames/")
        self.assertIn("a run that was killed left .frames.999999998.partial;", done.stderr)
        self.assertEqual(self.run_program(*synth, "other.npy").stderr, "")
        before = (self.folder / "clip.stipple").read_bytes()
        self.fails(INPUT, ["clip.stipple: exists already", "-o"], "recover", left, "--force")
        self.assertEqual((self.folder / "clip.stipple").read_bytes(), before)
        self.fails(INPUT, ["cannot be recovered"], "recover", ".video.999999999.partial.npy")
        self.fails(INPUT, ["folder of frames"], "recover", ".frames.999999998.partial")

    def test_what_is_being_written_is_left_alone(self):
        self.write_flat("light.npy", slots=40)
        program = self.start_program("capture", "live", "replay:light.npy", "-o", "clip.stipple",
                                     "--set", "camera.Loop=1", "--set", "camera.AcquisitionFrameRate=100")
        self.addCleanup(program.communicate)
        self.addCleanup(program.kill)
        for _ in range(6000):
            found = list(self.folder.glob(f".clip.{program.pid}-*.partial.stipple"))
            if found and found[0].stat().st_size > 4000:
                break
            time.sleep(0.01)
        name = found[0].name
        self.assertEqual(self.figures("recover")["left"], [])
        old = self.folder / f".old.{program.pid}.partial.npy"  # of a process that had that number before
        old.write_bytes(b"half")
        os.utime(old, (1e9, 1e9))
        self.assertEqual([one["output"] for one in self.figures("recover")["left"]], ["old.npy"])
        old.unlink()
        self.assertIn("no run that was killed", self.succeed("recover"))
        done = self.run_program("recover", name)
        self.assertEqual(done.returncode, INPUT)
        self.assertIn(f"process {program.pid} is writing it", done.stderr)
        self.assertIn(f"; process {program.pid} is writing it",
                      self.run_program("info", name).stdout)

    def test_what_holds_nothing_whole_is_refused(self):
        name = ".clip.999999999-0123abcd.partial.strec"
        left = self.killed_recording()
        content = (self.folder / left).read_bytes()
        second = content.index(b"\xc5FRM", content.index(b"\xc5FRM") + 1)
        (self.folder / name).write_bytes(content[:second + 50])
        self.fails(INPUT, [name, "holds no whole frame"], "recover", name)
        self.fails(INPUT, ["light.npy", "say with -o"], "recover", "light.npy")
        self.fails(INPUT, ["light.npy", "cannot be recovered"], "recover", "light.npy", "-o", "x")
        self.fails(INPUT, ["nothing: there is no such"], "recover", "nothing")
        self.fails(USAGE, ["saved.mp4", ".strec"], "recover", name, "-o", "saved.mp4")

    def test_a_demo_that_is_stopped_leaves_no_empty_folder(self):
        demo = self.start_program("demo", "--frames", 4000, "--size", "64x64")
        for _ in range(6000):
            if (self.folder / "stipple_demo").exists() or demo.poll() is not None:
                break
            time.sleep(0.01)
        demo.send_signal(signal.SIGINT)
        errors = demo.communicate(timeout=100)[1]
        self.assertEqual(demo.returncode, 130, errors)
        self.assertEqual(self.names(), [])


class RecordingInfoTest(ProgramTest):
    def test_it_says_what_a_recording_holds(self):
        np.save(self.folder / "light.npy",
                np.random.default_rng(1).integers(0, 65536, (9, 6, 8), dtype=np.uint16))
        self.succeed("capture", "record", "replay:light.npy", "-o", "clip.strec", "--set",
                     "camera.AcquisitionFrameRate=50")
        info = self.figures("info", "clip.strec")
        expected = {"kind": "recording", "settings": {"AcquisitionFrameRate": "50"}, "frames": 9,
                    "incomplete": 0, "missing_frames": 0, "gaps": [], "width": 8, "height": 6,
                    "format": "Mono16", "complete": True, "tail_bytes": 0, "damaged_places": 0}
        self.assertEqual({key: info[key] for key in expected}, expected)
        self.assertAlmostEqual(info["frames_hz"], 50)
        said = self.succeed("info", "clip.strec")
        for part in ("8 x 6 (width x height) Mono16, 9 of them", "50 per second",
                     "setting      AcquisitionFrameRate = 50", "undamaged, complete"):
            self.assertIn(part, said)

    def test_it_names_the_places_of_gaps_and_damage(self):
        np.save(self.folder / "light.npy", np.zeros((9, 6, 8), np.uint16))
        self.succeed("capture", "record", "replay:light.npy", "-o", "clip.strec", "--set",
                     "camera.AcquisitionFrameRate=0", "--buffers", "1024")
        content = (self.folder / "clip.strec").read_bytes()
        starts = [at for at in range(len(content)) if content.startswith(b"\xc5FRM", at)]
        # Frames 3 and 4 are blocks 4 and 5.
        (self.folder / "clip.strec").write_bytes(content[:starts[4]] + content[starts[6]:])
        done = self.run_program("info", "clip.strec", "--json", "info.json")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("missing      2 frames in 1 places\n             2 before frame 5: damage",
                      done.stdout)
        self.assertIn("clip.strec: is damaged (2 of its blocks cannot be read)", done.stderr)


if __name__ == "__main__":
    unittest.main()
