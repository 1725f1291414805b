#!/usr/bin/python3
"""Writes the tables of docs/rivals.md anew: `stipple rivals` on the middle of clips and on embedded scenes.

usage: tests/bench/docs/rivals.py PROGRAM RESULTS [--footage FOLDER] [--without SYSTEM]... [--strongest | --learned]
                                  [--seeds N]

FOLDER holds the clips (default: $STIPPLE_FOOTAGE). "coded portz2013" takes minutes a clip, and so does the dictionary.
RESULTS keeps the trials, so that a second run does only what is new, and the dictionary of hitomi2011, which is learned
from scenes and clips that the tables do not have. With --strongest only the table of the strongest systems is made, with
--learned that of the method learned, both on all clips. With several seeds linear PSNR has half of its 95 % interval."""

import argparse
import json
import os
import re
import subprocess
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
SPACE = ROOT / "config" / "spaces" / "rivals.toml"
PAGE = ROOT / "docs" / "rivals.md"
SCENES = ["pan", "roll"]
LEARNED_SCENES = ["pencils", "dice", "still"]
LEARNED_CLIPS = ["mouse250_b", "nat30_blocks", "hdr_stilllife"]
CLIPS = ["mouse250_a", "hdr_desk_fg", "nat30_coffee"]
ALL_CLIPS = [*CLIPS, "mouse250_b", "hdr_stilllife", "nat30_blocks"]
STRONGEST = ["coded best", "hardware best", "pixel flutter best", "1x vbm4d", "4x best", "alternating kang2003",
             "binned naive", "binned vbm4d", "charge-binned vbm4d", "full rate vbm4d (4 x samples)",
             "full rate best (4 x samples)"]
REFINED = ["coded best", "hardware best", "pixel flutter best", "1x best", "4x best", "binned best",
           "full rate best (4 x samples)"]
SIDE = 96  # pixels of the middle of a clip, as luminance
COLUMNS = {"field, %": ("field_of_view", 100, 0), "samples": ("samples_per_voxel", 1, 3),
           "light, %": ("light_throughput", 100, 0), "range, stops": ("sample_range_stops", 1, 1),
           "slots/s": ("readout_slots_per_second", 1, 0), "uJ/slot": ("energy_uj_per_slot", 1, 0),
           "code, Mbit/s": ("code_megabits_per_second", 1, 0)}


def dictionary_of(program, folder, results):
    """The dictionary of hitomi2011, learned once. Its patches have two periods of the schedule."""
    dictionary = results / "hitomi2011.npy"
    if not dictionary.exists():
        clips = [folder / clip for clip in LEARNED_CLIPS] if folder else []
        for scene in LEARNED_SCENES:
            clips.append(results / f"{scene}.npy")
            subprocess.run([program, "synth", scene, "-o", clips[-1], "--frames", "36", "--size", "128x96", "--force"],
                           check=True)
        subprocess.run([program, "dictionary", *clips, "-o", dictionary, "--slots", "8", "--luminance"], check=True)
    return dictionary


def figures_of(program, footage, results, dictionary, systems, seeds, methods):
    """Of a scene, or of the middle of a clip."""
    chosen = [word for system in systems for word in ("--system", system)]
    chosen += [word for method in methods for word in ("--method", method)]
    if dictionary:
        chosen += ["--dictionary", dictionary]
    reading = [] if footage in SCENES else ["--luminance", "--crop", f"{SIDE}x{SIDE}"]
    done = subprocess.run([program, "rivals", footage, "-o", results / "trials", *chosen, *reading, "--seeds",
                           str(seeds), "--json", "-"], check=True, stdout=subprocess.PIPE)
    return json.loads(done.stdout)["systems"]


def number(value, digits):
    return "" if value is None else f"{value:.{digits}f}"


def quality(row):
    """PSNR in dB: linear, after 1/2.2, PU21."""
    linear, *others = (number(row[key], 1) for key in ("psnr_db", "psnr_gamma_db", "pu21_psnr_db"))
    if row.get("psnr_db_low") is not None:
        linear += f" ± {(row['psnr_db_high'] - row['psnr_db_low']) / 2:.1f}"
    return " / ".join([linear, *others])


def compared(rows):
    """The slots that all systems of footage compare, as first:end."""
    slots, = {row["compared_slots"] for row in rows if row["compared_slots"]}
    return slots


def tables(footage, columns):
    """`footage`: names with the figures of the systems."""
    names = list(footage)
    first = footage[names[0]]
    text = "| " + " | ".join(["system", *columns, *(f"`{name}`" for name in names)]) + " |\n"
    text += "|---" * (1 + len(columns) + len(names)) + "|\n"
    for i, system in enumerate(first):
        cells = [number(system[name] and scale * system[name], digits) for name, scale, digits in columns.values()]
        cells += [quality(footage[name][i]) for name in names]
        text += f"| {system['system']} | " + " | ".join(cells) + " |\n"
    return text + "\nCompared slots: " + ", ".join(f"`{name}` {compared(rows)}" for name, rows in footage.items()) + ".\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path)
    parser.add_argument("results", type=Path)
    parser.add_argument("--footage", type=Path, default=os.environ.get("STIPPLE_FOOTAGE"))
    parser.add_argument("--without", action="append", default=[], metavar="SYSTEM")
    table = parser.add_mutually_exclusive_group()
    table.add_argument("--strongest", action="store_const", dest="table", const="strongest", default="rivals")
    table.add_argument("--learned", action="store_const", dest="table", const="learned")
    parser.add_argument("--seeds", type=int, default=1)
    arguments = parser.parse_args()
    systems = {"strongest": STRONGEST, "learned": REFINED}.get(arguments.table) or [
        system["name"] for system in tomllib.loads(SPACE.read_text())["systems"]]
    systems = [system for system in systems if system not in arguments.without]
    arguments.results.mkdir(exist_ok=True)
    learned = any("hitomi2011" in system for system in systems)
    dictionary = dictionary_of(arguments.program, arguments.footage, arguments.results) if learned else None
    footage = {scene: scene for scene in SCENES}
    for clip in (CLIPS if arguments.table == "rivals" else ALL_CLIPS) if arguments.footage else []:
        footage[clip] = arguments.footage / clip
    methods = ["learned"] if arguments.table == "learned" else []
    columns = {"samples": COLUMNS["samples"]} if methods else COLUMNS
    footage = {name: figures_of(arguments.program, clip, arguments.results, dictionary, systems, arguments.seeds, methods)
               for name, clip in footage.items()}
    block = re.compile(rf"(<!-- {arguments.table} -->\n).*?(<!-- end -->)", re.DOTALL)
    PAGE.write_text(block.sub(lambda found: found[1] + tables(footage, columns) + found[2], PAGE.read_text()))


if __name__ == "__main__":
    main()
