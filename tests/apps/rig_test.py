"""Several sensors on one scene: a rig through emulate, info and decode."""

import os
import shutil
import unittest

import numpy as np
from program import INPUT, USAGE, ProgramTest

NAIVE = ("--method", "naive")
TWO = """
name = "two"
sensors = ["left", "right"]
left = { share = 0.5 }
right = { share = 0.5, offset_px = [1, -2], phase_slots = 3, schedule = "full4x" }
"""


class RigTest(ProgramTest):
    def setUp(self):
        super().setUp()
        rows, cols = np.mgrid[0:12, 0:20]
        slots = np.arange(24).reshape(-1, 1, 1)
        self.light = self.write_array("light.npy", 0.2 + 0.1 * np.sin(0.7 * rows + 0.5 * cols + 0.3 * slots))

    def write_rig(self, text=TWO, name="two.toml"):
        (self.folder / name).write_text(text)
        return name

    def emulate(self, folder="rig", text=TWO, light="light.npy"):
        return self.figures("emulate", light, "-o", folder, "--rig", self.write_rig(text))

    def test_a_folder_has_the_stream_of_each_sensor_and_the_rig(self):
        figures = self.emulate()
        self.assertEqual(sorted(path.name for path in (self.folder / "rig").iterdir()),
                         ["left.stipple", "rig.toml", "right.stipple"])
        left, right = figures["sensors"]
        self.assertEqual([left["slots"], right["slots"]], [24, 21])
        self.assertEqual(figures["samples"], left["samples"] + right["samples"])
        self.assertAlmostEqual(figures["light_collected"],
                               0.5 * left["light_throughput"] + 0.5 * right["light_throughput"])
        bits = left["payload_bits"] / 24 + right["payload_bits"] / 21
        self.assertAlmostEqual(figures["bits_per_slot"], bits)
        self.assertAlmostEqual(figures["bits_per_second"], bits / 0.005)
        self.assertIsNone(figures["energy_uj"])

    def test_energy_is_that_of_all_readouts(self):
        text = ('sensors = ["a", "b"]\na = { sensor = "lux1310", schedule = "hardware_tiled", share = 0.5 }\n'
                'b = { sensor = "lux1310", schedule = "full4x", share = 0.5 }\n')
        light = self.write_flat("wide.npy", slots=16, rows=32, cols=64)
        figures = self.emulate(text=text, light=light)
        self.assertGreater(figures["energy_uj"], 0)
        self.assertAlmostEqual(figures["energy_uj"],
                               sum(sensor["readout"]["energy_uj"] for sensor in figures["sensors"]), 6)

    def test_a_pipe_in_place_of_a_stream_is_refused(self):
        self.emulate()
        (self.folder / "rig/left.stipple").unlink()
        os.mkfifo(self.folder / "rig/left.stipple")
        self.fails(INPUT, ["rig/left.stipple: is missing or not a file"], "info", "rig")

    def test_a_stream_is_that_of_the_sensor_alone(self):
        self.emulate()
        self.succeed("emulate", "light.npy", "-o", "alone.stipple", "--set", "sensor.photons_per_unit=500")
        self.assertEqual((self.folder / "rig/left.stipple").read_bytes(),
                         (self.folder / "alone.stipple").read_bytes())
        moved = np.load(self.folder / "light.npy")[3:]
        moved = np.pad(moved, ((0, 0), (1, 0), (0, 2)), "edge")[:, :12, 2:]
        self.write_array("moved.npy", moved)
        self.succeed("emulate", "moved.npy", "-o", "alone2.stipple", "--set", "sensor.photons_per_unit=500",
                     "--schedule", "full4x", "--seed", 2)
        decoded = [self.decode(name) for name in ("rig/right.stipple", "alone2.stipple")]
        np.testing.assert_array_equal(*decoded)

    def decode(self, stream, *options):
        self.succeed("decode", stream, "-o", "decoded.npy", *(options or NAIVE), "--force")
        return self.array("decoded.npy")

    def test_a_rig_of_one_sensor_decodes_as_its_stream(self):
        self.emulate(text='sensors = ["only"]\n')
        self.succeed("emulate", "light.npy", "-o", "alone.stipple")
        np.testing.assert_array_equal(self.decode("rig"), self.decode("alone.stipple"))

    def test_two_sensors_decode_better_than_each(self):
        self.emulate(text='sensors = ["a", "b"]\na.share = 0.5\nb.share = 0.5\nb.phase_slots = 1\nb.offset_px = [2, 1]\n')
        light = self.array("light.npy")
        error = [np.square(self.decode(name) - light)[4:-4].mean() for name in ("rig", "rig/a.stipple")]
        self.assertLess(error[0], 0.8 * error[1])
        figures = self.figures("decode", "rig", "-o", "fast.npy", "--method", "fast")
        self.assertEqual([figures["sensors"], figures["slots"]], [2, 24])

    def test_the_folder_needs_nothing_else(self):
        self.emulate()
        expected = self.decode("rig")
        (self.folder / "two.toml").unlink()
        shutil.move(self.folder / "rig", self.folder / "elsewhere")
        np.testing.assert_array_equal(self.decode("elsewhere"), expected)

    def test_info_tells_sensors_and_totals(self):
        emulated = self.emulate()
        told = self.figures("info", "rig")
        self.assertEqual(told["kind"], "rig")
        self.assertEqual([sensor["name"] for sensor in told["sensors"]], ["left", "right"])
        self.assertEqual(told["sensors"][1]["homography"], [1, 0, -2, 0, 1, 1, 0, 0, 1])
        for key in ("bits_per_slot", "bits_per_second"):
            self.assertAlmostEqual(told[key], emulated[key])
        text = self.succeed("info", "rig")
        for part in ("right: 50 %", "3 slots later", "moved by (1, -2)", "Mbit/s"):
            self.assertIn(part, text)
        self.assertIn("7.52 %", self.succeed("info", "tocci2011"))
        self.assertIn("two", self.succeed("info", "two.toml"))
        self.assertIn("mid: 33.3333 % of the light, sensor paper, schedule full4x with schedule.open_slots=2, "
                      "schedule.period_slots=4", self.succeed("info", "multi_exposure"))
        self.assertEqual(self.figures("info", "multi_exposure")["sensors"][0]["set"], [])
        self.assertIn("coded_pair", self.succeed("list", "rigs"))

    def test_keys_can_be_set(self):
        figures = self.figures("emulate", "light.npy", "-o", "rig", "--rig", self.write_rig(), "--set",
                               "rig.left.share=0.25")
        self.assertEqual(figures["sensors"][0]["share"], 0.25)
        self.assertIn("left.share = 0.25", (self.folder / "rig/rig.toml").read_text())
        self.decode("rig")

    def test_bad_rigs_are_refused(self):
        for text, parts in (
                ('sensors = ["a", "a"]', ['two sensors "a"']),
                ('sensors = ["a", "b"]\na.share = 0.9\nb.share = 0.2', ["sum 1.1"]),
                ('sensors = ["a", "b"]\na.share = 0.5\nb = { share = 0.5, offset_px = [12, 0] }', ["sees no pixel"]),
                ('sensors = ["a", "b"]\na.share = 0.5\nb = { share = 0.5, phase_slots = 24 }',
                 ['"b"', "begins at slot 24", "24 slots"]),
                ('sensors = ["a", "b"]\na.share = 0.5\nb = { share = 0.5, homography = [0, 0, 0, 0, 0, 0, 0, 0, 1] }',
                 ["singular"]),
                ("sensors = [", ["bad.toml"])):
            self.write_rig(text, "bad.toml")
            with self.subTest(text):
                self.fails(INPUT, parts, "emulate", "light.npy", "-o", "rig", "--rig", "bad.toml")
        self.fails(INPUT, ["nosuch", "rigs"], "emulate", "light.npy", "-o", "rig", "--rig", "nosuch")
        self.fails(INPUT, ['did you mean "tocci2011_slow"?'], "emulate", "light.npy", "-o", "rig", "--rig",
                   "tocci2011_slo")

    def test_streams_that_do_not_belong_together_are_refused(self):
        self.emulate()
        decode = ("decode", "rig", "-o", "x.npy", *NAIVE)
        right = self.folder / "rig/right.stipple"
        good = right.read_bytes()
        right.unlink()
        self.fails(INPUT, ["right.stipple", "missing", "rig.toml"], *decode)
        self.write_flat("other.npy", slots=24, rows=12, cols=20)
        self.succeed("emulate", "other.npy", "-o", right)
        self.fails(INPUT, ["right.stipple", "other footage"], *decode)
        self.succeed("emulate", "light.npy", "-o", right, "--force")
        self.fails(INPUT, ["right.stipple", "sha256", "another rig"], *decode)
        rig = self.folder / "rig/rig.toml"
        rig.write_text("".join(line for line in rig.read_text().splitlines(True) if "sha256" not in line))
        self.succeed(*decode)  # as it is
        self.succeed("emulate", "light.npy", "-o", right, "--force", "--set", "sensor.slot_us=1000")
        self.fails(INPUT, ["right.stipple", "slots of 1000 us", "5000"], "decode", "rig", "-o", "y.npy", *NAIVE)
        self.write_array("colour.npy", np.full((24, 12, 20, 3), 0.2))
        self.succeed("emulate", "colour.npy", "-o", right, "--force")
        self.fails(INPUT, ["right.stipple", "other footage"], "decode", "rig", "-o", "y.npy", *NAIVE)
        right.write_bytes(good[:len(good) // 2] + b"?" + good[len(good) // 2 + 1:])
        done = self.run_program("decode", "rig", "-o", "y.npy", *NAIVE)
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("right.stipple", done.stderr)

    def test_options_of_one_stream_are_refused(self):
        self.emulate()
        rig = ("emulate", "light.npy", "-o", "more", "--rig", "two.toml")
        for option in (("--sensor", "ideal"), ("--schedule", "tiled"), ("--seed", "4"), ("--overrun", "drop"),
                       ("--set", "sensor.bit_depth=10")):
            self.fails(USAGE, [option[0]], *rig, *option)
        self.fails(USAGE, ["no extension"], "emulate", "light.npy", "-o", "x.stipple", "--rig", "two.toml")
        self.fails(USAGE, ["--rig"], "emulate", "light.npy", "-o", "x.stipple", "--set", "rig.left.share=0.5")
        for option in (("--part", "1/2"), ("--follow",), ("--check-schedule",), ("--stages", "stages")):
            self.fails(USAGE, [option[0], "folder of a rig"], "decode", "rig", "-o", "x", *option)
        self.fails(INPUT, ["2 sensors", "portz2013"], "decode", "rig", "-o", "x", "--method", "portz2013")
        self.fails(INPUT, ["rig", "exists"], *rig[:3], "rig", *rig[4:])


if __name__ == "__main__":
    unittest.main()
