"""FITS: the light of each kind of number, and what is refused."""

import shutil
import subprocess
import unittest

import numpy as np
from camera_files import MOSAIC, CameraFilesTest
from program import INPUT


def fits(values, bitpix, *cards):
    """A FITS file of the stored numbers (slot, row, col), or (row, col)."""
    kind = {8: "u1", 16: ">i2", 32: ">i4", 64: ">i8", -32: ">f4", -64: ">f8"}[bitpix]
    axes = [f"NAXIS{i + 1:<3}= {size:>20}" for i, size in enumerate(reversed(values.shape))]
    header = [f"SIMPLE  = {'T':>20} / standard", f"BITPIX  = {bitpix:>20}", f"NAXIS   = {len(axes):>20}", *axes,
              "COMMENT = no value", *cards, "END"]
    text = "".join(f"{card:<80}" for card in header).encode()
    data = values.astype(kind).tobytes()
    return text + b" " * (-len(text) % 2880) + data + bytes(-len(data) % 2880)


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
                              ("header without an end", b"SIMPLE  = T" + b" " * (2880 * 1001))):
            with self.subTest(part=part):
                self.refuse([part], self.write("clip.fits", content))
        self.fails(INPUT, ["light is negative"], "emulate", self.fits(MOSAIC - 1, 16), "-o", "x.stipple")
        self.fails(INPUT, ["light is not a number"], "emulate", self.fits(MOSAIC * np.nan, -32), "-o", "x.stipple")

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
