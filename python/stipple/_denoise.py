"""Functions of the user that decoders call: denoisers, refiners; and the denoiser of best."""

import inspect
import math
from typing import Any, Callable, Mapping, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _stipple
from ._stipple import DenoiserStep

Array = npt.NDArray[np.float32]
Denoiser = Callable[..., Any]
Refiner = Callable[[Array], Any]


def _planes_first(array: npt.NDArray[Any]) -> Array:
    """(slot, plane, row, col), C-contiguous."""
    planar = np.moveaxis(array, 3, 1) if array.ndim == 4 else array[:, np.newaxis]
    return np.ascontiguousarray(planar, dtype=np.float32)


def denoise(
    video: npt.ArrayLike,
    sigma: float,
    step: Optional[DenoiserStep] = None,
    *,
    passes: int = 8,
    threads: int = 0,
) -> Array:
    """A video without its noise, by the collaborative filter of the method best: patches that are similar, along
    motion too, are filtered together.

    video: (slot, row, col) or (slot, row, col, plane), frames of at least 6 x 6 pixels. Of colour the first
        plane is compared, which is the luma in plug_and_play.
    sigma: standard deviation of the noise, above 0, equal in all voxels and planes.
    step: of a call of plug_and_play. The filter then does one pass with the estimates, motion and groups of
        earlier iterations, as best does: decode(stream, "plug_and_play", denoiser=denoise) has the bits of
        decode(stream, "best").
    passes: without a step; each is guided by the result of the one before.
    threads: without a step; 0 means all cores. The values do not depend on it.

    Returns an array of float32 of the same shape. Raises ValueError.
    """
    array = np.asarray(video)
    if array.dtype.kind != "f":
        raise ValueError(f"video: has dtype {array.dtype}; give floating-point values")
    if array.ndim not in (3, 4) or array.size == 0:
        raise ValueError(f"video: has the shape {array.shape}; give (slot, row, col) or (slot, row, col, plane)")
    if not np.isfinite(array).all():
        raise ValueError("video: has values that are not finite")
    if not 0 < sigma < math.inf:
        raise ValueError(f"sigma: {sigma} is not above 0")
    if passes < 1:
        raise ValueError(f"passes: {passes} is not above 0")
    planar = _planes_first(array)
    if step is not None:
        return _stipple.denoise(planar, sigma, step, passes)
    with _stipple.Threads(threads):
        return _stipple.denoise(planar, sigma, step, passes)


def check_given(method: str, options: Mapping[str, object], denoiser: Optional[Denoiser]) -> None:
    """That plug_and_play has a denoiser, which can be called."""
    if denoiser is not None and not callable(denoiser):
        raise ValueError(f"denoiser: {denoiser!r} is not a function of (video, sigma)")
    if method == "plug_and_play" and denoiser is None and "denoiser" not in options:
        raise ValueError(
            'denoiser: plug_and_play needs one, a function of (video, sigma), or options={"denoiser": "net.onnx"}'
        )


def _takes_step(denoiser: Denoiser) -> bool:
    try:
        return "step" in inspect.signature(denoiser).parameters
    except (TypeError, ValueError):  # of what is compiled
        return False


def _checked(name: str, result: object, shape: Tuple[int, ...]) -> Array:
    """What a function of the user has given."""
    array = np.asarray(result)
    if array.dtype.kind != "f":
        what = type(result).__name__ if array.dtype == object else f"values of {array.dtype}"
        raise ValueError(f"{name}: gives {what}; give an array of floating-point values")
    if array.shape != shape:
        raise ValueError(f"{name}: gives the shape {array.shape}, not {shape}")
    return array


def as_called(denoiser: Denoiser) -> Denoiser:
    """The function as the decoder calls it, with its result checked."""
    takes_step = _takes_step(denoiser)

    def call(video: Array, sigma: float, step: DenoiserStep) -> Array:
        shape = video.shape
        result = denoiser(video, sigma, step=step) if takes_step else denoiser(video, sigma)
        return _planes_first(_checked("denoiser", result, shape))

    return call


def refiner_as_called(refiner: Refiner) -> Refiner:
    """The function as the decoder calls it, with its result checked."""
    if not callable(refiner):
        raise ValueError(f"refiner: {refiner!r} is not a function of (inputs)")

    def call(inputs: Array) -> Array:
        shape = inputs.shape[1:]
        return np.ascontiguousarray(_checked("refiner", refiner(inputs), shape), dtype=np.float32)

    return call
