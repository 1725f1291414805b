"""Streams as an interactive page."""

import json
from os import PathLike, fsdecode
from typing import Any, Dict, Iterable, Optional, Union

from . import _stipple
from ._decoder import Method, caller_of, decoders_of
from ._pipeline import Name, Tell, Video, _reading

__all__ = ["report"]


def report(
    runs: Union[Name, _stipple.Stream, "Iterable[Union[Name, _stipple.Stream]]"],
    output: Name,
    *,
    truth: Optional[Video] = None,
    methods: Iterable[Method] = ("fast",),
    characterization: Optional[Name] = None,
    title: str = "Stipple report",
    until: int = 64,
    crop: Optional[str] = None,
    max_size: Optional[str] = None,
    max_value: Optional[float] = None,
    min_value: Optional[float] = None,
    transfer: Optional[str] = None,
    luminance: bool = False,
    raw: Optional[str] = None,
    force: bool = False,
    threads: int = 0,
    progress: Tell = None,
) -> Dict[str, Any]:
    """Writes a page that shows streams and their videos, as "stipple report" does (docs/report.md), and returns the
    figures: the keys of its option --json.

    runs: a stream in a file, a folder of them, or several.
    output: the page, a .html.
    truth: the video that the sensor saw, as for `emulate`.
    methods: beside "naive": names, and decoders of one's own as for `explore`. The page shows the first one first.
    characterization: what "stipple characterize --json" wrote.
    until: only the first slots.
    crop: area of the pictures, "WxH+X+Y" or "WxH"; by default all, or 640x480 of the middle.
    max_size: bound of the file, "96M" by default; beyond it pictures of slots are left out.
    max_value: light of both up to this is compared; by default what the streams can tell.
    min_value, transfer, luminance, raw: of the truth, as for `emulate`.
    force: replace a file that is there.
    progress: as for `emulate`, with decoded slots of all streams and methods.

    Raises ValueError and OSError, and as `explore` for a decoder. What was left out and damage are UserWarnings.
    """
    names = [runs] if isinstance(runs, (str, PathLike, _stipple.Stream)) else list(runs)
    task = _stipple.ReportTask([fsdecode(name) for name in names], output, force, title)
    task.set_limits(until, crop, max_size)
    task.set_max_value(max_value)
    if characterization is not None:
        task.set_camera(fsdecode(characterization))
    for method in decoders_of(methods):
        if isinstance(method, str):
            task.add_method(method)
        else:
            task.add_decoder(method.name, method.version, caller_of(method))
    footage = None
    if truth is not None:
        footage = _stipple.Footage(truth, _reading(transfer, luminance, None, raw, min_value))
    with _stipple.Threads(threads):
        figures: Dict[str, Any] = json.loads(_stipple.report(task, footage, progress))
    return figures
