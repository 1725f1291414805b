"""A camera through the sensor as it runs: what is shown meanwhile, rates, colour filters."""

import json
import os
import resource
import signal
import struct
import time
import unittest

import numpy as np
from program import DEVICE, INPUT, STOPPED, USAGE, ProgramTest
from sample_stream import samples

FAST = ("--set", "camera.AcquisitionFrameRate=0", "--buffers", "1024")
WINDOW = 16  # slots of a preview: twice the longest exposure of the schedule `random`
CAPTION = 20  # rows of text above a .png
PREVIEW_OF_FAST = ("--method", "fast", "--set", "decoder.rounds=1", "--set", "decoder.last_iterations=10")


def moving_light(slots, rows=24, cols=32):
    """A smooth image that moves by a pixel a slot, up to 0.9."""
    y, x = np.mgrid[:rows, :cols]
    return np.stack([0.5 + 0.4 * np.sin((x - slot) / 4) * np.cos(y / 5) for slot in range(slots)])


def until(condition, process):
    """Waits for it; the time limit only ends a test that hangs."""
    deadline = time.monotonic() + 100
    while not condition() and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.01)
    return condition()


class LiveTest(ProgramTest):
    def live(self, source, *arguments):
        return self.figures("capture", "live", "replay:" + source, "-o", "clip.stipple", "--force",
                            *arguments)

    def start_loop(self, *arguments):
        """A recording that goes on until somebody stops it."""
        self.write_array("light.npy", moving_light(40))
        program = self.start_program("capture", "live", "replay:light.npy", "-o", "clip.stipple",
                                     "-q", "--set", "camera.Loop=1", "--json", "figures.json", *arguments)
        self.addCleanup(program.communicate)
        self.addCleanup(program.kill)
        return program

    def stop(self, program):
        """Figures of its preview, and what it said on standard error."""
        program.send_signal(signal.SIGINT)
        errors = program.communicate(timeout=100)[1]
        self.assertEqual(program.returncode, STOPPED, errors)
        figures = json.loads((self.folder / "figures.json").read_text())
        self.assertEqual(self.figures("info", "clip.stipple")["slots"], figures["slots"])
        return figures["preview"], errors


class PreviewTest(LiveTest):
    def test_it_is_the_frame_that_decode_makes_of_these_slots(self):
        for method, decode, slots, shown in (("fast", PREVIEW_OF_FAST, WINDOW, WINDOW // 2),
                                             ("naive", ("--method", "naive"), WINDOW, WINDOW // 2),
                                             ("live", ("--method", "live"), 24, 15)):
            self.write_array("light.npy", moving_light(slots))
            preview = self.live("light.npy", *FAST, "--preview", "now.npy", "--preview-method",
                                method)["preview"]
            self.assertEqual((preview["made"], preview["slots"], preview["last_slot"]),
                             (1, slots, shown))
            self.succeed("decode", "clip.stipple", "-o", "all.npy", "--force", *decode)
            np.testing.assert_array_equal(self.array("now.npy")[0],
                                          self.array("all.npy")[shown])

    def test_of_fewer_slots_than_a_window_there_is_one(self):
        self.write_array("light.npy", moving_light(9))
        preview = self.live("light.npy", *FAST, "--preview", "now.npy")["preview"]
        self.assertEqual((preview["made"], preview["skipped_slots"]), (1, 0))
        self.assertAlmostEqual(self.array("now.npy").mean(), 0.5, delta=0.1)

    def test_the_middle_alone_is_the_middle_of_the_whole(self):
        self.write_array("light.npy", moving_light(WINDOW))
        preview = self.live("light.npy", *FAST, "--preview", "now.npy", "--preview-method", "naive",
                            "--preview-size", "12x999")["preview"]
        self.assertEqual((preview["width"], preview["height"]), (12, 24))
        self.succeed("decode", "clip.stipple", "-o", "all.npy", "--method", "naive")
        np.testing.assert_array_equal(self.array("now.npy")[0],
                                      self.array("all.npy")[WINDOW // 2][:, 10:22])

    def test_it_does_not_change_the_stream(self):
        self.write_array("light.npy", moving_light(60))
        self.live("light.npy", *FAST, "--preview", "now.npy", "--preview-method", "naive")
        clip = self.folder / "clip.stipple"
        with_preview = clip.read_bytes()
        self.live("light.npy", *FAST)
        self.assertEqual(clip.read_bytes(), with_preview)

    def test_a_replay_of_footage_is_no_emulation_of_it(self):
        """The replay quantises light to Mono16, so `emulate` makes other bytes: the header says so."""
        self.write_array("light.npy", moving_light(12))
        self.live("light.npy", *FAST)
        info = self.figures("info", "clip.stipple")
        self.assertIn('pixel_format = "Mono16"', info["provenance"].replace("'", '"'))
        self.assertIsNone(info["command"])
        self.succeed("capture", "record", "replay:light.npy", "-o", "light.strec", *FAST)
        self.live("light.strec", *FAST)
        self.assertEqual(self.figures("info", "clip.stipple")["command"],
                         "stipple emulate light.strec -o again.stipple")

    def test_the_image_is_replaced_while_the_recording_goes_on(self):
        program = self.start_loop("--preview", "now.png", "--preview-method", "naive")
        image = self.folder / "now.png"
        self.assertTrue(until(image.exists, program), "no image came")
        first = image.read_bytes()
        self.assertEqual(struct.unpack_from(">II", first, 16), (32, 24 + CAPTION))
        self.assertTrue(until(lambda: image.read_bytes() != first, program), "no other came")
        preview, _ = self.stop(program)
        self.assertGreaterEqual(preview["made"], 2)
        self.assertEqual(preview["failed"], 0)
        self.assertGreaterEqual(preview["delay_ms"]["max"], preview["delay_ms"]["median"])
        self.assertEqual(self.names(), ["clip.stipple", "figures.json", "light.npy", "now.png"])

    def test_saturated_pixels_are_red(self):
        light = np.full((WINDOW, 24, 32), 0.2)
        light[:, :, :8] = 1
        self.write_array("light.npy", light)
        self.live("light.npy", *FAST, "--preview", "now.png", "--set", "sensor.full_scale_e=900")
        self.succeed("emulate", "now.png", "-o", "x.stipple", "--truth", "now.npy")
        red, green, _ = np.moveaxis(self.array("now.npy")[0, CAPTION:], -1, 0)
        np.testing.assert_array_equal(red - green > 0.9, light[0] == 1)

    def test_a_folder_that_goes_is_said_and_ends_nothing(self):
        folder, away = self.folder / "shown", self.folder / "away"
        folder.mkdir()
        program = self.start_loop("--preview", "shown/now.npy", "--preview-method", "naive")
        self.assertTrue(until((folder / "now.npy").exists, program), "no preview came")
        os.rename(folder, away)
        line = program.stderr.readline()
        while "no preview" not in line and line:
            line = program.stderr.readline()
        self.assertIn('no folder "shown"', line)
        self.assertIn("the recording goes on", line)
        folder.mkdir()
        self.assertTrue(until((folder / "now.npy").exists, program), "no preview came again")
        preview, _ = self.stop(program)
        self.assertGreaterEqual(preview["failed"], 1)

    def test_what_cannot_be_is_refused(self):
        self.write_array("light.npy", moving_light(4))
        live = ("capture", "live", "replay:light.npy", "-o", "clip.stipple", "--preview")
        self.fails(USAGE, ["a preview is a .png or a .npy"], *live, "now.jpg")
        self.fails(USAGE, ["--preview-size"], *live, "now.png", "--preview-size", "big")
        for option, value in (("--preview-size", "8x8"), ("--preview-method", "fast")):
            self.fails(USAGE, [option, "add --preview FILE"], *live[:-1], option, value)
        for verb in ("live", "record"):
            for option in (("--stall", 0), ("--no-reconnect",)):
                self.fails(USAGE, [option[0], "a replay has no camera"], "capture", verb,
                           "replay:light.npy", "-o", "x", *option)
        self.fails(INPUT, ["nowhere"], *live, "nowhere/now.png")
        self.fails(USAGE, ["clip.npy is the output of --output too"], *live[:4], "clip.npy", "--preview",
                   "./clip.npy")
        self.fails(USAGE, ["light.npy"], *live, "light.npy")


class FullDiskTest(LiveTest):
    def test_it_leaves_the_slots_before(self):
        self.write_array("light.npy", moving_light(40))
        limit = 9000  # bytes: the header and some slots
        done = self.run_program(
            "capture", "live", "replay:light.npy", "-o", "clip.stipple", "--set", "camera.Loop=1",
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        self.assertEqual(done.returncode, DEVICE, done.stderr)
        for part in ("clip.stipple: cannot be written", "what was written before is kept"):
            self.assertIn(part, done.stderr)
        self.assertEqual(self.names(), ["clip.stipple", "light.npy"])
        self.run_program("decode", "clip.stipple", "-o", "all.npy", "--method", "naive")
        slots = json.loads(self.run_program("info", "clip.stipple", "--json", "-").stdout)["slots"]
        self.assertGreater(slots, 5)
        self.assertEqual(len(self.array("all.npy")), slots)


class RateTest(LiveTest):
    def warning(self, *arguments):
        self.write_array("light.npy", moving_light(20))
        done = self.run_program("capture", "live", "replay:light.npy", "-o", "clip.stipple", "-q",
                                "--force", "--json", "figures.json", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        figures = json.loads((self.folder / "figures.json").read_text())
        return done.stderr, figures["frames_hz"], figures["slots_hz"]

    def test_frames_that_come_at_another_rate_than_slots_are_said(self):
        slow = ("--set", "camera.AcquisitionFrameRate=160", "--buffers", "1024")
        said, frames_hz, slots_hz = self.warning(*slow)
        for part in ("sends 160 frames/s", "5000 us (200 a second)", "--set camera.AcquisitionFrameRate=200",
                     "--set sensor.slot_us=6250"):
            self.assertIn(part, said)
        self.assertAlmostEqual(frames_hz, 160, places=3)
        self.assertEqual(slots_hz, 200)
        self.assertEqual(self.warning(*slow, "--set", "sensor.slot_us=6250")[0], "")


class ColourFilterTest(LiveTest):
    """Of a camera with a colour filter array, into a sensor with one."""

    def setUp(self):
        super().setUp()
        dn = np.random.default_rng(3).integers(0, 65536, (20, 12, 16, 3))
        self.write_array("light.npy", dn / 65535)
        self.succeed("capture", "record", "replay:light.npy", "-o", "bayer.strec", "--set",
                     "camera.PixelFormat=BayerGB16", *FAST)

    def samples(self, name):
        """The packets of a stream; names of files are in its header."""
        return samples((self.folder / name).read_bytes())

    def test_the_sensor_samples_it_as_it_does_colour(self):
        gbrg = ("--sensor", "ideal", "--set", "sensor.cfa=gbrg")
        self.succeed("emulate", "light.npy", "-o", "colour.stipple", *gbrg)
        self.succeed("emulate", "bayer.strec", "-o", "bayer.stipple", *gbrg)
        self.live("bayer.strec", *FAST, "--sensor", "ideal", "--set", "sensor.cfa=gbrg",
                  "--preview", "now.npy", "--preview-method", "naive")
        self.assertEqual(self.samples("bayer.stipple"), self.samples("colour.stipple"))
        self.assertEqual(self.samples("clip.stipple"), self.samples("colour.stipple"))
        self.assertEqual(self.figures("info", "clip.stipple")["cfa"], "gbrg")
        self.assertEqual(self.array("now.npy").shape, (1, 12, 16, 3))

    def test_another_phase_is_refused(self):
        parts = ["begins as rggb, the frames as gbrg", "cfa=gbrg", "OffsetX"]
        self.fails(INPUT, parts, "emulate", "bayer.strec", "-o", "x.stipple", "--sensor", "ideal",
                   "--set", "sensor.cfa=rggb")
        self.fails(INPUT, parts, "capture", "live", "replay:bayer.strec", "-o", "x.stipple",
                   "--sensor", "ideal", "--set", "sensor.cfa=rggb")

    def test_a_sensor_without_filters_takes_it_for_grey_and_says_so(self):
        for command in (("emulate", "bayer.strec"), ("capture", "live", "replay:bayer.strec")):
            done = self.run_program(*command, "-o", "grey.stipple", "--force")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("mosaic of colours (gbrg)", done.stderr)
        self.assertEqual(self.figures("info", "grey.stipple")["cfa"], "none")


if __name__ == "__main__":
    unittest.main()
