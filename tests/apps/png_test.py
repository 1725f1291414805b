"""PNG files of all kinds, written by ffmpeg or bit by bit, against what they were made of."""

import shutil
import struct
import subprocess
import unittest
import zlib

import numpy as np
from program import INPUT, OK, ProgramTest

INTERLACED = 28  # offset of the flag in a file


class PngTest(ProgramTest):
    def ffmpeg(self, name, pixels, size, data, *options):
        done = subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", pixels, "-s", size,
                               "-i", "-", *options, name], input=data, cwd=self.folder, capture_output=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return name

    def write_bits(self, name, rows, depth, colour_type=0, chunks=()):
        """A image of fewer than 8 bits a pixel."""
        packed = b"".join(
            b"\0" + np.packbits(np.unpackbits(row[:, None], axis=1)[:, 8 - depth:]).tobytes() for row in rows)
        head = struct.pack(">IIBBBBB", rows.shape[1], rows.shape[0], depth, colour_type, 0, 0, 0)
        content = b"\x89PNG\r\n\x1a\n"
        for kind, data in [(b"IHDR", head), *chunks, (b"IDAT", zlib.compress(packed)), (b"IEND", b"")]:
            content += struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        (self.folder / name).write_bytes(content)
        return name

    def light(self, name):
        """The light of the image, and what was said of it."""
        done = self.run_program("emulate", name, "-o", "clip.stipple", "--truth", "light.npy", "--force", "-q")
        self.assertEqual(done.returncode, OK, done.stderr)
        return self.array("light.npy")[0], done.stderr

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_numbers_of_8_and_16_bits_are_exact_interlaced_or_not(self):
        random = np.random.default_rng(1)
        for pixels, channels in (("gray", 1), ("ya8", 2), ("rgb24", 3), ("rgba", 4), ("gray16be", 1),
                                 ("ya16be", 2), ("rgb48be", 3), ("rgba64be", 4)):
            most = 65535 if pixels.endswith("be") else 255
            values = random.integers(0, most + 1, (13, 11, channels)).astype(">u2" if most > 255 else "u1")
            for flags in ("-ildct", "+ildct"):
                name = self.ffmpeg("f.png", pixels, "11x13", values.tobytes(), "-flags", flags)
                self.assertEqual((self.folder / name).read_bytes()[INTERLACED], flags == "+ildct")
                light, said = self.light(name)
                with self.subTest(pixels=pixels, flags=flags):
                    planes = 1 if channels < 3 else 3
                    expected = values[..., :planes] / most
                    np.testing.assert_allclose(light.reshape(expected.shape), expected, atol=1e-7)
                    self.assertEqual("alpha channel is left out" in said, channels in (2, 4))

    def test_fewer_bits_of_grey_run_from_0_to_1(self):
        for depth in (1, 2, 4):
            rows = np.arange(16, dtype=np.uint8).reshape(2, 8) % 2 ** depth
            light, said = self.light(self.write_bits("f.png", rows, depth))
            np.testing.assert_allclose(light, rows / (2 ** depth - 1), atol=1e-7)
            self.assertEqual(said, "")

    def test_a_palette_gives_colours_and_its_transparency_is_left_out(self):
        colours = np.arange(48, dtype=np.uint8).reshape(16, 3) * 5
        rows = np.arange(16, dtype=np.uint8).reshape(2, 8)
        for chunks in ([(b"PLTE", colours.tobytes())], [(b"PLTE", colours.tobytes()), (b"tRNS", bytes(7))]):
            light, said = self.light(self.write_bits("f.png", rows, 4, 3, chunks))
            np.testing.assert_allclose(light, colours[rows] / 255, atol=1e-7)
            self.assertEqual("alpha channel is left out" in said, len(chunks) == 2)

    def test_a_transparent_colour_is_left_out(self):
        values = np.full((2, 2, 3), 9)
        light, said = self.light(self.write_png("f.png", values, [(b"tRNS", struct.pack(">HHH", 9, 9, 9))]))
        np.testing.assert_allclose(light, values / 255, atol=1e-7)
        self.assertIn("alpha channel is left out", said)

    def test_chunks_that_are_not_pixels_may_be_of_any_length_but_not_damaged(self):
        text = [(b"tEXt", b"Comment\0" + bytes(10_000_000))]
        self.light(self.write_png("f.png", np.zeros((2, 2)), text))
        self.change_byte("f.png", 1000)
        self.fails(INPUT, ["f.png: offset 33: tEXt: CRC error; it is damaged"], "emulate", "f.png", "-o", "x")
        content = (self.folder / "f.png").read_bytes()
        (self.folder / "f.png").write_bytes(content[:5000])
        self.fails(INPUT, ["f.png: offset 33: the file ends too early; it is damaged"], "emulate", "f.png", "-o", "x")


if __name__ == "__main__":
    unittest.main()
