#!/usr/bin/python3
"""The tables of docs/scaling.md: decoding on worker processes of Dask on this machine.

    PYTHONPATH=build/release/python tests/bench/scaling/dask_table.py cores    # 1, 2 and 4 workers, pinned to cores;
                                            # beside them as many processes of build/release/stipple, by --part
    PYTHONPATH=build/release/python tests/bench/scaling/dask_table.py memory   # 10^9 voxels, four workers of 1 GiB

Needs python3-distributed, and for `memory` 6 GB of disk in the folder TMPDIR."""

import argparse
import os
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import stipple.dask
from distributed import Client, LocalCluster

GIB = 1 << 30


ROWS, COLS = 240, 320
PROGRAM = Path(__file__).resolve().parents[3] / "build/release/stipple"


def write_stream(folder, slots):
    """A bar that moves a pixel a slot, through the sensor `paper`."""
    light = np.lib.format.open_memmap(folder / "light.npy", "w+", np.uint8, (slots, ROWS, COLS))
    still = np.random.default_rng(1).integers(20, 60, (ROWS, COLS), np.uint8)
    for slot in range(slots):
        light[slot] = still
        light[slot, :, slot % COLS:slot % COLS + 16] = 200
    light.flush()
    del light
    stream = folder / "film.stipple"
    begin = time.monotonic()
    stipple.emulate(folder / "light.npy", output=stream)
    print(f"{slots} slots of {COLS} x {ROWS}: {stream.stat().st_size / 1e6:.0f} MB of stream, "
          f"emulated in {time.monotonic() - begin:.1f} s")
    (folder / "light.npy").unlink()
    return stream


def pin(core):
    os.sched_setaffinity(0, {core})


def peak_bytes():
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) * 1024
    raise ValueError("no VmHWM in /proc/self/status")


def run(stream, folder, workers, memory, method, pinned):
    """Seconds of decode_to, and the peaks of memory of the workers."""
    cores = sorted(os.sched_getaffinity(0))
    with LocalCluster(n_workers=workers, threads_per_worker=1, memory_limit=memory, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            addresses = sorted(client.run(os.getpid))
            if pinned:
                for number, address in enumerate(addresses):
                    client.run(pin, cores[number % len(cores)], workers=[address])
            stipple.dask.check_workers(client)  # its cost is not that of the blocks
            begin, busy = time.monotonic(), os.times()
            blocks = stipple.dask.decode_to(folder / f"windows_{workers}", stream, client, method)
            seconds = time.monotonic() - begin
            assert sorted(client.run(os.getpid)) == addresses, "a worker was ended and replaced"
            peaks = client.run(peak_bytes)
    print(f"  {workers} workers: {blocks} blocks in {seconds:.1f} s, caller {os.times().user - busy.user:.1f} s, "
          f"peaks {', '.join(f'{peak / GIB:.2f}' for peak in peaks.values())} GiB", flush=True)
    return seconds


def run_parts(stream, folder, parts, method):
    """Seconds of processes of the program that share nothing: what the cores of the machine give."""
    cores = sorted(os.sched_getaffinity(0))
    begin = time.monotonic()
    processes = [subprocess.Popen(["taskset", "--cpu-list", str(cores[part % len(cores)]), PROGRAM, "decode", stream,
                                   "-o", folder / f"parts_{parts}", "--part", f"{part + 1}/{parts}", "--method", method,
                                   "--threads", "1"], stdout=subprocess.DEVNULL)
                 for part in range(parts)]
    for process in processes:
        assert process.wait() == 0
    return time.monotonic() - begin


def table_of_cores(folder, method, slots):
    voxels = slots * ROWS * COLS
    stream = write_stream(folder, slots)
    first = None
    for workers in (1, 2, 4):
        parts = run_parts(stream, folder, workers, method)
        seconds = run(stream, folder, workers, "2GiB", method, True)
        first = first or (seconds, parts)
        print(f"| {workers} | {seconds:.1f} | {voxels / seconds / 1e6:.2f} | {first[0] / seconds:.2f} | "
              f"{first[1] / parts:.2f} |", flush=True)


def table_of_memory(folder, method, slots):
    stream = write_stream(folder, slots)
    print(f"{slots * ROWS * COLS:.4g} voxels, method {method}")
    run(stream, folder, 4, "1GiB", method, False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", choices=("cores", "memory"))
    parser.add_argument("--method", default=None, help="default: fast for cores, naive for memory")
    parser.add_argument("--slots", type=int, default=None)
    options = parser.parse_args()
    load = os.getloadavg()[0]
    print(f"{len(os.sched_getaffinity(0))} cores, load before the run {load:.1f}")
    with tempfile.TemporaryDirectory(prefix="stipple_") as name:
        if options.table == "cores":
            table_of_cores(Path(name), options.method or "fast", options.slots or 960)
        else:
            table_of_memory(Path(name), options.method or "naive", options.slots or 13056)


if __name__ == "__main__":
    main()
