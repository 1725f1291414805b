"""The videos that the program writes, as ffmpeg and ffprobe read them."""

import json
import os
import shutil
import subprocess
import unittest

import numpy as np
from program import DEVICE, INPUT, OK, PROGRAM, USAGE, ProgramTest
from outputs_test import small_files

COLOURS = np.array([[[0.18, 0.18, 0.18], [1, 0.05, 0.05]], [[0.05, 1, 0.05], [0.1, 0.2, 3]]])
ONE_PROCESSOR = {min(os.sched_getaffinity(0))}


def tone_mapped(light):
    """docs: x (1 + x / 16) / (1 + x), then the power 1 / 2.2."""
    return np.round(255 * (light * (1 + light / 16) / (1 + light)) ** (1 / 2.2))


@unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
class OutputVideoTest(ProgramTest):
    def write_video(self, name, light):
        self.succeed("emulate", self.write_array("light.npy", light), "-o", "clip.stipple", "--force", "-q",
                     "--truth", name)
        return name

    def run_tool(self, *command):
        return subprocess.run(command, check=True, cwd=self.folder, capture_output=True, timeout=60).stdout

    def shown(self, name, rows, cols):
        """The last frame, in red, green and blue."""
        frames = self.run_tool("ffmpeg", "-v", "error", "-i", name, "-f", "rawvideo", "-pix_fmt", "rgb24", "-")
        return np.frombuffer(frames, np.uint8).reshape(-1, rows, cols, 3)[-1]

    def test_it_is_h264_that_declares_its_colours(self):
        for name in ("a.mp4", "a.mkv"):
            self.succeed("synth", "pan", "-o", name, "--size", "63x47", "--frames", 20)
            stream, = json.loads(self.run_tool("ffprobe", "-v", "error", "-count_frames", "-show_streams", "-of",
                                               "json", name))["streams"]
            expected = {"codec_name": "h264", "pix_fmt": "yuv420p", "width": 64, "height": 48,
                        "color_range": "tv", "color_space": "bt709", "color_primaries": "bt709",
                        "color_transfer": "bt470m", "avg_frame_rate": "30/1", "nb_read_frames": "20"}
            self.assertEqual({key: stream.get(key) for key in expected}, expected)

    def test_colours_are_those_of_the_light_at_any_size(self):
        for rows, cols in ((48, 64), (720, 16)):
            light = np.repeat(np.repeat(COLOURS, rows // 2, axis=0), cols // 2, axis=1)
            for name in ("a.mp4", "a.mkv"):
                image = self.shown(self.write_video(name, [light] * 3), rows, cols)
                inner = image[rows // 4::rows // 2, cols // 4::cols // 2]
                # Lossy: two steps of luma, which are 1.2, and two of chroma, up to 2.1. BT.601 is off by 15.
                np.testing.assert_allclose(inner, tone_mapped(COLOURS), atol=6)

    def test_uncompressed_video_has_the_colours_of_the_light(self):
        for rows, matrix in ((48, "bt601"), (720, "bt709")):  # as readers guess
            light = np.repeat(np.repeat(COLOURS, rows // 2, axis=0), 8, axis=1)
            self.write_video("a.y4m", [light] * 3)
            frames = self.run_tool("ffmpeg", "-v", "error", "-i", "a.y4m", "-vf", f"scale=in_color_matrix={matrix}", "-f",
                                   "rawvideo", "-pix_fmt", "rgb24", "-")
            image = np.frombuffer(frames, np.uint8).reshape(3, rows, 16, 3)[0, rows // 4::rows // 2, 4::8]
            np.testing.assert_allclose(image, tone_mapped(COLOURS), atol=3)  # 8 bits of luma and chroma

    def pipe(self, *arguments):
        """What a run with binary data on standard output writes there, and its messages."""
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, timeout=60)
        self.assertEqual(done.returncode, OK, done.stderr)
        return done.stdout, done.stderr.decode()

    def test_standard_output_and_named_pipes_take_uncompressed_video(self):
        decode = ("decode", self.write_stream(slots=6), "--method", "naive", "-o")
        self.succeed(*decode, "file.y4m")
        whole = (self.folder / "file.y4m").read_bytes()
        video, said = self.pipe(*decode, "-")
        self.assertEqual(video, whole)
        self.assertIn("stipple: -: 6 frames, method naive", said)
        frames = subprocess.run(["ffmpeg", "-v", "error", "-i", "-", "-f", "rawvideo", "-pix_fmt", "gray", "-"],
                                input=video, check=True, capture_output=True).stdout
        self.assertEqual(len(frames), 6 * 8 * 8)
        os.mkfifo(self.folder / "pipe.y4m")
        with subprocess.Popen(["cat", "pipe.y4m"], cwd=self.folder, stdout=subprocess.PIPE) as reader:
            self.succeed(*decode, "pipe.y4m")
            self.assertEqual(reader.communicate(timeout=60)[0], whole)
        self.succeed("decode", "clip.stipple", "--method", "naive", "-o", "windows", "--part", "1/1")
        self.assertEqual(self.pipe("join", "windows", "-o", "-")[0], whole)

    def test_a_pipe_without_a_reader_ends_the_program_quietly(self):
        with subprocess.Popen(["true"], stdin=subprocess.PIPE) as reader:
            reader.wait()
            done = subprocess.run([PROGRAM, "synth", "pan", "-o", "-", "--size", "256x192", "--frames", "4"],
                                  stdout=reader.stdin, stderr=subprocess.PIPE, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (141, b""))

    def test_what_a_pipe_cannot_take_is_refused(self):
        decode = ("decode", self.write_stream(slots=6), "--method", "naive")
        self.fails(USAGE, ['"-" is the output of --json too'], *decode, "-o", "-", "--json", "-")
        self.fails(USAGE, ["with --part it is a folder"], *decode, "-o", "-", "--part", "1/2")
        self.fails(USAGE, ["--video: needs .mp4 or .mkv"], *decode, "-o", "-", "--video", "pq")
        os.mkfifo(self.folder / "pipe.npy")
        self.fails(INPUT, ["pipe.npy: is a pipe, which takes .y4m only"], *decode, "-o", "pipe.npy")

    def test_grey_has_no_colour(self):
        light = np.repeat([[0, 0.18, 1, 4]], 16, axis=0).repeat(16, axis=1)
        image = self.shown(self.write_video("a.mkv", [light] * 3), 16, 64)
        self.assertLessEqual(np.ptp(image.astype(int), axis=2).max(), 1)
        np.testing.assert_allclose(image[8, 8::16, 0], tone_mapped(light[8, 8::16]), atol=2)

    def test_bytes_are_the_same_on_one_processor_and_on_all(self):
        self.succeed("synth", "pan", "-o", "light.npy", "--size", "96x64", "--frames", 40)
        for name in ("a.mp4", "a.mkv"):
            contents = set()
            for processors in (os.sched_getaffinity(0), ONE_PROCESSOR):
                self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--truth", name, "--force",
                             preexec_fn=lambda mask=processors: os.sched_setaffinity(0, mask))
                contents.add((self.folder / name).read_bytes())
            self.assertEqual(len(contents), 1)

    def test_a_full_disk_is_said_in_the_words_of_the_system(self):
        for name in ("a.mp4", "a.mkv"):
            self.fails(DEVICE, [f"{name}: cannot be written: File too large"], "synth", "pan", "-o", name,
                       "--size", "128x96", "--frames", 4, preexec_fn=small_files)

    def test_a_frame_that_no_encoder_takes_is_refused(self):
        light = self.write_array("light.npy", np.zeros((1, 2, 20000)))
        # libx264 does not free what it has taken for an encoder that it then refuses.
        self.fails(DEVICE, ["a.mp4: no video of 20000 x 2 pixels at 30 frames per second can be encoded"],
                   "emulate", light, "-o", "clip.stipple", "--truth", "a.mp4",
                   env=os.environ | {"ASAN_OPTIONS": "detect_leaks=0"})

    def test_libraries_that_cannot_be_loaded_are_named(self):
        (self.folder / "broken").mkdir()
        major = next(line.split(".so.")[1].split()[0] for line in self.run_tool("ldconfig", "-p").decode().splitlines()
                     if "libavformat.so." in line)
        (self.folder / f"broken/libavformat.so.{major}").write_bytes(b"no library")
        environment = {**os.environ, "LD_LIBRARY_PATH": str(self.folder / "broken")}
        self.fails(DEVICE, ["libavformat.so", "cannot be loaded, but video needs it"], "synth", "pan", "-o", "a.mp4",
                   env=environment)
        self.succeed("synth", "pan", "-o", "a.npy", "--size", "8x8", "--frames", 1)

    def test_a_start_loads_neither_ffmpeg_nor_what_reads_images_in_opencv(self):
        needed = self.run_tool("readelf", "--wide", "--dynamic", PROGRAM).decode()
        for library in ("libav", "libsw", "libopencv_imgcodecs", "libopencv_videoio", "libopencv_optflow"):
            self.assertNotIn(f"[{library}", needed)


if __name__ == "__main__":
    unittest.main()
