#!/usr/bin/python3
"""Scenes unlike those that the network of `learned` and `learned_fast` was trained on: dB of the estimate and after it.

    PYTHONPATH=build/release/python tests/bench/decoder/learned_failures.py [--model FILE] [--pictures FOLDER]

Each scene stands still, and moves by 1.5 pixels a slot; 32 slots of 96 x 96, schedule `random`, sensor `paper`."""

import argparse
from pathlib import Path

import numpy as np
import stipple
from PIL import Image, ImageDraw, ImageFont

SLOTS, SIDE, SPEED, MARGIN = 32, 96, 1.5, 4
FINE = 4  # samples a pixel, in rows and columns


def noise(rows, cols, random):
    return np.kron(random.uniform(0, 1, (rows // FINE, cols // FINE)), np.ones((FINE, FINE)))


def text(rows, cols, random):
    image = Image.new("F", (cols // 3, rows // 3), 0.9)
    draw, font = ImageDraw.Draw(image), ImageFont.load_default()
    for row in range(3, rows // 3, 14):
        draw.text((0, row), "".join(random.choice(list("abcdefghijklmnopqrstuvwxyz  "), 80)), 0.05, font)
    return np.asarray(image.resize((cols, rows), Image.BILINEAR))


def stripes(rows, cols, random):
    y, x = np.mgrid[:rows, :cols] / FINE
    return 0.5 + 0.45 * np.sin(2 * np.pi * (0.8 * x + 0.6 * y) / 2.7)


def checks(rows, cols, random):
    y, x = np.mgrid[:rows, :cols] // (5 * FINE)
    return 0.1 + 0.8 * ((x + y) % 2)


def stars(rows, cols, random):
    image = np.full((rows, cols), 0.002)
    for row, col in zip(random.integers(rows, size=120), random.integers(cols, size=120)):
        image[row:row + FINE, col:col + FINE] = random.uniform(0.1, 2)
    return image


def edge(rows, cols, random):
    image = np.full((rows, cols), 0.05)
    image[:, cols // 2:] = 0.9
    return image


def ramp(rows, cols, random):
    return np.tile(np.linspace(0.01, 1, cols), (rows, 1))


def lamp(rows, cols, random):
    """Far above what a long exposure holds."""
    y, x = np.mgrid[:rows, :cols]
    return np.where(np.hypot(y - rows / 2, x - cols / 3) < 14 * FINE, 2, 0.1)


def moved(image, speed):
    """Slots of a pan over an image of FINE samples a pixel; each slot is the mean of 4 instants."""
    def view(at):
        left = round(at * FINE)
        part = image[:SIDE * FINE, left:left + SIDE * FINE]
        return part.reshape(SIDE, FINE, SIDE, FINE).mean((1, 3))

    return np.stack([np.mean([view(speed * (slot + part / 4)) for part in range(4)], 0) for slot in range(SLOTS)])


def flashes(random):
    """A still scene whose light changes by half from slot to slot."""
    image = moved(text(SIDE * FINE, 2 * SIDE * FINE, random), 0)
    return image * random.uniform(0.5, 1, SLOTS)[:, np.newaxis, np.newaxis]


def scenes():
    for draw in (noise, text, stripes, checks, stars, edge, ramp, lamp):
        image = draw(SIDE * FINE, 2 * SIDE * FINE, np.random.default_rng(1))
        for speed in (0, SPEED):
            yield draw.__name__ + (" moves" if speed else ""), moved(image, speed).astype(np.float32)
    yield "flashes", flashes(np.random.default_rng(1)).astype(np.float32)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--model", help="weights")
    parser.add_argument("--pictures", type=Path, help="folder for a slot of each: truth, best, learned")
    args = parser.parse_args()
    options = {"model": args.model} if args.model else {}
    print("| scene, dB linear/after 1/2.2 | fast | learned_fast | best | learned |\n|---|---|---|---|---|")
    for name, video in scenes():
        stream = stipple.emulate(video, "paper", "random")
        decoded, texts = {}, []
        for base, refined in (("fast", "learned_fast"), ("best", "learned")):
            qualities = []
            for method in (base, refined):
                decoded[method] = stipple.decode(stream, method, options if method == refined else {})
                quality = stipple.compare(decoded[method], video, margin=MARGIN, max_value=2)
                qualities.append(np.array([quality.psnr_db, quality.psnr_gamma_db]))
            texts += ["{:.1f}/{:.1f}".format(*qualities[0]), "{:+.2f}/{:+.2f}".format(*(qualities[1] - qualities[0]))]
        print(f"| {name} | {' | '.join(texts)} |", flush=True)
        if args.pictures:
            args.pictures.mkdir(exist_ok=True)
            row = np.hstack([video[16], decoded["best"][16], decoded["learned"][16]])
            display = np.uint8(255 * np.clip(row, 0, 1) ** (1 / 2.2))
            Image.fromarray(display).save(args.pictures / f"{name}.png")


if __name__ == "__main__":
    main()
