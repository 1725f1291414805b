"""Each check finds the faults of small made-up trees, and nothing in sound ones."""

import re
import shutil
import tempfile
import unittest
from pathlib import Path

import aggregates
import citation
import config_comments
import headers
import includes
import layout
import links
import listed
import modules
import packages
import prose_figures
import quoted_messages
import sizes
import tested
import words
from tree import Tree

TABLE = """| module | may include |
|---|---|
| core | nothing |
| io, stream, sensor_model, metrics, scenes | core |
| decoder | stream, core |
| calibration | decoder, stream, core |
| readout | sensor_model, stream, core |
| capture | readout, sensor_model, stream, core |
| report | readout, decoder, metrics, stream, io, core |
| explore | report, readout, decoder, metrics, scenes, stream, io, core |
| apps, python, tests, bench | everything |
"""


class ChecksTest(unittest.TestCase):
    def findings(self, check, files):
        with tempfile.TemporaryDirectory() as root:
            for name, text in files.items():
                path = Path(root) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return list(check(Tree(root)))

    def places(self, check, files):
        return [finding.split(" ")[0].rstrip(":") for finding in self.findings(check, files)]

    def includes(self, files):
        sound = {includes.PAGE: TABLE, "core/plane.h": "", "sensor_model/noise.h": ""}
        return self.places(includes.check, sound | files)

    def test_a_module_includes_what_the_table_allows(self):
        source = '#include "sensor_model/noise.h"\n#include "core/plane.h"\n#include <vector>\n'
        self.assertEqual(self.includes({"readout/adc.cpp": source, "tests/t.cpp": source}), [])

    def test_the_decoder_does_not_know_the_sensor_model(self):
        source = '#include "core/plane.h"\n\n#  include "sensor_model/noise.h"\n'
        self.assertEqual(self.includes({"decoder/prox.cpp": source}), ["decoder/prox.cpp:3"])

    def test_an_include_that_would_escape_the_check_is_an_error(self):
        source = '#include <core/plane.h>\n#include "../core/plane.h"\n'
        self.assertEqual(self.includes({"decoder/a.h": source}), ["decoder/a.h:1", "decoder/a.h:2"])

    def test_linking_follows_the_same_table(self):
        build = "stipple_module(decoder\n    PUBLIC stipple_core stipple_readout)\n"
        self.assertEqual(self.includes({"decoder/CMakeLists.txt": build}),
                         ["decoder/CMakeLists.txt:2"])

    def test_a_module_without_a_row_is_an_error(self):
        table = TABLE.replace("| decoder | stream, core |\n", "")
        self.assertEqual(self.includes({includes.PAGE: table}), [includes.PAGE])

    def test_folders_of_a_module_form_no_circle(self):
        files = {"apps/a/a.cpp": '#include "apps/b/b.h"\n', "apps/b/b.h": '#include "apps/c/c.h"\n',
                 "apps/c/c.h": '#include "apps/top.h"\n', "apps/top.h": '#include "apps/a/a.h"\n',
                 "apps/a/a.h": ""}
        self.assertEqual(self.includes(files), [])
        files["apps/c/c.h"] += '#include "apps/a/a.h"\n'
        self.assertEqual(self.includes(files), ["apps/a/a.cpp:1", "apps/b/b.h:1", "apps/c/c.h:2"])

    def test_a_braced_member_before_a_call_has_its_type(self):
        wrong = ["A a{.b = {.c = 1},\n    .d = f()};", "return {x, {.c = y()}, f()};", "g({.b{1}, .e = {}, .d = C{f()}});"]
        right = ["A a{.b = B{.c = f()}, .d = f()};", "A a{.b = {}, .d = f()};", "A a{.d = f(), .b = {1}}; g();",
                 "g({.b = {1}}, f());", 'A a{.b = {1}, .d = "f()"};  // f()', "a.b = {1}; c = A{1, f()};"]
        files = {f"core/{number}.cpp": line for number, line in enumerate(wrong + right)}
        self.assertEqual(self.places(aggregates.check, files), ["core/0.cpp:1", "core/1.cpp:1", "core/2.cpp:1"])

    def test_third_party_types_stay_out_of_headers(self):
        foreign = "#pragma once\n#include <vector>\n#include <opencv2/core.hpp>\n"
        kernel = "#include <hwy/highway.h>\n"
        files = {"core/a.h": foreign, "core/z.cpp": foreign, "apps/a.h": foreign,
                 "core/b-inl.h": kernel, "core/c.h": "#pragma once\n" + kernel}
        self.assertEqual(self.places(headers.check, files), ["core/a.h:3", "core/c.h:2"])

    def test_an_inner_header_stays_inside(self):
        foreign, inner = "#pragma once\n#include <nlohmann/json_fwd.hpp>\n", '#pragma once\n#include "core/b.h"\n'
        files = {"core/CMakeLists.txt": "stipple_module(core\n    HEADERS a.h d.h)\n"
                 "target_sources(stipple_core PRIVATE b.h\n    c.h)\n",
                 "core/a.h": inner, "core/b.h": foreign, "core/c.h": foreign + inner, "core/d.h": foreign}
        self.assertEqual(self.places(headers.check, files), ["core/a.h:2", "core/d.h:2"])

    def test_a_header_has_pragma_once(self):
        self.assertEqual(self.places(headers.check, {"core/a.h": "int f();\n"}), ["core/a.h:1"])

    def test_a_source_of_a_library_includes_its_own_header_first(self):
        own = '#include "core/a.h"\n'
        files = {"core/a.h": "#pragma once\n", "core/b.h": "#pragma once\n", "apps/b.h": "#pragma once\n",
                 "core/a.cpp": "// Why.\n\n" + own, "core/b.cpp": "#include <vector>\n" + own,
                 "apps/b.cpp": own, "core/c.cpp": own}
        self.assertEqual(self.places(headers.check, files), ["core/b.cpp:1"])

    def test_a_type_has_one_definition(self):
        files = {"core/a.h": "#pragma once\nclass Twice;\nstruct Once {\n};\n",
                 "core/b.h": "#pragma once\nstruct Once;\nclass Twice : Once {\n};\n",
                 "core/c.h": "#pragma once\nenum class Twice : char { kA };\n"}
        self.assertEqual(self.places(headers.check, files), ["core/c.h:2"])

    def test_a_source_that_is_not_built_is_found(self):
        files = {"core/CMakeLists.txt": "stipple_module(core SOURCES new_plane.cpp HEADERS a.h)\n",
                 "core/plane.cpp": "", "core/new_plane.cpp": "", "core/a.h": "",
                 "tests/core/CMakeLists.txt": "stipple_test(core a_test.cpp)\n",
                 "core/b.h": "", "core/kernel-inl.h": "", "apps/c.h": "",
                 "tests/core/a_test.cpp": "", "tests/core/b_test.cpp": "",
                 "tests/core/c_test.py": ""}
        self.assertEqual(self.places(listed.check, files),
                         ["core/b.h", "core/plane.cpp", "tests/core/b_test.cpp",
                          "tests/core/c_test.py"])

    def test_every_source_of_a_library_has_a_test(self):
        files = {"core/a.h": "", "core/a.cpp": "", "core/b.h": "", "core/b.cpp": '#include "core/b.h"\n',
                 "core/b_part.cpp": '#include "core/b.h"\n', "core/c.h": "", "core/c.cpp": "", "apps/d.cpp": "",
                 "core/e.cpp": "", "tests/core/a_test.cpp": '#include "core/b.h"\n', "tests/apps/e_test.py": "",
                 tested.LIST: "# SOURCE TEST\ncore/b.cpp tests/core/a_test.cpp\n"
                              "core/b_part.cpp tests/core/a_test.cpp\ncore/e.cpp tests/apps/e_test.py\n"}
        self.assertEqual(self.places(tested.check, files), ["core/c.cpp"])
        wrong = ["core/c.cpp tests/core/a_test.cpp", "core/none.cpp tests/core/a_test.cpp", "core/e.cpp tests/none_test.py",
                 "core/a.cpp tests/core/a_test.cpp", "core/b.cpp tests/core/a_test.cpp", "core/c.cpp tests/core/a.cpp"]
        for line in wrong:
            found = self.places(tested.check, files | {tested.LIST: files[tested.LIST] + line + "\n"})
            self.assertIn(f"{tested.LIST}:5", found, line)

    def test_all_lists_of_modules_are_equal(self):
        every = ("core", "io", "stream", "sensor_model", "metrics", "scenes", "decoder", "calibration", "readout",
                 "capture", "report", "explore")
        page = "".join(f"| `{name}/` | x |\n" for name in (*every, "apps", "python", "tests")) + TABLE
        files = {f"{name}/CMakeLists.txt": "" for name in (*every, "apps", "python", "tests")}
        files |= {modules.BUILD: f"set(STIPPLE_MODULES {' '.join(every)})\n", modules.PAGE: page,
                  modules.TIDY: f"HeaderFilterRegex: '/({'|'.join((*every, 'apps', 'python'))})/'\n"}
        self.assertEqual(self.findings(modules.check, files), [])
        for name, old, new in ((modules.BUILD, " core", " core new"), (modules.PAGE, "| `io/` | x |\n", ""),
                               (modules.PAGE, "| decoder | stream, core |\n", ""), (modules.TIDY, "|scenes", "")):
            self.assertIn(old, files[name])
            self.assertNotEqual(self.findings(modules.check, files | {name: files[name].replace(old, new)}), [], name)

    def test_sizes_are_limited(self):
        body = "    f();\n"
        longest = "void g(int a,\n       int b) {\n" + 58 * body + "}\n"
        longer = "TEST(A, B) {\n" + 59 * body + "}\n"
        method = "class A {\n    A() : a_(1) {\n" + 59 * body + "    }\n};\n"
        files = {"core/a.cpp": longest, "core/b.cpp": longest + longer, "core/c.h": method,
                 "core/d.cpp": 401 * "\n", "core/e.py": "def f():\n" + 60 * "    g()\n"}
        self.assertEqual(self.places(sizes.check, files),
                         ["core/b.cpp:62", "core/c.h:2", "core/d.cpp", "core/e.py:1"])

    @unittest.skipUnless(shutil.which("clang-format"), "clang-format is not installed")
    def test_layout_is_that_of_clang_format(self):
        files = {".clang-format": "BasedOnStyle: Google\n", "core/a.cpp": "int f();\n",
                 "core/b.cpp": "int f();\nint   g();\n", "README.md": "blanks \n"}
        self.assertEqual(self.places(layout.check, files), ["README.md:1", "core/b.cpp:2"])

    def test_nothing_depends_on_one_machine(self):
        folder, site = "/" + "home/someone/data", "https:/" + "/example.org"
        papers = "[DOI](https://doi.org/10.1000/1), [arXiv](https://arxiv.org/abs/1)\n"
        files = {"a.md": f"see {folder}\n/usr/bin/env, /dev/full and docs/home/x are fine\n",
                 "b.cpp": f"// {site}/page\n", "c.md": papers, "d.md": papers.replace("doi", "doy")}
        self.assertEqual(self.places(words.check, files), ["a.md:1", "b.cpp:1", "d.md:1"])

    def test_vague_names_and_uncertain_bits_are_found(self):
        files = {"core/a.h": "class FrameManager;\nstruct BaseLine;\nenum class FrameHelper {};\n",
                 "core/frame_utils.cpp": "std::normal_distribution<float> draw;\n",
                 "core/b.cpp": "// \"--force\" of the command\nfail(\"give --force\");\n", "apps/b.cpp": "fail(\"give --force\");\n",
                 "core/CMakeLists.txt": "add_compile_options(-ffast-math)\n"}
        self.assertEqual(sorted(self.places(words.check, files)),
                         ["core/CMakeLists.txt:1", "core/a.h:1", "core/a.h:3", "core/b.cpp:2",
                          "core/frame_utils.cpp", "core/frame_utils.cpp:1"])

    def test_links_lead_somewhere(self):
        link = "[a](pages/a.md) [b](pages/b.md) [c](pages/a.md#two-words) [d](#none)\n"
        files = {"README.md": link, "pages/a.md": "# Two words\n[up](../README.md)\n",
                 "core/a.h": "// docs" + "/none.md, docs" + "/notes/none.md\n"}
        self.assertEqual(self.places(links.check, files),
                         ["README.md:1", "README.md:1", "core/a.h:1", "core/a.h:1"])

    def test_the_index_of_the_documentation_links_every_page(self):
        pages = {links.INDEX: "[a](a.md)\n", "docs" + "/a.md": "", "docs/notes" + "/b.md": ""}
        self.assertEqual(self.places(links.check, pages), [links.INDEX])

    def test_a_quoted_message_is_one_of_the_program(self):
        source = 'fail(fmt::format("{}: ends \\"{}\\" "\n     "before {} slots", a, b, c));\n'
        rows = ["| `ends ... before ... slots` | why |", '| `ends "..."` and `cause` | `not a message` |',
                "| `ends before ... frames` | why |"]
        files = {"apps/a.cpp": source, quoted_messages.PAGE: "".join(row + "\n" for row in rows)}
        self.assertEqual(self.places(quoted_messages.check, files), [quoted_messages.PAGE + ":3"])

    def test_every_config_key_is_explained(self):
        text = '# width\na = 1\nb = "#"\nc = 2  # height\n[t]\nd = 1\n'
        self.assertEqual(self.places(config_comments.check, {"config/a.toml": text}),
                         ["config/a.toml:3", "config/a.toml:6"])

    def test_package_list_build_sources_and_documentation_agree(self):
        row = "libfmt-dev fmt fmt/ text of messages\n"
        sound = {packages.LIST: "[build]\ncmake - - for the presets\n" + row,
                 "CMakeLists.txt": "find_package(fmt REQUIRED)\nfind_package(Threads)\n",
                 "core/a.cpp": "#include <fmt/format.h>\n#include <sys/stat.h>\n",
                 "README.md": "install libfmt-dev first\n"}
        self.assertEqual(self.findings(packages.check, sound), [])
        for name, text in {"README.md": "install libboost-dev\n",
                           "CMakeLists.txt": "find_package(fmt)\nfind_package(TBB)\n",
                           "core/b.cpp": "#include <gmock/gmock.h>\n",
                           packages.LIST: row + "libtbb-dev TBB - threads\n"}.items():
            self.assertEqual(len(self.findings(packages.check, sound | {name: text})), 1, name)
        self.assertEqual(len(self.findings(packages.check, sound | {"core/a.cpp": ""})), 1)
        sound["CMakeLists.txt"] = "pkg_check_modules(E REQUIRED IMPORTED_TARGET E)\n"
        self.assertEqual(len(self.findings(packages.check, sound)), 2)

    def test_conclusions_have_the_figures_of_their_tables(self):
        for name, begins in {prose_figures.RIVALS: ("samples costs ", "on `mouse250_b` by ", "`hardware_tiled` at "),
                             prose_figures.EXPLORED: ("`random` at ", "data rate for ", "groups of 2 cost "),
                             prose_figures.MAP: ("cell at the mean and ", "is far behind somewhere: by "),
                             prose_figures.README: ("coded exposure is at most ",),
                             prose_figures.CONCEPT: ("coded samples are ",)}.items():
            root = Path(__file__).parents[2]
            page = (root / name).read_text(encoding="utf-8")
            others = {prose_figures.MAP: (root / prose_figures.MAP).read_text(encoding="utf-8")}
            self.assertEqual(self.findings(prose_figures.check, others | {name: page}), [])
            for begin in begins:
                changed = re.sub(begin.replace(" ", r"\s+") + r"[\d.]+", begin + "99", page)
                self.assertEqual(len(self.findings(prose_figures.check, others | {name: changed})), 1, begin)

    def test_the_citation_has_its_keys_and_the_version_of_the_project(self):
        keys = "cff-version: 1.2.0\nmessage: m\ntitle: t\nauthors:\n  - name: a\nlicense: l\n"
        files = {"CMakeLists.txt": "project(p VERSION 0.2.0)\n", citation.FILE: keys + "version: 0.2.0\n"}
        self.assertEqual(self.findings(citation.check, files), [])
        for text in (keys + "version: 0.1.0\n", files[citation.FILE].replace("title", "name")):
            self.assertEqual(len(self.findings(citation.check, files | {citation.FILE: text})), 1)


if __name__ == "__main__":
    unittest.main()
