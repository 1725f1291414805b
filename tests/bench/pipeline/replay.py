#!/usr/bin/env python3
"""Replay of 16-bit footage from disk: 640x480 RGB through the chip to a stream file, in slots/s.

usage: replay.py [STIPPLE [FRAMES]]     build/release/stipple, 400 frames (1.8 MB each)

The footage is an .npy in a temporary folder. Where the system lets us (root), it is dropped from the
page cache first, so that it does come from the disk.
"""

import json
import os
import subprocess
import sys
import tempfile

import numpy

SHAPE = (480, 640, 3)


def write_footage(file, frames):
    image = numpy.random.default_rng(1).integers(0, 30000, SHAPE, dtype=numpy.uint16)
    footage = numpy.lib.format.open_memmap(file, "w+", numpy.uint16, (frames, *SHAPE))
    for slot in range(frames):
        footage[slot] = numpy.roll(image, slot, axis=1)
    footage.flush()


def drop_page_cache():
    """True if the next read comes from the disk."""
    os.sync()
    try:
        with open("/proc/sys/vm/drop_caches", "w") as control:
            control.write("1")
    except OSError:
        return False
    return True


def slots_per_second(stipple, footage, stream):
    text = subprocess.run([stipple, "emulate", footage, "-o", stream, "--force", "-q", "--json",
                           "-"], check=True, capture_output=True, text=True).stdout
    return json.loads(text)["slots_per_second"]


def main():
    stipple = sys.argv[1] if len(sys.argv) > 1 else "build/release/stipple"
    frames = int(sys.argv[2]) if len(sys.argv) > 2 else 400
    with tempfile.TemporaryDirectory() as folder:
        footage = os.path.join(folder, "footage.npy")
        write_footage(footage, frames)
        for run in range(3):
            source = "disk" if drop_page_cache() else "page cache"
            rate = slots_per_second(stipple, footage, os.path.join(folder, "clip.stipple"))
            print(f"{frames} slots of 640x480 RGB uint16 from {source}: {rate:.0f} slots/s, "
                  f"{rate / 200:.2f} x real time at 200 slots/s")


if __name__ == "__main__":
    main()
