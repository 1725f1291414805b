"""Keys and values of sensors and schedules that cannot be used are refused by name."""

import unittest

from program import INPUT, USAGE, ProgramTest


class BadSettingsTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write_flat("light.npy", slots=2)

    def refuse(self, parts, *arguments, code=INPUT):
        self.fails(code, parts, "emulate", "light.npy", "-o", "clip.stipple", *arguments)

    def test_an_unknown_key_with_the_nearest_known_one(self):
        self.refuse(["--set sensor.read_noise", "unknown", "read_noise_e"], "--set", "sensor.read_noise=3")
        self.refuse(["unknown"], "--schedule", "tiled", "--set", "schedule.tile_row=3")

    def test_a_setting_of_a_section_that_the_command_does_not_have(self):
        for setting in ("read_noise_e=5", "camera.Width=64", "sensors.bit_depth=8", "sensor"):
            self.refuse([setting, "begins with none of sensor., schedule."], "--set", setting, code=USAGE)

    def test_an_unknown_key_that_is_like_none_with_the_known_ones(self):
        message = "--set schedule.tile_rows: is unknown; known are exposure_slots, kind, name"
        self.refuse([message], "--set", "schedule.tile_rows=8")

    def test_a_policy_for_overruns_without_timing(self):
        self.refuse(["--overrun drop", "[timing]", "lux1310"], "--overrun", "drop")

    def test_a_value_out_of_range_with_the_range(self):
        for setting, limits in (("bit_depth=17", "1..16"), ("photons_per_unit=0", "0.001"),
                                ("read_noise_e=-1", "0..100000"), ("slot_us=nan", "slot_us")):
            self.refuse([setting.split("=")[0], limits], "--set", f"sensor.{setting}")
        self.refuse(["exposure_slots"], "--set", "schedule.exposure_slots=[65]")
        self.refuse(["exposure_slots"], "--set", "schedule.exposure_slots=[]")

    def test_a_key_of_the_physical_mode_in_paper_mode(self):
        self.refuse(["--set sensor.dsnu_e", 'mode = "physical"'], "--set", "sensor.dsnu_e=1")
        self.refuse(["prnu", "0..0.5"], "--sensor", "grasshopper", "--set", "sensor.prnu=2")
        self.refuse(["gain_map", "map_rows x map_cols = 1 x 1"], "--sensor", "ideal",
                    "--set", "sensor.gain_map=[1, 2]")
        self.refuse(["black_level_dn", "leaves nothing"], "--set", "sensor.mode=physical",
                    "--set", "sensor.read_noise_e=900")

    def test_a_colour_filter_array_without_colour(self):
        self.refuse(["cfa", "needs colour footage"], "--sensor", "ideal", "--set", "sensor.cfa=rggb")
        self.refuse(["cfa", "gbrg"], "--sensor", "ideal", "--set", "sensor.cfa=rgbg")

    def test_a_value_of_another_type(self):
        self.refuse(["bit_depth", "integer"], "--set", "sensor.bit_depth=many")
        self.refuse(["rounding", "nearest", "floor"], "--set", "sensor.rounding=up")

    def test_a_setting_without_a_value(self):
        self.refuse(["bit_depth"], "--set", "sensor.bit_depth")

    def test_a_file_by_file_and_line(self):
        (self.folder / "mine.toml").write_text('mode = "paper"\nread_noise = 3\n')
        self.refuse(["mine.toml:2", "read_noise", "unknown"], "--sensor", "mine.toml")
        (self.folder / "mine.toml").write_text('mode = "paper"\nbit_depth = = 3\n')
        self.refuse(["mine.toml", "2"], "--sensor", "mine.toml")
        (self.folder / "mine.toml").write_text('kind = "full"\n\nopen_slots = 65\n')
        self.refuse(["mine.toml:3", "open_slots", "1..64"], "--schedule", "mine.toml")

    def test_an_option_of_the_decoding_method(self):
        self.succeed("emulate", "light.npy", "-o", "clip.stipple")
        (self.folder / "mine.toml").write_text("rounds = 2\nlast_iterations = -1\n")
        for parts, options in ((["--set decoder.round", "rounds"], ["--set", "decoder.round=2"]),
                               (["--set decoder.rounds", "0..100"], ["--set", "decoder.rounds=-1"]),
                               (["rounds", "unknown"], ["--set", "decoder.rounds=2", "--method", "naive"]),
                               (["mine.toml:2", "0..10000"], ["--options", "mine.toml"]),
                               (["yours.toml", "No such file"], ["--options", "yours.toml"])):
            self.fails(INPUT, parts, "decode", "clip.stipple", "-o", "out.npy",
                       *([] if "--method" in options else ["--method", "fast"]), *options)

    def test_a_key_of_a_method_without_options(self):
        self.write_stream()
        self.fails(INPUT, ["--set decoder.foo: is unknown; there are no keys to set\n"], "decode", "clip.stipple", "-o",
                   "out.npy", "--method", "naive", "--set", "decoder.foo=1")

    def test_a_name_that_nobody_knows_with_the_known_ones(self):
        self.refuse(["nobody", "paper"], "--sensor", "nobody")
        self.refuse(["nobody", "full4x", "random", "tiled"], "--schedule", "nobody")

    def test_numbers_of_the_command_line(self):
        for option, value in (("--max-value", "nan"), ("--max-value", "0"), ("--max-value", "inf"), ("--min-value", "-0.1"),
                              ("--seed", "-1"), ("--seed", "1.5"), ("--threads", "-1"),
                              ("--seed", str(2**64)), ("--transfer", "log")):
            message = self.fails(USAGE, [option], "emulate", "light.npy", "-o", "clip.stipple",
                                 option, value)
            self.assertLess(len(message), 200)
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--seed", str(2**64 - 1))
        for option, value in (("--timeout", "nan"), ("--timeout", "-1"), ("--until", "0")):
            self.fails(USAGE, [option, value], "decode", "clip.stipple", "-o", "out.npy", option,
                       value)


if __name__ == "__main__":
    unittest.main()
