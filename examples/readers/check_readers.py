#!/usr/bin/python3
"""Compares the readers of this folder with the test files of the two formats.

usage: check_readers.py MANIFEST      tests/golden/manifest.json; exit code 1 if a result is not the expected one"""

import hashlib
import json
import sys
from pathlib import Path

from read_recording import read_recording
from read_stream import read_stream

READERS = {".stipple": read_stream, ".strec": read_recording}


def without_texts(result):
    """Errors and causes by their offset: the rest of the text is not part of the formats."""
    short = dict(result)
    for key in ("strict_error", "error"):
        short[key] = short.get(key) and short[key].split(":")[0]
    if "damage" in short:
        short["damage"] = [(place["offset"], place["bytes"]) for place in short["damage"]]
    return short


def difference(found, expected):
    """The first key in which a result is not the expected one, or an empty text."""
    found, expected = without_texts(found), without_texts(expected)
    for key in sorted(found.keys() | expected.keys()):
        if found.get(key) != expected.get(key):
            return f"{key}: {found.get(key)} instead of {expected.get(key)}"
    return ""


def outcome(result, is_stream):
    """`good`, `damaged` or `refused`, as in the manifest."""
    if result["error"] is not None:
        return "refused"
    at_fault = result["strict_error"] if is_stream else (result["damage"] or result["tail_bytes"] or not result["end"])
    return "damaged" if at_fault else "good"


def faults(manifest):
    """A line for each file that does not read as it should."""
    for entry in json.loads(manifest.read_text())["files"]:
        file, expected_file = manifest.parent / entry["file"], manifest.parent / entry["expected"]
        content, expected = file.read_bytes(), expected_file.read_bytes()
        if hashlib.sha256(content).hexdigest() != entry["sha256"]:
            yield f"{file}: another sha256"
        if hashlib.sha256(expected).hexdigest() != entry["expected_sha256"]:
            yield f"{expected_file}: another sha256"
        result = READERS[file.suffix](content)
        different = difference(result, json.loads(expected))
        if different:
            yield f"{file}: {different}"
        elif outcome(result, file.suffix == ".stipple") != entry["outcome"]:
            yield f"{file}: the outcome is not {entry['outcome']}"


if __name__ == "__main__":
    lines = list(faults(Path(sys.argv[1])))
    print("\n".join(lines) or "every file reads as expected")
    sys.exit(1 if lines else 0)
