"""Stipple as a library: installed, moved to another folder, and used from outside the tree."""

import os
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

EXAMPLES = Path(__file__).resolve().parents[2] / "docs/examples"


class ExamplesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="stipple_")))
        cls.run_command(os.environ["CMAKE"], "--install", os.environ["BUILD"], "--prefix", cls.folder / "first")
        cls.prefix = (cls.folder / "first").rename(cls.folder / "moved")
        cls.configure(EXAMPLES, cls.folder / "build")
        cls.run_command(os.environ["CMAKE"], "--build", cls.folder / "build")
        cls.clip = (np.arange(40 * 24 * 32).reshape(40, 24, 32) % 97 / 97).astype(np.float32)
        np.save(cls.folder / "clip.npy", cls.clip)

    @classmethod
    def run_command(cls, *command, code=0, **options):
        done = subprocess.run([*map(str, command)], cwd=cls.folder, capture_output=True, text=True, timeout=300,
                              **options)
        if done.returncode != code:
            raise AssertionError(f"{command}: {done.returncode}\n{done.stdout}\n{done.stderr}")
        return done.stdout + done.stderr

    @classmethod
    def configure(cls, source, build, code=0):
        return cls.run_command(os.environ["CMAKE"], "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={cls.prefix}",
                               "-DCMAKE_BUILD_TYPE=Release", code=code)

    def example(self, name, *arguments):
        return self.run_command(self.folder / "build" / name, *arguments)

    def program(self, *arguments):
        return self.run_command(self.prefix / "bin/stipple", *arguments)

    def test_the_installed_program_finds_its_configurations_and_libraries(self):
        sensors = self.prefix / "share/stipple/config/sensors"
        shutil.copy(sensors / "paper.toml", sensors / "installed_only.toml")
        self.program("emulate", "clip.npy", "-o", "flow.stipple", "--sensor", "installed_only")
        loaded = self.run_command(self.prefix / "bin/stipple", "decode", "flow.stipple", "-o", "flow.npy",
                                  "--method", "portz2013", env=os.environ | {"LD_DEBUG": "files"})
        self.assertRegex(loaded, f"calling init: {self.prefix}/.*/stipple/libstipple_opencv.so")

    def test_manual_pages_and_completions_are_installed(self):
        for name in ("man/man1/stipple-capture-record.1", "bash-completion/completions/stipple",
                     "zsh/vendor-completions/_stipple", "fish/vendor_completions.d/stipple.fish"):
            self.assertGreater((self.prefix / "share" / name).stat().st_size, 1000)

    def test_emulate_and_decode_are_those_of_the_program(self):
        self.example("emulate_decode", "clip.npy", "light.npy")
        self.program("emulate", "clip.npy", "-o", "program.stipple", "--sensor", "lux1310")
        self.program("decode", "program.stipple", "-o", "program.npy", "--method", "fast")
        np.testing.assert_array_equal(np.load(self.folder / "light.npy"), np.load(self.folder / "program.npy"))

    def test_a_stream_is_read(self):
        lines = self.read_stream(self.folder / "build/read_stream", "mean.stipple")
        self.assertEqual(len(lines), 40)

    def read_stream(self, reader, name):
        """Of light 0.5 on the ideal sensor, half of its full scale of 1.0 a slot: as many DN a slot."""
        np.save(self.folder / "grey.npy", np.full((40, 24, 32), 0.5, np.float32))
        self.program("emulate", "grey.npy", "-o", name, "--sensor", "ideal", "--schedule", "tiled", "--force")
        lines = self.run_command(reader, name).splitlines()
        means = [float(line.split()[4]) for line in lines]
        np.testing.assert_allclose(means, means[0], atol=0.5)
        return lines

    def test_a_schedule_of_ones_own(self):
        """Slots 0 to 15 of a pair of pixels: 16 samples and 8 of 8 light slots each."""
        said = self.example("own_schedule", "own.stipple")
        self.assertIn(f"{48 * 32 * (16 + 8)} samples, light throughput 1", said)
        information = self.program("info", "own.stipple")
        self.assertIn("fast_and_slow", information)
        self.assertIn("made_in_code = true", information)

    def test_pkg_config(self):
        places = [path.parent for path in self.prefix.rglob("stipple.pc")]
        environment = os.environ | {"PKG_CONFIG_PATH": str(places[0])}
        flags = shlex.split(self.run_command("pkg-config", "--cflags", "--libs", "stipple", env=environment))
        libraries = os.environ | {"LD_LIBRARY_PATH": str(places[0].parent)}
        # The library finds the configurations of its installation.
        self.run_command(os.environ["CXX"], EXAMPLES / "own_schedule.cpp", "-o", "own_by_hand", *flags)
        self.run_command(self.folder / "own_by_hand", "by_hand.stipple", env=libraries)
        self.run_command(os.environ["CXX"], EXAMPLES / "read_stream.cpp", "-o", "read_by_hand", *flags)
        self.assertIn("slot 15: ", self.run_command(self.folder / "read_by_hand", "by_hand.stipple", env=libraries))
        configs = self.run_command("pkg-config", "--variable=configdir", "stipple", env=environment).strip()
        self.assertTrue((Path(configs) / "sensors/paper.toml").is_file())

    def project(self, name, *lines):
        """A folder with a project of these lines of CMake."""
        folder = self.folder / name
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text("\n".join(
            ("cmake_minimum_required(VERSION 3.25)", f"project({name} LANGUAGES CXX)", *lines)))
        return folder

    def test_components_are_static_libraries(self):
        """The last two link all others."""
        source = self.project("whole", "find_package(stipple REQUIRED COMPONENTS capture study)",
                              "add_executable(whole main.cpp)",
                              "target_link_libraries(whole PRIVATE stipple::capture stipple::study)")
        (source / "main.cpp").write_text("#include <stipple/capture.h>\n"
                                         "#include <stipple/report.h>\n"
                                         "int main() {\n"
                                         "    static_cast<void>(stipple::list_cameras());\n"
                                         "    stipple::RunReport report({.title = \"By hand\"}, {4, 4, 1}, nullptr);\n"
                                         "    const std::string page = report.page();\n"
                                         "    return page.find(\"<title>By hand\") == std::string::npos;\n"
                                         "}\n")
        self.configure(source, "whole_build")
        self.run_command(os.environ["CMAKE"], "--build", "whole_build")
        self.run_command(self.folder / "whole_build/whole")
        libraries = self.run_command("ldd", self.folder / "whole_build/whole")
        self.assertNotIn("libstipple", libraries)

    def test_each_header_has_an_example_that_runs(self):
        """They follow on one another: a scene, its stream, the decoded video, its quality and page."""
        folder = self.folder / "headers"
        folder.mkdir()
        headers = ["error", "scene", "video", "schedule", "sensor", "emulate", "stream", "decode", "compare", "calibrate",
                   "capture", "explore", "report"]
        installed = self.prefix / "include/stipple"
        self.assertEqual({path.stem for path in installed.glob("*.h")}, set(headers))
        lines = ["find_package(stipple REQUIRED)"]
        for header in headers:
            example = re.findall(r"^///     (.*)$", (installed / f"{header}.h").read_text(), re.M)
            self.assertGreater(len(example), 1, header)
            (folder / f"{header}.cpp").write_text(
                f"#include <stipple/{header}.h>\n#include <iostream>\n#include <fstream>\n"
                + ("#include <stipple/stream.h>\n" if header == "error" else "")
                + "int main() {\n" + "\n".join(example) + "\n}\n")
            lines += [f"add_executable({header} {header}.cpp)",
                      f"target_link_libraries({header} PRIVATE stipple::stipple)"]
        source = self.project("doors", *lines)
        for file in folder.iterdir():
            file.rename(source / file.name)
        self.configure(source, "doors_build")
        self.run_command(os.environ["CMAKE"], "--build", "doors_build", "--parallel", "2")
        said = {header: self.run_command(self.folder / "doors_build" / header) for header in headers}
        self.assertIn("nosuch.stipple", said["error"])
        np.testing.assert_array_equal(np.load(self.folder / "copy.npy"), np.load(self.folder / "scene.npy"))
        self.assertEqual(np.load(self.folder / "decoded.npy").shape, (60, 48, 64))
        self.assertGreater(float(said["compare"].split()[0]), 20)
        self.assertIn("<title>A clip", (self.folder / "report.html").read_text())

    def test_the_shared_library_exports_its_own_names_alone(self):
        [library] = [path for path in self.prefix.rglob("libstipple.so") if path.is_symlink()]
        names = [line.split(maxsplit=2)[2] for line in
                 self.run_command("nm", "-D", "--defined-only", "-C", library).splitlines()]
        strange = [name for name in names if "stipple::" not in name]
        self.assertGreater(len(names), 1000)
        self.assertEqual(strange, [])

    def test_an_unknown_component_is_named(self):
        source = self.project("wrong", "find_package(stipple REQUIRED COMPONENTS lens)")
        said = self.configure(source, "wrong_build", code=1)
        self.assertIn("it has no component lens, but: core", " ".join(said.split()))


if __name__ == "__main__":
    unittest.main()
