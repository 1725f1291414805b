"""The example firmware in C on the emulated chip and on the chip in gates: it says the same on both, and the packets
of the one are those of the other."""

import os
import shutil
import subprocess
import unittest

import numpy as np
import sample_stream
from program import PROGRAM, ProgramTest, project_path

FIRMWARE = project_path("docs/examples/firmware")


class FirmwareTest(ProgramTest):
    def run_firmware(self, *command):
        done = subprocess.run([self.folder / "firmware", "--", *command], cwd=self.folder, capture_output=True, text=True,
                              timeout=100)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return done.stdout

    def test_runs_on_both_chips_alike(self):
        compiler = shutil.which("cc") or self.skipTest("no C compiler")
        subprocess.run([compiler, "-std=c11", "-D_POSIX_C_SOURCE=200809L", "-I", project_path("readout"),
                        *sorted(FIRMWARE.glob("*.c")), "-o", self.folder / "firmware"], check=True)
        self.write_array("light.npy", np.random.default_rng(1).random((9, 8, 12)))
        emulated = self.run_firmware(PROGRAM, "chip", "light.npy", "-o", "clip.stipple", "--sensor", FIRMWARE / "chip.toml",
                                     "--schedule", "tiled", "--tile", "4x4", "--blank")
        self.assertIn("capture:", emulated)
        in_gates = self.run_firmware(os.environ["CHIP_SERVER"], "packets.bin", "clip.stipple", "clip-2.stipple")
        self.assertEqual(in_gates, emulated)
        packets = [packet for name in ("clip.stipple", "clip-2.stipple")
                   for packet in sample_stream.parts((self.folder / name).read_bytes())[1] if packet[4] == 1]
        self.assertEqual((self.folder / "packets.bin").read_bytes(), b"".join(packets))


if __name__ == "__main__":
    unittest.main()
