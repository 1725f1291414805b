"""Streams that are foreign or damaged: refused, or decoded as far as they are intact."""

import json
import unittest

from program import INPUT, OK, ProgramTest


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
        self.refuse(self.write_flat("light.npy"), "not a sample stream")

    def test_a_newer_version_is_called_so(self):
        self.change_byte(self.write_stream(), 8)
        self.refuse("clip.stipple", "version")

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
        self.assertGreater(report["damage"][0]["bytes"], 0)

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
