"""Streams that are foreign or damaged: refused, or decoded as far as they are intact."""

import json
import struct
import unittest
from itertools import accumulate

import numpy as np
from program import INPUT, OK, ProgramTest, project_path
from sample_stream import crc32c, parts, sealed


class BadStreamsTest(ProgramTest):
    def refuse(self, stream, *parts):
        for command in (["info", stream], ["decode", stream, "-o", "out.npy", "--method", "naive"]):
            self.fails(INPUT, [stream, *parts], *command)

    def test_missing(self):
        self.refuse("nothing.stipple", "No such file")

    def test_a_folder_and_an_empty_file(self):
        (self.folder / "folder.stipple").mkdir()
        (self.folder / "empty.stipple").touch()
        self.refuse("folder.stipple")
        self.refuse("empty.stipple")

    def test_another_kind_of_file(self):
        self.fails(INPUT, [self.write_flat("light.npy"), "not a sample stream"],
                   "decode", "light.npy", "-o", "out.npy", "--method", "naive")
        (self.folder / "notes.stipple").write_text("no stream at all, but some words about one\n")
        self.refuse("notes.stipple")

    def test_a_newer_version_is_called_so(self):
        self.change_byte(self.write_stream(), 8)
        self.refuse("clip.stipple", "version")

    def test_version_1_has_the_light_of_version_2(self):
        old = project_path("tests/golden/stream_version_1")
        for file, slots, code in (("bands_of_rows", 3, OK), ("interrupted", 3, OK),
                                  ("damaged_payload", 3, INPUT)):
            stream = self.folder / f"{file}.stipple"
            stream.write_bytes((old / stream.name).read_bytes())
            done = self.run_program("info", stream.name, "--json", "-")
            self.assertEqual(done.returncode, code, done.stderr)
            info = json.loads(done.stdout)
            self.assertEqual((info["version"], info["slots"]), (1, slots))
            self.run_program("decode", stream.name, "-o", "old.npy", "--method", "naive", "--force")
            self.run_program("decode", old.with_name("stream") / stream.name, "-o", "new.npy", "--method", "naive",
                             "--force")
            self.assertEqual(len(self.array("old.npy")), slots)
            self.assertGreater(self.array("old.npy").std(), 0.05)
            np.testing.assert_array_equal(self.array("old.npy"), self.array("new.npy"))

    def test_a_damaged_header(self):
        self.change_byte(self.write_stream(), 40)
        self.refuse("clip.stipple", "header", "CRC")

    def test_a_stream_that_ends_within_its_header(self):
        path = self.folder / self.write_stream()
        path.write_bytes(path.read_bytes()[:70])
        self.refuse("clip.stipple", "header")

    def test_a_stream_without_samples_is_decoded_to_black_with_a_warning(self):
        emulate = ["emulate", self.write_flat("light.npy", 3), "-o", "clip.stipple"]
        self.assertIn("no exposure ended", self.succeed(*emulate, "--schedule", "full4x"))
        done = self.run_program("decode", "clip.stipple", "-o", "out.npy", "--method", "fast")
        self.assertEqual(done.returncode, OK, done.stderr)
        self.assertIn("clip.stipple: holds no sample", done.stderr)
        self.assertEqual(self.array("out.npy").max(), 0)

    def damaged_stream(self):
        """A stream of 30 slots with a changed byte in a packet in its middle."""
        name = self.write_stream(rows=32, cols=32)
        content = (self.folder / name).read_bytes()
        middle = content.index(b"\xc5SPK", len(content) // 2)
        self.change_byte(name, middle + 40)  # behind the header of 36 bytes
        return name

    def test_damage_is_named_with_its_place_and_the_rest_decoded(self):
        name = self.damaged_stream()
        done = self.run_program("decode", name, "-o", "out.npy", "--method", "naive")
        self.assertEqual(done.returncode, INPUT)
        for part in (name, "1 of 30 slots", "byte ", "CRC"):
            self.assertIn(part, done.stderr)
        self.assertEqual(self.array("out.npy").shape, (30, 32, 32))

    def test_info_lists_the_damage(self):
        name = self.damaged_stream()
        done = self.run_program("info", name, "--json", "-")
        self.assertEqual(done.returncode, INPUT)
        report = json.loads(done.stdout)
        self.assertEqual(report["missing_slots"], 1)
        self.assertEqual(report["packets"], 29)
        header, packets, _ = parts((self.folder / name).read_bytes())
        place, _ = report["damage"]  # then the slot that is missing
        sizes = dict(zip(accumulate(map(len, packets), initial=len(header)), map(len, packets)))
        self.assertEqual(place["bytes"], sizes[place["offset"]])

    def test_packets_of_another_recording_are_damage(self):
        streams = []
        for light in ("a.npy", "b.npy"):
            self.write_array(light, np.random.default_rng(ord(light[0])).random((30, 32, 32)))
            self.succeed("emulate", light, "-o", "clip.stipple", "--force")
            streams.append(parts((self.folder / "clip.stipple").read_bytes()))
        (header, first, _), (other, second, marker) = streams
        self.assertEqual(len(header), len(other))
        self.assertEqual(list(map(len, first)), list(map(len, second)))
        torn = self.folder / "torn.stipple"
        torn.write_bytes(header + b"".join(first[:8] + second[8:]) + marker)
        done = self.run_program("info", torn.name, "--json", "-")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("another stream", done.stderr)
        report = json.loads(done.stdout)
        self.assertEqual((report["version"], report["complete"]), (2, False))
        self.assertEqual((report["packets"], report["slots"]), (8, 8))
        tear = len(header) + sum(map(len, first[:8]))
        self.assertEqual([(place["offset"], place["bytes"]) for place in report["damage"]],
                         [(tear, torn.stat().st_size - tear)])
        done = self.run_program("decode", torn.name, "-o", "out.npy", "--method", "naive")
        self.assertEqual(done.returncode, INPUT)
        self.assertEqual(len(self.array("out.npy")), 8)
        self.fails(INPUT, ["another stream"], "decode", torn.name, "-o", "no.npy", "--strict")

    def test_packets_that_are_good_but_not_those_recorded_are_told(self):
        path = self.folder / self.write_stream(rows=32, cols=32)
        content = path.read_bytes()
        self.assertEqual(sealed(*parts(content)), content)
        header, packets, marker = parts(content)
        packets[9] = packets[9][:-1] + bytes([packets[9][-1] ^ 1])
        other = sealed(header, packets, marker)
        path.write_bytes(other)
        self.succeed("info", path.name)
        seed, end = crc32c(header[:-4]), marker[:16]  # the checksum of the packets as they were
        path.write_bytes(other[:-20] + end + struct.pack("<I", crc32c(end, seed)))
        for command in (["info"], ["decode", "-o", "out.npy", "--method", "naive"]):
            done = self.run_program(command[0], path.name, *command[1:])
            self.assertEqual(done.returncode, INPUT)
            self.assertIn("not those that were recorded", done.stderr)
        self.assertEqual(len(self.array("out.npy")), 30)

    def test_strict_writes_nothing(self):
        name = self.damaged_stream()
        self.fails(INPUT, [name, "byte "], "decode", name, "-o", "out.npy", "--method", "naive",
                   "--strict")

    def test_a_stream_that_was_cut_off_decodes_up_to_the_cut(self):
        path = self.folder / self.write_stream(rows=32, cols=32)
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
        done = self.run_program("decode", path.name, "-o", "out.npy", "--method", "naive")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("ends within a packet", done.stderr)
        self.assertIn(len(self.array("out.npy")), range(5, 25))

    def test_a_stream_without_a_packet_has_nothing_to_decode(self):
        path = self.folder / self.write_stream()
        content = path.read_bytes()
        path.write_bytes(content[: content.index(b"\xc5SPK")])
        self.fails(INPUT, ["clip.stipple", "no slot"], "decode", "clip.stipple", "-o", "out.npy")


if __name__ == "__main__":
    unittest.main()
