"""What is printed for people has the figures of the JSON of the same run, in the units that it names."""

import json
import math
import re
import unittest

import numpy as np

from program import ProgramTest

NUMBER = r"([\d.e+-]*\d)"


class TextsTest(ProgramTest):
    def told(self, *arguments):
        """The text and the figures of one run."""
        text = self.succeed(*arguments, "--json", "figures.json", "--force")
        return text, json.loads((self.folder / "figures.json").read_text())

    def check(self, text, pattern, *values):
        """The text has the values where the pattern has #, up to half of their last digit."""
        found = re.search(pattern.replace("#", NUMBER), text)
        self.assertIsNotNone(found, f"{pattern}\n{text}")
        for part, value in zip(found.groups(), values, strict=True):
            mantissa, _, exponent = part.partition("e")
            step = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
            self.assertAlmostEqual(float(part), value, delta=0.5001 * step, msg=found[0])

    def write_ramp(self):
        """Light from 0 to 6 in each slot."""
        return self.write_array("light.npy", np.broadcast_to(np.linspace(0, 6, 768).reshape(24, 32), (20, 24, 32)))

    def test_emulate_and_decode(self):
        text, figures = self.told("emulate", self.write_ramp(), "-o", "a.stipple", "--sensor", "lux1310", "--schedule",
                                  "pixel_flutter")
        self.assertEqual(len({figures["light_throughput"], figures["light_read"], figures["saturated_fraction"],
                              figures["zero_fraction"]}), 4)
        self.check(text, "a.stipple: # slots of 32 x 24 x 1, # samples of 12 bits, 1 for # values", figures["slots"],
                   figures["samples"], figures["compression_ratio"])
        self.check(text, "light throughput # %, # % read within the clip, # % of the samples saturated, # % at DN 0",
                   *(100 * figures[name] for name in ("light_throughput", "light_read", "saturated_fraction",
                                                      "zero_fraction")))
        readout = figures["readout"]
        self.assertEqual(len({readout["row_utilisation"], readout["adc_utilisation"], readout["link_utilisation"]}), 3)
        self.check(text, "readout +# slots/s of the sensor, # % of the rows read, ADCs # %, link # % busy",
                   readout["slots_hz"], *(100 * readout[f"{part}_utilisation"] for part in ("row", "adc", "link")))
        self.check(text, "# bits over the link, # uJ; schedule memory # bits, code # Mbit/s", readout["link_bits"],
                   readout["energy_uj"], readout["schedule_memory_bits"], 1e-6 * readout["code_load_bits_per_second"])
        text, figures = self.told("decode", "a.stipple", "-o", "a.npy", "--method", "naive")
        self.check(text, "a.npy: # frames, method naive, # s, # million voxels/s, # MB", figures["slots"],
                   figures["seconds"], 1e-6 * figures["voxels_per_second"], figures["peak_memory_bytes"] // 1000000)
        self.check(text, "# % of the samples saturated, # % at DN 0", 100 * figures["saturated_fraction"],
                   100 * figures["zero_fraction"])

    def test_a_rate_of_a_hundred_thousand_has_no_exponent(self):
        for slot_us, rate in ((10, 100000), (8.1, 123457)):
            text = self.succeed("emulate", self.write_ramp(), "-o", "a.stipple", "--sensor", "lux1310", "--overrun", "drop",
                                "--set", f"sensor.slot_us={slot_us}", "--force")
            self.assertIn(f"readout      {rate} slots/s of the sensor", text)

    def test_timing(self):
        text, figures = self.told("timing", "--sensor", "lux1310")
        self.check(text, "full +# readouts/s: # clocks, # a row", figures["full_readout_hz"], figures["frame_clocks"],
                   figures["row_clocks"])
        self.check(text, "coded +# slots/s of # clocks; the slowest readout takes # clocks and must end within # slot",
                   figures["coded_readout_hz"], figures["min_slot_clocks"], figures["slowest_readout_clocks"],
                   figures["deadline_slots"])
        self.check(text, "speed-up +#, limited by link; # if", figures["speedup"], figures["balanced_speedup"])
        self.check(text, "in use +rows # %, ADCs # %, link # %",
                   *(100 * figures[f"{part}_utilisation"] for part in ("row", "adc", "link")))
        self.check(text, "energy +# uJ a full readout, # pJ a sample; # uJ a slot, # pJ a sample",
                   *(figures[name] for name in ("full_energy_uj", "full_sample_energy_pj", "slot_energy_uj",
                                                "slot_sample_energy_pj")))
        self.check(text, "code +# bits of schedule memory, # Mbit/s, # clocks to load", figures["schedule_memory_bits"],
                   1e-6 * figures["code_load_bits_per_second"], figures["code_load_clocks"])
        self.check(text, "slot +# clocks", figures["slot_clocks"])
        self.assertEqual(len({figures["min_slot_clocks"], figures["frame_clocks"], figures["slot_clocks"]}), 3)

    def test_schedule(self):
        text, figures = self.told("schedule", "show", "pixel_flutter")
        self.assertLess(figures["light_throughput"], 1)
        self.check(text, "compression # in steady state, light throughput # %", figures["compression_ratio"],
                   100 * figures["light_throughput"])

    def test_compare(self):
        light = self.write_ramp()
        self.write_array("other.npy", self.array(light) + 0.01)
        for peak in (1, 3):
            text, figures = self.told("compare", "other.npy", light, "--peak", peak)
            self.check(text, r"PSNR +# dB +linear, peak #\n", 20 * np.log10(peak / 0.01), figures["peak"])
            self.check(text, "PU21-PSNR +# dB.*1.0 = # cd/m2", figures["pu21_psnr_db"], figures["cd_per_unit"])
            self.check(text, "SSIM +#", figures["ssim"])

    def test_info_of_streams_and_rigs(self):
        self.write_ramp()
        self.succeed("emulate", "light.npy", "-o", "a.stipple", "--sensor", "lux1310", "--schedule", "tiled")
        text, figures = self.told("info", "a.stipple")
        calibration = figures["calibration"]
        self.check(text, "samples +# bits, # e/DN, black level # DN, read noise # e, full well # e\nlight 1.0 +# e per slot",
                   *(calibration[name] for name in ("bit_depth", "gain_e_per_dn", "black_level_dn", "read_noise_e",
                                                    "full_well_e", "electrons_per_unit")))
        self.check(text, "holds +# slots, # packets, # samples, # payload bits",
                   *(figures[name] for name in ("slots", "packets", "samples", "payload_bits")))
        (self.folder / "two.toml").write_text('sensors = ["a", "b"]\na.share = 0.75\nb = { share = 0.25, schedule = "full1x" }\n')
        emulated = self.figures("emulate", "light.npy", "-o", "rig", "--rig", "two.toml")
        text, figures = self.told("info", "rig")
        self.assertAlmostEqual(figures["light_collected"], emulated["light_collected"])
        self.check(text, "total +# % of the light of an aperture collected, # bits a slot, # Mbit/s",
                   100 * figures["light_collected"], figures["bits_per_slot"], 1e-6 * figures["bits_per_second"])

    def test_parts_and_what_is_joined_of_them(self):
        self.write_flat("light.npy", 150)
        self.succeed("emulate", "light.npy", "-o", "clip.stipple")
        for verb, word, footage, output in (("emulate", "piece", "light.npy", "joined.stipple"),
                                            ("decode", "window", "clip.stipple", "joined.npy")):
            part = (verb, footage, "-o", word, "--part", "1/1", *(["--method", "naive"] if verb == "decode" else []))
            self.succeed(*part)
            (sorted((self.folder / word).glob(f"{word}_*"))[1]).unlink()
            text = self.succeed(*part, "--json", f"{verb}.json")
            figures = json.loads((self.folder / f"{verb}.json").read_text())
            done = figures[f"{word}s_{verb}d"]
            self.check(text, f"part # of #, # of # {word}s {verb}d, # kept", 1, 1, done, figures[f"{word}s"],
                       figures[f"{word}s"] - done)
            self.assertEqual((done, figures[f"{word}s"]), (1, 3))
            text, figures = self.told("join", word, "-o", output)
            self.check(text, f"{output}: # [a-z]+ of # {word}s", figures["slots"], figures[f"{word}s"])

    def test_import(self):
        random = np.random.default_rng(1)
        self.write_array("meas.npy", random.uniform(0.1, 1, (3, 6, 8)))
        for weights, kind in ((random.uniform(0.2, 1, (4, 6, 8)), "grey"), (np.ones((4, 6, 8)), "binary")):
            text, figures = self.told("import", "meas.npy", "--masks", self.write_array("masks.npy", weights), "-o",
                                      "a.stipple")
            self.check(text, f"a.stipple: # measurements of # x # pixels, # {kind} masks, light 1.0 is #",
                       figures["measurements"], figures["cols"], figures["rows"],
                       figures["slots"] / figures["measurements"], figures["light"])

    def test_calibrate(self):
        text, figures = self.told("calibrate", "--sensor", "t6", "--set", "sensor.response_loss=0.16", "--size", "32x24",
                                  "-o", "a.stcal", "--flats", 60, "--darks", 50)

        self.check(text, "a.stcal: # x # pixels from # flats and # darks of each", figures["cols"], figures["rows"],
                   figures["flats"], figures["darks"])
        self.check(text, r"gain +1 \+- #, uncertainty #", figures["gain"]["deviation"],
                   figures["gain_error"])
        for name, line in (("offset_dn", r"offset +# \+- # DN"), ("dark_dn_per_s", r"dark current +# \+- # DN/s")):
            self.check(text, line, figures[name]["mean"], figures[name]["deviation"])
        self.check(text, "readout noise # DN", math.sqrt(figures["readout_noise_dn2"]["mean"]))
        bent = figures["response"]
        self.check(text, r"# DN stand for # \+- # linear DN, by # levels", bent["brightest_dn"],
                   bent["brightest_dn"] + bent["bend_dn"], bent["error_dn"], bent["levels"])
        self.check(text, "defects +#", figures["defects"])


if __name__ == "__main__":
    unittest.main()
