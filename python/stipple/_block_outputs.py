"""Where workers store the blocks of a decoded stream: each is complete or absent, and no block of another
decoding gets in."""

import importlib
import json
import os
import secrets
import shutil
from pathlib import Path
from typing import Any, Mapping, Protocol, Tuple

import numpy as np
import numpy.typing as npt

from . import _stipple

__all__ = ["BlockOutput", "block_output", "slots_of_block"]

Identity = Mapping[str, Any]


class BlockOutput(Protocol):
    """What is sent to the workers: a name, no open files."""

    def claimed(self) -> bool:
        """Whether the output is there. Raises ValueError if it holds something else, OSError if it cannot be made."""

    def claim(self) -> None:
        """Makes the output unless it is there: before the first block is written, so a refused call leaves nothing."""

    def holds(self, number: int) -> bool:
        """Whether a block is there, with all of its frames. Raises ValueError for one of another decoding."""

    def write(self, number: int, frames: npt.NDArray[np.float32]) -> None:
        """Stores a block; the last axis of colour is its plane."""


def block_output(name: str, identity: str) -> BlockOutput:
    """That of a name: an array of Zarr by the extension .zarr, else a folder of windows; `identity` is the JSON of
    docs/scaling.md."""
    if Path(name).suffix == ".zarr":
        return ZarrArray(name, identity)
    return WindowFolder(name, identity)


def slots_of_block(number: int, slots: int) -> Tuple[int, int]:
    """[begin, end) of a block of a stream with so many slots."""
    last = number + 1 == _stipple.decode_blocks(slots)
    return _stipple.block_begin(number), slots if last else _stipple.block_begin(number + 1)


def _shape(identity: Identity, slots: int) -> Tuple[int, ...]:
    planes = (identity["planes"],) if identity["planes"] > 1 else ()
    return (slots, identity["rows"], identity["cols"], *planes)


def _require_same(name: object, there: Any, here: Identity) -> None:
    for key, value in here.items():
        other = there.get(key) if isinstance(there, dict) else None
        if other != value:
            raise ValueError(f"{name}: holds another decoding: {key} is {json.dumps(other)} there and "
                             f"{json.dumps(value)} here; give another name, or remove it")


def _require_folder(folder: Path) -> None:
    if not folder.is_dir():
        raise FileNotFoundError(f"{folder}: there is no such folder; create it first")


class WindowFolder:
    """The folder that "stipple decode --part" fills; "stipple join" makes a video of it."""

    def __init__(self, folder: str, identity: str) -> None:
        self.folder = folder
        self.identity = identity

    def _shards(self) -> _stipple.VideoShards:
        _require_folder(Path(self.folder).parent)
        return _stipple.VideoShards(self.folder, self.identity)

    def claimed(self) -> bool:
        return self._shards().claimed()

    def claim(self) -> None:
        self._shards().claim()

    def holds(self, number: int) -> bool:
        return self._shards().holds(number)

    def write(self, number: int, frames: npt.NDArray[np.float32]) -> None:
        planes_first = frames if frames.ndim == 3 else np.moveaxis(frames, 3, 1)
        self._shards().write(number, np.ascontiguousarray(planes_first))


class ZarrArray:
    """An array of Zarr, a chunk for each block; its attribute "decoding" holds the identity."""

    def __init__(self, name: str, identity: str) -> None:
        self.name = name
        self.identity = json.loads(identity)

    def _open(self, mode: str, name: str = "") -> Any:
        zarr: Any = importlib.import_module("zarr")
        slots = self.identity["slots"]
        chunk = _shape(self.identity, self.identity["window_slots"])
        return zarr.open_array(name or self.name, mode=mode, shape=_shape(self.identity, slots), chunks=chunk,
                               dtype="<f4", write_empty_chunks=True)

    def claimed(self) -> bool:
        _require_folder(Path(self.name).parent)
        if not os.path.exists(self.name):
            return False
        _require_same(self.name, self._open("r").attrs.asdict().get("decoding"), self.identity)
        return True

    def claim(self) -> None:
        if self.claimed():
            return
        folder, name = os.path.split(self.name)
        partial = os.path.join(folder, f".{name}.{secrets.token_hex(4)}")
        self._open("w-", partial).attrs["decoding"] = self.identity
        try:
            os.rename(partial, self.name)
        except OSError:
            shutil.rmtree(partial)
            if not self.claimed():  # else another worker was first
                raise

    def holds(self, number: int) -> bool:
        if not os.path.exists(self.name):
            return False
        begin, end = slots_of_block(number, self.identity["slots"])
        window = self.identity["window_slots"]
        store, rest = self._open("r").store, ".0" * (len(_shape(self.identity, 0)) - 1)
        return all(f"{chunk}{rest}" in store for chunk in range(begin // window, -(-end // window)))

    def write(self, number: int, frames: npt.NDArray[np.float32]) -> None:
        begin, end = slots_of_block(number, self.identity["slots"])
        self._open("r+")[begin:end] = frames
