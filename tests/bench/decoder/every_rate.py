#!/usr/bin/python3
"""Compares `best` with `fast`, and at full rate with `vbm4d`, over schedules, sensors, light and footage.

usage: tests/bench/decoder/every_rate.py PROGRAM [--footage FOLDER] [--results FOLDER] [OPTION]...

Every schedule is tried on the sensor `paper`, and on every sensor and light those of SCHEDULES_IN_ALL_LIGHT. The clips
of FOLDER (default: $STIPPLE_FOOTAGE) are cropped to their middle, as luminance. Light is that of the sensor's photons,
clipped at 2.0 or where a sample of one slot clips. PSNR in dB, linear and after 1/2.2, without the first and last four
slots. Results are kept by the program's bytes, so that a second run does only what is new."""

import argparse
import hashlib
import json
import os
import subprocess
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
FULL_RATE = {"every slot": ["full1x", "schedule.period_slots=1"], "random [1]": ["random", "schedule.exposure_slots=[1]"]}
OTHER = {"random [1, 2]": ["random", "schedule.exposure_slots=[1, 2]"]}
OF_SENSOR = {"nd_mosaic": "nd_mosaic"}  # schedules for one sensor only
SCHEDULES_IN_ALL_LIGHT = ["every slot", "random", "hardware_tiled", "full1x", "full4x"]
SENSORS = ["paper", "grasshopper", "t6", "nd_mosaic", "lux1310", "ideal"]
LIGHTS = [0.1, 1, 4]
CLIPS = ["hdr_desk", "hdr_desk_fg", "hdr_stilllife", "mouse250_a", "mouse250_b", "nat30_blocks", "nat30_coffee"]
SCENES = ["pan", "roll", "pencils", "dice", "still"]
MARGIN = 4  # slots


def schedules():
    known = {file.stem: [file.stem] for file in sorted((ROOT / "config" / "schedules").glob("*.toml"))}
    return FULL_RATE | OTHER | known


def cases(arguments):
    """Schedule, sensor, light, clip."""
    lit = arguments.schedules or SCHEDULES_IN_ALL_LIGHT
    clips = arguments.clips or (CLIPS if arguments.footage else []) + SCENES
    chosen = [(name, OF_SENSOR.get(name, "paper"), 1) for name in arguments.schedules or schedules()]
    chosen += [(name, sensor, light) for name in lit for sensor in arguments.sensors for light in arguments.lights]
    return [(*camera, clip) for camera in dict.fromkeys(chosen) for clip in clips]


class Trials:
    def __init__(self, arguments):
        self.arguments = arguments
        self.program = arguments.program.resolve()
        self.folder = arguments.results
        self.folder.mkdir(parents=True, exist_ok=True)
        self.hash = hashlib.sha256(self.program.read_bytes()).hexdigest()[:16]
        self.file = self.folder / "results.jsonl"
        self.known = {}
        if self.file.exists():
            self.known = {row["key"]: row["psnr"] for row in map(json.loads, self.file.open())}

    def run(self, *words):
        subprocess.run([self.program, *map(str, words), "--quiet", "--threads", "1"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def clip(self, name):
        """The light of the middle, clipped at 2.0, as a file."""
        side, slots = self.arguments.side, self.arguments.slots
        file = self.folder / f"{name}_{side}_{slots}.npy"
        if file.exists():
            return file
        with tempfile.TemporaryDirectory() as folder:
            whole = Path(folder) / "whole.npy"
            if name in SCENES:
                self.run("synth", name, "-o", whole, "--frames", slots, "--size", f"{side}x{side}", "--luminance")
            else:
                self.run("emulate", self.arguments.footage / name, "-o", Path(folder) / "a.stipple", "--luminance",
                         "--truth", whole)
            video = np.load(whole)
        row, col = ((length - side) // 2 for length in video.shape[1:3])
        np.save(file, np.minimum(video[:slots, row:row + side, col:col + side], 2).astype(np.float32))
        return file

    def psnr(self, decoded, truth, brightest):
        """Linear and after 1/2.2."""
        a, b = (np.clip(np.load(file)[MARGIN:-MARGIN].astype(float), 0, brightest) for file in (decoded, truth))
        return [float(-10 * np.log10(np.mean((a ** power - b ** power) ** 2))) for power in (1, 1 / 2.2)]

    def trial(self, case):
        """PSNR of each method; {} if the sensor cannot have the schedule."""
        schedule, sensor, light, clip = case
        settings = self.arguments.set
        wanted = self.arguments.methods or ["fast", "best"] + (["vbm4d"] if schedule in FULL_RATE else [])
        keys = {method: json.dumps([self.hash, *case, self.arguments.side, self.arguments.slots, method,
                                    settings if method == "best" else []]) for method in wanted}
        missing = [method for method in wanted if keys[method] not in self.known]
        if missing:
            with tempfile.TemporaryDirectory() as folder:
                self.decode(case, missing, keys, Path(folder))
        return {method: self.known[key] for method, key in keys.items() if self.known[key]}

    def decode(self, case, methods, keys, folder):
        schedule, sensor, light, clip = case
        figures = tomllib.loads((ROOT / "config" / "sensors" / f"{sensor}.toml").read_text())
        photons = light * figures["photons_per_unit"]
        electrons = photons * figures.get("quantum_efficiency", 1)
        brightest = min(2, min(figures["full_scale_e"], figures["full_well_e"]) / electrons)
        name, *changes = schedules()[schedule]
        changes += [f"sensor.photons_per_unit={photons:.9g}", "sensor.slot_us=5000"]
        if name == "two_bucket":
            changes.append("sensor.charge_stores=2")
        stream, result = folder / "a.stipple", folder / "a.npy"
        for method in methods:
            try:
                if not stream.exists():
                    self.run("emulate", self.clip(clip), "-o", stream, "--sensor", sensor, "--schedule", name,
                             *(word for change in changes for word in ("--set", change)))
                options = self.arguments.set if method == "best" else []
                self.run("decode", stream, "-o", result, "--method", method, "--force",
                         *(word for option in options for word in ("--set", f"decoder.{option}")))
                psnr = self.psnr(result, self.clip(clip), brightest)
            except subprocess.CalledProcessError as error:
                print(f"{case}: {error.stderr.strip()}")
                psnr = None
            self.known[keys[method]] = psnr
            with self.file.open("a") as file:
                file.write(json.dumps({"key": keys[method], "psnr": psnr}) + "\n")


def row(name, results):
    """Means, and the worst clip."""
    def gains(method):
        return [[a - b for a, b in zip(each["best"], each[method])] for _, each in results if method in each]
    text = f"| {name} |"
    for method in ("fast", "best", "vbm4d"):
        values = [each[method] for _, each in results if method in each]
        text += " / ".join(f"{np.mean(part):.2f}" for part in zip(*values)) + " |"
    worst, clip = min((min(a - b for a, b in zip(each["best"], each["fast"])), clip) for clip, each in results)
    text += f" {' / '.join(f'{x:+.2f}' for x in np.mean(gains('fast'), axis=0))} | {worst:+.2f} {clip} |"
    if gains("vbm4d"):
        worst, clip = min((min(a - b for a, b in zip(each["best"], each["vbm4d"])), clip) for clip, each in results)
        text += f" {' / '.join(f'{x:+.2f}' for x in np.mean(gains('vbm4d'), axis=0))} | {worst:+.2f} {clip} |"
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--footage", type=Path, default=os.environ.get("STIPPLE_FOOTAGE"))
    parser.add_argument("--results", type=Path, default=Path("every_rate"))
    parser.add_argument("--side", type=int, default=64, help="pixels of the crop")
    parser.add_argument("--slots", type=int, default=24)
    parser.add_argument("--schedules", nargs="*", help="these only, on all sensors and lights")
    parser.add_argument("--sensors", nargs="*", default=SENSORS)
    parser.add_argument("--lights", nargs="*", type=float, default=LIGHTS)
    parser.add_argument("--clips", nargs="*")
    parser.add_argument("--methods", nargs="*", help="default: fast, best, at full rate vbm4d")
    parser.add_argument("--set", nargs="*", default=[], help="options of best, KEY=VALUE")
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    trials = Trials(arguments)
    todo = cases(arguments)
    for clip in dict.fromkeys(case[3] for case in todo):
        trials.clip(clip)
    cameras = {}
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for case, result in zip(todo, pool.map(trials.trial, todo)):
            if "best" in result and "fast" in result:
                cameras.setdefault(case[:3], []).append((case[3], result))
    print("| schedule, sensor, light | fast | best | vbm4d | best - fast | worst | best - vbm4d | worst |")
    print("|---|---|---|---|---|---|---|---|")
    worst = []
    for (schedule, sensor, light), results in cameras.items():
        print(row(f"{schedule}, {sensor}, {light:g}", results))
        worst += [(min(a - b for a, b in zip(each["best"], each["fast"])), schedule, sensor, light, clip)
                  for clip, each in results]
    print(f"\n{len(worst)} cases; best is below fast by more than 0.1 dB in:")
    for gain, *case in sorted(worst, key=lambda each: each[0]):
        if gain < -0.1:
            print(f"{gain:+.2f} {' '.join(map(str, case))}")


if __name__ == "__main__":
    main()
