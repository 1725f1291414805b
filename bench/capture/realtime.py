#!/usr/bin/env python3
"""A camera of 640x480 Mono16 at 200 frames/s, recorded and emulated live, with and without preview:
frames lost, slots late.

usage: realtime.py [STIPPLE [SECONDS [FOLDER]]]     build/release/stipple, 10 s, temporary files

The camera is `stipple capture serve` on the loopback of a network namespace of its own, all on this
machine: it takes its share of the cores as well.
"""

import json
import os
import subprocess
import sys
import tempfile

import numpy

SHAPE, RATE, FRAMES = (480, 640), 200, 64
ADDRESS = "127.0.0.1"


def enter_namespace():
    """Runs this program again where no other camera and no other interface is."""
    if os.environ.get("STIPPLE_NAMESPACE"):
        return
    script = 'ip link set lo up && exec "$0" "$@"'
    os.environ["STIPPLE_NAMESPACE"] = "1"
    os.execvp("unshare", ["unshare", "-Urn", "sh", "-c", script, sys.executable, *sys.argv])


def write_footage(file):
    """A texture that moves by a pixel a frame: sums of noise at three scales, up to full scale."""
    random = numpy.random.default_rng(1)
    picture = sum(numpy.kron(random.random((SHAPE[0] // s, SHAPE[1] // s)), numpy.ones((s, s)))
                  for s in (1, 8, 32)) / 3 * 65535
    numpy.save(file, numpy.stack([numpy.roll(picture, slot, axis=1) for slot in range(FRAMES)])
               .astype(numpy.uint16))


def start_camera(stipple, footage):
    camera = subprocess.Popen([stipple, "capture", "serve", footage, "--format", "Mono16", "--fps",
                               str(RATE), "--repeat", "--address", ADDRESS],
                              stdout=subprocess.PIPE, text=True)
    line = camera.stdout.readline()
    if not line.startswith("READY"):
        sys.exit(f"the camera did not start: {line}")
    return camera


def capture(stipple, command, seconds, output, *arguments):
    done = subprocess.run([stipple, "capture", command, f"gige:{ADDRESS}", "-o", output, "--force",
                           "--seconds", str(seconds), "-q", "--json", "-", *arguments],
                          capture_output=True, text=True)
    sys.stderr.write(done.stderr)
    return json.loads(done.stdout)


def emulate_live(stipple, seconds, folder, method):
    preview = () if method is None else ("--preview", os.path.join(folder, "now.png"),
                                         "--preview-method", method)
    live = capture(stipple, "live", seconds, os.path.join(folder, "clip.stipple"), *preview)
    latency = live["latency_us"]
    print(f"live, preview {method}: {live['frames']} frames, lost {sum(live['lost'].values())},"
          f" late {live['late_slots']}, held {live['held_slots']}; frame in to packet out:"
          f" median {latency['median'] / 1e3:.2f} ms, p99 {latency['p99'] / 1e3:.2f} ms,"
          f" max {latency['max'] / 1e3:.2f} ms; queue up to {live['queue_peak_frames']}")
    if method is not None:
        shown = live["preview"]
        print(f"        {shown['made']} pictures, delay {shown['delay_ms']}")


def main():
    stipple = sys.argv[1] if len(sys.argv) > 1 else "build/release/stipple"
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 10
    enter_namespace()
    with tempfile.TemporaryDirectory(dir=sys.argv[3] if len(sys.argv) > 3 else None) as folder:
        footage = os.path.join(folder, "footage.npy")
        write_footage(footage)
        camera = start_camera(stipple, footage)
        try:
            record = capture(stipple, "record", seconds, os.path.join(folder, "clip.strec"))
            print(f"record: {record['frames']} frames in {record['seconds']:.2f} s,"
                  f" lost {sum(record['lost'].values())} {record['lost']}")
            for method in (None, "naive", "fast"):
                emulate_live(stipple, seconds, folder, method)
        finally:
            camera.terminate()
            camera.wait()


if __name__ == "__main__":
    main()
