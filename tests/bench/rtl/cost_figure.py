#!/usr/bin/env python3
"""Draws docs/figures/rtl_cost.svg from the table of docs/rtl.md that rtl_cost.py has printed.

usage: cost_figure.py
Needs gnuplot."""

import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
SLOTS = 15  # of the program of `random`

SCRIPT = """
set terminal svg size 760,300 font "DejaVu Sans,12" background "white"
set output "{output}"
set multiplot layout 1,2
set grid ytics lc rgb "#dddddd"
set border 3
set tics nomirror
set key top left
set xlabel "columns"
set ylabel "gates, 1000 NAND2"
set xrange [0:*]
set yrange [0:*]
plot $coded using 1:($2/1000) with linespoints pt 7 lw 2 lc rgb "#b5467a" title "coded", \\
     $conventional using 1:($2/1000) with linespoints pt 5 lw 2 lc rgb "#4b3b87" title "conventional"
set xlabel "side of the tile, pixels"
set ylabel "program of a bank, kbit"
set logscale xy 2
set xrange [3:80]
set yrange [0.125:128]
set xtics (4, 8, 16, 32, 64)
plot $memory using 1:($2/1024) with linespoints pt 7 lw 2 lc rgb "#b5467a" notitle
"""


def block(name, rows):
    return f"${name} << EOD\n" + "".join(f"{x} {y}\n" for x, y in rows) + "EOD\n"


def main():
    page = (ROOT / "docs/rtl.md").read_text()
    found = re.findall(r"^\| \d+, (\d+), \d+ \| (coded|conventional) \| ([\d,]+) \|", page, re.MULTILINE)
    gates = {chip: [(int(cols), gates.replace(",", "")) for cols, name, gates in found if name == chip]
             for chip in ("coded", "conventional")}
    memory = [(side, SLOTS * side * side) for side in (4, 8, 16, 32, 64)]
    data = "".join(block(name, rows) for name, rows in [*gates.items(), ("memory", memory)])
    script = data + SCRIPT.format(output=ROOT / "docs/figures/rtl_cost.svg")
    subprocess.run(["gnuplot"], input=script, text=True, check=True)


if __name__ == "__main__":
    main()
