"""scripts/packages.txt, the find_package() calls of the build, the includes of the sources and the
documentation agree on what the project needs."""

import re

from tree import report

LIST = "scripts/packages.txt"
FIND = re.compile(r"^\s*find_package\((\w+)|IMPORTED_TARGET (\w+)\)", re.M)
OWN = {"Threads", "stipple"}  # of the compiler; of what examples/ is built against
MADE = {"libstipple-dev"}  # by scripts/package
INCLUDE = re.compile(r"\s*#\s*include\s*<((?!(?:sys|arpa|net|netinet|stipple)/)[^>]+/[^>]+)>")
IN_TEXT = re.compile(r"\blib[a-z0-9-]+-dev\b")


def check(tree):
    rows = [(number, *line.split(maxsplit=3)) for number, line in tree.lines(LIST)
            if re.match(r"[a-z]", line)]
    for number, package, *columns in rows:
        if len(columns) < 3:
            yield f"{LIST}:{number}: {package}: four columns, the last says what it is for"
    rows = [row for row in rows if len(row) == 5]
    yield from wrong_finds(tree, {found_as: number for number, _, found_as, _, _ in rows})
    yield from wrong_headers(tree, {prefix: number for number, _, _, prefix, _ in rows})
    yield from wrong_texts(tree, {package for _, package, _, _, _ in rows})


def wrong_finds(tree, listed):
    used = set()
    for name in tree.ending("CMakeLists.txt"):
        for words in FIND.findall(tree.text(name)):
            used.update(word for word in words if word)
    for name in sorted(used - OWN - listed.keys()):
        yield f"{LIST}: the build looks for {name}; name the Debian package that holds it"
    for name in sorted(listed.keys() - used - {"-"}):
        yield f"{LIST}:{listed[name]}: no find_package({name}) in the build"


def wrong_headers(tree, listed):
    unused = listed.keys() - {"-"}
    for name in tree.ending(".h", ".cpp"):
        for number, line in tree.lines(name):
            include = INCLUDE.match(line)
            if include:
                prefixes = {prefix for prefix in listed if include[1].startswith(prefix)}
                unused -= prefixes
                if not prefixes:
                    yield f"{name}:{number}: <{include[1]}> is of no package in {LIST}"
    for prefix in sorted(unused):
        yield f"{LIST}:{listed[prefix]}: nothing includes <{prefix}...>; is the package needed?"


def wrong_texts(tree, packages):
    for name in tree.ending(".md"):
        for number, line in tree.lines(name):
            for package in set(IN_TEXT.findall(line)) - packages - MADE:
                yield f"{name}:{number}: {package} is not in {LIST}"


if __name__ == "__main__":
    report(check)
