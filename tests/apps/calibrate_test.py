"""Calibration of a chip: what `stipple calibrate` writes, `stipple decode` uses."""

import re
import struct
import unittest
import zlib

import numpy as np

from program import INPUT, USAGE, ProgramTest

SIZE = "32x24"
SENSOR = ("--sensor", "t6", "--set", "sensor.device_id=4")


def write_series(folder, groups):
    """A descriptor of PNG images, for groups of (line, DN of the images)."""
    lines = ["v 4.0", "n 12 16 12"]
    number = 0
    for line, images in groups:
        lines.append(line)
        for image in images:
            number += 1
            image_of(folder / f"{number}.png", image)
            lines.append(f"i {number}.png")
    (folder / "series.txt").write_text("\n".join(lines) + "\n")


def image_of(path, dn):
    """Of 16 bits, which ProgramTest.write_png does not write."""
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in dn)
    head = struct.pack(">IIBBBBB", dn.shape[1], dn.shape[0], 16, 0, 0, 0, 0)
    chunks = b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in [(b"IHDR", head), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")])
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunks)


class CalibrateTest(ProgramTest):
    def calibrate(self, name="chip.stcal", *more):
        return self.figures("calibrate", *SENSOR, "--size", SIZE, "-o", name, *more)

    def gains(self, name):
        """The first map of the file, as docs/calibration.md says."""
        content = (self.folder / name).read_bytes()
        rows, cols = struct.unpack_from("<HH", content, 12)
        start = 40 + struct.unpack_from("<I", content, 36)[0]
        return np.frombuffer(content, "<f4", rows * cols, start).reshape(rows, cols)

    def decoded_error(self, *more):
        """Root mean square error of a decoded flat field of light 0.8."""
        self.succeed("decode", "clip.stipple", "-o", "decoded.npy", "--method", "naive", "--force", *more)
        return np.sqrt(np.mean((self.array("decoded.npy") - 0.8) ** 2))

    def emulate(self, *more):
        self.write_flat("light.npy", 30, 24, 32, 0.8)
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", *SENSOR, "--force", *more)

    def test_a_calibrated_chip_decodes_better(self):
        figures = self.calibrate("chip.stcal", "--seed", 1)
        self.assertAlmostEqual(figures["gain"]["pixels"], 0.06, delta=0.01)  # 5 sqrt(1 / 2 / 768)
        self.assertEqual((figures["rows"], figures["cols"], figures["flats"]), (24, 32, 100))
        self.assertAlmostEqual(self.gains("chip.stcal").mean(), 1, places=3)
        told = self.figures("info", "chip.stcal")
        self.assertEqual((told["kind"], told["sensor"], told["device_id"], told["flats"], told["darks"]),
                         ("calibration", "t6", 4, 100, 200))
        self.assertAlmostEqual(told["gain"]["mean"], 1, places=3)
        self.assertEqual(told["defects"], figures["defects"])
        self.emulate()
        # A PRNU of 6 % adds 0.048 to the error of each pixel, whatever its samples.
        error = self.decoded_error()
        corrected = self.decoded_error("--calibration", "chip.stcal")
        self.assertGreater(np.sqrt(error ** 2 - corrected ** 2), 0.04)

    def test_info_tells_the_same_figures_as_calibrate(self):
        self.emulate()
        noisy = ("--sensor", "t6", "--set", "sensor.dsnu_e=3", "--set", "sensor.dark_current_e_per_s=4000", "--size", SIZE)
        for source, maps in ((noisy, ("gain", "offset_dn", "dark_dn_per_s")),
                             (("--scene", "clip.stipple", "--method", "naive"), ("gain",))):
            with self.subTest(source[0]):
                command = ("calibrate", *source, "-o", "chip.stcal", "--force")
                made, told = self.figures(*command), self.figures("info", "chip.stcal")
                for name in maps:
                    self.assertEqual({key: made[name][key] for key in ("mean", "deviation")}, told[name])
                spreads = re.findall(r"[-.\de]+ \+- [-.\de]+", self.succeed(*command))
                self.assertEqual(len(spreads), len(maps))
                said = self.succeed("info", "chip.stcal")
                self.assertEqual(re.findall(r"[-.\de]+ \+- [-.\de]+", said)[:len(maps)], spreads)

    def test_a_pattern_without_calibration_is_told(self):
        self.emulate()
        done = self.run_program("decode", "clip.stipple", "-o", "decoded.npy", "--method", "naive")
        self.assertEqual(done.returncode, 0)
        self.assertIn("PRNU 6 %", done.stderr)
        # 10 log10(1 + 0.06^2 7294^2 / (7294 + 60^2 + (7.6^2 + 19.6^2) / 2))
        self.assertIn("12.6 dB", done.stderr)
        self.calibrate()
        done = self.run_program("decode", "clip.stipple", "-o", "again.npy", "--method", "naive",
                                "--calibration", "chip.stcal")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.emulate("--set", "sensor.prnu=0")
        done = self.run_program("decode", "clip.stipple", "-o", "equal.npy", "--method", "naive")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_streams_of_a_chip_are_a_series(self):
        self.write_flat("none.npy", 300, 24, 32, 0)
        self.write_flat("flat.npy", 300, 24, 32, 0.8)
        for name in "none", "flat":
            self.succeed("emulate", f"{name}.npy", "-o", f"{name}.stipple", *SENSOR, "--seed", 8)
        self.succeed("calibrate", "--dark", "none.stipple", "--flat", "flat.stipple", "-o", "streams.stcal")
        self.assertEqual(self.figures("info", "streams.stcal")["device_id"], 4)
        self.calibrate()
        streams, sensor = self.gains("streams.stcal"), self.gains("chip.stcal")
        sound = sensor > 0.5
        # Both know the gain to better than 1 %.
        self.assertLess(np.std((streams - sensor)[sound]), 0.01)
        self.write_stream("paper.stipple", rows=24, cols=32)
        self.fails(INPUT, ["paper.stipple: is of another sensor"], "calibrate", "--dark", "none.stipple",
                   "--flat", "paper.stipple", "-o", "other.stcal")

    def bent(self, *more):
        """A flat field of 0.8 on a chip that bends by 16 %; 8 slots collect 0.44 of its well."""
        self.write_flat("light.npy", 30, 24, 32, 0.8)
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", *SENSOR, "--set", "sensor.response_loss=0.16",
                     "--force", *more)

    def test_levels_of_light_undo_a_non_linear_response(self):
        bend = ("--set", "sensor.response_loss=0.16")
        figures = self.calibrate("bent.stcal", *bend)["response"]
        self.assertEqual((figures["levels"] > 8, figures["linear"]), (True, False))
        # q = Q (1 - 0.16 Q / w) is solved for Q; the well has 3647 DN, the black level is 64.
        w, q = 3647, figures["brightest_dn"] - 64
        charge = (1 - np.sqrt(1 - 4 * 0.16 * q / w)) * w / (2 * 0.16)
        self.assertAlmostEqual(figures["bend_dn"] / (charge - q), 1, delta=0.02)
        self.assertIsNotNone(self.figures("info", "bent.stcal")["response"])
        flat = self.calibrate("flat.stcal", *bend, "--levels", 0)
        self.assertIsNone(flat["response"])
        self.bent()
        done = self.run_program("decode", "clip.stipple", "-o", "decoded.npy", "--method", "naive", "--force")
        self.assertIn("non-linear; without --calibration bright light decodes up to 16 % too dark", done.stderr)
        # Without the table the light of 8 slots is 7 % too dark: 0.016 of 0.8 in the mean over exposures.
        self.decoded_error("--calibration", "bent.stcal")
        self.assertAlmostEqual(self.array("decoded.npy").mean(), 0.8, delta=0.003)
        self.decoded_error("--calibration", "flat.stcal")
        self.assertGreater(abs(self.array("decoded.npy").mean() - 0.8), 0.01)
        # A linear chip has no table, and its file is that of version 1.
        self.assertIsNone(self.calibrate("linear.stcal", "--levels", 0)["response"])
        self.assertTrue(self.calibrate("linear.stcal", "--levels", 6, "--force")["response"]["linear"])
        self.assertEqual((self.folder / "linear.stcal").read_bytes()[8], 1)
        self.assertEqual((self.folder / "bent.stcal").read_bytes()[8], 2)

    def test_streams_tell_the_response_by_their_exposure_times(self):
        bend = ("--set", "sensor.response_loss=0.16")
        for name, light in ("none", 0), ("dim", 0.3), ("bright", 1.4):
            self.write_flat(f"{name}.npy", 120, 24, 32, light)
            self.succeed("emulate", f"{name}.npy", "-o", f"{name}.stipple", *SENSOR, *bend, "--seed", 8)
        figures = self.figures("calibrate", "--dark", "none.stipple", "--flat", "dim.stipple", "--flat",
                               "bright.stipple", "-o", "chip.stcal")
        response = figures["response"]
        self.assertFalse(response["linear"])
        w, q = 3647, response["brightest_dn"] - 64
        charge = (1 - np.sqrt(1 - 4 * 0.16 * q / w)) * w / (2 * 0.16)
        self.assertAlmostEqual(response["bend_dn"] / (charge - q), 1, delta=0.05)
        self.write_flat("short.npy", 8, 24, 32, 0.3)
        self.succeed("emulate", "short.npy", "-o", "short.stipple", *SENSOR, *bend)
        self.fails(INPUT, ["short.stipple: has too few frames"], "calibrate", "--dark", "none.stipple", "--flat",
                   "dim.stipple", "--flat", "short.stipple", "-o", "none.stcal")

    def test_photons_of_images_tell_the_response(self):
        random = np.random.default_rng(4)

        def images(count, photons):
            charge = 0.5 * photons * np.ones((12, 16))
            charge = charge + np.sqrt(charge + 4) * random.standard_normal((count, 12, 16))
            return list(np.round(64 + charge * (1 - 0.1 * charge / 4000)))

        bright = [(f"b 5000000 {photons}", images(4, photons)) for photons in range(600, 6601, 600)]
        write_series(self.folder, [("d 5000000", images(20, 0)), *bright, ("b 5000000 3000", images(40, 3000))])
        figures = self.figures("calibrate", "--series", "series.txt", "-o", "camera.stcal", "--no-dark-current")
        response = figures["response"]
        self.assertEqual((response["levels"], response["linear"]), (12, False))
        q = response["brightest_dn"] - 64
        charge = (1 - np.sqrt(1 - 4 * 0.1 * q / 4000)) * 4000 / (2 * 0.1)
        self.assertAlmostEqual(response["bend_dn"] / (charge - q), 1, delta=0.05)
        bright[5] = ("b 5000000 3600", images(4, 2700))  # the lamp has faltered
        write_series(self.folder, [("d 5000000", images(20, 0)), *bright, ("b 5000000 3000", images(40, 3000))])
        self.fails(INPUT, ["series.txt: falls from", "tells no response curve"], "calibrate", "--series",
                   "series.txt", "-o", "none.stcal", "--no-dark-current")

    def test_a_calibration_beside_the_stream_is_used(self):
        self.emulate()
        self.calibrate("chip.stcal")
        decode = ("decode", "clip.stipple", "--method", "naive", "--force", "-o")
        self.succeed(*decode, "given.npy", "--calibration", "chip.stcal")
        self.assertIsNone(self.figures(*decode, "plain.npy")["calibration"])
        self.assertIsNone(self.figures("info", "clip.stipple")["calibration_file"])
        self.emulate("--calibration", "chip.stcal")
        self.assertEqual((self.folder / "clip.stcal").read_bytes(), (self.folder / "chip.stcal").read_bytes())
        (self.folder / "clip.stipple").unlink()
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", *SENSOR, "--calibration", "clip.stcal")
        self.assertEqual((self.folder / "clip.stcal").read_bytes(), (self.folder / "chip.stcal").read_bytes())
        done = self.run_program(*decode, "beside.npy")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("calibrated by clip.stcal", done.stdout)
        np.testing.assert_array_equal(self.array("beside.npy"), self.array("given.npy"))
        self.assertEqual(self.figures(*decode, "beside.npy")["calibration"], "clip.stcal")
        self.succeed(*decode, "none.npy", "--calibration", "none")
        np.testing.assert_array_equal(self.array("none.npy"), self.array("plain.npy"))
        self.assertEqual(self.figures("info", "clip.stipple")["calibration_file"], "clip.stcal")
        self.assertIn("calibrated   by clip.stcal", self.run_program("info", "clip.stipple").stdout)
        self.succeed("decode", "clip.stipple", "--method", "naive", "-o", "windows", "--part", "1/1")
        self.succeed("join", "windows", "-o", "joined.npy")
        np.testing.assert_array_equal(self.array("joined.npy"), self.array("given.npy"))

    def test_a_wrong_calibration_beside_the_stream_is_named(self):
        self.emulate()
        self.succeed("calibrate", "--sensor", "t6", "--size", SIZE, "-o", "clip.stcal")
        decode = ("decode", "clip.stipple", "--method", "naive", "-o", "out.npy")
        self.fails(INPUT, ["clip.stipple: the calibration beside it cannot be used (--calibration none",
                           "clip.stcal: ", "device_id 0, and the stream of 4"], *decode)
        self.assertIn("calibrated   not: clip.stcal", self.run_program("info", "clip.stipple").stdout)
        self.succeed(*decode, "--calibration", "none")
        self.succeed("calibrate", "--sensor", "t6", "--size", "24x24", "-o", "clip.stcal", "--force")
        self.assertIn("24 x 24 pixels in 1 plane, and the stream has", self.run_program("info", "clip.stipple").stdout)
        self.succeed("calibrate", "--sensor", "t6", "--size", SIZE, "-o", "clip.stcal", "--force")
        self.fails(INPUT, ["clip.stcal: ", "device_id 0, and the stream of 4"], "emulate", "light.npy", "-o",
                   "other.stipple", *SENSOR, "--calibration", "clip.stcal")
        self.assertEqual([name for name in self.names() if name.startswith("other")], [])

    def test_the_scene_itself_tells_gains(self):
        self.emulate()
        self.succeed("calibrate", "--scene", "clip.stipple", "--method", "fast", "-o", "scene.stcal")
        self.calibrate()
        known, found = self.gains("chip.stcal"), self.gains("scene.stcal")
        sound = known > 0.5
        self.assertGreater(np.corrcoef(known[sound], found[sound])[0, 1], 0.25)  # by chance 0.04
        error = self.decoded_error()
        self.assertLess(self.decoded_error("--calibration", "scene.stcal"), error)
        with open(f"{self.folder}/clip.stipple", "r+b") as stream:
            stream.seek(stream.seek(0, 2) // 2)
            stream.write(b"damage")
        done = self.run_program("calibrate", "--scene", "clip.stipple", "--method", "naive", "-o", "damaged.stcal")
        self.assertIn("clip.stipple: the stream is damaged", done.stderr)
        self.assertEqual(done.returncode, 0)
        self.write_stream("paper.stipple", rows=24, cols=32)
        self.fails(INPUT, ["paper.stipple: ", "--prnu"], "calibrate", "--scene", "paper.stipple", "-o", "x.stcal")
        self.fails(USAGE, ["--prnu"], "calibrate", *SENSOR, "--size", SIZE, "--prnu", 0.1, "-o", "x.stcal")
        self.fails(USAGE, ["--sensor"], "calibrate", *SENSOR, "--size", SIZE, "--scene", "clip.stipple", "-o", "x.stcal")

    def test_images_are_a_series(self):
        random = np.random.default_rng(3)
        gain = 1 + 0.05 * random.standard_normal((12, 16))

        def images(count, light):
            signal = light * gain
            return [np.round(64 + signal + np.sqrt(4 + signal) * random.standard_normal(gain.shape))
                    for _ in range(count)]

        write_series(self.folder, [("d 5000000", images(20, 0)), ("d 80000000", images(20, 0)),
                                   ("b 5000000 100", images(2, 100)), ("b 5000000 2000", images(40, 2000))])
        self.succeed("calibrate", "--series", "series.txt", "-o", "camera.stcal")
        # sqrt(2000 / 40) of 2000 DN: 0.35 %; five standard deviations of 192 pixels.
        error = self.gains("camera.stcal") / (gain / gain.mean()) - 1
        self.assertLess(np.sqrt(np.mean(error ** 2)), 0.0035 * 1.3)
        write_series(self.folder, [("d 5000000", images(20, 0)), ("b 5000000 2000", images(40, 2000))])
        self.fails(INPUT, ["series.txt: ", "one exposure time only (5 ms)", "--no-dark-current"],
                   "calibrate", "--series", "series.txt", "-o", "none.stcal")
        self.succeed("calibrate", "--series", "series.txt", "-o", "camera.stcal", "--force",
                     "--no-dark-current")
        bright = [np.minimum(image, 4095) for image in images(40, 4500)]
        write_series(self.folder, [("d 5000000", images(20, 0)), ("b 5000000 4500", bright)])
        self.fails(INPUT, ["series.txt: saturates"], "calibrate", "--series", "series.txt", "-o", "none.stcal",
                   "--no-dark-current")

    def test_wrong_calibrations_are_named(self):
        self.calibrate()
        self.emulate()
        decode = ("decode", "clip.stipple", "-o", "out.npy", "--method", "naive", "--calibration")
        whole = (self.folder / "chip.stcal").read_bytes()
        (self.folder / "cut.stcal").write_bytes(whole[:500])
        self.fails(INPUT, ["cut.stcal: byte 500: the file is truncated"], *decode, "cut.stcal")
        (self.folder / "text.stcal").write_text("gain = 1")
        self.fails(INPUT, ["text.stcal: is not a calibration file"], *decode, "text.stcal")
        self.fails(INPUT, ["none.stcal"], *decode, "none.stcal")
        self.succeed("calibrate", *SENSOR, "--size", "24x24", "-o", "small.stcal")
        self.fails(INPUT, ["small.stcal: is the calibration of 24 x 24 pixels"], *decode, "small.stcal")
        self.succeed("calibrate", "--sensor", "t6", "--size", SIZE, "-o", "other.stcal")
        self.fails(INPUT, ["other.stcal: ", "device_id 0, and the stream of 4"], *decode, "other.stcal")

    def test_wrong_series_are_named(self):
        sensor = ("calibrate", *SENSOR, "--size", SIZE, "-o", "chip.stcal")
        self.fails(INPUT, ["has too few frames: 3 samples of a pixel"], *sensor, "--flats", 3)
        self.fails(INPUT, ["has too few frames: 4 samples of a pixel"], *sensor, "--darks", 2)
        self.fails(USAGE, ["--size"], "calibrate", *SENSOR, "-o", "chip.stcal")
        self.fails(USAGE, ["--sensor"], "calibrate", "-o", "chip.stcal")
        self.fails(USAGE, ["--flat"], "calibrate", "--dark", self.write_stream(), "-o", "chip.stcal")
        self.fails(USAGE, ["--flats"], "calibrate", "--series", "series.txt", "--flats", 9, "-o", "chip.stcal")


if __name__ == "__main__":
    unittest.main()
