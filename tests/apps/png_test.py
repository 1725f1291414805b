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

    def light(self, name, *options):
        """The light of the image, and what was said of it."""
        done = self.run_program("emulate", name, "-o", "clip.stipple", "--truth", "light.npy", "--force", "-q", *options)
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

    def test_declared_transfer_functions(self):
        """The chunks cICP, iCCP, sRGB and gAMA, the first of which counts; 0.5 is light by each."""
        colour = np.full((2, 2, 3), 128)
        value = 128 / 255
        srgb, bt709 = ((value + 0.055) / 1.055) ** 2.4, ((value + 0.099) / 1.099) ** (1 / 0.45)
        profile = lambda name: (b"iCCP", name + b"\0\0" + zlib.compress(bytes(128)))
        gamma = lambda power: (b"gAMA", struct.pack(">I", power))
        points = lambda *codes: (b"cICP", bytes(codes))
        for chunks, light, hint in (
                ([gamma(100000)], value, ""), ([gamma(45455)], srgb, "looks gamma-coded"),
                ([(b"sRGB", b"\0"), gamma(100000)], srgb, "looks gamma-coded"),
                ([profile(b"sRGB IEC61966-2.1"), gamma(100000)], srgb, "looks gamma-coded"),
                ([points(1, 1, 0, 1), profile(b"P3")], bt709, "looks gamma-coded"),
                ([points(1, 8, 0, 1), gamma(45455)], value, ""), ([points(1, 4, 0, 1)], value ** 2.2, "looks gamma-coded"),
                ([points(1, 18, 0, 1)], None, "is HDR in the curve hlg: add --transfer hlg")):
            with self.subTest(chunks=chunks):
                name = self.write_png("f.png", colour, chunks)
                said = self.light(name)[1]
                self.assertEqual(hint in said if hint else said, True if hint else "")
                if light is not None:
                    np.testing.assert_allclose(self.light(name, "--transfer", "auto")[0], light, rtol=1e-5)
        for chunk, curve in ((gamma(55556), "power 0.5556"), (profile(b"Display P3"), 'of the profile "display p3"'),
                             (points(1, 11, 0, 1), "11 of H.273")):
            with self.subTest(curve=curve):
                self.assertIn("looks gamma-coded", self.light(self.write_png("f.png", colour, [chunk]))[1])
                self.fails(INPUT, [f"f.png: declares the transfer function {curve}, which is not known"], "emulate",
                           "f.png", "-o", "x.stipple", "--transfer", "auto")
        self.write_png("f.png", colour, [points(1, 1, 0, 0)])
        self.fails(INPUT, ["f.png: declares numbers of limited range (cICP)"], "emulate", "f.png", "-o", "x.stipple")

    def test_hdr_colours_of_bt2020_are_those_of_rec_709_afterwards(self):
        """Pure red of BT.2020 is outside of Rec. 709: more red, no green or blue (ITU-R BT.2087)."""
        name = self.write_png("f.png", np.full((2, 2, 3), (200, 0, 0)), [(b"cICP", bytes((9, 16, 0, 1)))])
        light, said = self.light(name, "--transfer", "pq")
        grey = self.light(self.write_png("g.png", np.full((2, 2), 200)), "--transfer", "pq")[0]
        self.assertEqual(said, "")
        np.testing.assert_allclose(light[0, 0] / grey[0, 0], (1.6605, 0, 0), atol=2e-3)

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_display_coded_16_bits_of_ffmpeg_are_told_where_they_are_declared(self):
        """Without a declaration integers of 16 bits are linear, as cameras and Stipple write them."""
        for declared, hinted in ((",setparams=color_trc=iec61966-2-1", True), (",setparams=color_trc=linear", False),
                                 ("", False)):
            done = subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i",
                                   "testsrc2=size=16x16:rate=1:duration=1", "-vf", "format=rgb48be" + declared, "f.png"],
                                  cwd=self.folder, capture_output=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            with self.subTest(declared=declared):
                self.assertEqual("looks gamma-coded" in self.light("f.png")[1], hinted)

    def test_primaries_shape_of_pixels_and_orientation_are_told(self):
        rec709 = (31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000)
        p3 = (31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000)
        primaries = lambda values: (b"cHRM", struct.pack(">8I", *values))
        linear = (b"gAMA", struct.pack(">I", 100000))
        entries = ((256, 2), (274, 6), (305, 0))
        exif = {order: (b"MM\0*" if order == ">" else b"II*\0") + struct.pack(order + "IH", 8, len(entries)) +
                b"".join(struct.pack(order + "HHIHH", tag, 3, 1, value, 0) for tag, value in entries) for order in "<>"}
        colour = np.full((2, 2, 3), 128)
        for chunks, parts in (([linear, primaries(rec709)], []), ([linear, primaries(p3)], ["primaries of its chunk cHRM"]),
                              ([linear, (b"iCCP", b"P3\0\0")], ["primaries of the profile \"p3\""]),
                              ([linear, (b"pHYs", struct.pack(">IIB", 3, 4, 0))], ["pixels 1.333 times as wide as high"]),
                              ([linear, (b"pHYs", struct.pack(">IIB", 300, 300, 1))], []),
                              ([linear, (b"eXIf", exif["<"])], ["turned or mirrored (orientation 6)"]),
                              ([linear, (b"eXIf", exif[">"])], ["turned or mirrored (orientation 6)"]),
                              ([linear, (b"eXIf", exif[">"][:20])], [])):
            with self.subTest(chunks=chunks[1]):
                said = self.light(self.write_png("f.png", colour, chunks))[1]
                self.assertEqual(bool(said), bool(parts), said)
                for part in parts:
                    self.assertIn(part, said)
        self.assertEqual(self.light(self.write_png("f.png", np.zeros((2, 2)), [linear, primaries(p3)]))[1], "")

    def test_significant_bits_are_told(self):
        for values, chunk, bits in ((np.zeros((2, 2)), b"\5", 5), (np.zeros((2, 2, 3)), b"\5\6\5", 6)):
            self.write_png("f.png", values, [(b"sBIT", chunk)])
            self.assertEqual(self.figures("info", "f.png")["bits"], bits)

    def test_an_animation_is_refused(self):
        for frames in (1, 7):
            name = self.write_png("f.png", np.zeros((2, 2)), [(b"acTL", struct.pack(">II", frames, 0))])
            if frames == 1:
                self.light(name)
            else:
                self.fails(INPUT, ["f.png: is an animation of 7 frames", "ffmpeg"], "emulate", name, "-o", "x.stipple")

    def test_images_of_different_declarations_are_no_footage(self):
        for slot, chunks in enumerate(([], [(b"sRGB", b"\0")])):
            self.write_png(f"f/{slot}.png", np.zeros((2, 2)), chunks)
        self.fails(INPUT, ["f/1.png: declares another transfer function than the first frame"], "emulate", "f", "-o", "x")


if __name__ == "__main__":
    unittest.main()
