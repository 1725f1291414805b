"""The cases in a folder of test results (JUnit XML): ctest.xml and one NAME.xml for each GoogleTest
program or case that ctest ran as NAME."""

import re
from collections import Counter
from typing import NamedTuple
from xml.etree import ElementTree


class Case(NamedTuple):
    """A case of a GoogleTest program, or an entry of ctest that is no such program."""
    entry: str
    passed: bool
    skipped: str | None  # why


def cases(folder):
    """All cases that were run or skipped."""
    files = {file.relative_to(folder).with_suffix("").as_posix(): file for file in folder.rglob("*.xml")}
    for name, file in files.items():
        for case in ElementTree.parse(file).iter("testcase"):
            entry = case.get("name") if name == "ctest" else name
            filtered_out = name != "ctest" and case.get("status") == "notrun"
            if filtered_out or (name == "ctest" and entry in files):
                continue
            skipped = case.find("skipped")
            yield Case(entry, case.find("failure") is None and skipped is None,
                       None if skipped is None else reason(skipped.get("message") or ""))


def reason(message):
    """GoogleTest puts the place in the source before it."""
    return " ".join(line for line in message.splitlines() if not line.startswith("/"))


def passed_whole(folder):
    """Names of the entries that passed with all their cases: none failed, none was skipped."""
    whole = set()
    for entry in ElementTree.parse(folder / "ctest.xml").iter("testcase"):
        output = entry.findtext("system-out") or ""
        skips_inside = re.search(r"^OK \(.*skipped=", output, re.MULTILINE)  # Python's unittest
        if entry.get("status") == "run" and not skips_inside:
            whole.add(entry.get("name"))
    return whole - {case.entry for case in cases(folder) if not case.passed}


def summary(folder):
    """How many cases, which were skipped, and why."""
    found = list(cases(folder))
    skipped = Counter(case.skipped for case in found if case.skipped is not None)
    entries = len({case.entry for case in found})
    lines = [f"{len(found)} test cases in {entries} entries, {sum(skipped.values())} skipped"]
    return "\n".join(lines + [f"  {count} skipped: {why}" for why, count in skipped.most_common()])
