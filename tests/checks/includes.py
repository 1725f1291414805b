"""Modules include, and link, only what the table of docs/architecture.md allows."""

import re

from tree import MODULES, report

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
            elif form == "<" and target in tree.files:
                yield f"{name}:{number}: <{target}> is ours; write it in quotes"
            elif module in table and first in MODULES and first not in table[module] | {module}:
                yield f"{name}:{number}: {module} may not include {first} ({PAGE})"
            elif module in MODULES and first in ("tests", "bench"):
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


if __name__ == "__main__":
    report(check)
