"""Data for training: what sensors measure of crops of footage."""

from __future__ import annotations

import math
import operator
import os
import shutil
from typing import TYPE_CHECKING, Any, Iterable, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _stipple
from ._forward_model import ForwardModel, _module
from ._pipeline import load
from ._stipple import Sensor

if TYPE_CHECKING:
    from os import PathLike

__all__ = ["Dataset", "TrainingItem", "dataset"]

Name = Union[str, "PathLike[str]"]
Array = npt.NDArray[np.float32]
Range = Union[float, Tuple[float, float]]

#: Share of the speed of a shaking camera that it keeps from slot to slot.
INERTIA = 0.9


class TrainingItem(NamedTuple):
    """Arrays (slot, row, col), or of colour (slot, row, col, plane). They are those of the ForwardModel of a stream
    of `truth`."""

    measurement: Array  #: light of each exposure, in its last slot; 0 elsewhere (ForwardModel.y)
    mask: npt.NDArray[np.uint8]  #: bits: 1 open, 2 first and 4 last slot, 8 saturated, 16 store B, 64 DN 0
    noise: Array  #: variance of each sample, in its last slot; 0 elsewhere (ForwardModel.variance)
    truth: Array  #: light


class Augmentation(NamedTuple):
    """How items differ from the footage: [min, max] of each, equally likely in logarithm but for shake."""

    speed: Tuple[float, float]
    light: Tuple[float, float]
    contrast: Tuple[float, float]
    shake: float


class Dataset:
    """Items by index, as PyTorch calls a map-style data set; `dataset` makes one.

    len(data) is clips x sensors x schedules x seeds; the clip changes first with the index, then the sensor, the
    schedule and the seed. An item depends on its index only, in any process and order.
    """

    def __init__(
        self,
        clips: Sequence[Array],
        chips: Sequence[Tuple[object, object]],
        size: Tuple[int, int, int],
        seeds: Sequence[int],
        augmentation: Augmentation,
    ) -> None:
        """clips: (frame, row, col) or (frame, plane, row, col); chips: sensors and their schedules; size: (slots,
        rows, columns)."""
        self._clips, self._chips, self._size, self._seeds = clips, chips, size, seeds
        self._augmentation = augmentation
        planes = clips[0].shape[1] if clips[0].ndim == 4 else 1
        self._made = [_stipple.TrainingChip(*chip, *size[1:], planes) for chip in chips]

    def __reduce__(self) -> Tuple[Any, ...]:
        return Dataset, (self._clips, self._chips, self._size, self._seeds, self._augmentation)

    def __len__(self) -> int:
        return len(self._clips) * len(self._chips) * len(self._seeds)

    def __getitem__(self, index: int) -> TrainingItem:
        """The item of an index, also from the end. Raises IndexError for one that there is not."""
        truth, model = self._item(index)
        y, mask, noise = model.samples(), model.states(), model.variances()
        if model.planes() > 1:
            y, mask, noise = (np.moveaxis(y, -3, -1), np.moveaxis(mask, -3, -1), np.moveaxis(noise, -3, -1))
        return TrainingItem(y, mask, noise, truth)

    def model(self, index: int) -> ForwardModel:
        """The forward model with the samples, bounds and variances of an item."""
        return ForwardModel._of(self._item(index)[1])

    def _item(self, index: int) -> Tuple[Array, _stipple.ForwardModel]:
        number = operator.index(index) + (len(self) if index < 0 else 0)
        if not 0 <= number < len(self):
            raise IndexError(f"index: {index} is outside 0..{len(self) - 1}")
        rest, clip = divmod(number, len(self._clips))
        turn, chip = divmod(rest, len(self._chips))
        seed = self._seeds[turn]
        return self._made[chip].item(self._clips[clip], self._crop(clip, seed), seed)

    def _crop(self, clip: int, seed: int) -> _stipple.MovingCrop:
        """Of a clip with a seed, the same for all sensors and schedules."""
        random = np.random.Generator(np.random.Philox(key=[seed, clip]))
        slots, rows, cols = self._size
        shape = self._clips[clip].shape

        def between(ends: Tuple[float, float]) -> float:
            return float(ends[0] * (ends[1] / ends[0]) ** random.uniform()) if ends[0] < ends[1] else ends[0]

        speed = between(self._augmentation.speed)
        last = shape[0] - slots * speed
        first = random.integers(0, max(int(last), 0) + 1)

        def track(length: int, whole: int) -> List[float]:
            at = random.integers(0, whole - length + 1)
            way = at + self._augmentation.shake * _shaking(random, slots)
            return [float(place) for place in np.clip(way, 0, whole - length)]

        top, left = track(rows, shape[-2]), track(cols, shape[-1])
        factor, power = between(self._augmentation.light), between(self._augmentation.contrast)
        return _stipple.MovingCrop(float(first), speed, top, left, factor, power)

    def to_zarr(self, path: Name, indices: Optional[Iterable[int]] = None) -> None:
        """Writes the items of the indices, by default all, as a Zarr group of the arrays measurement, mask, noise
        and truth, an item a chunk (Debian: python3-zarr). Raises OSError if `path` is there."""
        chosen = list(range(len(self)) if indices is None else indices)
        zarr = _module("zarr", "Zarr")
        if os.path.exists(path):
            raise FileExistsError(f"{os.fspath(path)}: is there already; give another name")
        partial = f"{os.fspath(path)}.partial"
        try:
            group = zarr.open_group(partial, mode="w-")
            for place, index in enumerate(chosen):
                for name, array in self[index]._asdict().items():
                    if place == 0:
                        group.create_dataset(name, shape=(len(chosen), *array.shape), chunks=(1, *array.shape),
                                             dtype=array.dtype)
                    group[name][place] = array
            os.rename(partial, path)
        except BaseException:
            shutil.rmtree(partial, ignore_errors=True)
            raise


def _shaking(random: np.random.Generator, slots: int) -> npt.NDArray[np.float64]:
    """A smooth random way of unit mean square step, 0 in the middle slot."""
    steps = random.normal(size=slots)
    for i in range(1, slots):
        steps[i] = INERTIA * steps[i - 1] + math.sqrt(1 - INERTIA**2) * steps[i]
    way = np.cumsum(steps)
    return np.asarray(way - way[slots // 2])


def _listed(value: Any, name: str) -> List[Any]:
    values = list(value) if isinstance(value, (list, tuple)) else [value]
    if not values:
        raise ValueError(f"{name}: give at least one")
    return values


def _ends(value: Range, name: str) -> Tuple[float, float]:
    """[min, max] of a number or of two."""
    ends = value if isinstance(value, (list, tuple)) else (value, value)
    if len(ends) != 2 or not all(isinstance(end, (int, float)) for end in ends) or not (
        0 < ends[0] <= ends[1] < math.inf
    ):
        raise ValueError(f"{name}: {value} is not a number above 0, or (min, max) of such")
    return float(ends[0]), float(ends[1])


def _whole(values: Any, name: str, least: int) -> List[int]:
    try:
        numbers = [operator.index(value) for value in values]
    except TypeError:
        numbers = []
    if not numbers or any(not least <= number < 2**63 for number in numbers):
        raise ValueError(f"{name}: {values} are not whole numbers from {least} on")
    return numbers


def _planar(clip: Array) -> Array:
    """Planes one after the other: (frame, plane, row, col)."""
    return np.ascontiguousarray(np.moveaxis(clip, -1, -3) if clip.ndim == 4 else clip)


def _check_clips(clips: Sequence[Array], names: Sequence[Any], size: Tuple[int, int, int], speed: float) -> None:
    slots, rows, cols = size
    frames = slots * speed
    for number, (clip, name) in enumerate(zip(clips, names)):
        where = f"clip {number}" if isinstance(name, np.ndarray) else str(name)
        if clip.ndim != clips[0].ndim:
            raise ValueError(f"{where}: has other planes than the first clip; give luminance=True")
        if clip.shape[-2] < rows or clip.shape[-1] < cols:
            raise ValueError(f"{where}: has frames of {clip.shape[-1]} x {clip.shape[-2]} pixels; a crop needs "
                             f"{cols} x {rows}")
        if clip.shape[0] < frames:
            raise ValueError(f"{where}: has {clip.shape[0]} frames; {slots} slots"
                             f"{f' at a speed of {speed:g}' if speed != 1 else ''} need {math.ceil(frames)}")


def dataset(
    footage: Union[Name, npt.ArrayLike, Sequence[Union[Name, npt.ArrayLike]]],
    sensors: Union[Sensor, Name, Sequence[Union[Sensor, Name]]] = "paper",
    schedules: Union[_stipple.Schedule, Name, Sequence[Union[_stipple.Schedule, Name]]] = "tiled",
    crop: Tuple[int, int] = (64, 64),
    slots: int = 32,
    seeds: Union[int, Sequence[int]] = 1000,
    *,
    speed: Range = 1.0,
    shake: float = 0.0,
    light: Range = 1.0,
    contrast: Range = 1.0,
    transfer: Optional[str] = None,
    luminance: bool = False,
    scale: float = 1.0,
) -> Dataset:
    """Random crops of footage with the samples that sensors take of them, for training. The samples are those of
    `emulate`, bit by bit.

    footage: a video as for `emulate`, an array or a path, or a list of them; all lie in memory.
    sensors, schedules: as for `emulate`, or lists of them; all pairs are used. A schedule of a name has the seed 1.
    crop: (rows, columns) of an item.
    slots: of an item, at most 128. The array is reset before the first one, so exposures that an end cuts have no
        sample.
    seeds: of place, augmentation and noise: whole numbers, or their number n for 1 .. n.
    speed: frames of the footage in a slot, whose mean light the slot has: a number or (min, max).
    shake: standard deviation of the motion of the camera between two slots, in pixels. The motion is smooth, and
        bilinear between pixels.
    light: factor of the light: a number or (min, max).
    contrast: power of the light, before the factor; 2 doubles the stops: a number or (min, max).
    transfer, luminance, scale: of the footage, as for `load`.

    Raises ValueError for what is wrong, and for clips that are too small or too short; OSError for files.
    """
    videos = _listed(footage, "footage")
    size = _whole([slots, *(crop if isinstance(crop, (tuple, list)) else [])], "slots, crop", 1)
    if len(size) != 3 or size[0] > 128:
        raise ValueError(f"crop, slots: {crop} are not (rows, columns), or {slots} slots are more than 128")
    if isinstance(seeds, int) and seeds < 1:
        raise ValueError(f"seeds: {seeds} is below 1")
    numbers = _whole(range(1, seeds + 1) if isinstance(seeds, int) else seeds, "seeds", 0)
    if not (isinstance(shake, (int, float)) and 0 <= shake < math.inf):
        raise ValueError(f"shake: {shake} is not a number of pixels from 0 on")
    augmentation = Augmentation(_ends(speed, "speed"), _ends(light, "light"), _ends(contrast, "contrast"), float(shake))
    chips = [(s, plan) for plan in _listed(schedules, "schedules") for s in _listed(sensors, "sensors")]
    clips = []
    for number, video in enumerate(videos):
        try:
            clips.append(_planar(load(video, transfer=transfer, luminance=luminance, scale=scale)))
        except ValueError as error:
            raise ValueError(str(error).replace("video:", f"clip {number}:", 1)) from None
    window = (size[0], size[1], size[2])
    _check_clips(clips, videos, window, augmentation.speed[1])
    return Dataset(clips, chips, window, numbers, augmentation)
