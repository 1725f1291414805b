#!/usr/bin/env python3
"""What passed on this machine, by the content that was checked: a check of the same content with the
same tools need not run again.

    passed.py ask|record NAME PATH...

`ask` ends with 0, and says when it was, if the check NAME has passed on what PATHs, files and folders
of the project, hold now; `record` notes that it has. Packages of Debian that the project needs count
as content too. The notes lie in $XDG_CACHE_HOME/stipple/passed; without that folder all runs again.
They are kept for 30 days."""

import datetime
import functools
import hashlib
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
KEPT_SECONDS = 30 * 86400  # what passed long ago runs again
NOTES = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "stipple/passed"


def project_files(*paths):
    """Files below `paths`, relative to the project, that git tracks or does not ignore."""
    command = ["git", "-c", "safe.directory=*", "ls-files", "-z", "--cached", "--others",
               "--exclude-standard", "--", *paths]
    listed = subprocess.run(command, cwd=ROOT, check=True, capture_output=True).stdout.decode()
    return sorted({name for name in listed.split("\0") if name and (ROOT / name).is_file()})


def package_versions(check):
    """Of all installed packages whose name is, or begins as, one of scripts/packages.txt does. Those of
    the virtual machine count for its own check only, which installs them."""
    text = (ROOT / "scripts/packages.txt").read_text()
    if check == "vm":
        text += "linux-image-*\n"
    else:
        text = re.sub(r"^\[vm\](?:\n(?!\[).*)*", "", text, flags=re.MULTILINE)
    names = [line.split()[0] for line in text.splitlines() if line and line[0] not in "#["]
    command = ["dpkg-query", "--show", "--showformat", "${db:Status-Abbrev} ${Package} ${Version}\n",
               *names, "clang-*", "clang-tidy-*"]
    known = subprocess.run(command, check=False, capture_output=True).stdout
    return b"\n".join(line for line in known.splitlines() if line.startswith(b"ii"))


@functools.cache
def digest(name):
    """Of a file of the project, or of any whose path is absolute, as it was when first asked for."""
    return hashlib.sha256((ROOT / name).read_bytes()).digest()


class Passed:
    """The notes on one check."""

    def __init__(self, name):
        self._name = name
        self._base = hashlib.sha256(package_versions(name))

    def _note(self, files, *extra):
        content = self._base.copy()
        for text in extra:
            content.update(text.encode() + b"\0")
        for name in files:
            content.update(name.encode() + b"\0" + digest(name))
        return NOTES / f"{self._name}-{content.hexdigest()[:32]}"

    def when(self, files, *extra):
        """When the check passed on the content of `files` and the texts `extra`, or None."""
        note = self._note(files, *extra)
        return note.read_text().strip() if note.is_file() else None

    def record(self, files, *extra):
        NOTES.mkdir(parents=True, exist_ok=True)
        now = datetime.datetime.now(datetime.timezone.utc)
        for note in NOTES.glob(f"{self._name}-*"):
            if note.stat().st_mtime < now.timestamp() - KEPT_SECONDS:
                note.unlink(missing_ok=True)
        self._note(files, *extra).write_text(f"{now:%Y-%m-%d %H:%M} UTC\n")


def main(verb, name, *paths):
    passed = Passed(name)
    files = project_files(*paths)
    if verb == "record":
        passed.record(files)
        return 0
    when = passed.when(files)
    if when:
        print(f"{name}: skipped, passed {when} on the same content of {' '.join(paths)}")
    return 0 if when else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
