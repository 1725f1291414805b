"""The chip in gates for a sensor: `rtl`, and what the tools of the field make of its folder."""

import re
import shutil
import subprocess
import unittest

import numpy as np
from program import INPUT, USAGE, ProgramTest

# Small tiles and short slots: Icarus Verilog runs some thousand clocks a second.
SMALL = ["--schedule", "tiled", "--set", "schedule.tile_rows=4", "--set", "schedule.tile_cols=8"]
SENSORS = {"lux1310": ["--size", "16x8", "--slots", 8],
           "imx273": ["--size", "16x6", "--slots", 7, "--set", "sensor.slot_us=3000"],
           "vita": ["--size", "20x7", "--slots", 7, "--set", "sensor.slot_us=300"]}


def needs(tool, package):
    return unittest.skipUnless(shutil.which(tool), f"{tool} (package {package}) is not installed")


class RtlTest(ProgramTest):
    def design(self, sensor="lux1310", *more):
        self.succeed("rtl", "--sensor", sensor, *SMALL, *SENSORS[sensor], *more, "-o", f"{sensor}_chip")
        return self.folder / f"{sensor}_chip"

    def make(self, folder, *arguments):
        run = subprocess.run(["make", *arguments], cwd=folder, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, text=True, timeout=250, check=False)
        self.assertEqual(run.returncode, 0, run.stdout[-3000:])
        return run.stdout

    def expect_equal_packets(self, folder, *arguments):
        self.assertIn("packets equal", self.make(folder, *arguments))
        self.assertEqual((folder / "chip.stipple").read_bytes(), (folder / "expected.stipple").read_bytes())
        self.assertGreater((folder / "packets.bin").stat().st_size, 200)
        self.assertIn("slots", self.succeed("info", folder / "chip.stipple"))

    def expect_other_packets(self, folder):
        run = subprocess.run(["make", "SIMULATOR=icarus"], cwd=folder, capture_output=True, text=True,
                             timeout=250, check=False)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("differ", run.stdout + run.stderr)

    @needs("make", "make")
    @needs("iverilog", "iverilog")
    def test_icarus_gets_the_packets_of_the_emulator(self):
        for sensor in SENSORS:
            self.expect_equal_packets(self.design(sensor), "SIMULATOR=icarus")

    @needs("make", "make")
    @needs("iverilog", "iverilog")
    def test_rows_may_be_dropped_and_the_scene_filmed(self):
        light = np.random.default_rng(1).random((8, 8, 16))
        self.write_array("light.npy", light)
        self.succeed("rtl", "--sensor", "lux1310", *SMALL, "--footage", "light.npy", "--overrun", "drop",
                     "--set", "sensor.slot_us=300", "-o", "drop")
        folder = self.folder / "drop"
        self.expect_equal_packets(folder, "SIMULATOR=icarus")
        # In longer slots fewer rows are dropped.
        registers = (folder / "registers.txt").read_text()
        (folder / "registers.txt").write_text(re.sub(r" \w+ SLOT_CLOCKS", " 00001000 SLOT_CLOCKS", registers))
        self.expect_other_packets(folder)

    @needs("make", "make")
    @needs("iverilog", "iverilog")
    def test_a_chip_with_another_sample_is_found(self):
        folder = self.design()
        lines = (folder / "dn.mem").read_text().splitlines()
        (folder / "dn.mem").write_text("\n".join(reversed(lines)))
        self.expect_other_packets(folder)

    @needs("make", "make")
    @needs("verilator", "verilator")
    def test_verilator_has_no_warning_and_gets_the_packets_of_the_emulator(self):
        for sensor in SENSORS:
            self.make(self.design(sensor), "lint")
        self.expect_equal_packets(self.folder / "lux1310_chip", "SIMULATOR=verilator", "OPT_FAST=-O0",
                                  "OPT_SLOW=-O0", "OPT_GLOBAL=-O0")

    @needs("yosys", "yosys")
    def test_yosys_reads_the_chip(self):
        folder = self.design()
        (folder / "testbench.sv").unlink()
        run = subprocess.run(["yosys", "-p", "read_verilog -sv *.sv; hierarchy -top chip -check; proc; check"],
                             cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stdout[-3000:])

    @needs("make", "make")
    @needs("iverilog", "iverilog")
    @needs("fst2vcd", "gtkwave")
    def test_the_save_file_names_signals_of_the_waveform(self):
        folder = self.design()
        self.make(folder, "waves", "SIMULATOR=icarus")
        subprocess.run(["fst2vcd", "chip.fst", "-o", "chip.vcd"], cwd=folder, check=True, capture_output=True)
        top = (folder / "chip.vcd").read_text().split("$scope module testbench $end")[1].split("$scope")[0]
        signals = {f"testbench.{name}{bits}" for name, bits in
                   re.findall(r"^\$var \w+ +\d+ \S+ (\w+) ?(\S*) \$end", top, re.M)}
        shown = re.findall(r"^testbench.*", (folder / "chip.gtkw").read_text(), re.M)
        self.assertGreater(len(shown), 20)
        self.assertEqual(set(shown) - signals, set())

    def test_the_files_agree_with_the_compiled_schedule_and_the_figures(self):
        folder = self.design()
        self.succeed("schedule", "compile", "tiled", *SMALL[2:], "--size", "16x8", "-o", "tiled.mem")
        self.assertEqual((folder / "schedule.mem").read_text(), (self.folder / "tiled.mem").read_text())
        sizes = dict(re.findall(r"define CHIP_(\w+) (\d+)$", (folder / "chip.vh").read_text(), re.M))
        self.assertEqual({name: int(sizes[name]) for name in ("ROWS", "COLS", "CHANNELS", "TILE_ROWS", "TILE_COLS",
                                                              "BIT_DEPTH", "WORD_BYTES", "DEPTH")},
                         {"ROWS": 8, "COLS": 16, "CHANNELS": 16, "TILE_ROWS": 4, "TILE_COLS": 8,
                          "BIT_DEPTH": 12, "WORD_BYTES": 32, "DEPTH": 15})
        registers = {name: int(value, 16) for _, value, name in
                     map(str.split, (folder / "registers.txt").read_text().splitlines())}
        # 500 us of 1024 rows at 90 MHz.
        self.assertEqual(registers["SLOT_CLOCKS"], 500 * 90 * 8 // 1024)
        self.assertEqual((registers["ROWS"], registers["COLS"], registers["BANK_PERIOD[0]"]), (8, 16, 15))

    def test_the_whole_array_can_be_written(self):
        figures = self.figures("rtl", "--sensor", "vita", "--size", "1280x1024", "--slots", 1, "-o", "whole")
        self.assertEqual((figures["rows"], figures["cols"], figures["slot_clocks"]), (1024, 1280, 310000))

    def write_schedule(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def test_what_the_chip_cannot_be_is_refused_with_its_limit(self):
        grey = self.write_schedule("grey.toml", 'kind = "code"\nperiod_slots = 3\ncode = ["Aaa"]\n'
                                                'weights = ["FFFF80004000"]\n')
        for parts, sensor, *more in (
                (["CHANNELS = 16", "17 columns"], "lux1310", "--size", "17x8"),
                (["COLUMNS_PER_ADC = 5", "16 columns"], "lux1310", "--size", "16x8",
                 "--set", "sensor.timing.columns_per_adc=5"),
                (["384 bits", "WORD_BYTES", "256"], "lux2100"),
                (["charge store"], "lux1310", "--schedule", "two_bucket"),
                (["weights"], "lux1310", "--schedule", grey),
                (["SLOT_CLOCKS", "32 bits"], "lux1310", "--set", "sensor.slot_us=1e8", "--size", "16x1024"),
                (["[timing]"], "paper"),
                (["1280 x 1024"], "lux1310", "--size", "1296x8")):
            self.fails(INPUT, parts, "rtl", "--sensor", sensor, *more, "-o", "refused")
        self.write_flat("light.npy")
        self.fails(USAGE, ["--size", "footage"], "rtl", "--sensor", "vita", "--footage", "light.npy",
                   "--size", "8x8", "-o", "refused")

    def test_a_changed_design_is_not_replaced(self):
        folder = self.design()
        again = ("rtl", "--sensor", "lux1310", *SMALL, *SENSORS["lux1310"], "-o", "lux1310_chip")
        self.fails(INPUT, ["exists already", "--force"], *again)
        self.succeed(*again, "--force")
        (folder / "pads.sv").touch()
        self.fails(INPUT, ["pads.sv"], *again, "--force")


if __name__ == "__main__":
    unittest.main()
