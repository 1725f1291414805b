"""Manual pages and completions of the command line, as the programs that read them take them."""

import os
import pty
import re
import select
import shutil
import subprocess
import time
import unittest

from program import INPUT, OK, PROGRAM, ProgramTest


class ManualTest(ProgramTest):
    def commands(self, text):
        """The names that a help lists as subcommands."""
        listed = text.partition("Subcommands:\n")[2].partition("\n\n")[0]
        return re.findall(r"^  (\w+)", listed, re.MULTILINE)

    def test_each_command_has_a_page_with_its_options(self):
        self.succeed("manual", "man1")
        top = self.commands(self.succeed("--help"))
        pages = {"stipple.1"} | {f"stipple-{name}.1" for name in top}
        for name in ("capture", "schedule"):
            pages |= {f"stipple-{name}-{below}.1" for below in self.commands(self.succeed(name, "--help"))}
        self.assertEqual({path.name for path in (self.folder / "man1").iterdir()}, pages)
        page = (self.folder / "man1/stipple-emulate.1").read_text()
        for option in re.findall(r"^  (?:-\w,)?--([\w-]+)", self.succeed("emulate", "--help"), re.MULTILINE):
            self.assertIn("\\-\\-" + option.replace("-", "\\-"), page)
        self.fails(INPUT, ["man1", "--force"], "manual", "man1")
        self.assertEqual(self.succeed("manual", "capture", "record"), self.succeed("capture", "record", "--help"))

    def test_pages_are_good_roff(self):
        if shutil.which("groff") is None:
            self.skipTest("groff is not installed")
        self.succeed("manual", "man1")
        for page in sorted((self.folder / "man1").iterdir()):
            done = subprocess.run(["groff", "-man", "-ww", "-Tascii", "-P-cbu", page], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (OK, ""))
            self.assertIn("NAME", done.stdout)


class CompletionTest(ProgramTest):
    """What a shell makes of the beginning of a line."""

    def setUp(self):
        super().setUp()
        self.environment = os.environ | {"PATH": f"{os.path.dirname(PROGRAM)}:{os.environ['PATH']}",
                                         "HOME": str(self.folder)}

    def script_of(self, shell):
        if shutil.which(shell) is None:
            self.skipTest(f"{shell} is not installed")
        file = self.folder / f"completion.{shell}"
        file.write_text(self.succeed("completion", shell))
        return file

    def run_shell(self, *command):
        done = subprocess.run(command, env=self.environment, cwd=self.folder, capture_output=True, text=True,
                              timeout=60)
        self.assertEqual((done.returncode, done.stderr), (OK, ""))
        return done.stdout.split()

    def expect_completions(self, complete):
        self.assertEqual(complete("stipple emu"), ["emulate"])
        self.assertEqual(complete("stipple capture re"), ["record", "replay"])
        self.assertEqual(complete("stipple emulate --sched"), ["--schedule"])
        self.assertEqual(complete("stipple emulate --sensor lux"), ["lux1310", "lux2100"])
        self.assertEqual(complete("stipple decode a.stipple --method por"), ["portz2013"])
        self.assertEqual(complete("stipple schedule show random_"), ["random_subset"])
        self.assertEqual(complete("stipple list meth"), ["methods"])

    def test_bash(self):
        script = self.script_of("bash")
        self.expect_completions(lambda line: self.run_shell(
            "bash", "-c", f"source {script}; COMP_WORDS=({line}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); "
                          "_stipple; echo ${COMPREPLY[@]}"))

    def test_fish(self):
        script = self.script_of("fish")

        def complete(line):
            found = self.run_shell("fish", "-c", f"source {script}; complete -C '{line}' | cut -f 1")
            return [word for word in found if not word.endswith("/")]
        self.expect_completions(complete)

    def test_zsh(self):
        """In a terminal: where one word is left, the tabulator writes it."""
        script = self.script_of("zsh")
        pid, terminal = pty.fork()
        if pid == 0:
            os.execvpe("zsh", ["zsh", "-f"], self.environment | {"TERM": "dumb"})
        self.addCleanup(os.waitpid, pid, 0)
        self.addCleanup(os.close, terminal)

        def until(pattern, typed):
            os.write(terminal, typed.encode())
            shown, end = "", time.monotonic() + 30
            while not re.search(pattern, shown) and time.monotonic() < end:
                if select.select([terminal], [], [], 0.1)[0]:
                    shown += os.read(terminal, 65536).decode(errors="replace").replace("\0", "")
            self.assertRegex(shown, pattern)
        until("re" + "ady", f"PS1=; autoload -U compinit; compinit -u -D; source {script}; echo re''ady\n")
        for begun, whole in (("stipple emu", "late"), ("stipple capture rec", "ord"), ("stipple emulate --sched", "ule"),
                             ("stipple decode a --method por", "tz2013"), ("stipple list meth", "ods")):
            until(whole, begun + "\t")
            os.write(terminal, b"\x15")
        os.write(terminal, b"exit\n")


if __name__ == "__main__":
    unittest.main()
