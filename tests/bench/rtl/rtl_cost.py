#!/usr/bin/env python3
"""What coded exposure costs in gates, beside a conventional sensor of the same size: the table of docs/rtl.md.

usage: rtl_cost.py [--modules] [ROWSxCOLUMNSxCHANNELS]...
Needs Yosys, and nextpnr-ice40 for the clock on an iCE40 HX8K. Minutes for each size, and more for larger ones."""

import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

HERE = Path(__file__).resolve().parent
RTL = HERE.parents[2] / "rtl"
# Transistors of static CMOS over the four of a NAND2.
NAND2 = {"$_NOT_": 0.5, "$_NAND_": 1, "$_NOR_": 1, "$_AOI3_": 1.5, "$_OAI3_": 1.5, "$_AOI4_": 2, "$_OAI4_": 2,
         "$_AND_": 1.5, "$_OR_": 1.5, "$_MUX_": 3, "$_NMUX_": 2.5, "$_XOR_": 2.5, "$_XNOR_": 2.5}
# A NAND2 with its wires switches so much in a tenth of the clocks: with the 1.2 V of docs/readout_timing.md.
NAND2_PJ_PER_CLOCK = 0.1 * 4e-15 * 1.2**2 * 1e12
# Memories stay memories.
TO_GATES = ("proc; opt -full; wreduce; opt_clean; alumacc; share; opt; memory -nomap; opt -full; techmap; opt; "
            "dfflegalize -cell $_DFF_P_ x; opt_clean; abc -g cmos; opt_clean; ")
# Sizes that an HX8K of 7680 cells may hold: its memory blocks need a clock to read, so that the tables are flip-flops.
ICE40 = {"ROWS": 4, "COLS": 4, "CHANNELS": 1, "BIT_DEPTH": 8, "WORD_BYTES": 4}
ICE40_MEMORY = {"TILE": 4, "DEPTH": 2, "WORDS": 8}


def sources(chip):
    modules = RTL.glob("*.sv") if chip == "coded" else [RTL / "crc32c.sv"]
    skipped = ("stipple_chip", "chip_control", "chip_registers")
    return [str(path) for path in [HERE / f"{chip}.sv", *sorted(modules)] if path.stem not in skipped]


def yosys(folder, script):
    done = subprocess.run(["yosys", "-q", "-p", script], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stdout[-2000:] + done.stderr[-2000:])


def elaborated(chip, sizes):
    parameters = " ".join(f"-set {name} {value}" for name, value in sizes.items())
    return (f"read_verilog -sv -DSYNTHESIS {' '.join(sources(chip))}; chparam {parameters} {chip}; "
            f"hierarchy -check -top {chip}; rename -top {chip}; ")


def sizes_of(rows, columns, channels):
    word_bytes = max(4, 1 << (channels * 10 - 1).bit_length() - 3)
    return {"ROWS": rows, "COLS": columns, "CHANNELS": channels, "WORD_BYTES": word_bytes}


def count(chip, sizes):
    """NAND2 equivalents, flip-flops, and the bits of each memory."""
    with tempfile.TemporaryDirectory() as folder:
        yosys(folder, elaborated(chip, sizes) + "proc; flatten; " + TO_GATES + "write_json cells.json")
        module = json.loads((Path(folder) / "cells.json").read_text())["modules"]
    cells = next(it for name, it in module.items() if name.endswith(chip))["cells"]
    gates, flip_flops, memories = 0, 0, {}
    for name, cell in cells.items():
        kind = cell["type"]
        if kind == "$mem_v2":
            size = int(cell["parameters"]["SIZE"], 2) * int(cell["parameters"]["WIDTH"], 2)
            memories[name.replace("\\", "")] = size
        elif kind == "$_DFF_P_":
            flip_flops += 1
        else:
            gates += NAND2[kind]
    return gates, flip_flops, memories


def of_schedule(memories):
    return sum(bits for name, bits in memories.items() if "u_banks" in name)


def ice40(chip):
    """Cells and MHz on an HX8K, behind a shift register for the columns; why not otherwise."""
    if not shutil.which("nextpnr-ice40"):
        return "nextpnr-ice40 is not installed"
    sizes = {**ICE40, **(ICE40_MEMORY if chip == "coded" else {})}
    with tempfile.TemporaryDirectory() as folder:
        yosys(folder, elaborated(chip, sizes) + f"synth_ice40 -top {chip} -json chip.json")
        done = subprocess.run(["nextpnr-ice40", "--hx8k", "--package", "ct256", "--json", "chip.json", "--freq", "20",
                               "--pcf-allow-unconstrained", "--seed", "1"], cwd=folder, capture_output=True, text=True,
                              check=False)
    cells = re.search(r"ICESTORM_LC: +(\d+)/ *(\d+)", done.stderr)
    clocks = re.findall(r"Max frequency for clock.*: ([\d.]+) MHz", done.stderr)
    if not clocks:
        return f"{cells[1]} of {cells[2]} cells: does not fit" if cells else done.stderr[-300:]
    return f"{cells[1]} cells, {float(clocks[-1]):.0f} MHz"


def print_modules(rows, columns, channels):
    """The modules of the coded chip, each by itself: with programmable times and policy *drop*."""
    with tempfile.TemporaryDirectory() as folder:
        yosys(folder, elaborated("coded", sizes_of(rows, columns, channels)) + TO_GATES + "write_json cells.json")
        modules = json.loads((Path(folder) / "cells.json").read_text())["modules"]
    print("| module | number | NAND2 of each | flip-flops |\n|---|---|---|---|")
    number = Counter(cell["type"] for module in modules.values() for cell in module["cells"].values())
    for name, module in modules.items():
        kinds = [cell["type"] for cell in module["cells"].values()]
        plain = name.split("\\")[1] if name.startswith("$paramod") else name
        print(f"| {plain} | {max(1, number[name])} | {sum(NAND2.get(kind, 0) for kind in kinds):.0f} | "
              f"{kinds.count('$_DFF_P_')} |")


def main(sizes):
    print("| rows, columns, channels | chip | NAND2 | flip-flops | memory of the schedule, bit | other memory, bit "
          "| pJ per clock |")
    print("|---|---|---|---|---|---|---|")
    for size in sizes:
        for chip in ("conventional", "coded"):
            gates, flip_flops, memories = count(chip, sizes_of(*size))
            schedule = of_schedule(memories)
            print(f"| {', '.join(map(str, size))} | {chip} | {gates:.0f} | {flip_flops} | {schedule} | "
                  f"{sum(memories.values()) - schedule} | {gates * NAND2_PJ_PER_CLOCK:.1f} |", flush=True)
    for chip in ("conventional", "coded"):
        print(f"iCE40 HX8K, {chip} chip of {ICE40['ROWS']} x {ICE40['COLS']} pixels: {ice40(chip)}", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--modules", action="store_true", help="the modules of the first size instead")
    parser.add_argument("sizes", nargs="*", default=["16x16x2", "32x32x4"], metavar="ROWSxCOLUMNSxCHANNELS")
    options = parser.parse_args()
    chips = [tuple(map(int, size.split("x"))) for size in options.sizes]
    if options.modules:
        print_modules(*chips[0])
    else:
        main(chips)
