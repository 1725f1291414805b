"""`stipple view` of a running camera, which `capture serve` is: its frames, the samples that the chip would make of
them, recordings and features, and a camera that goes away."""

import json
import os
import resource
import socket
import subprocess
import threading
import time
import unittest
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from capture_record_test import records_of
from program import INPUT, USAGE, ProgramTest
from view_test import Viewer, light_of

ROWS, COLS, FRAMES_HZ = 48, 64, 100
FULL_SCALE = 65535


class ServedCamera(ProgramTest):
    """A camera of random light at an address of its own."""
    count = 0

    def setUp(self):
        super().setUp()
        if "built without" in self.run_program("capture", "list").stdout:
            self.skipTest("built without Aravis")
        ServedCamera.count += 1
        number = os.getpid()
        self.ip = f"127.{150 + self.count}.{number >> 8 & 255}.{number & 255 or 1}"
        self.address = f"gige:{self.ip}"
        self.light = np.random.default_rng(1).uniform(0.1, 0.9, (20, ROWS, COLS))
        self.write_array("light.npy", self.light)

    def serve(self, source="light.npy"):
        camera = self.start_program("capture", "serve", source, "--repeat", "--format", "Mono16", "--address", self.ip,
                                    "--frames-hz", FRAMES_HZ, stdout=subprocess.PIPE)
        watchdog = threading.Timer(60, camera.kill)
        watchdog.start()
        self.addCleanup(camera.communicate)
        self.addCleanup(camera.kill)
        self.assertIn("READY", camera.stdout.readline())
        watchdog.cancel()
        return camera

    def until(self, condition):
        deadline = time.monotonic() + 60
        while not (value := condition()):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)
        return value


class ViewCameraTest(ServedCamera):
    def view(self, *options):
        return Viewer(self, self.address, *options)

    def act(self, viewer, what, expected=200, **keys):
        status, _, answer = viewer.ask(f"camera/{what}", method="POST", **keys)
        self.assertEqual(status, expected, answer)
        return answer.decode()

    def test_the_picture_of_a_slot_is_a_frame_of_the_camera(self):
        self.serve()
        viewer = self.view()
        status = self.until(lambda: (now := viewer.json("status", than=30, wait=20000))["slots"] > 30 and now)
        _, codes = viewer.picture(0, status["slots"] - 1)
        distance = [np.abs(light_of(codes) / frame.ravel() - 1).max() for frame in self.light]
        self.assertLess(min(distance), 0.003)  # of a code
        self.assertEqual(viewer.ask(f"plane/v0-{status['slots'] + 1000}")[2], b"")
        slot = status["slots"] - 1
        for row, col in ((0, 0), (31, 17), (ROWS - 1, COLS - 1)):
            [[told, code]] = viewer.json("light", video=0, row=row, col=col, plane=0, first=slot, end=slot + 1)
            self.assertEqual((told, code), (slot, codes.reshape(ROWS, COLS)[row, col]))

    def test_samples_are_those_of_emulate(self):
        """Of a scene that does not move: there each frame of the camera is that of the footage."""
        light = (np.round(self.light[0] * FULL_SCALE) / FULL_SCALE).astype(np.float32)
        self.write_array("still.npy", np.broadcast_to(light, (120, ROWS, COLS)))
        self.succeed("emulate", "still.npy", "-o", "clip.stipple", "--schedule", "tiled")
        clip = Viewer(self, "clip.stipple")
        self.serve("still.npy")
        viewer = self.view("--schedule", "tiled")
        self.until(lambda: viewer.json("status")["slots"] > 60)
        for slot in (20, 45):
            of_clip, of_camera = ([np.frombuffer(of.ask(f"plane/r0{part}-{slot}")[2], "<u2") for part in "kd"]
                                  for of in (clip, viewer))
            np.testing.assert_array_equal(of_camera[0], of_clip[0])
            self.assertLess(np.mean(of_camera[1] != of_clip[1]), 0.001)  # the light may differ by its last bit

    def test_the_decoded_picture_is_near_the_light(self):
        self.write_array("still.npy", np.broadcast_to(self.light[:1], self.light.shape))
        self.serve("still.npy")
        viewer = self.view()
        slots = self.until(lambda: (now := viewer.json("status")["slots"]) > 60 and now)
        fields, codes = viewer.picture(1, slots - 20)
        self.assertIn(fields["Stipple-Method"], ("naive", "live"))
        self.assertLess(np.sqrt(np.mean((light_of(codes) - self.light[0].ravel()) ** 2)), 0.06)

    def test_a_recording_has_every_frame_from_its_begin_to_its_end(self):
        self.serve()
        (self.folder / "clips").mkdir()
        viewer = self.view("--recordings", "clips")
        self.until(lambda: viewer.json("camera")["frames"] > 20)
        self.act(viewer, "record")
        self.assertIn("is being recorded", self.act(viewer, "record", 400))
        self.until(lambda: viewer.json("camera")["recording"]["frames"] > 50)
        self.act(viewer, "stop")
        self.assertIn("is not being recorded", self.act(viewer, "stop", 400))
        self.until(lambda: any(".strec" in event["text"] for event in viewer.json("camera")["events"]))
        [file] = (self.folder / "clips").glob("*.strec")
        records = records_of(file)
        self.assertGreater(len(records), 50)
        self.assertEqual(records[0]["id"], 0)
        self.assertEqual(records[0]["lost_before"], 0)
        for before, record in zip(records, records[1:]):
            self.assertEqual(record["id"], before["id"] + 1 + record["lost_before"])
        known = self.figures("info", file)
        self.assertEqual(known["frames"], len(records))

    def test_ten_pages_and_one_that_stands_still_do_not_hold_a_recording_up(self):
        self.serve()
        viewer = self.view()
        stalled = socket.create_connection(("127.0.0.1", viewer.port))
        self.addCleanup(stalled.close)
        stalled.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        request = f"GET {viewer.path}?x HTTP/1.1\r\nHost: 127.0.0.1:{viewer.port}\r\n\r\n".encode()
        stalled.sendall(request * 10)  # and never reads
        self.act(viewer, "record")

        def look(number):
            shown = 0
            for _ in range(20):
                slots = viewer.json("status")["slots"]
                for video in (0, 1):
                    shown += viewer.picture(video, slots - 1, viewer=number, wait=2000)[1].size > 0
            return shown
        with ThreadPoolExecutor(10) as pages:
            self.assertTrue(all(shown > 0 for shown in pages.map(look, range(10))))
        self.act(viewer, "stop")
        self.until(lambda: any(".strec" in event["text"] for event in viewer.json("camera")["events"]))
        self.assertEqual(viewer.json("camera")["lost"]["queue_drop"], 0)
        [file] = self.folder.glob("*.strec")
        self.assertEqual(self.figures("info", file)["frames"], len(records_of(file)))

    def test_a_full_disk_ends_a_recording_and_says_so(self):
        self.serve()
        limit = (300_000, 300_000)  # of a file, in bytes: some 50 frames
        program = self.start_program("view", self.address, stdout=subprocess.PIPE,
                                     preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, limit))
        self.addCleanup(program.communicate)
        self.addCleanup(program.terminate)
        viewer = Viewer.of(program.stdout.readline().strip())
        self.act(viewer, "record")
        told = self.until(lambda: [event["text"] for event in viewer.json("camera")["events"] if ".strec" in event["text"]])
        self.assertIn("File too large", told[-1])
        self.assertIsNone(viewer.json("camera")["recording"])
        frames = viewer.json("camera")["frames"]
        self.until(lambda: viewer.json("camera")["frames"] > frames)
        [file] = self.folder.glob("*.strec*")
        self.assertIn(file.name, told[-1])
        self.assertGreater(len(records_of(file)), 10)

    def test_a_recording_under_way_is_kept_at_the_end(self):
        self.serve()
        viewer = self.view()
        self.act(viewer, "record")
        self.until(lambda: viewer.json("camera")["recording"]["frames"] > 5)
        viewer.program.terminate()
        self.assertEqual(viewer.program.wait(timeout=30), 143)
        [file] = self.folder.glob("*.strec")
        self.assertGreater(len(records_of(file)), 5)

    def test_features_are_set_within_their_ranges(self):
        self.serve()
        viewer = self.view()
        features = {feature["name"]: feature for feature in viewer.json("camera/features")}
        heartbeat = features["GevHeartbeatTimeout"]
        self.assertEqual(heartbeat["access"], "rw")
        value = int(heartbeat["minimum"]) + 100
        self.act(viewer, "set", feature="GevHeartbeatTimeout", value=value)
        again = {feature["name"]: feature for feature in viewer.json("camera/features")}
        self.assertEqual(int(again["GevHeartbeatTimeout"]["value"]), value)
        self.act(viewer, "set", 400, feature="GevHeartbeatTimeout", value=int(heartbeat["maximum"]) + 1)
        self.assertIn("NoSuchFeature", self.act(viewer, "set", 400, feature="NoSuchFeature", value=1))
        frames = viewer.json("camera")["frames"]
        self.until(lambda: viewer.json("camera")["frames"] > frames)

    def test_a_feature_that_is_locked_while_frames_come_opens_the_camera_anew(self):
        self.serve()
        viewer = self.view()
        region = {feature["name"]: feature for feature in viewer.json("camera/features")}["Height"]
        self.assertTrue(region["locked"])
        self.assertEqual(json.loads(self.act(viewer, "set", feature="Height", value=ROWS // 2, stopped=1)), {"reload": True})
        self.assertIn(f'"rows":{ROWS // 2}', viewer.ask()[2].decode())
        self.until(lambda: viewer.json("status")["slots"] > 5)
        self.assertEqual(viewer.picture(0, viewer.json("status")["slots"] - 1)[1].size, ROWS // 2 * COLS)
        self.assertIn("Height", self.act(viewer, "set", 400, feature="Height", value=1000 * ROWS, stopped=1))
        self.until(lambda: viewer.json("status")["slots"] > 5)  # as before
        self.act(viewer, "record")
        self.assertIn("stop first", self.act(viewer, "set", 400, feature="Height", value=ROWS, stopped=1))

    def test_only_the_page_acts(self):
        self.serve()
        viewer = self.view()
        self.assertEqual(viewer.ask("camera/record")[0], 404)  # GET: a picture in a page of others could ask it
        self.assertEqual(viewer.ask("camera/record", {"Origin": "http://" + "elsewhere.example"}, "POST")[0], 403)
        self.assertEqual(viewer.ask_for("/camera/record", method="POST")[0], 403)
        self.assertIsNone(viewer.json("camera")["recording"])
        self.assertEqual(list(self.folder.glob("*.strec")), [])

    def test_a_camera_that_goes_away_is_told(self):
        camera = self.serve()
        viewer = self.view("--set", "camera.GevHeartbeatTimeout=1000")
        self.until(lambda: viewer.json("camera")["frames"] > 5)
        camera.kill()
        self.until(lambda: any("lost" in event["text"] for event in viewer.json("camera")["events"]))
        self.assertGreater(viewer.picture(0, viewer.json("status")["slots"] - 1)[1].size, 0)

    def test_capture_live_shows_the_stream_that_it_writes(self):
        self.serve()
        live = self.start_program("capture", "live", self.address, "-o", "clip.stipple", "--frames", 400, "--view",
                                  stdout=subprocess.PIPE)
        self.addCleanup(live.communicate)
        self.addCleanup(live.kill)
        viewer = Viewer.of(live.stderr.readline().split()[-1])
        self.until(lambda: viewer.json("status")["slots"] > 40)
        kinds, dn = (np.frombuffer(viewer.ask(f"plane/r0{part}-30")[2], "<u2") for part in "kd")
        _, codes = viewer.picture(0, 30)
        self.assertLess(min(np.abs(light_of(codes) / frame.ravel() - 1).max() for frame in self.light), 0.003)
        status = viewer.json("camera")
        self.assertEqual(status["recording"]["file"], "clip.stipple")
        self.assertIn("ends with the program", self.act(viewer, "stop", 400))
        self.assertEqual(live.wait(timeout=60), 0)
        clip = Viewer(self, "clip.stipple")
        for part, shown in (("k", kinds), ("d", dn)):
            np.testing.assert_array_equal(np.frombuffer(clip.ask(f"plane/r0{part}-30")[2], "<u2"), shown)

    def change_sensor(self, viewer, changes):
        """The first slot of the changed sensor."""
        self.act(viewer, "sensor", changes=changes)
        [*_, slot] = viewer.json("status")["switched"]
        self.assertIn(f"from slot {slot} {changes}", [event["text"] for event in viewer.json("camera")["events"]])
        return slot

    def test_the_sensor_of_capture_live_changes_from_the_page(self):
        light = (np.round(self.light[0] * FULL_SCALE) / FULL_SCALE).astype(np.float32)
        self.write_array("still.npy", np.broadcast_to(light, (600, ROWS, COLS)))
        self.serve("still.npy")
        live = self.start_program("capture", "live", self.address, "-o", "clip.stipple", "--frames", 600, "--view",
                                  "--schedule", "tiled", stdout=subprocess.PIPE)
        self.addCleanup(live.communicate)
        self.addCleanup(live.kill)
        viewer = Viewer.of(live.stderr.readline().split()[-1])
        self.until(lambda: viewer.json("status")["slots"] > 40)
        for changes, text in (("", "none of"), ("gain=2", "none of"), ("schedule=no_such", "no_such"),
                              ("sensor.bit_depth=12", "only schedule"), ("schedule=two_bucket", "interleaved")):
            self.assertIn(text, self.act(viewer, "sensor", 400, changes=changes))
        changes = ["schedule=random,seed=3", "sensor.full_scale_e=8000"]
        first = self.change_sensor(viewer, changes[0])
        self.assertEqual(viewer.json("camera")["sensor"], {"schedule": "random", "seed": 3, "fixed": None})
        self.until(lambda: viewer.json("status")["slots"] > first + 40)
        second = self.change_sensor(viewer, changes[1])
        self.until(lambda: viewer.json("status")["slots"] > second + 40)
        slots = [first - 1, first, first + 5, second - 1, second, second + 30]
        shown = {slot: viewer.ask(f"plane/r0d-{slot}")[2] for slot in slots}
        _, codes = viewer.picture(1, second + 4)
        self.assertLess(np.sqrt(np.mean((light_of(codes) - light.ravel()) ** 2)), 0.06)
        live.terminate()
        live.wait(timeout=60)
        [one, two] = self.figures("info", "clip.stipple")["switches"]
        self.assertEqual((one["slot"], two["slot"]), (first, second))
        self.succeed("emulate", "still.npy", "-o", "again.stipple", "--schedule", "tiled",
                     "--switch", f"{first}:{changes[0]}", "--switch", f"{second}:{changes[1]}")
        clip, again = Viewer(self, "clip.stipple"), Viewer(self, "again.stipple")
        for slot, dn in shown.items():
            self.assertGreater(len(dn), 0)
            self.assertEqual(clip.ask(f"plane/r0d-{slot}")[2], dn)
            of_emulate = np.frombuffer(again.ask(f"plane/r0d-{slot}")[2], "<u2")
            self.assertLess(np.mean(np.frombuffer(dn, "<u2") != of_emulate), 0.001)  # the light may differ by its last bit
        self.succeed("decode", "clip.stipple", "-o", "decoded.npy", "--method", "fast")
        decoded = self.array("decoded.npy")[first - 20:second + 20]
        self.assertLess(np.sqrt(np.mean((decoded - light) ** 2)), 0.06)

    def test_the_sensor_of_a_viewed_camera_changes_from_the_page(self):
        self.write_array("still.npy", np.broadcast_to(self.light[:1], self.light.shape))
        self.serve("still.npy")
        viewer = self.view("--schedule", "tiled")
        for changes in ("seed=2", "schedule=random", "seed=5,sensor.full_scale_e=9000"):
            slots = viewer.json("status")["slots"]
            self.until(lambda: viewer.json("status")["slots"] > slots + 30)
            slot = self.change_sensor(viewer, changes)
        self.until(lambda: viewer.json("status")["slots"] > slot + 30)
        for at in (slot, slot + 10):
            _, codes = viewer.picture(1, at)
            self.assertLess(np.sqrt(np.mean((light_of(codes) - self.light[0].ravel()) ** 2)), 0.06)
        self.act(viewer, "set", feature="Height", value=ROWS // 2, stopped=1)  # opens the camera anew
        self.assertEqual(viewer.json("camera")["sensor"]["seed"], 5)

    def test_a_sensor_that_cannot_change_says_why(self):
        self.serve()
        viewer = self.view("--sensor", "lux1310", "--overrun", "drop")
        self.assertIn("drops late rows", viewer.json("camera")["sensor"]["fixed"])
        self.assertIn("drops late rows", self.act(viewer, "sensor", 400, changes="seed=2"))

    def test_what_cannot_be_viewed_is_told(self):
        self.serve()
        self.fails(INPUT, ["NoSuchFeature"], "view", self.address, "--set", "camera.NoSuchFeature=1")
        self.fails(INPUT, [self.address, "a page of its own"], "view", "light.npy", self.address)
        self.fails(USAGE, ["--sensor", "no running camera"], "view", "light.npy", "--sensor", "paper")
        self.fails(USAGE, ["--port", "add --view"], "capture", "live", self.address, "-o", "a.stipple", "--port", 8080)


if __name__ == "__main__":
    unittest.main()
