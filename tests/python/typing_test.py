"""The type hints are sound, and are those of the classes and functions that there are."""

import inspect
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import stipple
from stipple import _stipple

USE = '''
from pathlib import Path
import numpy as np
import stipple

video = np.zeros((30, 8, 8), np.float32)
sensor = stipple.Sensor("paper", {"read_noise_e": 5})
schedule = stipple.Schedule("tiled", size=(8, 8), sensor=sensor)
stream = stipple.emulate(video, sensor, schedule, seed=2, output=Path("clip.stipple"), progress=print)
result = stipple.decode(stream, "fast", {"rounds": 1}, until=3)
db: float = stipple.compare(result, video, margin=1).psnr_db
rows: int = stream.samples(0)["row"].size + stream.header["rows"]
series = [(5e6, 0.0, np.zeros((2, 4, 4), np.uint16))]
figures = [stipple.characterize(sensor, progress=print), stipple.characterize_images(series, bits=12)]
gain = stipple.calibrate("t6.stcal", sensor=sensor, size=(8, 8), progress=print)["gain"]
gain = stipple.calibrate(Path("a.stcal"), dark=stream, flat=["a.stipple", stream])["gain"]
settings = {"PixelFormat": "Mono12", "ExposureTime": 2000}
recording = stipple.capture.record("replay:a.npy", Path("a.strec"), settings=settings, seconds=1.5)
live = stipple.capture.live("replay:a.npy", sensor, schedule, frames=5, progress=lambda done, frames: done < 4)
def show(frame: stipple.PreviewFrame) -> None:
    print(frame.slot, frame.light.mean(), frame.saturated.any())
live = stipple.capture.live("replay:a.npy", preview=show, preview_method="fast", preview_size=(48, 64))
addresses = [camera.address for camera in stipple.capture.list()]
units = {feature.name: feature.unit for feature in stipple.capture.features("gige:127.0.0.1", "exposure")}
with stipple.capture.frames("replay:a.npy") as frames:
    dn = [frame.dn.mean() for frame in frames]
def own(stream: stipple.Stream, sigma: float = 0.1) -> "np.ndarray[tuple[int, ...], np.dtype[np.float32]]":
    return stipple.decode(stream, "naive")
table = stipple.rivals("pan", Path("results"), methods=["naive", own, stipple.Decoder(own, "other", "1")], seeds=2)
table = stipple.explore("space.toml", "results", methods=[own], crop="16x16", resize=(8, 8))
page: int = stipple.report([stream, "clip.stipple"], "a.html", truth=video, methods=["best", own])["bytes"]
rig = stipple.emulate_rig(stipple.synth("pan", frames=4), "tocci2011_slow", "rig", {"high.share": 0.5})
'''


class TypingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cache = cls.enterClassContext(tempfile.TemporaryDirectory(prefix="stipple_"))

    def mypy(self, *arguments):
        return subprocess.run(["mypy", "--strict", "--python-executable", sys.executable, "--cache-dir", self.cache,
                               *map(str, arguments)], capture_output=True, text=True, timeout=250,
                              env=os.environ | {"MYPYPATH": str(Path(stipple.__file__).parents[1])})

    def test_the_package_and_its_use_pass_mypy(self):
        for arguments in (["-c", USE], ["-p", "stipple"]):
            done = self.mypy(*arguments)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        done = self.mypy("-c", USE + "stipple.decode(stream, 5)\n")
        self.assertIn('Argument 2 to "decode" has incompatible type "int"; expected "str"', done.stdout)

    def test_the_stub_names_all_that_is_compiled(self):
        stub = (Path(_stipple.__file__).parent / "_stipple.pyi").read_text()
        for name, value in vars(_stipple).items():
            if name.startswith("__"):
                continue
            self.assertRegex(stub, rf"(class|def) {name}\b")
            members = vars(value) if inspect.isclass(value) else {}
            for member in members:
                if not member.startswith("_"):
                    self.assertRegex(stub, rf"def {member}\(self\b|def {member}\(", name)

    def test_all_that_is_public_is_explained(self):
        for name in stipple.__all__:
            value = getattr(stipple, name)
            if name == "__version__":
                continue
            self.assertTrue(value.__doc__, name)
        for name in stipple.capture.__all__:
            self.assertTrue(getattr(stipple.capture, name).__doc__, name)


if __name__ == "__main__":
    unittest.main()
