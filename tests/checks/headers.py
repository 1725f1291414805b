"""Every header has `#pragma once`; those of libraries include the standard library and our own
headers only, so that no third-party type gets into an interface. `*-inl.h` are the inside of
Highway kernels, compiled once per target: they have a guard of their own and include hwy.

No two headers define a type of the same name: a program that links both is broken, and neither
compiler nor linker says so."""

import re

from tree import LIBRARIES, report

# A header of the standard library has neither folder nor ending.
FOREIGN = re.compile(r"\s*#\s*include\s*<([^>]*[/.][^>]*)>")
# At the start of a line: a type of the namespace, no forward declaration.
DEFINITION = re.compile(r"(?:struct|class|enum class) (\w+)(?: final)?(?: :[^;]*)? \{")


def defined_twice(tree):
    places = {}
    for name in tree.of_modules(".h"):
        for number, line in tree.lines(name):
            definition = DEFINITION.match(line)
            if definition and not name.endswith("-inl.h"):
                first = places.setdefault(definition[1], f"{name}:{number}")
                if first != f"{name}:{number}":
                    yield f"{name}:{number}: {definition[1]} is defined in {first} too; rename one"


def check(tree):
    yield from defined_twice(tree)
    inner = tree.ending("-inl.h")
    for name in tree.ending(".h"):
        if name not in inner and "#pragma once" not in tree.text(name).splitlines():
            yield f"{name}:1: no #pragma once"
    for name in tree.of_modules(".h", modules=LIBRARIES):
        for number, line in tree.lines(name):
            foreign = FOREIGN.match(line)
            if foreign and not (name in inner and foreign[1].startswith("hwy/")):
                yield f"{name}:{number}: <{foreign[1]}> in a header; keep it in the .cpp file"


if __name__ == "__main__":
    report(check)
