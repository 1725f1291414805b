"""Images and TIFF stacks that the program writes, as other readers find them."""

import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np
from program import INPUT, USAGE, ProgramTest

try:
    import tifffile
except ImportError:
    tifffile = None

OME = "{http://www.openmicroscopy.org/Schemas/OME/2016-06}"


class ImagesTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.footage = np.random.default_rng(5).random((5, 12, 10, 3)) * 2
        self.decode_as_array(self.footage)

    def decode_as_array(self, footage):
        self.succeed("emulate", self.write_array("light.npy", footage), "-o", "clip.stipple", "-q", "--force", "--sensor",
                     "ideal")
        self.decode("decoded.npy")
        self.light = self.array("decoded.npy")

    def decode(self, output, *options):
        self.succeed("decode", "clip.stipple", "-o", output, "--method", "naive", "-q", "--force", *options)
        return output

    def read_back(self, name):
        self.succeed("emulate", name, "-o", "b.stipple", "-q", "--force", "--truth", "back.npy")
        return self.array("back.npy")

    def test_images_hold_the_light_to_half_a_step(self):
        step = 4 / 65535
        for name, options in (("pngs", ["--images", "png"]), ("tiffs", ["--images", "tiff", "--samples", "u16"]),
                              ("a.tif", ["--samples", "u16"])):
            back = 4 * self.read_back(self.decode(name, *options, "--full-scale", 4))
            np.testing.assert_allclose(back, self.light, atol=step / 2 + 1e-6)
        for name, options in (("exrs", []), ("tiffs", ["--images", "tiff"]), ("a.ome.tif", [])):
            np.testing.assert_array_equal(self.read_back(self.decode(name, *options)), self.light)
        back = self.read_back(self.decode("exrs", "--samples", "f16"))
        np.testing.assert_array_equal(back, self.light.astype(np.float16).astype(np.float32))

    @unittest.skipUnless(tifffile, "python3-tifffile is not installed")
    def test_an_independent_reader_finds_the_stack(self):
        for footage in (self.footage, self.footage[..., 0]):
            self.decode_as_array(footage)
            colour = footage.ndim == 4
            for options, kind in (([], np.float32), (["--samples", "u16", "--full-scale", 4], np.uint16)):
                self.decode("a.ome.tif", "--pixel-um", 6.5, *options)
                with tifffile.TiffFile(self.folder / "a.ome.tif") as stack:
                    self.assertTrue(stack.is_ome and stack.is_bigtiff)
                    series, = stack.series
                    self.assertEqual((series.axes, series.shape), ("TYXS" if colour else "TYX", footage.shape))
                    values = series.asarray()
                    xml = stack.ome_metadata
                self.assertEqual(values.dtype, kind)
                wanted = self.light if kind is np.float32 else self.light * 65535 / 4
                np.testing.assert_allclose(values, wanted, atol=0 if kind is np.float32 else 0.51)
                pixels = ElementTree.fromstring(xml).find(f"{OME}Image/{OME}Pixels")
                self.assertEqual([float(pixels.get(key)) for key in ("TimeIncrement", "PhysicalSizeX", "SizeT")],
                                 [0.005, 6.5, 5])

    @unittest.skipUnless(tifffile, "python3-tifffile is not installed")
    def test_stacks_of_an_independent_writer_are_moments_or_refused(self):
        """Of 4 times and 2 channels, and of one channel of it."""
        stack = (self.footage[:4, ..., :2] * 30000).astype(np.uint16).transpose(0, 3, 1, 2)
        for name, options in (("a.ome.tif", {}), ("a.tif", {}), ("a.tif", {"imagej": True})):
            def write(values, axes):
                tifffile.imwrite(self.folder / name, values, metadata={"axes": axes}, photometric="minisblack",
                                 **options)
            with self.subTest(name=name, **options):
                for values, axes in ((stack, "TCYX"), (stack, "TZYX"), (stack[:, 0], "CYX")):
                    write(values, axes)
                    self.fails(INPUT, [f"{name}: declares ", "each page becomes a moment in time"], "info", name)
                write(stack[:, 0], "TYX")
                np.testing.assert_allclose(self.read_back(name), stack[:, 0] / 65535, atol=1e-6)

    @unittest.skipUnless(tifffile, "python3-tifffile is not installed")
    def test_integers_with_a_colour_profile_look_gamma_coded(self):
        for kind, profile, is_coded in ((np.uint16, b"icc", True), (np.uint16, None, False), (np.float32, b"icc", False)):
            with self.subTest(kind=kind, profile=profile):
                tifffile.imwrite(self.folder / "a.tif", np.ones((12, 10, 3), kind), photometric="rgb",
                                 extratags=[(34675, 7, 3, profile, True)] if profile else [])
                self.assertEqual(self.figures("info", "a.tif")["gamma_coded"], is_coded)

    def test_xml_is_well_formed(self):
        content = (self.folder / self.decode("a.tif")).read_bytes()
        begin = content.rindex(b"<?xml")
        root = ElementTree.fromstring(content[begin:content.index(b"</OME>", begin) + 6])
        pixels = root.find(f"{OME}Image/{OME}Pixels")
        self.assertEqual({key: pixels.get(key) for key in ("SizeX", "SizeY", "SizeC", "SizeT", "Type")},
                         {"SizeX": "10", "SizeY": "12", "SizeC": "3", "SizeT": "5", "Type": "float"})

    def test_options_that_do_nothing_are_refused(self):
        for output, options, text in (("a.npy", ["--images", "png"], "--images"), ("a.npy", ["--samples", "u16"],
                                      "--samples"), ("a", ["--full-scale", 2], "--full-scale"),
                                      ("a.mkv", ["--samples", "f16"], "--samples"),
                                      ("a", ["--pixel-um", 2], "--pixel-um")):
            self.fails(USAGE, [text], "decode", "clip.stipple", "-o", output, *options)
        self.fails(INPUT, ["PNG has integers"], "decode", "clip.stipple", "-o", "a", "--images", "png", "--samples",
                   "f32")


if __name__ == "__main__":
    unittest.main()
