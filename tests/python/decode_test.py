"""Decoding in Python gives the video of the program, and can be interrupted."""

import os
import signal
import threading
import time
import unittest

import numpy as np
import stipple
from program import ProgramTest


class DecodeTest(ProgramTest):
    def write_clip(self, slots=36, planes=None, **options):
        """A bar that moves a pixel a slot."""
        frames = np.full((slots, 24, 32), 0.2, np.float32)
        for slot in range(slots):
            frames[slot, :, slot % 32] = 0.9
        if planes:
            frames = np.stack([frames, frames[:, ::-1], frames / 2], axis=3)
        stipple.emulate(frames, output=self.folder / "clip.stipple", **options)
        return frames

    def program_decodes(self, *arguments):
        self.succeed("decode", "clip.stipple", "-o", "program.npy", "--force", *arguments)
        return self.array("program.npy")

    def decodes(self, *arguments, **options):
        return stipple.decode(self.folder / "clip.stipple", *arguments, **options)

    def test_a_calibrated_chip_decodes_as_in_the_program(self):
        self.write_flat("light.npy", 20, 8, 8, 0.8)
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--sensor", "t6", "--force")
        self.succeed("calibrate", "--sensor", "t6", "--size", "8x8", "-o", "chip.stcal")
        result = self.decodes("naive", calibration=self.folder / "chip.stcal")
        np.testing.assert_array_equal(
            result, self.program_decodes("--method", "naive", "--calibration", "chip.stcal"))
        with self.assertRaisesRegex(ValueError, "clip.stipple: is not a calibration file"):
            self.decodes("naive", calibration=self.folder / "clip.stipple")
        with self.assertRaises(FileNotFoundError):
            self.decodes("naive", calibration=self.folder / "none.stcal")

    def test_a_bent_chip_and_a_calibration_beside_the_stream_decode_as_in_the_program(self):
        bent = ("--set", "sensor.response_loss=0.2")
        self.write_flat("light.npy", 20, 8, 8, 0.8)
        self.succeed("calibrate", "--sensor", "t6", "--size", "8x8", *bent, "-o", "chip.stcal")
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--sensor", "t6", *bent, "--calibration",
                     "chip.stcal")
        result = self.decodes("naive")
        np.testing.assert_array_equal(result, self.program_decodes("--method", "naive"))
        np.testing.assert_array_equal(result, self.decodes("naive", calibration=self.folder / "chip.stcal"))
        plain = self.decodes("naive", calibration="none")
        np.testing.assert_array_equal(
            plain, self.program_decodes("--method", "naive", "--calibration", "none"))
        self.assertGreater(np.abs(plain - result).max(), 0.01)

    def test_each_method_gives_the_values_of_the_program(self):
        self.write_clip()
        for method in ("naive", "fast", "best", "reddy2011"):
            self.assertIn(method, stipple.decode_methods())
            with self.subTest(method):
                result = self.decodes(method)
                self.assertEqual(result.dtype, np.float32)
                np.testing.assert_array_equal(result, self.program_decodes("--method", method))

    def test_options_are_those_of_the_program(self):
        self.write_clip()
        wanted = self.program_decodes("--method", "fast", "--set", "decoder.rounds=1", "--until", 20)
        result = self.decodes("fast", {"rounds": 1}, until=20, threads=1)
        self.assertEqual(result.shape, (20, 24, 32))
        np.testing.assert_array_equal(result, wanted)

    def test_colour_has_its_planes_last(self):
        for sensor in ("paper", "t6"):
            with self.subTest(sensor):
                frames = self.write_clip(planes=3, sensor=sensor, force=True)
                result = self.decodes("fast")
                self.assertEqual(result.shape, frames.shape)
                np.testing.assert_array_equal(result, self.program_decodes("--method", "fast"))
                # As it was decoded: plane by plane.
                self.assertTrue(result.transpose(0, 3, 1, 2).flags.c_contiguous)

    def test_the_result_outlives_the_stream(self):
        result = stipple.decode(stipple.emulate(np.full((30, 8, 8), 0.5, np.float32), "ideal"), "naive")
        self.assertTrue(result.flags.writeable)
        self.assertAlmostEqual(float(result[15].mean()), 0.5, delta=0.05)

    def test_damage_is_a_warning_or_an_error(self):
        self.write_clip()
        whole = self.decodes("naive")
        size = (self.folder / "clip.stipple").stat().st_size
        self.change_byte("clip.stipple", size // 2)
        with self.assertWarnsRegex(UserWarning, "1 of 36 slots are incomplete"):
            damaged = self.decodes("naive")
        self.assertEqual(damaged.shape, whole.shape)
        self.assertFalse(np.array_equal(damaged, whole))
        with self.assertRaisesRegex(ValueError, "clip.stipple: byte"):
            self.decodes("naive", strict=True)

    def test_a_stream_that_was_cut_off_is_warned_of(self):
        self.write_clip()
        path = self.folder / "clip.stipple"
        whole = path.read_bytes()
        said = set()
        for cut in range(1, 900):
            path.write_bytes(whole[:-cut])
            counts = stipple.Stream.open(path).counts()
            self.assertFalse(counts["complete"] and counts["tail_bytes"])
            if counts["complete"] or counts["damage"]:
                continue
            wanted = "ends within a packet" if counts["tail_bytes"] else "has no end marker"
            if wanted not in said:
                with self.assertWarnsRegex(UserWarning, wanted):
                    self.decodes("naive")
                said.add(wanted)
        self.assertEqual(len(said), 2)

    def test_refuses_what_the_program_refuses(self):
        self.write_clip()
        with self.assertRaisesRegex(ValueError, '"nave" is unknown; did you mean "naive"'):
            self.decodes("nave")
        with self.assertRaisesRegex(ValueError, "decoder setting round: is unknown"):
            self.decodes("fast", {"round": 1})
        with self.assertRaisesRegex(ValueError, 'options: hitomi2011 needs {"dictionary": FILE}'):
            self.decodes("hitomi2011")
        with self.assertRaisesRegex(ValueError, "until: 0 is not above 0"):
            self.decodes("fast", until=0)
        with self.assertRaises(FileNotFoundError):
            stipple.decode(self.folder / "none.stipple")
        self.write_array("no.npy", [1.0])
        with self.assertRaisesRegex(ValueError, "no.npy"):
            stipple.decode(self.folder / "no.npy")

    def test_progress_is_told_and_may_end_it(self):
        self.write_clip()
        told = []
        self.decodes("fast", progress=lambda done, total: told.append((done, total)))
        self.assertEqual(told, sorted(told))
        self.assertEqual(told[-1], (36, 36))
        told.clear()
        self.decodes("best", until=5, progress=lambda done, total: told.append((done, total)))
        self.assertEqual({done > 5 for done, total in told}, {False})
        self.assertEqual(told[-1], (5, 5))

        def stop(done, total):
            raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            self.decodes("fast", progress=stop)

    def test_control_c_ends_it(self):
        """A thread sends the signal, which it can as the decoder lets other threads run."""
        stream = stipple.emulate(np.random.default_rng(1).random((120, 120, 160), dtype=np.float32))
        finished = threading.Event()

        def interrupt():
            time.sleep(0.5)
            self.assertFalse(finished.is_set(), "the clip is too short for this test")
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=interrupt)
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            stipple.decode(stream, "best")
            finished.set()
        thread.join()


if __name__ == "__main__":
    unittest.main()
