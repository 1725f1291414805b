"""Each check finds the faults of small made-up trees, and nothing in sound ones."""

import re
import tempfile
import unittest
from pathlib import Path

import aggregates
import citation
import config_comments
import headers
import includes
import links
import packages
import prose_figures
import quoted_messages
import sizes
import words
from tree import MODULES, Tree

ALL = ", ".join(module for module in MODULES if module not in ("decoder", "readout"))
TABLE = f"| decoder | stream, core |\n| readout | sensor_model, core |\n| {ALL} | everything |\n"
ONCE = "#pragma once\n"
PAPERS = "[DOI](https://doi.org/10.1000/1)\n"
CITATION = "cff-version: 1.2.0\nmessage: m\ntitle: t\nauthors:\n  - name: a\nlicense: l\nversion: 0.1.0\n"
PACKAGE = "[build]\nlibfmt-dev fmt fmt/ text of messages\n"
CALL = "    f();\n"

# The check, a tree, and the places that the check names in it.
CASES = (
    (includes.check, {  # what the table allows, and what it does not
        includes.PAGE: TABLE, "core/a.h": "", "sensor_model/a.h": "",
        "readout/a.cpp": '#include "sensor_model/a.h"\n#include "core/a.h"\n#include <vector>\n',
        "decoder/a.cpp": '#include "core/a.h"\n\n#  include "sensor_model/a.h"\n#include <core/a.h>\n#include "../core/a.h"\n',
        "decoder/CMakeLists.txt": "stipple_module(decoder\n    PUBLIC stipple_core stipple_readout)\n"},
     ["decoder/a.cpp:3", "decoder/a.cpp:4", "decoder/a.cpp:5", "decoder/CMakeLists.txt:2"]),
    (includes.check, {includes.PAGE: TABLE.replace("| decoder |", "| lens |")}, [includes.PAGE]),
    (includes.check, {  # a circle, and none by way of the folder above
        includes.PAGE: TABLE, "apps/a/a.h": '#include "apps/b/b.h"\n', "apps/b/b.h": '#include "apps/a/a.h"\n',
        "apps/top.h": '#include "apps/c/c.h"\n', "apps/c/c.h": '#include "apps/top.h"\n'},
     ["apps/a/a.h:1", "apps/b/b.h:1"]),
    (aggregates.check, {
        "core/a.cpp": "A a{.b = {.c = 1},\n    .d = f()};", "core/b.cpp": "g({.b{1}, .e = {}, .d = C{f()}});",
        "core/c.cpp": "A a{.b = B{.c = f()}, .d = f()};", "core/d.cpp": 'A a{.b = {1}, .d = "f()"};  // f()'},
     ["core/a.cpp:1", "core/b.cpp:1"]),
    (headers.check, {  # types of others stay out, but for private headers and kernels
        "core/CMakeLists.txt": "target_sources(stipple_core PRIVATE b.h)\n", "core/a.h": ONCE + "#include <opencv2/core.hpp>\n",
        "core/b.h": ONCE + "#include <opencv2/core.hpp>\n", "core/c.h": ONCE + '#include "core/b.h"\n',
        "core/d-inl.h": "#include <hwy/highway.h>\n", "core/e.h": "int f();\n"},
     ["core/a.h:2", "core/c.h:2", "core/e.h:1"]),
    (headers.check, {  # a source includes its header first; a type is defined once
        "core/a.h": ONCE + "struct A {\n};\n", "core/b.h": ONCE + "struct A;\nclass A : B {\n};\n",
        "core/a.cpp": '// Why.\n\n#include "core/a.h"\n', "core/b.cpp": '#include <vector>\n#include "core/b.h"\n'},
     ["core/b.h:3", "core/b.cpp:1"]),
    (sizes.check, {
        "core/a.cpp": "void g(int a,\n       int b) {\n" + 58 * CALL + "}\n", "core/b.cpp": "TEST(A, B) {\n" + 59 * CALL + "}\n",
        "core/c.h": "class A {\n    A() : a_(1) {\n" + 59 * CALL + "    }\n};\n", "core/d.cpp": 401 * "\n",
        "core/e.py": "def f():\n" + 60 * "    g()\n"}, ["core/b.cpp:1", "core/c.h:2", "core/d.cpp", "core/e.py:1"]),
    (words.check, {
        "a.md": "/" + "home/someone/data\n/usr/bin/env and docs/home/x are fine\n", "b.md": PAPERS + PAPERS.replace("doi", "doy"),
        "core/a.h": "class FrameManager;\nstruct BaseLine;\n", "core/frame_utils.cpp": "std::normal_distribution<float> draw;\n",
        "core/CMakeLists.txt": "add_compile_options(-ffast-math)\n",
        "io/a.cpp": "// \"--force\" of the command\nfail(\"give --force\");\n", "apps/a.cpp": "fail(\"give --force\");\n"},
     ["a.md:1", "b.md:2", "core/frame_utils.cpp", "core/a.h:1", "core/frame_utils.cpp:1", "io/a.cpp:2", "core/CMakeLists.txt:1"]),
    (links.check, {
        "README.md": "[a](pages/a.md) [b](pages/b.md) [c](pages/a.md#two-words) [d](#none)\n",
        "pages/a.md": "# Two words\n[up](../README.md)\n", "core/a.h": "// docs" + "/none.md\n"},
     ["README.md:1", "README.md:1", "core/a.h:1"]),
    (links.check, {links.INDEX: "[a](a.md)\n", "docs" + "/a.md": "", "docs/notes" + "/b.md": ""}, [links.INDEX]),
    (quoted_messages.check, {
        "apps/a.cpp": 'fail(fmt::format("{}: ends \\"{}\\" "\n     "before {} slots", a, b, c));\n',
        quoted_messages.PAGE: "| `ends ... before ... slots` | why |\n| `ends before ... frames` | why |\n"},
     [quoted_messages.PAGE + ":2"]),
    (config_comments.check, {"config/a.toml": '# width\na = 1\nb = "#"\nc = 2  # height\n[t]\nd = 1\n'},
     ["config/a.toml:3", "config/a.toml:6"]),
    (citation.check, {"CMakeLists.txt": "project(p VERSION 0.1.0)\n", citation.FILE: CITATION}, []),
    (citation.check, {"CMakeLists.txt": "project(p VERSION 0.2.0)\n", citation.FILE: CITATION.replace("title", "name")},
     [citation.FILE, citation.FILE]),
)


def findings(check, files):
    with tempfile.TemporaryDirectory() as root:
        for name, text in files.items():
            path = Path(root) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return list(check(Tree(root)))


class ChecksTest(unittest.TestCase):
    def test_faults_are_found(self):
        for check, files, places in CASES:
            found = [finding.split(" ")[0].rstrip(":") for finding in findings(check, files)]
            self.assertEqual(sorted(found), sorted(places), check.__module__)

    def test_package_list_build_sources_and_documentation_agree(self):
        sound = {packages.LIST: PACKAGE, "CMakeLists.txt": "find_package(fmt REQUIRED)\nfind_package(Threads)\n",
                 "core/a.cpp": "#include <fmt/format.h>\n", "README.md": "install libfmt-dev first\n"}
        self.assertEqual(findings(packages.check, sound), [])
        for name, text in {"README.md": "install libboost-dev\n", "CMakeLists.txt": "find_package(fmt)\nfind_package(TBB)\n",
                           "core/b.cpp": "#include <gmock/gmock.h>\n", "core/a.cpp": "",
                           packages.LIST: PACKAGE + "libtbb-dev TBB - threads\n"}.items():
            self.assertEqual(len(findings(packages.check, sound | {name: text})), 1, name)

    def test_conclusions_have_the_figures_of_their_tables(self):
        page = (Path(__file__).parents[2] / prose_figures.MAP).read_text(encoding="utf-8")
        self.assertEqual(findings(prose_figures.check, {prose_figures.MAP: page}), [])
        changed = re.sub(r"(cell at the mean and\s)[\d.]+", r"\g<1>99", page)
        self.assertEqual(len(findings(prose_figures.check, {prose_figures.MAP: changed})), 1)


if __name__ == "__main__":
    unittest.main()
