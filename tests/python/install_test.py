"""What pip installs has all that it needs, and is complete without the project's folder."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from program import project_path

PARTS = ("CMakeLists.txt", "README.md", "config", "pyproject.toml", "python/stipple", "setup.py")


class InstallTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="stipple_")))
        source = cls.folder / "source"  # pip leaves files where it builds
        for part in PARTS:
            path, target = project_path(part), source / part
            target.parent.mkdir(parents=True, exist_ok=True)
            (shutil.copytree if path.is_dir() else shutil.copy)(path, target)
        done = subprocess.run([sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--no-index",
                               "--target", cls.folder / "installed", source], capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(done.stdout + done.stderr)
        cls.package = cls.folder / "installed/stipple"

    def python(self, code):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("STIPPLE")}
        done = subprocess.run([sys.executable, "-B", "-c", code], cwd=self.folder, capture_output=True, text=True,
                              env=environment | {"PYTHONPATH": str(self.package.parent)}, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.strip()

    def test_is_found_by_its_version(self):
        self.assertEqual(self.python("import stipple, importlib.metadata as m\n"
                                     "print(stipple.__file__, m.version('stipple') == stipple.__version__)"),
                         f"{self.package / '__init__.py'} True")

    def test_has_sensors_and_schedules_of_its_own(self):
        self.assertEqual(sorted(path.stem for path in (self.package / "config/sensors").glob("*.toml")),
                         self.python("import stipple; print(*stipple.Sensor.names())").split())
        file = self.package / "config/sensors/paper.toml"
        before = file.read_text()
        self.addCleanup(file.write_text, before)
        file.write_text(before.replace("read_noise_e = 10", "read_noise_e = 7"))
        self.assertEqual(self.python("import stipple; print(stipple.Sensor().read_noise_e)"), "7.0")

    def test_has_the_library_of_portz2013(self):
        self.python("import numpy as np, stipple\n"
                    "stream = stipple.emulate(np.full((20, 16, 16), 0.3), 'ideal')\n"
                    "assert stipple.decode(stream, 'portz2013').shape == (20, 16, 16)\n"
                    f"assert '{self.package / 'libstipple_opencv.so'}' in open('/proc/self/maps').read()")

    def test_has_its_type_hints(self):
        for name in ("py.typed", "_stipple.pyi"):
            self.assertTrue((self.package / name).is_file())


if __name__ == "__main__":
    unittest.main()
