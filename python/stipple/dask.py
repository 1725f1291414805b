"""Decodes a stream on the workers of a Dask cluster, with the same bits as in one process::

    client = dask.distributed.Client("scheduler:8786")
    video = stipple.dask.decode("/shared/film.stipple", client, "fast")

Each worker needs this package, and the stream under the same path."""

import functools
import hashlib
from os import PathLike, fsdecode, path
from typing import Any, Mapping, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _pipeline, _stipple
from ._stipple import Stream

__all__ = ["check_workers", "decode"]

Name = Union[str, "PathLike[str]"]


class Fingerprint(NamedTuple):
    """Of a process: equal where Stipple gives the same bits."""

    version: str
    decode_sha256: str  #: of a small clip through chip and decoder


@functools.lru_cache(maxsize=None)
def _fingerprint() -> Fingerprint:
    slot, row, col = np.indices((24, 16, 16))
    light = ((3 * slot + 5 * row + 7 * col) % 17 / 16).astype(np.float32)
    video = _pipeline.decode(_pipeline.emulate(light, "paper", "tiled", threads=1), "fast", threads=1)
    digest = hashlib.sha256(np.ascontiguousarray(video).tobytes()).hexdigest()
    return Fingerprint(_stipple.__version__, digest)


def _difference(there: Any, here: Fingerprint) -> str:
    """What a process of this fingerprint, or of an exception, has else; empty where nothing."""
    if isinstance(there, BaseException):
        return f"cannot run Stipple ({there!r}); install the package of this process, version {here.version}"
    if there[0] != here.version:
        return f"has Stipple {there[0]}, this process {here.version}; install the same version"
    if there[1] != here.decode_sha256:
        return "decodes a small clip to other bits than this process; install the same build of Stipple"
    return ""


def check_workers(client: Any) -> Fingerprint:
    """Raises RuntimeError that names the first worker of a dask.distributed.Client with another version of
    Stipple, or with another hash of a small clip that is emulated and decoded; TypeError if `client` is none.
    Workers that come later are not asked: pass the result to the tasks, which call `require_same`.
    """
    if not all(hasattr(client, name) for name in ("submit", "gather", "run")):
        raise TypeError(f"client is a {type(client).__name__}; give a dask.distributed.Client (Debian: "
                        "python3-distributed, else: pip install distributed)")
    here = _fingerprint()
    for worker, there in sorted(client.run(_fingerprint, on_error="return").items()):
        difference = _difference(there, here)
        if difference:
            raise RuntimeError(f"worker {worker} {difference}")
    return here


def require_same(caller: Fingerprint) -> None:
    """For tasks: raises RuntimeError if this worker differs from the process that sent them."""
    difference = _difference(_fingerprint(), caller)
    if difference:
        raise RuntimeError(f"a worker {difference}")


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

    Raises as `check_workers`, and ValueError and OSError as `stipple.decode`.
    """
    caller = check_workers(client)
    name = path.abspath(fsdecode(stream))
    chip = None if calibration is None else path.abspath(fsdecode(calibration))
    slots = Stream.open(name).slots()
    how = (method, dict(options), fill_gaps, chip, threads)
    tasks = [
        client.submit(_decode_block, caller, name, number, slots, how, pure=False)
        for number in range(_stipple.decode_blocks(slots))
    ]
    if not tasks:
        raise ValueError(f"{name}: holds no slot to decode")
    return np.concatenate(client.gather(tasks))


def _decode_block(caller: Fingerprint, name: str, number: int, slots: int, how: Any) -> npt.NDArray[np.float32]:
    """The frames of one block, on a worker."""
    require_same(caller)
    method, options, fill_gaps, calibration, threads = how
    last = number + 1 == _stipple.decode_blocks(slots)
    until = slots if last else _stipple.block_begin(number + 1)
    task = _stipple.DecodeTask(method, options, fill_gaps, False, until)
    task.calibration = calibration
    task.begin_at_block(number)
    with _stipple.Threads(threads):
        return _stipple.decode(Stream.open(name), task, None)
