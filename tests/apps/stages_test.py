"""What a decoding method in stages leaves behind: estimates, figures, chart."""

import os
import shutil
import unittest

import numpy as np

from program import INPUT, OK, ProgramTest
from sample_stream import parts

QUICK = ["--method", "portz2013"]
for setting in ("stage1.window_px=2", "stage1.iterations=3", "stage2.window_px=2",
                "stage2.iterations=4", "stage2.flow_radius_slots=1"):
    QUICK += ["--set", f"decoder.{setting}"]


class StagesTest(ProgramTest):
    def test_the_estimates_of_all_stages_and_what_they_minimise(self):
        # More than one block of slots: 48 and 22.
        stream = self.write_stream(slots=70, rows=17, cols=18)
        folder = ["--stages", "stages"] if shutil.which("gnuplot") else []
        figures = self.figures("decode", stream, "-o", "out.npy", *QUICK, *folder)
        steps = [(step["first_slot"], step["tile"], step["stage"], len(step["objective"]))
                 for step in figures["convergence"]]
        self.assertEqual(steps, [(0, 0, "stage1", 3), (0, 0, "stage2", 4),
                                 (48, 0, "stage1", 3), (48, 0, "stage2", 4)])
        for step in figures["convergence"]:
            self.assertTrue(all(np.isfinite(step["objective"])))
        if not folder:
            self.skipTest("gnuplot is not installed")
        self.assertEqual([name for name in self.names() if name.startswith("stages/")],
                         ["stages/convergence.png", "stages/stage1.npy", "stages/stage2.npy",
                          "stages/start.npy"])
        self.assertEqual(self.array("stages/stage1.npy").shape, self.array("out.npy").shape)
        np.testing.assert_array_equal(self.array("stages/stage2.npy"), self.array("out.npy"))
        self.assertFalse(np.array_equal(self.array("stages/start.npy"), self.array("out.npy")))

    def test_without_gnuplot_all_but_the_chart_is_there(self):
        stream = self.write_stream(slots=10, rows=17, cols=18)
        done = self.run_program("decode", stream, "-o", "out.npy", *QUICK, "--stages", "stages",
                                env=dict(os.environ, PATH=str(self.folder)))
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertIn("stages/convergence.png is not drawn: gnuplot: No such file", done.stderr)
        self.assertEqual([name for name in self.names() if name.startswith("stages/")],
                         ["stages/stage1.npy", "stages/stage2.npy", "stages/start.npy"])

    def test_a_chart_that_is_there_is_not_written_over(self):
        stream = self.write_stream(slots=10, rows=17, cols=18)
        (self.folder / "stages").mkdir()
        (self.folder / "stages/convergence.png").touch()
        self.fails(INPUT, ["stages/convergence.png", "exists already"], "decode", stream, "-o", "out.npy",
                   *QUICK, "--stages", "stages")

    def test_a_block_without_samples_is_dark_in_each_stage(self):
        stream = self.folder / self.write_stream(slots=144, rows=17, cols=18)
        header, packets, _ = parts(stream.read_bytes())
        stream.write_bytes(header + b"".join(packets[:10] + packets[124:144]))
        self.run_program("decode", stream.name, "-o", "out.npy", *QUICK, "--stages", "stages", "--fill-gaps")
        out = self.array("out.npy")
        self.assertEqual(len(out), 144)
        self.assertEqual(np.count_nonzero(out[48:96]), 0)
        np.testing.assert_array_equal(self.array("stages/stage2.npy"), out)
        self.assertEqual(self.array("stages/start.npy").shape, out.shape)

    def test_the_stages_of_reddy2011(self):
        self.succeed("decode", self.write_stream(slots=10, rows=16, cols=16), "-o", "out.npy", "--method", "reddy2011",
                     "--stages", "stages")
        names = [name for name in self.names() if name.startswith("stages/")]
        self.assertLess({"stages/start.npy", "stages/without_flow.npy", "stages/round1.npy"}, set(names) | {""})
        last = max(name for name in names if "round" in name)
        np.testing.assert_array_equal(self.array(last), self.array("out.npy"))

    def test_a_method_without_stages_is_refused(self):
        self.fails(INPUT, ["--stages", "method naive has none; portz2013, reddy2011 have"], "decode",
                   self.write_stream(), "-o", "out.npy", "--method", "naive", "--stages", "stages")


if __name__ == "__main__":
    unittest.main()
