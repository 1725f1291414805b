"""Frames before the end: --until, and streams that are still being written."""

import os
import signal
import subprocess
import time
import unittest
from itertools import accumulate

import numpy as np
from program import INPUT, STOPPED, ProgramTest
from sample_stream import parts

CORE, REST = 48, 16  # decoder/block_partition.h: slots of a block, and of a rest that it takes along


def packet_begins(content):
    """Offsets of the packets of a stream, and of its end marker."""
    header, packets, _ = parts(content)
    return list(accumulate(map(len, packets), initial=len(header)))


class UntilTest(ProgramTest):
    def test_gives_the_first_frames_of_the_whole(self):
        self.write_stream(slots=130)
        self.succeed("decode", "clip.stipple", "-o", "all.npy", "--method", "fast")
        for until in (1, 48, 49, 129):
            figures = self.figures("decode", "clip.stipple", "-o", "first.npy", "--method", "fast",
                                   "--until", until, "--force")
            self.assertEqual((figures["slots"], figures["ended_by"]), (until, "until"))
            np.testing.assert_array_equal(self.array("first.npy"), self.array("all.npy")[:until])

    def test_reads_no_further_than_it_needs(self):
        path = self.folder / self.write_stream(slots=130)
        begins = packet_begins(path.read_bytes())
        self.change_byte(path.name, begins[CORE + REST + 1] + 40)
        self.succeed("decode", path.name, "-o", "first.npy", "--method", "naive", "--until", 48)
        done = self.run_program("decode", path.name, "-o", "more.npy", "--method", "naive",
                                "--until", 49)
        self.assertEqual(done.returncode, INPUT)
        self.assertEqual(len(self.array("more.npy")), 49)

    def test_beyond_the_end_says_where_that_is(self):
        self.write_stream(slots=30)
        done = self.run_program("decode", "clip.stipple", "-o", "all.npy", "--method", "naive",
                                "--until", 31)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("ends after 30 slots, before --until 31", done.stderr)
        self.assertEqual(len(self.array("all.npy")), 30)


class FollowTest(ProgramTest):
    """Time limits here only end a test that hangs."""

    def setUp(self):
        super().setUp()
        path = self.folder / self.write_stream("whole.stipple", slots=130)
        self.content = path.read_bytes()
        self.begins = packet_begins(self.content)
        self.succeed("decode", "whole.stipple", "-o", "all.npy", "--method", "fast")
        self.live = self.folder / "live.stipple"
        self.written = 0

    def write_up_to(self, offset):
        with self.live.open("ab") as file:
            file.write(self.content[self.written:offset])
        self.written = offset

    def follow(self, *arguments, **options):
        program = self.start_program("decode", "live.stipple", "-o", "out", "--method", "fast",
                                     "--follow", "--timeout", 600, *arguments,
                                     stdout=subprocess.DEVNULL, **options)
        self.addCleanup(program.communicate)
        self.addCleanup(program.kill)
        return program

    def frames(self):
        folder = self.folder / "out"
        return len(list(folder.glob("frame_*.exr"))) if folder.exists() else 0

    def test_a_stream_is_followed_before_it_has_its_name(self):
        np.lib.format.open_memmap(self.folder / "light.npy", "w+", np.uint8, (100000, 32, 32))
        writer = self.start_program("emulate", "light.npy", "-o", "live.stipple")
        self.addCleanup(writer.kill)
        program = self.follow()
        deadline = time.monotonic() + 100
        while self.frames() < CORE:
            self.assertIsNone(program.poll())
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)
        self.assertFalse(self.live.exists())
        writer.send_signal(signal.SIGINT)  # it completes a shorter stream
        writer.communicate(timeout=100)
        program.send_signal(signal.SIGINT)
        self.assertEqual(program.wait(timeout=100), STOPPED)

    def test_a_pipe_that_stays_empty_ends_by_the_time_limit_or_a_signal(self):
        os.mkfifo(self.live)
        done = self.run_program("decode", "live.stipple", "-o", "out", "--follow", "--timeout", 1)
        self.assertEqual(done.returncode, INPUT, done.stderr)
        with open(self.live, "r+b", buffering=0) as pipe:  # a writer that goes on to have it open
            pipe.write(self.content[:20])
            done = self.run_program("decode", "live.stipple", "-o", "out", "--follow", "--timeout", 1)
            self.assertEqual(done.returncode, INPUT, done.stderr)
            for line in (["info", "live.stipple"], ["decode", "live.stipple", "-o", "out"],
                         ["decode", "live.stipple", "-o", "out", "--follow", "--timeout", "600"]):
                pipe.write(self.content[:20])
                program = self.start_program(*line, stdout=subprocess.DEVNULL)
                self.addCleanup(program.kill)
                time.sleep(1)
                program.send_signal(signal.SIGTERM)
                program.communicate(timeout=20)
                self.assertEqual(program.returncode, 143, line)

    def wait_for(self, program, frames):
        deadline = time.monotonic() + 100
        while self.frames() < frames and program.poll() is None and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertEqual(self.frames(), frames)

    def expect_first(self, frames):
        """The folder holds the first frames of the whole, to the bit."""
        self.succeed("compare", "out", self.write_array("first.npy", self.array("all.npy")[:frames]),
                     "--json", "figures.json")
        self.assertIn('"psnr_db": null', (self.folder / "figures.json").read_text())

    def test_frames_come_out_before_the_stream_ends(self):
        program = self.follow()  # there is no file yet
        self.write_up_to(50)  # a part of the header
        # A block goes out as soon as the slot is whole that says whether a rest belongs to it.
        self.write_up_to(self.begins[CORE + REST + 1])
        self.wait_for(program, CORE)
        self.write_up_to(self.begins[CORE + REST + 2] + 50)  # in the midst of a packet
        self.write_up_to(self.begins[2 * CORE + REST + 1])
        self.wait_for(program, 2 * CORE)
        self.write_up_to(len(self.content))
        self.assertEqual(program.wait(100), 0)
        self.assertEqual(self.frames(), 130)
        self.expect_first(130)

    def test_until_ends_it(self):
        program = self.follow("--until", 20)
        self.write_up_to(self.begins[CORE + REST + 1])
        self.assertEqual(program.wait(100), 0)
        self.expect_first(20)

    def test_ctrl_c_ends_it_and_leaves_what_there_is(self):
        program = self.follow()
        self.write_up_to(self.begins[CORE + REST + 1] + 50)
        self.wait_for(program, CORE)
        program.send_signal(signal.SIGINT)
        self.assertEqual(program.wait(100), STOPPED)
        self.expect_first(CORE)

    def cut_stream(self, end):
        self.live.write_bytes(self.content[:end])
        return self.run_program("decode", "live.stipple", "-o", "out.npy", "--method", "fast",
                                "--follow", "--timeout", 0.1)

    def test_a_stream_that_ceases_to_grow_is_decoded_as_far_as_it_goes(self):
        done = self.cut_stream(self.begins[60])
        self.assertEqual(done.returncode, 0, done.stderr)
        for part in ("nothing was appended for 0.1 s", "60 slots"):
            self.assertIn(part, done.stderr)
        self.succeed("decode", "live.stipple", "-o", "cut.npy", "--method", "fast")
        np.testing.assert_array_equal(self.array("out.npy"), self.array("cut.npy"))

    def test_a_packet_that_never_ends_is_damage_in_the_end(self):
        done = self.cut_stream(self.begins[60] + 40)
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("ends within a packet", done.stderr)
        self.assertEqual(len(self.array("out.npy")), 60)

    def test_a_stream_that_never_comes_is_refused(self):
        self.fails(INPUT, ["live.stipple", "has not appeared", "--timeout"], "decode",
                   "live.stipple", "-o", "out", "--follow", "--timeout", 0.1)
        self.live.write_bytes(self.content[:50])
        self.fails(INPUT, ["live.stipple", "header"], "decode",
                   "live.stipple", "-o", "out", "--follow", "--timeout", 0.1)


if __name__ == "__main__":
    unittest.main()
