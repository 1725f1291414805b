"""`stipple list keys` lists what --set takes, with the defaults that hold where nothing is set."""

import shutil
import subprocess
import tomllib
import unittest

import numpy as np

from program import INPUT, PROGRAM, USAGE, ProgramTest, project_path


def flat(table, prefix=""):
    for key, value in table.items():
        if isinstance(value, dict):
            yield from flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key


class KeysTest(ProgramTest):
    def keys(self, *which):
        return self.figures("list", "keys", *which)["keys"]

    def defaults(self, *which):
        """Arguments that set every key to its default, but those that choose what is listed."""
        settings = [f"{key['name']}={key['default']}" for key in self.keys(*which)
                    if key["default"] and key["name"] not in ("sensor.mode", "schedule.kind", "schedule.name")]
        self.assertTrue(settings)
        return [word for setting in settings for word in ("--set", setting)]

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def emulated(self, *arguments):
        """The samples that emulated footage becomes, as light."""
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--force", *arguments)
        self.succeed("decode", "clip.stipple", "-o", "naive.npy", "--method", "naive", "--force")
        return self.array("naive.npy")

    def test_a_program_without_its_configurations_says_so(self):
        shutil.copy(PROGRAM, self.folder / "alone")
        done = subprocess.run([self.folder / "alone", "list", "sensors"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (INPUT, ""))
        self.assertIn("there is no sensors/ in ", done.stderr)

    def test_the_keys_of_a_sensor_are_those_of_its_mode_and_timing(self):
        for sensor, kinds in (("ideal", {"paper", "physical", "timing"}), ("lux1310", {"paper", "timing"}),
                              ("paper", {"paper"})):  # the last is the name of a mode too
            self.assertEqual({key["of"] for key in self.keys("sensor", sensor)}, kinds)
        self.fails(USAGE, ['"random" is unknown'], "list", "keys", "sensor", "random")

    def test_the_keys_of_every_sensor_and_schedule_are_listed(self):
        files = [("sensor", file) for file in project_path("config/sensors").glob("*.toml")]
        files += [("schedule", file) for file in project_path("config/schedules").glob("*.toml")]
        self.assertGreater(len(files), 20)
        listed = {(key["of"], key["name"]) for key in self.keys()}
        for section, file in files:
            table = tomllib.loads(file.read_text())
            kinds = ("paper", "physical", "timing") if section == "sensor" else (table["kind"],)
            for key in flat(table):
                self.assertTrue(any((kind, f"{section}.{key}") in listed for kind in kinds), f"{file}: {key}")

    def test_the_files_that_show_every_key_of_a_mode_do(self):
        def value(default):
            try:
                return tomllib.loads(f"value = {default}")["value"]
            except tomllib.TOMLDecodeError:
                return default

        paper, ideal = (tomllib.loads(project_path(f"config/sensors/{name}.toml").read_text())
                        for name in ("paper", "ideal"))
        listed = {key["name"].removeprefix("sensor."): value(key["default"])
                  for key in self.keys("sensor", "paper")}
        self.assertEqual(paper, listed)
        physical = {key["name"].removeprefix("sensor.") for key in self.keys("sensor", "physical")}
        self.assertEqual(ideal.keys(), listed.keys() | physical)

    def test_the_defaults_of_a_sensor_hold_where_nothing_is_set(self):
        self.write_array("light.npy", np.random.default_rng(1).random((16, 12, 20)))
        paper = self.defaults("sensor", "paper")
        for mode, settings in (("paper", paper), ("physical", paper + self.defaults("sensor", "physical"))):
            sensor = ["--sensor", self.write("mine.toml", f'mode = "{mode}"\n')]
            np.testing.assert_array_equal(self.emulated(*sensor, *settings), self.emulated(*sensor), mode)
        sensor = self.write("mine.toml", "[timing]\nclock_hz = 1000000\nrows = 12\ncols = 20\n")
        line = ("timing", "--sensor", sensor, "--schedule", "tiled")
        self.assertEqual(self.figures(*line, *self.defaults("sensor", "timing")), self.figures(*line))

    def test_the_defaults_of_a_schedule_hold_where_nothing_is_set(self):
        self.write_array("light.npy", np.random.default_rng(1).random((24, 16, 16)))
        kinds = {key["of"] for key in self.keys("schedule")}
        self.assertEqual(len(kinds), 9)
        for kind in kinds:
            code = 'code = ["A"]\n' if kind == "code" else ""
            schedule = ["--schedule", self.write("mine.toml", f'kind = "{kind}"\n{code}')]
            np.testing.assert_array_equal(self.emulated(*schedule, *self.defaults("schedule", kind)),
                                          self.emulated(*schedule), kind)

    def test_the_defaults_of_a_method_hold_where_nothing_is_set(self):
        self.write_array("light.npy", np.random.default_rng(1).random((12, 16, 16)))
        self.succeed("emulate", "light.npy", "-o", "clip.stipple")
        self.assertEqual(self.keys("decoder", "naive"), [])
        self.assertEqual(self.succeed("list", "keys", "decoder", "naive"), "decoder naive: no keys\n")
        for method in ("fast", "best", "portz2013", "reddy2011"):
            decoded = []
            for settings in ([], self.defaults("decoder", method)):
                self.succeed("decode", "clip.stipple", "-o", "out.npy", "--force", "--method", method, *settings)
                decoded.append(self.array("out.npy"))
            np.testing.assert_array_equal(*decoded, method)

    def test_each_key_has_a_line(self):
        keys = self.keys()
        lines = [line.split() for line in self.succeed("list", "keys").splitlines() if line.startswith("  ")]
        self.assertEqual([line[0] for line in lines], [key["name"] for key in keys])
        text = self.succeed("list", "keys", "sensor", "paper")
        self.assertRegex(text, r"sensor\.read_noise_e +10 +sigma: .* \(electrons, 0\.\.100000\)\n")
        self.assertRegex(text, r"sensor\.rounding +nearest +rounding of the converter \(nearest, floor\)\n")
        for key in keys:
            self.assertTrue(key["text"], key)

    def test_what_cannot_be_listed(self):
        self.fails(USAGE, ["SECTION", '"sensor" is more than stipple list sensors takes'], "list", "sensors",
                   "sensor")
        self.fails(USAGE, ["SECTION", '"camera"'], "list", "keys", "camera")
        self.fails(USAGE, ["OF", '"fats" is unknown', 'did you mean "fast"?'], "list", "keys", "decoder", "fats")
        for command in ("emulate", "decode", "timing"):
            self.assertIn("(stipple list keys)", " ".join(self.succeed(command, "--help").split()))
        self.assertNotIn("list keys", self.succeed("capture", "record", "--help"))


if __name__ == "__main__":
    unittest.main()
