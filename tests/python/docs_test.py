"""The examples of docs/python.md work."""

import doctest
import os
import unittest

from program import ProgramTest, project_path


class DocsTest(ProgramTest):
    def test_the_examples_give_what_the_page_says(self):
        page = str(project_path("docs/python.md"))
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        failed, tried = doctest.testfile(page, module_relative=False)
        self.assertEqual(failed, 0)
        self.assertGreater(tried, 20)


if __name__ == "__main__":
    unittest.main()
