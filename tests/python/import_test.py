"""The package can be imported, and is of the same version as the program."""

import os
import subprocess
import unittest

import stipple


class ImportTest(unittest.TestCase):
    def test_has_the_version_of_the_program(self):
        said = subprocess.run([os.environ["STIPPLE"], "--version"], capture_output=True, text=True, check=True)
        self.assertIn(stipple.__version__, said.stdout)


if __name__ == "__main__":
    unittest.main()
