"""Tables of many trials, in this process or on a cluster."""

import tempfile
from collections import deque
from functools import lru_cache
from os import PathLike, fsdecode, path
from typing import Any, Callable, Deque, Iterable, Optional, Tuple, Union

from . import _stipple
from ._decoder import Method, caller_of, decoders_of
from ._pipeline import _reading
from ._workers import Fingerprint, check_workers, require_same

__all__ = ["explore", "explore_on", "rivals"]

Name = Union[str, "PathLike[str]"]
Tell = Optional[Callable[[float, Optional[int]], object]]

#: Trials that are on their way at a time: enough for some hundred workers.
IN_FLIGHT = 512


def _options(
    methods: Iterable[Method],
    seeds: int,
    force: bool,
    reading: _stipple.Reading,
    budget: str = "",
    rank: str = "",
) -> _stipple.ExploreOptions:
    options = _stipple.ExploreOptions(force, budget, rank)
    options.set_reading(reading)
    options.set_seeds(seeds)
    for method in decoders_of(methods):
        if isinstance(method, str):
            options.add_method(method)
        else:
            options.add_decoder(method.name, method.version, caller_of(method))
    return options


def _run(exploration: _stipple.Exploration, report: bool, title: str = "") -> "list[dict[str, Any]]":
    try:
        while exploration.next_rung():
            for number in exploration.due():
                if exploration.begin(number):
                    exploration.run(number)
    finally:
        exploration.write(report, title)
    return _rows(exploration)


def explore(
    space: Name,
    results: Name,
    *,
    methods: Iterable[Method] = (),
    seeds: int = 1,
    transfer: Optional[str] = None,
    luminance: bool = False,
    min_value: Optional[float] = None,
    raw: Optional[str] = None,
    scale: float = 1.0,
    frames: Optional[str] = None,
    crop: Optional[str] = None,
    bin: int = 1,
    resize: Optional[Tuple[int, int]] = None,
    force: bool = False,
    budget: str = "",
    rank: str = "",
    report: bool = True,
    threads: int = 0,
    progress: Tell = None,
) -> "list[dict[str, Any]]":
    """Runs the trials of a space that `results` lacks, as "stipple explore" does, and returns the table.

    space: the path of a TOML file (docs/explore.md), or a name of "stipple list spaces".
    results: the path of the folder of results.
    methods: names of methods and decoders of one's own, a Decoder or a function from a Stream to an array, in place of
        the methods of the space. If it has systems, each one of one sensor with the method "best" has a copy for each
        of them: that of "coded best" by "own" is "coded own".
    seeds: trials of each point, for means, intervals and tied ranks.
    transfer, luminance, min_value, raw, scale: of the footage, as for `emulate`.
    frames, crop, bin, resize: the part of the footage, "A:B", "WxH+X+Y", a number of pixels and (rows, columns).
    force: run all trials again.
    budget: "10m", or a number of decoded clips as text; without it all points have the whole clip.
    rank: the column by which the better half of the points is chosen, and by which seeds rank.
    report: write report.html too.
    threads: 0 means all cores. The figures but decode_seconds and decode_megabytes do not depend on it.
    progress: as for `emulate`, with trials for slots.

    A row is a dict of the columns of table.csv; a figure that is not known is None. Raises ValueError and OSError. What
    a decoder of one's own raises is the cause of a RuntimeError, and a result that is no video of its stream a
    ValueError; both name decoder and trial, and what was done before is kept.
    """
    reading = _reading(transfer, luminance, None, raw, min_value, scale)
    reading.set_part(frames, crop, bin, resize)
    options = _options(methods, seeds, force, reading, budget, rank)
    with _stipple.Threads(threads):
        return _run(_stipple.Exploration(_space_file(space), results, options, progress), report)


def rivals(
    footage: Name,
    results: Name,
    *,
    sensor: Name = "",
    space: Name = "rivals",
    systems: Iterable[str] = (),
    dictionary: Name = "",
    methods: Iterable[Method] = (),
    seeds: int = 1,
    transfer: Optional[str] = None,
    luminance: bool = False,
    min_value: Optional[float] = None,
    raw: Optional[str] = None,
    scale: float = 1.0,
    frames: Optional[str] = None,
    crop: Optional[str] = None,
    bin: int = 1,
    resize: Optional[Tuple[int, int]] = None,
    force: bool = False,
    report: bool = True,
    threads: int = 0,
    progress: Tell = None,
) -> "list[dict[str, Any]]":
    """Coded exposure and its rivals on a scene, as "stipple rivals" does; returns the table.

    footage: a path, or a scene of "stipple list scenes".
    results: the path of the folder of results.
    sensor: name or path of the sensor of the systems; by default that of the space.
    space: the systems, the name or path of a space.
    systems: names of systems, only these and their copies by `methods`; by default all. A copy may be named too.
    dictionary: of hitomi2011, a file that "stipple dictionary" wrote.
    methods, seeds, transfer, luminance, min_value, raw, scale, frames, crop, bin, resize, force, report, threads,
        progress: as for `explore`.

    Rows and errors are as those of `explore`.
    """
    reading = _reading(transfer, luminance, None, raw, min_value, scale)
    reading.set_part(frames, crop, bin, resize)
    options = _options(methods, seeds, force, reading)
    title = options.choose_rivals(fsdecode(footage), fsdecode(sensor), _texts(systems), fsdecode(dictionary))
    with _stipple.Threads(threads):
        return _run(_stipple.Exploration(_space_file(space), results, options, progress), report, title)


def _space_file(space: Name) -> str:
    return _stipple.find_space(fsdecode(space))


def _texts(systems: Iterable[str]) -> "list[str]":
    if isinstance(systems, str):
        raise TypeError(f"systems: {systems!r} is a text; give a list")
    return list(systems)


def explore_on(
    space: Name,
    results: Name,
    client: Any,
    *,
    force: bool = False,
    budget: str = "",
    rank: str = "",
    report: bool = True,
    threads: int = 1,
    progress: Tell = None,
) -> "list[dict[str, Any]]":
    """The same with the trials on the workers of a cluster; each trial is a task.

    client: a dask.distributed.Client. Its workers need this package, and the files that the space names under the
        same paths. `results` is needed here alone.
    threads: of each task; 0 means all cores of its worker.

    The table is that of `explore`, but for decode_seconds and decode_megabytes. Raises as `check_workers`, and as `explore`.
    """
    caller = check_workers(client)
    exploration = _stipple.Exploration(space, results, _stipple.ExploreOptions(force, budget, rank), progress)
    name = fsdecode(space)
    flying: Deque[Tuple[int, Any]] = deque()

    def land() -> None:
        number, task = flying.popleft()
        identity, outcome = client.gather([task])[0]
        if isinstance(outcome, str):
            exploration.fail(number, outcome)
        elif identity != exploration.identity(number):
            raise ValueError(
                f"{name}: a worker has other footage, sensors or schedules than this machine under the names of "
                f"point {number + 1}; put them where all machines see the same, and give absolute paths"
            )
        else:
            exploration.put(number, outcome)

    try:
        while exploration.next_rung():
            for number in exploration.due():
                if len(flying) == IN_FLIGHT:
                    land()
                if exploration.begin(number):
                    point = (exploration.text(), name, exploration.point_of_clip(number), threads)
                    flying.append((number, client.submit(_run_point, caller, *point, pure=False)))
            while flying:
                land()
    finally:
        exploration.write(report, "")
    return _rows(exploration)


@lru_cache(maxsize=1)
def _scene_light(space: str, name: str, footage: str) -> _stipple.TrialLight:
    return _stipple.TrialLight(_stipple.Space(space, name), footage)


def _run_point(
    caller: Fingerprint, text: str, name: str, point: Tuple[int, int, int, int], threads: int
) -> Tuple[str, Any]:
    """Identity and outcome of a trial, on a worker; instead of the outcome the problem of a point that fails."""
    require_same(caller)
    space = _stipple.Space(text, name)
    footage = space.footage(point[0])
    with tempfile.TemporaryDirectory(prefix="stipple_") as folder, _stipple.Threads(threads):
        try:
            if _stipple.is_scene(footage):
                light = _scene_light(text, name, footage)
            else:  # which may have changed
                light = _stipple.TrialLight(space, footage)
            return _stipple.run_point(space, point, light, path.join(folder, "point.stipple"))
        except ValueError as problem:
            return "", str(problem)


def _rows(exploration: _stipple.Exploration) -> "list[dict[str, Any]]":
    rows = exploration.rows()
    for row in rows:
        for name, value in row.items():
            if isinstance(value, str) and name not in ("limited_by", "compared_slots", "rank", "problem"):
                row[name] = _value(value)
    return rows


def _value(text: str) -> Union[int, float, str]:
    """A value of an axis: a number if it is one."""
    try:
        return int(text)
    except ValueError:
        pass
    try:
        return float(text)
    except ValueError:
        return text
