"""CITATION.cff has the keys that version 1.2.0 of its format requires, each on a line of its own, and the version of the
project."""

import re

from tree import report

FILE = "CITATION.cff"
REQUIRED = ("cff-version", "message", "title", "authors", "version", "license")


def check(tree):
    if FILE not in tree.files:
        yield f"{FILE}: does not exist"
        return
    keys = dict(re.findall(r"^([\w-]+): *(.*)$", tree.text(FILE), re.M))
    for key in REQUIRED:
        if key not in keys:
            yield f"{FILE}: no key {key}"
    project = re.search(r"^project\(\w+ VERSION ([\d.]+)", tree.text("CMakeLists.txt"), re.M)
    if project and keys.get("version") != project[1]:
        yield f"{FILE}: version {keys.get('version')}, but CMakeLists.txt has {project[1]}"


if __name__ == "__main__":
    report(check)
