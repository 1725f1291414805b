#!/usr/bin/env python3
"""Hours of `stipple capture live` from `stipple capture serve`: 640x480 Mono8, 200 frames/s, one packet
in a thousand never sent. Every frame of the camera is of one level, the next of another, and the
sensor has no noise, so that each slot of the stream can be checked as it is written:

- the samples of a slot have as many values as there are exposure times, and a longer exposure has
  the sum of its slots: no part of an incomplete frame, and no frame at a wrong place, became light;
- a slot has the level of the next frame, or the one before (held): these are counted.

usage: long_live.py [--stall S] [--rate HZ] [STIPPLE [SECONDS [FOLDER [CAMERA-OPTION]...]]]
       build/release/stipple, 7200 s, temporary files, --fault-lose 0.001

With --stall the emulating thread of `live` stands still for S seconds, from the 70th second on, every
10 s: the queue fills, as when the machine is busy. 64 frame periods and more fill it.

Slots that are checked are cut out of the file (holes), so that it takes no more than some 100 MB of
the disk, though it is 33 MB/s long. Exit code 1 if anything is wrong, or if the memory of `live` or of
`serve` grows by more than 5 MB after the first minute.
"""

import argparse
import ctypes
import glob
import json
import os
import struct
import subprocess
import sys
import tempfile
import time

import numpy

from realtime import ADDRESS, RATE, SHAPE, Namespace

LEVELS = numpy.arange(97) * 61 % 97 * 2 + 40  # one after the other differ, by 72 or more
EXPOSURES = 4  # of schedule random: 1, 2, 4, 8 slots
PACKET, INDEX, HEADER_BYTES = b"\xc5SPK", 3, 36  # docs/stream_format.md
MAX_GROWTH_MB, SETTLED_S, EACH_S = 5.0, 60, 10
FALLOC_FL_KEEP_SIZE, FALLOC_FL_PUNCH_HOLE = 1, 2
PTRACE_DETACH, PTRACE_SEIZE, PTRACE_INTERRUPT, WALL = 17, 0x4206, 0x4207, 0x40000000
LIBC = ctypes.CDLL(None, use_errno=True)


def write_footage(file):
    numpy.save(file, numpy.broadcast_to(LEVELS[:, None, None], (len(LEVELS), *SHAPE))
               .astype(numpy.uint8))


class Slots:
    """What the slots of a stream hold, one after the other."""

    def __init__(self):
        self.count = self.held = 0
        self.either = 0  # held or not: in a long gap the turn comes round to the level that is held
        self.faults = []
        self.frame = None  # whose turn it is, in LEVELS
        self.shown = []  # levels in DN of the newest slots

    def fault(self, text):
        self.faults.append(f"slot {self.count}: {text}")

    def add(self, samples, dn_of):
        values = numpy.flatnonzero(numpy.bincount(samples, minlength=1 << 16))
        level = int(values[0])
        if self.frame is None:
            self.frame = int(numpy.argmin(abs(dn_of - level)))
        else:
            self.frame = (self.frame + 1) % len(LEVELS)
        on_turn = abs(level - dn_of[self.frame]) <= 1  # half a DN may be rounded either way
        as_before = bool(self.shown) and level == self.shown[-1]
        self.held += as_before and not on_turn
        self.either += as_before and on_turn
        if not on_turn and not as_before:
            self.fault(f"level {level}, neither {dn_of[self.frame]} nor that of the slot before")
        self.shown = [*self.shown[-7:], level]
        if len(self.shown) == 8:
            sums = [sum(self.shown[-n:]) for n in (1, 2, 4, 8)]
            if len(values) != EXPOSURES or max(abs(values - sums)) > 8:  # each level is rounded
                self.fault(f"values {values[:8]}, not {sums}")
        self.count += 1


class Follower:
    """Checks the packets of a stream that is being written, and frees the disk behind them."""

    def __init__(self, file, dn_of):
        self.file = os.open(file, os.O_RDWR)
        self.dn_of, self.slots = dn_of, Slots()
        self.at = self.freed = 0
        self.ended = False

    def follow(self):
        """All packets that are whole by now."""
        if self.at == 0:
            start = os.pread(self.file, 16, 0)
            if len(start) < 16:
                return
            self.at = struct.unpack_from("<I", start, 12)[0]
        while not self.ended:
            header = os.pread(self.file, HEADER_BYTES, self.at)
            size = struct.unpack_from("<I", header, 24)[0] if len(header) == HEADER_BYTES else 0
            payload = os.pread(self.file, size, self.at + HEADER_BYTES) if header else b""
            if len(header) < HEADER_BYTES or len(payload) < size:
                break
            self.ended = header[:4] != PACKET or header[4] == INDEX
            if not self.ended:
                self.slots.add(numpy.frombuffer(payload, "<u2"), self.dn_of)
                self.at += HEADER_BYTES + size
        self.free()

    def free(self):
        end = self.at // 4096 * 4096
        begin = max(self.freed, 1 << 20)  # the header stays
        if end - begin < 1 << 26:
            return
        mode = FALLOC_FL_KEEP_SIZE | FALLOC_FL_PUNCH_HOLE
        if LIBC.fallocate(self.file, mode, ctypes.c_long(begin), ctypes.c_long(end - begin)) != 0:
            sys.exit(f"no holes can be made in a file here: {os.strerror(ctypes.get_errno())}")
        self.freed = end


def stall(process, seconds):
    """Stops the first thread of a process, which emulates, and no other (ptrace)."""
    def trace(request):
        if LIBC.ptrace(request, process.pid, None, None) != 0:
            sys.exit(f"the emulating thread cannot be stopped: {os.strerror(ctypes.get_errno())}")

    trace(PTRACE_SEIZE)
    trace(PTRACE_INTERRUPT)
    os.waitpid(process.pid, WALL)
    time.sleep(seconds)
    trace(PTRACE_DETACH)


def resident_mb(process):
    """What the process holds, without pages of files."""
    with open(f"/proc/{process.pid}/status", encoding="ascii") as file:
        line = next((line for line in file if line.startswith("RssAnon")), "RssAnon: 0")
    return int(line.split()[1]) / 1024


class Memory:
    """Of a process, from the first minute on."""

    def __init__(self, process):
        self.process, self.first, self.most, self.last = process, None, 0.0, 0.0

    def look(self, seconds):
        now = resident_mb(self.process)
        if seconds < SETTLED_S or now == 0:
            return
        self.first = self.first or now
        self.most, self.last = max(self.most, now), now

    def growth(self):
        return self.most - (self.first or 0)

    def text(self):
        return (f"{self.first or 0:.1f} MB after {SETTLED_S} s, at most {self.most:.1f}, "
                f"{self.last:.1f} at the end")


def start_camera(stipple, footage, rate, options, figures):
    camera = subprocess.Popen(
        [*stipple, "capture", "serve", footage, "--format", "Mono8", "--frames-hz", f"{rate:g}", "--repeat",
         "--address", ADDRESS, "--json", figures, *options], stdout=subprocess.PIPE, text=True)
    line = camera.stdout.readline()
    if not line.startswith("READY"):
        sys.exit(f"the camera did not start: {line}")
    return camera


def run(stipple, camera, seconds, folder, stall_s):
    """Figures of `live`, what its slots hold, memory of both."""
    figures = os.path.join(folder, "live.json")
    live = subprocess.Popen(
        [*stipple, "capture", "live", f"gige:{ADDRESS}", "-o", os.path.join(folder, "clip.stipple"),
         "--sensor", "ideal", "--schedule", "random", "--seconds", str(seconds), "-q", "--json", figures])
    memory = {"live": Memory(live), "serve": Memory(camera)}
    full_dn = 4000  # 1000 electrons of light 1.0 a slot, 4 DN an electron
    dn_of = numpy.rint(LEVELS / 255 * full_dn).astype(int)
    begun, looked, follower = time.monotonic(), 0.0, None
    while live.poll() is None:
        time.sleep(0.1)
        passed = time.monotonic() - begun
        found = glob.glob(os.path.join(glob.escape(folder), ".clip.*.partial.stipple"))
        if follower is None and found:
            follower = Follower(found[0], dn_of)
        if follower:
            follower.follow()
        if passed - looked >= EACH_S:
            looked = passed
            if stall_s > 0 and passed > SETTLED_S + EACH_S:
                stall(live, stall_s)
            for each in memory.values():
                each.look(passed)
            if follower is None:
                sys.exit(f"no stream is being written after {EACH_S} s")
            print(f"{passed:7.0f} s, {follower.slots.count} slots, {follower.slots.held} held, "
                  f"{len(follower.slots.faults)} faults, live {memory['live'].last:.1f} MB, "
                  f"serve {memory['serve'].last:.1f} MB", file=sys.stderr, flush=True)
    if follower is None:
        sys.exit(f"nothing was recorded; exit code {live.returncode}")
    follower.follow()
    if live.returncode != 0:
        follower.slots.fault(f"exit code {live.returncode}")
    with open(figures, encoding="utf-8") as file:
        return json.load(file), follower.slots, memory


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--stall", type=float, default=0)
    parser.add_argument("--rate", type=float, default=RATE)
    known, given = parser.parse_known_args()
    stipple, seconds, parent, *options = given + ["build/release/stipple", "7200", None][len(given):]
    options = options or ["--fault-lose", "0.001"]
    with tempfile.TemporaryDirectory(dir=parent) as folder, Namespace() as inside:
        footage, figures = os.path.join(folder, "levels.npy"), os.path.join(folder, "serve.json")
        write_footage(footage)
        camera = start_camera([*inside, stipple], footage, known.rate, options, figures)
        try:
            live, slots, memory = run([*inside, stipple], camera, float(seconds), folder, known.stall)
        finally:
            camera.terminate()
            camera.wait()
        with open(figures, encoding="utf-8") as file:
            print(f"serve: {file.read()}")
    lost = sum(live["lost"].values())
    live["late"] = len(live["late"])
    print(f"live: {json.dumps(live)}")
    print(f"{slots.count} slots checked, {slots.held} to {slots.held + slots.either} of them held; "
          f"complete frames {live['frames']}, incomplete {live['incomplete']}, lost {lost}, "
          f"repeated {live['repeated']}")
    for name, each in memory.items():
        print(f"memory of {name}: {each.text()}")
    if slots.count != live["slots"]:
        slots.fault(f"the stream should have {live['slots']} slots")
    held = live["incomplete"] + lost
    if not slots.held <= held <= slots.held + slots.either or live["frames"] + held != slots.count:
        slots.fault("slots, frames and held ones do not agree")
    faults = slots.faults + [f"{name} grew by {each.growth():.1f} MB"
                             for name, each in memory.items() if each.growth() > MAX_GROWTH_MB]
    print("\n".join(faults[:20]) or "nothing wrong")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
