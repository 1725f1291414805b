"""Every call that can fail does (docs/reliability.md): faulty_calls.cpp says which can be made to.

After a fault the exit code is 0 and the output is what it would have been, or it is 1 to 3 and one
message says why; the output before is whole, or the new one; what has a hidden name is told. With
STIPPLE_LONG each call fails in turn, of the requests for memory a thousand; with STIPPLE_LONG=every
all of them, once alone and once with all that follow. Without it some of each kind fail."""

import errno
import os
import random
import re
import shutil
import signal
import unittest

import numpy as np
from faults import KILL, SHORT, Fault, FaultyProgram
from program import DEVICE, INPUT, OK, ProgramTest

LONG = "STIPPLE_LONG" in os.environ
EVERY = os.environ.get("STIPPLE_LONG") == "every"
SEED = 1
OLD = b"the output before" * 100
FAST = ("--set", "camera.AcquisitionFrameRate=0", "--buffers", "1024")
ERRORS = {"open": (errno.EMFILE, errno.ENOSPC), "read": (errno.EIO,), "write": (errno.ENOSPC, errno.EIO, SHORT),
          "sync": (errno.EIO, errno.ENOSPC), "rename": (errno.EIO,), "cut": (errno.EIO,), "remove": (errno.EIO,),
          "map": (errno.ENOMEM,), "thread": (errno.EAGAIN,)}
BLOCK, PACKET = b"\xc5FRM", b"\xc5SPK"
NO_MEMORY = "not enough memory; end other programs, or give smaller or fewer frames"
NO_THREAD = "no further thread can be started"
NO_WORKER = "pthread_create has failed: Resource temporarily unavailable"  # of oneTBB


def some(last, most):
    """Numbers of calls from 1 to `last`: all, or `most` evenly spread ones, first and last too."""
    return sorted({round(n) for n in np.linspace(1, last, min(last, most))}) if last else []


class FaultyRuns(ProgramTest):
    def setUp(self):
        super().setUp()
        values = np.random.default_rng(SEED).integers(0, 65536, (8, 24, 32), dtype=np.uint16)
        np.save(self.folder / "light.npy", values)
        self.frames = [frame.tobytes() for frame in values]

    def prepare(self, output, *command):
        """Runs it once without a fault."""
        inputs = {path.name for path in self.folder.iterdir()}
        self.inputs, self.output = inputs, output
        self.program = FaultyProgram(self.folder, [*command, "-o", output, "--force", "-q"])
        self.addCleanup(self.program.close)
        self.reset()
        clean = self.program.run()
        self.assertEqual((clean.code, clean.said), (OK, ""))
        self.calls = clean.calls
        if clean.calls["memory"] == 0:
            self.skipTest("the program brings its own allocator")
        self.new = self.content(output)

    def prepare_one(self, name):
        if name == "emulate":
            self.prepare("out.stipple", "emulate", "light.npy")
        elif name == "images":
            for number, values in enumerate(np.load(self.folder / "light.npy") // 256):
                self.write_png(f"frames/f{number}.png", values)
            self.prepare("out.stipple", "emulate", "frames")
        elif name == "record":
            self.prepare("out.strec", "capture", "record", "replay:light.npy", *FAST)
        elif name == "live":
            self.prepare("out.stipple", "capture", "live", "replay:light.npy", *FAST)
        else:
            self.succeed("emulate", "light.npy", "-o", "clip.stipple", "-q")
            self.prepare("out" if name == "folder" else "out.npy", "decode", "clip.stipple", "--method", "naive")

    def outputs(self):
        return [path for path in self.folder.iterdir() if path.name not in self.inputs]

    def content(self, name):
        path = self.folder / name
        if not path.is_dir():
            return path.read_bytes()
        return {frame.name: frame.read_bytes() for frame in path.iterdir()}

    def reset(self):
        """The folder with the output before."""
        for path in self.outputs():
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        self.old = {"frame_0000.exr": OLD} if self.output == "out" else OLD
        path = self.folder / self.output
        if self.output == "out":
            path.mkdir()
            path /= "frame_0000.exr"
        path.write_bytes(OLD)

    def is_new(self, content):
        """Recordings hold the time, so that only their frames are the same."""
        if not self.output.endswith(".strec"):
            return content == self.new
        return self.kept_frames(content) == len(self.frames) and content.count(BLOCK) == len(self.frames) + 2

    def kept_frames(self, content):
        """How many frames a recording begins with; -1 if it holds others too."""
        kept = 0
        while kept < len(self.frames) and self.frames[kept] in content:
            kept += 1
        return kept if content.count(BLOCK) - kept in (1, 2) else -1  # session and end

    def is_beginning(self, content):
        """Of what a camera has sent: at least a frame."""
        if self.output.endswith(".strec"):
            return self.kept_frames(content) > 0
        last = content.rfind(PACKET)  # that may be half, or the index of a shorter stream
        return last >= 0 and content[:last] == self.new[:last]

    def check(self, outcome):
        """What holds after each run that was not killed."""
        self.assertIn(outcome.code, (OK, INPUT, DEVICE), outcome.said)
        now = self.content(self.output)
        hidden = [path for path in self.outputs() if path.name != self.output]
        if outcome.code == OK:
            self.assertTrue(self.is_new(now), "exit code 0, but not the output")
            self.assertEqual((outcome.said, hidden), ("", []))
            return "harmless"
        lines = outcome.said.splitlines()
        kept = [line for line in lines if re.search(r"(kept|left beside the outputs: \S+)$", line)]
        told = [line for line in lines if line not in kept]
        self.assertEqual(len(told), 1, outcome.said)
        self.assertRegex(told[0], rf"^stipple: error: (({self.output}|light\.npy|frames|clip\.stipple|/)\S*: .|"
                                  rf"{NO_MEMORY}$|{NO_THREAD}|{NO_WORKER})")
        self.assertNotIn("damaged", outcome.said)
        for path in hidden:
            self.assertIn(path.name, outcome.said)
            self.assertTrue(self.is_whole(self.content(path.name)) or "left beside" in outcome.said, outcome.said)
        if any(line.endswith("kept") for line in kept):
            self.assertTrue(self.is_beginning(now), outcome.said)
            return "kept"
        self.assertTrue(now == self.old or self.is_new(now), outcome.said)
        return "old" if now == self.old else "new"

    def is_whole(self, content):
        if self.output == "out":  # that it could not be removed is told too
            return content.items() <= self.old.items() or content == self.new
        return content == self.old or self.is_new(content) or self.is_beginning(content)


class FaultsTest(FaultyRuns):
    def faults(self):
        for kind, errors in ERRORS.items():
            for index, number in enumerate(some(self.calls[kind], 1000 if LONG else 4)):
                for error in errors if LONG else [errors[index % len(errors)]]:
                    yield Fault(kind, number, error, lasting=error != SHORT and index % 2 == 1)
        for number in range(1, self.calls["memory"] + 1) if EVERY else ():
            yield Fault("memory", number, errno.ENOMEM)
            yield Fault("memory", number, errno.ENOMEM, lasting=True)
        for number in some(self.calls["memory"], 600 if LONG else 8):
            yield Fault("memory", number, errno.ENOMEM, lasting=number % 2 == 0)
        for number in some(self.calls["memory"] // 3, 300 if LONG else 6):  # after the command line
            yield Fault("memory", self.calls["memory"] - number, errno.ENOMEM)
        for size in (256, 4096, 65536):
            for number in range(1, 40 if LONG else 3):
                yield Fault("memory", number, errno.ENOMEM, lasting=number == 1, min_bytes=size)

    def sweep(self, name):
        self.prepare_one(name)
        outcomes = {}
        for fault in self.faults():
            with self.subTest(str(fault)):
                self.reset()
                outcome = self.check(self.program.run(fault))
                outcomes[outcome] = outcomes.get(outcome, 0) + 1
        print(f"{name}: {sum(outcomes.values())} faults: {outcomes}")

    def test_emulate(self):
        self.sweep("emulate")

    def test_emulate_images(self):
        self.sweep("images")

    def test_decode(self):
        self.sweep("decode")

    def test_decode_to_a_folder(self):
        self.sweep("folder")

    def test_record(self):
        self.sweep("record")

    def test_live(self):
        self.sweep("live")


class KilledTest(FaultyRuns):
    """SIGKILL at random moments, which the calls count: also half-way through a write."""

    def moments(self, count):
        rng = random.Random(SEED)
        for one in range(count):
            kind = ("any", "write", "open", "sync", "rename", "memory")[one % 6]
            yield Fault(kind, rng.randint(1, self.calls[kind]), KILL)

    def whole(self, content):
        """Packets or frames that are whole in what is left."""
        if self.output.endswith(".strec"):
            return sum(frame in content for frame in self.frames)
        starts = [found.start() for found in re.finditer(re.escape(PACKET), self.new)]
        self.assertEqual(content, self.new[:len(content)])
        return min(sum(start <= len(content) for start in starts[1:]), len(self.frames))

    def kill(self, name):
        self.prepare_one(name)
        left = 0
        for fault in self.moments(200 if LONG else 12):
            with self.subTest(str(fault)):
                self.reset()
                outcome = self.program.run(fault)
                if outcome.code == OK:
                    continue  # threads: this time it had fewer calls
                self.assertEqual((outcome.code, outcome.said), (-signal.SIGKILL, ""))
                now = self.content(self.output)
                self.assertTrue(now == self.old or self.is_new(now), "the output before is not whole")
                for path in self.outputs():
                    if path.name != self.output and name in ("emulate", "record", "live"):
                        left += 1
                        self.recover(path.name)
        print(f"{name}: {left} hidden files")

    def recover(self, hidden):
        whole = self.whole(self.content(hidden))
        if whole == 0:
            self.assertEqual(self.run_program("recover", hidden, "-o", "saved").returncode, INPUT)
        else:
            self.assertEqual(self.figures("recover", hidden, "-o", "saved")["whole"], whole)

    def test_emulate(self):
        self.kill("emulate")

    def test_decode(self):
        self.kill("decode")

    def test_record(self):
        self.kill("record")

    def test_live(self):
        self.kill("live")


if __name__ == "__main__":
    unittest.main()
