"""Gain, offset, dark current, response curve and defects of a chip, measured."""

from os import PathLike, fsdecode
from typing import Any, Callable, Optional, Sequence, Tuple, Union

from . import _stipple
from ._stipple import Sensor, Stream

__all__ = ["calibrate"]

Name = Union[str, "PathLike[str]"]
Streams = Union[Stream, Name, Sequence[Union[Stream, Name]]]
Tell = Optional[Callable[[float, Optional[int]], object]]


def calibrate(
    output: Name,
    *,
    sensor: Optional[Union[Sensor, Name]] = None,
    size: Optional[Tuple[int, int]] = None,
    planes: int = 1,
    flats: int = 100,
    darks: int = 100,
    levels: Optional[int] = None,
    seed: int = 1,
    dark: Streams = (),
    flat: Streams = (),
    images: Optional[Name] = None,
    scene: Optional[Union[Stream, Name]] = None,
    method: str = "best",
    prnu: Optional[float] = None,
    dark_current: bool = True,
    force: bool = False,
    threads: int = 0,
    progress: Tell = None,
) -> dict[str, Any]:
    """Writes the calibration of a chip, as "stipple calibrate" does, for `decode` (docs/calibration.md).

        stipple.calibrate("t6.stcal", sensor="t6", size=(128, 128))
        stipple.calibrate("chip.stcal", dark="dark.stipple", flat=["dim.stipple", "bright.stipple"])
        stipple.decode("clip.stipple", calibration="chip.stcal")

    output: a new .stcal file.
    sensor: a Sensor, the name of one, or the path of its file, whose series is emulated. With it:
        size: (rows, columns) of its array.
        planes: 1 mono or mosaic, 3 stacked red, green and blue.
        flats: images of uniform light.
        darks: images without light, of each of two exposure times.
        levels: of light, for the response curve; by default 12 of a sensor with response_loss or inl_dn, else 0.
        seed: of the noise.
    dark, flat: streams of the chip without light, and in uniform, constant light: one or a list each.
    images: of a camera, the path of their descriptor (docs/characterize.md).
    scene: a stream of any scene that moves: gains only. With it:
        method: that decodes the stream.
        prnu: standard deviation of the gains, as 0.01 for 1 %; by default that of the sensor, which the stream tells.
    dark_current: False takes it for 0: one exposure time without light is enough.
    force: replace a file that is there.
    threads: 0 means all cores; the file does not depend on it.
    progress: as for `emulate`, with images for slots.

    Returns the keys of "stipple calibrate --json". Raises ValueError and OSError; warns of damage of a stream."""
    fields = _files(dark), _files(flat)
    _check_sources((sensor, images, scene), *fields)
    with _stipple.Threads(threads):
        task = _stipple.CalibrationTask(output, force, dark_current)
        if sensor is not None:
            if size is None:
                raise ValueError("size: (rows, columns) of the array are needed, as of the footage")
            numbers = {"size": size, "planes": planes, "flats": flats, "darks": darks, "levels": levels, "seed": seed}
            return task.of_sensor(sensor, numbers, progress)
        if images is not None:
            return task.of_images(images, progress)
        if scene is not None:
            return task.of_scene(fsdecode(scene), method, prnu, progress)
        return task.of_streams(*fields, progress)


def _files(streams: Streams) -> "list[str]":
    if isinstance(streams, (str, PathLike, Stream)):
        return [fsdecode(streams)]
    return [fsdecode(stream) for stream in streams]


def _check_sources(others: Sequence[object], dark: "list[str]", flat: "list[str]") -> None:
    """One source of samples."""
    if sum(other is not None for other in others) + bool(dark or flat) != 1:
        raise ValueError("sensor: one of sensor, images, scene, and dark with flat is needed")
    if bool(dark) != bool(flat):
        raise ValueError(f"{'flat' if dark else 'dark'}: streams without light and of uniform light are both needed")
