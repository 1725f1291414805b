"""FITS: the light of each kind of number, and what is refused."""

import shutil
import subprocess
import unittest

import numpy as np
from camera_files import MOSAIC, CameraFilesTest
from program import INPUT


def padded(content, by):
    return content + by * (-len(content) % 2880)


def header_data_unit(first, values, bitpix, cards):
    """A header that begins with this card, and its array of the stored numbers; () has none."""
    kind = {8: "u1", 16: ">i2", 32: ">i4", 64: ">i8", -32: ">f4", -64: ">f8"}[bitpix]
    axes = [f"NAXIS{i + 1:<3}= {size:>20}" for i, size in enumerate(reversed(values.shape))]
    header = [first, f"BITPIX  = {bitpix:>20}", f"NAXIS   = {len(axes):>20}", *axes, "COMMENT = no value", *cards,
              "END"]
    text = "".join(f"{card:<80}" for card in header).encode()
    data = values.astype(kind).tobytes() if axes else b""
    return padded(text, b" ") + padded(data, b"\0")


def extension(kind, values, bitpix, *cards):
    quoted = f"'{kind}'"
    return header_data_unit(f"XTENSION= {quoted:<20}", values, bitpix, ("PCOUNT  = 0", "GCOUNT  = 1", *cards))


def fits(values, bitpix, *cards):
    """A FITS file of the stored numbers (slot, row, col), or (row, col)."""
    return header_data_unit(f"SIMPLE  = {'T':>20} / standard", values, bitpix, cards)



class FitsTest(CameraFilesTest):
    def fits(self, values, bitpix, *cards):
        return self.write("clip.fits", fits(values, bitpix, *cards))

    def test_numbers_of_each_kind(self):
        upside_down = MOSAIC[:, ::-1]
        small = MOSAIC // 21 % 4
        for stored, bitpix, cards, light in (
                (upside_down % 256, 8, (), MOSAIC % 256 / 255),
                (upside_down, 16, (), MOSAIC / 32767),
                (upside_down * 16 - 32768, 16, ("BZERO   =              32768.0", "BSCALE  = 1"), MOSAIC * 16 / 65535),
                (upside_down, 16, ("BZERO   = 1.", "BSCALE  = 2.5D-4 / of light"), 1 + MOSAIC * 2.5e-4),
                (small[:, ::-1], 32, (), small), (small[:, ::-1], 64, (), small),
                (upside_down / 4096, -32, (), MOSAIC / 4096), (upside_down / 4095, -64, (), MOSAIC / 4095),
                (MOSAIC, 16, ("ROWORDER= 'TOP-DOWN'",), MOSAIC / 32767)):
            with self.subTest(bitpix=bitpix, cards=cards):
                self.assert_light(light, self.fits(stored, bitpix, *cards))
                self.assertEqual(self.said, "")

    def test_an_image_is_one_frame(self):
        self.assert_light(MOSAIC[:1] / 32767, self.fits(MOSAIC[0, ::-1], 16))

    def test_exposure(self):
        """Slots of 5000 us."""
        blurred = "its frames were exposed for 6000 us, but a slot of sensor \"paper\" takes 5000 us (200 a second)"
        for cards in (("EXPTIME =                0.006 / seconds",), ("EXPTIME = 6.0D-3",), ("EXPOSURE= 0.006",),
                      ("EXPTIME = 0.006", "EXPOSURE= 1.")):
            with self.subTest(cards=cards):
                name = self.fits(MOSAIC, 16, *cards)
                self.light(name)
                self.assertIn(f"{name}: {blurred}: motion is blurred", self.said)
                self.assertAlmostEqual(self.figures("info", name)["exposure_us"], 6000)
        name = self.fits(MOSAIC, 16, "EXPTIME = 0.001")
        self.light(name)
        self.assertEqual(self.said, "")
        self.light(name, "--frames-hz", 200)
        self.assertIn("its frames were exposed for 1000 of 5000 us each", self.said)
        for value in ("0", "-0.006", "'unknown '", "1E305", "nan", ""):
            with self.subTest(value=value):
                name = self.fits(MOSAIC, 16, f"EXPTIME = {value}")
                self.light(name)
                self.assertEqual(self.said, "")
                self.assertIsNone(self.figures("info", name)["exposure_us"])

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_ffmpeg_reads_the_same_image(self):
        ramp = np.arange(48).reshape(6, 8) * 5
        ramp[0, 1] = 255  # from 0 to 255: to these ffmpeg stretches the numbers
        name = self.fits(ramp, 8)
        frame = subprocess.run(["ffmpeg", "-v", "error", "-i", name, "-f", "rawvideo", "-pix_fmt", "gray", "-"],
                               cwd=self.folder, capture_output=True, check=True).stdout
        light = self.light(name)
        np.testing.assert_allclose(light[0] * 255, np.frombuffer(frame, np.uint8).reshape(6, 8), atol=1e-4)

    def test_digital_numbers_as_floats_are_told(self):
        self.light(self.fits(MOSAIC.astype(float), -32))
        self.assertIn("the mean light is", self.said)

    def test_what_is_not_read(self):
        for part, content in (("BITPIX is 12", fits(MOSAIC, 16).replace(b"16\x20", b"12\x20", 1)),
                              ("primary array has 0 axes", fits(np.zeros(()), 8)),
                              ("primary array has 4 axes", fits(MOSAIC[None], 16)),
                              ("is a mosaic (BAYERPAT)", fits(MOSAIC, 16, "BAYERPAT= 'RGGB    '")),
                              ("BZERO is \"many\", no number", fits(MOSAIC, 16, "BZERO   = many")),
                              ("NAXIS1 is \"0\"", fits(MOSAIC[:, :, :0], 16)),
                              ("does not begin with SIMPLE", bytes(2880)),
                              ("ROWORDER is ", fits(MOSAIC, 16, "ROWORDER= 'LEFT'")),
                              ("header without an end", b"SIMPLE  = T" + b" " * (2880 * 1001))):
            with self.subTest(part=part):
                self.refuse([part], self.write("clip.fits", content))
        self.fails(INPUT, ["light is negative", "--min-value 0"], "emulate", self.fits(MOSAIC - 1, 16), "-o",
                   "x.stipple")
        self.fails(INPUT, ["light is not a number"], "emulate", self.fits(MOSAIC * np.nan, -32), "-o", "x.stipple")

    def test_the_image_may_be_in_an_extension(self):
        """As Hubble and astropy write them: the primary array is empty; its cards hold for the extension."""
        empty = fits(np.zeros(()), 8)
        table = extension("BINTABLE", np.zeros((3, 20)), 8).replace(b"PCOUNT  = 0", b"PCOUNT  = 9", 1)
        image = extension("IMAGE", MOSAIC[:, ::-1] * 16 - 32768, 16, "BZERO   = 32768.0")
        spectrum = extension("IMAGE", np.ones(5), 8)
        for parts in ((image,), (table, image), (spectrum, image, table), (image, b"\1" * 5760)):
            self.assert_light(MOSAIC * 16 / 65535, self.write("clip.fits", b"".join((empty, *parts))))
            self.assertEqual(self.said, "")
        for primary, own in ((("EXPTIME = 0.006",), ()), (("EXPTIME = 1.",), ("EXPTIME = 0.006",))):
            content = fits(np.zeros(()), 8, *primary) + extension("IMAGE", MOSAIC, 16, *own)
            self.assertAlmostEqual(self.figures("info", self.write("clip.fits", content))["exposure_us"], 6000)
        content = fits(np.zeros(()), 8, "ROWORDER= 'TOP-DOWN'") + extension("IMAGE", MOSAIC, 16)
        self.assert_light(MOSAIC / 32767, self.write("clip.fits", content))
        # A primary array that is an image is the footage.
        self.assert_light(MOSAIC / 32767, self.write("clip.fits", fits(MOSAIC[:, ::-1], 16) + image))
        self.assertEqual(self.said, "stipple: warning: clip.fits: the images in its extensions are left out\n")
        self.light(self.write("clip.fits", fits(MOSAIC[:, ::-1], 16) + table))
        self.assertEqual(self.said, "")

    def test_the_third_axis_is_time(self):
        for cards, hz in ((("CTYPE3  = 'TIME    '", "CDELT3  = 0.005", "CUNIT3  = 's'"), 200),
                          (("CTYPE3  = 'UTC'", "CDELT3  = 0.005"), 200), (("CTYPE3  = 'TIME'", "CUNIT3  = 'd'"), None)):
            name = self.fits(MOSAIC, 16, *cards)
            self.light(name)
            self.assertEqual((self.said, self.figures("info", name)["frames_hz"]), ("", hz))
        for axis in ("WAVE", "FREQ", "STOKES", "VRAD", "RGB"):
            self.refuse([f'its third axis is "{axis}", not time'], self.fits(MOSAIC, 16, f"CTYPE3  = '{axis}'"))
            self.light(self.fits(MOSAIC[:1], 16, f"CTYPE3  = '{axis}'"))
        self.light(self.fits(MOSAIC[:3], 16))
        self.assertIn("has 3 frames; if they are red, green and blue", self.said)

    def test_numbers_without_a_value_are_refused(self):
        dn = MOSAIC[:, ::-1].copy()
        self.light(self.fits(dn, 16, "BLANK   = -32768"))
        dn[1, 5, 3] = -32768  # the first row is the last
        self.fails(INPUT, ["clip.fits: frame 1: row 0, column 3: has no value (BLANK)"], "emulate",
                   self.fits(dn, 16, "BLANK   = -32768", "BSCALE  = 0.5", "BZERO   = 16384."), "-o", "x.stipple")
        self.light(self.fits(MOSAIC / 4096, -32, "BLANK   = 0"))  # of integers alone

    def test_units_and_pedestals_are_told(self):
        name = self.fits(MOSAIC, 16, "BUNIT   = 'adu     '", "PEDESTAL= -100")
        self.light(name)
        self.assertEqual(self.said, "stipple: warning: clip.fits: declares a pedestal of -100, which is not "
                         "subtracted from its numbers\n")
        self.assertEqual(self.figures("info", name)["sample_format"], "BITPIX 16, adu")

    def test_extensions_that_are_not_read(self):
        empty = fits(np.zeros(()), 8)
        image = [extension("IMAGE", MOSAIC, 16, f"EXTNAME = '{name}'") for name in ("SCI", "ERR")]
        self.refuse(['its extensions 1 "SCI", 2 "ERR"', "one to a file of its own", "fitscopy"],
                    self.write("clip.fits", empty + b"".join(image)))
        many = self.write("clip.fits", empty + image[0] * 20)
        self.refuse(['8 "SCI", ...; write'], many)
        compressed = extension("BINTABLE", np.zeros((3, 20)), 8, "ZIMAGE  = T")
        self.refuse(["compressed image", "funpack"], self.write("clip.fits", empty + compressed))
        self.refuse(["primary array has 0 axes", "image extension, of which it has none"],
                    self.write("clip.fits", empty + extension("TABLE", np.zeros((3, 20)), 8)))
        self.refuse(["image extension has 4 axes"],
                    self.write("clip.fits", empty + extension("IMAGE", MOSAIC[None], 16)))
        self.refuse(["is a mosaic (BAYERPAT)"],
                    self.write("clip.fits", fits(np.zeros(()), 8, "BAYERPAT= 'RGGB'") + image[0]))
        self.refuse(["damaged or cut short"], self.write("clip.fits", (empty + image[0])[:-2880]))
        for name, value in (("PCOUNT", "-1"), ("GCOUNT", "1.5"), ("NAXIS1", "x"), ("NAXIS1", "3e9")):
            cards = (f"{name:<8}= {value}", "NAXIS1  = 1")  # the first one of a name holds
            broken = header_data_unit("XTENSION= 'BINTABLE'", np.zeros(()), 8, cards).replace(
                b"NAXIS   =                    0", b"NAXIS   =                    1", 1)
            self.refuse([name], self.write("clip.fits", empty + broken))
        for sizes in ((2**31 - 1,) * 5, (0, 2**31 - 1)):
            axes = [f"NAXIS{i + 1}  = {size}" for i, size in enumerate(sizes)]
            broken = header_data_unit("XTENSION= 'BINTABLE'", np.zeros(()), 8, axes).replace(
                b"NAXIS   =                    0", f"NAXIS   = {len(sizes):>20}".encode(), 1)
            self.refuse(["it has none"], self.write("clip.fits", empty + broken))

    def test_negative_light_can_be_clipped(self):
        """As after the subtraction of a dark image."""
        dark = MOSAIC[:, ::-1] / 4096 - 0.01
        self.assert_light(np.maximum(MOSAIC / 4096 - 0.01, 0), self.fits(dark, -32), "--min-value", 0)
        self.assertIn("--min-value 0", self.succeed("info", "clip.stipple"))

    def test_damage(self):
        whole = fits(MOSAIC, 16)
        for length in (0, 80, 2879, 2880, 2880 + 4 * 96 - 1):
            with self.subTest(length=length):
                self.refuse(["damaged or cut short"], self.write("clip.fits", whole[:length]))
        self.refuse(["4 frames of 536862720"], self.write("clip.fits", whole.replace(
            b"NAXIS1  =                    8", b"NAXIS1  =                65535").replace(
            b"NAXIS2  =                    6", b"NAXIS2  =                 4096")))


if __name__ == "__main__":
    unittest.main()
