"""Measurements and masks of other people's code: streams to arrays, and arrays to streams."""

from os import PathLike
from typing import Any, Callable, Dict, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _stipple
from ._stipple import Stream

__all__ = ["export", "import_measurements"]

Name = Union[str, "PathLike[str]"]
Tell = Optional[Callable[[float, Optional[int]], object]]


def export(
    stream: Union[Stream, Name],
    output: Optional[Name] = None,
    *,
    masks: str = "shared",
    slots: Optional[range] = None,
    calibration: Optional[Name] = None,
    force: bool = False,
    progress: Tell = None,
) -> Dict[str, npt.NDArray[Any]]:
    """The samples of a stream as code for snapshot compressive imaging takes them, as "stipple export" does: a dict
    of arrays, of which docs/outputs.md tells names, shapes and units.

        clip = stipple.export(stream)
        meas[m] == (mask * video[m * B : (m + 1) * B]).sum(axis=0), but for noise and rounding

    stream: a Stream, or the path of one; of one plane, which may be a colour mosaic.
    output: a new .npz or .mat that holds them, for numpy.load and scipy.io.loadmat.
    masks: "shared": mask (slots, rows, columns) is that of every measurement; for schedules with one exposure of a
        pixel in each period. "own": mask (measurements, slots, rows, columns), for all schedules; measurements are
        the exposures of a pixel within the slots.
    slots: range(first, end) of the stream; None: all, of shared masks whole periods.
    calibration: as for `decode`.
    force: replace a file that is there.
    progress: as for `emulate`.

    Raises ValueError with the reason where the stream cannot be expressed so, OSError for files.
    """
    task = _stipple.ExportTask(masks, slots, calibration)
    source = stream if isinstance(stream, Stream) else Stream.open(stream)
    return _stipple.export_arrays(source, task, output, force, progress)


def _numbers(value: npt.ArrayLike, argument: str) -> npt.NDArray[Any]:
    array = np.asarray(value)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{argument}: {array.dtype} are no real numbers")
    if isinstance(value, np.ma.MaskedArray):
        raise ValueError(f"{argument}: may have masked values; give {argument}.filled(0)")
    return array


def import_measurements(
    measurements: Union[Name, npt.ArrayLike],
    masks: Union[Name, npt.ArrayLike, None] = None,
    *,
    output: Optional[Name] = None,
    force: bool = False,
    slots: Optional[int] = None,
    light: Optional[float] = None,
    white: Optional[float] = None,
    electrons: Optional[float] = 1000,
    read_noise: float = 0,
    saturation: Optional[float] = None,
    cfa: str = "none",
    slot_us: float = 5000,
    variable: str = "meas",
    mask_variable: str = "mask",
) -> Stream:
    """A stream of the measurements of a coded aperture or micromirror camera, as "stipple import" makes it
    (docs/schedules.md), for `decode`.

    measurements: array (measurements, rows, columns) or (rows, columns), or the path of a .npy, .npz or .mat.
    masks: array (slots, rows, columns), or a path; None: in the .npz or .mat of the measurements. Both are arrays
        or both are paths.
    output: a new .stipple file; without it the stream is temporary, as of `emulate`.
    force: replace a file that is there.
    slots: of a measurement, the first masks; None: all.
    light: measurement of light 1.0 in one slot of weight 1; None: 255 if some light would be above 1.0, else 1.
    white: value of the masks that is weight 1; None: 255 or 65535 of whole numbers above 1, else 1.
    electrons: photo-electrons of light 1.0 in one slot of weight 1; None: the measurements have no noise.
    read_noise: in electrons.
    saturation: measurements from this value on are clipped; None: none is.
    cfa: colour filter array, "none", "rggb", "grbg", "gbrg" or "bggr".
    slot_us: length of a slot in microseconds.
    variable, mask_variable: names in a .npz or .mat.

    Raises ValueError, or OSError for files. Pixels whose masks are 0 are a UserWarning.
    """
    numbers = {
        "light": light,
        "white": white,
        "electrons": electrons,
        "read_noise": read_noise,
        "saturation": saturation,
        "slot_us": slot_us,
    }
    if slots is not None and not 1 <= slots <= 65535:
        raise ValueError(f"slots: {slots} is outside 1..65535")
    arrays = _stipple.MeasuredArrays(numbers, cfa)
    mixed = TypeError("masks: give arrays for both measurements and masks, or paths for both")
    if isinstance(measurements, (str, PathLike)):
        if not isinstance(masks, (str, PathLike, type(None))):
            raise mixed
        arrays = arrays.of_files(measurements, masks, (variable, mask_variable), slots or 0)
    else:
        if masks is None or isinstance(masks, (str, PathLike)):
            raise mixed
        arrays = arrays.of_arrays(
            _numbers(measurements, "measurements"), _numbers(masks, "masks"), slots or 0
        )
    return _stipple.import_measurements(arrays, output, force)
