#!/usr/bin/env python3
"""Explores the spaces of config/spaces with the built program and five seeds, and writes their tables in
docs/explored_spaces.md anew: what stands between "<!-- bit_depth.toml -->" and "<!-- end -->". Takes some minutes; trials
of build/spaces are kept."""

import argparse
import csv
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "docs/explored_spaces.md"
BLOCK = re.compile(r"<!-- (\w+\.toml) -->\n.*?<!-- end -->\n", re.DOTALL)
FIGURES = {  # column of table.csv: heading, format; decode_seconds is of a machine
    "slots_per_second": ("slots/s", "{:.0f}"), "readout_slots_per_second": ("readout, slots/s", "{:.0f}"),
    "limited_by": ("limited by", "{}"),
    "megabits_per_second": ("Mbit/s", "{:.1f}"), "energy_uj_per_slot": ("uJ per slot", "{:.0f}"),
    "light_throughput": ("light", "{:.3g}"), "psnr_db": ("PSNR, dB", "{:.1f}"),
    "pu21_psnr_db": ("PU21-PSNR, dB", "{:.1f}"), "sample_range_stops": ("sample range, stops", "{:.1f}")}


def shown(row, name):
    """A cell, with half of its 95 % interval if it has one."""
    if name not in FIGURES:
        return row[name]
    form = FIGURES[name][1]
    try:
        text = form.format(float(row[name]))
    except ValueError:
        return row[name]
    if row.get(f"{name}_low"):
        text += " ± " + form.format((float(row[f"{name}_high"]) - float(row[f"{name}_low"])) / 2)
    return text


def table_of(rows):
    """Markdown of the columns that differ between rows, with PSNR in any case."""
    names = [name for name in rows[0] if not name.endswith(("_low", "_high")) and name not in (
        "decode_seconds", "decode_megabytes", "samples_per_voxel", "psnr_gamma_db", "rung", "slots", "problem", "field_of_view",
        "code_megabits_per_second")]
    columns = [name for name in names if name == "psnr_db" or len({row[name] for row in rows}) > 1]
    head = [FIGURES.get(name, (f"`{name}`", ""))[0] for name in columns]
    lines = [[shown(row, name) for name in columns] for row in rows]
    head, *body = [f"| {' | '.join(line)} |\n" for line in [head, *lines]]
    return "".join([head, "|" + "---|" * len(columns) + "\n", *body])


def explored(program, space, results):
    """The rows of table.csv."""
    subprocess.run([program, "explore", ROOT / "config/spaces" / space, "-o", results / Path(space).stem,
                    "--seeds", "5"], check=True)
    with open(results / Path(space).stem / "table.csv", newline="") as table:
        rows = list(csv.DictReader(table))
    if any(row["problem"] for row in rows):
        raise ValueError(f"{space}: {next(row['problem'] for row in rows if row['problem'])}")
    return rows


def with_tables(page, tables):
    return BLOCK.sub(lambda block: f"<!-- {block[1]} -->\n{tables[block[1]]}<!-- end -->\n", page)


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("program", nargs="?", default=ROOT / "build/release/stipple", help="the built program")
    given = arguments.parse_args()
    results = ROOT / "build/spaces"
    results.mkdir(parents=True, exist_ok=True)
    text = PAGE.read_text()
    PAGE.write_text(with_tables(text, {space: table_of(explored(given.program, space, results))
                                       for space in BLOCK.findall(text)}))
