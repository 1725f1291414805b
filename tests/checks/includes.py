"""Modules include, and link, only what the table of docs/architecture.md allows. Folders of a module that
lie beside each other do not include each other in a circle."""

import os
import re
from pathlib import Path

from tree import MODULES, report

# Folders that may include each other, each pair with its reason.
MUTUAL = {
    frozenset({"capture/aravis", "capture/doctor"}),  # the doctor opens cameras, which use its rules
    frozenset({"capture/recording", "capture/serve"}),  # each reads what the other one writes
}

PAGE = "docs/architecture.md"
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


def allowed_modules(tree):
    """{module: modules it may include}, from the rows `| module | core, stream |` of the page."""
    table = {}
    for row in re.findall(r"^\| *([\w, ]+?) *\| *([\w, ]+?) *\|$", tree.text(PAGE), re.M):
        for module in row[0].split(", "):
            if module in MODULES:
                table[module] = set(MODULES) if row[1] == "everything" else set(row[1].split(", "))
    return table


def check(tree):
    table = allowed_modules(tree)
    for module in MODULES:
        if module not in table:
            yield f"{PAGE}: the table of includes has no row for {module}"
    yield from wrong_includes(tree, table)
    yield from wrong_links(tree, table)
    yield from circles(tree)


def wrong_includes(tree, table):
    for name in tree.ending(".h", ".cpp"):
        module = name.split("/")[0]
        for number, line in tree.lines(name):
            include = INCLUDE.match(line)
            if not include:
                continue
            form, target = include.groups()
            first = target.split("/")[0]
            if form == '"' and target not in tree.files:
                yield f'{name}:{number}: "{target}" is no file here; write the path from the root'
            elif form == "<" and target in tree.files and not name.startswith("docs/examples/"):
                yield f"{name}:{number}: <{target}> is ours; write it in quotes"
            elif module in table and first in MODULES and first not in table[module] | {module}:
                yield f"{name}:{number}: {module} may not include {first} ({PAGE})"
            elif module in MODULES and first == "tests":
                yield f"{name}:{number}: {module} may not include {first}"


def wrong_links(tree, table):
    for module in table:
        name = f"{module}/CMakeLists.txt"
        if name not in tree.files:
            continue
        for number, line in tree.lines(name):
            for other in re.findall(r"\bstipple_(\w+)\b", line):
                if other in MODULES and other not in table[module] | {module}:
                    yield f"{name}:{number}: {module} may not link {other} ({PAGE})"


def circles(tree):
    places = {}  # {(folder, folder that it includes): where}
    for name in tree.of_modules(".h", ".cpp"):
        for number, line in tree.lines(name):
            include = INCLUDE.match(line)
            pair = include and siblings(name, include.group(2))
            if pair and frozenset(pair) not in MUTUAL:
                places.setdefault(pair, f"{name}:{number}")
    for (first, second), place in sorted(places.items()):
        if first in reached_from(second, places):
            yield f"{place}: {first} includes {second}, which leads back to it; move what both need"


def siblings(name, target):
    """The folders of a file and of its include where their paths part: ("apps/output",
    "apps/arguments"). None if one lies in the other, or in another module."""
    here, there = Path(name).parent.parts, Path(target).parent.parts
    shared = len(os.path.commonprefix([here, there]))
    if shared == 0 or shared in (len(here), len(there)):
        return None
    return "/".join(here[:shared + 1]), "/".join(there[:shared + 1])


def reached_from(folder, edges):
    """`folder` and the folders that it includes, directly or by others."""
    found, new = set(), {folder}
    while new:
        found |= new
        new = {second for first, second in edges if first in new} - found
    return found


if __name__ == "__main__":
    report(check)
