"""Pictures of one scene through each schedule and by each decoding method, made by the Python module."""

import struct
import subprocess
import zlib

import numpy as np

SIZE, FRAMES, SHOWN = "192x144", 24, 12
NOT_READ = (38, 50, 84)  # colour of pixels that are not read
SENSORS = {"nd_mosaic": "nd_mosaic"}
INTRODUCTION = f"""# Gallery

One slot of the scene `pan` ([synthetic scenes](docs/scenes.md)), {FRAMES} slots of {SIZE} pixels, through the sensor
`paper`. Each picture shows from left to right: the truth; the samples that the chip delivers in this slot, each as the
mean light of its exposure (blue: not read); the video by `naive`; the video by another method, if there is one. PSNR
is in dB for light up to 2.0, without the first and last four frames. `scripts/site` makes all pictures with the program
itself.
"""


def tone_mapped(light):
    """Reinhard et al. 2002, Eq. 4, then the power 1/2.2; white is light 2.0."""
    light = np.clip(light, 0, 2)
    return np.rint(255 * (light * (1 + light / 4) / (1 + light)) ** (1 / 2.2)).astype(np.uint8)


def png(pixels):
    """The bytes of a PNG file of 8-bit RGB (row, column, 3)."""
    rows, cols, _ = pixels.shape
    lines = np.concatenate([np.zeros((rows, 1), np.uint8), pixels.reshape(rows, -1)], axis=1)
    chunks = ((b"IHDR", struct.pack(">2I5B", cols, rows, 8, 2, 0, 0, 0)),
              (b"IDAT", zlib.compress(lines.tobytes(), 9)), (b"IEND", b""))
    framed = (struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
              for name, data in chunks)
    return b"\x89PNG\r\n\x1a\n" + b"".join(framed)


def enlarged(panel, factor):
    return panel.repeat(factor, axis=0).repeat(factor, axis=1)


def side_by_side(panels):
    gap = np.full((panels[0].shape[0], 4, 3), 255, np.uint8)
    return png(np.concatenate([part for panel in panels for part in (panel, gap)][:-1], axis=1))


def samples_of(stream, truth, slot=SHOWN):
    """The samples of a slot as a picture."""
    sensor = stream.header["calibration"] if "calibration" in stream.header else stream.header
    picture = np.full((*truth.shape[1:3], 3), np.nan, np.float32)
    found = stream.samples(slot)
    light = (found["dn"] - sensor["black_level_dn"]) * sensor["gain_e_per_dn"] / sensor["electrons_per_unit"]
    picture[found["row"], found["col"], found["plane"]] = light / found["light_slots"]
    return np.where(np.isfinite(picture), tone_mapped(np.nan_to_num(picture)), np.array(NOT_READ, np.uint8))


class Gallery:
    """The scene, and the folder of the site's pages."""

    def __init__(self, stipple, program, folder):
        self.stipple, self.folder = stipple, folder
        (folder / "gallery").mkdir()
        scene = folder / "gallery/scene.npy"
        command = [program, "synth", "pan", "-o", scene, "--size", SIZE, "--frames", str(FRAMES), "-q"]
        subprocess.run(command, check=True)
        self.truth = np.load(scene)
        scene.unlink()

    def picture(self, name, stream, methods):
        """Writes the picture; returns a line with its link, and the PSNR of each method."""
        panels, figures = [tone_mapped(self.truth[SHOWN]), samples_of(stream, self.truth)], []
        for method in methods:
            video = self.stipple.decode(stream, method=method)
            quality = self.stipple.compare(video, self.truth, margin=4, max_value=2)
            figures.append(f"`{method}` {quality.psnr_db:.1f} dB")
            panels.append(tone_mapped(video[SHOWN]))
        (self.folder / f"gallery/{name}.png").write_bytes(side_by_side(panels))
        samples = stream.counts()["samples"] / self.truth.size
        return (f"![Slot {SHOWN}: truth, samples, decoded by {', '.join(methods)}](gallery/{name}.png)\n\n"
                f"{100 * samples:.0f} % of the values are sampled; {', '.join(figures)}.\n")

    def small_picture(self, methods):
        """The same of a part of the scene that each method decodes in seconds, enlarged; every method, no samples."""
        first, slots, rows, cols = 4, 16, 24, 32
        top, left = ((side - part) // 2 for side, part in zip(self.truth.shape[1:3], (rows, cols)))
        truth = self.truth[first:first + slots, top:top + rows, left:left + cols]
        stream = self.stipple.emulate(truth, "paper", "random")
        videos = {method: self.stipple.decode(stream, method=method) for method in methods}
        panels = [enlarged(tone_mapped(video[SHOWN - first]), 5) for video in (truth, *videos.values())]
        (self.folder / "gallery/methods_small.png").write_bytes(side_by_side(panels))
        figures = (f"`{method}` {self.stipple.compare(video, truth, margin=4, max_value=2).psnr_db:.1f} dB"
                   for method, video in videos.items())
        return (f"\n### All methods of coded schedules on {cols} x {rows} pixels\n\nThe middle of the scene, {slots} slots: few enough for the "
                f"method of the paper, `portz2013`.\n\n![Slot {SHOWN}: truth, {', '.join(methods)}]"
                f"(gallery/methods_small.png)\n\n{', '.join(figures)}.\n")

    def write_tutorial(self, program, figures):
        """The pictures of docs/tutorial.md."""
        stream = self.stipple.emulate(self.truth, "paper", "random")
        videos = [self.stipple.decode(stream, method) for method in ("naive", "fast")] + [self.truth]
        pictures = {"scene": [tone_mapped(self.truth[slot]) for slot in (4, SHOWN, 20)],
                    "samples": [samples_of(stream, self.truth, slot) for slot in (SHOWN - 1, SHOWN, SHOWN + 1)],
                    "decoded": [tone_mapped(video[SHOWN]) for video in videos]}
        for name, panels in pictures.items():
            (figures / f"tutorial_{name}.png").write_bytes(side_by_side(panels))
        subprocess.run([program, "schedule", "show", "random", "--pixels", "8", "-q", "--force",
                        "-o", figures / "tutorial_schedule.png"], check=True)

    def write(self, schedules, methods, small_methods):
        """One picture a schedule and a method; `small_methods` on a part of the scene, none if empty."""
        lines = [INTRODUCTION, "\n## Decoding methods\n\nThe schedule is `random` ([all methods](docs/decoder.md)).\n"]
        stream = self.stipple.emulate(self.truth, "paper", "random")
        for method in methods:
            lines.append(f"\n### {method}\n\n" + self.picture(f"method_{method}", stream, dict.fromkeys(("naive", method))))
        if small_methods:
            lines.append(self.small_picture(small_methods))
        lines.append("\n## Schedules\n\nEach schedule is explained on [its page](docs/schedules.md).\n")
        for schedule in schedules:
            stores = self.stipple.Schedule(schedule, size=self.truth.shape[1:3]).charge_stores
            settings = {"charge_stores": stores} if stores > 1 else {}
            sensor = self.stipple.Sensor(SENSORS.get(schedule, "paper"), settings)
            stream = self.stipple.emulate(self.truth, sensor, schedule)
            lines.append(f"\n### {schedule}\n\n" + self.picture(schedule, stream, ("naive", "fast")))
        (self.folder / "gallery.md").write_text("".join(lines))
