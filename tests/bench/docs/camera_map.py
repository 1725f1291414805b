#!/usr/bin/python3
"""Makes docs/camera_map.md anew: which camera wins over light, motion and detail, with its table and its figure.

usage: tests/bench/docs/camera_map.py PROGRAM RESULTS

Films moving leaves with the systems of SYSTEMS, by `stipple explore`. RESULTS keeps the footage and the trials, so that a
second run does only what is new; the first takes an hour or two. Needs python3-numpy and python3-matplotlib."""

import argparse
import csv
import io
import re
import subprocess
import tomllib
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "docs/camera_map.md"
CODED = ["coded best", "hardware best", "pixel flutter best"]
FRAMES = ["1x vbm4d", "1x best", "4x best", "alternating kang2003", "binned vbm4d", "binned best", "charge-binned vbm4d"]
LIGHTS = [30, 100, 300, 1000, 3000]  # electrons in a slot at light 1.0
SPEEDS = [0, 0.5, 1, 2, 4]           # pixels per slot, root mean square
BLURS = [0, 1]                       # of the lens: standard deviation in pixels
SEEDS = [1, 2, 3, 4, 5]
STUDENT_T = 2.776                    # of 95 % and 4 degrees of freedom
SIDE, TORUS, FINE, STEPS, SLOTS = 64, 96, 3, 4, 36  # pixels, pixels, points a pixel, instants a slot, slots


def velocities(speed, count, rng):
    """In pixels per slot, (leaf, axis): a part common to all and one of each leaf's own, of equal length."""
    angle = rng.uniform(0, 2 * np.pi, count + 1)
    parts = speed * np.sqrt(0.5) * np.stack([np.sin(angle), np.cos(angle)], 1)
    return parts[0] + parts[1:]


def leaves(speed, seed):
    """Light of moving leaves before the lens, (slot, row, col) with FINE points a pixel.

    The dead leaves of Lee, Mumford, Huang (IJCV 2001): discs that cover each other, whose radii r, 4 to 32 pixels, have the
    density r^-3. Each has light of 0.05 to 2, log-uniform, under a texture of 1/f noise, and moves straight on. The
    picture continues at its ends."""
    rng = np.random.default_rng(seed)
    size = TORUS * FINE
    count = round(8 * TORUS ** 2 / (np.pi * 67))  # covers each point 8 times: mean r^2 is 67
    radius = FINE / np.sqrt(rng.uniform(32.0 ** -2, 4.0 ** -2, count))
    start = rng.uniform(0, size, (count, 2))
    light = 0.05 * 40 ** rng.uniform(size=count)
    velocity = FINE * velocities(speed, count, rng)
    origin = rng.integers(0, size, (count, 2))
    frequency = np.hypot(np.fft.fftfreq(size)[:, None], np.fft.rfftfreq(size))
    frequency[0, 0] = np.inf
    texture = np.fft.irfft2(np.fft.rfft2(rng.standard_normal((size, size))) / frequency, (size, size))
    texture = np.exp(0.3 * texture / texture.std())
    rows, cols = np.mgrid[:size, :size]
    video = np.zeros((SLOTS, size, size))
    for step in range(SLOTS * STEPS):
        center = start + velocity * (step + 0.5) / STEPS
        owner = np.zeros((size, size), int)
        for i in range(count):
            (y, x), r = center[i], radius[i]
            row, col = np.arange(np.ceil(y - r), y + r, dtype=int), np.arange(np.ceil(x - r), x + r, dtype=int)
            inside = (row - y)[:, None] ** 2 + (col - x) ** 2 < r * r
            part = np.ix_(row % size, col % size)
            owner[part] = np.where(inside, i, owner[part])
        at = np.rint(center).astype(int) - origin
        video[step // STEPS] += light[owner] * texture[(rows - at[owner, 0]) % size, (cols - at[owner, 1]) % size] / STEPS
    return video


def filmed(video, blur):
    """Through a lens with a Gaussian point spread, by square pixels: (slot, row, col)."""
    size = TORUS * FINE
    frequency2 = np.fft.fftfreq(size)[:, None] ** 2 + np.fft.rfftfreq(size) ** 2
    lens = np.exp(-2 * np.pi ** 2 * (blur * FINE) ** 2 * frequency2)
    video = np.fft.irfft2(np.fft.rfft2(video) * lens, (size, size))
    return video.reshape(SLOTS, TORUS, FINE, TORUS, FINE).mean((2, 4))[:, :SIDE, :SIDE].astype(np.float32)


def footage_of(folder):
    """Files of the films by (speed, blur, seed), made where they are missing."""
    files = {}
    for speed in SPEEDS:
        for seed in SEEDS:
            films = {(speed, blur, seed): folder / f"leaves_{speed}_{blur}_{seed}.npy" for blur in BLURS}
            if not all(file.exists() for file in films.values()):
                light = leaves(speed, seed)
                for (_, blur, _), file in films.items():
                    np.save(file, filmed(light, blur))
            files |= films
    return files


def toml_of(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f'"{key}" = {toml_of(entry)}' for key, entry in value.items()) + " }"
    return f'"{value}"' if isinstance(value, str) else str(value)


def space_of(files):
    """The systems of rivals.toml on the footage at each light, by a sensor of 12 bits whose range is its well."""
    known = {system["name"]: system
             for system in tomllib.loads((ROOT / "config/spaces/rivals.toml").read_text())["systems"]}
    lines = ["[axes]", 'sensor = "paper_black"', f"footage = {[str(file) for file in files]}"]
    for name in CODED + FRAMES:
        lines += ["[[systems]]", *(f"{key} = {toml_of(value)}" for key, value in known[name].items())]
    lines += ["[set]", f'"sensor.photons_per_unit" = {LIGHTS}', '"sensor.bit_depth" = 12',
              '"sensor.full_scale_e" = 20000', '"sensor.black_level_dn" = 13', "[clip]", f"frames = {SLOTS}"]
    return "\n".join(lines) + "\n"


def explored(program, results):
    """The rows of the table of all systems on all films, each with its "film": (speed, blur, seed)."""
    files = {str(file.resolve()): film for film, file in footage_of(results).items()}
    (results / "space.toml").write_text(space_of(files))
    subprocess.run([program, "explore", results / "space.toml", "-o", results / "trials", "--no-report", "-q"],
                   check=True)
    with open(results / "trials" / "table.csv", newline="") as table:
        return [row | {"film": files[row["footage"]]} for row in csv.DictReader(table)]


def quality(rows, figure):
    """A figure in dB by (light, speed, blur) and system: an array with a value for each seed."""
    cells = {}
    for row in rows:
        speed, blur, _ = row["film"]
        cell = cells.setdefault((int(row["sensor.photons_per_unit"]), speed, blur), {})
        cell.setdefault(row["system"], []).append(float(row[figure]))
    return {cell: {system: np.array(values) for system, values in systems.items()} for cell, systems in cells.items()}


def verdict(systems, rivals=FRAMES):
    """The best coded system, the best of the rivals, by how much the first is ahead, and half of the 95 % interval."""
    coded, frames = (max(names, key=lambda name: systems[name].mean()) for names in (CODED, rivals))
    lead = systems[coded] - systems[frames]
    return coded, frames, lead.mean(), STUDENT_T * lead.std(ddof=1) / np.sqrt(len(lead))


def told(cell):
    """The winner and its lead in dB; in brackets if the interval holds 0."""
    coded, frames, lead, half = cell
    text = f"{coded if lead > 0 else frames} {abs(lead):.1f} ± {half:.1f}"
    return f"({text})" if abs(lead) < half else text


def tables(cells):
    text = ""
    for blur in BLURS:
        text += f"**Blur {blur} px.**\n\n| e-/slot | " + " | ".join(f"{speed} px/slot" for speed in SPEEDS) + " |\n"
        text += "|---" * (1 + len(SPEEDS)) + "|\n"
        for light in LIGHTS:
            text += f"| {light} | " + " | ".join(told(cells[light, speed, blur]) for speed in SPEEDS) + " |\n"
        text += "\n"
    return text


def summary(cells):
    """How often each side leads, and by how much."""
    leads = [(lead, half) for _, _, lead, half in cells.values()]
    ahead, behind = sum(lead > half for lead, half in leads), sum(-lead > half for lead, half in leads)
    return (f"coded ahead in {ahead} of {len(cells)} cells, by up to {max(leads)[0]:.1f} dB; frames in {behind}, by up to "
            f"{-min(leads)[0]:.1f} dB; {len(cells) - ahead - behind} are not decided.\n")


def deficits(measured):
    """One camera for all cells: how far each system is behind the best one of a cell."""
    means = [{system: values.mean() for system, values in systems.items()} for systems in measured.values()]
    text = ("**One camera for all cells**: behind the best one of each cell.\n\n"
            "| system | mean, dB | worst cell, dB |\n|---|---|---|\n")
    behind = {system: [max(cell.values()) - cell[system] for cell in means] for system in CODED + FRAMES}
    for system, lost in sorted(behind.items(), key=lambda entry: np.mean(entry[1])):
        text += f"| {system} | {np.mean(lost):.1f} | {max(lost):.1f} |\n"
    return text + "\n"


def draw(cells, file):
    import matplotlib  # only pictures need it
    from matplotlib import pyplot as plt
    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "camera_map", "font.size": 9,
                                "font.family": ["DejaVu Sans", "sans-serif"]})
    figure, panels = plt.subplots(1, len(BLURS), figsize=(13, 4.6), sharey=True, layout="constrained")
    for panel, blur in zip(panels, BLURS):
        grid = [[cells[light, speed, blur] for speed in SPEEDS] for light in LIGHTS]
        picture = panel.imshow([[cell[2] for cell in row] for row in grid], cmap="PuOr", vmin=-4, vmax=4, origin="lower",
                               aspect="auto")
        for row, line in enumerate(grid):
            for col, (coded, frames, lead, half) in enumerate(line):
                winner = (coded if lead > 0 else frames).rsplit(" ", 1)
                panel.text(col, row, f"{winner[0]}\n{winner[1]}\n{abs(lead):.1f} ± {half:.1f}", ha="center", va="center",
                           fontsize=7, color="white" if abs(lead) > 2.5 else "#777" if abs(lead) < half else "black")
        panel.set_xticks(range(len(SPEEDS)), SPEEDS)
        panel.set_yticks(range(len(LIGHTS)), LIGHTS)
        panel.set_xlabel("motion / px per slot")
        panel.set_title(f"blur of the lens {blur} px")
    panels[0].set_ylabel("light / electrons per slot")
    figure.colorbar(picture, ax=panels, label="lead of coded exposure / dB", extend="both")
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata=dict.fromkeys(("Creator", "Date", "Format", "Type")))
    file.write_text("\n".join(line.rstrip() for line in text.getvalue().splitlines()) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("results", type=Path)
    arguments = parser.parse_args()
    arguments.results.mkdir(parents=True, exist_ok=True)
    rows = explored(arguments.program, arguments.results)
    measured = {figure: quality(rows, figure) for figure in ("psnr_db", "psnr_gamma_db", "pu21_psnr_db")}
    cells, gamma, pu21 = ({cell: verdict(systems) for cell, systems in found.items()} for found in measured.values())
    without = {cell: verdict(systems, [name for name in FRAMES if not name.startswith("charge-")])
               for cell, systems in measured["psnr_db"].items()}
    draw(cells, ROOT / "docs/figures/camera_map.svg")
    counts = (f"- Linear PSNR: {summary(cells)}- The same without charge binning: {summary(without)}"
              f"- PSNR after the power 1/2.2: {summary(gamma)}- PSNR of PU21 values: {summary(pu21)}\n")
    block = re.compile(r"(<!-- map -->\n).*?(<!-- end -->)", re.DOTALL)
    text = counts + tables(cells) + deficits(measured["psnr_db"])
    PAGE.write_text(block.sub(lambda found: found[1] + text + found[2], PAGE.read_text()))


if __name__ == "__main__":
    main()
