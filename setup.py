"""Builds the Python package for pip: CMake makes what is compiled, and the package brings config/ with it.

STIPPLE_BUILD names a build folder to take it from (build/wheel)."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
BUILD = Path(os.environ.get("STIPPLE_BUILD", ROOT / "build/wheel")).resolve()
VERSION = re.search(r"project\(stipple VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


class CMakeBuild(build_ext):
    def run(self):
        if not (BUILD / "CMakeCache.txt").is_file():
            subprocess.run(["cmake", "--preset", "release", "-B", BUILD, f"-DPython_EXECUTABLE={sys.executable}",
                            "-DSTIPPLE_PYTHON=ON", "-DSTIPPLE_TESTS=OFF", "-DSTIPPLE_BENCH=OFF"], cwd=ROOT, check=True)
        subprocess.run(["cmake", "--build", BUILD, "--target", "stipple_python"], check=True)
        package = Path(self.build_lib) / "stipple"
        shutil.copytree(BUILD / "python/stipple", package, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))


setup(version=VERSION, packages=["stipple"], package_dir={"": "python"},
      ext_modules=[Extension("stipple._stipple", [])], cmdclass={"build_ext": CMakeBuild})
