"""Tables of many trials, in this process or on a cluster."""

import tempfile
from collections import deque
from functools import lru_cache
from os import PathLike, fsdecode, path
from typing import Any, Callable, Deque, Optional, Tuple, Union

from . import _stipple
from ._workers import Fingerprint, check_workers, require_same

__all__ = ["explore", "explore_on"]

Name = Union[str, "PathLike[str]"]
Tell = Optional[Callable[[float, Optional[int]], object]]

#: Trials that are on their way at a time: enough for some hundred workers.
IN_FLIGHT = 512


def explore(
    space: Name,
    results: Name,
    *,
    force: bool = False,
    budget: str = "",
    rank: str = "",
    report: bool = True,
    threads: int = 0,
    progress: Tell = None,
) -> "list[dict[str, Any]]":
    """Runs the trials of a space that `results` lacks, as "stipple explore" does, and returns the table.

    space: the path of a TOML file (docs/explore.md).
    results: the path of the folder of results.
    force: run all trials again.
    budget: "10m", or a number of decoded clips as text; without it all points have the whole clip.
    rank: the column by which the better half of the points is chosen.
    report: write report.html too.
    threads: 0 means all cores. The figures but decode_seconds do not depend on it.
    progress: as for `emulate`, with trials for slots.

    A row is a dict of the columns of table.csv; a figure that is not known is None. Raises ValueError and OSError.
    """
    with _stipple.Threads(threads):
        exploration = _stipple.Exploration(space, results, _stipple.ExploreOptions(force, budget, rank), progress)
        try:
            while exploration.next_rung():
                for number in exploration.due():
                    if exploration.begin(number):
                        exploration.run(number)
        finally:
            exploration.write(report)
    return _rows(exploration)


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

    The table is that of `explore`, but for decode_seconds. Raises as `check_workers`, and as `explore`.
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
        exploration.write(report)
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
            if isinstance(value, str) and name not in ("limited_by", "compared_slots", "problem"):
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
