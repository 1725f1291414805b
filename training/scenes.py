"""Scenes to train on: crops of videos, views of panoramas and drawings that move, and the embedded scenes."""

from pathlib import Path

import numpy as np
import stipple
from drawings import drawing
from frame_hash import frame_hashes
from scipy import ndimage

LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)  # Rec. 709
SHARES = {"video": 0.3, "panorama": 0.4, "embedded": 0.1, "drawing": 0.2}
EMBEDDED = ("pan", "roll", "pencils", "dice", "still")
SUBSTEPS = 4  # instants of a slot


def read_radiance(path):
    """An image in Radiance RGBE with run-length coded rows (Ward, Graphics Gems II, 1991): light (row, col, plane)."""
    data = Path(path).read_bytes()
    header, _, rest = data.partition(b"\n\n")
    if not header.startswith(b"#?"):
        raise ValueError(f"{path}: is not a Radiance image")
    size, _, body = rest.partition(b"\n")
    axis, rows, across, cols = size.split()
    if (axis, across) != (b"-Y", b"+X"):
        raise ValueError(f"{path}: is turned: {size.decode()}")
    rows, cols, place = int(rows), int(cols), 0
    image = np.empty((rows, 4, cols), np.uint8)
    for row in range(rows):
        if body[place:place + 2] != b"\2\2":
            raise ValueError(f"{path}: row {row} is not run-length coded")
        place += 4
        for channel in range(4):
            col = 0
            while col < cols:
                count = body[place]
                run = count > 128
                count -= 128 if run else 0
                values = body[place + 1:place + (2 if run else 1 + count)]
                image[row, channel, col:col + count] = np.frombuffer(values, np.uint8)
                place += 1 + len(values)
                col += count
    mantissa, exponent = image[:, :3].astype(np.float32), image[:, 3:].astype(np.int32)
    return np.moveaxis(np.ldexp(mantissa, exponent - 136), 1, 2)


def reduced(video, side=300):
    """By areas of whole pixels to about `side` rows."""
    step = max(1, round(video.shape[1] / side))
    rows, cols = video.shape[1] // step * step, video.shape[2] // step * step
    blocks = video[:, :rows, :cols].reshape(len(video), rows // step, step, cols // step, step)
    return blocks.mean((2, 4))


class Scenes:
    """Clips of light, luminance (slot, row, col), from the videos and panoramas of a folder."""

    def __init__(self, footage, kept):
        """kept: a folder for what has been decoded."""
        kept.mkdir(exist_ok=True)
        self.videos, self.panoramas, self.hashes = [], [], {}
        for path in sorted(Path(footage).glob("*.mp4")):
            file = kept / f"{path.stem}.npy"
            if not file.exists():
                light = stipple.load(path, transfer="gamma22", luminance=True)
                np.save(file, reduced(light[:200]).astype(np.float16))
            self.videos.append(np.load(file, mmap_mode="r"))
            self.hashes[path.name] = frame_hashes(self.videos[-1])
        for path in sorted(Path(footage).glob("*.hdr")):
            file = kept / f"{path.stem}.panorama.npy"
            if not file.exists():
                np.save(file, read_radiance(path) @ LUMINANCE)
            self.panoramas.append(np.load(file))
            self.hashes[path.name] = frame_hashes(self.panoramas[-1][np.newaxis])

    def write_hashes(self, file):
        """Lines of a source and the hash of a frame."""
        file.write_text("".join(f"{name} {frame.tobytes().hex()}\n" for name, frames in self.hashes.items() for frame in frames))

    def clip(self, random, slots, side):
        """Light of about 0 to 1, at most 2."""
        kind = random.choice(list(SHARES), p=list(SHARES.values()))
        video = getattr(self, kind)(random, slots, side)
        for axis in (1, 2):
            if random.random() < 0.5:
                video = np.flip(video, axis)
        if random.random() < 0.5:
            video = video.transpose(0, 2, 1)
        if random.random() < 0.5:
            video = video[::-1]
        if random.random() < 0.5:  # less contrast
            video = random.uniform(0.15, 1) * np.maximum(video, 0) ** random.uniform(0.3, 1)
        if random.random() < 0.1:  # flashes
            video = video * np.where(random.random((slots, 1, 1)) < random.uniform(0.05, 0.6), 1, random.uniform(0.02, 0.5))
        if random.random() < 0.4:
            video = video + random.uniform(0, 0.015) * np.sqrt(video + 0.02) * grain(random, video.shape)
        return np.ascontiguousarray(np.clip(video, 0, 2), np.float32)

    def video(self, random, slots, side):
        source = self.videos[random.integers(len(self.videos))]
        frames, rows, cols = source.shape
        step = min(int(random.integers(1, 4)), min(rows, cols) // side)
        pause = 2 if frames >= 2 * slots and random.random() < 0.3 else 1
        first = random.integers(0, frames - pause * slots + 1)
        top, left = random.integers(0, rows - side * step + 1), random.integers(0, cols - side * step + 1)
        part = source[first:first + pause * slots:pause, top:top + side * step, left:left + side * step]
        part = part.astype(np.float32).reshape(slots, side, step, side, step).mean((2, 4))
        return part * random.choice([1, 1, 1, 0.5, 1.5])

    def embedded(self, random, slots, side):
        name = str(random.choice(EMBEDDED))
        scene = stipple.synth(name, frames=slots, size=(160, 216), seed=int(random.integers(1000, 2**31)),
                              luminance=True, threads=1)
        top, left = random.integers(0, 160 - side + 1), random.integers(0, 216 - side + 1)
        return scene[:, top:top + side, left:left + side]

    def panorama(self, random, slots, side):
        source = self.panoramas[random.integers(len(self.panoramas))]
        if random.random() < 0.5:  # a texture of low contrast on it
            texture = drawing(random)
            repeats = [-(-size // own) for size, own in zip(source.shape, texture.shape)]
            texture = np.tile(texture - texture.mean(), repeats)[:source.shape[0], :source.shape[1]]
            source = source * np.maximum(1 + random.uniform(0.1, 1) * texture, 0)
        return self.moving(random, slots, side, source)

    def drawing(self, random, slots, side):
        return self.moving(random, slots, side, drawing(random))

    def moving(self, random, slots, side, source):
        """Turns, zooms and shakes; sometimes with a piece of a panorama that moves in front."""
        rows, cols = source.shape
        still = random.random() < 0.35
        speed, shake, turn, zoom = (0 if still else value for value in (
            random.normal(0, 2.5, 2), random.uniform(0, 1.2), np.radians(random.normal(0, 0.2)), random.normal(0, 0.002)))
        scale = random.choice([0.5, 0.75, 1.0, 1.5, 2.0])
        centre = np.array([random.uniform(100, rows - 100), random.uniform(150, cols - 150)])
        phase = random.uniform(0, 2 * np.pi, 2)
        piece = Piece(random, self.panoramas, source, slots, side) if random.random() < 0.6 else None
        result = np.zeros((slots, side, side), np.float32)
        for slot in range(slots):
            for substep in range(SUBSTEPS):
                t = slot + (substep + 0.5) / SUBSTEPS - 0.5 - slots / 2
                place = centre + t * np.asarray(speed) + shake * scale * np.sin(np.array([0.8, 0.9]) * t + phase)
                view = sampled(source, place, turn * t, scale * (1 + zoom * t) / 2, 2 * side)
                if piece is not None:
                    view = piece.before(view, t)
                result[slot] += view.reshape(side, 2, side, 2).mean((1, 3)) / SUBSTEPS
        return np.minimum(result / max(np.percentile(result, random.uniform(96, 99.8)), 1e-6), 2)


class Piece:
    """A disc of another panorama, in front of a view of twice `side` pixels."""

    def __init__(self, random, panoramas, behind, slots, side):
        source = panoramas[random.integers(len(panoramas))]
        self.radius = int(random.integers(8, 24))
        row, col = (random.integers(self.radius, size - self.radius) for size in source.shape)
        disc = source[row - self.radius:row + self.radius, col - self.radius:col + self.radius]
        self.light = disc * np.median(behind) / max(np.median(disc), 1e-6) * random.uniform(0.3, 3)
        away = np.hypot(*(np.mgrid[:2 * self.radius, :2 * self.radius] - self.radius + 0.5))
        self.cover = np.clip(self.radius - 1 - away, 0, 1).astype(np.float32)
        self.middle, self.speed = random.uniform(20, side - 20, 2), random.normal(0, 4, 2)
        self.spin = np.radians(random.normal(0, 5))

    def before(self, view, t):
        middle = 2 * (self.middle + t * self.speed)
        c, s = np.cos(self.spin * t) / 2, np.sin(self.spin * t) / 2
        turn = np.array([[c, s], [-s, c]])
        offset = self.radius - 0.5 - turn @ middle
        cover, light = (ndimage.affine_transform(image, turn, offset, view.shape, order=1)
                        for image in (self.cover, self.light))
        return view * (1 - cover) + light * cover


def grain(random, shape):
    """Noise of unit variance, as of footage that a camera has taken and a codec may have smoothed."""
    sigma = random.choice([0, 0.6, 1.0, 1.5])
    noise = ndimage.gaussian_filter(random.standard_normal(shape, np.float32), (random.uniform(0, sigma), sigma, sigma))
    return noise / noise.std()


def sampled(image, centre, angle, scale, side):
    """A square of `side` samples around a place, turned, with a distance of `scale` pixels."""
    c, s = scale * np.cos(angle), scale * np.sin(angle)
    turn = np.array([[c, s], [-s, c]])
    return ndimage.affine_transform(image, turn, centre - turn @ np.full(2, (side - 1) / 2), (side, side),
                                    order=1, mode="mirror")
