"""Scenes and rigs in Python are those of the program."""

import unittest

import numpy as np

import stipple
from program import ProgramTest


class SceneTest(ProgramTest):
    def test_a_scene_is_that_of_the_program(self):
        for more, arguments in (({}, ()), ({"luminance": True, "seed": 7}, ("--luminance", "--seed", 7))):
            self.succeed("synth", "dice", "-o", "scene.npy", "--frames", 3, "--size", "40x24", "--force", *arguments)
            scene = stipple.synth("dice", frames=3, size=(24, 40), **more)
            self.assertEqual(scene.dtype, np.float32)
            np.testing.assert_array_equal(scene, self.array("scene.npy"))

    def test_bad_input(self):
        for arguments, message in (({"scene": "nosuch"}, "nosuch"), ({"scene": "pan", "frames": 0}, "slots"),
                                   ({"scene": "pan", "size": (4, 40)}, "8"), ({"scene": "pan", "seed": -1}, "seed")):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                stipple.synth(**arguments)
        with self.assertRaisesRegex(TypeError, "size: 5 is not"):
            stipple.synth("pan", size=5)
        with self.assertRaises(ZeroDivisionError):
            stipple.synth("pan", frames=10000, size=(64, 64), luminance=True, progress=lambda done, slots: 1 / 0)


class RigTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.light = self.write_array("light.npy", np.random.default_rng(1).random((24, 16, 24)))

    def test_streams_and_video_are_those_of_the_program(self):
        told = self.figures("emulate", self.light, "-o", "program", "--rig", "tocci2011_slow", "--set", "rig.high.share=0.5")
        figures = stipple.emulate_rig(self.folder / self.light, "tocci2011_slow", self.folder / "python", {"high.share": 0.5})
        for sensor, of_program in zip(figures["sensors"], told["sensors"], strict=True):
            self.assertEqual(sensor, {name: of_program[name] for name in sensor})
        for name in set(figures) - {"sensors"}:
            self.assertEqual(figures[name], told[name])
        for file in sorted((self.folder / "program").iterdir()):
            self.assertEqual((self.folder / "python" / file.name).read_bytes(), file.read_bytes(), file.name)
        self.succeed("decode", "program", "-o", "program.npy", "--method", "fast")
        np.testing.assert_array_equal(stipple.decode(self.folder / "python", "fast"), self.array("program.npy"))

    def test_arrays_are_emulated_to_the_same_samples(self):
        video = self.array(self.light)
        stipple.emulate_rig(video, "tocci2011_slow", self.folder / "array")
        stipple.emulate_rig(self.folder / self.light, "tocci2011_slow", self.folder / "file")
        for name in sorted(path.name for path in (self.folder / "file").glob("*.stipple")):
            array, file = (stipple.Stream.open(self.folder / folder / name) for folder in ("array", "file"))
            for a, b in zip(array, file, strict=True):
                np.testing.assert_array_equal(a, b)

    def test_bad_input_leaves_nothing(self):
        before = self.names()
        for rig, settings, message in (("nosuch", {}, "nosuch"), ("tocci2011_slow", {"high.share": 5}, "share")):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                stipple.emulate_rig(self.folder / self.light, rig, self.folder / "out", settings)
        with self.assertRaises(ZeroDivisionError):
            stipple.emulate_rig(np.zeros((20000, 16, 24), np.float32), "tocci2011_slow", self.folder / "out",
                                progress=lambda done, slots: 1 / 0)
        self.assertEqual(self.names(), before)
        stipple.emulate_rig(self.folder / self.light, "tocci2011_slow", self.folder / "out")
        with self.assertRaises(FileExistsError):
            stipple.emulate_rig(self.folder / self.light, "tocci2011_slow", self.folder / "out")
        with self.assertRaisesRegex(ValueError, "calibration: is of one stream"):
            stipple.decode(self.folder / "out", "fast", calibration="none")


if __name__ == "__main__":
    unittest.main()
