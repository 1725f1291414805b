"""A compiled schedule drives the chip as the schedule does, and Verilog reads it as we do."""

import shutil
import subprocess
import tomllib
import unittest

import numpy as np

from program import INPUT, USAGE, ProgramTest, project_path
from sample_stream import samples

TILES = {"tiled": ["--set", "schedule.tile_rows=5", "--set", "schedule.tile_cols=7"],
         "full1x": [], "pixel_flutter": [], "two_bucket": []}


class SequencerProgramTest(ProgramTest):
    def compile(self, name, *options):
        return self.figures("schedule", "compile", name, "-o", f"{name}.mem", *options)

    def packets(self, name):
        return samples((self.folder / name).read_bytes())

    def figures_of(self, file):
        lines = (self.folder / file).read_text().splitlines()
        return dict(line[3:].split(" = ") for line in lines if " = " in line)

    def test_the_chip_runs_from_the_image_as_from_the_schedule(self):
        light = np.random.default_rng(1).uniform(0, 1, (40, 12, 20))
        self.write_array("light.npy", light)
        stores = ["--set", "sensor.charge_stores=2"]
        for name, options in TILES.items():
            self.compile(name, *options)
            self.succeed("emulate", "light.npy", "-o", "a.stipple", "--schedule", name, *options,
                         *stores, "--force")
            self.succeed("emulate", "light.npy", "-o", "b.stipple", "--schedule", f"{name}.mem",
                         *stores, "--force")
            self.assertEqual(self.packets("a.stipple"), self.packets("b.stipple"), name)
            infos = [self.figures("info", stream) for stream in ("a.stipple", "b.stipple")]
            for info in infos:  # they say how they were made, which differs
                del info["provenance"], info["command"]
            self.assertEqual(*infos)

    def test_an_image_of_the_whole_array_may_be_the_paper_s_schedule(self):
        light = np.random.default_rng(1).uniform(0, 1, (40, 12, 20))
        self.write_array("light.npy", light)
        figures = self.compile("random", "--size", "20x12", "--seed", "3")
        self.assertEqual(figures["program_bits"], 12 * 20 * 15)
        for schedule in ("random", "random.mem"):
            self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--schedule", schedule,
                         "--seed", "3", "--force")
            self.succeed("decode", "clip.stipple", "-o", f"{schedule}.npy", "--method", "naive")
        np.testing.assert_array_equal(self.array("random.npy"), self.array("random.mem.npy"))

    def test_the_size_is_that_of_the_memory(self):
        for name, bits in {"tiled": 1 * 15 * 16 * 16, "full1x": 2 * 4}.items():
            self.assertEqual(self.compile(name)["program_bits"], bits)

    def test_verilog_reads_what_the_chip_reads(self):
        if not shutil.which("iverilog"):
            self.skipTest("Icarus Verilog (package iverilog) is not installed")
        for name, options in TILES.items():
            self.compile(name, *options)
            self.succeed("schedule", "make", name, *options, "-o", f"{name}.toml")
            self.assertEqual(self.read_in_verilog(name), self.read_in_code(name), name)

    def read_in_verilog(self, name):
        """(slot, row, col) of each reading, by $readmemh."""
        figures = self.figures_of(f"{name}.mem")
        parameters = {"ROWS": "tile_rows", "COLS": "tile_cols", "PERIOD": "period_slots",
                      "BITS": "bits_per_pixel"}
        source = project_path("tests/apps/sequencer.v")
        subprocess.run(["iverilog", "-o", "chip", source]
                       + [f"-Psequencer.{p}={figures[key]}" for p, key in parameters.items()],
                       cwd=self.folder, check=True)
        text = subprocess.run(["vvp", "-N", "chip", f"+image={name}.mem"], cwd=self.folder,
                              check=True, capture_output=True, text=True).stdout
        readings = set()
        for line in text.splitlines():
            place, cols = line.split(":")
            readings |= {(*map(int, place.split()), int(col)) for col in cols.split()}
        return readings

    def read_in_code(self, name):
        """The same from the strings of a code file: the last letter of each exposure."""
        code = tomllib.loads((self.folder / f"{name}.toml").read_text())
        readings = set()
        for pixel, slots in enumerate(code["code"]):
            place = divmod(pixel, code["tile_cols"])
            for store in "ab":
                open_slots = [i for i, c in enumerate(slots) if c.lower() == store]
                for i, slot in enumerate(open_slots):
                    following = open_slots[(i + 1) % len(open_slots)]
                    if slots[following].isupper():
                        readings.add((slot, *place))
        return readings

    def test_what_cannot_be_compiled_or_run(self):
        self.compile("tiled")
        self.fails(INPUT, ["tiled.mem", "exists already"], "schedule", "compile", "tiled", "-o",
                   "tiled.mem")
        self.fails(USAGE, ["out.txt", ".mem"], "schedule", "compile", "tiled", "-o", "out.txt")
        self.write_flat("light.npy")
        emulate = ["emulate", "light.npy", "-o", "clip.stipple", "--schedule"]
        self.fails(INPUT, ["missing.mem"], *emulate, "missing.mem")
        self.fails(INPUT, ["schedule.tile_rows", "compiled"], *emulate, "tiled.mem", "--set",
                   "schedule.tile_rows=3")
        text = (self.folder / "tiled.mem").read_text()
        (self.folder / "tiled.mem").write_text(text.replace("// slot 3", "\nx // slot 3"))
        self.fails(INPUT, ["tiled.mem:"], *emulate, "tiled.mem")


if __name__ == "__main__":
    unittest.main()
