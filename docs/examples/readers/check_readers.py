#!/usr/bin/python3
"""Compares the readers of this folder with the test files of the two formats.

usage: check_readers.py MANIFEST      tests/golden/manifest.json; exit code 1 for another result"""

import hashlib
import json
import sys
from pathlib import Path

from read_recording import FIELDS, Recording, image
from read_stream import Stream

# of the header of a stream
NOT_SHOWN = ("n", "p", "s", "random", "calibrated", "weighted", "crc")
SWITCH = ("number", "slot", "rounding", "black_level_dn", "gain_e_per_dn", "read_noise_e",
          "full_well_e", "electrons_per_unit", "schedule_name", "schedule")
CFA = (None, "rggb", "grbg", "gbrg", "bggr")


def stream_result(content):
    """What the reader finds, in the form of docs/stream_format.md, "Test files"."""
    try:
        stream = Stream(content)
    except ValueError as error:
        return {"strict_error": str(error), "error": str(error)}
    faults = [place["offset"] for place in stream.damage]
    if stream.tail_bytes:
        faults.append(len(content) - stream.tail_bytes)
    header = {key: value for key, value in stream.head.items() if key not in NOT_SHOWN}
    header |= {"rounding": ("nearest", "floor")[header["rounding"]], "cfa": CFA[header["cfa"]]}
    for key in ("cfa", "weights", "noise_free"):
        if not header[key]:
            del header[key]
    keys = ("packets", "slots", "missing_slots", "tail_bytes", "damage")
    found = {key: getattr(stream, key) for key in keys}
    if stream.switching:
        found["switches"] = [{key: part[key] for key in SWITCH} for part in stream.parts[1:]]
        for part in found["switches"]:
            part["rounding"] = ("nearest", "floor")[part["rounding"]]
        for packet in stream.packets:
            packet["exposures"] = exposures(stream, packet)
    strict_error = f"byte {faults[0]}:" if faults else None
    return {"strict_error": strict_error, "error": None, "header": header, **found}


def exposures(stream, packet):
    """[first slot, open slots] of each sample of a packet; None if they are unknown."""
    if packet["flags"] & 2:  # dropped
        return []
    rows = range(packet["first_row"], packet["first_row"] + packet["rows"])
    due = [sample[3:] for sample in stream.due(packet["slot"], rows)]
    return [None if first is None else [first, open_slots] for first, open_slots in due]


def recording_result(content):
    """What the reader finds, in the form of docs/recording_format.md, "Test files"."""
    try:
        recording = Recording(content)
    except ValueError as error:
        return {"error": str(error)}
    keys = ("session", "end", "missing_blocks", "tail_bytes", "damage")
    return {"error": None, "frames": [frame_result(frame) for frame in recording.frames],
            **{key: getattr(recording, key) for key in keys}}


def frame_result(frame):
    shown = {key: frame[key] for key in FIELDS if key != "payload_hash"}
    shown = {key: None if value != value else value for key, value in shown.items()}  # NaN is null
    return shown | {"samples": list(image(frame))}


RESULTS = {".stipple": stream_result, ".strec": recording_result}


def read(file, content):
    """The result of these bytes of a file, as if it were read from JSON: tuples are lists."""
    return json.loads(json.dumps(RESULTS[file.suffix](content)))


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
    if is_stream:
        return "damaged" if result["strict_error"] else "good"
    whole = not result["damage"] and not result["tail_bytes"] and result["end"]
    return "good" if whole else "damaged"


def faults(manifest):
    """A line for each file that does not read as it should."""
    for entry in json.loads(manifest.read_text())["files"]:
        file, expected_file = manifest.parent / entry["file"], manifest.parent / entry["expected"]
        content, expected = file.read_bytes(), expected_file.read_bytes()
        if hashlib.sha256(content).hexdigest() != entry["sha256"]:
            yield f"{file}: another sha256"
        if hashlib.sha256(expected).hexdigest() != entry["expected_sha256"]:
            yield f"{expected_file}: another sha256"
        result = read(file, content)
        different = difference(result, json.loads(expected))
        if different:
            yield f"{file}: {different}"
        elif outcome(result, file.suffix == ".stipple") != entry["outcome"]:
            yield f"{file}: the outcome is not {entry['outcome']}"


if __name__ == "__main__":
    lines = list(faults(Path(sys.argv[1])))
    print("\n".join(lines) or "every file reads as expected")
    sys.exit(1 if lines else 0)
