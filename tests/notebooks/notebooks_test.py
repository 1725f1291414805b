"""The notebooks run from beginning to end, draw their figures, and are stored without results."""

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from program import project_path

NEEDED = {"nbconvert": "jupyter-nbconvert", "ipykernel": "python3-ipykernel", "matplotlib": "python3-matplotlib"}
TORCH = ("learned_schedule.ipynb", "plug_in_a_denoiser.ipynb")
MISSING = [package for module, package in NEEDED.items() if importlib.util.find_spec(module) is None]


class NotebooksTest(unittest.TestCase):
    notebooks = sorted(project_path("docs/examples/notebooks").glob("*.ipynb"))

    def test_they_are_stored_without_results(self):
        """So that a change of a figure is no change of the file. Jupyter: Cell > All Output > Clear."""
        self.assertEqual(len(self.notebooks), 5)
        for path in self.notebooks:
            for cell in json.loads(path.read_text())["cells"]:
                if cell["cell_type"] == "code":
                    self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None), path.name)

    @unittest.skipIf(MISSING, f"missing: {', '.join(MISSING)}")
    def test_each_cell_runs_and_each_figure_is_drawn(self):
        for path in self.notebooks:
            with self.subTest(path.name), tempfile.TemporaryDirectory(prefix="stipple_") as folder:
                if path.name in TORCH and importlib.util.find_spec("torch") is None:
                    self.skipTest("missing: python3-torch")
                self.check(path, self.execute(path, Path(folder)))

    def execute(self, path, folder):
        """Its cells with their results. Whatever Jupyter and Matplotlib want to keep goes with the folder."""
        copy = folder / path.name
        copy.write_bytes(path.read_bytes())
        done = subprocess.run(
            [sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--inplace", copy],
            cwd=folder, capture_output=True, text=True, timeout=500, env=os.environ | {"HOME": str(folder)})
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(copy.read_text())["cells"]

    def check(self, path, cells):
        """Each plt.show() has drawn a figure; nothing is on standard error."""
        code = [cell for cell in cells if cell["cell_type"] == "code"]
        outputs = [output for cell in code for output in cell["outputs"]]
        figures = [output for output in outputs if "image/png" in output.get("data", {})]
        shows = sum("".join(cell["source"]).count("plt.show()") for cell in code)
        self.assertGreater(shows, 4, path.name)
        self.assertGreaterEqual(len(figures), shows, path.name)
        self.assertEqual([output for output in outputs if output.get("name") == "stderr"], [], path.name)


if __name__ == "__main__":
    unittest.main()
