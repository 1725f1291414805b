"""Decodes a stream, or explores a space, on the workers of a Dask cluster, with the same bits as in one process::

    client = dask.distributed.Client("scheduler:8786")
    video = stipple.dask.decode("/shared/film.stipple", client, "fast")
    stipple.dask.decode_to("/shared/film.zarr", "/shared/film.stipple", client, "fast")
    rows = stipple.dask.explore("space.toml", "results", client)

Each worker needs this package, and the files under the same paths."""

import warnings
from os import PathLike, fsdecode, path
from typing import Any, List, Mapping, NamedTuple, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _stipple
from ._block_outputs import BlockOutput, block_output, slots_of_block
from ._explore import explore_on as explore
from ._stipple import Stream
from ._workers import Fingerprint, _fingerprint, check_workers, require_same

__all__ = ["check_workers", "decode", "decode_to", "explore", "require_same"]

Name = Union[str, "PathLike[str]"]
Source = Union[Stream, Name]


class _Job(NamedTuple):
    """What all blocks of a decoding have in common."""

    caller: Fingerprint
    stream: str
    slots: int
    method: str
    options: Mapping[str, object]
    fill_gaps: bool
    calibration: Optional[str]
    threads: int

    def task(self, until: int) -> _stipple.DecodeTask:
        task = _stipple.DecodeTask(self.method, self.options, self.fill_gaps, False, until)
        task.calibration = self.calibration
        return task

    def decode(self, number: int) -> Tuple[npt.NDArray[np.float32], List[str]]:
        """On a worker: the frames of a block, and what is to be said of its samples."""
        require_same(self.caller)
        task = self.task(slots_of_block(number, self.slots)[1])
        task.begin_at_block(number)
        with _stipple.Threads(self.threads), warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            frames = _stipple.decode(Stream.open(self.stream), task, None)
        return frames, [str(warning.message) for warning in said]

    def store(self, number: int, output: BlockOutput) -> Tuple[None, List[str]]:
        """On a worker: the same, stored there. What is there stays: a cluster repeats the tasks whose results a
        killed worker held."""
        if output.holds(number):
            return None, []
        frames, said = self.decode(number)
        output.claim()
        output.write(number, frames)
        return None, said


def _calibration_of(calibration: Optional[Name]) -> Optional[str]:
    """As the workers find it; None: the file beside the stream."""
    if calibration is None:
        return None
    return "none" if calibration == "none" else path.abspath(fsdecode(calibration))


def _job(client: Any, stream: Source, method: str, more: Mapping[str, Any]) -> _Job:
    caller = check_workers(client)
    name = path.abspath(fsdecode(stream))
    chip = _calibration_of(more["calibration"])
    slots = Stream.open(name).slots()
    if slots == 0:
        raise ValueError(f"{name}: holds no slot to decode")
    job = _Job(caller, name, slots, method, dict(more["options"]), more["fill_gaps"], chip, more["threads"])
    job.task(slots)  # raises for wrong options here, and not on a worker
    return job


def _gather(client: Any, tasks: List[Any]) -> List[Any]:
    """The results of tasks. What they say is a warning, once."""
    results, said = zip(*client.gather(tasks)) if tasks else ((), ())
    for text in dict.fromkeys(text for texts in said for text in texts):
        warnings.warn(text, UserWarning, stacklevel=3)
    return list(results)


def decode(
    stream: Source,
    client: Any,
    method: str = "best",
    options: Mapping[str, object] = {},
    *,
    fill_gaps: bool = False,
    calibration: Optional[Name] = None,
    threads: int = 1,
) -> npt.NDArray[np.float32]:
    """The video of a stream, as `stipple.decode` gives it; each block of 48 slots is a task of the cluster.

    stream: the path of a file, or a Stream of one. It holds its number of slots: it was written to its end.
    client: a dask.distributed.Client.
    method, options, fill_gaps, calibration: as for `stipple.decode`.
    threads: of each task; 0 means all cores of its worker.

    Raises as `check_workers`, and ValueError and OSError as `stipple.decode`.
    """
    more = {"options": options, "fill_gaps": fill_gaps, "calibration": calibration, "threads": threads}
    job = _job(client, stream, method, more)
    blocks = range(_stipple.decode_blocks(job.slots))
    tasks = [client.submit(_Job.decode, job, number, pure=False) for number in blocks]
    return np.concatenate(_gather(client, tasks))


def decode_to(
    output: Name,
    stream: Source,
    client: Any,
    method: str = "best",
    options: Mapping[str, object] = {},
    *,
    fill_gaps: bool = False,
    calibration: Optional[Name] = None,
    threads: int = 1,
) -> int:
    """The same, stored by the workers, for videos that are larger than a memory. Blocks that are there are
    kept, so the same call goes on after it was ended. Returns the number of blocks that were decoded.

    output: on storage that the caller and all workers see under this path. With the extension .zarr an array
        of Zarr (Debian: python3-zarr) of float32, shape (slot, row, col) or (slot, row, col, plane); else the
        folder of windows that "stipple decode --part" writes and "stipple join" reads.
    stream ... threads: as for `decode`.

    Raises as `decode`, ModuleNotFoundError without Zarr, and ValueError if the output holds something else.
    """
    more = {"options": options, "fill_gaps": fill_gaps, "calibration": calibration, "threads": threads}
    job = _job(client, stream, method, more)
    store = block_output(path.abspath(fsdecode(output)), _stipple.decoding_identity(job.stream, job.task(job.slots)))
    store.claimed()
    missing = [number for number in range(_stipple.decode_blocks(job.slots)) if not store.holds(number)]
    tasks = [client.submit(_Job.store, job, number, store, pure=False) for number in missing]
    _gather(client, tasks)
    return len(missing)
