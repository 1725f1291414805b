#!/usr/bin/python3
"""Voxels a second of stipple.dataset by processes, and those of a second of a core, which other programs do not change.

    PYTHONPATH=build/release/python tests/bench/study/dataset_rate.py"""

import argparse
import multiprocessing
import os
import time

import numpy as np
import stipple

AUGMENTED = {"speed": (1, 2), "shake": 0.5, "light": (0.2, 2), "contrast": (0.8, 1.5)}


def make(data, begin, end):
    for index in range(begin, end):
        data[index]


def rate(data, processes, items):
    """Mvoxel/s of all processes, and of a second of a core; the best of three."""
    best, of_core = 0.0, 0.0
    voxels = processes * items * np.prod(data._size) / 1e6
    for _ in range(3):
        parts = [multiprocessing.get_context("fork").Process(target=make, args=(data, i * items, (i + 1) * items))
                 for i in range(processes)]
        begin, used = time.monotonic(), sum(os.times()[2:4])
        for part in parts:
            part.start()
        for part in parts:
            part.join()
        best = max(best, voxels / (time.monotonic() - begin))
        of_core = max(of_core, voxels / (sum(os.times()[2:4]) - used))
    return f"{best:.0f} ({of_core:.0f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--items", type=int, default=100, help="of a process")
    parser.add_argument("--processes", type=int, nargs="*", default=[1, 2])
    options = parser.parse_args()
    footage = np.random.default_rng(1).uniform(0, 1, (80, 256, 256)).astype(np.float32)
    print("| crop | sensor | augmentation |", " | ".join(f"{n} processes" for n in options.processes), "| Mvoxel/s (of a core)")
    for crop in ((64, 64), (128, 128)):
        for sensor in ("paper", "paper_black"):
            for name, changes in (("no", {}), ("all", AUGMENTED)):
                data = stipple.dataset(footage, sensor, "tiled", crop, 32, 100 * max(options.processes) * options.items,
                                       **changes)
                rates = [rate(data, n, options.items) for n in options.processes]
                print(f"| {crop[0]} x {crop[1]} | {sensor} | {name} |", " | ".join(rates), "|", flush=True)


if __name__ == "__main__":
    main()
