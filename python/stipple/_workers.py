"""Whether other processes compute what this one would compute."""

import functools
import hashlib
from typing import Any, NamedTuple

import numpy as np

from . import _pipeline, _stipple

__all__ = ["Fingerprint", "check_workers", "require_same"]


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
