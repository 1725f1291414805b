#!/usr/bin/env python3
"""A camera of 640x480 Mono16 at 200 frames/s, recorded and emulated live, with and without preview:
frames lost, slots late, and how often the machine itself paused meanwhile (machine_pauses.py).

usage: realtime.py [STIPPLE [SECONDS [FOLDER [METHOD]...]]]
       build/release/stipple, 10 s, temporary files, previews none naive fast

The camera is `stipple capture serve` on the loopback of a network namespace of its own, all on this
machine: it takes its share of the cores as well.
"""

import json
import os
import subprocess
import sys
import tempfile

import numpy

from machine_pauses import MachinePauses

SHAPE, RATE, FRAMES = (480, 640), 200, 64
ADDRESS = "127.0.0.1"


class Namespace:
    """Where no other camera and no other interface is."""

    def __enter__(self):
        self.keeper = subprocess.Popen(
            ["unshare", "-Urn", "sh", "-c", "ip link set lo up && echo up && exec cat"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        if self.keeper.stdout.readline() != "up\n":
            sys.exit("no network namespace can be made here")
        return ["nsenter", "-t", str(self.keeper.pid), "-U", "-n", "--preserve-credentials"]

    def __exit__(self, *_):
        self.keeper.stdin.close()
        self.keeper.wait()


def write_footage(file):
    """A texture that moves by a pixel a frame: sums of noise at three scales, up to full scale."""
    random = numpy.random.default_rng(1)
    image = sum(numpy.kron(random.random((SHAPE[0] // s, SHAPE[1] // s)), numpy.ones((s, s)))
                  for s in (1, 8, 32)) / 3 * 65535
    numpy.save(file, numpy.stack([numpy.roll(image, slot, axis=1) for slot in range(FRAMES)])
               .astype(numpy.uint16))


def start_camera(stipple, footage):
    camera = subprocess.Popen([*stipple, "capture", "serve", footage, "--format", "Mono16", "--frames-hz",
                               str(RATE), "--repeat", "--address", ADDRESS],
                              stdout=subprocess.PIPE, text=True)
    line = camera.stdout.readline()
    if not line.startswith("READY"):
        sys.exit(f"the camera did not start: {line}")
    return camera


def capture(stipple, command, seconds, output, *arguments):
    with MachinePauses() as pauses:
        done = subprocess.run([*stipple, "capture", command, f"gige:{ADDRESS}", "-o", output,
                               "--force", "--seconds", str(seconds), "-q", "--json", "-",
                               *arguments], capture_output=True, text=True)
    sys.stderr.write(done.stderr)
    return json.loads(done.stdout), pauses


def excused(late, pauses):
    times = [(slot["arrival_monotonic_ns"] * 1e-9, slot["latency_us"] * 1e-6) for slot in late]
    return sum(pauses.excuse(begin, begin + latency) for begin, latency in times)


def emulate_live(stipple, seconds, folder, method):
    preview = () if method == "none" else ("--preview", os.path.join(folder, "now.png"),
                                           "--preview-method", method)
    live, pauses = capture(stipple, "live", seconds, os.path.join(folder, "clip.stipple"), *preview)
    latency = live["latency_us"]
    print(f"live, preview {method}: {live['frames']} frames, lost {sum(live['lost'].values())},"
          f" late {live['late_slots']}, of these {excused(live['late'], pauses)} by pauses of the"
          f" machine; frame in to packet out: median {latency['median'] / 1e3:.2f} ms,"
          f" p99 {latency['p99'] / 1e3:.2f} ms, max {latency['max'] / 1e3:.2f} ms;"
          f" queue up to {live['queue_peak_frames']}\n    {pauses.text()}")
    if method != "none":
        shown = live["preview"]
        print(f"    {shown['made']} images, delay {shown['delay_ms']}")
    sys.stdout.flush()


def main():
    given = sys.argv[1:]
    stipple, seconds, parent, *methods = given + ["build/release/stipple", "10", None][len(given):]
    with tempfile.TemporaryDirectory(dir=parent) as folder, Namespace() as inside:
        footage = os.path.join(folder, "footage.npy")
        write_footage(footage)
        stipple = [*inside, stipple]
        camera = start_camera(stipple, footage)
        try:
            record, pauses = capture(stipple, "record", seconds, os.path.join(folder, "clip.strec"))
            print(f"record: {record['frames']} frames in {record['seconds']:.2f} s,"
                  f" lost {sum(record['lost'].values())} {record['lost']}\n    {pauses.text()}")
            for method in methods or ("none", "naive", "fast"):
                emulate_live(stipple, float(seconds), folder, method)
        finally:
            camera.terminate()
            camera.wait()


if __name__ == "__main__":
    main()
