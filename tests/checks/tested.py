"""Every source of a library has a test: tests/MODULE/.../FILE_test.cpp of its own, or the test or fuzz target that
covered_by.txt names for it. A C++ test has to reach the source through includes."""

import re
from functools import cache

from tree import LIBRARIES, report

LIST = "tests/checks/covered_by.txt"
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)


def check(tree):
    sources = tree.of_modules(".cpp", modules=LIBRARIES)
    reached = reach(tree)
    covered = {}
    for number, line in tree.lines(LIST):
        if not line or line.startswith("#"):
            continue
        source, _, test = line.partition(" ")
        problem = ""
        if source not in sources:
            problem = f"{source} is no source of a library"
        elif source in covered:
            problem = f"{source} is listed twice"
        elif own_test(source) in tree.files:
            problem = f"{source} has a test of its own; delete the line"
        elif not re.search(r"_(test|fuzz)\.(cpp|py)$", test) or test not in tree.files:
            problem = f"{test} is no test"
        elif test.endswith(".cpp") and source not in reached(test):
            problem = f"{test} does not reach {source} through its includes"
        if problem:
            yield f"{LIST}:{number}: {problem}"
        covered[source] = test
    for source in sources:
        if own_test(source) not in tree.files and source not in covered:
            yield f"{source}: has no {own_test(source)}; write it, or name the test that covers it in {LIST}"


def own_test(source):
    return f"tests/{source.removesuffix('.cpp')}_test.cpp"


def reach(tree):
    """A function: all files that a test compiles or links, by its includes. A header brings the source of its name,
    and sources without such a header that include it first."""
    files = set(tree.files)
    includes = {name: [target for target in INCLUDE.findall(tree.text(name)) if target in files]
                for name in tree.ending(".h", ".cpp")}
    sources = {}
    for name in tree.ending(".cpp"):
        own = name.removesuffix(".cpp") + ".h"
        header = own if own in files else next(iter(includes[name]), None)
        sources.setdefault(header, []).append(name)

    @cache
    def reached(test):
        found, todo = set(), [test]
        while todo:
            name = todo.pop()
            if name not in found:
                found.add(name)
                todo += includes[name] + sources.get(name, [])
        return found

    return reached


if __name__ == "__main__":
    report(check)
