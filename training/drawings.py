"""Images that no camera has taken: stripes, checks, letters, stars, noise, shapes; light of about 0 to 1."""

import string

import numpy as np
from PIL import Image, ImageDraw, ImageFont

ROWS, COLS = 480, 640


def stripes(random):
    angle, period = random.uniform(0, np.pi), np.exp(random.uniform(np.log(2), np.log(40)))
    y, x = np.mgrid[:ROWS, :COLS]
    wave = np.sin(2 * np.pi * (np.cos(angle) * x + np.sin(angle) * y) / period)
    return 0.5 + 0.5 * (wave if random.random() < 0.5 else np.tanh(random.uniform(2, 20) * wave))


def checks(random):
    side = random.integers(3, 20)
    return ((np.mgrid[:ROWS, :COLS] // side).sum(0) % 2).astype(float)


def letters(random):
    size = random.uniform(1, 3)
    image = Image.new("F", (int(COLS / size), int(ROWS / size)))
    draw, font = ImageDraw.Draw(image), ImageFont.load_default()
    for row in range(0, image.height, 12):
        draw.text((0, row), "".join(random.choice(list(string.printable[:94] + " " * 12), 120)), random.uniform(0.3, 1), font)
    return np.asarray(image.resize((COLS, ROWS), Image.BILINEAR))


def stars(random):
    image = np.zeros((ROWS, COLS))
    count, side = random.integers(500, 6000), random.integers(1, 3)
    for row, col in zip(random.integers(ROWS, size=count), random.integers(COLS, size=count)):
        image[row:row + side, col:col + side] = random.uniform(0, 1) ** 2
    return image


def noise(random):
    side = int(random.integers(1, 6))
    cells = random.uniform(0, 1, (ROWS // side + 1, COLS // side + 1))
    return np.kron(cells, np.ones((side, side)))[:ROWS, :COLS]


def shapes(random):
    image = Image.new("F", (COLS, ROWS), random.uniform(0, 1))
    draw = ImageDraw.Draw(image)
    for _ in range(random.integers(20, 300)):
        place, size = random.uniform(0, COLS, 2), random.uniform(4, 80)
        corners = [tuple(place + size * random.normal(0, 1, 2)) for _ in range(random.integers(3, 6))]
        draw.polygon(corners, random.uniform(0, 1) ** 2)
    return np.asarray(image)


def ramp(random):
    angle = random.uniform(0, 2 * np.pi)
    y, x = np.mgrid[:ROWS, :COLS] / COLS - 0.5
    return np.clip(0.5 + (np.cos(angle) * x + np.sin(angle) * y), 0, 1)


def drawing(random):
    """(row, col), of one of these kinds."""
    draw = [stripes, checks, letters, stars, noise, shapes, ramp][random.integers(7)]
    dark, contrast = 10 ** random.uniform(-3, -0.5), random.uniform(0.3, 1)
    image = dark + contrast * draw(random)
    return np.float32(image if random.random() < 0.7 else dark + contrast - image + dark)
