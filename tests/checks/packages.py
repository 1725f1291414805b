"""scripts/packages.txt, the find_package() calls of the build and the documentation name the same
packages."""

import re

from tree import report

LIST = "scripts/packages.txt"
FIND = re.compile(r"^\s*find_package\((\w+)|IMPORTED_TARGET (\w+)\)", re.M)
OF_CMAKE = {"Threads"}  # comes with the compiler
IN_TEXT = re.compile(r"\blib[a-z0-9-]+-dev\b")


def check(tree):
    listed, packages = {}, set()
    for number, line in tree.lines(LIST):
        if re.match(r"[a-z]", line):
            package, found_as, *purpose = line.split()
            listed.setdefault(found_as, number)
            packages.add(package)
            if not purpose:
                yield f"{LIST}:{number}: {package}: what is it for?"
    used = set()
    for name in tree.ending("CMakeLists.txt"):
        for words in FIND.findall(tree.text(name)):
            used.update(word for word in words if word)
    for name in sorted(used - OF_CMAKE - listed.keys()):
        yield f"{LIST}: the build looks for {name}; name the Debian package that holds it"
    for name in sorted(listed.keys() - used - {"-"}):
        yield f"{LIST}:{listed[name]}: no find_package({name}) in the build"
    for name in tree.ending(".md"):
        for number, line in tree.lines(name):
            for package in set(IN_TEXT.findall(line)) - packages:
                yield f"{name}:{number}: {package} is not in {LIST}"


if __name__ == "__main__":
    report(check)
