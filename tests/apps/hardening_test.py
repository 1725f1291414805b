"""What the loader is told of an optimised program, what it calls to check its buffers (cmake/Hardening.cmake), and that
it does not say where it was built."""

import os
import subprocess
import unittest
from pathlib import Path

from program import PROGRAM

LIBRARY = Path(PROGRAM).with_name("libstipple_opencv.so")


def readelf(option, file):
    return subprocess.run(["readelf", "--wide", option, file], check=True, text=True,
                          capture_output=True, env={"LC_ALL": "C"}).stdout


@unittest.skipUnless(os.environ["STIPPLE_HARDENED"] == "1",
                     "a build without hardening: no optimised one, or STIPPLE_HARDENING is OFF")
class HardeningTest(unittest.TestCase):
    def test_the_program_lies_at_a_random_address(self):
        self.assertRegex(readelf("--file-header", PROGRAM), r"Type: +DYN ")
        self.assertRegex(readelf("--dynamic", PROGRAM), r"\(FLAGS_1\).*\bPIE\b")

    def test_addresses_of_functions_become_read_only_at_the_start(self):
        for file in (PROGRAM, LIBRARY):
            with self.subTest(file):
                self.assertRegex(readelf("--dynamic", file), r"\(FLAGS_1\).*\bNOW\b")
                self.assertRegex(readelf("--program-headers", file), r"GNU_RELRO")

    def test_no_stack_can_be_executed(self):
        for file in (PROGRAM, LIBRARY):
            self.assertRegex(readelf("--program-headers", file), r"GNU_STACK .* RW ")

    def test_overruns_of_the_stack_and_of_buffers_are_noticed(self):
        symbols = readelf("--dyn-syms", PROGRAM)
        self.assertIn(" __stack_chk_fail@", symbols)
        self.assertIn(" __memcpy_chk@", symbols)

    def test_no_file_names_the_folder_of_the_sources(self):
        sources = os.fsencode(Path(__file__).parents[2])
        for file in (PROGRAM, LIBRARY):
            self.assertNotIn(sources, Path(file).read_bytes())


if __name__ == "__main__":
    unittest.main()
