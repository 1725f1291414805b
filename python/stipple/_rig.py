"""Scenes that are rendered, and rigs of several sensors."""

from os import fsdecode
from typing import Any, Dict, Mapping, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _stipple
from ._pipeline import Name, Tell, Video, _reading

__all__ = ["emulate_rig", "synth"]


def synth(
    scene: str,
    *,
    frames: int = 48,
    size: Tuple[int, int] = (240, 320),
    seed: int = 1,
    luminance: bool = False,
    threads: int = 0,
    progress: Tell = None,
) -> npt.NDArray[np.float32]:
    """An embedded scene as an array of linear light, as "stipple synth" renders it (docs/scenes.md): (slot, row, col,
    plane), or (slot, row, col) with `luminance`. In memory it is as that of `decode`.

    scene: a name of "stipple list scenes".
    frames: their number, of 1/200 s each.
    size: (rows, columns), 8 to 4096 each.
    seed: of textures and arrangement.
    luminance: Rec. 709 luminance instead of colours.
    progress: as for `emulate`.
    """
    with _stipple.Threads(threads):
        return _stipple.synth(scene, _stipple.SceneOptions(frames, size, seed, luminance), progress)


def emulate_rig(
    video: Video,
    rig: Name,
    output: Name,
    settings: Mapping[str, object] = {},
    *,
    force: bool = False,
    transfer: Optional[str] = None,
    luminance: bool = False,
    max_value: Optional[float] = None,
    min_value: Optional[float] = None,
    raw: Optional[str] = None,
    scale: float = 1.0,
    resample: Optional[str] = None,
    frames_hz: Optional[float] = None,
    threads: int = 0,
    progress: Tell = None,
) -> Dict[str, Any]:
    """The sample streams that the sensors of a rig make of a video, as "stipple emulate --rig" does (docs/rig.md), in a
    folder that `decode` decodes to one video. Returns the figures: the keys of its option --json, without the speed.

    video, transfer, luminance, max_value, min_value, raw, scale, resample, frames_hz, progress: as for `emulate`.
    rig: the name of one, or the path of its file.
    output: a new folder.
    settings: keys of the rig, {"high.share": 0.9}.
    force: replace a folder that is there.
    """
    reading = _reading(transfer, luminance, max_value, raw, min_value, scale)
    reading.set_resampling(resample)
    reading.set_rate(frames_hz)
    footage = _stipple.Footage(video, reading)
    with _stipple.Threads(threads):
        return _stipple.emulate_rig(footage, (fsdecode(rig), settings), output, force, progress)
