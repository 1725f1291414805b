"""Footage in, stream, video out: figures that follow from the definitions."""

import json
import math
import os
import struct
import subprocess
import time
import unittest

import numpy as np
from program import ProgramTest

EXACT = ["--set", "sensor.shot_noise=false", "--set", "sensor.read_noise_e=0"]
STEP = 2000 / 255 / 1000  # one DN of the default sensor in units of light


class PipelineTest(ProgramTest):
    def test_a_conventional_camera_reads_every_pixel_every_fourth_slot(self):
        light = self.write_flat("light.npy", slots=8, rows=3, cols=5, light=1)
        figures = self.figures("emulate", light, "-o", "a.stipple", "--schedule", "full4x", *EXACT)
        self.assertEqual(figures["slots"], 8)
        self.assertEqual(figures["samples"], 2 * 15)
        self.assertEqual(figures["payload_bits"], 2 * 15 * 8)
        self.assertEqual(figures["compression_ratio"], 4)
        self.assertEqual(figures["light_throughput"], 1)
        self.assertEqual(figures["saturated_fraction"], 1)  # 4000 e, 2000 e are full scale
        figures = self.figures("emulate", light, "-o", "b.stipple", "--schedule", "full1x", *EXACT)
        self.assertEqual(figures["light_throughput"], 0.25)
        self.assertEqual(figures["saturated_fraction"], 0)
        self.assertAlmostEqual(figures["samples_per_second"] / figures["slots_per_second"], 2 * 15 / 8)

    def test_light_throughput_counts_filters(self):
        def light(slots, *arguments, rows=4, cols=6):
            flat = self.write_flat("light.npy", slots=slots, rows=rows, cols=cols)
            figures = self.figures("emulate", flat, "-o", "a.stipple", "--force", *arguments)
            return figures["light_throughput"], figures["light_read"]

        self.assertEqual(light(10, "--schedule", "full4x"), (1, 8 / 10))
        self.assertEqual(light(10, "--schedule", "full1x"), (1 / 4, 3 / 10))
        self.assertEqual(light(3, "--schedule", "full4x"), (1, 0))
        mosaic = np.array([[1, 1 / 2], [1 / 4, 1 / 8]])
        filters = ["--sensor", "nd_mosaic"]
        self.assertAlmostEqual(mosaic.mean(), 0.469, places=3)
        self.assertEqual(light(10, *filters, "--schedule", "nd_mosaic"),
                         (mosaic.mean(), mosaic.mean() * 8 / 10))
        # On an array of 3 x 5 the bright filters are more; exposures differ by pixel too.
        exposures = np.array([[1, 2], [4, 8]]) / 8
        self.assertEqual(
            light(16, *filters, "--schedule", "spatially_varying_exposure", "--set",
                  "schedule.exposure_slots=[1, 2, 4, 8]", rows=3, cols=5),
            (np.tile(mosaic * exposures, (2, 3))[:3, :5].mean(),) * 2)
        # Of each length L, (L - 1) / 2 slots are cut off at either end, with the weight L / 15.
        throughput, read = light(32, rows=64, cols=64)
        self.assertEqual(throughput, 1)
        self.assertAlmostEqual(read, 1 - 2 * sum(L * (L - 1) / 2 for L in (1, 2, 4, 8)) / 15 / 32,
                               delta=0.01)  # 0.0014 times the standard deviation of 4096 pixels

    def test_samples_that_the_full_well_clips_count_as_saturated(self):
        light = self.write_flat("light.npy", slots=8, light=0.9)
        figures = self.figures("emulate", light, "-o", "a.stipple", "--set", "sensor.full_well_e=500")
        self.assertEqual(figures["saturated_fraction"], 1)  # 900 e a slot
        self.assertIn("100.00 % of the samples saturated",
                      self.succeed("decode", "a.stipple", "-o", "a.npy", "--method", "naive"))

    def test_the_part_at_dn_0_is_that_of_normal_noise(self):
        """Read noise of 10 e is rounded to 0 below half a step. Without a black level there is a warning."""
        half_step_e = 2000 / 255 / 2  # config/sensors/paper.toml
        part = math.erfc(-half_step_e / 10 / math.sqrt(2)) / 2
        self.write_flat("dark.npy", slots=16, rows=64, cols=64, light=0)
        self.write_flat("light.npy", slots=16, light=0.5)

        def zeros(*arguments):
            done = self.run_program(*arguments, "--json", "-")
            self.assertEqual(done.returncode, 0, done.stderr)
            return json.loads(done.stdout)["zero_fraction"], "are DN 0" in done.stderr

        for arguments in (("emulate", "dark.npy", "-o", "dark.stipple"),
                          ("decode", "dark.stipple", "-o", "decoded.npy", "--method", "naive")):
            found, warned = zeros(*arguments)
            self.assertAlmostEqual(found, part, delta=5 * math.sqrt(part * (1 - part) / 14000))
            self.assertTrue(warned)
        self.assertIn(" % at DN 0", self.succeed("emulate", "dark.npy", "-o", "again.stipple"))
        self.assertEqual(zeros("emulate", "light.npy", "-o", "light.stipple"), (0, False))
        # A black level of 0.25 DN leaves at 0 what is below 0.25 DN: 0.2 standard deviations, 58 %.
        found, warned = zeros("emulate", "dark.npy", "-o", "black.stipple", "--set", "sensor.mode=physical", "--set",
                              "sensor.black_level_dn=0.25")
        self.assertGreater(found, 0.5)
        self.assertFalse(warned)

    def test_the_saturated_part_of_a_sensor_whose_well_is_at_full_scale(self):
        mean, well, read_noise, max_dn = 9950, 10000, 10, 4095  # config/sensors/lux1310.toml
        self.write_flat("light.npy", slots=32, rows=64, cols=64, light=mean / 4 / 1000)
        emulated = self.figures("emulate", "light.npy", "-o", "a.stipple", "--sensor", "lux1310",
                                "--schedule", "full4x")

        def part_from(electrons):
            """Of Z + V from there on: Z ~ Poisson, cut at the well, V normal."""
            part = 0
            for z in range(mean - 1000, mean + 1000):
                share = math.exp(z * math.log(mean) - mean - math.lgamma(z + 1))
                above = (electrons - min(z, well)) / read_noise / math.sqrt(2)
                part += share * (1 if z > well and electrons == full_scale
                                 else math.erfc(above) / 2)
            return part

        e_per_dn = well / max_dn
        full_scale = (max_dn - 0.5) * e_per_dn
        expected = part_from(full_scale)
        # What may have been clipped, as docs/decoder.md says: 5 standard deviations below the well.
        below_dn = 5 * math.hypot(read_noise / e_per_dn, math.sqrt(1 / 12))
        expected_bounds = part_from((math.ceil(max_dn - below_dn) - 0.5) * e_per_dn)
        decoded = self.figures("decode", "a.stipple", "-o", "a.npy", "--method", "naive")
        self.assertEqual(emulated["samples"], 8 * 64 * 64)
        for found, part in ((emulated, expected), (decoded, expected_bounds)):
            tolerance = 5 * math.sqrt(part * (1 - part) / emulated["samples"])
            self.assertAlmostEqual(found["saturated_fraction"], part, delta=tolerance)
        self.assertGreater(decoded["saturated_fraction"], emulated["saturated_fraction"])

    def test_schedule_and_sensor_follow_the_settings(self):
        light = self.write_flat("light.npy", slots=6, rows=4, cols=4)
        figures = self.figures("emulate", light, "-o", "a.stipple", "--set", "sensor.bit_depth=12",
                               "--set", "schedule.exposure_slots=[1]")
        self.assertEqual(figures["samples"], 6 * 16)  # each pixel in each slot
        self.assertEqual(figures["payload_bits"], 6 * 16 * 12)
        report = self.figures("info", "a.stipple")
        self.assertEqual(report["calibration"]["bit_depth"], 12)
        self.assertEqual((report["slots"], report["packets"], report["samples"]), (6, 6, 96))
        self.assertEqual(report["damage"], [])
        self.assertIn("light.npy", report["provenance"])
        self.assertTrue(report["complete"])
        self.assertIn("undamaged, complete", self.succeed("info", "a.stipple"))
        whole = (self.folder / "a.stipple").read_bytes()
        begin = whole.index(b"\xc5SPK", whole.index(b"\xc5SPK") + 36)  # of the second packet
        (self.folder / "cut.stipple").write_bytes(whole[:begin])
        self.assertFalse(self.figures("info", "cut.stipple")["complete"])
        self.assertIn("without an end marker", self.succeed("info", "cut.stipple"))
        cut = self.run_program("decode", "cut.stipple", "-o", "cut.npy", "--method", "naive")
        self.assertIn("no end marker", cut.stderr)

    def test_a_mosaic_of_colours_is_decoded_to_rgb(self):
        light = np.zeros((6, 4, 5, 3), np.float32) + [0.25, 0.5, 1]
        self.write_array("light.npy", light)
        figures = self.figures("emulate", "light.npy", "-o", "a.stipple", "--sensor", "ideal",
                               "--set", "sensor.cfa=gbrg", "--schedule", "full1x", "--truth", "truth.npy")
        self.assertEqual(figures["samples"] * figures["compression_ratio"], 6 * 20)
        np.testing.assert_allclose(self.array("truth.npy"), light)
        report = self.figures("info", "a.stipple")
        self.assertEqual((report["planes"], report["cfa"]), (1, "gbrg"))
        self.assertIn("gbrg", self.succeed("info", "a.stipple"))
        figures = self.figures("decode", "a.stipple", "-o", "out.npy", "--method", "naive")
        self.assertEqual(figures["voxels"], 6 * 4 * 5 * 3)
        self.assertEqual(self.array("out.npy").shape, light.shape)
        np.testing.assert_allclose(self.array("out.npy")[1:], light[1:], atol=0.005)
        self.assertIn("PSNR", self.succeed("compare", "out.npy", "light.npy"))

    def test_pixels_that_differ_come_back_alike(self):
        light = self.write_flat("light.npy", slots=40, light=0.2)
        self.succeed("emulate", light, "-o", "a.stipple", "--sensor", "ideal", "--set", "sensor.map_cols=2",
                     "--set", "sensor.transmittance=[1, 0.125]", "--set", "sensor.gain_map=[1, 4]",
                     "--set", "sensor.dark_current_e_per_s=2000")
        calibration = self.figures("info", "a.stipple")["calibration"]
        self.assertEqual(calibration["responsivity"], [1, 0.125])
        self.assertEqual(calibration["dark_e_per_slot"], 10)
        self.succeed("decode", "a.stipple", "-o", "out.npy", "--method", "naive")
        # Steps of 1/4 electron at 1000 electrons, and at 125 with the gain 4: 0.0005 at most.
        np.testing.assert_allclose(self.array("out.npy")[15:-15], 0.2, atol=0.0003)

    def test_still_light_comes_back_up_to_half_a_step(self):
        """The shortest exposure is one slot long, so light is off by STEP / 2 at most."""
        light = self.write_flat("light.npy", slots=40, light=0.2)
        for schedule in ("random", "tiled", "full4x", "full1x"):
            self.succeed("emulate", light, "-o", "clip.stipple", "--schedule", schedule, "--force",
                         *EXACT)
            figures = self.figures("decode", "clip.stipple", "-o", "out.npy", "--method", "naive",
                                   "--force")
            self.assertEqual(figures["method"], "naive")
            self.assertEqual(figures["voxels"], 40 * 64)
            np.testing.assert_allclose(self.array("out.npy")[15:-15], 0.2, atol=STEP / 2 + 1e-6)

    def test_decode_tells_its_speed_memory_and_threads(self):
        stream = self.write_stream(slots=40, rows=96, cols=96)
        for threads in (1, 2, 3):
            begin = time.monotonic()
            decode = self.start_program("decode", stream, "-o", "out.npy", "--method", "fast", "--force", "--no-sync",
                                        "--threads", threads, "--json", "figures.json", stdout=subprocess.DEVNULL)
            _, decode.returncode, usage = os.wait4(decode.pid, 0)
            elapsed = time.monotonic() - begin
            self.assertEqual(decode.returncode, 0, decode.communicate()[1])
            figures = json.loads((self.folder / "figures.json").read_text())
            self.assertLess(figures["seconds"], elapsed)
            self.assertGreater(figures["seconds"], elapsed / 2)  # most of the run
            self.assertTrue(1 < figures["voxels_per_second"] * elapsed / (40 * 96 * 96) < 2, figures)
            self.assertEqual(figures["threads"], threads)
            self.assertLessEqual(figures["peak_memory_bytes"], usage.ru_maxrss * 1024)
            self.assertGreater(figures["peak_memory_bytes"], 0.95 * usage.ru_maxrss * 1024)

    def test_compare_gives_the_figures_of_the_definitions(self):
        result = self.write_array("result.npy", [np.full((16, 16), light) for light in (0.6, 0.51)])
        reference = self.write_flat("light.npy", slots=2, rows=16, cols=16, light=0.5)
        figures = self.figures("compare", result, reference)
        self.assertAlmostEqual(figures["psnr_db"], -10 * math.log10((1e-2 + 1e-4) / 2), places=4)
        self.assertAlmostEqual(figures["psnr_frame_mean_db"], (20 + 40) / 2, places=3)
        shown, other = np.array([0.6, 0.51]) ** (1 / 2.2), 0.5 ** (1 / 2.2)
        self.assertAlmostEqual(figures["psnr_gamma_db"],
                               -10 * math.log10(np.mean((shown - other) ** 2)), places=4)
        # Without variance only the means count; C1 is 0.01^2.
        ssim = (2 * shown * other + 1e-4) / (shown**2 + other**2 + 1e-4)
        self.assertAlmostEqual(figures["ssim"], ssim.mean(), places=5)
        self.assertEqual(set(figures), {"psnr_db", "psnr_gamma_db", "psnr_frame_mean_db",
                                        "pu21_psnr_db", "ssim", "peak", "cd_per_unit", "frames", "longer"})
        figures = self.figures("compare", result, reference, "--max-value", "0.5")
        self.assertIsNone(figures["psnr_db"], "no difference is left; JSON has no infinity")
        self.assertAlmostEqual(figures["ssim"], 1)

    def test_the_first_frames_alone_are_compared(self):
        light = 0.2 + np.random.default_rng(5).random((9, 16, 16))
        long = self.write_array("long.npy", light)
        noisy = light + np.random.default_rng(6).normal(0, 0.01, light.shape)
        whole = self.figures("compare", self.write_array("a.npy", noisy[:5]), self.write_array("b.npy", light[:5]))
        self.assertEqual(self.figures("compare", "a.npy", long, "--until", 5), whole)
        self.write_array("noisy.npy", noisy)
        self.assertEqual(self.figures("compare", "noisy.npy", long, "--until", 5), whole)
        self.fails(1, ["margin", "none of 5"], "compare", "a.npy", long, "--until", 5, "--margin", 3)

    def test_compare_refuses_videos_of_different_shape(self):
        a = self.write_flat("a.npy", slots=4)
        self.fails(1, ["b.npy", "9 x 8"], "compare", self.write_flat("b.npy", slots=4, cols=9), a)
        self.fails(1, ["margin", "none of 4"], "compare", a, a, "--margin", 2)

    def test_footage_is_turned_into_light_as_asked(self):
        colour = np.zeros((2, 4, 4, 3))
        colour[..., 0] = 0.5
        self.write_array("colour.npy", colour)
        self.succeed("emulate", "colour.npy", "-o", "a.stipple", "--luminance", "--transfer",
                     "gamma22", "--truth", "truth.npy")
        np.testing.assert_allclose(self.array("truth.npy"), 0.2126 * 0.5**2.2, rtol=1e-5)
        self.succeed("emulate", "colour.npy", "-o", "b.stipple", "--max-value", "0.25", "--truth",
                     "clipped.npy")
        np.testing.assert_array_equal(self.array("clipped.npy"), np.minimum(colour, 0.25))

    def test_images_of_a_folder_or_a_pattern_are_footage(self):
        for number in range(1, 4):
            self.write_png(f"frames/f{number}.png", np.full((4, 4), 51 * number))
        for footage in ("frames", "frames/f%d.png"):
            self.succeed("emulate", footage, "-o", "a.stipple", "--truth", "truth.npy", "--force")
            np.testing.assert_allclose(self.array("truth.npy")[:, 0, 0], [0.2, 0.4, 0.6], rtol=1e-6)

    def test_a_run_is_the_same_bytes_with_any_number_of_threads(self):
        for threads in ("1", "2"):
            (self.folder / threads).mkdir()
            self.succeed("synth", "dice", "-o", f"{threads}/light", "--frames", "20", "--size",
                         "48x40", "--threads", threads)
            self.succeed("emulate", f"{threads}/light", "-o", f"{threads}/clip.stipple",
                         "--threads", threads)
            for method in ("naive", "fast"):
                self.succeed("decode", f"{threads}/clip.stipple", "-o", f"{threads}/{method}.npy",
                             "--method", method, "--threads", threads)
        one, two = ([path for path in sorted((self.folder / threads).rglob("*")) if path.is_file()]
                    for threads in ("1", "2"))
        self.assertEqual(len(one), 20 + 1 + 2)
        for a, b in zip(one, two, strict=True):
            self.assertEqual(a.read_bytes(), b.read_bytes(), b)

    def test_demo_leaves_video_images_and_figures(self):
        demo = ["demo", "--frames", "20", "--size", "48x40", "-o", "shown"]
        trials = self.figures(*demo)["trials"]
        self.assertEqual([trial["name"] for trial in trials],
                         ["4x exposure", "1x exposure", "1x, decoded", "coded, naive", "coded, decoded"])
        self.assertGreater(trials[2]["psnr_db"], trials[1]["psnr_db"])  # denoised, along motion
        for trial in trials:
            self.assertAlmostEqual(trial["megabits_per_second"],
                                   trial["payload_bits"] / 20 / 5000)
        self.assertEqual(len(list((self.folder / "shown/decoded").glob("frame_*.exr"))), 20)
        self.expect_demo_figures(trials)
        # Six versions of 48 x 40, 4 pixels apart, under 20 rows of text.
        images = [self.folder / f"shown/side_by_side_{number}.png" for number in (1, 2, 3)]
        sizes = {struct.unpack_from(">II", image.read_bytes(), 16) for image in images}
        self.assertEqual(sizes, {(6 * 48 + 5 * 4, 40 + 20)})
        self.assertEqual((self.folder / "shown/decoded.mp4").read_bytes()[4:8], b"ftyp")
        self.assertEqual(self.figures("info", "shown/random.stipple")["slots"], 20)
        self.fails(1, ["shown", "exists already", "--force"], *demo)
        text = self.succeed(*demo, "--force")
        self.assertIn("In shown:", text)
        self.assertRegex(text, r"coded, decoded +\d+\.\d\d : 1")
        for trial in trials:
            self.assertRegex(text, f"{trial['name']} +{trial['text']}")

    def expect_demo_figures(self, trials):
        """Those of `compare` on what `decode` makes of the recordings, as the demo leaves them."""
        self.succeed("synth", "pan", "-o", "truth.npy", "--frames", 20, "--size", "48x40")
        for trial, schedule, method in ((trials[1], "full1x", "naive"), (trials[4], "random", "fast")):
            self.succeed("decode", f"shown/{schedule}.stipple", "-o", "again.npy", "--force", "--method",
                         method)
            figures = self.figures("compare", "again.npy", "truth.npy", "--margin", 4, "--max-value", 2)
            for name in ("psnr_db", "psnr_gamma_db", "pu21_psnr_db", "ssim"):
                self.assertAlmostEqual(trial[name], figures[name], msg=f"{trial['name']}: {name}")


if __name__ == "__main__":
    unittest.main()
