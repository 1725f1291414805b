#!/usr/bin/python3
"""dB of `best` and what `learned` adds, for colour footage through three stacked planes and through a mosaic.

    PYTHONPATH=build/release/python tests/bench/decoder/learned_colour.py FOLDER CLIP... [--model FILE]

FOLDER has the clips; of each the middle 96 x 96 pixels and the first 24 slots. Schedule `random`; 12 bits, shot noise and
read noise of 10 electrons, where light 1.0 has 1000 photons."""

import argparse
from pathlib import Path

import numpy as np
import stipple

SLOTS, SIDE, MARGIN = 24, 96, 4
CHIP = {"read_noise_e": 10, "shot_noise": True, "bit_depth": 12, "full_scale_e": 10000, "full_well_e": 12000}


def middle(video):
    top, left = ((size - SIDE) // 2 for size in video.shape[1:3])
    return np.ascontiguousarray(video[:SLOTS, top:top + SIDE, left:left + SIDE])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("clips", nargs="+")
    parser.add_argument("--model", default="", help="weights instead of those of Stipple")
    args = parser.parse_args()
    options = {"model": args.model} if args.model else {}
    print("| clip | planes: `best` | `learned` | mosaic: `best` | `learned` |\n|---|---|---|---|---|")
    for name in args.clips:
        video, texts = middle(stipple.load(args.folder / name)), []
        for filters in ("none", "rggb"):
            stream = stipple.emulate(video, stipple.Sensor("ideal", {"cfa": filters, **CHIP}), "random")
            best, learned = (
                np.array([quality.psnr_db, quality.psnr_gamma_db]) for quality in (
                    stipple.compare(stipple.decode(stream, method, of_method), video, margin=MARGIN)
                    for method, of_method in (("best", {}), ("learned", options))))
            texts += ["{:.2f}/{:.2f}".format(*best), "{:+.2f}/{:+.2f}".format(*(learned - best))]
        print(f"| {name} | {' | '.join(texts)} |", flush=True)


if __name__ == "__main__":
    main()
