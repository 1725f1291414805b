"""Recordings of cameras, frame by frame."""

import json
import unittest
import warnings

import numpy as np
import stipple
from program import ProgramTest, project_path


class RecordingTest(ProgramTest):
    def record(self, dn, pixel_format="Mono16"):
        self.write_array("dn.npy", dn, dn.dtype)
        self.figures("capture", "record", "replay:dn.npy", "-o", "clip.strec", "--set",
                     "camera.AcquisitionFrameRate=0", "--set", f"camera.PixelFormat={pixel_format}", "--buffers", 1024, "--frames", len(dn), "--force")
        return self.folder / "clip.strec"

    def test_frames_are_those_that_were_sent(self):
        random = np.random.default_rng(5)
        for name, dn in {"Mono16": random.integers(0, 65536, (6, 5, 8), dtype=np.uint16),
                         "Mono8": random.integers(0, 256, (6, 5, 8), dtype=np.uint8),
                         "RGB8": random.integers(0, 256, (6, 5, 8, 3), dtype=np.uint8)}.items():
            recording = stipple.Recording.open(self.record(dn, name))
            self.assertEqual(recording.camera["transport"], "replay")
            for _ in range(2):  # each time from the beginning
                with self.subTest(name), warnings.catch_warnings():
                    warnings.simplefilter("error")
                    frames = list(recording)
                    self.assertEqual([frame.id for frame in frames], list(range(6)))
                    np.testing.assert_array_equal([frame.dn for frame in frames], dn)
                    self.assertEqual({(frame.format, frame.status, frame.cause, frame.lost_before)
                                      for frame in frames}, {(name, "complete", "none", 0)})
                    self.assertEqual(frames[0].significant_bits, 8 * dn.itemsize)
                    self.assertEqual(frames[1].device_ns - frames[0].device_ns, 5_000_000)

    def test_padding_at_the_end_of_rows_is_no_pixel(self):
        frame, = stipple.Recording.open(project_path("tests/golden/recording/padded_rows.strec"))
        expected = json.loads(project_path("tests/golden/recording/padded_rows.json").read_text())["frames"][0]
        self.assertGreater(expected["stride_bytes"], 2 * expected["width"])
        np.testing.assert_array_equal(frame.dn, expected["samples"])

    def test_is_footage(self):
        dn = np.full((30, 8, 8), 52428, np.uint16)
        recording = stipple.Recording.open(self.record(dn))
        result = stipple.decode(stipple.emulate(recording, "ideal"), "naive")
        self.assertAlmostEqual(float(result[15].mean()), 0.8, delta=0.05)
        with self.assertRaisesRegex(ValueError, "numbers are linear"):
            stipple.emulate(recording, luminance=True)
        self.succeed("emulate", "clip.strec", "-o", "program.stipple")
        stipple.emulate(recording, output=self.folder / "python.stipple")
        self.assertEqual((self.folder / "python.stipple").read_bytes(),
                         (self.folder / "program.stipple").read_bytes())

    def test_damage_costs_its_own_frame_and_is_a_warning(self):
        dn = np.random.default_rng(5).integers(0, 256, (6, 64, 64), dtype=np.uint8)
        path = self.record(dn, "Mono8")
        self.change_byte("clip.strec", path.stat().st_size // 2)
        with self.assertWarnsRegex(UserWarning, "clip.strec: ") as warned:
            frames = list(stipple.Recording.open(path))
        self.assertEqual(len(frames), 5)
        for frame in frames:
            np.testing.assert_array_equal(frame.dn, dn[frame.id])
        self.assertEqual(warned.filename, __file__)

    def test_opens_recordings_only(self):
        with self.assertRaises(FileNotFoundError):
            stipple.Recording.open(self.folder / "none.strec")
        with self.assertRaisesRegex(ValueError, "clip.stipple"):
            stipple.Recording.open(self.folder / self.write_stream())


if __name__ == "__main__":
    unittest.main()
