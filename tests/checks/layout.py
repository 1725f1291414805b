"""Every C++ source is laid out as .clang-format says; no text has tabs or trailing blanks."""

import re
import shutil
import subprocess
import sys

from tree import SKIPPED, report


def check(tree):
    sources = tree.ending(".h", ".cpp")
    for name in tree.texts():
        for number, line in tree.lines(name):
            if line != line.rstrip() or "\t" in line:
                yield f"{name}:{number}: tab or blanks at the end of the line"
    if sources:
        command = ["clang-format", "--dry-run", "--Werror", "--ferror-limit=1", *sources]
        run = subprocess.run(command, cwd=tree.root, capture_output=True, text=True)
        for place in re.findall(r"^(\S+?:\d+):\d+: error:.*$", run.stderr, re.M):
            yield f"{place}: not as clang-format would lay it out; run clang-format -i on the file"


if __name__ == "__main__":
    if not shutil.which("clang-format"):
        print("skipped: clang-format is not installed (scripts/install-deps checks)")
        sys.exit(SKIPPED)
    report(check)
