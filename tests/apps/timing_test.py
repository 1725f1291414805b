"""How fast sensors read: `timing`, and the readout's cost and waveform of `emulate`."""

import re
import shutil
import struct
import subprocess
import unittest

import numpy as np
from program import DEVICE, INPUT, USAGE, ProgramTest
from sample_stream import parts

SENSORS = ("cmv4000", "imx273", "imx296", "lux1310", "lux2100", "plc720", "sp5000", "vita")
SMALL = ["--roi", "64x32"]


class TimingTest(ProgramTest):
    def test_figures_of_a_conventional_camera_are_the_published_ones(self):
        for sensor, clocks, hertz in (("lux1310", 84143, 90e6), ("imx296", 1118 * 1100, 74.25e6),
                                      ("vita", 1024 * 392, 62e6)):
            figures = self.figures("timing", "--sensor", sensor, "--schedule", "full4x")
            self.assertEqual(figures["frame_clocks"], clocks)
            self.assertAlmostEqual(figures["frame_time_s"], clocks / hertz, places=12)
            self.assertAlmostEqual(figures["full_readout_hz"], hertz / clocks, places=6)
            # A frame of 4 slots is transferred while the next one is exposed.
            self.assertAlmostEqual(figures["coded_readout_hz"], 4 * hertz / clocks, places=6)
            self.assertEqual(figures["speedup"], 4)

    def test_every_sensor_has_figures_that_agree_with_one_another(self):
        for sensor in SENSORS:
            it = self.figures("timing", "--sensor", sensor, *SMALL)
            self.assertAlmostEqual(it["speedup"], it["coded_readout_hz"] / it["full_readout_hz"])
            self.assertLessEqual(it["speedup"], it["balanced_speedup"] * 1.000001)
            self.assertIn(it["limited_by"], ("adc", "link", "row_overhead", "code_load"))
            self.assertLessEqual(it["mean_slot_clocks"], it["min_slot_clocks"])
            self.assertAlmostEqual(it["min_slot_clocks"] * it["coded_readout_hz"] / it["full_readout_hz"],
                                   it["frame_clocks"], places=6)
            self.assertEqual(it["fits_slot"], it["min_slot_clocks"] <= it["slot_clocks"])
            self.assertTrue(it["exposes_while_reading"])
            self.assertEqual(it["schedule_memory_bits"], 64 * 32 * 15)
            for share in ("row_utilisation", "adc_utilisation", "link_utilisation"):
                self.assertTrue(0 < it[share] <= 1, (sensor, share))
            for readout, samples in (("full", 64 * 32), ("slot", it["samples_per_slot"])):
                self.assertAlmostEqual(it[f"{readout}_energy_uj"] * 1e6,
                                       it[f"{readout}_sample_energy_pj"] * samples, places=3)

    def test_a_chip_that_is_not_for_sale_is_called_hypothetical(self):
        text = self.succeed("timing", "--sensor", "lux1310", "--schedule", "hardware_tiled")
        self.assertTrue(text.splitlines()[1].startswith("hypothetical the commercial chip"))
        self.assertIn("reads whole windows", text)
        self.assertIn("settle for 79 clocks in full, 20 in the slowest readout", text)
        figures = self.figures("timing", "--sensor", "imx273", *SMALL)
        self.assertIn("8 channels", figures["hypothetical"])
        figures = self.figures("timing", "--sensor", "lux1310", "--schedule", "hardware_tiled")
        self.assertEqual(figures["full_settle_clocks"], 79)
        self.assertEqual(figures["slowest_settle_clocks"], 20)
        arguments = ("timing", "--sensor", "lux1310", *SMALL, "--set", "sensor.timing.hypothetical=''")
        self.assertIsNone(self.figures(*arguments)["hypothetical"])
        self.assertNotIn("hypothetical", self.succeed(*arguments))

    def test_rates_and_clocks_are_told_without_powers_of_ten(self):
        window = ("timing", "--sensor", "lux1310", "--roi", "50x4")
        it = self.figures(*window)
        self.assertGreater(it["coded_readout_hz"], 1e5)
        said = self.succeed(*window)
        self.assertIn(f"coded        {it['coded_readout_hz']:.0f} slots/s of ", said)
        self.assertIn(f"full         {it['full_readout_hz']:.0f} readouts/s: ", said)
        whole = ("timing", "--sensor", "imx296", "--schedule", "full1x", "--set", "sensor.timing.exposes_while_reading=false",
                 "--set", "sensor.slot_us=50000")
        clocks = self.figures(*whole)["min_slot_clocks"]
        self.assertGreater(clocks, 1e6)
        self.assertIn(f" slots/s of {clocks:.0f} clocks", self.succeed(*whole))

    def test_skipping_saves_the_link_and_not_the_conversion(self):
        it = self.figures("timing", "--sensor", "lux1310")
        pixels = 1280 * 1024
        conversion, link = 100 * 2 ** (12 - 10), 12 * 10  # pJ of a sample
        rows = 1024 * 100
        self.assertAlmostEqual(it["full_sample_energy_pj"], conversion + link + rows / pixels)
        self.assertAlmostEqual(it["full_energy_uj"] * 1e6, it["full_sample_energy_pj"] * pixels)
        slot = rows + pixels * (conversion + 4.4) + it["samples_per_slot"] * link
        self.assertAlmostEqual(it["slot_energy_uj"] * 1e6, slot, delta=1)
        self.assertAlmostEqual(it["slot_sample_energy_pj"], slot / it["samples_per_slot"], places=3)
        text = self.succeed("timing", "--sensor", "lux1310")
        self.assertIn(f"{it['slot_sample_energy_pj']:.4g} pJ a sample", text)
        self.assertIn("assumed", text)

    def test_info_says_how_long_stretched_slots_were(self):
        self.write_flat("light.npy", slots=32, rows=40, cols=30)
        sensor = ("--sensor", "imx296", "--set", "sensor.slot_us=50")
        emulated = self.figures("emulate", "light.npy", "-o", "a.stipple", *sensor)["readout"]
        self.assertEqual(emulated["overrun_slots"], 32)
        info = self.figures("info", "a.stipple")
        self.assertEqual(info["stretched_slots"], 32)
        mean_us = emulated["seconds"] / 32 * 1e6
        self.assertAlmostEqual(info["mean_stretched_us"], mean_us, places=6)
        self.assertIn(f"a slot is nominally 50 us; 32 of 32 slots were stretched, mean {mean_us:.4g} us",
                      self.succeed("info", "a.stipple"))
        self.assertEqual(self.figures("emulate", "light.npy", "-o", "b.stipple", "--sensor",
                                      "imx296", "--set", "sensor.slot_us=5000")["readout"]["overrun_slots"],
                         0)
        self.assertNotIn("nominally", self.succeed("info", "b.stipple"))

    def test_frames_of_the_sold_chip_lose_nothing_at_its_frame_rate(self):
        self.write_flat("light.npy", slots=16, rows=1024, cols=1280)
        slot = ("--sensor", "lux1310", "--set", "sensor.slot_us=333.333")
        for schedule in ("full1x", "full4x"):
            readout = self.figures("emulate", "light.npy", "-o", "a.stipple", "--force", "--schedule", schedule,
                                   "--overrun", "drop", *slot)["readout"]
            self.assertEqual((readout["overrun_slots"], readout["dropped_samples"]), (0, 0))
            self.succeed("schedule", "check", schedule, "--size", "1280x1024", *slot)
        self.fails(1, ["must end within 1 slot of 333.333 us", "934.922 us"], "schedule", "check", "tiled", "--size",
                   "1280x1024", *slot)

    def test_a_chip_that_cannot_expose_while_it_reads_takes_the_sum_of_both(self):
        arguments = ("timing", "--sensor", "lux1310", "--set", "sensor.timing.exposes_while_reading=false")
        frames = self.figures(*arguments, "--schedule", "full1x")
        self.assertEqual(frames["min_slot_clocks"], (45000 + 84143) / 4)
        coded = self.figures(*arguments)
        self.assertEqual(coded["min_slot_clocks"], 45000 + coded["slowest_readout_clocks"])
        self.assertIn(f"takes {coded['slowest_readout_clocks']} clocks, while no pixel exposes", self.succeed(*arguments))
        self.write_flat("light.npy", slots=16, rows=8, cols=16)
        self.fails(INPUT, ["cannot expose while it reads", "stretch"], "emulate", "light.npy", "-o", "a.stipple",
                   "--overrun", "drop", *arguments[1:])

    def test_the_list_of_sensors_says_what_coding_gains(self):
        for sensor in SENSORS:
            line = next(line for line in self.succeed("list", "sensors").splitlines() if line.startswith(sensor))
            told = re.search(r"coded ([\d.]+)(?: to ([\d.]+))? slots per full readout", line)
            gains = [self.figures("timing", "--sensor", sensor, "--schedule", schedule)["speedup"]
                     for schedule in ("random", "hardware_tiled")]
            self.assertEqual([f"{gain:.2f}" for gain in gains], [told[1], told[2] or told[1]])

    def test_a_sensor_without_timing_is_refused_with_those_that_have_it(self):
        message = self.fails(INPUT, ["paper", "[timing]"], "timing", "--sensor", "paper")
        for sensor in SENSORS:
            self.assertIn(sensor, message)

    def test_size_is_another_name_of_roi(self):
        self.assertEqual(self.figures("timing", "--sensor", "lux1310", "--size", "64x32"),
                         self.figures("timing", "--sensor", "lux1310", *SMALL))

    def test_impossible_timing_names_the_constraint(self):
        for parts, arguments in (
                (["2000 x 100", "1280 x 1024"], ["--roi", "2000x100"]),
                (["7 channels", "1280 columns"], ["--set", "sensor.timing.channels=7"]),
                (["timing.clock_hz", "1.."], ["--set", "sensor.timing.clock_hz=0"]),
                (["0 clocks"], ["--set", "sensor.timing.io_clocks=0", "--set",
                                "sensor.timing.clocks_per_column=0"]),
                (["slot_us", "clock"], ["--set", "sensor.slot_us=0.001", "--set", "sensor.timing.clock_hz=1"])):
            self.fails(INPUT, parts, "timing", "--sensor", "lux1310", *arguments)
        for roi in ("12", "0x5", "5x", "axb"):
            self.fails(USAGE, ["--roi"], "timing", "--sensor", "lux1310", "--roi", roi)
        self.fails(USAGE, ["--sensor"], "timing")


class ReadoutOfARecordingTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write_flat("light.npy", slots=20, rows=32, cols=64)

    def emulate(self, *arguments):
        return self.figures("emulate", "light.npy", "-o", "clip.stipple", "--force", "--sensor",
                            "lux1310", *arguments)

    def test_the_account_is_that_of_all_slots(self):
        figures = self.emulate()
        readout = figures["readout"]
        self.assertEqual(readout["slot_clocks"], 45000)  # 500 us at 90 MHz
        self.assertEqual(readout["clocks"], 20 * 45000)
        self.assertEqual((readout["overrun_slots"], readout["dropped_samples"]), (0, 0))
        self.assertEqual(readout["transferred_samples"], figures["samples"])
        self.assertEqual(readout["link_bits"], figures["payload_bits"])
        self.assertAlmostEqual(readout["slots_hz"], 2000)
        self.assertAlmostEqual(readout["sample_energy_pj"] * figures["samples"],
                               readout["energy_uj"] * 1e6, places=3)

    def test_a_sensor_without_timing_has_no_account(self):
        self.assertNotIn("readout", self.figures("emulate", "light.npy", "-o", "a.stipple"))

    def test_rows_that_do_not_fit_are_dropped_and_the_rest_decodes(self):
        whole = self.emulate("--set", "sensor.timing.code_load_clocks=0")
        cut = self.emulate("--set", "sensor.timing.code_load_clocks=0", "--set", "sensor.slot_us=6",
                           "--overrun", "drop")
        readout = cut["readout"]
        packets = parts((self.folder / "clip.stipple").read_bytes())[1][:-1]  # without the index
        dropped = [struct.unpack_from("<Q", packet, 8) for packet in packets if packet[5] & 2]
        self.assertEqual(readout["overrun_slots"], len(set(dropped)))
        self.assertEqual(readout["overrun_slots"], 20)
        self.assertEqual(readout["clocks"], 20 * 540)
        self.assertEqual(cut["samples"] + readout["dropped_samples"], whole["samples"])
        self.assertEqual(cut["payload_bits"], 12 * cut["samples"])
        self.assertLess(cut["light_read"], 0.9 * whole["light_read"])
        report = self.figures("info", "clip.stipple")
        self.assertEqual(report["samples"], cut["samples"])
        self.assertEqual((report["slots"], report["missing_slots"], report["damage"]), (20, 0, []))
        self.assertEqual(report["packets"], len(packets))
        for method in ("naive", "fast"):
            self.succeed("decode", "clip.stipple", "-o", "out.npy", "--method", method, "--force",
                         "--strict")
            video = self.array("out.npy")
            self.assertEqual(video.shape, (20, 32, 64))
            self.assertTrue(np.isfinite(video).all())
            np.testing.assert_allclose(video[8:, :8].mean(), 0.2, rtol=0.05)

    def test_overruns_stretch_their_slots_and_lose_nothing(self):
        whole = self.emulate()
        slow = ["--set", "sensor.slot_us=6", "--set", f"sensor.timing.code_load_clocks={2700 * 1024 // 32}"]
        stretched = self.emulate(*slow, "--overrun", "stretch")
        self.assertEqual(stretched["samples"], whole["samples"])
        readout = stretched["readout"]
        self.assertEqual(readout["overrun_slots"], 20)  # the code takes 30 us to load
        self.assertEqual(readout["clocks"], 20 * 2700)
        text = self.succeed("emulate", "light.npy", "-o", "b.stipple", "--sensor", "lux1310",
                            "--set", "sensor.slot_us=6")
        self.assertIn("--overrun drop", text)

    def test_what_dropping_cannot_help_is_refused(self):
        self.fails(INPUT, ["slot_us", "exposure code"], "emulate", "light.npy", "-o", "x.stipple",
                   "--sensor", "lux1310", "--set", "sensor.slot_us=2", "--overrun", "drop")
        self.fails(INPUT, ["1280 x 1024"], "emulate",
                   self.write_flat("tall.npy", slots=1, rows=1025), "-o", "x.stipple", "--sensor",
                   "lux1310")
        self.fails(USAGE, ["--overrun"], "emulate", "light.npy", "-o", "x.stipple", "--overrun",
                   "ignore")


class WaveformTest(ProgramTest):
    def changes(self, name):
        """Number of times, and the signals, of a VCD file."""
        text = (self.folder / name).read_text()
        return (len(re.findall(r"^#\d+$", text, re.M)),
                re.findall(r"^\$var wire \d+ \S+ (\w+)", text, re.M))

    def test_a_waveform_reader_takes_the_file(self):
        for tool in ("vcd2fst", "fst2vcd"):
            if shutil.which(tool) is None:
                self.skipTest(f"there is no {tool}; it is in the Debian package gtkwave")
        self.succeed("timing", "--sensor", "lux1310", *SMALL, "--vcd", "readout.vcd")
        for command in (["vcd2fst", "readout.vcd", "readout.fst"],
                        ["fst2vcd", "readout.fst", "-o", "back.vcd"]):
            subprocess.run(command, cwd=self.folder, check=True, capture_output=True, timeout=60)
        times, signals = self.changes("readout.vcd")
        self.assertEqual(self.changes("back.vcd"), (times, signals))
        self.assertGreater(times, 100)
        for signal in ("slot_start", "row_select", "adc_busy", "link_valid", "channel_busy",
                       "code_load"):
            self.assertIn(signal, signals)

    @unittest.skipUnless(shutil.which("vcd2fst"), "there is no vcd2fst; it is in the Debian package gtkwave")
    def test_an_fst_file_holds_the_same_waveform(self):
        readout = ("timing", "--sensor", "lux1310", *SMALL, "--vcd")
        self.succeed(*readout, "readout.vcd")
        self.succeed(*readout, "waves.fst")
        subprocess.run(["fst2vcd", "waves.fst", "-o", "back.vcd"], cwd=self.folder, check=True,
                       capture_output=True, timeout=60)
        self.assertEqual(self.values("back.vcd"), self.values("readout.vcd"))
        self.assertEqual(self.names(), ["back.vcd", "readout.gtkw", "readout.vcd", "waves.fst",
                                        "waves.gtkw"])

    def values(self, name):
        """The changes of each signal of a VCD file: (time, value)."""
        text = (self.folder / name).read_text()
        names = dict(re.findall(r"^\$var wire \d+ (\S+) (\w+)", text, re.M))
        changes, time = {}, 0
        for line in text.split("$enddefinitions $end")[1].splitlines():
            if line.startswith("#"):
                time = int(line[1:])
            elif change := re.fullmatch(r"b([01]+) (\S+)|([01])(\S+)", line):
                value, code = change.group(1) or change.group(3), change.group(2) or change.group(4)
                signal = changes.setdefault(names[code], [])
                if not signal or signal[-1][1] != int(value, 2):
                    signal.append((time, int(value, 2)))
        return changes

    def test_the_save_file_shows_every_signal_of_the_waveform(self):
        for name, channels in (("many", 16), ("one", 1)):
            self.succeed("timing", "--sensor", "lux1310", *SMALL, "--vcd", f"{name}.vcd",
                         "--set", f"sensor.timing.channels={channels}")
            scope, = re.findall(r"scope module (\w+)", (self.folder / f"{name}.vcd").read_text())
            signals = re.findall(r"^\$var wire \d+ \S+ (\w+)(?: (\S+))? \$end", (self.folder / f"{name}.vcd").read_text(), re.M)
            save = (self.folder / f"{name}.gtkw").read_text()
            self.assertIn(f'[dumpfile] "{name}.vcd"', save)
            self.assertEqual(sorted(re.findall(r"^\w+\..*$", save, re.M)),
                             sorted(f"{scope}.{signal}{bits}" for signal, bits in signals))
            # Rows are signed decimal numbers: dark rows are below 0.
            self.assertRegex(save, rf"@420\n{scope}\.row\[31:0\]\n")

    def test_an_fst_file_needs_its_converter(self):
        self.fails(DEVICE, ["vcd2fst", "install the package gtkwave", ".vcd"], "timing", "--sensor", "vita",
                   *SMALL, "--vcd", "readout.fst", env={"PATH": "/nowhere"})

    def test_a_save_file_is_not_replaced(self):
        (self.folder / "readout.gtkw").write_text("precious")
        readout = ("timing", "--sensor", "vita", *SMALL, "--vcd", "readout.vcd")
        self.fails(INPUT, ["readout.gtkw", "--force"], *readout)
        self.succeed(*readout, "--force")
        self.assertIn("readout.vcd", (self.folder / "readout.gtkw").read_text())

    def test_a_waveform_ends_after_the_slots_asked_for(self):
        self.write_flat("light.npy", slots=6, rows=32, cols=64)
        for slots, expected in ((2, 2), (16, 6)):
            self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--sensor", "lux1310",
                         "--vcd", "readout.vcd", "--vcd-slots", slots, "--force")
            last = (self.folder / "readout.vcd").read_text().split("#")[-1]
            self.assertEqual(int(last.split()[0]), expected * 500 * 10**6)  # ps

    def test_files_that_cannot_be_written_are_refused_before_the_work(self):
        self.write_flat("light.npy", slots=2)
        self.fails(INPUT, ["--vcd", "[timing]"], "emulate", "light.npy", "-o", "a.stipple", "--vcd",
                   "readout.vcd")
        self.succeed("timing", "--sensor", "vita", *SMALL, "--vcd", "readout.vcd")
        self.fails(INPUT, ["readout.vcd", "--force"], "timing", "--sensor", "vita", *SMALL,
                   "--vcd", "readout.vcd")
        self.fails(USAGE, ["--vcd-slots requires --vcd"], "timing", "--sensor", "vita", *SMALL,
                   "--vcd-slots", 3)


if __name__ == "__main__":
    unittest.main()
