"""What a stream says of how it was made: enough to make it again."""

import hashlib
import shlex
import subprocess
import tomllib
import unittest

import numpy as np
from program import PROGRAM, ProgramTest


class ProvenanceTest(ProgramTest):
    def made_again(self, *emulate):
        """Makes a stream, then the same by the command that it holds. What it says of itself."""
        self.succeed("emulate", *emulate, "-o", "first.stipple")
        info = self.figures("info", "first.stipple")
        self.assertIn("again        " + info["command"] + "\n",
                      self.succeed("info", "first.stipple"))
        (self.folder / "bin").mkdir()
        (self.folder / "bin/stipple").symlink_to(PROGRAM)
        done = subprocess.run(info["command"], shell=True, cwd=self.folder, text=True,
                              env={"PATH": str(self.folder / "bin")}, capture_output=True)
        self.assertEqual(done.returncode, 0, info["command"] + done.stderr)
        self.assertEqual((self.folder / "again.stipple").read_bytes(),
                         (self.folder / "first.stipple").read_bytes())
        return tomllib.loads(info["provenance"]), info["command"]

    def test_the_defaults_are_the_shortest_command(self):
        light = self.write_flat("light.npy", slots=6)
        provenance, command = self.made_again(light)
        self.assertEqual(command, "stipple emulate light.npy -o again.stipple")
        self.assertEqual(provenance["seed"], 1)
        self.assertEqual(provenance["footage"], {
            "name": "light.npy", "transfer": "linear", "luminance": False,
            "sha256": hashlib.sha256((self.folder / light).read_bytes()).hexdigest()})

    def test_odd_options_make_the_same_bytes_again(self):
        light = np.random.default_rng(1).random((9, 16, 32, 3))
        np.save(self.folder / "a scene's.npy", light)
        provenance, command = self.made_again(
            "a scene's.npy", "--transfer", "srgb", "--max-value", 0.51234567890123, "--luminance", "--min-value", 0.01,
            "--sensor", "lux1310", "--set", "sensor.slot_us=3.5", "--set", "sensor.timing.channels=8",
            "--set", "sensor.timing.code_load_clocks=0",
            "--set", "sensor.full_scale_e=1e4", "--schedule", "tiled", "--set", "schedule.tile_rows=8",
            "--overrun", "drop", "--seed", 2**64 - 1)
        self.assertEqual(shlex.split(command)[2], "a scene's.npy")
        self.assertEqual(provenance["footage"]["max_value"], 0.51234567890123)
        self.assertTrue(provenance["footage"]["luminance"])
        self.assertEqual(provenance["overrun"], "drop")
        self.assertEqual(provenance["seed"], str(2**64 - 1))  # TOML has no such number
        self.assertEqual(provenance["sensor"]["slot_us"], 3.5)
        self.assertEqual(provenance["sensor"]["timing"]["channels"], 8)
        self.assertEqual(provenance["sensor"]["timing"]["clock_hz"], 90_000_000)
        self.assertEqual(provenance["schedule"]["tile_rows"], 8)

    def test_files_of_sensor_schedule_and_frames(self):
        frames = [np.full((4, 6), 40 * i) for i in range(5)]
        for i, frame in enumerate(frames):
            self.write_png(f"scene/f{i}.png", frame)
        (self.folder / "my.toml").write_text('name = "my"\nfull_well_e = 900\n')
        self.succeed("schedule", "make", "tiled", "-o", "code.toml", "--size", "6x4", "--set",
                     "schedule.tile_rows=4", "--set", "schedule.tile_cols=6")
        provenance, command = self.made_again("scene/", "--sensor", "my.toml", "--schedule",
                                              "code.toml")
        self.assertEqual(command, "stipple emulate scene -o again.stipple --sensor my.toml "
                                  "--schedule code.toml")
        every = b"".join((self.folder / f"scene/f{i}.png").read_bytes() for i in range(5))
        self.assertEqual(provenance["footage"]["sha256"], hashlib.sha256(every).hexdigest())
        self.assertEqual(provenance["sensor"]["full_well_e"], 900)

    def test_a_command_with_control_characters_is_not_printed(self):
        self.write_flat("a\tb.npy", slots=6)
        self.succeed("emulate", "a\tb.npy", "-o", "a.stipple")
        self.assertIsNone(self.figures("info", "a.stipple")["command"])
        self.assertNotIn("again  ", self.succeed("info", "a.stipple"))

    def test_what_has_no_command_says_none(self):
        self.succeed("demo", "-o", "demo", "--frames", 16, "--size", "16x16")
        clip = next((self.folder / "demo").glob("*.stipple"))
        self.assertIsNone(self.figures("info", clip)["command"])


if __name__ == "__main__":
    unittest.main()
