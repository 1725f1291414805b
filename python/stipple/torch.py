"""What PyTorch trains with: a differentiable chip, the codes that a sensor can run, and data sets as it has them.

    import stipple.torch

    chip = stipple.torch.CodedSensor("lux1310", period_slots=15)
    samples = chip(light, weights)                          # (batch, slots, rows, columns), soft codes
    schedule = stipple.torch.project(weights, 15, "lux1310")

Needs PyTorch (Debian: python3-torch)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _stipple
from ._dataset import Dataset as _Dataset
from ._dataset import TrainingItem
from ._forward_model import _module
from ._pipeline import EXPOSURE, Schedule
from ._stipple import Sensor

if TYPE_CHECKING:
    from os import PathLike

torch: Any = _module("torch", "PyTorch")

__all__ = ["CodedSensor", "Dataset", "Samples", "delayed", "legal_codes", "nearest_codes", "project", "weights_of"]

Name = Union[str, "PathLike[str]"]
Tensor = Any

#: Codes that legal_codes lists at most.
MAX_CODES = 100_000


class Samples(NamedTuple):
    """Of `CodedSensor`, shape (..., repetition, exposure, row, column)."""

    y: Tensor  #: light of the samples; 0 where there is none
    is_sample: Tensor  #: bool, without batch: exposures that lie in the window
    variance: Tensor  #: of y, of the light before noise


class CodedSensor(torch.nn.Module):  # type: ignore[misc]
    """A chip whose codes have gradients: light behind soft open weights, shot and read noise, full well, converter.

    sensor: a Sensor, the name of one, or the path of its file, whose pixels are equal, linear and independent.
    period_slots: slots after which the codes repeat.
    softness: width of the gradient around full well, full scale and DN 0, as a share of the full scale.

    Values have the distribution of the emulator's: Poisson, normal, clipped, rounded. Gradients are those of the mean
    and of the scale of the noise (reparameterisation); rounding has the gradient 1, clipping that of a soft limit, so
    saturated samples still pull.
    """

    def __init__(self, sensor: Union[Sensor, Name] = "paper", period_slots: int = 15, softness: float = 0.05) -> None:
        super().__init__()
        if period_slots < 1:
            raise ValueError(f"period_slots: {period_slots} is not above 0")
        if not softness > 0:
            raise ValueError(f"softness: {softness} is not above 0")
        self.period_slots = period_slots
        self._numbers = _stipple.plain_noise(sensor)
        self._softness = softness

    def forward(self, light: Tensor, weights: Tensor, generator: Any = None) -> Samples:
        """The samples of light (..., slot, row, column) from 0 on.

        weights: (exposure, slot, tile row, tile column), 0 to 1: the share of light that an exposure collects so many
            slots after the period began. The tile repeats over the array, the exposures every period. A sample is
            there if all slots in which it has weight lie in the window.
        generator: of the noise, a torch.Generator.
        """
        exposed = self.expose(light, weights)
        is_sample = self.is_sample(light.shape, weights)
        dark = self._numbers["dark_e_per_slot"] * _tiled(weights, light.shape).sum(1)
        y = self._light(self._levels(exposed, dark, generator), dark)
        return Samples(y * is_sample, is_sample, self.variance(exposed, dark) * is_sample)

    def expose(self, light: Tensor, weights: Tensor) -> Tensor:
        """The light of each sample before noise: A x."""
        parts = self._parts(light, weights.shape[1])
        return torch.einsum("...krcs,esrc->...kerc", parts, _tiled(weights, light.shape))

    def adjoint(self, y: Tensor, weights: Tensor, slots: int) -> Tensor:
        """A^T y: (..., slot, row, column) of so many slots."""
        spread = torch.einsum("...kerc,esrc->...ksrc", y, _tiled(weights, y.shape))
        before, after = self._padding(slots, weights.shape[1])
        light = y.new_zeros(*y.shape[:-4], before + slots + after, *y.shape[-2:])
        for number in range(y.shape[-4]):
            begin = number * self.period_slots
            light[..., begin:begin + weights.shape[1], :, :] += spread[..., number, :, :, :]
        return light[..., before:before + slots, :, :]

    def gain(self, shape: Sequence[int], weights: Tensor) -> Tensor:
        """A A^T, which is diagonal, of light of this shape: (exposure, row, column)."""
        return _tiled(weights, shape).square().sum(1)

    def is_sample(self, shape: Sequence[int], weights: Tensor) -> Tensor:
        """Which samples there are of light of this shape: (repetition, exposure, row, column)."""
        inside = self._parts(torch.ones(*shape[-3:], device=weights.device), weights.shape[1])
        open_slots = _tiled((weights.detach() > 0).float(), shape)
        seen = torch.einsum("krcs,esrc->kerc", inside, open_slots)
        return (seen == open_slots.sum(1)) & (seen > 0)

    def variance(self, exposed: Tensor, dark_e: Any = 0.0) -> Tensor:
        """Of samples of this light: shot noise, read noise and rounding, as the decoder has it."""
        n = self._numbers
        shot = exposed.clamp(min=0) * n["electrons_per_unit"] + dark_e if n["shot_noise"] else 0 * exposed
        return (shot + n["read_noise_e"] ** 2 + n["gain_e_per_dn"] ** 2 / 12) / n["electrons_per_unit"] ** 2

    def _padding(self, slots: int, span: int) -> Tuple[int, int]:
        """Slots before and after the window, so that all exposures are in whole repetitions."""
        before = (span - 1) // self.period_slots * self.period_slots
        repetitions = -(-(before + slots) // self.period_slots)
        return before, max((repetitions - 1) * self.period_slots + span - before - slots, 0)

    def _parts(self, light: Tensor, span: int) -> Tensor:
        """The light of the slots of each repetition, (..., repetition, row, column, slot)."""
        padded = torch.nn.functional.pad(light, (0, 0, 0, 0, *self._padding(light.shape[-3], span)))
        return padded.unfold(-3, span, self.period_slots)

    def _levels(self, exposed: Tensor, dark_e: Tensor, generator: Any) -> Tensor:
        """DN of samples of this light."""
        n, width = self._numbers, self._softness * self._numbers["max_dn"] * self._numbers["gain_e_per_dn"]
        electrons = exposed.clamp(min=0) * n["electrons_per_unit"] + dark_e
        if n["shot_noise"]:
            deviation = electrons.clamp(min=1).sqrt()
            photons = torch.poisson(electrons.detach(), generator=generator)
            electrons = electrons + deviation * ((photons - electrons) / deviation).detach()
        electrons = _at_most(electrons, n["full_well_e"], width)
        noise = torch.empty_like(electrons).normal_(generator=generator)
        level = (electrons + n["read_noise_e"] * noise) / n["gain_e_per_dn"] + n["black_level_dn"]
        width = self._softness * n["max_dn"]
        level = -_at_most(-_at_most(level, n["max_dn"], width), 0.0, width)
        return level + (torch.floor(level + (0 if n["floor"] else 0.5)) - level).detach()

    def _light(self, dn: Tensor, dark_e: Tensor) -> Tensor:
        """As the decoder has it: the middle of the levels that give a DN."""
        n = self._numbers
        electrons = (dn + (0.5 if n["floor"] else 0) - n["black_level_dn"]) * n["gain_e_per_dn"]
        return (electrons - dark_e) / n["electrons_per_unit"]


def _at_most(value: Tensor, limit: float, width: float) -> Tensor:
    """min(value, limit) with the gradient of a soft minimum."""
    soft = limit - width * torch.nn.functional.softplus((limit - value) / width)
    return soft + (value.clamp(max=limit) - soft).detach()


def _tiled(weights: Tensor, shape: Sequence[int]) -> Tensor:
    """The weights of each pixel of an array with these last two sides."""
    if weights.ndim != 4:
        raise ValueError(f"weights: {tuple(weights.shape)} is not (exposures, slots, rows, columns)")
    rows, cols = (torch.arange(side, device=weights.device) % tile
                  for side, tile in zip(shape[-2:], weights.shape[-2:]))
    return weights[:, :, rows][:, :, :, cols]


def weights_of(schedule: Schedule) -> Tensor:
    """The weights of a schedule, 0, 1 or its own: (exposure, slot, tile row, tile column), for CodedSensor with its
    period. A pixel with fewer exposures than another one has exposures without weight."""
    rows, grey = schedule.exposures(), schedule.weights()
    lists: dict[Tuple[int, int], List[Any]] = {}
    for row in rows:
        lists.setdefault((int(row["row"]), int(row["col"])), []).append(row)
    span = max(int(row["first_slot"]) + int(row["open_slots"]).bit_length() for row in rows)
    weights = torch.zeros(max(map(len, lists.values())), span, *schedule.tile)
    for (y, x), exposures in lists.items():
        for number, exposure in enumerate(exposures):
            for i in range(int(exposure["open_slots"]).bit_length()):
                if int(exposure["open_slots"]) >> i & 1:
                    slot = int(exposure["first_slot"]) + i
                    weights[number, slot, y, x] = float(grey[slot % schedule.period_slots, y, x])
    return weights


def delayed(weights: Tensor, period_slots: int, delay_slots: Tuple[int, int], repeats: Tuple[int, int]) -> Tensor:
    """The tile repeated so often down and to the right, each time `delay_slots` later than above and on the left,
    modulo the period. Columns that share a channel then have their readouts in different slots."""

    def later(row: int, col: int) -> int:
        return (row * delay_slots[0] + col * delay_slots[1]) % period_slots

    def tile(delay: int) -> Tensor:
        return torch.nn.functional.pad(weights, (0, 0, 0, 0, delay, period_slots - 1 - delay))

    rows = [torch.cat([tile(later(row, col)) for col in range(repeats[1])], dim=3) for row in range(repeats[0])]
    return torch.cat(rows, dim=2)


def _orders(lengths: Sequence[int], exposures: int, slots: int) -> List[Tuple[int, ...]]:
    """Orders of so many lengths that fill the slots."""
    if exposures == 0:
        return [()] if slots == 0 else []
    return [(length, *rest) for length in lengths if length <= slots
            for rest in _orders(lengths, exposures - 1, slots - length)]


def legal_codes(period_slots: int, lengths: Sequence[int], exposures: int) -> Tensor:
    """All codes of a pixel that exposes so many times in a period, without gaps, for these lengths in slots: an array
    (code, exposure, slot) of 0 and 1, with 2 x period_slots - 1 slots. An exposure begins in the first period.
    Raises ValueError if there are none or more than 100000."""
    lengths = sorted(set(lengths))
    if not lengths or not all(isinstance(length, int) and 1 <= length <= 64 for length in lengths):
        raise ValueError(f"lengths: {lengths} are not whole numbers of 1 to 64 slots")
    if period_slots < 1 or exposures < 1 or len(lengths) ** (exposures - 1) * period_slots > 100 * MAX_CODES:
        raise ValueError(f"exposures: {exposures} of {len(lengths)} lengths in {period_slots} slots are none, or too "
                         "many codes; give fewer lengths")
    begins = set()
    for order in _orders(lengths, exposures, period_slots):
        for offset in range(period_slots):
            ends = offset + np.cumsum(order)
            begins.add(tuple(sorted(int(end) % period_slots for end in ends)))
    if not 0 < len(begins) <= MAX_CODES:
        raise ValueError(f"lengths: {len(begins)} codes of {exposures} exposures of {lengths} slots fill a period of "
                         f"{period_slots}; between 1 and {MAX_CODES} are possible")
    first = np.array(sorted(begins))
    end = np.concatenate([first[:, 1:], first[:, :1] + period_slots], axis=1)
    slot = np.arange(2 * period_slots - 1)
    return torch.from_numpy(((first[..., None] <= slot) & (slot < end[..., None])).astype(np.float32))


def nearest_codes(weights: Tensor, codes: Tensor, period_slots: int) -> Tensor:
    """The number of the code (of legal_codes) of each tile pixel that is nearest to the weights in square distance,
    exposures in any cyclic order. All codes are open for the whole period, so it has the greatest inner product."""

    def circular(array: Tensor) -> Tensor:
        """(..., slot of the period)."""
        padded = torch.nn.functional.pad(array, (0, -array.shape[-1] % period_slots))
        return padded.unflatten(-1, (-1, period_slots)).sum(-2)

    soft, hard = circular(weights.detach().double().permute(2, 3, 0, 1)), circular(codes.double())
    turns = [torch.einsum("rcep,nep->rcn", soft.roll(turn, 2), hard) for turn in range(soft.shape[2])]
    return torch.stack(turns).amax(0).argmax(-1)


def project(
    weights: Tensor,
    period_slots: int,
    sensor: Union[Sensor, Name] = "paper",
    *,
    lengths: Sequence[int] = (1, 2, 4, 8),
    delay_slots: Optional[Tuple[int, int]] = None,
    size: Tuple[int, int] = (480, 640),
    name: str = "learned",
) -> Schedule:
    """The schedule nearest to soft weights that the sensor can run: exposures without gaps, of these lengths.

    weights: as CodedSensor has them; their number of exposures is that of each pixel in a period.
    delay_slots: how much later each repetition of the tile is than that above it and on its left (`delayed`). By
        default (0, d) with the smallest d from 0 on with which the sensor reads in time.
    size: (rows, columns) that the sensor reads.

    Raises ValueError if there are no such codes, or the sensor cannot read the tile in time.
    """
    if weights.ndim != 4 or not bool(torch.isfinite(weights).all()):
        raise ValueError(f"weights: {tuple(weights.shape)} is not (exposures, slots, rows, columns), or not finite")
    codes = legal_codes(period_slots, lengths, weights.shape[0])
    chosen = codes[nearest_codes(weights, codes, period_slots)].permute(2, 3, 0, 1)
    problem = None
    for delay in [(0, right) for right in range(period_slots)] if delay_slots is None else [delay_slots]:
        schedule = _schedule(chosen, period_slots, delay, size, name)
        problem = schedule.check(sensor)
        if problem is None:
            return schedule
    raise ValueError(f"weights: {problem}; give other lengths, fewer exposures, or longer slots")


def _schedule(codes: Tensor, period_slots: int, delay: Tuple[int, int], size: Tuple[int, int], name: str) -> Schedule:
    """Of hard weights (exposure, slot, row, column)."""
    tile = [period_slots // math.gcd(slots, period_slots) for slots in delay]
    codes = delayed(codes, period_slots, delay, (tile[0], tile[1]))
    first, length = codes.argmax(1).numpy() % period_slots, codes.sum(1).long().numpy()
    rows = [(row, col, begin, (1 << int(slots)) - 1) for (_, row, col), begin, slots in
            zip(np.ndindex(first.shape), first.ravel().tolist(), length.ravel())]
    return Schedule.from_exposures(np.array(rows, dtype=EXPOSURE), codes.shape[2:], period_slots, name=name, size=size)


class Dataset(torch.utils.data.Dataset):  # type: ignore[misc]
    """A stipple.Dataset of tensors: TrainingItem (measurement, mask, noise, truth), for a DataLoader."""

    def __init__(self, data: _Dataset) -> None:
        self.data = data

    def __len__(self) -> int:
        return len(self.data)

    def __getitem__(self, index: int) -> TrainingItem:
        return TrainingItem(*(torch.from_numpy(np.ascontiguousarray(array)) for array in self.data[index]))
