"""Streams whose schedule changes between two slots: `emulate --switch`, and what reads them."""

import json
import unittest

import numpy as np
from program import INPUT, OK, USAGE, ProgramTest

QUIET = ("--set", "sensor.shot_noise=false", "--set", "sensor.read_noise_e=0")


class SwitchTest(ProgramTest):
    def emulate(self, *switches, slots=80, output="clip.stipple"):
        """A static scene without noise, at most 0.1 bright."""
        frame = np.random.default_rng(1).random((12, 16)) * 0.1
        self.write_array("light.npy", np.broadcast_to(frame, (slots, 12, 16)))
        return self.figures("emulate", "light.npy", "-o", output, *QUIET, "--set", "sensor.bit_depth=16",
                            *[part for text in switches for part in ("--switch", text)])

    def test_a_static_scene_is_decoded_across_switches(self):
        figures = self.emulate("30:schedule=tiled,seed=5", "50:schedule=random,sensor.full_scale_e=4000")
        self.assertIsNone(figures["light_throughput"])
        self.emulate(output="plain.stipple")
        inner = {}  # errors, without the ends of the clip
        for name, method in (("clip", "naive"), ("clip", "fast"), ("plain", "fast")):
            self.succeed("decode", f"{name}.stipple", "-o", f"{method}.npy", "--method", method, "--force")
            inner[name, method] = np.abs(self.array(f"{method}.npy") - self.array("light.npy"))[10:70].max()
        self.assertLess(inner["clip", "naive"], 4000 / 65535 / 1000)  # a DN
        self.assertLess(inner["clip", "fast"], 1.1 * inner["plain", "fast"])
        self.succeed("decode", "clip.stipple", "-o", "followed.npy", "--method", "naive", "--follow")
        self.assertTrue((self.array("followed.npy") == self.array("naive.npy")).all())

    def test_parts_are_those_of_one_run(self):
        self.emulate("30:schedule=tiled", "70:schedule=random,seed=3", slots=150)
        self.succeed("decode", "clip.stipple", "-o", "whole.npy", "--method", "naive")
        for part in ("1/2", "2/2"):
            self.succeed("decode", "clip.stipple", "-o", "parts", "--method", "naive", "--part", part)
        self.succeed("join", "parts", "-o", "joined.npy")
        self.assertTrue((self.array("joined.npy") == self.array("whole.npy")).all())

    def test_info_lists_the_switches_and_the_command(self):
        self.emulate("30:schedule=tiled,seed=5", "50:schedule=random,sensor.full_scale_e=4000")
        info = self.figures("info", "clip.stipple")
        self.assertEqual(info["version"], 4)
        self.assertEqual([(one["number"], one["slot"], one["schedule"]) for one in info["switches"]],
                         [(1, 30, "tiled"), (2, 50, "random")])
        self.assertAlmostEqual(info["switches"][1]["gain_e_per_dn"], 4000 / 65535)
        self.assertIn("--switch 30:schedule=tiled,seed=5 --switch 50:", info["command"])
        text = self.succeed("info", "clip.stipple")
        self.assertIn("from slot    30 schedule tiled", text)
        self.assertIn("undamaged, complete", text)
        self.assertNotIn("switches", self.figures("info", self.write_stream("plain.stipple")))

    def test_the_first_part_is_that_of_a_stream_without_switches(self):
        self.emulate("30:schedule=tiled")
        self.emulate(output="plain.stipple")
        for name in ("clip", "plain"):
            self.succeed("decode", f"{name}.stipple", "-o", f"{name}.npy", "--method", "naive", "--until", "20")
        # Slots of one block have a common start of the iteration, so they differ by rounding.
        np.testing.assert_allclose(self.array("clip.npy"), self.array("plain.npy"), rtol=0, atol=1e-6)

    def test_damage_of_a_switch_costs_its_slot_only(self):
        self.emulate("30:schedule=tiled")
        content = (self.folder / "clip.stipple").read_bytes()
        at = content.index(b"\xc5SPK\x04")
        self.change_byte("clip.stipple", at + 40)
        done = self.run_program("decode", "clip.stipple", "-o", "light2.npy", "--method", "naive")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("1 of 80 slots are incomplete", done.stderr)
        self.assertLess(np.abs(self.array("light2.npy") - self.array("light.npy")).max(), 0.002)

    def test_a_stream_that_is_cut_off_is_recovered(self):
        self.emulate("30:schedule=tiled")
        content = (self.folder / "clip.stipple").read_bytes()
        left = ".cut.999999999-5e1f00d5.partial.stipple"
        (self.folder / left).write_bytes(content[:len(content) * 3 // 4])
        figures = self.figures("recover", left)
        self.assertGreater(figures["whole"], 40)
        self.assertEqual(self.figures("info", "cut.stipple")["slots"], figures["whole"])

    def test_commands_of_one_schedule_refuse(self):
        self.emulate("30:schedule=tiled")
        for command in (("report", "clip.stipple", "-o", "page.html"),
                        ("calibrate", "-o", "chip.npz", "--scene", "clip.stipple", "--prnu", "0.01"),
                        ("decode", "clip.stipple", "-o", "x.npy", "--check-schedule=fix")):
            done = self.run_program(*command)
            self.assertEqual(done.returncode, INPUT, done.stderr)
            self.assertIn("schedule", done.stderr)

    def test_a_rig_with_a_switch_is_refused(self):
        self.emulate("30:schedule=tiled")
        (self.folder / "two.toml").write_text('name = "two"\nsensors = ["a", "b"]\na = { share = 0.5 }\n'
                                              'b = { share = 0.5 }\n')
        self.succeed("emulate", "light.npy", "-o", "rig", "--rig", "two.toml", "--set", 'rig.a.set=["sensor.bit_depth=16"]')
        (self.folder / "rig/a.stipple").write_bytes((self.folder / "clip.stipple").read_bytes())
        text = (self.folder / "rig/rig.toml").read_text()
        (self.folder / "rig/rig.toml").write_text("".join(line for line in text.splitlines(True) if "sha256" not in line))
        self.fails(INPUT, ["a.stipple", "its schedule changes at slot 30"], "decode", "rig", "-o", "x.npy")
        self.fails(INPUT, ["a.stipple", "its schedule changes at slot 30"], "info", "rig")

    def test_a_report_shows_what_comes_before_a_switch(self):
        self.emulate("30:schedule=tiled")
        self.succeed("report", "clip.stipple", "-o", "page.html", "--until", "20", "--method", "naive")

    def test_what_cannot_be_switched_is_refused(self):
        self.write_flat("light.npy")
        run = ("emulate", "light.npy", "-o", "x.stipple")
        for text, code, parts in (
                ("schedule=tiled", USAGE, ["is a slot from 1 on and what changes there"]),
                ("0:schedule=tiled", USAGE, ["is a slot from 1 on"]),
                ("5:shedule=tiled", USAGE, ["shedule=tiled: is none of schedule=NAME"]),
                ("5:schedule=nosuch", INPUT, ["nosuch"]),
                ("5:sensor.bit_depth=4", INPUT, ["switch at slot 5", "may change"]),
                ("5:schedule=two_bucket", INPUT, ["two_bucket"])):
            self.fails(code, parts, *run, "--switch", text)
        self.fails(USAGE, ["comes before the switch that precedes it"], *run, "--switch", "9:seed=2",
                   "--switch", "8:seed=3")
        self.fails(USAGE, ["--switch"], *run[:3], "pieces", "--part", "1/2", "--switch", "9:seed=2")
        lux = ("--sensor", "lux1310", "--switch", "9:seed=2")
        self.fails(INPUT, ["drops late rows", "stretch"], *run, *lux, "--overrun", "drop")
        self.fails(INPUT, ["may change"], *run, *lux[:3], "9:sensor.timing.adc_clocks=9")
        self.fails(USAGE, ["--vcd", "--switch"], *run, *lux, "--vcd", "readout.vcd")
        done = self.run_program(*run, "--switch", "500:seed=2")
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertIn("ends before slot 500", done.stderr)


if __name__ == "__main__":
    unittest.main()
