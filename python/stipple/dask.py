"""Decodes a stream on the workers of a Dask cluster, with the same bits as in one process::

    client = dask.distributed.Client("scheduler:8786")
    video = stipple.dask.decode("/shared/film.stipple", client, "fast")

Each worker needs this package, and the stream under the same path."""

from os import PathLike, fsdecode, path
from typing import Any, Mapping, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _stipple
from ._stipple import Stream

__all__ = ["decode"]

Name = Union[str, "PathLike[str]"]


def decode(
    stream: Name,
    client: Any,
    method: str = "best",
    options: Mapping[str, object] = {},
    *,
    fill_gaps: bool = False,
    calibration: Optional[Name] = None,
    threads: int = 1,
) -> npt.NDArray[np.float32]:
    """The video of a stream, as `stipple.decode` gives it; each block of 48 slots is a task of the cluster.

    stream: the path of a file, which holds its number of slots: one that was written to its end.
    client: a dask.distributed.Client.
    method, options, fill_gaps, calibration: as for `stipple.decode`.
    threads: of each task; 0 means all cores of its worker.

    Raises TypeError if `client` takes no tasks, and ValueError and OSError as `stipple.decode`.
    """
    if not (hasattr(client, "submit") and hasattr(client, "gather")):
        raise TypeError(f"client is a {type(client).__name__}; give a dask.distributed.Client (Debian: "
                        "python3-distributed, else: pip install distributed)")
    name = path.abspath(fsdecode(stream))
    chip = None if calibration is None else path.abspath(fsdecode(calibration))
    slots = Stream.open(name).slots()
    tasks = [
        client.submit(_decode_block, name, number, slots, (method, dict(options), fill_gaps, chip, threads), pure=False)
        for number in range(_stipple.decode_blocks(slots))
    ]
    if not tasks:
        raise ValueError(f"{name}: holds no slot to decode")
    return np.concatenate(client.gather(tasks))


def _decode_block(name: str, number: int, slots: int, how: Any) -> npt.NDArray[np.float32]:
    """The frames of one block, on a worker."""
    method, options, fill_gaps, calibration, threads = how
    last = number + 1 == _stipple.decode_blocks(slots)
    until = slots if last else _stipple.block_begin(number + 1)
    task = _stipple.DecodeTask(method, options, fill_gaps, False, until)
    task.calibration = calibration
    task.begin_at_block(number)
    with _stipple.Threads(threads):
        return _stipple.decode(Stream.open(name), task, None)
