#!/usr/bin/python3
"""Voxels a second of stipple.dataset, by processes.

    PYTHONPATH=build/release/python tests/bench/study/dataset_rate.py"""

import argparse
import multiprocessing
import time

import numpy as np
import stipple

AUGMENTED = {"speed": (1, 2), "shake": 0.5, "light": (0.2, 2), "contrast": (0.8, 1.5)}


def make(data, begin, end):
    for index in range(begin, end):
        data[index]


def rate(data, processes, items):
    """Mvoxel/s, best of three."""
    best = 0.0
    for _ in range(3):
        parts = [multiprocessing.get_context("fork").Process(target=make, args=(data, i * items, (i + 1) * items))
                 for i in range(processes)]
        begin = time.monotonic()
        for part in parts:
            part.start()
        for part in parts:
            part.join()
        best = max(best, processes * items * np.prod(data._size) / (time.monotonic() - begin) / 1e6)
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--items", type=int, default=100, help="of a process")
    parser.add_argument("--processes", type=int, nargs="*", default=[1, 2])
    options = parser.parse_args()
    footage = np.random.default_rng(1).uniform(0, 1, (80, 256, 256)).astype(np.float32)
    print("| crop | sensor | augmentation |", " | ".join(f"{n} processes" for n in options.processes), "| Mvoxel/s")
    for crop in ((64, 64), (128, 128)):
        for sensor in ("paper", "paper_black"):
            for name, changes in (("no", {}), ("all", AUGMENTED)):
                data = stipple.dataset(footage, sensor, "tiled", crop, 32, 100 * max(options.processes) * options.items,
                                       **changes)
                rates = [f"{rate(data, n, options.items):.0f}" for n in options.processes]
                print(f"| {crop[0]} x {crop[1]} | {sensor} | {name} |", " | ".join(rates), "|", flush=True)


if __name__ == "__main__":
    main()
