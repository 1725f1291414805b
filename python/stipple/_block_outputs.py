"""Where workers store the blocks of a decoded stream: each is complete or absent, and no block of another
decoding gets in."""

import importlib
import json
import os
import secrets
from pathlib import Path
from typing import Any, Mapping, Protocol, Tuple

import numpy as np
import numpy.typing as npt

from . import _stipple

__all__ = ["BlockOutput", "block_output", "slots_of_block"]

IDENTITY = "decoding.json"
Identity = Mapping[str, Any]


class BlockOutput(Protocol):
    """What is sent to the workers: a name, no open files."""

    def claim(self) -> None:
        """Makes the output unless it is there. Raises ValueError if it holds something else."""

    def holds(self, number: int) -> bool:
        """Whether a block is there, with all of its frames. Raises ValueError for one of another decoding."""

    def write(self, number: int, frames: npt.NDArray[np.float32]) -> None:
        """Stores a block; the last axis of colour is its plane."""


def block_output(name: str, identity: Identity) -> BlockOutput:
    """That of a name: an array of Zarr by the extension .zarr, else a folder of windows."""
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


class WindowFolder:
    """The folder that "stipple decode --part" fills; "stipple join" makes a video of it."""

    def __init__(self, folder: str, identity: Identity) -> None:
        self.folder = Path(folder)
        self.identity = dict(identity)

    def claim(self) -> None:
        self.folder.mkdir(exist_ok=True)
        for path in self.folder.iterdir():
            if path.is_symlink():
                raise ValueError(f"{path}: is a link, which is neither followed nor replaced in a folder that this program "
                                 "fills; remove it")
        file = self.folder / IDENTITY
        if not file.exists():
            for path in self.folder.iterdir():
                if not path.name.startswith(".") and path.name != IDENTITY:
                    raise ValueError(f"{self.folder}: holds {path.name}, and is no folder of windows; "
                                     "give another name")
            text = json.dumps(self.identity, indent=2) + "\n"
            self._put(file, lambda stream: stream.write(text.encode()))
        try:
            there = json.loads(file.read_text(encoding="utf-8"))
        except ValueError:
            there = None
        _require_same(self.folder, there, self.identity)

    def window(self, number: int) -> Path:
        return self.folder / f"window_{number:06d}.npy"

    def _header(self, number: int) -> bytes:
        """It names the decoding, so that no window of another one is taken for one of this."""
        begin, end = slots_of_block(number, self.identity["slots"])
        rows, cols, planes = (self.identity[key] for key in ("rows", "cols", "planes"))
        return _stipple.window_header(number, (end - begin, rows, cols, planes), (self.folder / IDENTITY).read_bytes())

    def holds(self, number: int) -> bool:
        file, header = self.window(number), self._header(number)
        try:
            np.load(file, mmap_mode="r")
        except (FileNotFoundError, ValueError, EOFError):
            return False  # absent, or cut off by a power failure
        with open(file, "rb") as stream:
            if stream.read(len(header)) != header:
                raise ValueError(f"{file}: is not this window of the decoding that {IDENTITY} describes: it was copied "
                                 "from elsewhere, or an earlier version wrote it; remove it")
        return True

    def write(self, number: int, frames: npt.NDArray[np.float32]) -> None:
        content = self._header(number) + np.ascontiguousarray(frames).tobytes()
        self._put(self.window(number), lambda stream: stream.write(content))
        for left in self.folder.glob(f".window_{number:06d}.*.partial.npy"):
            left.unlink(missing_ok=True)  # of workers that were killed

    def _put(self, file: Path, write: Any) -> None:
        """The file gets its name when it is on the disk; the hidden name is that of the program's."""
        partial = self.folder / f".{file.stem}.{os.getpid()}-{secrets.token_hex(4)}.partial{file.suffix}"
        with open(partial, "xb") as stream:
            write(stream)
            stream.flush()
            os.fsync(stream.fileno())
        try:
            os.replace(partial, file)
        except FileNotFoundError:
            if not file.exists():  # else a second worker of the same block was first
                raise


class ZarrArray:
    """An array of Zarr, a chunk for each block; its attribute "decoding" holds the identity."""

    def __init__(self, name: str, identity: Identity) -> None:
        self.name = name
        self.identity = dict(identity)

    def _open(self, mode: str) -> Any:
        zarr: Any = importlib.import_module("zarr")
        slots = self.identity["slots"]
        chunk = _shape(self.identity, self.identity["window_slots"])
        return zarr.open_array(self.name, mode=mode, shape=_shape(self.identity, slots), chunks=chunk,
                               dtype="<f4", write_empty_chunks=True)

    def claim(self) -> None:
        if not os.path.exists(self.name):
            self._open("w-").attrs["decoding"] = self.identity
        _require_same(self.name, self._open("r").attrs.asdict().get("decoding"), self.identity)

    def holds(self, number: int) -> bool:
        begin, end = slots_of_block(number, self.identity["slots"])
        window = self.identity["window_slots"]
        store, rest = self._open("r").store, ".0" * (len(_shape(self.identity, 0)) - 1)
        return all(f"{chunk}{rest}" in store for chunk in range(begin // window, -(-end // window)))

    def write(self, number: int, frames: npt.NDArray[np.float32]) -> None:
        begin, end = slots_of_block(number, self.identity["slots"])
        self._open("r+")[begin:end] = frames
