"""Export, import and dictionaries have the bytes of the program."""

import unittest

import numpy as np
import stipple
from program import ProgramTest

PERIODIC = ("single_bump", {"period_slots": 4, "exposure_slots": 2})


def moving_light(slots=24, rows=12, cols=10):
    rng = np.random.default_rng(3)
    return (0.1 + 0.8 * rng.random((rows, cols)) * np.sin(np.arange(slots) / 3)[:, None, None] ** 2).astype(np.float32)


def periodic_stream(light, **options):
    schedule = stipple.Schedule(*PERIODIC, size=light.shape[1:3])
    return stipple.emulate(light, schedule=schedule, **options)


class MeasurementsTest(ProgramTest):
    def content(self, name):
        return (self.folder / name).read_bytes()

    def test_an_export_has_the_bytes_and_arrays_of_the_program(self):
        stream = periodic_stream(moving_light(), output=self.folder / "clip.stipple")
        for name in ("a.npz", "a.mat"):
            told = []
            arrays = stipple.export(stream, self.folder / name, slots=range(4, 20), progress=lambda *done: told.append(done))
            self.succeed("export", "clip.stipple", "-o", f"program_{name}", "--slots", "4:20")
            self.assertEqual(self.content(name), self.content(f"program_{name}"))
            self.assertTrue(told)
        self.assert_same(arrays, np.load(self.folder / "a.npz"))
        own = stipple.export(self.folder / "clip.stipple", masks="own", slots=range(5, 20))
        self.succeed("export", "clip.stipple", "-o", "own.npz", "--masks", "own", "--slots", "5:20")
        self.assert_same(own, np.load(self.folder / "own.npz"))

    def assert_same(self, ours, theirs):
        self.assertEqual(list(ours), list(theirs))
        for name, array in ours.items():
            self.assertEqual((array.dtype, array.shape), (theirs[name].dtype, theirs[name].shape), name)
            np.testing.assert_array_equal(array, theirs[name])

    def test_an_import_has_the_bytes_of_the_program(self):
        clip = stipple.export(periodic_stream(moving_light()), self.folder / "clip.npz")
        options = {"light": 1, "white": 1, "electrons": 500, "read_noise": 3, "saturation": 1.5, "slot_us": 2000, "cfa": "grbg"}
        line = [f"--{key.replace('_', '-')}={value}" for key, value in options.items()]
        self.succeed("import", "clip.npz", "-o", "program.stipple", *line)
        stream = stipple.import_measurements(self.folder / "clip.npz", output=self.folder / "a.stipple", **options)
        self.assertEqual(self.content("a.stipple"), self.content("program.stipple"))
        self.assertEqual(stream.figures["measurements"], 6)
        np.save(self.folder / "meas.npy", clip["meas"])
        np.save(self.folder / "mask.npy", clip["mask"])
        self.succeed("import", "meas.npy", "--masks", "mask.npy", "-o", "program.stipple", "--force", "--slots", "3", "--noise-free")
        files = stipple.import_measurements(self.folder / "meas.npy", self.folder / "mask.npy", slots=3, electrons=None,
                                            output=self.folder / "a.stipple", force=True)
        self.assertEqual(self.content("a.stipple"), self.content("program.stipple"))
        arrays = stipple.import_measurements(clip["meas"], clip["mask"], slots=3, electrons=None)
        np.testing.assert_array_equal(arrays.samples(), files.samples())
        self.assertIsNone(arrays.path)
        one = stipple.import_measurements(clip["meas"][0].tolist(), clip["mask"])
        self.assertEqual(one.slots(), 4)

    def test_light_that_rests_comes_back(self):
        rng = np.random.default_rng(5)
        masks, light = rng.random((4, 9, 7)) + 0.1, rng.random((9, 7))
        stream = stipple.import_measurements((masks * light).sum(axis=0), masks, light=1, electrons=None)
        np.testing.assert_allclose(stipple.decode(stream, "naive"), np.repeat(light[None], 4, axis=0), atol=1e-3)
        clip = stipple.export(stream)
        np.testing.assert_allclose((clip["mask"] * light).sum(axis=0), clip["meas"][0], atol=1e-3)

    def test_a_closed_pixel_is_a_warning(self):
        masks = np.ones((2, 3, 3))
        masks[:, 1, 1] = 0
        with self.assertWarnsRegex(UserWarning, "masks of 1 pixel are 0"):
            stipple.import_measurements(np.ones((3, 3)), masks)

    def test_wrong_arguments_of_an_import_are_named(self):
        good = np.ones((2, 4, 5))
        file = self.folder / "meas.npy"
        np.save(file, good)
        for error, text, measurements, masks, options in (
                (ValueError, r"measurements: has the shape \(5\)", np.ones(5), good, {}),
                (ValueError, r"masks: has the shape \(4, 5\), not \(layers", good, good[0], {}),
                (ValueError, "2 measurements of 4 x 5", good, np.ones((2, 4, 6)), {}),
                (ValueError, "measurements: measurement 1 pixel", [good[0], good[0] * np.nan], good, {}),
                (ValueError, "is not a weight", good, -good, {}),
                (ValueError, "electrons: 0 is outside", good, good, {"electrons": 0}),
                (ValueError, "light: nan is outside", good, good, {"light": np.nan}),
                (ValueError, "slots: 0 is outside", good, good, {"slots": 0}),
                (ValueError, "has 2 masks, fewer than slots=3", good, good, {"slots": 3}),
                (ValueError, 'cfa: "rgb" is none of', good, good, {"cfa": "rgb"}),
                (ValueError, "a sample stream is a .stipple", good, good, {"output": "a.npz"}),
                (TypeError, "arrays for both", good, "masks.npy", {}),
                (TypeError, "arrays for both", good, None, {}),
                (TypeError, "measurements: complex128 are no real numbers", good.astype(complex), good, {}),
                (ValueError, "masks: may have masked values", good, np.ma.masked_less(good, 2), {}),
                (ValueError, "masks: is needed", file, None, {}),
                (FileNotFoundError, "none.npz", "none.npz", None, {})):
            with self.subTest(text):
                with self.assertRaisesRegex(error, text):
                    stipple.import_measurements(measurements, masks, **options)

    def test_wrong_arguments_of_an_export_are_named(self):
        stream = periodic_stream(moving_light())
        tiled = stipple.emulate(moving_light(), schedule="tiled")
        for error, text, source, options in (
                (ValueError, 'pixel .0, 0. has 4 exposures .* masks="own" gives', tiled, {}),
                (ValueError, 'masks: "both" is none of shared, own', stream, {"masks": "both"}),
                (ValueError, r"slots: range\(4, 4\) holds no slot", stream, {"slots": range(4, 4)}),
                (ValueError, "slots: begin and end", stream, {"slots": range(1, 4)}),
                (ValueError, "holds 24 slots, not 28; export others with slots", stream, {"slots": range(0, 28)}),
                (TypeError, r"slots: \(0, 4\) is not range", stream, {"slots": (0, 4)}),
                (TypeError, "slots", stream, {"slots": range(0, 8, 2)}),
                (ValueError, "a .npz or a .mat", stream, {"output": "a.npy"}),
                (FileNotFoundError, "none.stcal", stream, {"calibration": "none.stcal"}),
                (FileNotFoundError, "clip.npz", stream, {"output": "none/clip.npz"}),
                (FileNotFoundError, "none.stipple", "none.stipple", {})):
            with self.subTest(text):
                with self.assertRaisesRegex(error, text):
                    stipple.export(source, **options)
        stipple.export(stream, self.folder / "a.npz")
        with self.assertRaises(FileExistsError):
            stipple.export(stream, self.folder / "a.npz")

        def stop(*done):
            raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            stipple.export(stream, self.folder / "b.npz", progress=stop)
        self.assertEqual(self.names(), ["a.npz"])


class DictionaryTest(ProgramTest):
    OPTIONS = {"slots": 4, "side": 3, "atoms": 24, "iterations": 4, "patches": 500}

    def test_a_dictionary_has_the_bytes_of_the_program(self):
        slot, row, col = np.mgrid[0:16, 0:20, 0:24]
        wave = (0.5 + 0.2 * np.sin(0.7 * (col + 0.5 * slot)) + 0.2 * np.cos(0.5 * (row - slot))).astype(np.float32)
        np.save(self.folder / "wave.npy", wave)
        np.save(self.folder / "turned.npy", wave[:, ::-1])
        line = [f"--{key}={value}" for key, value in self.OPTIONS.items()]
        self.succeed("dictionary", "wave.npy", "turned.npy", "-o", "program.npy", *line, "--seed", "5")
        told = []
        learnt = stipple.dictionary([wave, self.folder / "turned.npy"], self.folder / "a.npy", seed=5, **self.OPTIONS,
                                    progress=lambda *done: told.append(done))
        self.assertEqual((self.folder / "a.npy").read_bytes(), (self.folder / "program.npy").read_bytes())
        np.testing.assert_array_equal(learnt, np.load(self.folder / "a.npy"))
        self.assertEqual((learnt.shape, told[-1]), ((24, 4, 9), (4.0, 4)))
        np.testing.assert_array_equal(stipple.dictionary([wave, wave[:, ::-1]], seed=5, threads=1, **self.OPTIONS), learnt)

    def test_wrong_arguments_are_named(self):
        light = np.random.default_rng(1).random((9, 20, 24), dtype=np.float32)
        for error, text, footage, options in (
                (ValueError, "video: has 3 frames, a patch 8; give slots", light[:3], {}),
                (ValueError, "24 x 20 are smaller than a patch of 21 x 21 pixels; give side", light, {"side": 21}),
                (ValueError, "0 patches with contrast are too few for 512 atoms", np.ones_like(light), {}),
                (ValueError, "side: 1 is outside 2..32", light, {"side": 1}),
                (TypeError, "atoms: 2.5 is not a whole number", light, {"atoms": 2.5}),
                (ValueError, "a dictionary is a .npy", light, {"output": "a.txt"}),
                (FileNotFoundError, "none.npy", "none.npy", {})):
            with self.subTest(text), self.assertRaisesRegex(error, text):
                stipple.dictionary(footage, **options)

        def stop(*done):
            raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            stipple.dictionary(light, self.folder / "a.npy", **self.OPTIONS, progress=stop)
        self.assertEqual(self.names(), [])


if __name__ == "__main__":
    unittest.main()
