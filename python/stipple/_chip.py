"""An emulated chip that is driven through its registers."""

from os import PathLike
from pathlib import Path
from typing import Optional, Tuple, Union

import numpy.typing as npt

from . import _stipple
from ._pipeline import _reading
from ._stipple import ChipLight, ChipMemory, RegisterChip, Sensor

__all__ = ["Chip"]

Name = Union[str, "PathLike[str]"]


class Chip:
    """An emulated chip behind its registers (docs/chip.md), as "stipple chip" has it.

    video: the light, as of `emulate`. Each capture begins with its first frame, and after the last one it begins again.
    output: the stream of the first capture; the next ones are NAME-2, NAME-3 and so on.
    sensor: one with a timing; with schedule, seed and overrun as of `emulate`. They set the registers and bank 0.
    blank: begin as after a reset instead.
    tile: (rows, columns) of the schedule memory; depth: slots of a bank; pixel_bits. By default those of the schedule.

    A register is a name of docs/chip_registers.md, such as "STATUS" or "BANK_PERIOD[1]", or an address. An access that is
    an error raises ValueError; a command that is refused is a UserWarning. The end of the `with` block, or `finish`, ends
    a capture as STOP does."""

    def __init__(
        self,
        video: Union[Name, npt.ArrayLike],
        output: Name,
        sensor: Union[Sensor, Name] = "lux1310",
        schedule: Union[_stipple.Schedule, Name] = "random",
        seed: int = 1,
        *,
        force: bool = False,
        overrun: str = "stretch",
        blank: bool = False,
        tile: Optional[Tuple[int, int]] = None,
        depth: Optional[int] = None,
        pixel_bits: Optional[int] = None,
    ) -> None:
        light = ChipLight(video, _reading(None, False, None, None, None, 1.0))
        memory = ChipMemory(tile, depth, pixel_bits)
        self._chip = RegisterChip(light, sensor, (schedule, seed, overrun), memory, (output, force))
        if not blank:
            self._chip.preset()

    def read(self, register: Union[str, int]) -> int:
        """The value of a register, in 2 clocks."""
        return self._chip.read(register)

    def write(self, register: Union[str, int], value: int) -> None:
        """Writes a register, in 2 clocks."""
        self._chip.write(register, value)

    def wait(self, clocks: int) -> None:
        """Lets clocks pass."""
        self._chip.wait(clocks)

    def finish(self) -> None:
        """Ends a capture that runs, as STOP does."""
        self._chip.finish()

    @property
    def clocks(self) -> int:
        """Since the reset."""
        return self._chip.clocks

    @property
    def outputs(self) -> "list[Path]":
        """The streams of the captures so far."""
        return [Path(name) for name in self._chip.outputs]

    def __enter__(self) -> "Chip":
        return self

    def __exit__(self, *exception: object) -> None:
        self.finish()
