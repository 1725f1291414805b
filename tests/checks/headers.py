"""Every header has `#pragma once`; those of libraries include the standard library and our own
headers only, so that no third-party type gets into an interface. `*-inl.h` are the inside of
Highway kernels, compiled once per target: they have a guard of their own and include hwy. The private
headers of a module, which are not installed, may include others, but no installed header them.

A source of a library includes its own header first, which proves that the header compiles alone:
stipple_module() then leaves it out of the headers that are compiled one at a time.

No two headers define a type of the same name: a program that links both is broken, and neither
compiler nor linker says so."""

import re

from tree import LIBRARIES, report

# A header of the standard library has neither folder nor ending.
FOREIGN = re.compile(r"\s*#\s*include\s*<([^>]*[/.][^>]*)>")
OWN = re.compile(r'\s*#\s*include\s*"([^"]+)"')
INNER = re.compile(r"\btarget_sources\(stipple_\w+ PRIVATE\s+([\w/.\s]+)\)")
# At the start of a line: a type of the namespace, no forward declaration.
DEFINITION = re.compile(r"(?:struct|class|enum class) (\w+)(?: final)?(?: :[^;]*)? \{")
# The preprocessor's work may begin with nothing else: a macro before it could be what it needs.
FIRST_INCLUDE = re.compile(r"\A(?:\s*//.*\n|\s*\n)*#include \"([^\"]+)\"")


def defined_twice(tree):
    places = {}
    for name in tree.of_modules(".h"):
        for number, line in tree.lines(name):
            definition = DEFINITION.match(line)
            if definition and not name.endswith("-inl.h"):
                first = places.setdefault(definition[1], f"{name}:{number}")
                if first != f"{name}:{number}":
                    yield f"{name}:{number}: {definition[1]} is defined in {first} too; rename one"


def included_late(tree):
    for name in tree.of_modules(".cpp", modules=LIBRARIES):
        own = name.removesuffix(".cpp") + ".h"
        if own in tree.files:
            first = FIRST_INCLUDE.search(tree.text(name))
            if not first or first[1] != own:
                yield f"{name}:1: include \"{own}\" first, so that it is proved to compile alone"


def inner_headers(tree):
    """Those that target_sources(stipple_MODULE PRIVATE ...) names."""
    return {f"{module}/{header}" for module in LIBRARIES if f"{module}/CMakeLists.txt" in tree.files
            for header in " ".join(INNER.findall(tree.text(f"{module}/CMakeLists.txt"))).split()}


def check(tree):
    yield from defined_twice(tree)
    yield from included_late(tree)
    yield from wrong_includes(tree, inner_headers(tree))
    for name in tree.ending(".h"):
        if not name.endswith("-inl.h") and "#pragma once" not in tree.text(name).splitlines():
            yield f"{name}:1: no #pragma once"


def wrong_includes(tree, inner):
    for name in tree.of_modules(".h", modules=LIBRARIES):
        if name in inner:
            continue
        for number, line in tree.lines(name):
            foreign = FOREIGN.match(line)
            if foreign and not (name.endswith("-inl.h") and foreign[1].startswith("hwy/")):
                yield f"{name}:{number}: <{foreign[1]}> in a header; keep it in the .cpp file"
            own = OWN.match(line)
            if own and own[1] in inner:
                yield f"{name}:{number}: \"{own[1]}\" is not installed; include it in the .cpp file"


if __name__ == "__main__":
    report(check)
