"""stipple export: the samples of a stream as measurements with their masks."""
import unittest

import numpy as np

from program import INPUT, USAGE, ProgramTest

PERIODIC = ["--schedule", "single_bump", "--set", "schedule.period_slots=4", "--set", "schedule.exposure_slots=2"]
NUMBERS = {"first_slot", "slot_us", "electrons_per_unit", "read_noise_e", "gain_e_per_dn", "black_level_dn", "bit_depth",
           "full_well_e", "dark_e_per_slot", "noise_free"}
ARRAYS = {"mask", "meas", "variance", "saturated", "zero"}


def moving_light(slots=26, rows=12, cols=10, peak=0.8):
    rng = np.random.default_rng(3)
    return np.clip(rng.random((rows, cols)) * (0.3 + 0.7 * np.sin(np.arange(slots) / 3) ** 2)[:, None, None], 0.02, peak)


class ExportTest(ProgramTest):
    def emulate(self, light, *options):
        self.write_array("light.npy", light)
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--force", *options)

    def exported(self, *options, file="clip.npz"):
        figures = self.figures("export", "clip.stipple", "-o", file, "--force", *options)
        return figures, dict(np.load(self.folder / file)) if file.endswith(".npz") else figures

    def numbers(self):
        return self.figures("info", "clip.stipple")["calibration"]

    def test_a_measurement_is_the_sum_of_mask_and_light(self):
        light = moving_light()
        self.emulate(light, *PERIODIC, "--sensor", "ideal")
        figures, clip = self.exported()
        self.assertEqual(set(clip), ARRAYS | NUMBERS)
        mask, meas = clip["mask"], clip["meas"]
        self.assertEqual((mask.shape, mask.dtype, meas.shape, meas.dtype), ((4, 12, 10), np.uint8, (6, 12, 10), np.float32))
        self.assertEqual([figures[key] for key in ("rows", "cols", "measurements", "slots", "first_slot", "weighted", "samples", "saturated")],
                         [12, 10, 6, 4, 0, False, 6 * 120, 0])
        sums = np.einsum("trc,mtrc->mrc", mask, light[:24].reshape(6, 4, 12, 10))
        step = clip["gain_e_per_dn"] / clip["electrons_per_unit"]
        self.assertLess(np.abs(meas - sums).max(), 0.5001 * step)  # rounding to a DN

    def test_own_masks_tell_the_exposures_of_any_schedule(self):
        light = moving_light()
        for options in (["--schedule", "tiled"], ["--schedule", "random"], ["--schedule", "two_bucket", "--set", "sensor.charge_stores=2"],
                        PERIODIC):
            with self.subTest(options):
                self.emulate(light, *options, "--sensor", "ideal")
                figures, clip = self.exported("--masks", "own", "--slots", "3:20")
                mask, meas = clip["mask"], clip["meas"]
                self.assertEqual(mask.shape, (figures["measurements"], 17, 12, 10))
                self.assertEqual((clip["first_slot"], figures["samples"]), (3, np.count_nonzero(mask.any(axis=1))))
                self.assertLessEqual(mask.sum(axis=0).max(), 1)  # each voxel is in one exposure
                sums = np.einsum("ktrc,trc->krc", mask, light[3:20])
                step = clip["gain_e_per_dn"] / clip["electrons_per_unit"]
                self.assertLess(np.abs(meas - sums).max(), 0.5001 * step)
                begin = np.where(mask.any(axis=1), mask.argmax(axis=1), 99)
                self.assertTrue((np.diff(begin, axis=0) >= 0).all())

    def test_own_masks_of_periodic_exposures_are_the_shared_ones(self):
        self.emulate(moving_light(), *PERIODIC)
        shared = self.exported("--slots", "4:12")[1]
        own = self.exported("--masks", "own", "--slots", "4:12")[1]
        np.testing.assert_array_equal(own["meas"], shared["meas"])
        np.testing.assert_array_equal(own["mask"][0, :4], shared["mask"])
        np.testing.assert_array_equal(own["mask"][1, 4:], shared["mask"])

    def test_an_import_has_the_samples_of_the_export(self):
        self.emulate(moving_light(), *PERIODIC)
        before = self.exported()[1]
        c = self.numbers()
        self.exported(file="clip.mat")
        made = self.run_program("export", "clip.stipple", "-o", "again.mat")
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertEqual((self.folder / "again.mat").read_bytes(), (self.folder / "clip.mat").read_bytes())
        for file in ("clip.npz", "clip.mat"):
            with self.subTest(file):
                options = ["--light", 1, "--white", 1, "--electrons", c["electrons_per_unit"], "--read-noise", c["read_noise_e"]]
                made = self.run_program("import", file, "-o", "back.stipple", "--force", *map(str, options))
                if "libmatio-dev" in made.stderr:
                    self.skipTest("built without matio")
                self.assertEqual(made.returncode, 0, made.stderr)
                self.succeed("export", "back.stipple", "-o", "back.npz", "--force")
                after = dict(np.load(self.folder / "back.npz"))
                np.testing.assert_array_equal(after["mask"], before["mask"])
                dn = lambda clip: np.round(clip["meas"] * c["electrons_per_unit"] / c["gain_e_per_dn"] + c["black_level_dn"])
                np.testing.assert_array_equal(dn(after), dn(before))
                # One step of 65533 in the variance: rounding of the import instead of that of the chip.
                rounding = (c["gain_e_per_dn"] / c["electrons_per_unit"]) ** 2 / 12
                np.testing.assert_allclose(after["variance"] + rounding, before["variance"], rtol=1e-3)

    def test_scipy_reads_what_numpy_reads(self):
        try:
            from scipy.io import loadmat
        except ImportError:
            self.skipTest("no SciPy")
        self.emulate(moving_light(), "--schedule", "tiled")
        options = ["--masks", "own", "--slots", "2:20"]
        clip = self.exported(*options)[1]
        self.exported(*options, file="clip.mat")
        read = loadmat(self.folder / "clip.mat")
        for name, array in clip.items():
            with self.subTest(name):
                turned = np.atleast_2d(array)
                turned = np.moveaxis(turned, (-2, -1), (0, 1))  # (rows, columns, measurements, slots)
                if turned.ndim == 4:
                    turned = turned.swapaxes(2, 3)
                self.assertEqual(read[name].dtype, array.dtype)
                np.testing.assert_array_equal(read[name], turned)

    def test_weights_and_a_mosaic_are_kept(self):
        rng = np.random.default_rng(1)
        masks = rng.random((4, 12, 10)) + 0.1
        light = rng.random((12, 10))
        self.write_array("masks.npy", masks)
        self.write_array("meas.npy", [(masks * light).sum(axis=0)] * 2)
        self.succeed("import", "meas.npy", "--masks", "masks.npy", "-o", "clip.stipple", "--cfa", "rggb", "--light", "1")
        figures, clip = self.exported()
        self.assertTrue(figures["weighted"])
        self.assertEqual(clip["mask"].dtype, np.float32)
        np.testing.assert_allclose(clip["mask"], masks, rtol=1e-6)
        np.testing.assert_allclose(clip["meas"], self.array("meas.npy"), atol=1e-4)

    def test_bounds_are_marked(self):
        light = np.full((8, 6, 8), 0.1)
        light[:, :3] = 50
        light[:, 3] = 0
        self.emulate(light, *PERIODIC, "--sensor", "ideal")
        figures, clip = self.exported()
        self.assertEqual((figures["saturated"], figures["zeros"]), (2 * 3 * 8, 2 * 8))
        self.assertTrue(clip["saturated"][:, :3].all() and not clip["saturated"][:, 3:].any())
        self.assertTrue(clip["zero"][:, 3].all() and clip["zero"].sum() == 16)

    def test_the_variance_is_that_of_the_noise(self):
        """Of 100 measurements of the same light: 2 % is some ten standard deviations of the mean of 9600 pixels."""
        self.emulate(np.repeat(moving_light(1, 120, 80), 400, axis=0), *PERIODIC)
        clip = self.exported()[1]
        self.assertEqual(len(clip["meas"]), 100)
        self.assertLess(abs(np.var(clip["meas"], axis=0, ddof=1).mean() / clip["variance"].mean() - 1), 0.02)

    def refuse(self, parts, *options, code=INPUT, output="x.npz"):
        self.fails(code, parts, "export", "clip.stipple", "-o", output, *options)
        self.assertNotIn(output, self.names())

    def test_what_cannot_be_expressed_is_refused(self):
        light = moving_light()
        self.emulate(light, "--schedule", "tiled")
        self.refuse(["clip.stipple: pixel (0, 0) has 4 exposures in a period of 15 slots", "--masks own"])
        self.emulate(light, *PERIODIC)
        self.refuse(["--slots", "multiples of the period", "4 slots"], "--slots", "3:")
        self.refuse(["holds 26 slots, not 32"], "--slots", "0:32")
        self.refuse(["holds 26 slots, not 32"], "--slots", "0:32", "--masks", "own")
        self.refuse(["holds 26 slots, not 28"], "--slots", "24:")
        self.refuse(["--slots"], "--slots", "a", code=USAGE)
        self.refuse([".npz or a .mat"], code=USAGE, output="x.npy")
        self.refuse(["--masks"], "--masks", "none", code=USAGE)
        self.emulate(light, *PERIODIC, "--switch", "13:seed=2")
        self.refuse(["clip.stipple", "slot 13"])
        self.exported("--slots", "0:12")
        self.emulate(np.repeat(light[..., None], 3, axis=3), *PERIODIC)
        self.refuse(["clip.stipple: has 3 planes"])
        self.emulate(light[:3], *PERIODIC)
        self.refuse(["holds 3 slots, not 4"])
        self.emulate(light[:1], "--schedule", "full4x")
        self.refuse(["no exposure lies within the 1 slots"], "--masks", "own")

    def test_a_damaged_stream_lacks_its_measurements(self):
        self.emulate(moving_light(40), *PERIODIC)
        self.change_byte("clip.stipple", (self.folder / "clip.stipple").stat().st_size // 2)
        self.refuse(["has no sample of pixel", "--slots"])
        done = self.run_program("export", "clip.stipple", "-o", "own.npz", "--masks", "own")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("clip.stipple", done.stderr)

    def test_an_output_is_replaced_only_with_force(self):
        self.emulate(moving_light(), *PERIODIC)
        self.exported()
        self.fails(INPUT, ["clip.npz", "exists"], "export", "clip.stipple", "-o", "clip.npz")

    def test_archives_of_numpy_are_read(self):
        """Compressed, and with the names of others; damaged ones are named."""
        rng = np.random.default_rng(2)
        masks = rng.random((4, 6, 5))
        meas = np.stack([(masks * light).sum(axis=0) for light in rng.random((3, 6, 5))])
        for save in (np.savez, np.savez_compressed):
            save(self.folder / "clip.npz", meas=meas, masks=masks)
            options = ("--mask-variable", "masks", "-o", "clip.stipple", "--force", "--light", "1", "--noise-free")
            self.assertEqual(self.figures("import", "clip.npz", *options)["measurements"], 3)
            np.testing.assert_allclose(self.exported(file="back.npz")[1]["meas"], meas, atol=1e-4)
            self.fails(INPUT, ['clip.npz: array "mask"', 'is missing; the file holds "meas", "masks"', "--mask-variable"], "import", "clip.npz",
                       "-o", "x.stipple")
            content = (self.folder / "clip.npz").read_bytes()
            for length in np.linspace(0, len(content) - 1, 8).astype(int):
                (self.folder / "cut.npz").write_bytes(content[:length])
                self.fails(INPUT, ["cut.npz"], "import", "cut.npz", *options)
            changed = bytearray(content)
            changed[len(content) // 3] ^= 4
            (self.folder / "changed.npz").write_bytes(changed)
            self.fails(INPUT, ["changed.npz"], "import", "changed.npz", *options)


if __name__ == "__main__":
    unittest.main()
