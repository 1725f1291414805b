"""docs/cli.md: its tables of options are what the program says of itself."""

import importlib.machinery
import importlib.util
import unittest

from program import PROGRAM, project_path

LOADER = importlib.machinery.SourceFileLoader("option_tables", str(project_path("scripts/option_tables")))
option_tables = importlib.util.module_from_spec(importlib.util.spec_from_loader("option_tables", LOADER))
LOADER.exec_module(option_tables)


class OptionTablesTest(unittest.TestCase):
    maxDiff = None

    def test_the_page_has_the_options_of_every_command(self):
        page = project_path("docs/cli.md").read_text()
        self.assertEqual(page, option_tables.with_tables(page, option_tables.tables_of(PROGRAM)),
                         "run scripts/option_tables, and look whether the text around the tables still holds")

    def test_a_page_that_lacks_a_command_or_has_one_too_many_is_refused(self):
        tables = {"stipple.md": "`stipple`\n", "stipple-demo.md": "`stipple demo`\n"}
        block = "<!-- {} -->\nold\n<!-- end -->\n"
        whole = block.format("stipple.md") + "text\n" + block.format("stipple-demo.md")
        self.assertEqual(option_tables.with_tables(whole, tables), whole.replace("old\n<", "{}\n<").format(
            "`stipple`\n", "`stipple demo`\n"))
        for page in (block.format("stipple.md"), whole + block.format("stipple-old.md"), 2 * whole):
            with self.assertRaises(ValueError):
                option_tables.with_tables(page, tables)


if __name__ == "__main__":
    unittest.main()
