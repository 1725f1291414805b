"""The methods learned and learned_fast with the weights of Stipple."""

import hashlib
import json
import shutil
import unittest
from pathlib import Path

from program import INPUT, ProgramTest

WEIGHTS = Path(__file__).resolve().parents[2] / "config/models/refinement.safetensors"


class LearnedTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.succeed("synth", "dice", "-o", "light.npy", "--frames", 70, "--size", "64x48", "--luminance")
        self.succeed("emulate", "light.npy", "-o", "clip.stipple")

    def quality(self, method, *more):
        self.succeed("decode", "clip.stipple", "-o", f"{method}.npy", "--method", method, *more)
        return self.figures("compare", f"{method}.npy", "light.npy", "--margin", 4)["psnr_db"]

    def test_they_are_better_than_what_they_refine(self):
        self.assertGreater(self.quality("learned_fast"), self.quality("fast"))
        self.assertGreater(self.quality("learned"), self.quality("best"))

    def test_parts_have_the_bytes_of_one_run_and_the_hash_of_the_weights(self):
        self.quality("learned_fast")
        for part in ("2/2", "1/2"):
            self.succeed("decode", "clip.stipple", "-o", "parts", "--part", part, "--method", "learned_fast")
        self.succeed("join", "parts", "-o", "joined.npy")
        self.assertEqual((self.folder / "joined.npy").read_bytes(), (self.folder / "learned_fast.npy").read_bytes())
        identity = json.loads((self.folder / "parts/decoding.json").read_text())
        self.assertEqual(identity["options"], "# " + hashlib.sha256(WEIGHTS.read_bytes()).hexdigest())

    def test_the_same_weights_from_a_file_give_the_same_bytes(self):
        shutil.copy(WEIGHTS, self.folder / "copy.safetensors")
        self.quality("learned_fast")
        self.succeed("decode", "clip.stipple", "-o", "named.npy", "--method", "learned_fast", "--set",
                     "decoder.model=copy.safetensors")
        self.assertEqual((self.folder / "named.npy").read_bytes(), (self.folder / "learned_fast.npy").read_bytes())

    def test_damaged_weights_are_one_error(self):
        (self.folder / "cut.safetensors").write_bytes(WEIGHTS.read_bytes()[:100000])
        self.fails(INPUT, ["cut.safetensors"], "decode", "clip.stipple", "-o", "x.npy", "--method", "learned_fast",
                   "--set", "decoder.model=cut.safetensors")


if __name__ == "__main__":
    unittest.main()
