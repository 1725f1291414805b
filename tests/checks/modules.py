"""The modules are those of STIPPLE_MODULES in CMakeLists.txt, and apps and python. The two tables of
docs/architecture.md and the header filter of .clang-tidy name the same ones."""

import re

from tree import report

BUILD = "CMakeLists.txt"
PAGE = "docs/architecture.md"
TIDY = ".clang-tidy"


def check(tree):
    listed = re.search(r"set\(STIPPLE_MODULES ([^)]*)\)", tree.text(BUILD))
    modules = {*listed.group(1).split(), "apps", "python"}
    page = tree.text(PAGE)
    folders = {name for name in re.findall(r"^\| `(\w+)/` \|", page, re.M) if f"{name}/{BUILD}" in tree.files}
    yield from differences(f"{PAGE}: the table of folders", modules, folders - {"bench", "examples", "tests"})
    table = page[page.find("| may include |"):]
    rows = re.findall(r"^\| *([\w, ]+?) *\| *[\w, ]+? *\|$", table, re.M)
    included = {module for row in rows for module in row.split(", ")}
    yield from differences(f"{PAGE}: the table of includes", modules, included - {"bench", "tests"})
    regex = re.search(r"^HeaderFilterRegex: '/\((.*)\)/'", tree.text(TIDY), re.M)
    yield from differences(f"{TIDY}: HeaderFilterRegex", modules, set(regex.group(1).split("|")) if regex else set())


def differences(place, wanted, found):
    for module in sorted(wanted - found):
        yield f"{place} lacks {module}, a module of {BUILD}"
    for module in sorted(found - wanted):
        yield f"{place} has {module}, no module of {BUILD}"


if __name__ == "__main__":
    report(check)
