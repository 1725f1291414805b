"""The program as a GigE Vision camera, met by our own client and by Aravis' tools."""

import json
import os
import re
import resource
import shutil
import signal
import socket
import struct
import subprocess
import threading
import time
import tomllib
import unittest

import numpy as np
from program import DEVICE, INPUT, PROGRAM, STOPPED, USAGE, ProgramTest
from sample_stream import parts

BUILT_WITHOUT = "built without Aravis"


def own_address(number):
    """A loopback address that no other test process uses."""
    return f"127.{100 + number}.{os.getpid() >> 8 & 255}.{os.getpid() & 255 or 1}"


def frames_of(recording):
    """Records and payloads, read as docs/recording_format.md says."""
    data, at, frames = recording.read_bytes(), 16, []
    while at + 32 <= len(data):
        kind, _, length, payload = struct.unpack_from("<4xIIIQ", data, at)
        record, at = data[at + 32:at + 32 + length], at + 32 + length + payload
        if kind == 1:
            dtype = np.dtype([tuple(field) for field in json.loads(record)["frame_record"]])
        elif kind == 2:
            frames.append((np.frombuffer(record, dtype, 1)[0], data[at - payload:at]))
    return frames


class ServeTest(ProgramTest):
    count = 0

    def serve(self, *arguments):
        """Starts a server and waits for its READY line; its address."""
        ServeTest.count += 1
        address = own_address(ServeTest.count)
        server = subprocess.Popen(
            [PROGRAM, "capture", "serve", *map(str, arguments), "--address", address],
            cwd=self.folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(self.stop, server)
        watchdog = threading.Timer(60, server.kill)
        watchdog.start()
        ready = server.stdout.readline()
        watchdog.cancel()
        self.assertIn(f"READY gige:{address}", ready, server.stderr.read() if not ready else "")
        return address

    def stop(self, server):
        server.send_signal(signal.SIGINT)
        try:
            server.communicate(timeout=30)
        except subprocess.TimeoutExpired:
            server.kill()
            server.communicate()

    def test_ctrl_c_is_no_loss(self):
        server = self.start_program("capture", "serve", self.scene(), "--address", own_address(0),
                                    "--json", "counts.json", stdout=subprocess.PIPE)
        self.addCleanup(self.stop, server)
        self.assertIn("READY", server.stdout.readline())
        server.send_signal(signal.SIGINT)
        errors = server.communicate(timeout=60)[1]
        self.assertEqual(server.returncode, STOPPED, errors)
        self.assertNotIn("shorter", errors)
        self.assertEqual(json.loads((self.folder / "counts.json").read_text())["frames"], 0)

    def test_clients_are_told_as_they_come_and_go_and_frames_at_the_end(self):
        for quiet in ([], ["-q"]):
            ServeTest.count += 1
            address = own_address(ServeTest.count)
            server = self.start_program("capture", "serve", self.scene(), "--address", address, "--frames-hz",
                                        100, *quiet, stdout=subprocess.PIPE)
            self.addCleanup(self.stop, server)
            self.assertIn("READY", server.stdout.readline())
            self.record(address, "clip.strec", "--frames", 6, "--force")
            time.sleep(0.5)
            server.send_signal(signal.SIGINT)
            text, errors = server.communicate(timeout=60)
            if quiet:
                self.assertEqual((text, "127." in errors), ("", False), errors)
                continue
            told = re.findall(r"^stipple: (127[.\d]+:\d+) (controls the camera|has gone, \d+ frames sent)$",
                              errors, re.MULTILINE)
            self.assertEqual([what[:8] for _, what in told], ["controls", "has gone"] * (len(told) // 2))
            self.assertGreaterEqual(int(told[-1][1].split()[2]), 6)
            self.assertRegex(text, r"^\d+ frames in 1 start, \d+ late; \d+ packets, \d+ sent again\n$")

    def test_cameras_differ_in_their_serial_numbers(self):
        scene = self.scene()
        for address in (self.serve(scene), self.serve(scene)):
            self.assertIn(f"DeviceSerialNumber = {address}", self.tool(
                "arv-tool-0.8", "-a", address, "control", "DeviceSerialNumber"))

    def record(self, address, output, *arguments):
        done = self.run_program("capture", "record", "gige:" + address, "-o", output, *arguments)
        if BUILT_WITHOUT in done.stderr:
            self.skipTest(BUILT_WITHOUT)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def warnings_of(self, source, frames):
        """What a server says while a client records so many frames."""
        ServeTest.count += 1
        address = own_address(ServeTest.count)
        server = self.start_program("capture", "serve", source, "--address", address, "--frames-hz", 200,
                                    stdout=subprocess.PIPE)
        self.addCleanup(self.stop, server)
        self.assertIn("READY", server.stdout.readline())
        self.record(address, "clip.strec", "--frames", frames, "--force")
        time.sleep(0.5)  # the warning comes from another thread
        server.send_signal(signal.SIGINT)
        return server.communicate(timeout=60)[1]

    def write_register(self, camera, register, value):
        """Status of a GigE Vision WRITEREG from 127.0.0.1; control is taken first."""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
            client.bind(("127.0.0.1", 0))
            client.settimeout(30)
            client.sendto(struct.pack(">BBHHH4I", 0x42, 1, 0x82, 16, 7, 0xA00, 2, register, value),
                          (camera, 3956))
            return struct.unpack_from(">H", client.recv(576))[0]

    def test_frames_go_elsewhere_only_where_that_is_allowed(self):
        destination, own, other = 0xD18, 0x7F000001, 0x7F000042
        address = self.serve(self.scene())
        self.assertEqual(self.write_register(address, destination, own), 0)
        address = self.serve("scene.npy")
        self.assertEqual(self.write_register(address, destination, other), 0x8002)
        address = self.serve("scene.npy", "--allow-other-destination")
        self.assertEqual(self.write_register(address, destination, other), 0)

    def test_no_client_asks_for_more_frames_a_second_than_are_offered(self):
        address = self.serve(self.scene(), "--frames-hz", 50)
        for rate, code in ((50, 0), (51, INPUT)):
            done = self.run_program("capture", "record", "gige:" + address, "-o", f"{rate}.strec", "--frames",
                                    2, "--set", f"camera.AcquisitionFrameRate={rate}")
            if BUILT_WITHOUT in done.stderr:
                self.skipTest(BUILT_WITHOUT)
            self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn("AcquisitionFrameRate: 51 cannot be set; it takes 0.01 to 50", done.stderr)

    def test_light_that_is_clipped_and_damage_are_told(self):
        light = np.full((6, 8, 16), 0.5, np.float32)
        self.assertNotIn("clipped", self.warnings_of(self.write_array("light.npy", light), 6))
        self.succeed("capture", "record", "replay:light.npy", "-o", "whole.strec", "--frames", 6)
        light[0, :2] = 4.5
        said = self.warnings_of(self.write_array("hdr.npy", light), 6)
        self.assertIn("hdr.npy: its first frame has light up to 4.5; 25 % of it is clipped", said)
        self.assertIn("Mono8", said)
        content = bytearray((self.folder / "whole.strec").read_bytes())
        blocks = [at for at in range(len(content)) if content[at:at + 4] == b"\xc5FRM"]
        content[blocks[2] - 1] ^= 0xFF  # the last sample of the first frame, behind the session
        (self.folder / "damaged.strec").write_bytes(content)
        self.assertIn("damaged.strec: is damaged", self.warnings_of("damaged.strec", 5))

    def test_a_setting_that_cannot_be_is_answered_with_what_can(self):
        address = self.serve(self.scene())
        for setting, parts in (
                ("Width=33", ["Width: 33 cannot be set", "it takes ", " to 64 in steps of "]),
                ("ExposureTime=100", ["ExposureTime: the camera has no such feature"]),
                ("Wdith=32", ["Wdith: the camera has no such feature", 'did you mean "Width"?'])):
            done = self.run_program("capture", "record", "gige:" + address, "-o", "x.strec", "--set",
                                    f"camera.{setting}")
            if BUILT_WITHOUT in done.stderr:
                self.skipTest(BUILT_WITHOUT)
            self.assertEqual(done.returncode, INPUT, done.stderr)
            for part in parts:
                self.assertIn(part, done.stderr)

    def tool(self, name, *arguments):
        """Output of one of Aravis' programs."""
        program = shutil.which(name)
        if program is None:
            self.skipTest(f"{name} is not installed")
        done = subprocess.run([program, *map(str, arguments)], text=True, capture_output=True,
                              timeout=120)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def scene(self, slots=24, rows=40, cols=64):
        light = np.random.default_rng(3).random((slots, rows, cols), np.float32)
        return self.write_array("scene.npy", light)

    def same_bytes(self, one, other):
        return (self.folder / one).read_bytes() == (self.folder / other).read_bytes()

    def test_frames_lost_before_the_first_are_counted_and_ids_that_begin_elsewhere_are_not(self):
        scene = self.scene()
        for fault, missing in ((["--fault-begin-at", 4], 4), (["--fault-first-block", 500], 0),
                               (["--fault-gap-at", 0, "--fault-gap", 400], 0)):
            address = self.serve(scene, "--frames-hz", 50, *fault)
            figures = json.loads(self.record(address, "clip.strec", "--frames", 3, "--force",
                                             "--json", "-").stdout)
            self.assertEqual(figures["missing_before_first"], missing, fault)
            self.assertEqual(sum(figures["lost"].values()), missing, fault)
            first = frames_of(self.folder / "clip.strec")[0][0]
            self.assertEqual((first["id"], first["lost_before"]), (missing, missing), fault)

    def test_slots_lost_before_the_first_are_dropped_packets(self):
        address = self.serve(self.scene(), "--mode", "coded", "--fault-begin-at", 4)
        done = self.record(address, "clip.stipple", "--coded", "--json", "-")
        self.assertEqual(json.loads(done.stdout),
                         {"slots": 24, "missing_slots": 4, "damaged_frames": 0})

    def test_a_coded_stream_arrives_as_emulate_writes_it(self):
        choice = [self.scene(), "--seed", 7, "--set", "sensor.bit_depth=10", "--schedule", "tiled"]
        self.succeed("emulate", *choice, "-o", "emulated.stipple")
        address = self.serve(*choice, "--mode", "coded")
        for output in ("first.stipple", "second.stipple"):  # each start begins with slot 0
            self.record(address, output, "--coded")
            self.assertTrue(self.same_bytes(output, "emulated.stipple"))

    def test_packets_that_come_late_change_nothing(self):
        self.succeed("emulate", self.scene(), "-o", "emulated.stipple")
        address = self.serve("scene.npy", "--mode", "coded", "--fault-drop", 0.1,
                             "--fault-reorder")
        self.record(address, "clip.stipple", "--coded", "--set", "camera.GevSCPSPacketSize=576")
        self.assertTrue(self.same_bytes("clip.stipple", "emulated.stipple"))

    def test_slots_that_are_lost_are_dropped_packets(self):
        self.scene()
        address = self.serve("scene.npy", "--mode", "coded", "--fault-gap-at", 10,
                             "--fault-gap", 3, "--fault-lose", 0.05)
        done = self.record(address, "clip.stipple", "--coded", "--json", "-", "--set",
                           "camera.GevSCPSPacketSize=576")
        *packets, _index = parts((self.folder / "clip.stipple").read_bytes())[1]  # one for each slot
        dropped = sum(packet[5] >> 1 & 1 for packet in packets)
        self.assertEqual((len(packets), dropped > 0), (24, True))
        self.assertEqual(json.loads(done.stdout), {"slots": 24, "missing_slots": dropped, "damaged_frames": dropped})

    def test_a_full_disk_leaves_the_slots_of_a_coded_stream_before(self):
        address = self.serve(self.scene(), "--mode", "coded")
        done = self.run_program("capture", "record", "gige:" + address, "--coded", "-o", "clip.stipple",
                                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (8000, 8000)))
        if BUILT_WITHOUT in done.stderr:
            self.skipTest(BUILT_WITHOUT)
        self.assertEqual(done.returncode, DEVICE, done.stderr)
        self.assertIn("clip.stipple: what was written before is kept\n", done.stderr)
        self.assertIn("clip.stipple: cannot be written: File too large", done.stderr)
        self.assertEqual(self.names(), ["clip.stipple", "scene.npy"])
        self.assertIn(json.loads(self.run_program("info", "clip.stipple", "--json", "-").stdout)["slots"], range(1, 24))

    def test_no_two_live_streams_have_the_same_header(self):
        address = self.serve(self.scene(), "--repeat")
        provenances = []
        for output in ("one.stipple", "two.stipple"):
            done = self.run_program("capture", "live", "gige:" + address, "-o", output, "--frames", 3)
            if BUILT_WITHOUT in done.stderr:
                self.skipTest(BUILT_WITHOUT)
            self.assertEqual(done.returncode, 0, done.stderr)
            provenances.append(tomllib.loads(self.figures("info", output)["provenance"]))
        names = [provenance["footage"].pop("recording") for provenance in provenances]
        self.assertEqual([len(name) for name in names], [16, 16])
        self.assertNotEqual(*names)
        self.assertEqual(*provenances)

    def test_a_camera_without_coded_stream_says_so(self):
        address = self.serve(self.scene())
        done = self.run_program("capture", "record", "gige:" + address, "--coded", "-o", "x.stipple")
        if BUILT_WITHOUT in done.stderr:
            self.skipTest(BUILT_WITHOUT)
        self.assertEqual(done.returncode, INPUT, done.stderr)
        self.assertIn("--mode coded", done.stderr)
        self.assertNotIn("x.stipple", self.names())

    def test_a_coded_stream_is_not_taken_for_images(self):
        address = self.serve(self.scene(), "--mode", "coded")
        for verb in ("live", "record"):
            done = self.run_program("capture", verb, "gige:" + address, "-o", "x", "--frames", 5)
            if BUILT_WITHOUT in done.stderr:
                self.skipTest(BUILT_WITHOUT)
            self.assertEqual(done.returncode, INPUT, done.stderr)
            self.assertIn("\"capture record\" writes it with --coded", done.stderr)
            self.assertEqual(self.names(), ["scene.npy"])

    def test_a_recording_is_served_with_the_same_bytes_and_stamps(self):
        dn = np.random.default_rng(5).integers(0, 65536, (12, 40, 64)).astype(np.uint16)
        self.write_array("dn.npy", dn, np.uint16)
        address = self.serve("dn.npy", "--format", "Mono16", "--frames-hz", 100)
        self.record(address, "one.strec", "--frames", 12)
        again = self.serve("one.strec")
        self.record(again, "two.strec", "--frames", 12)
        one, two = frames_of(self.folder / "one.strec"), frames_of(self.folder / "two.strec")
        self.assertEqual([payload for _, payload in one], [frame.tobytes() for frame in dn])
        self.assertEqual([payload for _, payload in two], [payload for _, payload in one])
        for name in ("device_ns", "width", "height", "payload_hash"):
            self.assertEqual([record[name] for record, _ in two],
                             [record[name] for record, _ in one], name)

    def test_mosaics_are_served_and_come_back_bit_by_bit(self):
        random = np.random.default_rng(6)
        for name, bits, kind in (("BayerRG8", 8, np.uint8), ("BayerGR10p", 10, None),
                                 ("BayerBG12p", 12, None), ("BayerGB16", 16, np.uint16)):
            once, twice = name + "_once.strec", name + "_twice.strec"
            dn = random.integers(0, 2**bits, (5, 12, 16)).astype(np.uint16)
            np.save(self.folder / "light.npy", (dn / (2**bits - 1)).astype(np.float32))
            self.record(self.serve("light.npy", "--format", name, "--frames-hz", 100), once,
                        "--frames", 5)
            self.record(self.serve(once), twice, "--frames", 5)
            if kind is None:  # one string of bits, each sample from its lowest
                bit = dn.reshape(5, -1, 1) >> np.arange(bits) & 1
                wanted = np.packbits(bit.reshape(5, -1).astype(np.uint8), axis=1, bitorder="little")
            else:
                wanted = dn.astype(kind)
            for file in (once, twice):
                frames = frames_of(self.folder / file)
                self.assertEqual([payload for _, payload in frames],
                                 [frame.tobytes() for frame in wanted], name)
                self.assertEqual({record["format"] for record, _ in frames}, {name.encode()})

    def test_colour_behind_a_filter_array_is_its_mosaic(self):
        dn = np.random.default_rng(7).integers(0, 256, (3, 8, 12, 3)).astype(np.uint8)
        self.write_array("colour.npy", dn, np.uint8)
        self.record(self.serve("colour.npy", "--format", "BayerGB8"), "one.strec", "--frames", 3)
        wanted = dn[..., 1].copy()  # G B over R G
        wanted[:, 0::2, 1::2] = dn[:, 0::2, 1::2, 2]
        wanted[:, 1::2, 0::2] = dn[:, 1::2, 0::2, 0]
        self.assertEqual([payload for _, payload in frames_of(self.folder / "one.strec")],
                         [frame.tobytes() for frame in wanted])

    def test_mosaics_that_cannot_be_are_refused(self):
        np.save(self.folder / "odd.npy", np.zeros((2, 7, 12), np.uint8))
        self.fails(INPUT, ["odd.npy", "even"], "capture", "serve", "odd.npy", "--format", "BayerRG8")
        np.save(self.folder / "cells.npy", np.zeros((2, 8, 6), np.uint8))
        self.fails(INPUT, ["BayerRG10p", "BayerRG12p"], "capture", "serve", "cells.npy", "--format",
                   "BayerRG10p")  # 6 x 10 bits
        self.fails(INPUT, ["BayerRG10MIPI", "BayerRG8"], "capture", "serve", "cells.npy",
                   "--format", "BayerRG10MIPI")

    def test_arv_tool_finds_reads_and_sets(self):
        address = self.serve(self.scene(), "--serial", "ab12")
        features = self.tool("arv-tool-0.8", "-a", address, "features")
        for name in ("PixelFormat", "ChunkExposureMapID", "SourceFrameCount", "GevSCPSPacketSize"):
            self.assertIn(f"'{name}'", features)
        values = self.tool("arv-tool-0.8", "-a", address, "control", "Width=32", "Width", "OffsetX=8",
                           "PixelFormat=Mono16", "PayloadSize", "DeviceSerialNumber",
                           "SourceFrameCount")
        self.assertIn("PayloadSize = 2560", values)  # 32 x 40 x 2
        self.assertIn("DeviceSerialNumber = ab12", values)
        self.assertIn("SourceFrameCount = 24", values)

    def test_arv_camera_test_streams_without_loss(self):
        address = self.serve(self.scene(), "--repeat", "--frames-hz", 50)
        report = self.tool("arv-camera-test-0.8", "-n", address, "--duration", 3, "-i", 1500)
        figures = dict(line.split("=") for line in report.splitlines() if "=" in line)
        figures = {name.strip(): value.strip() for name, value in figures.items()}
        self.assertGreater(int(figures["n_completed_buffers"]), 20)
        for name in ("n_failures", "n_size_mismatch_errors", "n_error_packets"):
            self.assertEqual(figures[name], "0", report)

    def test_what_cannot_be_served_is_named(self):
        scene = self.scene()
        taken = self.serve(scene)
        self.fails(DEVICE, [taken, "--address"], "capture", "serve", scene, "--address", taken)
        self.fails(INPUT, ["nowhere"], "capture", "serve", scene, "--address", "nowhere")
        self.fails(INPUT, ["Mono99"], "capture", "serve", scene, "--format", "Mono99", "--address",
                   own_address(90))
        self.fails(INPUT, ["absent.npy"], "capture", "serve", "absent.npy")
        self.fails(INPUT, ["no.such.sensor"], "capture", "serve", scene, "--mode", "coded", "--sensor",
                   "no.such.sensor")
        self.fails(USAGE, ["--fault-drop"], "capture", "serve", scene, "--fault-drop", 2)
        for serial in ("", "x" * 16):
            self.fails(USAGE, ["--serial", f"{len(serial)} bytes"], "capture", "serve", scene,
                       "--serial", serial)

    def test_footage_that_looks_coded_is_told(self):
        colour = self.write_png("f.png", np.full((8, 8, 3), 99))
        for mode in ("frames", "coded"):
            errors = self.run_program("capture", "serve", colour, "--mode", mode, "--address",
                                      "nowhere").stderr
            self.assertIn("f.png: looks gamma-coded: add --transfer srgb", errors)

    def test_options_of_another_mode_are_refused(self):
        serve = ("capture", "serve", self.scene())
        for option, value in (("--sensor", "ideal"), ("--schedule", "tiled"), ("--seed", 3),
                              ("--set", "sensor.bit_depth=8"), ("--overrun", "stretch"), ("--threads", 1)):
            self.fails(USAGE, [option, "--mode coded"], *serve, option, value)
        self.fails(USAGE, ["--format", "--mode frames"], *serve, "--mode", "coded", "--format",
                   "Mono8")
        self.fails(USAGE, ["--fault-gap-at requires --fault-gap"], *serve, "--fault-gap-at", 3)
        self.fails(USAGE, ["--fault-seed", "--fault-drop"], *serve, "--fault-seed", 3)
        self.succeed("capture", "record", "replay:scene.npy", "-o", "clip.strec")
        self.fails(INPUT, ["clip.strec", "numbers are linear"], "capture", "serve", "clip.strec",
                   "--max-value", 0.5)


if __name__ == "__main__":
    unittest.main()
