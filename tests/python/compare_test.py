"""Figures of quality are those of the program."""

import math
import os
import signal
import threading
import unittest

import numpy as np
import stipple
from program import ProgramTest

KEYS = ("psnr_db", "psnr_gamma_db", "psnr_frame_mean_db", "pu21_psnr_db", "ssim")


class CompareTest(ProgramTest):
    def setUp(self):
        super().setUp()
        random = np.random.default_rng(3)
        self.a = random.random((6, 16, 20, 3), dtype=np.float32)
        self.b = np.clip(self.a + random.normal(0, 0.05, self.a.shape), 0, 2).astype(np.float32)
        self.write_array("a.npy", self.a)
        self.write_array("b.npy", self.b)

    def same(self, quality, figures):
        for key in KEYS:
            self.assertEqual(getattr(quality, key), figures[key], key)

    def test_figures_are_those_of_the_program(self):
        self.same(stipple.compare(self.a, self.b), self.figures("compare", "a.npy", "b.npy"))
        self.same(stipple.compare(self.folder / "a.npy", self.b, margin=1, max_value=0.8, peak=0.8,
                                  cd_per_unit=1000, until=5, luminance=True, transfer="gamma22"),
                  self.figures("compare", "a.npy", "b.npy", "--margin", 1, "--max-value", 0.8, "--peak", 0.8,
                               "--cd-per-unit", 1000, "--until", 5, "--luminance", "--transfer", "gamma22"))

    def test_psnr_is_that_of_its_formula(self):
        error = (self.a.astype(float) - self.b) ** 2
        self.assertAlmostEqual(stipple.compare(self.a, self.b).psnr_db, -10 * math.log10(error.mean()), 6)
        self.assertEqual(stipple.compare(self.a, self.a).psnr_db, math.inf)

    def test_each_frame_has_its_figures(self):
        options = {"pu21_ssim": True, "pixels_per_degree": 60}
        whole = stipple.compare(self.a, self.b, margin=1, **options)
        self.assertEqual(len(whole.frames), 4)
        for slot, frame in enumerate(whole.frames, start=1):
            alone = stipple.compare(self.a[slot:slot + 1], self.b[slot:slot + 1], **options)
            for key in (*KEYS, "pu21_ssim", "pu21_csf_psnr_db"):
                self.assertEqual(getattr(frame, key), getattr(alone, key), key)
        self.assertIsNone(stipple.compare(self.a, self.b).pu21_ssim)

    def test_the_frames_that_both_have_are_compared(self):
        same = stipple.compare(self.a, self.b, until=5)
        for videos in ((self.a[:5], self.b), (self.a, self.b[:5])):
            with self.assertWarnsRegex(UserWarning, "ends after 5 frames, before the other does"):
                self.assertEqual(stipple.compare(*videos).ssim, same.ssim)

    def test_an_argument_out_of_its_range_is_named(self):
        for name, value in {"until": 0, "cd_per_unit": -1, "pixels_per_degree": math.inf, "peak": 0}.items():
            with self.subTest(name), self.assertRaisesRegex(ValueError, f"^{name}: {value:g} is not"):
                stipple.compare(self.a, self.b, **{name: value})

    def test_the_light_of_the_result_may_be_negative(self):
        self.write_array("negative.npy", self.a - 0.5)
        self.same(stipple.compare(self.a - np.float32(0.5), self.b), self.figures("compare", "negative.npy", "b.npy"))
        with self.assertRaisesRegex(ValueError, "light is negative"):
            stipple.compare(self.b, self.a - np.float32(0.5))

    def test_control_c_ends_it(self):
        """Without, it would take days, and so does making a stream of as much light."""
        # Where a shell's background job ignores it, Python has no handler of its own.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        endless = np.broadcast_to(np.float32(0.5), (10**9, 16, 16))
        for call in (lambda: stipple.compare(endless, endless), lambda: stipple.emulate(endless)):
            # From another thread, which runs as long calls let others run.
            timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                call()
            timer.join()

    def test_refuses_videos_that_do_not_match(self):
        for message, arguments in {
                "has frames of 20 x 16 x 1": (self.a[..., 0], self.b)}.items():
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                stipple.compare(*arguments)
        for message, options in {"ends after 6 frames, before until=7": {"until": 7},
                                 "margin": {"margin": 3}, "peak": {"peak": 0}}.items():
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                stipple.compare(self.a, self.b, **options)


if __name__ == "__main__":
    unittest.main()
