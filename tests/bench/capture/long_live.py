#!/usr/bin/env python3
"""Hours of `stipple capture live` from `stipple capture serve`: 640x480 Mono8, 200 frames/s, one packet
in a thousand never sent. Every frame of the camera is of one level, the next of another, and the
sensor has no noise, so that each slot of the stream can be checked as it is written:

- the samples of a slot have as many values as there are exposure times, and a longer exposure has
  the sum of its slots: no part of an incomplete frame, and no frame at a wrong place, became light;
- a slot has the level of the next frame, or the one before (held): these are counted;
- a slot without samples (dropped, as the queue was full) counts as held;
- only where the camera was gone may the levels begin anew: once for each such outage.

usage: long_live.py [--stall S] [--rate HZ] [STIPPLE [SECONDS [FOLDER [CAMERA-OPTION]...]]]
       build/release/stipple, 7200 s, temporary files, --fault-lose 0.001

With --stall the emulating thread of `live` stands still for S seconds, from the 70th second on, every
10 s: the queue fills, as when the machine is busy. 64 frame periods and more fill it.

Slots that are checked are cut out of the file (holes), so that it takes no more than some 100 MB of
the disk, though it is 33 MB/s long. Totals come at the end, on standard output, and progress meanwhile,
on standard error. SIGTERM ends the run early, with its totals. Exit code 1 if anything is wrong, or if
the memory of `live` or of `serve` grows by more than 5 MB after the first minute.
"""

import argparse
import ctypes
import glob
import json
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time

import numpy

from realtime import ADDRESS, RATE, SHAPE, Namespace

LEVELS = numpy.arange(97) * 61 % 97 * 2 + 40  # one after the other differ, by 72 or more
EXPOSURES = 4  # of schedule random: 1, 2, 4, 8 slots
PACKET, INDEX, DROPPED, HEADER_BYTES = b"\xc5SPK", 3, 2, 36  # docs/stream_format.md
MAX_GROWTH_MB, SETTLED_S, EACH_S = 5.0, 60, 10
MARKS_S = (SETTLED_S, 3600, 7200)  # when memory is reported
START_S, END_S = 60, 120  # a busy machine may take so long to begin, and to end
MAX_TEXTS = 20
STOPPED = (-signal.SIGTERM, 128 + signal.SIGTERM)
FALLOC_FL_KEEP_SIZE, FALLOC_FL_PUNCH_HOLE = 1, 2
PTRACE_DETACH, PTRACE_SEIZE, PTRACE_INTERRUPT, WALL = 17, 0x4206, 0x4207, 0x40000000
LIBC = ctypes.CDLL(None, use_errno=True)


def write_footage(file):
    numpy.save(file, numpy.broadcast_to(LEVELS[:, None, None], (len(LEVELS), *SHAPE))
               .astype(numpy.uint8))


class Slots:
    """What the slots of a stream hold, one after the other."""

    def __init__(self):
        self.count = self.held = self.dropped = 0
        self.either = 0  # held or not: in a long gap the turn comes round to the level that is held
        self.fault_count, self.faults = 0, []  # the first of them as text
        self.jumps = []  # where the levels begin anew
        self.outages = 0  # of the camera
        self.frame = None  # whose turn it is, in LEVELS
        self.shown = []  # levels in DN of the newest slots

    def fault(self, text):
        self.fault_count += 1
        if self.fault_count <= MAX_TEXTS:
            self.faults.append(f"slot {self.count}: {text}")

    def add(self, samples, dn_of):
        values = numpy.flatnonzero(numpy.bincount(samples, minlength=1 << 16))
        if len(values) > 0:
            self.take(values, dn_of)
        else:
            self.fault("no samples")
        self.count += 1

    def drop(self):
        self.frame = (self.frame + 1) % len(LEVELS)
        self.shown = [*self.shown[-7:], self.shown[-1]]
        self.held += 1
        self.dropped += 1
        self.count += 1

    def take(self, values, dn_of):
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
            self.jump(level, dn_of)
        self.shown = [*self.shown[-7:], level]
        if len(self.shown) == 8:
            sums = [sum(self.shown[-n:]) for n in (1, 2, 4, 8)]
            if len(values) != EXPOSURES or max(abs(values - sums)) > 8:  # each level is rounded
                self.fault(f"values {values[:8]}, not {sums}")

    def jump(self, level, dn_of):
        text = f"level {level}, neither {dn_of[self.frame]} nor that of the slot before"
        nearest = int(numpy.argmin(abs(dn_of - level)))
        if abs(level - dn_of[nearest]) > 1:
            self.fault(text + ", and of no frame")
        elif len(self.jumps) < MAX_TEXTS:
            self.jumps.append(f"slot {self.count}: {text}")
        else:
            self.fault(text)
        self.frame = nearest

    def allow_jumps(self, outages):
        """The levels begin anew once for each outage; more often is a fault."""
        self.outages = outages
        for text in self.jumps[outages:]:
            self.fault_count += 1
            self.faults.append(text)


class Follower:
    """Checks the packets of a stream that is being written, and frees the disk behind them."""

    def __init__(self, file, dn_of):
        self.file = os.open(file, os.O_RDWR)
        self.dn_of, self.slots = dn_of, Slots()
        self.at = self.freed = 0
        self.ended = False

    def follow(self, seconds=float("inf")):
        """The packets that are whole by now, as far as the time goes."""
        until = time.monotonic() + seconds
        if self.at == 0:
            start = os.pread(self.file, 16, 0)
            if len(start) < 16:
                return
            self.at = struct.unpack_from("<I", start, 12)[0]
        while not self.ended and time.monotonic() < until:
            header = os.pread(self.file, HEADER_BYTES, self.at)
            size = struct.unpack_from("<I", header, 24)[0] if len(header) == HEADER_BYTES else 0
            payload = os.pread(self.file, size, self.at + HEADER_BYTES) if header else b""
            if len(header) < HEADER_BYTES or len(payload) < size:
                break
            self.ended = header[:4] != PACKET or header[4] == INDEX
            if not self.ended and header[5] & DROPPED:
                self.slots.drop()
                self.at += HEADER_BYTES
            elif not self.ended:
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
        self.process, self.most, self.last = process, 0.0, 0.0
        self.seen = []  # (s, MB) at each mark that was reached
        self.passed = 0.0

    def look(self, seconds):
        now = resident_mb(self.process)
        if now == 0:  # it has ended
            return
        self.last, self.passed = now, seconds
        if len(self.seen) < len(MARKS_S) and seconds >= MARKS_S[len(self.seen)]:
            self.seen.append((MARKS_S[len(self.seen)], now))
        if self.seen:
            self.most = max(self.most, now)

    def growth(self):
        return self.most - self.seen[0][1] if self.seen else 0.0

    def text(self):
        marks = [*self.seen, (self.passed, self.last)]
        return (", ".join(f"{mb:.1f} MB at {seconds:.0f} s" for seconds, mb in marks)
                + f" (the last); growth after {SETTLED_S} s: {self.growth():.1f} MB")


def start_camera(stipple, footage, rate, options, figures):
    camera = subprocess.Popen(
        [*stipple, "capture", "serve", footage, "--format", "Mono8", "--frames-hz", f"{rate:g}", "--repeat",
         "--address", ADDRESS, "--json", figures, *options], stdout=subprocess.PIPE, text=True)
    line = camera.stdout.readline()
    if not line.startswith("READY"):
        sys.exit(f"the camera did not start: {line}")
    return camera


def follow_to_end(live, folder, seconds, stall_s, memory):
    """Checks the stream while `live` writes it; the follower, None if there was no stream."""
    full_dn = 4000  # 1000 electrons of light 1.0 a slot, 4 DN an electron
    dn_of = numpy.rint(LEVELS / 255 * full_dn).astype(int)
    begun, told, follower = time.monotonic(), 0.0, None
    while live.poll() is None:
        time.sleep(0.1)
        passed = time.monotonic() - begun
        found = glob.glob(os.path.join(glob.escape(folder), ".clip.*.partial.stipple"))
        if follower is None and found:
            follower = Follower(found[0], dn_of)
        if follower is None and passed > START_S:
            sys.exit(f"no stream is being written after {START_S} s")
        if passed > seconds + START_S + END_S:
            sys.exit(f"`live` does not end after {seconds:g} s")
        if follower:
            follower.follow(seconds=1)
        for each in memory.values():
            each.look(passed)
        if follower and passed - told >= EACH_S:
            told = passed
            slots = follower.slots
            print(f"{passed:7.0f} s, {slots.count} slots, {slots.held} held, "
                  f"{slots.fault_count} faults, {len(slots.jumps)} jumps, live "
                  f"{memory['live'].last:.1f} MB, serve {memory['serve'].last:.1f} MB",
                  file=sys.stderr, flush=True)
            if stall_s > 0 and passed > SETTLED_S + EACH_S:
                stall(live, stall_s)
    if follower:
        follower.follow()
    return follower


def run(stipple, camera, seconds, folder, stall_s):
    """Figures of `live` (None: it gave none), what its slots hold, memory of both."""
    figures, log = os.path.join(folder, "live.json"), os.path.join(folder, "live.log")
    with open(log, "wb") as messages:
        live = subprocess.Popen(
            [*stipple, "capture", "live", f"gige:{ADDRESS}", "-o",
             os.path.join(folder, "clip.stipple"), "--sensor", "ideal", "--schedule", "random",
             "--seconds", str(seconds), "-q", "--json", figures], stderr=messages)
    signal.signal(signal.SIGTERM, lambda *_: live.terminate())
    memory = {"live": Memory(live), "serve": Memory(camera)}
    try:
        follower = follow_to_end(live, folder, seconds, stall_s, memory)
    finally:
        if live.poll() is None:
            live.kill()
        live.wait()
        with open(log, encoding="utf-8") as file:
            messages = file.read()
        sys.stderr.write(messages)
    if follower is None:
        sys.exit(f"nothing was recorded; exit code {live.returncode}")
    slots = follower.slots
    slots.allow_jumps(outages=messages.count("camera lost ("))
    if live.returncode != 0 and live.returncode not in STOPPED:
        slots.fault(f"exit code {live.returncode}")
    return read_json(figures), slots, memory


def read_json(file):
    """None if there is no such file."""
    if not os.path.exists(file):
        return None
    with open(file, encoding="utf-8") as text:
        return json.load(text)


def print_totals(live, slots, memory):
    """A line for each; compares the figures of `live` with the slots."""
    print(f"slots checked: {slots.count}")
    print(f"slots held: {slots.held} to {slots.held + slots.either}")
    if live is None:
        slots.fault("`live` gave no figures")
    else:
        lost = sum(live["lost"].values())
        dropped = live["lost"]["queue_drop"]
        print(f"frames complete: {live['frames']}\n"
              f"frames incomplete: {live['incomplete']}\n"
              f"frames dropped, queue full: {dropped}\n"
              f"frames lost otherwise: {lost - dropped}\n"
              f"frames repeated: {live['repeated']}\n"
              f"slots late: {live['late_slots']}; latency in us: {live['latency_us']}")
        held = live["incomplete"] + lost
        if slots.count != live["slots"]:
            slots.fault(f"the stream should have {live['slots']} slots")
        if slots.dropped != live["dropped_slots"]:
            slots.fault(f"{slots.dropped} slots have no samples, not {live['dropped_slots']}")
        if not slots.held <= held <= slots.held + slots.either or live["frames"] + held != slots.count:
            slots.fault("slots, frames and held ones do not agree")
    print(f"outages: {slots.outages}, the levels begin anew: {len(slots.jumps)} times")
    for name, each in memory.items():
        print(f"memory of {name}: {each.text()}")
        if each.growth() > MAX_GROWTH_MB:
            slots.fault(f"{name} grew by {each.growth():.1f} MB")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--stall", type=float, default=0)
    parser.add_argument("--rate", type=float, default=RATE)
    known, given = parser.parse_known_args()
    stipple, seconds, parent, *options = given + ["build/release/stipple", "7200", None][len(given):]
    options = options or ["--fault-lose", "0.001"]
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("stopped before the first frame"))
    with tempfile.TemporaryDirectory(dir=parent) as folder, Namespace() as inside:
        footage, figures = os.path.join(folder, "levels.npy"), os.path.join(folder, "serve.json")
        write_footage(footage)
        camera = start_camera([*inside, stipple], footage, known.rate, options, figures)
        try:
            live, slots, memory = run([*inside, stipple], camera, float(seconds), folder, known.stall)
        finally:
            camera.terminate()
            camera.wait()
        print(f"serve: {json.dumps(read_json(figures))}")
    if live is not None:
        live["late"] = len(live["late"])
    print(f"live: {json.dumps(live)}")
    print_totals(live, slots, memory)
    print("\n".join(slots.faults) or "nothing wrong")
    sys.exit(1 if slots.fault_count > 0 else 0)


if __name__ == "__main__":
    main()
