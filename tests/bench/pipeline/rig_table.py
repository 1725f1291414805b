#!/usr/bin/env python3
"""The table of docs/rig.md: rigs against one sensor of the whole aperture, on footage.

usage: tests/bench/pipeline/rig_table.py PROGRAM FOOTAGE [RIG|SCHEDULE[:KEY=VALUE]...]...
Prints a row per system and method: dB linear and after 1/2.2, light, bits a slot. A name of "stipple list
rigs" or a file is a rig, any other a schedule on one sensor `paper`.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

METHODS = ("naive", "fast", "best")


def run(program, *arguments):
    done = subprocess.run([program, *map(str, arguments), "--json", "-", "--force"], capture_output=True, text=True,
                          check=True)
    return json.loads(done.stdout)


def rigs_of(program):
    return {entry["name"] for entry in run(program, "list", "rigs")["rigs"]}


def main():
    program, footage, *systems = sys.argv[1:]
    rigs = rigs_of(program)
    with tempfile.TemporaryDirectory() as folder:
        for system in systems or ["random", *sorted(rigs)]:
            name, *settings = system.split(":")
            is_rig = name in rigs or name.endswith(".toml")
            stream = Path(folder) / ("rig" if is_rig else "clip.stipple")
            told = run(program, "emulate", footage, "-o", stream, "--truth", Path(folder) / "truth.npy",
                       "--rig" if is_rig else "--schedule", name, *(f"--set={setting}" for setting in settings))
            light = told["light_collected"] if is_rig else told["light_throughput"]
            bits = told["bits_per_slot"] if is_rig else told["payload_bits"] / told["slots"]
            for method in METHODS:
                video = Path(folder) / "video.npy"
                seconds = run(program, "decode", stream, "-o", video, "--method", method)["seconds"]
                quality = run(program, "compare", video, Path(folder) / "truth.npy", "--margin", 4)
                print(f"| `{system}` | `{method}` | {quality['psnr_db']:.1f} | {quality['psnr_gamma_db']:.1f} "
                      f"| {100 * light:.0f} % | {bits:.0f} | {seconds:.1f} |", flush=True)


if __name__ == "__main__":
    main()
