"""Every header has `#pragma once`; those of libraries include the standard library and our own
headers only, so that no third-party type gets into an interface. `*-inl.h` are the inside of
Highway kernels, compiled once per target: they have a guard of their own and include hwy."""

import re

from tree import LIBRARIES, report

# A header of the standard library has neither folder nor ending.
FOREIGN = re.compile(r"\s*#\s*include\s*<([^>]*[/.][^>]*)>")


def check(tree):
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
