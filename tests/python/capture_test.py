"""Cameras in Python: recordings and streams are those of the program, and waiting can be ended."""

import os
import signal
import subprocess
import threading
import unittest
import warnings

import numpy as np
import stipple
from program import ProgramTest

FAST = {"AcquisitionFrameRate": 0}  # as fast as they are taken; nothing is lost with 1024 buffers


class CameraTest(ProgramTest):
    count = 0

    def write_dn(self, slots=24, dtype=np.uint16, shape=(12, 16)):
        """Footage whose DN a replay as Mono16 (Mono8) sends as they are."""
        most = np.iinfo(dtype).max
        dn = np.random.default_rng(3).integers(0, most, (slots, *shape), dtype=dtype, endpoint=True)
        self.write_array("dn.npy", dn, dtype)
        return dn

    def replay(self, name="dn.npy"):
        return f"replay:{self.folder / name}"

    def serve(self, *arguments):
        """Starts the emulated camera and waits for its READY line; its address."""
        if "built without" in self.run_program("capture", "list").stdout:
            self.skipTest("built without Aravis")
        CameraTest.count += 1
        ip = f"127.{60 + CameraTest.count}.{os.getpid() >> 8 & 255}.{os.getpid() & 255 or 1}"
        server = self.start_program("capture", "serve", *arguments, "--address", ip, stdout=subprocess.PIPE)
        self.addCleanup(server.communicate)
        self.addCleanup(server.kill)
        watchdog = threading.Timer(60, server.kill)
        watchdog.start()
        self.assertIn("READY", server.stdout.readline())
        watchdog.cancel()
        return f"gige:{ip}"

    def interrupt_after(self, frames):
        """A `progress` that has Ctrl-C pressed once so many have come."""
        def tell(done, total):
            if done >= frames:
                os.kill(os.getpid(), signal.SIGINT)
        return tell


class RecordTest(CameraTest):
    def record(self, output="clip.strec", settings={}, **options):
        return stipple.capture.record(self.replay(), self.folder / output, settings=FAST | settings, buffers=1024,
                                      **options)

    def test_frames_and_figures_are_those_of_the_program(self):
        dn = self.write_dn()
        recording = self.record(settings={"PixelFormat": "Mono16"})
        np.testing.assert_array_equal([frame.dn for frame in recording], dn)
        told = self.figures("capture", "record", "replay:dn.npy", "-o", "program.strec", "--set",
                            "camera.AcquisitionFrameRate=0", "--set", "camera.PixelFormat=Mono16", "--buffers", 1024)
        self.assertEqual(list(recording.figures), list(told))
        measured = {"file", "seconds", "frames_hz"}
        self.assertEqual({key: value for key, value in recording.figures.items() if key not in measured},
                         {key: value for key, value in told.items() if key not in measured})
        program = stipple.Recording.open(self.folder / "program.strec")
        self.assertIsNone(program.figures)
        self.assertEqual([frame.payload.tobytes() for frame in program],
                         [frame.payload.tobytes() for frame in recording])
        self.assertEqual(recording.features, program.features)

    def test_a_recording_has_no_name_of_another_kind_of_file(self):
        self.write_dn()
        with self.assertRaisesRegex(ValueError, "clip.mp4: a recording is a .strec, or has a name without extension"):
            self.record("clip.mp4")

    def test_settings_of_a_file_come_before_those_of_the_call(self):
        self.write_dn()
        (self.folder / "camera.toml").write_text('PixelFormat = "Mono8"\nAcquisitionFrameRate = 100\n')
        recording = self.record(config=self.folder / "camera.toml", frames=3)
        self.assertEqual([frame.format for frame in recording], ["Mono8"] * 3)
        self.assertEqual(recording.figures["frames"], 3)

    def test_progress_ends_a_recording(self):
        self.write_dn()
        loop = {"Loop": 1, "AcquisitionFrameRate": 200}
        recording = self.record(settings=loop, progress=lambda done, total: done < 5)
        self.assertGreaterEqual(recording.figures["frames"], 5)
        self.assertEqual(len(list(recording)), recording.figures["frames"])

    def test_what_progress_raises_and_ctrl_c_leave_a_recording(self):
        self.write_dn()

        def stop(done, total):
            if done > 0:
                raise ZeroDivisionError

        loop = {"Loop": 1, "AcquisitionFrameRate": 200}
        for error, tell in ((ZeroDivisionError, stop), (KeyboardInterrupt, self.interrupt_after(3))):
            with self.subTest(error), self.assertRaises(error):
                self.record(settings=loop, progress=tell, force=True)
            self.assertGreater(len(list(stipple.Recording.open(self.folder / "clip.strec"))), 0)
            self.assertEqual(self.names(), ["clip.strec", "dn.npy"])

    def test_other_threads_run_meanwhile(self):
        self.write_dn()
        ticks = threading.Event()
        thread = threading.Timer(0, ticks.set)
        recording = self.record(settings={"Loop": 1, "AcquisitionFrameRate": 200},
                                progress=lambda done, total: thread.start() if thread.ident is None
                                else not ticks.is_set())
        self.assertTrue(ticks.is_set())
        self.assertGreater(recording.figures["frames"], 0)

    def test_a_camera_is_recorded(self):
        self.write_array("light.npy", np.random.default_rng(1).random((20, 48, 64)))
        address = self.serve("light.npy", "--repeat", "--format", "Mono16", "--frames-hz", 100)
        recording = stipple.capture.record(address, self.folder / "clip.strec", frames=10)
        frames = list(recording)
        self.assertEqual(len(frames), 10)
        self.assertEqual(recording.camera["transport"], "GigE Vision")
        for before, frame in zip(frames, frames[1:]):
            self.assertEqual(frame.id, before.id + 1 + frame.lost_before)

    def test_a_coded_stream_is_the_bytes_of_emulate(self):
        self.write_array("light.npy", np.random.default_rng(1).random((20, 48, 64)))
        self.succeed("emulate", "light.npy", "-o", "emulated.stipple", "--schedule", "tiled")
        address = self.serve("light.npy", "--mode", "coded", "--schedule", "tiled")
        told = []
        stream = stipple.capture.record_coded(address, self.folder / "clip.stipple",
                                              progress=lambda *now: told.append(now))
        self.assertEqual(stream.figures, {"slots": 20, "missing_slots": 0, "damaged_frames": 0})
        self.assertEqual(told[-1], (20, 20))
        self.assertEqual((self.folder / "clip.stipple").read_bytes(), (self.folder / "emulated.stipple").read_bytes())
        with self.assertRaisesRegex(ValueError, "coded=True"):
            stipple.capture.record(address, self.folder / "x.strec", frames=1)

    def test_errors_have_the_texts_of_the_program(self):
        self.write_dn()
        (self.folder / "there.strec").touch()
        (self.folder / "empty.npy").touch()
        for error, source, arguments, options in (
                (ValueError, "none:1", {}, []),
                (FileNotFoundError, "replay:none.strec", {}, []),
                (ValueError, "replay:empty.npy", {}, []),
                (ValueError, "replay:dn.npy", {"settings": {"Wdth": 4}}, ["--set", "camera.Wdth=4"]),
                (FileExistsError, "replay:dn.npy", {"output": "there.strec"}, ["-o", "there.strec"]),
                (FileNotFoundError, "replay:dn.npy", {"output": "none/x.strec"}, ["-o", "none/x.strec"])):
            output = arguments.pop("output", "x.strec")
            options = options if "-o" in options else [*options, "-o", output]
            done = self.run_program("capture", "record", source, *options)
            self.assertNotEqual(done.returncode, 0)
            text = (done.stderr.splitlines()[-1].removeprefix("stipple: error: ").replace("--set camera.", "camera setting ")
                    .replace("--force", "force=True"))
            with self.subTest(source, **arguments), self.assertRaises(error) as raised:
                where = os.getcwd()
                os.chdir(self.folder)
                try:
                    stipple.capture.record(source, output, **arguments)
                finally:
                    os.chdir(where)
            self.assertEqual(str(raised.exception), text)
        for message, arguments in (("incomplete: \"x\" is none of", {"incomplete": "x"}),
                                   ("frames: 0 is not above 0", {"frames": 0}),
                                   ("seconds: -1", {"seconds": -1.0}),
                                   ("stall_ms: -1 is outside", {"stall_ms": -1})):
            with self.assertRaisesRegex(ValueError, message):
                self.record(**arguments)
        with self.assertRaisesRegex(ValueError, "buffers: 1 is outside 2..1024"):
            stipple.capture.record(self.replay(), self.folder / "x.strec", buffers=1)

    def test_a_camera_that_is_gone_is_an_OSError_and_leaves_a_recording(self):
        self.write_array("light.npy", np.random.default_rng(1).random((20, 48, 64)))
        address = self.serve("light.npy", "--frames-hz", 200)  # it ends
        with self.assertRaisesRegex(OSError, f"{address}: camera lost: "):
            stipple.capture.record(address, self.folder / "clip.strec", reconnect=False, stall_ms=200)
        self.assertGreater(len(list(stipple.Recording.open(self.folder / "clip.strec"))), 0)


class LiveSourceTest(CameraTest):
    def live(self, *arguments, settings={}, **options):
        return stipple.capture.live(self.replay(), *arguments, settings=FAST | {"PixelFormat": "Mono16"} | settings,
                                    buffers=1024, queue=1024, **options)


class LiveTest(LiveSourceTest):
    def test_the_stream_is_that_of_the_program(self):
        self.write_dn()
        told = self.figures("capture", "live", "replay:dn.npy", "-o", "program.stipple", "--set",
                            "camera.AcquisitionFrameRate=0", "--set", "camera.PixelFormat=Mono16", "--buffers", 1024,
                            "--queue", 1024, "--schedule", "tiled", "--seed", 5, "--black-level", 64, "--sensor",
                            "lux1310", "--set", "sensor.read_noise_e=3")
        wanted = (self.folder / "program.stipple").read_bytes()
        sensor = stipple.Sensor("lux1310", {"read_noise_e": 3})
        with self.assertWarnsRegex(UserWarning, "sends 200 frames/s, but .*2000 a second"):
            stream = self.live(sensor, "tiled", 5, black_level_dn=64, output=self.folder / "python.stipple")
        self.assertEqual((self.folder / "python.stipple").read_bytes(), wanted)
        self.assertEqual(set(stream.figures), set(told) - {"warnings"})
        for key in ("slots", "samples", "payload_bits", "frames", "slots_hz", "incomplete", "lost", "transport",
                    "held_slots", "unheld_slots", "readout", "light_read", "compression_ratio"):
            self.assertEqual(stream.figures[key], told[key], key)
        self.assertEqual(set(stream.figures["latency_us"]), {"median", "p99", "max"})

    def test_without_output_it_lies_in_a_temporary_file(self):
        self.write_dn()
        schedule = stipple.Schedule("tiled", size=(12, 16))
        stream = self.live("paper", schedule, frames=20)
        self.assertIsNone(stream.path)
        self.assertEqual((stream.slots(), stream.shape), (20, (12, 16, 1)))
        self.assertEqual(stipple.decode(stream, "naive").shape, (20, 12, 16))
        self.assertEqual(self.names(), ["dn.npy"])

    def test_ctrl_c_leaves_a_stream_and_progress_may_end_it(self):
        self.write_dn()
        loop = {"Loop": 1, "AcquisitionFrameRate": 200}
        path = self.folder / "clip.stipple"
        with self.assertRaises(KeyboardInterrupt):
            self.live(settings=loop, output=path, progress=self.interrupt_after(3))
        self.assertGreaterEqual(stipple.Stream.open(path).slots(), 3)
        self.assertTrue(stipple.Stream.open(path).counts()["complete"])
        stream = self.live(settings=loop, progress=lambda done, total: done < 3)
        self.assertGreaterEqual(stream.slots(), 3)

    def test_another_rate_than_that_of_slots_is_a_warning(self):
        self.write_dn()
        with self.assertWarnsRegex(UserWarning, "sends 160 frames/s.*camera setting AcquisitionFrameRate=200"):
            self.live(settings={"AcquisitionFrameRate": 160})
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.live(stipple.Sensor("paper", {"slot_us": 6250}), settings={"AcquisitionFrameRate": 160})

    def test_refuses_what_the_program_refuses(self):
        self.write_dn()
        for message, arguments in {"black_level|black level": {"black_level_dn": 70000},
                                   'did you mean "paper"': {"sensor": "papr"},
                                   "queue: 0 is outside": {"queue": 0},
                                   "late_after: 0 is not above 0": {"late_after": 0},
                                   "is none of stretch, drop": {"overrun": "bend"}}.items():
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                stipple.capture.live(self.replay(), **arguments)
        (self.folder / "clip.stipple").touch()
        with self.assertRaises(FileExistsError):
            self.live(output=self.folder / "clip.stipple")


class PreviewTest(LiveSourceTest):
    """Frames are waited for as long as it takes: the preview has idle priority."""

    LOOP = {"Loop": 1, "AcquisitionFrameRate": 200}

    def live_until_shown(self, count, *arguments, **options):
        shown = []
        stream = self.live(*arguments, settings=self.LOOP, preview=shown.append,
                           progress=lambda done, total: len(shown) < count, **options)
        return stream, shown

    def test_frames_are_the_light_of_a_still_scene(self):
        dn = self.write_dn(slots=1)[0]
        self.write_array("dn.npy", np.repeat(dn[None], 24, axis=0), np.uint16)
        _, shown = self.live_until_shown(2, "ideal", "tiled")
        for frame in shown:
            # Half a DN of 1/4 electron, and half of the DN of the camera; light 1.0 is 1000 electrons.
            np.testing.assert_allclose(frame.light, dn / 65535, atol=2e-4)
            self.assertEqual((frame.light.dtype, frame.saturated.dtype), (np.float32, bool))
        self.assertLess(shown[0].slot, shown[1].slot)

    def test_figures_are_those_of_the_program(self):
        self.write_dn()
        told = self.figures("capture", "live", "replay:dn.npy", "-o", "program.stipple", "--set",
                            "camera.AcquisitionFrameRate=0", "--buffers", 1024, "--queue", 1024, "--preview", "p.npy")
        stream = self.live(preview=lambda frame: None)
        self.assertEqual(["file", *stream.figures["preview"]], list(told["preview"]))
        for key in ("width", "height", "slots"):
            self.assertEqual(stream.figures["preview"][key], told["preview"][key])
        self.assertNotIn("preview", self.live().figures)

    def test_a_short_source_shows_its_first_frame(self):
        self.write_dn(slots=16)
        shown = []
        stream = self.live(preview=shown.append)
        self.assertGreater(len(shown), 0)
        self.assertEqual(stream.figures["preview"]["made"], len(shown))

    def test_colour_parts_of_the_frame_and_saturated_pixels(self):
        dn = np.zeros((24, 20, 24, 3), np.uint16)
        dn[:, 5, 6, 1] = 65535
        self.write_array("dn.npy", dn, np.uint16)
        shown = []
        self.live(stipple.Sensor("paper", {"full_scale_e": 500}), "full1x", settings={"PixelFormat": "RGB8"},
                  preview=shown.append, preview_size=(10, 12))
        self.assertEqual(shown[0].light.shape, (10, 12, 3))
        self.assertEqual(np.argwhere(shown[0].saturated).tolist(), [[0, 0]])  # the middle begins at (5, 6)
        self.assertEqual(shown[0].light[..., 1].argmax(), 0)

    def test_what_it_raises_and_ctrl_c_end_the_call_and_leave_a_stream(self):
        self.write_dn()

        def fail(frame):
            raise ZeroDivisionError

        path = self.folder / "clip.stipple"
        for error, show in ((ZeroDivisionError, fail),
                            (KeyboardInterrupt, lambda frame: os.kill(os.getpid(), signal.SIGINT))):
            with self.subTest(error), self.assertRaises(error):
                self.live(settings=self.LOOP, output=path, force=True, preview=show)
            self.assertGreaterEqual(stipple.Stream.open(path).slots(), 12)
            self.assertTrue(stipple.Stream.open(path).counts()["complete"])

    def test_refuses_what_is_no_preview(self):
        self.write_dn()
        with self.assertRaisesRegex(TypeError, "preview: give a function"):
            self.live(preview=5)
        for message, arguments in {'preview_method: "best" is none of naive, live, fast': {"preview_method": "best"},
                                   r"preview_size: \(4, 8\) is outside 8..65535": {"preview_size": (4, 8)}}.items():
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                self.live(preview=print, **arguments)


class SearchTest(CameraTest):
    def test_a_served_camera_is_found_and_described(self):
        self.write_array("light.npy", np.random.default_rng(1).random((20, 48, 64)))
        address = self.serve("light.npy", "--repeat", "--format", "Mono16")
        told = self.figures("capture", "features", address)["features"]
        found = stipple.capture.features(address)
        self.assertEqual([feature.name for feature in found], [feature["name"] for feature in told])
        for feature, wanted in zip(found, told):
            if feature.name == "Width":
                self.assertEqual(feature._asdict() | {"choices": []}, wanted)
        self.assertEqual([f.value for f in stipple.capture.features(address, "pixelf*")], ["Mono16"])
        unbounded, = (feature for feature in found if feature.name == "GevTimestampTickFrequency")
        self.assertEqual((unbounded.minimum, unbounded.maximum), ("0", None))
        self.assertRegex(self.succeed("capture", "features", address, unbounded.name), r" 0\.\.\n$")
        with self.assertRaisesRegex(ValueError, '"nothing": matches none of the'):
            stipple.capture.features(address, "nothing")

    def test_the_list_is_that_of_the_program(self):
        self.write_array("light.npy", np.random.default_rng(1).random((20, 48, 64)))
        address = self.serve("light.npy", "--repeat")
        told = self.figures("capture", "list")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            found = stipple.capture.list()
        self.assertEqual([str(warning.message) for warning in caught], told["problems"])
        mine = [camera._asdict() for camera in found if camera.address == address]  # others may come and go
        self.assertEqual(mine, [camera for camera in told["cameras"] if camera["address"] == address])
        self.assertEqual(len(mine), 1)

    def test_what_has_no_features_is_named(self):
        for address, message in (("replay:a.npy", "replay:a.npy: has no features"),
                                 ("none:1", "is not the address of a camera")):
            with self.assertRaisesRegex(ValueError, message):
                stipple.capture.features(address)


class FramesTest(CameraTest):
    def frames(self, **settings):
        return stipple.capture.frames(self.replay(), settings=FAST | settings, buffers=1024, queue=1024)

    def test_they_are_those_that_were_sent(self):
        for dtype, name in ((np.uint16, "Mono16"), (np.uint8, "Mono8")):
            dn = self.write_dn(dtype=dtype)
            with self.frames(PixelFormat=name) as camera:
                frames = list(camera)
            self.assertEqual([frame.id for frame in frames], list(range(len(dn))))
            np.testing.assert_array_equal([frame.dn for frame in frames], dn)
            self.assertEqual(list(camera), [])  # it is at its end

    def test_words_are_not_copied_and_outlive_the_camera(self):
        dn = self.write_dn(shape=(12, 16, 3))
        with self.frames(PixelFormat="BayerRG16") as camera:
            frame = next(camera)
        self.assertTrue(np.shares_memory(frame.dn, frame.payload))
        self.assertFalse(frame.dn.flags.writeable)
        values = frame.dn
        del frame, camera
        self.assertEqual(values[0, 0], dn[0, 0, 0, 0])  # red
        self.assertEqual(values[1, 1], dn[0, 1, 1, 2])  # blue

    def test_ctrl_c_ends_a_wait(self):
        """For a camera that sends a frame in a quarter of an hour."""
        self.write_dn()
        with self.frames(AcquisitionFrameRate=0.001, Loop=1) as camera:
            next(camera)
            threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
            with self.assertRaises(KeyboardInterrupt):
                next(camera)


if __name__ == "__main__":
    unittest.main()
