"""stipple import: measurements of a coded aperture with its masks."""
import struct
import unittest

import numpy as np

from program import INPUT, USAGE, ProgramTest


def element(kind, content):
    """A data element of a MATLAB 5 file, padded to 8 bytes."""
    return struct.pack("<II", kind, len(content)) + content + b"\0" * (-len(content) % 8)


def matrix(name, values, flags=6, kind=9, form="<f8", more=()):
    """A variable: array flags with its class, dimensions, name and values with the first dimension fastest."""
    dims = struct.pack(f"<{values.ndim}i", *values.shape)
    parts = (element(6, struct.pack("<II", flags, 1)), element(5, dims), element(1, name.encode()), *more,
             element(kind, values.astype(form).tobytes(order="F")))
    return element(14, b"".join(parts))


MAT_HEAD = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49)


def mat_file(**arrays):
    return MAT_HEAD + b"".join(matrix(name, values) for name, values in arrays.items())


# Measured PSNR of test_every_method_finds_light_that_rests.
MEASURED_DB = {"naive": 102.1, "fast": 54.2, "best": 49.7, "portz2013": 51.0, "reddy2011": 49.7}


class ImportTest(ProgramTest):
    def setUp(self):
        super().setUp()
        rng = np.random.default_rng(1)
        self.masks = rng.random((4, 12, 10)) * (rng.random((4, 12, 10)) < 0.9)
        self.masks[0] += 0.1  # every pixel is open somewhere
        self.light = rng.random((12, 10))
        self.measurements = np.stack([(self.masks * k * self.light).sum(axis=0) for k in (1, 0.5, 0.25)])

    def write(self, measurements=None, masks=None, dtype=np.float64):
        self.write_array("meas.npy", self.measurements if measurements is None else measurements, dtype)
        self.write_array("masks.npy", self.masks if masks is None else masks, dtype)

    def imported(self, *options):
        return self.figures("import", "meas.npy", "--masks", "masks.npy", "-o", "clip.stipple", "--force", *options)

    def decoded(self, method="naive"):
        self.succeed("decode", "clip.stipple", "-o", "out.npy", "--method", method, "--force")
        return self.array("out.npy")

    def test_measurements_at_rest_decode_to_their_light(self):
        self.write()
        figures = self.imported("--noise-free")
        self.assertEqual([figures[key] for key in ("measurements", "slots", "weighted", "light", "unread_pixels")],
                         [3, 12, True, 1, 0])
        self.assertAlmostEqual(figures["light_throughput"], self.masks.mean(), delta=1e-6)
        info = self.figures("info", "clip.stipple")
        self.assertEqual((info["version"], info["schedule"]["weighted"], info["calibration"]["noise_free"]),
                         (3, True, True))
        # The naive estimate of one measurement is the sample by the sum of its weights.
        weight = self.masks.sum(axis=0)
        step = self.measurements.max() / 65533
        self.write(self.measurements[:1])
        self.imported("--noise-free")
        self.assertLess((np.abs(self.decoded() - self.light) * weight).max(), 0.51 * step)

    def test_numbers_of_images_are_taken_by_their_white(self):
        self.write(np.round(self.measurements * 255), np.round(self.masks * 200))
        figures = self.imported()
        self.assertEqual((figures["light"], figures["noise_free"]), (255, False))
        self.assertAlmostEqual(figures["light_throughput"], np.round(self.masks * 200).mean() / 255, delta=1e-6)
        figures = self.imported("--light", "100", "--white", "200", "--electrons", "5000", "--read-noise", "3")
        self.assertEqual(figures["light"], 100)
        calibration = self.figures("info", "clip.stipple")["calibration"]
        self.assertEqual((calibration["electrons_per_unit"], calibration["read_noise_e"]), (5000, 3))

    def test_the_first_masks_of_a_file_can_be_taken(self):
        """As of data sets with 50 masks, of which a measurement of 10 slots uses the first 10."""
        self.write()
        all_masks = self.imported("--noise-free")
        first = self.decoded()
        more = np.concatenate([self.masks, np.full((3, 12, 10), 200.0)])  # white: as of the first only
        self.write(masks=more)
        self.assertEqual(self.imported("--noise-free", "--slots", "4"), all_masks)
        np.testing.assert_array_equal(self.decoded(), first)
        self.assertEqual(self.imported("--slots", "7")["slots"], 21)
        self.refuse(["masks.npy", "has 7 masks, fewer than --slots 8"], masks=more, options=("--slots", "8"))
        self.fails(USAGE, ["--slots"], "import", "meas.npy", "--masks", "masks.npy", "-o", "x.stipple", "--slots", "0")

    def test_negative_measurements_have_a_black_level(self):
        self.measurements[:, 3, 4] = -0.2
        self.write()
        self.imported("--noise-free")
        black = self.figures("info", "clip.stipple")["calibration"]["black_level_dn"]
        self.assertAlmostEqual(black, 1 + 0.2 * 65533 / (self.measurements.max() + 0.2), places=6)
        self.assertLess(self.decoded()[:, 3, 4].max(), 1e-6)

    def test_clipped_measurements_are_lower_bounds(self):
        self.write()
        limit = np.median(self.measurements)
        self.imported("--saturation", str(limit))
        figures = self.figures("decode", "clip.stipple", "-o", "out.npy", "--method", "naive")
        self.assertEqual(figures["saturated_fraction"], np.mean(self.measurements >= limit))

    def test_a_pixel_without_light_is_left_out(self):
        self.masks[:, 2, 3] = 0
        self.measurements[1, 2, 3] = np.nan
        self.write()
        self.assertEqual(self.imported()["unread_pixels"], 1)

    def test_a_mosaic_decodes_to_colours(self):
        self.write()
        self.imported("--cfa", "rggb")
        self.assertEqual(self.decoded().shape, (12, 12, 10, 3))

    def test_every_method_finds_light_that_rests(self):
        row, col = np.mgrid[:32, :32]
        light = 0.5 + 0.4 * np.sin(col / 3) * np.cos(row / 4)
        masks = np.random.default_rng(1).random((4, 32, 32))
        self.write([(masks * light).sum(axis=0)] * 3, masks)
        self.imported()
        for method, psnr_db in MEASURED_DB.items():
            error = self.decoded(method) - light
            self.assertGreater(-10 * np.log10(np.mean(error**2)), psnr_db - 0.3, method)

    def refuse(self, parts, measurements=None, masks=None, options=()):
        self.write(measurements, masks)
        self.fails(INPUT, parts, "import", "meas.npy", "--masks", "masks.npy", "-o", "x.stipple", *options)

    def test_wrong_arrays_are_named(self):
        self.refuse(["meas.npy", "3 measurements of 12 x 9", "4 masks of", "12 x 10"], self.measurements[:, :, :9])
        self.refuse(["meas.npy", "10 measurements of 3 x 12"], np.moveaxis(self.measurements, 2, 0))
        self.refuse(["meas.npy", "no measurement is above 0"], np.zeros((1, 12, 10)))
        self.refuse(["masks.npy", "all weights are 0"], masks=np.zeros((4, 12, 10)))
        self.refuse(["masks.npy", "2 dimensions"], masks=self.masks[0])
        for value in (-0.01, 2e6, np.nan, np.inf):
            masks = self.masks.copy()
            masks[2, 5, 6] = value
            self.refuse(["masks.npy", "pixel (5, 6) slot 2", "is not a weight"], masks=masks)
        for value in (np.nan, np.inf):
            self.measurements[1, 5, 6] = value
            self.refuse(["meas.npy", "measurement 1 pixel (5, 6)", "is not a number"])

    def test_masks_are_needed(self):
        self.write()
        self.fails(INPUT, ["--masks", ".mat"], "import", "meas.npy", "-o", "x.stipple")
        self.fails(USAGE, ["--electrons", "--noise-free"], "import", "meas.npy", "--masks", "masks.npy", "-o",
                   "x.stipple", "--noise-free", "--electrons", "5")

    def test_a_mat_file_holds_the_same(self):
        """Or the program says that it cannot read one."""
        content = mat_file(meas=np.moveaxis(self.measurements, 0, 2), mask=np.moveaxis(self.masks, 0, 2))
        (self.folder / "clip.mat").write_bytes(content)
        made = self.run_program("import", "clip.mat", "-o", "mat.stipple", "--noise-free")
        if "libmatio-dev" in made.stderr:
            self.assertEqual(made.returncode, INPUT)
            self.skipTest("built without matio")
        self.assertEqual(made.returncode, 0, made.stderr)
        self.write()
        self.imported("--noise-free")
        self.succeed("decode", "mat.stipple", "-o", "mat.npy", "--method", "naive")
        np.testing.assert_array_equal(self.array("mat.npy"), self.decoded())
        self.fails(INPUT, ['variable "orig": is missing', 'holds "meas", "mask"'], "import", "clip.mat", "-o", "x.stipple", "--variable", "orig")
        masks = np.moveaxis(self.masks > 0.1, 0, 2)
        for flags, kind, form in ((6, 9, "<f8"), (9 | 0x200, 2, "u1"), (10, 3, "<i2"), (14, 12, "<i8"), (15, 13, "<u8"), (7, 7, "<f4")):
            with self.subTest(form=form):  # double, logical, int16, int64, uint64, single
                (self.folder / "clip.mat").write_bytes(mat_file(meas=np.moveaxis(self.measurements, 0, 2)) +
                                                       matrix("mask", masks, flags, kind, form))
                self.succeed("import", "clip.mat", "-o", "mat.stipple", "--noise-free", "--force")
                self.succeed("decode", "mat.stipple", "-o", "kind.npy", "--method", "naive", "--force")
                of_doubles = self.array("kind.npy") if flags == 6 else of_doubles
                np.testing.assert_array_equal(self.array("kind.npy"), of_doubles)
        ones = np.ones((4, 4))
        sparse = [element(5, struct.pack("<4i", *range(4))), element(5, struct.pack("<5i", *range(5)))]
        for part, variable in (("complex numbers", matrix("meas", ones, 6 | 0x800, more=[element(9, bytes(128))])),
                               ("sparse array; save full(x)", matrix("meas", ones[0, None].T * ones[0], 5, more=sparse)),
                               ("is text, a cell", matrix("meas", ones, 4, 4, "<u2"))):
            with self.subTest(part=part):
                (self.folder / "kind.mat").write_bytes(MAT_HEAD + variable)
                self.fails(INPUT, ['kind.mat: variable "meas"', part], "import", "kind.mat", "-o", "x.stipple")
        for length in (0, 60, 128, 200, len(content) - 200):
            (self.folder / "cut.mat").write_bytes(content[:length])
            self.fails(INPUT, ["cut.mat"], "import", "cut.mat", "-o", "x.stipple")


if __name__ == "__main__":
    unittest.main()
