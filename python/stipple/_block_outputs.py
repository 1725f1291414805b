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

IDENTITY = "decoding.json"
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


def _require_folder(folder: Path) -> None:
    if not folder.is_dir():
        raise FileNotFoundError(f"{folder}: there is no such folder; create it first")


class WindowFolder:
    """The folder that "stipple decode --part" fills; "stipple join" makes a video of it."""

    def __init__(self, folder: str, identity: Identity) -> None:
        self.folder = Path(folder)
        self.identity = dict(identity)

    def claimed(self) -> bool:
        _require_folder(self.folder.parent)
        if not self.folder.exists():
            return False
        for path in self.folder.iterdir():
            if path.is_symlink():
                raise ValueError(f"{path}: is a link, which is neither followed nor replaced in a folder that this program "
                                 "fills; remove it")
        file = self.folder / IDENTITY
        if not file.exists():
            for path in self.folder.iterdir():
                if not path.name.startswith(".") and path.name != IDENTITY:
                    raise ValueError(f"{self.folder}: holds {path.name}, and is not a folder of windows; "
                                     "give another name")
            return False
        try:
            there = json.loads(file.read_text(encoding="utf-8"))
        except ValueError:
            there = None
        _require_same(self.folder, there, self.identity)
        return True

    def claim(self) -> None:
        if not self.claimed():
            self.folder.mkdir(exist_ok=True)
            text = json.dumps(self.identity, indent=2) + "\n"
            self._put(self.folder / IDENTITY, lambda stream: stream.write(text.encode()))
            self.claimed()  # by another decoding, if that was first

    def window(self, number: int) -> Path:
        return self.folder / f"window_{number:06d}.npy"

    def _header(self, number: int) -> bytes:
        """It names the decoding, so that no window of another one is taken for one of this."""
        begin, end = slots_of_block(number, self.identity["slots"])
        rows, cols, planes = (self.identity[key] for key in ("rows", "cols", "planes"))
        return _stipple.window_header(number, (end - begin, rows, cols, planes), (self.folder / IDENTITY).read_bytes())

    def holds(self, number: int) -> bool:
        file = self.window(number)
        try:
            np.load(file, mmap_mode="r")
        except (FileNotFoundError, ValueError, EOFError):
            return False  # absent, or cut off by a power failure
        header = self._header(number)
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
