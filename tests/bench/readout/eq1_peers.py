#!/usr/bin/env python3
"""Eq. 1 (light to DN) of one thread, in one run: Stipple, NumPy's Generator, the standard library.

usage: eq1_peers.py [BENCH]     BENCH: the program bench_eq1 (build/release/bench_eq1)

Prints Msamples/s and how many times as fast as NumPy Stipple is; a figure is the best of three
passes in turn, so that a busy machine hurts all alike.
"""

import json
import subprocess
import sys
import time

import numpy

MEANS_E = [1, 10, 100, 1000, 8000]
SAMPLES = 1 << 16
FULL_WELL_E, READ_NOISE_E, FULL_SCALE_E, MOST_DN = 20000, 10, 2000, 255


def numpy_rate(mean_e, seconds=0.3):
    """Msamples/s of Eq. 1 in NumPy, without waste: single precision, in place."""
    generator = numpy.random.Generator(numpy.random.PCG64(1))
    mean = mean_e * generator.uniform(0.9, 1.1, SAMPLES)
    passes, begin = 0, time.perf_counter()
    while time.perf_counter() - begin < seconds:
        charge = numpy.minimum(generator.poisson(mean), FULL_WELL_E).astype(numpy.float32)
        noise = generator.standard_normal(SAMPLES, dtype=numpy.float32)
        noise *= READ_NOISE_E
        charge += noise
        charge *= MOST_DN / FULL_SCALE_E
        numpy.clip(charge, 0, MOST_DN, out=charge)
        numpy.rint(charge, out=charge)
        charge.astype(numpy.uint16)
        passes += 1
    return passes * SAMPLES / (time.perf_counter() - begin) / 1e6


def bench_rates(program):
    """Msamples/s of the benchmarks of `program`, by their names."""
    text = subprocess.run([program, "--benchmark_format=json", "--benchmark_min_time=0.2"],
                          check=True, capture_output=True, text=True).stdout
    return {b["name"]: b["items_per_second"] / 1e6 for b in json.loads(text)["benchmarks"]}


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else "build/release/bench_eq1"
    best = {}
    for _ in range(3):
        rates = bench_rates(program) | {f"numpy/{mean}": numpy_rate(mean) for mean in MEANS_E}
        best = {name: max(rate, best.get(name, 0)) for name, rate in rates.items()}
    print("mean electrons   Stipple   NumPy   std   Stipple / NumPy   Stipple / std")
    for mean in MEANS_E:
        ours, peer = best[f"light_to_dn/{mean}"], best[f"numpy/{mean}"]
        std = best[f"std_light_to_dn/{mean}"]
        print(f"{mean:14} {ours:9.0f} {peer:7.1f} {std:5.1f} {ours / peer:17.1f} "
              f"{ours / std:15.1f}")


if __name__ == "__main__":
    main()
