#!/usr/bin/python3
"""Time of the operations of stipple.ForwardModel over that of the same ones in C++ (bench_decoder), in the same run.

    PYTHONPATH=build/release/python tests/bench/decoder/forward_model.py build/release/bench_decoder"""

import json
import subprocess
import sys
import time

import numpy as np
import stipple

SHAPE = (32, 256, 256)  # of decoder_bench.cpp
ROUNDS = 5


def of_cpp(program, name):
    """Milliseconds of a call."""
    output = subprocess.run([program, f"--benchmark_filter=^{name}/2/", "--benchmark_format=json",
                             "--benchmark_min_time=0.3"], capture_output=True, check=True).stdout
    return json.loads(output)["benchmarks"][0]["real_time"]


def of_python(call):
    """Milliseconds of a call, the mean of 30."""
    call()
    begin = time.monotonic()
    for _ in range(30):
        call()
    return (time.monotonic() - begin) / 30 * 1e3


def main():
    scene = stipple.synth("pan", frames=SHAPE[0], size=SHAPE[1:], luminance=True)
    model = stipple.ForwardModel(stipple.emulate(scene, "paper", "random"))
    x = np.ascontiguousarray(scene, np.float32)
    y = model.forward(x)
    step = np.full(SHAPE, 0.005, np.float32)
    calls = {"forward": lambda: model.forward(x), "adjoint": lambda: model.adjoint(y), "prox": lambda: model.prox(x, step)}
    print("| operation | C++, ms | Python, ms | ratio (least and greatest of %d) |" % ROUNDS)
    for name, call in calls.items():
        times = np.array([(of_cpp(sys.argv[1], name), of_python(call)) for _ in range(ROUNDS)])
        ratio = times[:, 1] / times[:, 0]
        print(f"| {name} | {np.median(times[:, 0]):.1f} | {np.median(times[:, 1]):.1f} "
              f"| {np.median(ratio):.2f} ({ratio.min():.2f}, {ratio.max():.2f}) |")


if __name__ == "__main__":
    main()
