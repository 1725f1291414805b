"""HDR video: what ffprobe and ffmpeg find in what the program writes, and what it reads of theirs."""

import json
import os
import shutil
import subprocess
import unittest

import numpy as np
from program import INPUT, OK, USAGE, ProgramTest

WHITE_CD = 203
TO_BT2020 = np.array([[.6274, .3293, .0433], [.0691, .9195, .0114], [.0164, .0880, .8956]])  # ITU-R BT.2087-0
COLOURS = np.array([[[0.18, 0.18, 0.18], [1, 0.05, 0.05], [4, 4, 4]],
                    [[0.05, 1, 0.05], [0.1, 0.2, 3], [0.01, 0.01, 0.01]]])
PATCH = 32  # HEVC needs 64 x 64
SLOTS = 4


def pq(cd):
    """ITU-R BT.2100-2, table 4."""
    power = (np.asarray(cd) / 10000) ** (1305 / 8192)
    return ((107 / 128 + 2413 / 128 * power) / (1 + 2392 / 128 * power)) ** (2523 / 32)


def hlg(light):
    """ITU-R BT.2100-2, table 5."""
    light = np.asarray(light, float)
    return np.where(light <= 1 / 12, np.sqrt(3 * light),
                    0.17883277 * np.log(np.maximum(12 * light - 0.28466892, 1e-9)) + 0.55991073)


@unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
class HdrVideoTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.light = np.repeat(np.repeat(COLOURS, PATCH, axis=0), PATCH, axis=1)
        rows, cols, _ = self.light.shape
        self.size = f"{cols}x{rows}"
        self.write_array("light.npy", [self.light] * SLOTS)
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "-q", "--sensor", "ideal", "--schedule", "full1x")
        self.succeed("decode", "clip.stipple", "-o", "decoded.npy", "--method", "naive", "-q")
        self.decoded = self.array("decoded.npy")[1]

    def tool(self, *command):
        done = subprocess.run(command, cwd=self.folder, capture_output=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def write_video(self, name, *options):
        return self.figures("decode", "clip.stipple", "-o", name, "--method", "naive", "--force", "-q", *options)

    def stream(self, name):
        found, = json.loads(self.tool("ffprobe", "-v", "error", "-count_frames", "-show_streams", "-of", "json",
                                      name))["streams"]
        return found

    def middles(self, frames):
        """The middle of each patch of the second frame."""
        return frames[1][PATCH // 2::PATCH, PATCH // 2::PATCH]

    def shown(self, name):
        """R'G'B' of the patches, 0..1."""
        raw = self.tool("ffmpeg", "-v", "error", "-i", name, "-vf", "scale=flags=accurate_rnd+full_chroma_int",
                        "-f", "rawvideo", "-pix_fmt", "rgb48le", "-")
        return self.middles(np.frombuffer(raw, "<u2").reshape(-1, *self.light.shape) / 65535)

    def test_pq_has_all_tags_and_the_mastering_display(self):
        for name, codec in (("a.mkv", "hevc"), ("a.mp4", "hevc"), ("b.mkv", "av1"), ("b.mp4", "av1")):
            figures = self.write_video(name, "--video", "pq", "--codec", codec, "--fps", 60)
            found = self.stream(name)
            expected = {"codec_name": codec, "pix_fmt": "yuv420p10le", "color_range": "tv", "color_space":
                        "bt2020nc", "color_primaries": "bt2020", "color_transfer": "smpte2084",
                        "avg_frame_rate": "60/1", "nb_read_frames": str(SLOTS)}
            self.assertEqual({key: found.get(key) for key in expected}, expected, name)
            data = {entry["side_data_type"]: entry for entry in found["side_data_list"]}
            mastering = data["Mastering display metadata"]
            value = {key: np.divide(*map(int, text.split("/"))) for key, text in mastering.items() if "/" in text}
            for key, wanted in {"red_x": .64, "red_y": .33, "green_x": .3, "green_y": .6, "blue_x": .15, "blue_y":
                                .06, "white_point_x": .3127, "white_point_y": .329, "max_luminance": 1000}.items():
                self.assertAlmostEqual(value[key], wanted, places=4, msg=f"{name} {key}")
            light = data["Content light level metadata"]
            brightest = np.minimum(WHITE_CD * self.array("decoded.npy") @ TO_BT2020.T, 1000).max(axis=3)
            self.assertEqual(light["max_content"], int(np.ceil(brightest.max())), name)
            self.assertAlmostEqual(light["max_average"], brightest.mean(axis=(1, 2)).max(), delta=1.1)
            self.assertAlmostEqual(figures["light_levels"]["max_cll"], brightest.max(), delta=0.1)

    def test_light_levels_in_the_stream_are_those_of_the_container(self):
        for name in ("a.mkv", "a.mp4"):
            self.write_video(name, "--video", "pq", "--peak-cd", 400)
            # The stream alone, with the headers that the container has held.
            self.tool("ffmpeg", "-v", "error", "-y", "-i", name, "-c", "copy", "-bsf:v", "hevc_mp4toannexb", "-f",
                      "hevc", "a.hevc")
            frames = json.loads(self.tool("ffprobe", "-v", "error", "-show_frames", "-of", "json", "a.hevc"))["frames"]
            data = {entry["side_data_type"]: entry for entry in frames[0]["side_data_list"]}
            self.assertEqual(data["Content light level metadata"]["max_content"], 400, name)
            container = {entry["side_data_type"]: entry for entry in self.stream(name)["side_data_list"]}
            self.assertEqual(data["Content light level metadata"], container["Content light level metadata"], name)
        frames = json.loads(self.tool("ffprobe", "-v", "error", "-show_frames", "-of", "json", "a.mkv"))["frames"]
        kinds = [entry["side_data_type"] for entry in frames[0]["side_data_list"]]
        self.assertIn("Mastering display metadata", kinds)
        data = {entry["side_data_type"]: entry for entry in self.stream("a.mkv")["side_data_list"]}
        self.assertEqual(data["Content light level metadata"]["max_content"], 400)
        said = self.succeed("decode", "clip.stipple", "-o", "a.mkv", "--method", "naive", "--force", "--video", "pq",
                            "--peak-cd", 400, "--json", "figures.json")
        clipped = json.loads((self.folder / "figures.json").read_text())["light_levels"]["clipped_fraction"]
        self.assertGreater(clipped, 0.1)
        self.assertIn("MaxCLL 400, MaxFALL ", said)
        self.assertIn(f", {100 * clipped:.2g} % of the values clipped", said)

    def test_signals_are_those_of_the_light(self):
        # Lossy: of 10 bits, some steps of luma, and of chroma, which weigh up to 1.9. A wrong matrix, curve or
        # range is off by 0.05 and more.
        bt2020 = self.middles([self.decoded] * 2) @ TO_BT2020.T
        for codec in ("hevc", "av1"):
            self.write_video("a.mkv", "--video", "pq", "--codec", codec, "--cd-per-unit", 100, "--peak-cd", 10000)
            np.testing.assert_allclose(self.shown("a.mkv"), pq(100 * bt2020), atol=0.012)
            self.write_video("a.mkv", "--video", "hlg", "--codec", codec)
            scene = np.minimum(bt2020 * (WHITE_CD / 1000) ** (1 / 1.2), 1)
            np.testing.assert_allclose(self.shown("a.mkv"), hlg(scene), atol=0.012)

    def test_hlg_has_its_tags_and_no_mastering_display(self):
        self.write_video("a.mp4", "--video", "hlg")
        found = self.stream("a.mp4")
        self.assertEqual([found["color_transfer"], found["color_primaries"], found["color_space"]],
                         ["arib-std-b67", "bt2020", "bt2020nc"])
        self.assertNotIn("Mastering", json.dumps(found.get("side_data_list", [])))

    def test_an_independent_reader_finds_the_light(self):
        if b" zscale " not in self.tool("ffmpeg", "-v", "error", "-filters"):
            self.skipTest("this ffmpeg has no zscale")
        self.write_video("a.mkv", "--video", "pq", "--peak-cd", 10000)
        raw = self.tool("ffmpeg", "-v", "error", "-i", "a.mkv", "-vf",
                        f"zscale=t=linear:npl={WHITE_CD}:p=bt709:m=gbr:r=full,format=gbrpf32le", "-f", "rawvideo", "-")
        rows, cols, _ = self.light.shape
        planes = np.frombuffer(raw, "<f4").reshape(-1, 3, rows, cols)[:, [2, 0, 1]].transpose(0, 2, 3, 1)
        wanted = self.middles([self.decoded] * 2)
        # A step of the 10-bit signal is about 1 % of the light; the matrix spreads that of the largest.
        np.testing.assert_allclose(self.middles(planes), wanted, rtol=0.05, atol=0.03 * wanted.max())
        self.succeed("emulate", "a.mkv", "-o", "again.stipple", "-q", "--transfer", "auto", "--truth", "again.npy",
                     "--set", "sensor.slot_us=33333.3")
        # The same steps; chroma between pixels is the same inside of the patches.
        np.testing.assert_allclose(self.middles(self.array("again.npy")), self.middles(planes), rtol=0.01,
                                   atol=2e-3)

    def test_light_comes_back(self):
        wanted = self.middles([self.decoded] * 2)
        for name in ("pq", "hlg"):
            for transfer in (name, "auto"):
                self.write_video("a.mkv", "--video", name, *(["--peak-cd", 10000] if name == "pq" else []))
                self.succeed("emulate", "a.mkv", "-o", "b.stipple", "-q", "--force", "--transfer", transfer, "--truth",
                             "b.npy", "--set", "sensor.slot_us=33333.3")
                limit = wanted.max() if name == "pq" else 1 / (WHITE_CD / 1000) ** (1 / 1.2)
                found = self.middles(self.array("b.npy"))
                unclipped = wanted.max(axis=2) < 0.95 * limit
                np.testing.assert_allclose(found[unclipped], wanted[unclipped], rtol=0.05, atol=0.03 * limit)

    def test_auto_takes_what_the_file_declares(self):
        codes = np.linspace(0, 65535, 256).astype("<u2").reshape(1, 16, 16).repeat(2, axis=0)
        value = codes[0] / 65535
        formulas = {"smpte2084": None, "linear": value, "gamma22": value ** 2.2,
                    "bt709": np.where(value < 0.081, value / 4.5, ((value + 0.099) / 1.099) ** (1 / 0.45)),
                    "iec61966-2-1": np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)}
        for curve, light in formulas.items():
            subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "gray16le", "-s", "16x16",
                            "-i", "-", "-c:v", "ffv1", "-color_trc", curve, "a.mkv"], input=codes.tobytes(),
                           cwd=self.folder, check=True)
            self.succeed("emulate", "a.mkv", "-o", "b.stipple", "-q", "--force", "--transfer", "auto", "--truth", "b.npy")
            found = self.array("b.npy")[0]
            if light is None:
                np.testing.assert_allclose(pq(WHITE_CD * found), value, atol=3e-5)  # of floats
            else:
                np.testing.assert_allclose(found, light, atol=1e-5)
        self.assertIn("--transfer auto", self.succeed("info", "b.stipple"))

    def test_auto_needs_a_declaration_that_is_known(self):
        for curve, parts in (([], ["declares no transfer function", "--transfer bt709"]),
                             (["-color_trc", "log100"], ["declares the transfer function log100"])):
            self.tool("ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i", "testsrc2=size=16x16:duration=0.1", "-c:v",
                      "ffv1", "-pix_fmt", "yuv444p", *curve, "a.mkv")
            self.fails(INPUT, ["a.mkv: " + parts[0], *parts[1:]], "emulate", "a.mkv", "-o", "b.stipple", "--transfer",
                       "auto")

    def test_options_that_do_nothing_are_refused(self):
        for output, options, text in (("a.npy", ["--video", "pq"], "--video"), ("a.mkv", ["--codec", "av1"], "--codec"),
                                      ("a", ["--fps", 5], "--fps"),
                                      ("a.mkv", ["--video", "hlg", "--peak-cd", 500], "--peak-cd"),
                                      ("a.mkv", ["--video", "pq", "--peak-cd", 20000], "--peak-cd")):
            self.fails(USAGE, [text], "decode", "clip.stipple", "-o", output, *options)

    def test_small_frames_are_for_av1(self):
        self.write_array("light.npy", [self.light[:20, :30]] * SLOTS)
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "-q", "--force")
        for video in ("pq", "hlg"):
            self.fails(INPUT, ["a.mkv: frames of 30 x 20 are too small for HEVC", "--codec av1"], "decode",
                       "clip.stipple", "-o", "a.mkv", "--method", "naive", "--video", video)
        self.write_video("a.mkv", "--video", "pq", "--codec", "av1")

    def test_bytes_are_the_same_on_one_processor_and_on_all(self):
        for codec in ("hevc", "av1"):
            contents = set()
            for processors in (os.sched_getaffinity(0), {min(os.sched_getaffinity(0))}):
                done = self.run_program("decode", "clip.stipple", "-o", "a.mkv", "--force", "-q", "--method", "naive",
                                        "--video", "pq", "--codec", codec,
                                        preexec_fn=lambda mask=processors: os.sched_setaffinity(0, mask))
                self.assertEqual((done.returncode, done.stderr), (OK, ""))
                contents.add((self.folder / "a.mkv").read_bytes())
            self.assertEqual(len(contents), 1, codec)


if __name__ == "__main__":
    unittest.main()
