"""scripts/site makes a site of the pages, the interfaces and a gallery, without warnings and dead links."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
SKIPPED = 77  # exit status that ctest shows as "Skipped"
sys.path.insert(0, str(PROJECT / "docs/site"))

from dead_links import dead_links  # noqa: E402


class SiteTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.html = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="stipple_"))) / "site/html"
        done = subprocess.run([PROJECT / "scripts/site", "--quick", "--build", os.environ["STIPPLE_BUILD"], "--output",
                               cls.html.parent], capture_output=True, text=True, timeout=280)
        if "missing" in done.stderr and "install-deps site" in done.stderr:
            print("skipped:", done.stderr.strip())
            sys.exit(SKIPPED)
        if done.returncode != 0:
            raise AssertionError(done.stdout + done.stderr)

    def text(self, page):
        return (self.html / page).read_text()

    def test_pages_interfaces_and_gallery_are_there(self):
        self.assertIn("coded exposure", self.text("docs/concept.html"))
        self.assertIn("stipple capture record", self.text("docs/cli.html"))
        self.assertIn("StreamReader", self.text("cpp/stream.html"))
        self.assertIn("linear light, a frame per time slot", self.text("python_api.html"))
        self.assertIn("full1x.png", self.text("gallery.html"))

    def test_a_dead_link_is_found(self):
        page = self.html / "dead.html"
        links = ("docs/concept.html#nothing", "nothing.html", "gallery.html")
        page.write_text("".join(f'<a href="{link}">a</a>' for link in links))
        self.addCleanup(page.unlink)
        self.assertEqual(len(list(dead_links(self.html))), 2)


if __name__ == "__main__":
    unittest.main()
