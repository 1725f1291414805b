"""Verilator, Yosys and Icarus Verilog take the sources of the chip; sizes that it cannot have are refused."""

import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCES = sorted(str(path) for path in (Path(__file__).parents[2] / "rtl").glob("*.sv"))
SMALL = {"ROWS": 4, "COLS": 8, "CHANNELS": 2, "TILE_ROWS": 4, "TILE_COLS": 4, "DEPTH": 4,
         "DARK_ROWS": 1, "WORD_BYTES": 4, "WORDS": 16, "PACKETS": 4}
SIZES = [{}, SMALL,
         {"PIXEL_BITS": 3, "GROUP_ROWS": 2, "GROUP_COLS": 4, "COLUMNS_PER_ADC": 4},
         {"ROWS": 7, "COLS": 15, "CHANNELS": 5, "COLUMNS_PER_ADC": 3, "TILE_ROWS": 3, "TILE_COLS": 5,
          "PIXEL_BITS": 2, "DEPTH": 5, "BIT_DEPTH": 12, "DARK_ROWS": 1}]
REFUSED = {"CHANNELS does not divide COLS": {"CHANNELS": 3},
           "COLUMNS_PER_ADC does not divide COLS": {"COLUMNS_PER_ADC": 3},
           "WORD_BYTES is less than a column": {"WORD_BYTES": 4},
           "WORD_BYTES is none of": {"WORD_BYTES": 64},
           "DARK_ROWS is 0": {"DARK_ROWS": 0},
           "PIXEL_BITS is not 1..3": {"PIXEL_BITS": 4}}


def needs(tool, package):
    return unittest.skipUnless(shutil.which(tool), f"{tool} (package {package}) is not installed")


class ToolsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_tool(self, *command):
        return subprocess.run(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, check=False)

    @needs("verilator", "verilator")
    def test_verilator_has_no_warning(self):
        for size in SIZES:
            run = self.run_tool("verilator", "--lint-only", "-Wall", "--top-module", "stipple_chip",
                                *(f"-G{name}={value}" for name, value in size.items()), *SOURCES)
            self.assertEqual((run.returncode, run.stdout), (0, ""), size)

    @needs("yosys", "yosys")
    def test_yosys_makes_gates_without_loops_and_takes_the_image(self):
        words = [f"{word:x}" for word in range(16)]
        (self.folder / "image.mem").write_text("\n".join(words))
        sizes = " ".join(f"-set {name} {value}" for name, value in SMALL.items())
        run = self.run_tool("yosys", "-p", "read_verilog -sv " + " ".join(SOURCES) + "; "
                            f'chparam {sizes} -set IMAGE "image.mem" stipple_chip; '
                            "synth -top stipple_chip; check -assert; stat")
        self.assertEqual(run.returncode, 0, run.stdout[-3000:])
        self.assertRegex(run.stdout, "Found and reported 0 problems")
        flip_flops = sum(int(count) for count in re.findall(r"_DFF\S* +(\d+)", run.stdout.split("hierarchy")[-1]))
        self.assertGreater(flip_flops, 1000)

    @needs("iverilog", "iverilog")
    def test_icarus_compiles_and_refuses_sizes(self):
        (self.folder / "image.mem").write_text("0\n" * 256)
        for message, size in {"": {}, **REFUSED}.items():
            made = self.run_tool("iverilog", "-g2012", "-s", "stipple_chip", "-o", "chip",
                                 *(f"-Pstipple_chip.{name}={value}" for name, value in size.items()), *SOURCES)
            self.assertEqual(made.returncode, 0, made.stdout)
            run = self.run_tool("vvp", "-N", "chip", "+schedule=image.mem")
            self.assertIn(message, run.stdout)
            self.assertEqual(run.returncode != 0, message != "", run.stdout)


if __name__ == "__main__":
    unittest.main()
