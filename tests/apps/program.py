"""Runs the program under test, and makes the files that it reads."""

import json
import os
import struct
import subprocess
import tempfile
import unittest
import zlib
from pathlib import Path

import numpy as np

PROGRAM = os.environ["STIPPLE"]
OK, INPUT, USAGE, DEVICE, STOPPED = 0, 1, 2, 3, 130


def project_path(name):
    """A file or folder of the project."""
    return Path(__file__).parents[2] / name


class ProgramTest(unittest.TestCase):
    """Each test works in an empty folder of its own, with paths relative to it."""

    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory(prefix="stipple_")))

    def run_program(self, *arguments, **options):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                              capture_output=True, timeout=120, **options)

    def start_program(self, *arguments, **options):
        return subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                                stderr=subprocess.PIPE, **options)

    def succeed(self, *arguments, **options):
        """Standard output of a run that must succeed."""
        done = self.run_program(*arguments, **options)
        self.assertEqual(done.returncode, OK, done.stderr)
        return done.stdout

    def figures(self, *arguments):
        return json.loads(self.succeed(*arguments, "--json", "-"))

    def fails(self, code, parts, *arguments, **options):
        """Expects the exit code, a message that holds all parts, and no new file."""
        before = self.names()
        done = self.run_program(*arguments, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)
        self.assertEqual(self.names(), before)
        return done.stderr

    def names(self):
        """All files and folders below the test's folder, hidden ones too."""
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*"))

    def array(self, name):
        return np.load(self.folder / name)

    def write_array(self, name, values, dtype=np.float32):
        np.save(self.folder / name, np.asarray(values, dtype))
        return name

    def write_flat(self, name, slots=30, rows=8, cols=8, light=0.2):
        """Footage of the same light everywhere."""
        return self.write_array(name, np.full((slots, rows, cols), light))

    def write_stream(self, name="clip.stipple", slots=30, **flat):
        self.succeed("emulate", self.write_flat("light.npy", slots, **flat), "-o", name)
        return name

    def write_png(self, name, values, chunks=()):
        """8-bit grey, or by a last axis of 2 to 4 grey with alpha, RGB, RGB with alpha; with further
        chunks, (kind, data)."""
        values = np.asarray(values, np.uint8)
        rows = b"".join(b"\0" + row.tobytes() for row in values)
        colour_type = {1: 0, 2: 4, 3: 2, 4: 6}[values.shape[2] if values.ndim == 3 else 1]
        head = struct.pack(">IIBBBBB", values.shape[1], values.shape[0], 8, colour_type, 0, 0, 0)
        chunks = b"".join(
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
            for kind, data in [(b"IHDR", head), *chunks, (b"IDAT", zlib.compress(rows)), (b"IEND", b"")])
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunks)
        return name

    def change_byte(self, name, offset):
        path = self.folder / name
        content = bytearray(path.read_bytes())
        content[offset] ^= 0xFF
        path.write_bytes(content)
