"""A camera on the network, found, examined and recorded."""

import json
import os
import re
import resource
import signal
import socket
import struct
import subprocess
import threading
import time
import unittest

import numpy as np
from program import DEVICE, INPUT, OK, PROGRAM, STOPPED, USAGE, ProgramTest, project_path

CAUSES = ("device", "transport", "host_underrun", "queue_drop", "reconnect", "layout")


def counted_by_long_live():
    """What tests/bench/capture/long_live.py takes for an outage in what the program says."""
    return re.search(r'messages[.]count[(]"(.+)"[)]', project_path("tests/bench/capture/long_live.py").read_text())[1]


def records_of(path):
    """The records of a recording's frames, read as docs/recording_format.md says."""
    data, at, records, dtype = path.read_bytes(), 16, [], None
    while at + 32 <= len(data):
        kind, _, length, payload = struct.unpack_from("<4xIIIQ", data, at)
        record, at = data[at + 32:at + 32 + length], at + 32 + length + payload
        if kind == 1:
            dtype = np.dtype([tuple(field) for field in json.loads(record)["frame_record"]])
        elif kind == 2 and at <= len(data):
            records.append(np.frombuffer(record, dtype, 1)[0])
    return records


class Relay(threading.Thread):
    """A camera's control channel at another address, until the register 0xE8, DeviceUserID, is read: from then on the
    camera `goes`, so that nothing is answered, or it asks for another minute."""

    def __init__(self, address, camera, goes=True):
        super().__init__(daemon=True)
        self.addresses = [socket.inet_aton(one) for one in (camera, address)]
        self.camera, self.goes, self.reached = (camera, 3956), goes, threading.Event()
        self.outside, self.inside = (socket.socket(type=socket.SOCK_DGRAM) for _ in range(2))
        self.outside.bind((address, 3956))
        self.inside.bind(("127.0.0.1", 0))
        self.start()

    def run(self):
        discovery, read_memory, pending_ack, minute_ms = 0x02, 0x84, 0x89, 60_000
        while True:
            request, client = self.outside.recvfrom(65536)
            if request[3] == read_memory and request[8:12] == b"\0\0\0\xe8":
                self.reached.set()
            if not self.reached.is_set():
                self.inside.sendto(request, self.camera)
                answer = self.inside.recv(65536)
                self.outside.sendto(answer.replace(*self.addresses) if request[3] == discovery else answer, client)
            elif not self.goes:
                self.outside.sendto(struct.pack(">3H", 0, pending_ack, 4) + request[6:8] + struct.pack(">2H", 0, minute_ms),
                                    client)


class CaptureRecordTest(ProgramTest):
    count = 0

    def setUp(self):
        super().setUp()
        if "built without" in self.run_program("capture", "list").stdout:
            self.skipTest("built without Aravis")
        CaptureRecordTest.count += 1
        number = os.getpid()
        self.ip = f"127.{200 + self.count}.{number >> 8 & 255}.{number & 255 or 1}"
        self.address = f"gige:{self.ip}"
        self.write_array("light.npy", np.random.default_rng(1).random((20, 48, 64)))

    def serve(self, *options, images=("--format", "Mono16")):
        """Starts a camera and waits until it is there."""
        camera = self.start_program("capture", "serve", "light.npy", "--repeat", *images,
                                    "--address", self.ip, "--frames-hz", 100, *options, stdout=subprocess.PIPE)
        watchdog = threading.Timer(60, camera.kill)
        watchdog.start()
        self.addCleanup(self.end, camera)
        self.assertIn("READY", camera.stdout.readline())
        watchdog.cancel()
        return camera

    @staticmethod
    def end(process):
        process.kill()
        process.communicate()

    def record(self, *arguments, **options):
        return self.start_program("capture", "record", self.address, "-o", "clip.strec", *arguments,
                                  **options)

    def until_frames(self, recorder, frames):
        """Waits until the hidden file under way holds so many frames."""
        self.until_size(recorder, ".strec", frames * 64 * 48 * 2)

    def until_size(self, recorder, extension, size):
        deadline = time.monotonic() + 60
        while recorder.poll() is None and time.monotonic() < deadline:
            parts = [name for name in os.listdir(self.folder) if name.endswith(extension)]
            if any((self.folder / name).stat().st_size > size for name in parts):
                return
            time.sleep(0.01)
        recorder.kill()
        self.fail(recorder.communicate()[1])

    def test_every_frame_of_a_recording_is_accounted_for(self):
        self.serve()
        figures = self.figures("capture", "record", self.address, "-o", "clip.strec", "--frames", 30)
        self.assertEqual(figures["frames"], 30)
        self.assertEqual(tuple(figures["lost"]), CAUSES)
        records = records_of(self.folder / "clip.strec")
        self.assertEqual(len(records), 30)
        for before, record in zip(records, records[1:]):
            self.assertEqual(record["id"], before["id"] + 1 + record["lost_before"])

    def losses(self, options, *told):
        """Records; the parts are in what is told for people, and --fail-on-loss has an exit code. The figures."""
        command = ["capture", "record", self.address, "-o", *options, "--json", "figures.json", "--force"]
        said = self.succeed(*command)
        for part in told:
            self.assertIn(part, said)
        self.fails(DEVICE, ["clip.", "; the file is kept (--fail-on-loss)"], *command, "--fail-on-loss")
        return json.loads((self.folder / "figures.json").read_text())

    def test_frames_that_the_camera_leaves_out_are_its_loss(self):
        self.serve("--fault-begin-at", 4)
        figures = self.losses(["clip.strec", "--frames", 5], "lost: 4 device, of these 4 before the first frame")
        self.assertEqual((figures["lost"]["device"], figures["missing_before_first"]), (4, 4))

    def test_lost_packets_are_a_loss_in_transport(self):
        self.serve("--fault-lose", 0.2, "--no-resend")
        figures = self.losses(["clip.strec", "--frames", 20, "--incomplete", "drop"], " transport")
        self.assertEqual(sum(figures["lost"].values()), figures["lost"]["transport"])
        info = self.figures("info", "clip.strec")
        self.assertTrue(info["complete"])
        self.assertEqual(info["missing_frames"] + info["missing_after_last"], figures["lost"]["transport"])

    def test_missing_slots_are_told_apart_from_damaged_frames(self):
        self.serve("--mode", "coded", "--fault-begin-at", 4, images=())
        figures = self.losses(["clip.stipple", "--coded", "--frames", 12], "of these 4 missing, 0 frames damaged")
        self.assertEqual((figures["missing_slots"], figures["damaged_frames"]), (4, 0))

    def test_features_are_listed_with_their_ranges(self):
        self.serve()
        figures = self.figures("capture", "features", self.address)
        features = {row["name"]: row for row in figures["features"]}
        self.assertEqual(figures["address"], self.address)
        self.assertEqual((features["Width"]["type"], features["Width"]["value"]), ("integer", "64"))
        self.assertEqual(features["PixelFormat"]["value"], "Mono16")
        self.assertIn("Mono16", features["PixelFormat"]["choices"])
        said = self.succeed("capture", "features", self.address, "pixelf*")
        self.assertRegex(said, r"^PixelFormat +r[ow] +choice +Mono16")
        self.assertEqual(said.count("\n"), 1)
        self.assertIn("PixelFormat", self.succeed("capture", "features", self.address, "lform"))
        self.fails(INPUT, ['"nothing"', "matches none of"], "capture", "features", self.address, "nothing")
        self.fails(INPUT, ["replay:light.npy: has no features"], "capture", "features", "replay:light.npy")

    def relay(self, **options):
        """Another address of the camera, as Relay says."""
        CaptureRecordTest.count += 1
        relay = Relay(f"127.{150 + self.count}.{self.ip.split('.', 2)[2]}", self.ip, **options)
        return relay, "gige:" + socket.inet_ntoa(relay.addresses[1])

    def test_a_camera_that_goes_away_while_it_is_looked_at_is_lost(self):
        self.serve()
        for command in ("features", "doctor"):
            relay, address = self.relay()
            done = self.run_program("capture", command, address)
            self.assertTrue(relay.reached.is_set(), done.stderr)
            self.assertEqual(done.returncode, DEVICE, done.stderr)
            self.assertIn(f"{address}: camera lost: it no longer answers", done.stdout + done.stderr)

    def test_the_doctor_that_waits_for_a_camera_ends_when_told_to(self):
        self.serve()
        relay, address = self.relay(goes=False)
        doctor = self.start_program("capture", "doctor", address, stdout=subprocess.DEVNULL)
        self.addCleanup(self.end, doctor)
        self.assertTrue(relay.reached.wait(60))
        doctor.terminate()
        errors = doctor.communicate(timeout=20)[1]  # of the minute
        self.assertEqual(doctor.returncode, 128 + signal.SIGTERM, errors)

    def test_a_folder_gets_a_recording_named_by_the_time(self):
        self.serve()
        (self.folder / "clips").mkdir()
        self.succeed("capture", "record", self.address, "-o", "clips", "--frames", 2)
        (clip,) = (self.folder / "clips").iterdir()
        self.assertRegex(clip.name, r"^\d{8}_\d{6}_\d{3}\.strec$")

    def test_ctrl_c_leaves_a_readable_recording(self):
        self.serve()
        recorder = self.record()
        self.until_frames(recorder, 10)
        recorder.send_signal(signal.SIGINT)
        recorder.communicate(timeout=60)
        self.assertEqual(recorder.returncode, STOPPED)
        self.assertGreaterEqual(len(records_of(self.folder / "clip.strec")), 10)

    def test_a_full_disk_leaves_a_readable_recording(self):
        self.serve()
        limit = 200_000
        recorder = self.record(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE,
                                                                     (limit, limit)))
        errors = recorder.communicate(timeout=60)[1]
        self.assertEqual(recorder.returncode, DEVICE, errors)
        self.assertIn("clip.strec", errors)
        self.assertGreaterEqual(len(records_of(self.folder / "clip.strec")), 20)

    def test_a_camera_that_is_gone_for_good_ends_the_recording(self):
        camera = self.serve()
        recorder = self.record("--no-reconnect")
        self.until_frames(recorder, 5)
        camera.kill()
        errors = recorder.communicate(timeout=60)[1]
        self.assertEqual(recorder.returncode, DEVICE, errors)
        self.assertIn("camera lost", errors)
        self.assertRegex(errors, r"clip.strec: \d+ frames kept")
        self.assertGreaterEqual(len(records_of(self.folder / "clip.strec")), 5)

    def test_a_camera_that_is_gone_for_good_ends_live(self):
        camera = self.serve()
        live = self.start_program("capture", "live", self.address, "-o", "live.stipple", "--no-reconnect")
        self.until_size(live, ".stipple", 20_000)
        camera.kill()
        errors = live.communicate(timeout=60)[1]
        self.assertEqual(live.returncode, DEVICE, errors)
        self.assertIn(f"{self.address}: camera lost: ", errors)
        self.assertIn("live.stipple: what was written before is kept", errors)
        self.assertTrue(self.figures("info", "live.stipple")["complete"])

    def test_a_camera_that_comes_back_is_recorded_on(self):
        camera = self.serve()
        recorder = self.record("--json", "figures.json", "--frames", 60)
        self.until_frames(recorder, 5)
        camera.kill()
        camera.wait()
        self.serve()
        errors = recorder.communicate(timeout=100)[1]
        self.assertEqual(recorder.returncode, OK, errors)
        figures = json.loads((self.folder / "figures.json").read_text())
        if figures["outages"] == 0:
            self.skipTest("all frames had come before the camera was gone")
        self.assertEqual(errors.count(counted_by_long_live()), figures["outages"])
        records = records_of(self.folder / "clip.strec")
        self.assertEqual(len(records), 60)
        self.assertGreaterEqual(records[-1]["epoch"], 1)
        for before, record in zip(records, records[1:]):
            self.assertEqual(record["id"], before["id"] + 1 + record["lost_before"])

    def test_the_text_that_long_live_counts_as_an_outage_is_in_the_program(self):
        sources = "".join(path.read_text() for path in project_path("apps").rglob("*.cpp"))
        self.assertIn(f'say_warning("{counted_by_long_live()}', sources)

    def test_a_replay_ends_where_its_recording_does(self):
        self.serve()
        self.figures("capture", "record", self.address, "-o", "clip.strec", "--frames", 5)
        figures = self.figures("capture", "record", "replay:clip.strec", "-o", "copy.strec")
        self.assertEqual((figures["frames"], figures["outages"]), (5, 0))
        hashes = [[record["payload_hash"] for record in records_of(self.folder / name)]
                  for name in ("clip.strec", "copy.strec")]
        self.assertEqual(hashes[0], hashes[1])

    def findings_of(self, address):
        """What the doctor finds; its exit code tells whether there is a problem among it."""
        done = self.run_program("capture", "doctor", address, "--json", "-")
        findings = json.loads(done.stdout)["findings"]
        problems = [one for one in findings if one["level"] == "problem"]
        self.assertEqual(done.returncode, DEVICE if problems else OK, done.stderr)
        self.assertEqual(f"found {len(problems)} problem" in done.stderr, bool(problems), done.stderr)
        return findings

    def test_the_doctor_knows_who_holds_control(self):
        self.serve()
        found = self.findings_of(self.address)
        self.assertIn(("control", "free"), [(one["subject"], one["fact"]) for one in found])
        levels = {one["subject"]: one["level"] for one in found}
        self.assertEqual((levels["control"], levels["Width"]), ("good", "fact"))
        # Other interfaces and kinds of cameras do not matter to this one.
        self.assertEqual([name for name in levels if name.startswith(("interface", "MTU"))], ["interface lo"])
        self.assertFalse([name for name in levels if "usbfs" in name or "/dev/" in name])
        recorder = self.record()
        self.until_frames(recorder, 1)
        found = self.findings_of(self.address)
        (control,) = [one for one in found if one["subject"] == "control"]
        self.assertEqual(control["level"], "problem")
        self.assertIn("stop that program", control["fix"])
        self.end(recorder)

    def test_the_doctor_refuses_what_it_cannot_look_at(self):
        for address in ("foo", "xyz:1", "gige", "gige:foo"):
            said = [self.fails(INPUT, [address], *words) for words in (
                ("capture", "doctor", address), ("capture", "record", address, "-o", "x"))]
            self.assertEqual(*said)
        for address in ("v4l2:/dev/null", "replay:missing"):
            self.fails(INPUT, [address, "gige:IP or usb:SERIAL"], "capture", "doctor", address)

    def test_the_doctor_names_a_silent_camera_once(self):
        findings = self.findings_of("gige:127.254.254.253")
        subjects = [one["subject"] for one in findings]
        self.assertEqual(len(subjects), len(set(subjects)), subjects)
        (camera,) = [one for one in findings if one["subject"] == "camera"]
        self.assertEqual((camera["level"], camera["fix"]), ("problem", ""))
        self.assertIn("check power, cable", camera["fact"])
        self.assertNotIn("doctor", camera["fact"])

    def test_what_cannot_be_is_refused(self):
        self.serve()
        camera = ("capture", "record", self.address, "-o", "clip.strec")
        self.fails(INPUT, ["Wdith: the camera has no such feature"], *camera, "--set", "camera.Wdith=64")
        self.fails(INPUT, ["is not the address of a camera"], "capture", "record", "lan:1", "-o", "x")
        self.fails(DEVICE, ["no camera answers"], "capture", "record", "gige:127.254.254.253", "-o",
                   "x")
        self.fails(USAGE, ["--stall excludes --coded"], *camera, "--coded", "--stall", 0)
        (self.folder / "camera.toml").write_text("Width = [1, 2]\n")
        self.fails(INPUT, ["camera.toml:1", "is a list"], *camera, "--config", "camera.toml")


if __name__ == "__main__":
    unittest.main()
