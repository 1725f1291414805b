"""EMVA 1288 figures of an emulated sensor, or of images."""

from os import PathLike
from typing import Any, Callable, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _stipple
from ._stipple import Sensor

__all__ = ["characterize", "characterize_images"]

Name = Union[str, "PathLike[str]"]
Tell = Optional[Callable[[float, Optional[int]], object]]
Stack = Tuple[float, float, npt.NDArray[Union[np.uint8, np.uint16]]]


def characterize(
    sensor: Union[Sensor, Name] = "paper", seed: int = 1, *, threads: int = 0, progress: Tell = None
) -> dict[str, Any]:
    """Figures of a sensor by EMVA 1288 (docs/characterize.md), from 302 flat-field images of 320 x 240 pixels
    that are emulated and not kept: the keys of "stipple characterize --json".

    sensor: a Sensor, the name of one, or the path of its file.
    seed: of the noise.
    threads: 0 means all cores. The figures do not depend on it.
    progress: as for `emulate`, with images for slots.

    "measured" and "configured" are dicts of the figures, as they are evaluated from the images and as they
    follow from the sensor's parameters: gain_dn_per_e, quantum_efficiency, dark_noise_e, saturation_e, dsnu_e
    and prnu (also of rows, columns and pixels, and without shading: dsnu_row_e, prnu_high_pass ...), snr_max,
    sensitivity_threshold_p (photons), dynamic_range, linearity_error. "photon_transfer" is an
    array (exposure, 3) of photons per pixel, mean in DN and temporal variance in DN^2, without those of dark
    images; "saturation_point" is its row of the largest variance. "dark_deviations" (DN) and
    "bright_deviations" (of the mean signal) are histograms of defects, with the keys of `characterize --json`.

    Raises ValueError for a sensor that cannot be evaluated. A black level that cuts the noise off is a
    UserWarning, and "biased" is True.
    """
    with _stipple.Threads(threads):
        return _stipple.characterize(sensor, seed, progress)


def characterize_images(
    images: Union[Name, Sequence[Stack]], bits: int = 16, *, progress: Tell = None
) -> dict[str, Any]:
    """The same figures, without "configured", of images that a camera has taken of a uniformly lit field.

    images: the path of a descriptor (emva1288_data.txt), or a list of (exposure_ns, photons, dn): exposure
        time in ns, mean photons per pixel (0: dark), and an array (image, row, col) of uint8 or uint16.
        Two images tell the temporal noise, more the spatial noise. Needed are ten bright pairs, dark pairs of
        their exposure times, a bright stack and a dark one.
    bits: of a DN of the arrays, 1 to 16; a descriptor says it itself.
    progress: as for `characterize`.
    """
    if isinstance(images, (str, PathLike)):
        return _stipple.characterize_files(images, progress)
    return _stipple.characterize_arrays(images, bits, progress)
