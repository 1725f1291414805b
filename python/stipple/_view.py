"""The page of `stipple view` on streams and videos, in a browser or a notebook."""

import html
import tempfile
from os import PathLike
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from ._stipple import Stream, Window

__all__ = ["View", "view"]

Source = Union[str, "PathLike[str]", Stream, npt.ArrayLike]

#: Height of the page in a notebook, in pixels.
FRAME_HEIGHT = 900


class View:
    """A page that is served until `close`, the end of its `with` block, or that of the program. In a notebook it is
    shown as the value of a cell. `url`: its address, with a random token."""

    def __init__(self, sources: Any, truth: Any, method: str, address: str, port: int) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="stipple_")  # pylint: disable=consider-using-with
        try:
            files = [self._file_of(source, f"{number}") for number, source in enumerate(sources, 1)]
            light = "" if truth is None else self._file_of(truth, "truth")
            self._window = Window(files, light, method, address, port)
        except BaseException:
            self._folder.cleanup()
            raise
        self.url = self._window.url

    def _file_of(self, source: Any, name: str) -> str:
        folder = Path(self._folder.name)
        if isinstance(source, Stream):
            if source.path is not None:
                return str(source.path)
            source.save(folder / f"stream_{name}.stipple")
            return str(folder / f"stream_{name}.stipple")
        if isinstance(source, (str, PathLike)):
            return str(source)
        np.save(folder / f"{name}.npy", np.asarray(source))
        return str(folder / f"{name}.npy")

    def close(self) -> None:
        """Ends the page."""
        self._window.close()
        self._folder.cleanup()

    def __enter__(self) -> "View":
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"View({self.url!r})"

    def _repr_html_(self) -> str:
        return f'<iframe src="{html.escape(self.url)}" width="100%" height="{FRAME_HEIGHT}"></iframe>'


def view(
    *sources: Source,
    truth: Optional[Source] = None,
    method: str = "best",
    address: str = "127.0.0.1",
    port: int = 0,
) -> View:
    """Serves a page on `sources`: streams (Stream or path), videos and footage (path, or an array (slot, row, col) or
    (slot, row, col, 3) of linear light), all of one frame size. `truth`: the light that the sensor saw. `method`:
    that of the last pictures of a stream. Raises ValueError or OSError for what cannot be shown, and OSError for an
    `address` or a `port` (0: a free one) that cannot be used."""
    if not sources:
        raise ValueError("view() needs a stream or a video")
    return View(sources, truth, method, address, port)
