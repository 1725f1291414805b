"""The readers in docs/examples/readers, written from the pages of the formats alone, read every test file as expected, and
notice each broken byte. STIPPLE_UPDATE_GOLDEN=1 writes the hashes of changed test files into the manifest."""

import hashlib
import json
import os
import re
import subprocess
import sys
import unittest
import warnings
from pathlib import Path

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
GOLDEN = PROJECT / "tests/golden"
MANIFEST = GOLDEN / "manifest.json"
sys.path.insert(0, str(PROJECT / "docs/examples/readers"))

from check_readers import difference, faults, read  # noqa: E402


def sha256(name):
    return hashlib.sha256((GOLDEN / name).read_bytes()).hexdigest()


def entries():
    return json.loads(MANIFEST.read_text())["files"]


def update_hashes():
    files = [entry | {"sha256": sha256(entry["file"]), "expected_sha256": sha256(entry["expected"])}
             for entry in entries()]
    MANIFEST.write_text(json.dumps({"files": files}, indent=1) + "\n")


class ReadersTest(unittest.TestCase):
    def test_every_file_reads_as_expected(self):
        self.assertEqual(list(faults(MANIFEST)), [])

    def test_the_manifest_lists_every_file_and_says_what_it_shows(self):
        listed = {entry[key] for entry in entries() for key in ("file", "expected")}
        folders = ("stream", "stream_version_1", "stream_version_3", "stream_version_4",
                   "recording")
        there = {f"{folder}/{file.name}" for folder in folders for file in (GOLDEN / folder).iterdir()}
        self.assertEqual(listed, there)
        self.assertTrue(all(entry["shows"] for entry in entries()))

    def test_a_broken_byte_is_seen(self):
        """Of each good file; but the last 4 bytes of a recording's magic are reserved."""
        for entry in entries():
            if entry["outcome"] != "good":
                continue
            file = GOLDEN / entry["file"]
            expected, content = json.loads((GOLDEN / entry["expected"]).read_text()), file.read_bytes()
            for at in range(0, len(content), 41):
                if file.suffix == ".strec" and 12 <= at < 16:
                    continue
                broken = bytearray(content)
                broken[at] ^= 0x04
                self.assertNotEqual(difference(read(file, bytes(broken)), expected), "", f"{file}: byte {at}")

    def test_a_changed_sample_is_seen(self):
        expected = json.loads((GOLDEN / "stream/example.json").read_text())
        expected["packets"][0]["dn"][0] -= 1
        file = GOLDEN / "stream/example.stipple"
        self.assertIn("packets", difference(read(file, file.read_bytes()), expected))

    def test_each_reader_stands_alone_and_prints(self):
        """The samples of the page's example with their places; a frame a line, then the damage."""
        def printed(name, file):
            command = [sys.executable, "-I", "-B", PROJECT / "docs/examples/readers" / name, GOLDEN / file]
            return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()

        self.assertEqual(printed("read_stream.py", "stream/example.stipple"), [
            "0 0 0 0 0 1 1023", "0 1 0 0 0 1 1",
            "1 0 0 0 1 1 512", "1 0 1 0 0 3 3", "1 1 0 0 1 1 4", "1 1 1 0 0 3 0"])
        frames, damage = printed("read_recording.py", "recording/damaged_payload.strec")[:2], "1839 204 "
        self.assertTrue(all(frame.startswith("id=") for frame in frames), frames)
        self.assertIn(damage, "\n".join(printed("read_recording.py", "recording/damaged_payload.strec")))

    def test_each_reader_is_one_short_file(self):
        for name in ("read_stream.py", "read_recording.py"):
            lines = (PROJECT / "docs/examples/readers" / name).read_text().splitlines()
            self.assertLessEqual(len(lines), 221)
            self.assertLessEqual(max(map(len, lines)), 100)

    def test_the_image_of_the_page_has_the_samples(self):
        page = (PROJECT / "docs/recording_format.md").read_text()
        reader, image = re.findall(r"```python\n(.*?)```", page, re.S)
        for name in ("mono8", "mono12", "mono16_big_endian", "rgb8", "padded_rows", "losses"):
            read = {}
            argv, sys.argv = sys.argv, ["reader", str(GOLDEN / f"recording/{name}.strec")]
            self.addCleanup(setattr, sys, "argv", argv)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", ResourceWarning)  # the page's lines leave closing to Python
                exec(reader + image, read)
            expected = json.loads((GOLDEN / f"recording/{name}.json").read_text())["frames"]
            self.assertEqual(len(read["frames"]), len(expected))
            for (record, pixels), frame in zip(read["frames"], expected):
                rows = read["image"](record, pixels).reshape(frame["height"], -1)
                np.testing.assert_array_equal(rows, frame["samples"])


if __name__ == "__main__":
    if "STIPPLE_UPDATE_GOLDEN" in os.environ:
        update_hashes()
    unittest.main()
