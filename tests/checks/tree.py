"""The files of the project, and how a check reports what it finds in them."""

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LIBRARIES = tuple(re.search(r"set\(STIPPLE_MODULES ([^)]*)\)", (ROOT / "CMakeLists.txt").read_text()).group(1).split())
MODULES = (*LIBRARIES, "apps", "python")


class Tree:
    """All files that belong to the project: tracked by git, or new and not ignored. A copy without
    git is walked instead."""

    def __init__(self, root):
        self.root = Path(root)
        self.files = sorted(self._from_git() or self._walk())

    def _from_git(self):
        if not (self.root / ".git").exists():
            return []
        command = ["git", "-c", "safe.directory=*", "ls-files", "-z", "--cached", "--others",
                   "--exclude-standard"]
        try:
            listed = subprocess.run(command, cwd=self.root, check=True, capture_output=True)
        except (OSError, subprocess.CalledProcessError):
            return []
        names = set(listed.stdout.decode().split("\0"))
        return [name for name in names if name and (self.root / name).is_file()]

    def _walk(self):
        found = []
        for folder, folders, names in os.walk(self.root):
            folders[:] = [name for name in folders if name not in {"build", "out", ".git",
                                                                   "__pycache__"}]
            found += [(Path(folder) / name).relative_to(self.root).as_posix() for name in names]
        return found

    def ending(self, *suffixes):
        return [name for name in self.files if name.endswith(suffixes)]

    def of_modules(self, *suffixes, modules=MODULES):
        return [name for name in self.ending(*suffixes) if name.split("/")[0] in modules]

    def text(self, name):
        return (self.root / name).read_text(encoding="utf-8", errors="replace")

    def lines(self, name):
        """(line number, line), from 1."""
        return enumerate(self.text(name).splitlines(), start=1)

    def texts(self):
        """Names of the files that hold text, the inputs of fuzz targets excepted."""
        for name in self.files:
            if "/corpus/" not in name and b"\0" not in (self.root / name).read_bytes():
                yield name


def report(check):
    """Runs `check(tree)`, which yields "file:line: what is wrong, what to do". Prints them all;
    exits with 1 if there are any."""
    root = sys.argv[1] if len(sys.argv) > 1 else ROOT
    findings = list(check(Tree(root)))
    for finding in findings:
        print(finding)
    sys.exit(1 if findings else 0)
