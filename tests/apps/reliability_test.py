"""What docs/reliability.md promises: outputs are on the disk before they have their names."""

import errno
import os
import signal
import subprocess
import time
import unittest
from pathlib import Path

import numpy as np
from program import DEVICE, INPUT, OK, PROGRAM, STOPPED, ProgramTest

SYNTH = ["synth", "roll", "--frames", "3", "--size", "16x8", "-o"]
FRAMES = [f"frame_000{slot}.exr" for slot in range(3)]


class DiskTest(ProgramTest):
    def run_noted(self, *arguments, failing="", number=0, **environment):
        """A run, and what it did to put outputs on the disk and in place: (what, name); a hidden name
        is "partial", the folder of the test "."."""
        log = self.folder / "calls"
        done = self.run_program(*arguments, env=os.environ | {
            "LD_PRELOAD": os.environ["DISK_CALLS_LIBRARY"], "DISK_CALLS": str(log),
            **environment, **({"FAILING_SYNC": failing, "FAILING_ERRNO": str(number)} if failing else {})})
        calls = [tuple(line.split(" ", 1)) for line in log.read_text().splitlines()] if log.exists() else []
        log.unlink(missing_ok=True)
        names = {str(self.folder): "."}
        return done, [(what, names.get(path) or self.short(Path(path).name)) for what, path in calls]

    @staticmethod
    def short(name):
        return "partial" if name.startswith(".") and ".partial" in name else name

    def leftovers(self):
        return sorted(path.name for path in self.folder.glob(".*.partial*"))

    def test_a_file_is_synced_then_named_then_its_folder_is_synced(self):
        self.write_stream("clip.stipple")
        record = ("capture", "record", "replay:light.npy", "-o", "a.strec", "--set", "camera.AcquisitionFrameRate=0")
        for name, line in (("out.npy", [*SYNTH, "out.npy"]), ("out.mp4", [*SYNTH, "out.mp4"]),
                           ("b.stipple", ["emulate", "light.npy", "-o", "b.stipple"]),
                           ("a.strec", record), ("s.toml", ["schedule", "make", "tiled", "-o", "s.toml"]),
                           ("i.json", ["info", "clip.stipple", "--json", "i.json"])):
            for force in ([], ["--force"]):
                done, calls = self.run_noted(*line, *force)
                self.assertEqual(done.returncode, OK, done.stderr)
                self.assertEqual(calls, [("sync", "partial"), ("rename", name), ("sync", ".")])
        self.assertEqual(self.leftovers(), [])

    def test_a_folder_is_synced_with_all_that_is_in_it(self):
        done, calls = self.run_noted(*SYNTH, "out")
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertEqual(sorted(calls[:3]), [("sync", name) for name in FRAMES])
        self.assertEqual(calls[3:], [("sync", "partial"), ("rename", "out"), ("sync", ".")])

    def test_a_folder_that_is_replaced_gives_way_at_once(self):
        self.succeed("synth", "roll", "--frames", 5, "--size", "8x8", "-o", "out")
        done, calls = self.run_noted(*SYNTH, "out", "--force")
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertEqual(calls[3:], [("sync", "partial"), ("rename", "out"), ("sync", ".")])
        self.assertEqual(self.names(), ["out", *(f"out/{name}" for name in FRAMES)])

    def test_a_file_system_that_cannot_exchange_names_will_do(self):
        for force, name in (([], "out"), (["--force"], "out"), ([], "out.npy"), (["--force"], "out.npy")):
            done, calls = self.run_noted(*SYNTH, name, *force, OLD_FILE_SYSTEM="1")
            self.assertEqual((done.returncode, calls[-2:]), (OK, [("rename", name), ("sync", ".")]), done.stderr)
        self.assertEqual(self.names(), ["out", "out.npy", *(f"out/{name}" for name in FRAMES)])

    def test_a_leftover_that_is_kept_is_synced(self):
        stream = self.folder / self.write_stream("clip.stipple")
        left = self.folder / ".old.999999999-01ab.partial.stipple"
        left.write_bytes(stream.read_bytes())
        done, calls = self.run_noted("recover", left.name)
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertEqual(calls, [("sync", "partial"), ("rename", "old.stipple"), ("sync", ".")])

    def test_a_new_folder_of_several_outputs_is_synced_in_the_one_around_it(self):
        done, calls = self.run_noted("demo", "--frames", 6, "--size", "16x16", "-o", "shown")
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertEqual(calls[0], ("sync", "."))
        self.assertEqual(calls[-1], ("sync", "shown"))

    def test_no_sync_does_not_wait(self):
        for name in ("out.npy", "out"):
            done, calls = self.run_noted(*SYNTH, name, "--no-sync")
            self.assertEqual((done.returncode, calls), (OK, [("rename", name)]), done.stderr)

    def test_a_disk_that_fails_leaves_the_output_before_and_what_was_written(self):
        for name, failing, number in (("out.npy", "*.partial.npy", errno.EIO), ("out.npy", "*.partial.npy", errno.ENOSPC),
                                      ("out", "*/frame_0001.exr", errno.EIO), ("out", "*.partial", errno.ENOSPC)):
            self.succeed("synth", "pan", "--frames", 1, "--size", "8x8", "-o", name, "--force")
            one = self.folder / ("out.npy" if name == "out.npy" else "out/frame_0000.exr")
            before = one.read_bytes()
            done, _ = self.run_noted(*SYNTH, name, "--force", failing=failing, number=number)
            self.assertEqual(done.returncode, DEVICE, done.stderr)
            left, = self.leftovers()
            for part in (f"{name}: cannot be put in place: {os.strerror(number)}", "what was written is in", f"{left}, rename it"):
                self.assertIn(part, done.stderr)
            self.assertEqual(one.read_bytes(), before)
            if name == "out.npy":
                self.assertEqual(self.array(left).shape, (3, 8, 16, 3))
            subprocess.run(["rm", "-r", self.folder / left], check=True)

    def test_a_folder_that_fails_leaves_the_whole_output(self):
        done, _ = self.run_noted(*SYNTH, "out.npy", failing=self.folder, number=errno.EIO)
        self.assertEqual(done.returncode, DEVICE)
        self.assertIn(f"out.npy: is complete, but its name may not be on the disk: {os.strerror(errno.EIO)}",
                      done.stderr)
        self.assertEqual(self.array("out.npy").shape, (3, 8, 16, 3))

    def test_what_cannot_be_synced_is_left_to_the_system(self):
        for number in (errno.EINVAL, errno.EROFS):
            done, calls = self.run_noted(*SYNTH, "out", "--force", failing="*", number=number)
            self.assertEqual((done.returncode, len(calls)), (OK, 6), done.stderr)


class LinkTest(ProgramTest):
    def test_a_link_stays_and_what_it_leads_to_is_replaced(self):
        (self.folder / "disk").mkdir()
        (self.folder / "disk/real.npy").write_text("old")
        (self.folder / "link.npy").symlink_to("hop.npy")
        (self.folder / "hop.npy").symlink_to("disk/real.npy")
        self.fails(INPUT, ["disk/real.npy: exists already", "--force"], *SYNTH, "link.npy")
        self.succeed(*SYNTH, "link.npy", "--force")
        self.assertTrue((self.folder / "link.npy").is_symlink() and (self.folder / "hop.npy").is_symlink())
        self.assertEqual(self.array("disk/real.npy").shape, (3, 8, 16, 3))
        self.assertEqual(self.names(), ["disk", "disk/real.npy", "hop.npy", "link.npy"])

    def test_a_link_to_nothing_or_to_itself_is_refused(self):
        (self.folder / "link.npy").symlink_to("nothing.npy")
        (self.folder / "self.npy").symlink_to("self.npy")
        for force in ([], ["--force"]):
            self.fails(INPUT, ["link.npy: is a link to", "nothing.npy\", which does not exist"],
                       *SYNTH, "link.npy", *force)
            self.fails(INPUT, ["self.npy: is a link to"], *SYNTH, "self.npy", *force)

    def test_an_open_file_is_never_replaced(self):
        stream = self.write_stream()
        (self.folder / "stdout").symlink_to("/proc/self/fd/1")  # as /dev/stdout is
        for force in ([], ["--force"]):
            with open(self.folder / "shell", "w", encoding="utf-8") as shell:
                done = subprocess.run([PROGRAM, "info", stream, "--json", "stdout", *force], stdout=shell,
                                      cwd=self.folder, stderr=subprocess.PIPE, text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, INPUT)
            self.assertIn('stdout: stands for a file that is open, which no other can replace; give another '
                          'name', done.stderr)
            self.assertEqual((self.folder / "shell").read_text(), "")
        self.assertTrue((self.folder / "stdout").is_symlink())


class ClosedStreamsTest(ProgramTest):
    def test_closed_standard_streams_do_not_become_outputs(self):
        """Ctrl-C writes a message to standard error, whatever file that has become."""
        np.save(self.folder / "light.npy", np.zeros((9, 6, 8), np.uint16))
        for closed in ((0, 2), (1, 2), (0, 1, 2)):
            name = "".join(map(str, closed)) + ".strec"
            def close(streams=closed):
                for stream in streams:
                    os.close(stream)
            run = subprocess.Popen([PROGRAM, "capture", "record", "replay:light.npy", "-o", name, "-q", "--set",
                                    "camera.Loop=1", "--set", "camera.AcquisitionFrameRate=100"], cwd=self.folder,
                                   preexec_fn=close)
            self.addCleanup(run.kill)
            deadline = time.monotonic() + 60
            while not any(path.stat().st_size > 4000 for path in self.folder.glob(".*.partial.strec")):
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.01)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.wait(timeout=60), STOPPED)
            info = self.figures("info", name)
            self.assertEqual((info["complete"], info["damaged_places"]), (True, 0))


if __name__ == "__main__":
    unittest.main()
