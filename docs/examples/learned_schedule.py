"""Learns the exposure codes of an 8 x 8 tile for a class of scenes, and compares them with hardware_tiled.

    python3 learned_schedule.py OUT [CLIP]...

A camera with the clocks of the LUX1310 sees textures that move and discs that cover them. Codes and a small unrolled
decoder are trained together; the codes begin as those of hardware_tiled. OUT gets learned.toml, learned.mem (for the
chip's sequencer) and a table of both schedules on scenes that were not trained, and on clips. A schedule is judged by
Stipple's decoders, not by the one of the training.

Needs PyTorch and SciPy (Debian: python3-torch, python3-scipy), and the program stipple. Takes minutes on two cores."""

import argparse
import os
import subprocess
from pathlib import Path

import numpy as np
import stipple
import stipple.torch as st
import torch
from scipy.stats import t as student

SENSOR, ARRAY = "lux1310", (1024, 1280)
TILE, PERIOD, EXPOSURES, LENGTHS = 8, 15, 4, range(1, 9)
CROP, SLOTS, MIDDLE = 32, 45, slice(15, 30)  # slots of the loss: no end of the clip cuts their exposures


def scene(seed, frames=48, side=96):
    """A texture that moves, and discs of other textures before it."""
    random = np.random.default_rng(seed)
    row, col = np.indices((side, side))
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(side), np.fft.fftfreq(side), indexing="ij"))

    def texture():
        """Natural images have amplitudes of about 1 / frequency."""
        spectrum = np.fft.fft2(random.normal(size=(side, side))) / np.maximum(frequency, 1 / side) ** 1.2
        image = np.fft.ifft2(spectrum).real
        return 0.5 * random.uniform(0.2, 1) * np.exp(random.uniform(0.3, 0.8) * image / image.std())

    def moved(image, way):
        ramp = np.fft.fftfreq(side)[:, None] * way[0] + np.fft.fftfreq(side)[None] * way[1]
        return np.fft.ifft2(np.fft.fft2(image) * np.exp(-2j * np.pi * ramp)).real

    layers = [(texture(), random.normal(0, 1, 2), None)]
    layers += [(texture(), random.normal(0, 1.5, 2), (random.uniform(0, side, 2), random.uniform(6, 16)))
               for _ in range(6)]
    video = np.empty((frames, side, side), np.float32)
    for slot in range(frames):
        for image, speed, disc in layers:
            light = moved(image, slot * speed)
            if disc is not None:
                middle = disc[0] + slot * speed - side / 2
                away = [(at - middle[i]) % side - side / 2 for i, at in enumerate((row, col))]
                cover = np.clip(disc[1] + 0.5 - np.hypot(*away), 0, 1)
                light = cover * light + (1 - cover) * video[slot]
            video[slot] = light
    return np.clip(video, 0, 8)


class Decoder(torch.nn.Module):
    """Steps of the data term in closed form, each followed by a small network."""

    def __init__(self, steps=3, channels=8):
        super().__init__()
        self.networks = torch.nn.ModuleList(
            torch.nn.Sequential(torch.nn.Conv3d(2, channels, 3, padding=1), torch.nn.ReLU(),
                                torch.nn.Conv3d(channels, channels, 3, padding=1), torch.nn.ReLU(),
                                torch.nn.Conv3d(channels, 1, 3, padding=1)) for _ in range(steps))
        self.step = torch.nn.Parameter(torch.full((steps,), -3.0))  # logarithm

    def forward(self, chip, samples, weights):
        y, is_sample, variance = samples
        gain = chip.gain(y.shape, weights)
        seen = chip.adjoint(is_sample.float().expand_as(y), weights, SLOTS)
        x = chip.adjoint(y / gain, weights, SLOTS)
        x = x + (1 - seen) * (x.sum(1, True) / seen.sum(1, True).clamp(min=1))
        for step, network in zip(self.step.exp(), self.networks):
            error = is_sample * (y - chip.expose(x, weights))
            x = x + chip.adjoint(error / (gain + variance / step), weights, SLOTS)
            root = x.clamp(min=1e-3).sqrt()
            x = (root + network(torch.stack([root, seen], 1))[:, 0]).clamp(min=0).square()
        return x


class Codes(torch.nn.Module):
    """Soft weights, of which the chip has the nearest legal codes; the gradient passes straight through (as in
    BinaryConnect: Courbariaux, Bengio, David, NIPS 2015)."""

    def __init__(self, begin):
        super().__init__()
        self.codes = st.legal_codes(PERIOD, LENGTHS, EXPOSURES)
        self.soft = torch.nn.Parameter(self.hard(st.nearest_codes(begin, self.codes, PERIOD)))

    def hard(self, chosen):
        return self.codes[chosen].permute(2, 3, 0, 1)

    def chosen(self):
        return torch.einsum("esrc,nes->nrc", self.soft.detach(), self.codes).argmax(0)

    def forward(self):
        return self.hard(self.chosen()) + (self.soft - self.soft.detach())


def lattice():
    """The codes of the first 8 x 8 pixels of hardware_tiled, and its delays from tile to tile."""
    plan = stipple.Schedule("hardware_tiled", size=ARRAY, sensor=SENSOR)
    codes = {}
    for row, col, first, open_slots in plan.exposures().tolist():
        codes.setdefault((row, col), set()).add((first, open_slots))

    def delay(row, col):
        there = codes[row % plan.tile[0], col % plan.tile[1]]
        return next(d for d in range(PERIOD) if {((first + d) % PERIOD, o) for first, o in codes[0, 0]} == there)

    return st.weights_of(plan)[:, :, :TILE, :TILE], (delay(TILE, 0), delay(0, TILE))


def train(steps, batch=2):
    """The learned weights and their delays."""
    torch.manual_seed(1)
    scenes = [scene(seed) for seed in range(min(24, batch * steps))]
    data = stipple.dataset(scenes, SENSOR, "full1x", crop=(CROP, CROP), slots=SLOTS, light=(0.3, 2))
    begin, delays = lattice()
    chip, codes, decoder = st.CodedSensor(SENSOR, PERIOD), Codes(begin), Decoder()
    learn = torch.optim.Adam([{"params": decoder.parameters(), "lr": 3e-3}, {"params": codes.parameters(), "lr": 0}])
    order = torch.randperm(len(data), generator=torch.Generator().manual_seed(1)).tolist()
    losses = []
    for step in range(steps):
        if step == steps // 3:  # until then the decoder learns alone
            learn.param_groups[1]["lr"] = 0.02
        items = [data[order[(batch * step + i) % len(order)]] for i in range(batch)]
        truth = torch.from_numpy(np.stack([item.truth for item in items]))
        weights = st.delayed(codes(), PERIOD, delays, (CROP // TILE,) * 2)
        video = decoder(chip, chip(truth, weights), weights)
        error = (video + 1e-3).sqrt() - (truth + 1e-3).sqrt()
        loss = error[:, MIDDLE].square().mean()
        learn.zero_grad()
        loss.backward()
        learn.step()
        losses.append(float(loss))
        if (step + 1) % max(steps // 10, 1) == 0:
            recent = np.mean(losses[-(steps // 10 + 1):])
            print(f"step {step + 1} of {steps}: {-10 * np.log10(recent):.2f} dB", flush=True)
    changed = int((codes.chosen() != st.nearest_codes(begin, codes.codes, PERIOD)).sum())
    print(f"{changed} of {TILE * TILE} codes have changed", flush=True)
    return codes().detach(), delays


def mean_of(rows, system, clip, figure):
    """Over the seeds."""
    return np.mean([row[figure] for row in rows if (row["system"], row["footage"]) == (system, str(clip))])


def compare(schedule, out, clips, seeds, methods):
    """Gains over hardware_tiled, mean and 95 % interval over the clips."""
    systems = "".join(f'[[systems]]\nname = "{name} {method}"\nschedule = "{plan}"\nmethod = "{method}"\n\n'
                      for method in methods for name, plan in (("hardware", "hardware_tiled"), ("learned", schedule)))
    space = out / "space.toml"
    listed = ", ".join(f'"{clip}"' for clip in clips)
    space.write_text(f'[axes]\nsensor = "{SENSOR}"\nfootage = [{listed}]\nseed = {list(range(1, seeds + 1))}\n\n'
                     f"{systems}")
    rows = stipple.explore(space, out / "results")
    print(f"{'method':8} {'figure':16} {'hardware':>9} {'gain, dB':>9}  95 % interval over {len(clips)} clips")
    for method in methods:
        for figure in ("psnr_db", "psnr_gamma_db", "pu21_psnr_db"):
            mean = {name: np.array([mean_of(rows, f"{name} {method}", clip, figure) for clip in clips])
                    for name in ("hardware", "learned")}
            gain = mean["learned"] - mean["hardware"]
            half = (student.ppf(0.975, len(clips) - 1) * gain.std(ddof=1) / len(clips) ** 0.5 if len(clips) > 1
                    else np.nan)
            print(f"{method:8} {figure:16} {mean['hardware'].mean():9.2f} {gain.mean():+9.2f}  "
                  f"{gain.mean() - half:+.2f} .. {gain.mean() + half:+.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path)
    parser.add_argument("clips", nargs="*", type=Path)
    parser.add_argument("--steps", type=int, default=300)
    parser.add_argument("--scenes", type=int, default=6, help="synthetic ones to compare on")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--methods", nargs="*", default=["fast"])
    options = parser.parse_args()
    options.out.mkdir()

    weights, delays = train(options.steps)
    schedule = st.project(weights, PERIOD, SENSOR, lengths=LENGTHS, delay_slots=delays, size=ARRAY)
    file, image = options.out / "learned.toml", options.out / "learned.mem"
    schedule.save(file)
    program = os.environ.get("STIPPLE", "stipple")
    subprocess.run([program, "schedule", "check", file, "--sensor", SENSOR], check=True)
    subprocess.run([program, "schedule", "compile", file, "-o", image], check=True)
    for name, plan in (("hardware_tiled", "hardware_tiled"), ("learned", schedule)):
        rate = stipple.timing(SENSOR, plan, size=ARRAY)
        print(f"{name}: {rate['speedup']:.2f} slots in the time of a full readout")

    clips = [options.out / f"scene{number}.npy" for number in range(options.scenes)]
    for number, clip in enumerate(clips):
        np.save(clip, scene(1000 + number))
    for name, some in (("scenes of the class", clips), ("other clips", options.clips)):
        if some:
            print(f"\n{name}")
            compare(image, options.out, some, options.seeds, options.methods)


if __name__ == "__main__":
    main()
