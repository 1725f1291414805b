"""The cases in the results (JUnit XML) of ctest and of the GoogleTest programs that it ran."""

import re
from collections import Counter
from typing import NamedTuple
from xml.etree import ElementTree


class Case(NamedTuple):
    """A case of a GoogleTest program, or an entry of ctest that is no such program."""
    entry: str
    passed: bool
    skipped: str | None  # why


def cases(results, programs):
    """All cases that were run or skipped: of the entries of ctest in `results`, of which `programs` names
    the results of those that are GoogleTest programs."""
    for entry in ElementTree.parse(results).iter("testcase"):
        name = entry.get("name")
        written = name in programs and programs[name].is_file()
        for case in ElementTree.parse(programs[name]).iter("testcase") if written else [entry]:
            skipped = case.find("skipped")
            if not written or case.get("status") != "notrun":  # filtered out
                yield Case(name, case.find("failure") is None and skipped is None,
                           None if skipped is None else reason(skipped.get("message") or ""))


def reason(message):
    """GoogleTest puts the place in the source before it."""
    return " ".join(line for line in message.splitlines() if not line.startswith("/"))


def passed_whole(results, programs):
    """Names of the entries that passed with all their cases: none failed, none was skipped."""
    whole = set()
    for entry in ElementTree.parse(results).iter("testcase"):
        output = entry.findtext("system-out") or ""
        skips_inside = re.search(r"^OK \(.*skipped=", output, re.MULTILINE)  # Python's unittest
        if entry.get("status") == "run" and not skips_inside:
            whole.add(entry.get("name"))
    return whole - {case.entry for case in cases(results, programs) if not case.passed}


def summary(results, programs):
    """How many cases, which were skipped, and why."""
    found = list(cases(results, programs))
    skipped = Counter(case.skipped for case in found if case.skipped is not None)
    entries = len({case.entry for case in found})
    lines = [f"{len(found)} test cases in {entries} entries, {sum(skipped.values())} skipped"]
    return "\n".join(lines + [f"  {count} skipped: {why}" for why, count in skipped.most_common()])
