#!/usr/bin/python3
"""Makes the pictures of docs/concept.md anew from the built program: timing.svg and strip.png in docs/figures, by
Debian's Python (python3-numpy) and ffmpeg. docs/figures/chip.svg is drawn by hand. Prints the quality of the videos."""

import argparse
import base64
import json
import struct
import subprocess
import tempfile
import tomllib
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
FONT = 'font-family="DejaVu Sans, Verdana, Helvetica, Arial, sans-serif"'
SLOT_MS = 5  # of the paper's sensor
COLOURS = {1: ("#fbd46d", "#222"), 2: ("#f0904d", "#222"), 4: ("#b5467a", "#fff"), 8: ("#4b3b87", "#fff")}


class Svg:
    """A picture on white, written as it is drawn."""

    def __init__(self, width, height):
        self.lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
                      f'height="{height}" {FONT} font-size="13" fill="#222">']
        self.rect(0, 0, width, height, "#fff")

    def rect(self, x, y, width, height, fill, extra=""):
        self.lines.append(f'<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="{fill}"{extra}/>')

    def text(self, x, y, words, extra=""):
        self.lines.append(f'<text x="{x}" y="{y}"{extra}>{words}</text>')

    def write(self, file):
        file.write_text("\n".join([*self.lines, "</svg>"]) + "\n")


MIDDLE, END, BOLD, SMALL = (' text-anchor="middle"', ' text-anchor="end"', ' font-weight="bold"',
                            ' font-size="12" fill="#444"')


class Program:
    """The program under work, in a folder for its files."""

    def __init__(self, file, folder):
        self.file, self.folder = file.resolve(), folder

    def __call__(self, *arguments):
        done = subprocess.run([self.file, *arguments, "--json", "-", "--force", "-q"], cwd=self.folder, check=True,
                              stdout=subprocess.PIPE)
        return json.loads(done.stdout)

    def exposures(self, schedule, size):
        """Of each pixel of an array the exposures (first slot, slots) in a period, and the period. The schedule
        has no gaps within exposures."""
        self("schedule", "make", schedule, "--size", size, "-o", "schedule.toml")
        made = tomllib.loads((self.folder / "schedule.toml").read_text())
        period = made["period_slots"]
        return [code_exposures(code, period) for code in made["code"]], period


def code_exposures(code, period):
    begins = [slot for slot in range(period) if code[slot] == "A"]
    ends = [begin + 1 for begin in begins]
    for i, begin in enumerate(begins):
        while ends[i] < begin + period and code[ends[i] % period] == "a":
            ends[i] += 1
    return [(begin, end - begin) for begin, end in zip(begins, ends)]


# The timing diagram.

SHOWN_SLOTS, SLOT, LANE, LEFT, MARKED = 16, 44, 25, 158, 9


def lane(svg, top, exposures, period):
    """Draws the exposures of a pixel; returns the slots at whose end it is read."""
    reads = []
    for first, slots in exposures:
        for begin in range(first - period * (first // period + 1), SHOWN_SLOTS, period):
            left, right = max(begin, 0), min(begin + slots, SHOWN_SLOTS)
            if left >= right:
                continue
            fill, ink = COLOURS[slots]
            svg.rect(LEFT + left * SLOT + 1, top + 3, (right - left) * SLOT - 2, LANE - 6, fill)
            svg.text(LEFT + left * SLOT + 11, top + LANE // 2 + 4, slots, f' fill="{ink}" font-size="12"')
            if begin + slots <= SHOWN_SLOTS:
                reads.append(begin + slots - 1)
    return reads


def timing(program, output):
    """Exposures and readouts of the two conventional cameras and of ten coded pixels."""
    svg = Svg(LEFT + SHOWN_SLOTS * SLOT + 20, 434)
    svg.text(16, 18, "Conventional cameras, all pixels alike", BOLD)
    svg.text(LEFT + SHOWN_SLOTS * SLOT, 18, f"bar: exposure, its length in slots of {SLOT_MS} ms; dot: readout",
             END + SMALL)
    svg.text(16, 102, "Coded exposure, ten pixels", BOLD)
    pixels, period = program.exposures("random", "10x1")
    rows = [(110 + row * LANE, f"pixel {row + 1}", exposures, period) for row, exposures in enumerate(pixels)]
    for row, (schedule, name) in enumerate((("full1x", "1x exposure"), ("full4x", "4x exposure"))):
        (exposures,), period = program.exposures(schedule, "1x1")
        rows.append((30 + row * LANE, name, exposures, period))
    reads = []
    for top, name, exposures, period in rows:
        svg.text(LEFT - 12, top + 17, name, END)
        reads.append(lane(svg, top, exposures, period))
    top, marked = 110 + len(pixels) * LANE + 18, LEFT + (MARKED + 1) * SLOT
    for stroke in ("#fff", '#111" stroke-dasharray="5 4'):
        svg.lines.append(f'<path d="M{marked} 108 V{top + 22}" stroke="{stroke}" stroke-width="2"/>')
    for (lane_top, *_), slots in zip(rows, reads):
        for slot in slots:
            svg.lines.append(f'<circle cx="{LEFT + (slot + 1) * SLOT}" cy="{lane_top + LANE / 2}" r="4.5" fill="#111" '
                             'stroke="#fff"/>')
    for words, down in (("pixels read", 0), ("slot", 20), ("time / ms", 40)):
        svg.text(LEFT - 12, top + down, words, END)
    for slot in range(SHOWN_SLOTS):
        middle = LEFT + slot * SLOT + SLOT // 2
        svg.text(middle, top, sum(slot in slots for slots in reads[:len(pixels)]), MIDDLE + BOLD * (slot == MARKED))
        svg.text(middle, top + 20, slot, MIDDLE + SMALL)
    for slot in range(0, SHOWN_SLOTS + 1, 4):
        svg.text(LEFT + slot * SLOT, top + 40, slot * SLOT_MS, MIDDLE + SMALL)
    svg.write(output / "timing.svg")


# The strip of pictures.

SIZE, FRAMES, SHOWN = "320x240", "32", 16
CROP = (slice(34, 162), slice(96, 264))  # rows, columns
ZOOM = 4  # of details: a lamp and a dark doorway
DETAILS = {"#ff7f0e": (slice(46, 78), slice(158, 200)), "#17becf": (slice(129, 161), slice(172, 214))}
NOT_READ = (38, 50, 84)


def tone_mapped(light):
    """Reinhard et al. 2002, Eq. 4, then the power 1/2.2. White is 2.0, the most that an exposure of one slot can tell
    with the paper's sensor."""
    light = np.clip(light, 0, 2)
    return np.rint(255 * (light * (1 + light / 4) / (1 + light)) ** (1 / 2.2)).astype(np.uint8)


def samples_of_slot(program, stream, slot, shape):
    """What the chip delivers in a slot (docs/stream_format.md), as mean light of each exposure; NaN where a pixel is
    not read."""
    content = (program.folder / stream).read_bytes()
    at, = struct.unpack_from("<I", content, 12)
    gain, = struct.unpack_from("<d", content, 40)
    per_unit, = struct.unpack_from("<d", content, 64)
    payload = b""
    while content[at:at + 4] == b"\xc5SPK":
        size, = struct.unpack_from("<I", content, at + 24)
        if content[at + 4] == 1 and struct.unpack_from("<Q", content, at + 8)[0] == slot:
            payload += content[at + 36:at + 36 + size]
        at += 36 + size
    pixels, period = program.exposures("random", SIZE)
    lengths = np.zeros(len(pixels))
    for pixel, exposures in enumerate(pixels):
        for first, slots in exposures:
            if (first + slots - 1 - slot) % period == 0:
                lengths[pixel] = slots
    light = np.full((len(pixels), 3), np.nan)
    due = lengths > 0
    light[due] = np.frombuffer(payload, np.uint8).reshape(-1, 3) * gain / per_unit / lengths[due, None]
    return light.reshape(shape)


def png(pixels):
    rows, cols, _ = pixels.shape
    command = ["ffmpeg", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{cols}x{rows}", "-i", "-",
               "-f", "image2pipe", "-c:v", "png", "-"]
    return subprocess.run(command, input=pixels.tobytes(), check=True, stdout=subprocess.PIPE).stdout


def videos(program):
    """Renders, records and decodes the scene. Returns the pictures of the shown slot and the quality of each video."""
    program("synth", "pan", "-o", "truth.npy", "--size", SIZE, "--frames", FRAMES)
    truth = np.load(program.folder / "truth.npy", mmap_mode="r")[SHOWN]
    pictures, quality = {"truth": truth}, {}
    for schedule in ("full1x", "full4x", "random"):
        program("emulate", "truth.npy", "-o", f"{schedule}.stipple", "--schedule", schedule)
        for method in ("naive", "best"):
            program("decode", f"{schedule}.stipple", "-o", "video.npy", "--method", method)
            pictures[schedule, method] = np.load(program.folder / "video.npy", mmap_mode="r")[SHOWN]
            quality[schedule, method] = program("compare", "video.npy", "truth.npy", "--margin", "4", "--max-value",
                                                "2")["psnr_db"]
    pictures["samples"] = samples_of_slot(program, "random.stipple", SHOWN, truth.shape)
    return pictures, quality


def strip(program, output):
    """One slot as the conventional cameras and the coded chip deliver it, decoded, and the truth."""
    pictures, quality = videos(program)
    read = 100 * np.mean(np.isfinite(pictures["samples"][..., 0]))
    panels = [(("full1x", "naive"), "1x exposure", f"{250 // SLOT_MS} frames/s, {SLOT_MS} ms light"),
              (("full4x", "naive"), "4x exposure", f"{250 // SLOT_MS} frames/s, {4 * SLOT_MS} ms light"),
              ("samples", "Coded samples", f"one slot, {read:.0f} % of the pixels"),
              (("random", "best"), "Decoded", f"{1000 // SLOT_MS} frames/s"),
              ("truth", "Truth", f"{1000 // SLOT_MS} frames/s")]
    rows, cols = (part.stop - part.start for part in CROP)
    gap, head = 8, 44
    width, height = len(panels) * (cols + gap) + gap, (1 + len(DETAILS)) * (rows + gap)
    svg = Svg(width, head + height)
    canvas = np.full((height, width, 3), 255, np.uint8)
    frames = []
    for i, (key, title, words) in enumerate(panels):
        left = gap + i * (cols + gap)
        svg.text(left, 18, title, f'{BOLD} font-size="14"')
        svg.text(left, 35, words, SMALL)
        picture = np.where(np.isfinite(pictures[key]), tone_mapped(np.nan_to_num(pictures[key])), NOT_READ)
        canvas[:rows, left:left + cols] = picture[CROP]
        for j, (colour, detail) in enumerate(DETAILS.items()):
            top = (1 + j) * (rows + gap)
            canvas[top:top + rows, left:left + cols] = picture[detail].repeat(ZOOM, 0).repeat(ZOOM, 1)
            frames += [(left, head + top, cols, rows, colour),
                       (left + detail[1].start - CROP[1].start, head + detail[0].start - CROP[0].start, cols // ZOOM,
                        rows // ZOOM, colour)]
    data = base64.b64encode(png(canvas)).decode()
    svg.lines.append(f'<image x="0" y="{head}" width="{width}" height="{height}" href="data:image/png;base64,{data}"/>')
    for x, y, frame_width, frame_height, colour in frames:
        svg.rect(x, y, frame_width, frame_height, "none", f' stroke="{colour}" stroke-width="2"')
    svg.write(program.folder / "strip.svg")
    subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-i", program.folder / "strip.svg", "-vf",
                    "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=dither=none",
                    "-compression_level", "100", "-pred", "mixed", output / "strip.png"], check=True)
    print("PSNR in dB of the videos, light up to 2.0, without the first and last four frames")
    for (schedule, method), psnr in quality.items():
        print(f"{schedule:8} {method:6} {psnr:6.2f}")


def main():
    figures = {"timing": timing, "strip": strip}
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("figure", nargs="*", help="timing, strip; both if none is named")
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/stipple",
                        help="built program (build/release/stipple)")
    parser.add_argument("--output", type=Path, default=ROOT / "docs/figures",
                        help="folder of the pictures (docs/figures)")
    options = parser.parse_args()
    if not options.program.is_file():
        parser.error(f"{options.program} does not exist; build it with scripts/build release stipple")
    for name in options.figure or figures:
        if name not in figures:
            parser.error(f"{name} is no figure; timing and strip are")
        with tempfile.TemporaryDirectory(prefix="stipple_figures_") as folder:
            figures[name](Program(options.program, Path(folder)), options.output)


if __name__ == "__main__":
    main()
