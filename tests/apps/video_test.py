"""Video files of all depths, matrices and ranges, written by ffmpeg, against what it was given."""

import shutil
import subprocess
import unittest

import numpy as np
from program import INPUT, OK, ProgramTest

COLOUR = (0xC0, 0x30, 0x60)
HINT = "looks gamma-coded: add --transfer srgb"


def but_the_rate(said):
    """Without the warning that the video plays at another rate than that of the slots."""
    return "".join(line for line in said.splitlines(True) if " frames/s, but a slot " not in line)


@unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
class VideoTest(ProgramTest):
    def ffmpeg(self, *arguments, data=None):
        done = subprocess.run(["ffmpeg", "-v", "error", "-y", *map(str, arguments)], input=data,
                              cwd=self.folder, capture_output=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def write_raw(self, name, frames, pixels, *options, rate=25):
        """Frames (slot, row, col, ...) of a pixel format of ffmpeg, without loss."""
        self.ffmpeg("-f", "rawvideo", "-pix_fmt", pixels, "-r", rate, "-s",
                    f"{frames.shape[2]}x{frames.shape[1]}", "-i", "-", "-c:v", "ffv1", *options, name,
                    data=frames.tobytes())
        return name

    def write_moving(self, name, *options, seconds=1):
        self.ffmpeg("-f", "lavfi", "-i", f"testsrc2=size=64x48:rate=30:duration={seconds}", *options,
                    name)
        return name

    def write_flat_colour(self, name, rows, matrix, scale, pixels, *options):
        """The colour, turned into Y'CbCr by ffmpeg."""
        declared = ["-colorspace", matrix] if matrix else []
        self.ffmpeg("-f", "lavfi", "-i", "color=c=0x%02x%02x%02x:s=16x%d:d=0.04" % (*COLOUR, rows),
                    "-vf", f"format=gbrp16le,scale={scale},format={pixels}", *declared, *options,
                    name)
        return name

    def emulate(self, video, *options):
        """The light that was emulated, and what was said of it."""
        done = self.run_program("emulate", video, "-o", "clip.stipple", "--truth", "light.npy",
                                "--force", "-q", *options)
        self.assertEqual(done.returncode, OK, done.stderr)
        return self.array("light.npy"), but_the_rate(done.stderr)

    def shown(self, video, shape):
        """The frames as ffmpeg shows them, in 8 bits."""
        frames = self.ffmpeg("-i", video, "-sws_flags",
                             "bicubic+accurate_rnd+full_chroma_int+full_chroma_inp", "-f", "rawvideo",
                             "-pix_fmt", "rgb24", "-")
        return np.frombuffer(frames, np.uint8).reshape(shape)

    def test_grey_stays_one_plane_at_its_own_depth(self):
        for depth in (8, 10, 12, 16):
            most = 2 ** depth - 1
            levels = np.arange(4096).reshape(1, 64, 64) % (most + 1) * (most // min(most, 4095))
            pixels = "gray" if depth == 8 else f"gray{depth}le"
            self.write_raw("grey.mkv", levels.astype(np.uint8 if depth == 8 else "<u2"), pixels)
            light, _ = self.emulate("grey.mkv")
            with self.subTest(depth=depth):
                self.assertEqual(light.shape, levels.shape)
                self.assertEqual(len(np.unique(light)), min(4096, most + 1))
                np.testing.assert_allclose(light, levels / most, atol=1e-7)  # float32

    def test_grey_of_limited_range_runs_from_16_to_235(self):
        levels = np.arange(256, dtype=np.uint8).reshape(1, 16, 16)
        self.write_raw("grey.mkv", levels, "gray", "-color_range", "tv")
        light, _ = self.emulate("grey.mkv")
        np.testing.assert_allclose(light, np.clip((levels - 16.0) / 219, 0, 1), atol=1e-6)

    def test_rgb_is_exact_at_all_depths(self):
        random = np.random.default_rng(1)
        for pixels, most in (("rgb24", 255), ("bgra", 255), ("rgb48le", 65535)):
            values = random.integers(0, most + 1, (2, 9, 7, len(pixels.rstrip("1234567890le"))))
            values = values.astype(np.uint8 if most == 255 else "<u2")
            name = self.write_raw("rgb.mkv", values, pixels)
            light, said = self.emulate(name)
            expected = values[..., 2::-1] if pixels == "bgra" else values
            with self.subTest(pixels=pixels):
                np.testing.assert_allclose(light, expected / most, atol=1e-7)
                self.assertEqual("its alpha channel is left out" in said, pixels == "bgra")

    def test_the_matrix_and_the_range_are_those_that_the_file_declares(self):
        lossless = {"yuv420p": ["-c:v", "libx264", "-qp", "0"], "yuv444p12le": ["-c:v", "ffv1"],
                    "yuv422p10le": ["-c:v", "ffv1"]}
        for rows, matrix, scaled in ((48, "bt709", "bt709"), (720, "smpte170m", "bt601"),
                                     (48, "bt2020nc", "bt2020"), (48, "smpte240m", "smpte240m"), (48, "fcc", "fcc"),
                                     (718, None, "bt601"),
                                     (720, None, "bt709")):
            for span in ("tv", "pc"):
                for pixels, codec in lossless.items():
                    name = self.write_flat_colour(
                        "flat.mkv", rows, matrix, f"out_color_matrix={scaled}:out_range={span}",
                        pixels, "-color_range", span, *codec)
                    light, _ = self.emulate(name)
                    with self.subTest(rows=rows, matrix=matrix, span=span, pixels=pixels):
                        np.testing.assert_allclose(light[0, 20, 9] * 255, COLOUR, atol=2)

    def test_two_moments_in_a_frame_are_refused(self):
        """Frames of fields, as each kind of file declares them; bwdif makes a frame of each."""
        fields = ["-vf", "interlace=scan=tff"]
        for name, options in (
                ("h264.mp4", ["-c:v", "libx264", "-flags", "+ilme+ildct", "-x264-params", "tff=1"]),
                ("mpeg2.mpg", ["-c:v", "mpeg2video", "-flags", "+ilme+ildct", "-top", "1"]),
                ("prores.mov", ["-c:v", "prores_ks", "-flags", "+ildct", "-top", "1"]),
                ("raw.y4m", ["-pix_fmt", "yuv420p", "-field_order", "tt"])):
            with self.subTest(name=name):
                self.write_moving(name, *fields, *options, seconds=0.4)
                for command in (["info", name], ["emulate", name, "-o", "x.stipple"]):
                    self.fails(INPUT, [f"{name}: frame 0: is interlaced", "ffmpeg -i VIDEO -vf bwdif OUT.mkv"],
                               *command)
                self.ffmpeg("-i", name, "-vf", "bwdif", "progressive.mkv")
                self.assertGreater(len(self.emulate("progressive.mkv")[0]), 10)

    def test_other_primaries_are_said_unless_they_are_converted(self):
        for primaries, curve, options, is_said in (
                ("bt2020", "bt709", [], True), ("smpte432", "bt709", ["--transfer", "bt709"], True),
                ("bt2020", "smpte2084", ["--transfer", "auto"], False), ("bt2020", "smpte2084", [], True),
                ("bt709", "bt709", [], False), ("smpte170m", "smpte170m", [], False)):
            with self.subTest(primaries=primaries, curve=curve, options=options):
                self.write_moving("a.mkv", "-pix_fmt", "yuv420p", "-c:v", "libx264", "-color_primaries", primaries,
                                  "-color_trc", curve, "-colorspace", "bt2020nc", seconds=0.1)
                _, said = self.emulate("a.mkv", *options)
                self.assertEqual(f"declares the primaries {primaries}, which are not converted" in said, is_said, said)
        self.write_moving("a.mkv", "-pix_fmt", "yuv420p", "-c:v", "libx264", "-color_primaries", "bt2020", "-color_trc",
                          "bt709", "-colorspace", "bt2020nc", "-color_range", "tv", seconds=0.1)
        self.ffmpeg("-i", "a.mkv", "-vf", "colorspace=bt709", "b.mkv")
        self.assertNotIn("primaries", self.emulate("b.mkv")[1])
        self.write_raw("grey.mkv", np.zeros((1, 16, 16), np.uint8), "gray", "-color_primaries", "bt2020")
        self.assertNotIn("primaries", self.emulate("grey.mkv")[1])

    def test_pixels_that_are_not_square_are_said(self):
        for name, codec in (("a.mp4", "libx264"), ("a.mkv", "ffv1"), ("a.avi", "mpeg4")):
            with self.subTest(name=name):
                self.write_moving(name, "-vf", "setsar=4/3", "-c:v", codec, seconds=0.1)
                self.assertIn(f"{name}: declares pixels 1.333 times as wide as high", self.emulate(name)[1])
                self.write_moving(name, "-c:v", codec, seconds=0.1)
                self.assertNotIn("as wide", self.emulate(name)[1])

    def test_fields_that_begin_later_are_refused_where_they_do(self):
        self.write_moving("a.m2v", "-c:v", "mpeg2video", seconds=0.2)
        self.write_moving("b.m2v", "-vf", "interlace=scan=tff", "-c:v", "mpeg2video", "-flags", "+ilme+ildct", seconds=0.4)
        (self.folder / "both.mpg").write_bytes((self.folder / "a.m2v").read_bytes() + (self.folder / "b.m2v").read_bytes())
        said = self.fails(INPUT, ["is interlaced"], "emulate", "both.mpg", "-o", "x.stipple")
        self.assertNotIn("frame 0:", said)

    def test_prores_keeps_ten_bits(self):
        ramp = np.broadcast_to(np.arange(64, 940, dtype="<u2")[:768], (1, 64, 768))
        neutral = np.full((1, 64, 384), 512, "<u2")
        data = b"".join(plane.tobytes() for plane in (ramp, neutral, neutral))
        self.ffmpeg("-f", "rawvideo", "-pix_fmt", "yuv422p10le", "-s", "768x64", "-i", "-", "-c:v",
                    "prores_ks", "-profile:v", "hq", "ramp.mov", data=data)
        light, _ = self.emulate("ramp.mov")
        expected = (ramp[0, 0] - 64.0) / 876
        # Lossy, but finer than 8 bits, whose steps are 4: two of ten bits at most.
        self.assertLess(np.abs(light[0, :, :, 1].mean(axis=0) - expected).max(), 2 / 876)
        self.assertGreater(len(np.unique(light[0, :, :, 1])), 400)

    def test_chroma_is_upsampled_as_by_ffmpeg(self):
        self.write_moving("video.mp4", "-pix_fmt", "yuv420p", "-c:v", "libx264", seconds=0.2)
        light, _ = self.emulate("video.mp4")
        # Theirs rounds light and colour to 8 bits, of which one of colour is 1.8 of blue.
        np.testing.assert_allclose(light * 255, self.shown("video.mp4", light.shape), atol=3.5)

    def test_turned_video_is_set_upright(self):
        self.write_moving("video.mp4", "-pix_fmt", "yuv444p", "-c:v", "libx264", seconds=0.2)
        for degrees in (90, 180, 270):
            self.ffmpeg("-i", "video.mp4", "-c", "copy", "-metadata:s:v:0", f"rotate={degrees}",
                        "turned.mp4")
            light, _ = self.emulate("turned.mp4")
            self.assertEqual(light.shape[1:3], (48, 64) if degrees == 180 else (64, 48))
            np.testing.assert_allclose(light * 255, self.shown("turned.mp4", light.shape), atol=3.5)

    def test_odd_sizes(self):
        planes = [np.full(size, value, np.uint8)
                  for size, value in (((21, 35), 126), ((11, 18), 128), ((11, 18), 128))]
        self.ffmpeg("-f", "rawvideo", "-pix_fmt", "yuv420p", "-s", "35x21", "-i", "-", "-c:v", "ffv1",
                    "odd.mkv", data=b"".join(plane.tobytes() for plane in planes))
        light, _ = self.emulate("odd.mkv")
        self.assertEqual(light.shape, (1, 21, 35, 3))
        np.testing.assert_allclose(light, 110 / 219, atol=1e-6)

    def refuse(self, video, *parts):
        message = self.fails(INPUT, [video, *parts], "emulate", video, "-o", "clip.stipple",
                             "--transfer", "srgb")
        self.assertEqual(but_the_rate(message).count("\n"), 1, message)

    def test_a_truncated_file_is_refused(self):
        for name, codec in (("video.mkv", "libx264"), ("video.avi", "mpeg4"),
                            ("video.mov", "prores_ks")):
            self.write_moving(name, "-c:v", codec)
            whole = (self.folder / name).read_bytes()
            for percent in (1, 30, 60, 85):
                (self.folder / name).write_bytes(whole[:len(whole) * percent // 100])
                with self.subTest(name=name, percent=percent):
                    self.refuse(name, "damaged")

    def test_a_truncated_file_with_sound_is_refused(self):
        self.write_moving("video.mkv", "-f", "lavfi", "-i", "sine=duration=1", "-c:v", "ffv1", "-c:a",
                          "flac")
        self.assertEqual(self.emulate("video.mkv", "--transfer", "srgb")[1], "")
        whole = (self.folder / "video.mkv").read_bytes()
        (self.folder / "cut.mkv").write_bytes(whole[:len(whole) // 2])
        (self.folder / "clip.stipple").unlink()
        self.refuse("cut.mkv", "damaged")

    def test_a_cut_end_is_told(self):
        self.write_moving("video.mkv", "-c:v", "ffv1")
        whole = (self.folder / "video.mkv").read_bytes()
        (self.folder / "video.mkv").write_bytes(whole[:len(whole) * 94 // 100])
        light, said = self.emulate("video.mkv", "--transfer", "srgb")
        self.assertLess(len(light), 30)
        self.assertIn(f"video.mkv: ends after {len(light)} frames, at {len(light) / 30:.3f} of 1.000 s; "
                      "frames may be missing", said)

    def test_frames_that_last_unequally_long_are_told(self):
        self.write_moving("video.mkv", "-c:v", "ffv1", "-vf", "setpts=N*N/300/TB", "-fps_mode", "vfr")
        light, said = self.emulate("video.mkv", "--transfer", "srgb")
        self.assertGreater(len(light), 20)  # ffmpeg leaves out some that would be shown at once
        self.assertRegex(said, r'^stipple: warning: video.mkv: its frames are [\d.]+ to [\d.]+ s apart, but each '
                         r'becomes one slot; --resample blend puts them at their times\n$')
        for rate in (24, 59.94, 240, 700):  # times in whole milliseconds
            self.write_moving("video.mkv", "-c:v", "ffv1", "-r", rate, seconds=0.2)
            self.assertEqual(self.emulate("video.mkv", "--transfer", "srgb")[1], "")

    def write_bar(self, name, kept, *options):
        """A bar, at column 2 t after t hundredths of a second, of which ffmpeg keeps some frames at their times."""
        time = np.arange(60)[:, None, None]
        frames = np.broadcast_to(90 + 160 * (np.arange(160) // 4 == time // 2), (60, 16, 160)).astype(np.uint8)
        return self.write_raw(name, frames, "gray", "-vf", f"select='{kept}'", "-fps_mode", "vfr", *options,
                              rate=100)

    def test_resampling_heeds_the_times_of_frames(self):
        """Slots of a hundredth of a second: the bar is where it was in the last frame that is shown."""
        every = np.arange(60)
        for name, options in (("a.mkv", []), ("a.mp4", ["-c:v", "libx264", "-qp", "0"])):
            for kept, shown in (("1", every), ("not(mod(n,4))+gt(n,30)", np.where(every > 30, every, every // 4 * 4)),
                                ("lt(n,10)+gt(n,40)", np.where((every > 9) & (every < 41), 9, every))):
                with self.subTest(name=name, kept=kept):
                    self.write_bar(name, kept, *options)
                    light, said = self.emulate(name, "--transfer", "linear", "--luminance", "--resample", "hold",
                                               "--set", "sensor.slot_us=10000")
                    self.assertEqual(said, "")
                    np.testing.assert_array_equal(light[:, 0].argmax(axis=1)[:58], shown[:58] // 2 * 4)
                    self.assertIn(len(light), (59, 60, 61))

    def test_flow_and_blend_of_unequal_times_move_at_the_speed_of_equal_ones(self):
        """A wide edge that moves by 2 columns in a hundredth of a second: its place of one half is linear in time."""
        time, cols = np.arange(60)[:, None, None], np.arange(200)[None, None, :]
        frames = np.broadcast_to(np.clip(128 + 3 * (30 + 2 * time - cols), 0, 255), (60, 32, 200)).astype(np.uint8)
        edges = {}
        for name, kept in (("equal.mkv", "1"), ("unequal.mkv", "eq(mod(n,7),0)+eq(mod(n,7),2)+eq(mod(n,7),3)")):
            self.write_raw(name, frames, "gray", "-vf", f"select='{kept}'", "-fps_mode", "vfr", rate=100)
            for method in ("blend", "flow"):
                light, said = self.emulate(name, "--transfer", "linear", "--resample", method, "--set",
                                           "sensor.slot_us=5000")
                self.assertEqual(said, "")
                edges[name, method] = np.array([np.interp(-0.5, -row, np.arange(200)) for row in light[:, 16]])[12:90]
        for (name, method), columns in edges.items():
            with self.subTest(name=name, method=method):
                speed = np.polyfit(np.arange(78), columns, 1)
                self.assertAlmostEqual(speed[0], 1, delta=0.02)
                # Blending holds a frame of up to 4 hundredths of a second, in which the edge moves by 8 columns.
                self.assertLess(np.abs(columns - np.polyval(speed, np.arange(78))).max(),
                                0.5 if method == "flow" else 4.5)

    def test_frame_rates_of_the_command_line_make_frames_equally_long(self):
        self.write_bar("a.mkv", "not(mod(n,4))+gt(n,30)")
        light, said = self.emulate("a.mkv", "--transfer", "linear", "--resample", "hold", "--frames-hz", 100, "--set",
                                   "sensor.slot_us=10000")
        self.assertEqual(len(light), 8 + 29)
        self.assertEqual(said, "stipple: warning: a.mkv: its frames are 0.01 to 0.04 s apart, but --frames-hz makes "
                         "them equally long\n")

    def test_a_frame_far_behind_is_refused(self):
        """An hour of one frame among milliseconds would be millions of slots."""
        self.write_bar("a.mkv", "1", "-vf", "setpts='if(gt(N,30),N+3600000,N)*0.001/TB'")
        self.fails(INPUT, ["a.mkv: has a frame ", "frame periods after the one before", "--frames-hz"], "emulate", "a.mkv",
                   "-o", "x.stipple", "--transfer", "linear", "--resample", "blend")

    def test_a_damaged_frame_is_refused_by_its_number(self):
        self.write_moving("video.mkv", "-c:v", "libx264", "-g", "10")
        video = bytearray((self.folder / "video.mkv").read_bytes())
        for at in range(len(video) // 2, len(video) // 2 + 40):
            video[at] ^= 0xFF
        (self.folder / "video.mkv").write_bytes(video)
        self.refuse("video.mkv", ": frame ", "damaged")

    def test_errors_that_the_decoder_only_logs_are_counted(self):
        self.write_moving("video.mkv", "-c:v", "ffv1", "-slicecrc", "1")
        video = bytearray((self.folder / "video.mkv").read_bytes())
        video[len(video) // 2] ^= 0xFF
        (self.folder / "video.mkv").write_bytes(video)
        light, said = self.emulate("video.mkv", "--transfer", "srgb")
        self.assertEqual(len(light), 30)
        self.assertRegex(said, r"video.mkv: the decoder reports \d+ errors?, the first at frame \d+")

    def test_gif(self):
        self.write_moving("video.gif", seconds=0.2)
        light, said = self.emulate("video.gif")
        np.testing.assert_array_equal(light, np.float32(self.shown("video.gif", light.shape)) / np.float32(255))
        self.assertIn(HINT, said)

    def test_frames_that_the_container_announces(self):
        self.write_moving("video.mp4", seconds=0.2)
        self.assertEqual(self.figures("info", "video.mp4", "--header")["announced_frames"], 6)
        self.assertIn("6 announced", self.succeed("info", "video.mp4", "--header"))
        self.write_moving("video.mkv", seconds=0.2)  # a container that tells no number
        self.assertIsNone(self.figures("info", "video.mkv", "--header")["announced_frames"])
        self.assertIn("number is not announced", self.succeed("info", "video.mkv", "--header"))

    def test_images_that_are_not_read_have_the_command_that_converts_them(self):
        (self.folder / "frames").mkdir()
        self.write_moving("frames/%04d.jpg", seconds=0.2)
        for footage in ("frames", "frames/%04d.jpg", "frames/0001.jpg"):
            self.refuse(footage, ".jpg is not read, convert it: ffmpeg -i %04d.jpg %04d.png")
        (self.folder / "frames/0001.jpg").rename(self.folder / "one.JPEG")
        self.refuse("one.JPEG", ".jpeg is not read, convert it: ffmpeg -i %04d.jpeg %04d.png")

    def test_truth_for_viewing_is_no_reference(self):
        self.write_flat("light.npy", slots=2, rows=16, cols=16)
        for name, warned in (("a.mp4", True), ("a.y4m", True), ("a.npy", False)):
            said = self.run_program("emulate", "light.npy", "-o", "clip.stipple", "--force", "--truth", name).stderr
            self.assertEqual("tone-mapped to 8 bits" in said, warned)

    def test_pixels_that_are_no_such_numbers_are_refused(self):
        self.write_flat_colour("flat.mkv", 48, "ycgco", "out_color_matrix=bt709", "yuv444p", "-c:v",
                               "ffv1")
        self.refuse("flat.mkv", 'the matrix "ycgco"', "BT.709")

    def test_coded_video_is_hinted_at_and_linear_video_is_not(self):
        self.write_moving("video.mp4", "-c:v", "libx264", seconds=0.2)
        for options, hinted in (([], True), (["--transfer", "linear"], False),
                                (["--transfer", "srgb"], False)):
            _, said = self.emulate("video.mp4", *options)
            self.assertEqual(HINT in said, hinted, options)
        grey = np.full((1, 8, 8), 99 * 257, "<u2")
        self.assertEqual(self.emulate(self.write_raw("deep.mkv", grey, "gray16le"))[1], "")
        declared = self.write_raw("video.mkv", (grey // 257).astype(np.uint8), "gray", "-color_trc", "linear")
        self.assertEqual(self.emulate(declared)[1], "")
        _, said = self.emulate(self.write_raw("hdr.mkv", grey, "gray16le", "-color_trc", "smpte2084"))
        self.assertIn("hdr.mkv: is HDR in the curve smpte2084", said)


if __name__ == "__main__":
    unittest.main()
