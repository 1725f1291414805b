"""The commands of docs/tutorial.md do what the page says."""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "docs/tutorial.md"


class TutorialTest(unittest.TestCase):
    def test_every_command_works_and_the_coded_video_is_better(self):
        commands = re.findall(r"^    (stipple .*)$", PAGE.read_text(), re.M)
        path = f"{os.environ['STIPPLE_BUILD']}:{os.environ['PATH']}"
        psnr = []
        with tempfile.TemporaryDirectory(prefix="stipple_") as folder:
            for command in commands:
                done = subprocess.run(command, shell=True, cwd=folder, env=os.environ | {"PATH": path},
                                      capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, command + done.stderr)
                if command.startswith("stipple compare"):
                    psnr.append(float(re.search(r"PSNR\D+([\d.]+)", done.stdout)[1]))
        self.assertGreater(len(commands), 8)
        self.assertGreater(psnr[0], psnr[1] + 3)  # dB, of the schedules random and full4x


if __name__ == "__main__":
    unittest.main()
