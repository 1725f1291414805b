"""The Debian packages hold what is installed, and are as Debian's policy wants them."""

import gzip
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from program import project_path

VERSION = re.search(r"project\(stipple VERSION (\d+[.]\d+)", project_path("CMakeLists.txt").read_text())[1]
SHARED = f"libstipple{VERSION}"
PACKAGES = ["libstipple-dev", SHARED, "python3-stipple", "stipple"]
# A build for /usr/local has its libraries in lib/, which cpack tells ldconfig of; scripts/package makes one
# for /usr, with the folder of the architecture, where lintian finds neither.
OF_LOCAL_BUILDS = "maintscript-calls-ldconfig,pkg-config-unavailable-for-cross-compilation"


def run(*command, **options):
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, timeout=500, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


@unittest.skipUnless(shutil.which("dpkg-deb") and shutil.which("dpkg-shlibdeps"), "no dpkg-dev: this is not Debian")
@unittest.skipUnless(os.environ["STIPPLE_PYTHON"] == "1", "a build without the Python module")
class PackagesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="stipple_")))
        environment = os.environ | {"SOURCE_DATE_EPOCH": "1767225600", "DEBFULLNAME": "A Packager",
                                    "DEBEMAIL": "packager@example.org"}
        run(os.environ["CPACK"], "--config", Path(os.environ["BUILD"]) / "CPackConfig.cmake", "-B", cls.folder,
            "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip",  # in half the time of xz
            cwd=cls.folder, env=environment)
        cls.files = {file.name.split("_")[0]: file for file in sorted(cls.folder.glob("*.deb"))}
        for package, file in cls.files.items():
            run("dpkg-deb", "--extract", file, cls.folder / package)

    def field(self, package, name):
        return run("dpkg-deb", "--field", self.files[package], name).strip()

    def contents(self, package):
        """Paths relative to /usr."""
        root = self.folder / package / "usr"
        return {str(path.relative_to(root)) for path in root.rglob("*") if not path.is_dir()}

    def test_there_are_four(self):
        self.assertEqual(list(self.files), PACKAGES)

    @unittest.skipUnless(shutil.which("lintian"), "lintian is missing (Debian: lintian)")
    def test_lintian_finds_nothing(self):
        found = run("lintian", "--allow-root", "--fail-on", "error,warning", "--tag-display-limit", "0",
                    "--suppress-tags", OF_LOCAL_BUILDS, *self.files.values())
        self.assertEqual(found, "")

    def test_they_depend_on_what_they_load(self):
        """Libraries that are linked are dependencies, those that are loaded late are recommended."""
        program = self.field("stipple", "Depends")
        for library in ("libc6", "libtbb12", "libtiff6", "libpng16-16", "libopencv-core406", "libaravis-0.8-0"):
            self.assertIn(library, program)
        self.assertNotIn("avcodec", program)
        self.assertRegex(self.field("stipple", "Recommends"), r"libavcodec\d+.*gnuplot-nox")
        version = re.escape(self.field("stipple", "Version"))
        for package, needed in ((SHARED, "stipple"), ("libstipple-dev", SHARED), ("python3-stipple", "stipple")):
            self.assertRegex(self.field(package, "Depends"), rf"{re.escape(needed)} \(= {version}\)")
        self.assertRegex(self.field("python3-stipple", "Depends"), r"python3-numpy.*libc6")

    def test_headers_that_the_libraries_need_are_packages_of_the_build(self):
        listed = project_path("scripts/packages.txt").read_text()
        needed = [name for name in re.split(r",\s*", self.field("libstipple-dev", "Depends")) if "(" not in name]
        self.assertGreater(len(needed), 10)
        for name in needed:
            self.assertRegex(listed, rf"(?m)^{re.escape(name)} ")

    def test_all_that_is_installed_is_in_one_package(self):
        prefix = self.folder / "installed"
        run(os.environ["CMAKE"], "--install", os.environ["BUILD"], "--prefix", prefix)
        installed = {str(path.relative_to(prefix)) for path in prefix.rglob("*") if not path.is_dir()}
        packed = [re.sub(r"(man1/.*)[.]gz$", r"\1", path) for package in PACKAGES for path in self.contents(package)]
        self.assertEqual(len(packed), len(set(packed)))
        self.assertEqual(installed - set(packed), set())
        added = set(packed) - installed
        self.assertEqual({path for path in added if not path.startswith(("share/doc/", "lib/python3/"))}, set())

    def test_the_module_has_its_type_hints_and_its_version(self):
        module = self.contents("python3-stipple")
        for name in ("stipple/__init__.py", "stipple/_stipple.pyi", "stipple/py.typed"):
            self.assertIn(f"lib/python3/dist-packages/{name}", module)
        metadata = next(self.folder.glob("python3-stipple/usr/lib/python3/dist-packages/stipple-*.dist-info/METADATA"))
        self.assertIn(f"Version: {self.field('stipple', 'Version').split('-')[0]}\n", metadata.read_text())

    def test_documents(self):
        for package in PACKAGES:
            documents = self.folder / package / "usr/share/doc" / package
            self.assertIn("License: Apache-2.0", (documents / "copyright").read_text())
            self.assertEqual(gzip.open(documents / "changelog.gz").read(), project_path("CHANGELOG.md").read_bytes())
            said = gzip.open(documents / "changelog.Debian.gz", "rt").read()
            self.assertIn("\n -- A Packager <packager@example.org>  Thu, 01 Jan 2026 00:00:00 +0000\n", said)
            self.assertIn(self.field(package, "Version"), said)
            self.assertEqual(self.field(package, "Maintainer"), "A Packager <packager@example.org>")
        self.assertIn("share/doc/libstipple-dev/examples/read_stream.cpp", self.contents("libstipple-dev"))

    def test_the_packed_program_runs(self):
        program = self.folder / "stipple/usr/bin/stipple"
        sensors = self.folder / "stipple/usr/share/stipple/config/sensors"
        shutil.copy(sensors / "paper.toml", sensors / "packed_only.toml")
        run(program, "synth", "pan", "-o", "scene.npy", "--frames", "8", cwd=self.folder)
        run(program, "emulate", "scene.npy", "-o", "clip.stipple", "--sensor", "packed_only", cwd=self.folder)

    def test_what_is_compiled_is_hardened_and_stripped(self):
        compiled = [self.folder / "stipple/usr/bin/stipple", *self.folder.glob("*/usr/lib/**/*.so*")]
        compiled = [path for path in compiled if not path.is_symlink()]
        self.assertEqual(len(compiled), 4)
        for file in compiled:
            with self.subTest(file.name):
                self.assertRegex(run("readelf", "--wide", "--dynamic", file), r"\(FLAGS_1\).*\bNOW\b")
                sections = run("readelf", "--wide", "--sections", "--program-headers", file)
                self.assertIn("GNU_RELRO", sections)
                self.assertNotIn(".symtab", sections)


if __name__ == "__main__":
    unittest.main()
