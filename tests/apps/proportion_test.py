"""Small files that announce much: memory and disk are in proportion to what is really there."""

import os
import re
import resource
import struct
import subprocess
import unittest
import zlib
from pathlib import Path

import numpy as np
from program import INPUT, OK, PROGRAM, ProgramTest

SANITIZED = b"__asan_init" in Path(PROGRAM).read_bytes()  # which takes memory of its own
MOST_BYTES = (1024 if SANITIZED else 256) * 2**20
long_of_memory = unittest.skipIf(SANITIZED, "of memory, which the sanitizers take too, and long with them")
XXH3_OF_NOTHING = 0x2D06800538D394C2


def crc_table():
    for number in range(256):
        for _ in range(8):
            number = number >> 1 ^ (0x82F63B78 if number & 1 else 0)
        yield number


TABLE = tuple(crc_table())


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc = crc >> 8 ^ TABLE[(crc ^ byte) & 0xFF]
    return struct.pack("<I", crc ^ 0xFFFFFFFF)


FULL = struct.pack("<HHH", 1, 1, 1) + b"\1\0\1"  # all pixels in every slot


def stream_header(rows, cols, schedule=FULL, provenance=b"", kind=0, bits=8):
    """docs/stream_format.md, version 1. Of a random schedule (kind 1) the CRC is wrong."""
    size = 92 + len(provenance) + len(schedule) + 4
    head = b"\x89STPL\r\n\x1a" + struct.pack("<HHIHHBBBB", 1, 0, size, rows, cols, 1, 0, bits, 0)
    head += struct.pack("<6d", 5000, 0, 20, 10, 5000, 1000)
    head += struct.pack("<IIIBBH", 0, len(provenance), len(schedule), kind, 0, 0) + crc32c(schedule)
    head += provenance + schedule
    return head + crc32c(head)


def packet(slot, rows, samples=0, payload=b"", flags=0):
    head = b"\xc5SPK" + struct.pack("<BBHQHHII", 1, flags, 0, slot, 0, rows, samples, len(payload))
    head += crc32c(payload)
    return head + crc32c(head) + payload


def dropped(slot, rows):
    """A packet of a slot whose samples were given up."""
    return packet(slot, rows, flags=2)


def tiff(*tags):
    """A file with a directory of these (tag, value); what they point to begins at byte 200."""
    content = b"II*\0" + struct.pack("<IH", 8, len(tags))
    content += b"".join(struct.pack("<HHII", tag, 4, 1, value) for tag, value in tags)
    return content.ljust(200, b"\0")


class ProportionTest(ProgramTest):
    def measured(self, *arguments):
        """Exit code and messages of a run that keeps within the memory and the disk of all."""
        limit = 256 * 2**20
        with subprocess.Popen(
                [PROGRAM, *map(str, arguments)], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))) as program:
            said = program.stdout.read()
            _, status, usage = os.wait4(program.pid, 0)
            program.returncode = os.waitstatus_to_exitcode(status)
        self.assertLess(usage.ru_maxrss * 1024, MOST_BYTES, said)
        return program.returncode, said

    def refuses(self, parts, *arguments):
        before = self.names()
        code, said = self.measured(*arguments)
        self.assertEqual(code, INPUT, said)
        for part in parts:
            self.assertIn(part, said)
        self.assertEqual(self.names(), before)

    def write(self, name, content):
        (self.folder / name).write_bytes(content)
        return name

    def test_slots_that_are_missing_are_few_beside_those_that_are_there(self):
        for rows, slots in ((512, (0, 99_999)), (8, range(0, 1_000_000, 100_000))):
            self.write("gap.stipple", stream_header(rows, rows) +
                       b"".join(dropped(slot, rows) for slot in slots))
            for method in ("naive", "fast"):
                self.refuses([f"gap.stipple: slots 1 to {slots[1] - 1} are missing", "--fill-gaps"], "decode",
                             "gap.stipple", "-o", "x.npy", "--method", method)
        code, said = self.measured("info", "gap.stipple")
        self.assertIn("of 900001 slots are incomplete", said)

    def test_missing_slots_are_decoded_up_to_the_limit_and_beyond_it_if_told(self):
        decode = ("decode", "gap.stipple", "-o", "x.npy", "--method", "naive", "--force")
        self.write("gap.stipple", stream_header(4, 4) + dropped(0, 4) + dropped(1033, 4))
        self.assertEqual(self.measured(*decode)[0], INPUT)  # damage is told
        self.assertEqual(len(self.array("x.npy")), 1034)  # 16 for each of 2, and 1000
        self.write("gap.stipple", stream_header(4, 4) + dropped(0, 4) + dropped(1034, 4))
        self.assertIn("--fill-gaps", self.measured(*decode)[1])
        self.assertIn("1033 of 1035 slots are incomplete", self.measured(*decode, "--fill-gaps")[1])
        self.assertEqual(len(self.array("x.npy")), 1035)

    def test_frames_of_slots_without_samples_are_few(self):
        self.write("large.stipple", stream_header(16384, 16384) + dropped(0, 16384))
        for method in ("naive", "fast", "best"):
            self.refuses(["large.stipple: slots up to 0 hold 0 samples", "1074 MB", "--fill-gaps"], "decode",
                         "large.stipple", "-o", "x.npy", "--method", method)

    @long_of_memory
    def test_a_schedule_made_from_a_seed_is_counted_without_being_kept(self):
        for rows, cols, lengths in ((8192, 2048, b"\1"), (8192, 32, b"\1" * 64)):
            section = struct.pack("<QB", 1, len(lengths)) + lengths
            self.write("random.stipple", stream_header(rows, cols, section, kind=1))
            self.refuses(["byte 88: the schedule is not the one"], "info", "random.stipple")
            self.refuses(["random.stipple: needs", "MiB of memory for its schedule",
                          "a file of less than 1 MB", "--max-memory"], "decode", "random.stipple",
                         "-o", "x.npy", "--method", "naive")
        self.write_stream(rows=24, cols=40)
        schedule = self.figures("info", "clip.stipple")["schedule"]
        self.assertEqual([schedule[key] for key in ("tile_rows", "tile_cols", "period_slots")],
                         [24, 40, 15])

    @long_of_memory
    def test_few_bits_a_sample_are_not_many_frames(self):
        every_64th = struct.pack("<HHH", 1, 1, 64) + b"\1\0\1"
        self.write("bits.stipple", stream_header(500, 400, every_64th, bits=1) + b"".join(
            packet(slot, 500, *((0, b"") if slot % 64 else (200_000, b"\x5a" * 25_000)))
            for slot in range(8 * 64)))
        for method in ("naive", "fast"):
            self.refuses(["bits.stipple: needs", "slots of 400 x 500 by the method " + method,
                          "--max-memory"], "decode", "bits.stipple", "-o", "x.npy",
                         *(("--method", method) if method == "fast" else
                           ("--method", method, "--max-memory", "100M")))
        self.fails(INPUT, ["samples only, for", "--fill-gaps"], "decode",
                   "bits.stipple", "-o", "x.npy", "--method", "naive", "--max-memory", "1G")

    def test_the_limit_of_memory_can_be_told(self):
        self.write_stream(rows=64, cols=64)
        decode = ("decode", "clip.stipple", "-o", "x.npy", "--method", "fast")
        self.refuses(["clip.stipple: needs 7 MiB", "than the 4 MiB that --max-memory says",
                      "--max-memory 64M allows it"], *decode, "--max-memory", "4M")
        self.succeed(*decode, "--max-memory", "0.5G")
        for size in ("", "4", "G", "12Q", "1K", "-1G", "nanG", "1e30G"):
            self.fails(2, ["--max-memory"], *decode, f"--max-memory={size}")

    def test_info_needs_no_more_than_the_schedule_for_a_long_period(self):
        pixel = b"\2" + b"\0\5" + b"\1\5"  # slots 0 and 2, 1 and 3: interleaved
        schedule = struct.pack("<HHH", 1, 20_000, 65535) + pixel * 20_000
        self.write("long.stipple", stream_header(8, 8, schedule))
        code, said = self.measured("info", "long.stipple")
        self.assertEqual(code, OK, said)
        self.assertIn("period 65535 slots", said)

    def recorded(self, frames=2, size=8):
        self.write_flat("light.npy", frames, size, size)
        self.succeed("capture", "record", "replay:light.npy", "-o", "clip.strec", "--force", "--set",
                     "camera.AcquisitionFrameRate=0", "--set", "camera.PixelFormat=Mono8", "--buffers", 64)

    def change_frame(self, which, fields, payload=None):
        """Writes numbers (offset in the record: code, value) of docs/recording_format.md to a frame."""
        content = (self.folder / "clip.strec").read_bytes()
        at = [found.start() for found in re.finditer(rb"\xc5FRM", content)][1 + which]
        kind, number, length, size = struct.unpack_from("<IIIQ", content, at + 4)
        record = bytearray(content[at + 32:at + 32 + length])
        kept = content[at + 32 + length:at + 32 + length + size]
        if payload is not None:
            kept, fields = payload, {**fields, 80: ("<Q", XXH3_OF_NOTHING)}
        for offset, (code, value) in fields.items():
            struct.pack_into(code, record, offset, value)
        head = b"\xc5FRM" + struct.pack("<IIIQ", kind, number, length, len(kept)) + crc32c(record)
        self.write("clip.strec", content[:at] + head + crc32c(head) + record + kept +
                   content[at + 32 + length + size:])

    def test_a_frame_that_is_complete_has_the_bytes_of_its_layout(self):
        for side, problem in ((16384, "0 of the 268435456 bytes"), (65535, "more than 2^28 values")):
            self.recorded()
            self.change_frame(0, {88: ("<Q", side), 108: ("<I", side), 112: ("<I", side)}, b"")
            code, said = self.measured("capture", "replay", "clip.strec", "-o", "x.npy", "--force")
            self.assertEqual(code, INPUT, said)
            self.assertIn(problem, said)
            self.assertEqual(len(self.array("x.npy")), 1)
            self.assertIn("damaged", self.measured("emulate", "clip.strec", "-o", "x.stipple",
                                                   "--force")[1])

    def test_frames_that_are_missing_are_few_beside_those_that_are_there(self):
        for size in (8, 512):
            self.recorded(size=size)
            self.change_frame(1, {16: ("<Q", 2**20)})
            said = [f"{2**20} frames are missing", "--fill-gaps", "--skip-gaps"]
            self.refuses(said, "capture", "replay", "clip.strec", "-o", "x.npy")
            self.refuses(said, "emulate", "clip.strec", "-o", "x.stipple")
            replay = ("capture", "replay", "clip.strec", "-o", "x.npy", "--force")
            self.assertEqual(self.measured(*replay, "--skip-gaps")[0], OK)
            self.assertEqual(len(self.array("x.npy")), 2)
            (self.folder / "x.npy").unlink()
        self.change_frame(1, {16: ("<Q", 2**20)})
        live = self.figures("capture", "live", "replay:clip.strec", "-o", "live.stipple")
        self.assertEqual(live["held_slots"] + live["unheld_slots"], 2**20)
        self.assertEqual(live["held_slots"], 32 + 2**25 // 512**2)
        self.assertEqual(live["slots"], live["held_slots"] + 2)
        self.recorded()
        for lost, code in ((1032, OK), (1033, INPUT)):
            self.change_frame(1, {16: ("<Q", lost)})
            self.assertEqual(self.measured(*replay)[0], code)
            self.assertEqual(self.measured(*replay, "--fill-gaps")[0], OK)
            self.assertEqual(len(self.array("x.npy")), lost + 2)

    def emulate_refuses(self, name, *parts):
        self.refuses([name, *parts], "emulate", name, "-o", "x.stipple")

    def test_images_are_not_larger_than_their_files_can_hold(self):
        content = bytearray((self.folder / self.write_png("a.png", np.zeros((4, 4)))).read_bytes())
        for side, part in ((20_000, "outside"), (16_000, "announces an image of 256000000 bytes")):
            struct.pack_into(">II", content, 16, side, side)
            struct.pack_into(">I", content, 29, zlib.crc32(content[12:29]))
            self.write("a.png", content)
            self.emulate_refuses("a.png", part)
        self.succeed("synth", "pan", "-o", "frames", "--size", "32x32", "--frames", 1)
        image = next((self.folder / "frames").iterdir()).read_bytes()
        window = struct.pack("<iiii", 0, 0, 31, 31)
        self.assertEqual(image.count(window), 2)  # data and display
        last = b"screenWindowWidth\0float\0"
        head = image[:image.index(last) + len(last) + 8 + 1]  # size, value, end of the header
        self.write("a.exr", head.replace(window, struct.pack("<iiii", 0, 0, 8191, 8191)) + b"\0" * 4096)
        self.emulate_refuses("a.exr", "announces an image of")

    def test_texts_are_not_larger_than_the_file_that_has_them(self):
        self.succeed("synth", "still", "-o", "frames", "--size", "32x32", "--frames", 1)
        image = next((self.folder / "frames").iterdir()).read_bytes()
        head = 8  # magic and version: attributes follow
        text = b"owner\0string\0" + struct.pack("<I", 1_800_000_000)
        self.write("a.exr", image[:head] + text + image[head:])
        self.emulate_refuses("a.exr", "cannot be read as OpenEXR: Attribute 'owner', type 'string': Invalid size 1800000000")

    def test_names_are_not_larger_than_the_mat_file_that_has_them(self):
        flags = struct.pack("<IIII", 6, 8, 6, 0)  # of 32 bits; double
        sides = struct.pack("<IIii", 5, 8, 1, 2)
        name = struct.pack("<II", 1, 2**31 - 256) + b"meas\0\0\0\0"
        numbers = struct.pack("<II2d", 9, 16, 0, 0)
        matrix = flags + sides + name + numbers
        head = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H2s", 0x0100, b"IM")
        self.write("a.mat", head + struct.pack("<II", 14, len(matrix)) + matrix)
        self.refuses(["a.mat"], "import", "a.mat", "-o", "x.stipple")

    def test_tiff_is_not_larger_than_its_way_of_packing_allows(self):
        side = 16_000
        for packing, size in ((1, 100_000), (32773, 1_000_000), (8, 100_000)):
            self.write("a.tif", tiff((256, side), (257, side), (258, 8), (259, packing), (262, 1), (273, 200), (277, 1),
                                     (278, side), (279, size)) + bytes(size))  # width, height, ..., a strip, its bytes
            self.emulate_refuses("a.tif", "announces an image of 256000000 bytes")

    def test_tiles_are_not_larger_than_their_files_can_hold(self):
        side = 32_000  # of a tile in an image of 8 x 2
        for packing, part in ((1, "announces an image of 1024000000 bytes"), (5, "of memory for the image")):
            self.write("a.tif", tiff((256, 8), (257, 2), (258, 8), (259, packing), (262, 1), (277, 1), (322, side),
                                     (323, side), (324, 200), (325, 16)) + bytes(100_000))
            self.emulate_refuses("a.tif", part)

    def test_well_packed_images_are_not_larger_than_small_files_may_be(self):
        side = 16_000
        packer = zlib.compressobj(9)
        strip = b"".join(packer.compress(bytes(side * 100)) for _ in range(side // 100))
        strip += packer.flush()
        self.write("a.tif", tiff((256, side), (257, side), (258, 8), (259, 8), (262, 1), (273, 200), (277, 1),
                                 (278, side), (279, len(strip))) + strip)
        self.emulate_refuses("a.tif", "needs 1.2 GiB of memory for the image", "--max-memory 1280M")
        side = 4000
        self.write_png("a.png", np.zeros((side, side)))
        self.emulate_refuses("a.png", f"for frames of {side} x {side}", "--max-memory")

    def test_frames_of_videos_are_not_larger_than_small_files_may_be(self):
        subprocess.run(["ffmpeg", "-v", "error", "-f", "lavfi", "-i", "color=black:s=12000x12000",
                        "-frames:v", "1", "-c:v", "ffv1", self.folder / "a.mkv"], check=True)
        self.emulate_refuses("a.mkv", "needs 1.6 GiB of memory for a frame", "--max-memory")

    def test_frames_of_videos_do_not_grow_beyond_what_small_files_may_take(self):
        def coded(size):
            return subprocess.run(["ffmpeg", "-v", "error", "-f", "lavfi", "-i", f"color=black:s={size}", "-frames:v",
                                   "1", "-c:v", "flv", "-f", "flv", "-"], check=True, stdout=subprocess.PIPE).stdout
        large = coded("16000x7000")
        at = 13  # the first tag: its kind and its length, 11 bytes in all; data; 4 bytes
        while large[at] != 9:  # video
            at += 15 + int.from_bytes(large[at + 1:at + 4], "big")
        kept = 1000  # of the frame
        tag = b"\x09" + kept.to_bytes(3, "big") + large[at + 4:at + 11 + kept] + (11 + kept).to_bytes(4, "big")
        self.write("a.flv", coded("64x64") + tag)
        self.refuses(["a.flv: frame 1: is damaged"], "emulate", "a.flv", "-o", "x.stipple", "--transfer", "linear")

    def test_images_are_files(self):
        (self.folder / "frames").mkdir()
        (self.folder / "frames" / "a.png").symlink_to("/dev/zero")
        self.refuses(["frames/a.png", "is a device"], "emulate", "frames", "-o", "x.stipple")
        (self.folder / "frames" / "a.png").unlink()
        os.mkfifo(self.folder / "frames" / "a.png")
        self.refuses(["frames/a.png", "is a device, pipe"], "emulate", "frames", "-o", "x.stipple")
        (self.folder / "frames" / "a.png").rename(self.folder / "a.tif")
        self.emulate_refuses("a.tif", "is a device, pipe")
        self.write("clip.stipple", stream_header(4, 4))
        self.refuses(["/dev/zero", "is a device"], "decode", "clip.stipple", "-o", "x.npy",
                     "--options", "/dev/zero")

    def test_keys_of_many_parts_are_refused_wherever_they_are(self):
        key = ".".join(["a"] * 30_000)
        for text in (f"{key}=1", f"[{key}]", f"[[{key}]]", f"x={{{key}=1}}"):
            self.write("deep.toml", b"# a comment\n" + text.encode())
            for command in (("schedule", "show", "deep.toml"),
                            ("timing", "--sensor", "deep.toml"),
                            ("decode", "x.stipple", "-o", "x.npy", "--options", "deep.toml")):
                self.refuses(["deep.toml:2", "more than 32 parts"], *command)
        part = ".".join(["a" * 100] * 32)
        for text in ("x=" + f"{{{part}=" * 250 + "1" + "}" * 250,
                     f"[{'a' * 300_000}]\n" + "".join(f"k{i}=1\n" for i in range(5000))):
            self.write("deep.toml", text.encode())
            self.refuses(["deep.toml:", "longer than 256"], "schedule", "show", "deep.toml")
        self.write_flat("light.npy")
        self.refuses(["bit_depth"], "emulate", "light.npy", "-o", "x.stipple", "--set",
                     f"sensor.bit_depth={{{key}=1}}")
        self.write("deep.stipple", stream_header(8, 8, provenance=f"{key}=1".encode()) + dropped(0, 8))
        code, said = self.measured("info", "deep.stipple")
        self.assertEqual(code, OK, said)


if __name__ == "__main__":
    unittest.main()
