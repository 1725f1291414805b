"""scripts/run_tests skips a test that passed, and runs it again when its program or what it reads has
changed: on a small project, whose programs are scripts that note that they ran."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
PRESETS = {"version": 6,
           "configurePresets": [{"name": "p", "generator": "Ninja", "binaryDir": "${sourceDir}/build/p"}],
           "testPresets": [{"name": "p", "configurePreset": "p"}]}
# A program that notes that it ran, writes GoogleTest's results, if any, and its output, and ends with a
# status.
PROGRAM = """#!/bin/sh
echo {name} >>"$RAN"
mkdir -p test_results
[ -z '{results}' ] || echo '{results}' >test_results/{name}.xml
echo '{output}'
exit {status}
"""
SKIPPED_CASE = '<testsuites><testcase name="A" status="run"><skipped message="why"/></testcase></testsuites>'


class RunTestsTest(unittest.TestCase):
    def setUp(self):
        folder = Path(self.enterContext(tempfile.TemporaryDirectory(prefix="stipple_")))
        self.root = folder / "project"
        self.ran = folder / "ran"
        self.environment = os.environ | {"XDG_CACHE_HOME": f"{folder}/cache", "RAN": str(self.ran),
                                         "STIPPLE_FOOTAGE": f"{folder}/footage"}
        for name in ("run_tests", "passed.py", "test_results.py", "packages.txt"):
            (self.root / "scripts").mkdir(parents=True, exist_ok=True)
            shutil.copy(SCRIPTS / name, self.root / "scripts")
        self.write("CMakePresets.json", json.dumps(PRESETS))
        self.write("config/c", "text")
        self.lists = ["cmake_minimum_required(VERSION 3.25)", "project(p LANGUAGES NONE)", "enable_testing()"]

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)

    def entry(self, name, reads="config", **program):
        """A test of a program of its own, which reads a file or folder, or may read all if that is None."""
        self.write(f"bin/{name}", PROGRAM.format(
            **{"name": name, "results": "", "output": "", "status": 0} | program))
        self.lists += [
            f"add_test(NAME {name} COMMAND ${{CMAKE_SOURCE_DIR}}/bin/{name} --flag "
            f"--gtest_output=xml:${{CMAKE_BINARY_DIR}}/test_results/{name}.xml)",
            f"set_tests_properties({name} PROPERTIES SKIP_RETURN_CODE 77)"]
        if reads is not None:
            paths = f"${{CMAKE_SOURCE_DIR}}/config:${{CMAKE_SOURCE_DIR}}/{reads}"
            self.lists += [f'set_tests_properties({name} PROPERTIES ENVIRONMENT "STIPPLE_READS={paths}")']

    def configure(self):
        self.write("CMakeLists.txt", "\n".join(self.lists) + "\n")
        subprocess.run(["cmake", "--preset", "p"], cwd=self.root, check=True, capture_output=True)

    def run_tests(self, *options):
        """Names of the tests that ran, and what was printed."""
        self.ran.write_text("")
        done = subprocess.run([sys.executable, "-B", "scripts/run_tests", "p", *options], cwd=self.root,
                              env=self.environment, text=True, capture_output=True, check=False)
        self.assertNotIn("Traceback", done.stderr)
        return sorted(self.ran.read_text().split()), done.stdout + done.stderr

    def test_what_passed_runs_again_only_when_its_program_or_what_it_reads_changes(self):
        self.entry("test_one", reads="golden/one")
        self.entry("test_two", reads="pages/page.md")
        self.entry("check", reads=None)
        for name in ("golden/one/a", "golden/one/deep/b", "pages/page.md", "pages/other.md"):
            self.write(name, "text")
        self.configure()
        self.assertEqual(self.run_tests()[0], ["check", "test_one", "test_two"])
        ran, printed = self.run_tests()
        self.assertEqual(ran, ["check"])
        self.assertIn("1 test cases in 1 entries, 0 skipped\n2 of 3 entries skipped", printed)
        self.assertIn(": test_{one,two}\nfootage: ", printed)
        for name, again in {"pages/other.md": [], "bin/test_one": ["test_one"], "golden/one/a": ["test_one"],
                            "golden/one/deep/b": ["test_one"], "golden/one/new": ["test_one"],
                            "pages/page.md": ["test_two"], "config/c": ["test_one", "test_two"]}.items():
            with open(self.root / name, "a", encoding="utf-8") as file:
                file.write("\n")
            self.assertEqual(self.run_tests()[0], ["check", *again], name)
            self.assertEqual(self.run_tests()[0], ["check"], name)
        self.assertEqual(self.run_tests("--all")[0], ["check", "test_one", "test_two"])

    def test_what_a_test_reads_has_to_exist(self):
        self.entry("test_one", reads="golden/one")
        self.configure()
        for options in ([], ["--all"]):
            ran, printed = self.run_tests(*options)
            self.assertEqual(ran, [])
            self.assertIn(f"test_one: STIPPLE_READS names {self.root}/golden/one, which is neither", printed)
        self.write("golden/one", "text")
        self.assertEqual(self.run_tests()[0], ["test_one"])

    def test_what_passed_in_one_folder_does_not_run_again_in_another(self):
        self.entry("test_one", reads="golden/one")
        self.write("golden/one/a", "text")
        self.configure()
        self.assertEqual(self.run_tests()[0], ["test_one"])
        moved = self.root.with_name("a_longer_name")
        shutil.move(self.root, moved)
        shutil.rmtree(moved / "build")
        self.root = moved
        self.configure()
        self.assertEqual(self.run_tests()[0], [])
        self.write("golden/one/a", "other")
        self.assertEqual(self.run_tests()[0], ["test_one"])

    def test_what_failed_or_was_skipped_in_part_runs_again(self):
        self.entry("passes")
        self.entry("fails", status=1)
        self.entry("is_skipped", status=77)
        self.entry("skips_a_case", results=SKIPPED_CASE)
        self.entry("skips_in_python", output=5000 * "x" + "\n\nOK (skipped=1)")
        self.configure()
        self.run_tests()
        again, printed = self.run_tests()
        self.assertEqual(again, ["fails", "is_skipped", "skips_a_case", "skips_in_python"])
        self.assertIn("4 test cases in 4 entries, 2 skipped", printed)

    def test_another_setting_footage_or_command_runs_all_again(self):
        self.entry("test_one")
        self.configure()
        self.run_tests()
        self.assertEqual(self.run_tests()[0], [])
        self.environment["GTEST_SHUFFLE"] = "1"
        self.assertEqual(self.run_tests()[0], ["test_one"])
        clip = Path(self.environment["STIPPLE_FOOTAGE"]) / "clip/1.png"
        clip.parent.mkdir(parents=True)
        clip.write_text("image")
        self.assertEqual(self.run_tests()[0], ["test_one"])
        self.lists = [line.replace("--flag", "--other") for line in self.lists]
        self.configure()
        self.assertEqual(self.run_tests()[0], ["test_one"])
        self.assertEqual(self.run_tests()[0], [])

    def test_footage_beside_the_project_has_to_be_there(self):
        """The program stands for a test of footage: it fails where STIPPLE_FOOTAGE is wrong."""
        del self.environment["STIPPLE_FOOTAGE"]
        self.entry("of_footage", status='$([ -d "${STIPPLE_FOOTAGE-/}" ]; echo $?)')
        self.configure()
        self.assertIn("footage: tests of it were skipped", self.run_tests("--all")[1])
        self.assertEqual(self.run_tests()[0], [])
        shared = self.root.parent / "shared"
        shared.mkdir()
        ran, printed = self.run_tests()
        self.assertEqual(ran, ["of_footage"])
        self.assertIn("0% tests passed", printed)
        self.assertIn(f"footage: tests of it read {shared}/footage", printed)
        (shared / "footage").mkdir()
        self.assertIn("100% tests passed", self.run_tests()[1])

    def test_old_notes_are_removed(self):
        self.entry("test_one")
        self.configure()
        self.run_tests()
        (old,) = Path(self.environment["XDG_CACHE_HOME"]).glob("stipple/passed/*")
        os.utime(old, (0, 0))
        self.write("config/c", "new")
        self.run_tests()
        (new,) = old.parent.iterdir()
        self.assertNotEqual(new, old)


if __name__ == "__main__":
    unittest.main()
