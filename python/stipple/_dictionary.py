"""Patches of footage that the method hitomi2011 knows."""

from os import PathLike
from typing import Callable, List, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _stipple
from ._pipeline import Video, _reading

__all__ = ["dictionary"]

Name = Union[str, "PathLike[str]"]
Tell = Optional[Callable[[float, Optional[int]], object]]


def dictionary(
    footage: Union[Video, List[Video]],
    output: Optional[Name] = None,
    *,
    slots: int = 8,
    side: int = 7,
    atoms: int = 512,
    sparsity: int = 8,
    iterations: int = 12,
    patches: int = 20000,
    seed: int = 1,
    force: bool = False,
    transfer: Optional[str] = None,
    luminance: bool = False,
    min_value: Optional[float] = None,
    raw: Optional[str] = None,
    threads: int = 0,
    progress: Tell = None,
) -> npt.NDArray[np.float32]:
    """Learns patches of footage by K-SVD for the method hitomi2011, as "stipple dictionary" does: an array (atom,
    slot, pixel) of patches of norm 1, the pixels row by row.

        stipple.dictionary(["street", "garden"], "patches.npy")
        stipple.decode(stream, "hitomi2011", {"dictionary": "patches.npy"})

    footage: a video as for `emulate`, or a list of them; not that to be decoded.
    output: a new .npy file with the array.
    slots: of a patch, the period of the schedule. 1..64.
    side: rows and columns of a patch. 2..32.
    atoms: number of patches, 2..16384.
    sparsity: max atoms of a patch, 1..64.
    iterations: of K-SVD, 1..1000.
    patches: max patches to learn from, 2..10^7.
    seed: of the choice of patches.
    force: replace a file that is there.
    transfer, luminance, min_value, raw: as for `emulate`.
    threads: 0 means all cores. The values do not depend on it.
    progress: as for `emulate`, of iterations.

    Raises ValueError for footage that is too short, too small or without contrast, OSError for files.
    """
    task = _stipple.DictionaryTask(
        {
            "slots": slots,
            "side": side,
            "atoms": atoms,
            "sparsity": sparsity,
            "iterations": iterations,
            "patches": patches,
            "seed": seed,
        },
        output,
        force,
    )
    clips: Sequence[Video] = footage if isinstance(footage, list) else [footage]
    with _stipple.Threads(threads):
        for clip in clips:
            reading = _reading(transfer, luminance, None, raw, min_value)
            task.add_clip(_stipple.Footage(clip, reading))
        return task.learn(progress)
