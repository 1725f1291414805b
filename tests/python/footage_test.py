"""Footage of cameras in Python is that of the program: frames without a header, other rates, exposure; and so is
what is wrong with it."""

import unittest
import warnings

import numpy as np
import stipple
from program import ProgramTest

FAST = ["--set", "camera.AcquisitionFrameRate=0", "--buffers", 1024]


class FootageTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.dn = np.random.default_rng(3).integers(0, 4096, (12, 18, 20)).astype("<u2")
        self.dn.tofile(self.folder / "clip.raw")

    def path(self, name):
        return self.folder / name

    def warnings_of(self, call):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            call()
        return [str(warning.message) for warning in told]

    def test_a_file_without_a_header_gives_the_bytes_of_the_program(self):
        raw = "20x18:mono12:black=64:hz=400"
        for resample in ("hold", "blend", "flow"):
            for rate in (400, 100):
                self.succeed("emulate", "clip.raw", "-o", "program.stipple", "--raw", raw, "--scale", 1.5, "--resample",
                             resample, "--frames-hz", rate, "--max-value", 0.9, "--force")
                stream = stipple.emulate(self.path("clip.raw"), raw=raw, scale=1.5, resample=resample, frames_hz=rate,
                                         max_value=0.9, output=self.path("python.stipple"), force=True)
                self.assertEqual(stream.slots(), 12 * 200 // rate)
                self.assertEqual(self.path("python.stipple").read_bytes(), self.path("program.stipple").read_bytes())
        light = np.maximum(self.dn.astype(int) - 64, 0) / (4095 - 64)
        np.testing.assert_allclose(stipple.load(self.path("clip.raw"), raw=raw, scale=3), 3 * light, rtol=1e-6)
        self.assertGreater(stipple.compare(light.astype(np.float32), self.path("clip.raw"), raw=raw).psnr_db, 120)

    def test_an_array_is_resampled_and_scaled_as_its_file(self):
        light = (self.dn / 4095).astype(np.float32)
        self.write_array("light.npy", light)
        for options in ({"resample": "flow", "frames_hz": 50.0}, {"resample": "blend", "frames_hz": 500.0}, {"scale": 0.3}):
            of_file = stipple.emulate(self.path("light.npy"), **options)
            of_array = stipple.emulate(light, **options)
            self.assertEqual(of_array.slots(), of_file.slots())
            for slot in range(of_file.slots()):
                np.testing.assert_array_equal(of_array.samples(slot), of_file.samples(slot))

    def test_negative_light_can_be_clipped(self):
        light = (self.dn / 4095).astype(np.float32) - 0.25
        self.write_array("light.npy", light)
        for video in (light, light.astype(float), self.path("light.npy")):
            np.testing.assert_allclose(stipple.load(video, min_value=0), np.maximum(light, 0), rtol=1e-6)
            np.testing.assert_allclose(stipple.load(video, min_value=0.25, max_value=0.5),
                                       np.clip(light, 0.25, 0.5), rtol=1e-6)
            with self.assertRaisesRegex(ValueError, "light is negative .*clip it with min_value=0"):
                stipple.load(video)
        self.assertTrue(np.any(light < 0))  # arrays of the caller stay as they are
        self.assertGreater(stipple.compare(np.maximum(light, 0), light, min_value=0).psnr_db, 120)

    def test_bad_options(self):
        light = np.zeros((4, 16, 16), np.float32)
        for options, message in (({"scale": 0}, "scale: 0"), ({"scale": np.nan}, "scale"),
                                 ({"scale": 1e39}, "scale: 1e\\+39"), ({"scale": 1e38}, "infinite by scale"),
                                 ({"min_value": -0.1}, "min_value: -0.1"),
                                 ({"min_value": 2, "max_value": 1}, "min_value: 2 is above max_value"),
                                 ({"resample": "flow"}, "resample needs frames_hz"), ({"resample": "flo"}, "resample.*hold"),
                                 ({"resample": "hold", "frames_hz": -5}, "frames_hz: -5"), ({"raw": "4x4:mono8"}, "array"),
                                 ({"resample": "blend", "frames_hz": 1e6}, "shorter than a slot")):
            with self.subTest(options), self.assertRaisesRegex(ValueError, message):
                stipple.emulate(light + 9, **options)
        for raw, message in (("20x18", "pixel format"), ("20x18:mono13", "mono13"), ("7x5:mono8", "offset of raw")):
            with self.assertRaisesRegex(ValueError, message):
                stipple.load(self.path("clip.raw"), raw=raw)

    def test_what_does_not_suit_the_sensor_is_a_warning_with_the_text_of_the_program(self):
        raw = "20x18:mono12:black=64:hz=1000"
        done = self.run_program("emulate", "clip.raw", "-o", "a.stipple", "--raw", raw, "-q")
        told = self.warnings_of(lambda: stipple.emulate(self.path("clip.raw"), raw=raw))
        said = [line.split("clip.raw: ")[1] for line in done.stderr.splitlines()]
        self.assertIn("has 1000 frames/s", said[0])
        self.assertEqual([text.split("clip.raw: ")[1] for text in told],
                         [line.replace("--set sensor.", "sensor setting ").replace("--resample blend", 'resample="blend"')
                          for line in said])
        self.assertEqual(self.warnings_of(lambda: stipple.emulate(self.path("clip.raw"), raw=raw, resample="hold")), [])

    def test_missing_frames_and_damage_of_a_recording_are_warnings(self):
        self.write_array("dn.npy", self.dn / 4095)
        self.succeed("capture", "record", "replay:dn.npy", "-o", "clip.strec", *FAST)
        whole = self.path("clip.strec").read_bytes()
        rates = ("the camera sent",)  # frames as fast as they are taken have any rate

        def told(call):
            return [text for text in self.warnings_of(call) if not any(rate in text for rate in rates)]

        self.assertEqual(told(lambda: stipple.emulate(self.path("clip.strec"))), [])
        at = whole.find(b"\xc5FRM", len(whole) // 2)
        self.path("clip.strec").write_bytes(whole[:at - 1] + bytes([whole[at - 1] ^ 0xFF]) + whole[at:])
        light = np.zeros(self.dn.shape, np.float32)
        for call in (lambda: stipple.emulate(self.path("clip.strec")), lambda: stipple.load(self.path("clip.strec")),
                     lambda: stipple.compare(light, self.path("clip.strec"))):
            text, = told(call)
            self.assertIn("clip.strec: is damaged (1 of its blocks cannot be read), has 1 missing", text)
        np.save(self.path("zero.npy"), light)
        done = self.run_program("compare", "zero.npy", "clip.strec", "-q")
        self.assertIn("clip.strec: is damaged", done.stderr)


if __name__ == "__main__":
    unittest.main()
