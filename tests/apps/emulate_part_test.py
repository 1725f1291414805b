"""Parts of an emulation, in pieces that are joined: the bytes of one run."""

import json
import os
import random
import signal
import time
import unittest

import numpy as np
from program import INPUT, USAGE, ProgramTest


class EmulatePartTest(ProgramTest):
    def write_noise(self, name, slots, *shape, kind=np.float32):
        generator = np.random.default_rng(1)
        values = generator.uniform(0, 2, (slots, *shape)) if kind == np.float32 else \
            generator.integers(0, 256, (slots, *shape))
        return self.write_array(name, values, kind)

    def emulate_part(self, part, *more, footage="light.npy"):
        return self.figures("emulate", footage, "-o", "pieces", "--part", part, *more)

    def expect_bytes_of_one_run(self, *options, footage="light.npy"):
        self.succeed("emulate", footage, "-o", "whole.stipple", *options, "--force")
        self.succeed("join", "pieces", "-o", "joined.stipple", "--force")
        self.assertEqual((self.folder / "joined.stipple").read_bytes(), (self.folder / "whole.stipple").read_bytes())

    def test_parts_in_any_order_make_the_bytes_of_one_run(self):
        # 150 slots: pieces of 64, 64 and 22.
        self.write_noise("light.npy", 150, 20, 28)
        for number, options in enumerate([
                (), ("--schedule", "tiled", "--seed", 7, "--set", "sensor.bit_depth=10"),
                ("--sensor", "lux1310", "--schedule", "hardware_tiled", "--set", "sensor.slot_us=5",
                 "--overrun", "drop"),
                ("--sensor", "grasshopper", "--set", "sensor.row_skew_slots=0.5", "--schedule", "pixel_flutter",
                 "--set", "sensor.parasitic_light_sensitivity=0.1"),
                ("--schedule", "two_bucket", "--set", "sensor.charge_stores=2"),
                ("--max-value", 1.5, "--scale", 0.7),
                ("--resample", "blend", "--frames-hz", 190)]):
            with self.subTest(options):
                for part in ("3/3", "1/3", "2/3"):
                    self.emulate_part(part, *options)
                self.expect_bytes_of_one_run(*options)
                (self.folder / "pieces").rename(self.folder / f"pieces{number}")

    def test_footage_of_each_kind_makes_the_bytes_of_one_run(self):
        self.write_noise("light.npy", 130, 12, 16, 3)
        self.succeed("emulate", "light.npy", "-o", "a.stipple", "--truth", "images")
        self.succeed("emulate", "light.npy", "-o", "b.stipple", "--truth", "video.mkv")
        (self.folder / "frames.raw").write_bytes(bytes(range(256)) * 120)
        for footage, options in (("images", ()), ("video.mkv", ("--transfer", "srgb")),
                                 ("frames.raw", ("--raw", "16x16:mono8"))):
            with self.subTest(footage):
                for part in ("2/2", "1/2"):
                    self.emulate_part(part, *options, footage=footage)
                self.expect_bytes_of_one_run(*options, footage=footage)
                (self.folder / "pieces").rename(self.folder / f"pieces_of_{footage}")

    def test_a_recording_makes_the_bytes_of_one_run(self):
        self.write_noise("light.npy", 140, 12, 16, kind=np.uint8)
        self.succeed("capture", "record", "replay:light.npy", "-o", "shot.strec", "--set",
                     "camera.AcquisitionFrameRate=0")
        for part in ("2/3", "3/3", "1/3"):
            self.emulate_part(part, footage="shot.strec")
        self.expect_bytes_of_one_run(footage="shot.strec")

    def test_killed_at_random_moments_it_goes_on_where_it_was(self):
        self.write_noise("light.npy", 1500, 40, 48)
        seed = random.randrange(1000)
        moments = random.Random(seed)
        for _ in range(6):
            before = len(list(self.folder.glob("pieces/piece_*")))
            program = self.start_program("emulate", "light.npy", "-o", "pieces", "--part", "1/1", "--threads", 1)
            deadline = time.monotonic() + 60
            while (program.poll() is None and time.monotonic() < deadline
                   and len(list(self.folder.glob("pieces/piece_*"))) < min(before + moments.randrange(4), 22)):
                time.sleep(moments.random() * 0.002)
            program.send_signal(signal.SIGKILL)
            program.communicate(timeout=60)
        kept = len(list(self.folder.glob("pieces/piece_*")))
        figures = self.emulate_part("1/1")
        self.assertEqual((figures["pieces"], figures["pieces_emulated"]), (24, 24 - kept), f"seed {seed}")
        self.assertEqual([name for name in self.names() if ".partial" in name and "piece_" in name], [])
        self.expect_bytes_of_one_run()

    def test_only_missing_and_broken_pieces_are_emulated_again(self):
        self.write_noise("light.npy", 640, 8, 8)
        self.assertEqual(self.emulate_part("1/1")["pieces_emulated"], 10)
        self.assertEqual(self.emulate_part("1/1")["pieces_emulated"], 0)
        pieces = self.folder / "pieces"
        (pieces / "piece_000002.stipple").unlink()
        (pieces / "piece_000007.stipple").write_bytes((pieces / "piece_000007.stipple").read_bytes()[:-1])
        (pieces / "piece_000009.stipple").write_bytes(b"")
        self.fails(INPUT, ["lacks 3 of its 10 pieces: piece_000002.stipple, piece_000007.stipple, "
                           "piece_000009.stipple", "emulate again"], "join", "pieces", "-o", "joined.stipple")
        self.assertEqual(self.emulate_part("1/1")["pieces_emulated"], 3)
        self.assertEqual(self.emulate_part("1/2", "--force")["pieces_emulated"], 5)
        self.expect_bytes_of_one_run()

    def test_a_damaged_piece_is_not_joined(self):
        self.write_noise("light.npy", 200, 16, 16)
        self.emulate_part("1/1")
        size = (self.folder / "pieces" / "piece_000001.stipple").stat().st_size
        self.change_byte("pieces/piece_000001.stipple", size // 2)
        self.fails(INPUT, ["piece_000001.stipple", "damaged"], "join", "pieces", "-o", "joined.stipple")
        (self.folder / "pieces" / "piece_000001.stipple").write_bytes(
            (self.folder / "pieces" / "piece_000002.stipple").read_bytes())
        self.fails(INPUT, ["piece_000001.stipple", "damaged"], "join", "pieces", "-o", "joined.stipple")

    def test_a_piece_from_elsewhere_is_emulated_again(self):
        self.write_noise("light.npy", 100, 8, 8)
        self.emulate_part("1/1")
        (self.folder / "pieces").rename(self.folder / "other")
        self.emulate_part("1/1", "--seed", 2)
        (self.folder / "other/piece_000001.stipple").replace(self.folder / "pieces/piece_000001.stipple")
        self.fails(INPUT, ["lacks 1 of its 2 pieces: piece_000001"], "join", "pieces", "-o", "joined.stipple")
        self.assertEqual(self.emulate_part("1/1", "--seed", 2)["pieces_emulated"], 1)
        self.expect_bytes_of_one_run("--seed", 2)

    def test_pieces_of_another_emulation_are_not_mixed_in(self):
        self.write_noise("light.npy", 100, 8, 8)
        self.emulate_part("1/2")
        emulate = ("emulate", "light.npy", "-o", "pieces", "--part", "2/2")
        self.fails(INPUT, ["another emulation", "set = []", "there and", "sensor.bit_depth=10"], *emulate,
                   "--set", "sensor.bit_depth=10")
        self.fails(INPUT, ["another emulation", "seed = 1", "seed = 2"], *emulate, "--seed", 2)
        self.write_noise("light.npy", 101, 8, 8)
        self.fails(INPUT, ["another emulation", "sha256"], *emulate)
        identity = self.folder / "pieces" / "emulation.json"
        described = json.loads(identity.read_text())
        self.fails(INPUT, ["lacks 1 of its 2 pieces"], "join", "pieces", "-o", "joined.stipple")
        identity.write_text(json.dumps(described | {"version": "0.0.1"}))
        self.fails(INPUT, ["another version", "0.0.1"], "join", "pieces", "-o", "joined.stipple")
        for slots in (0, -1, 1.5, 1e300, "a"):
            identity.write_text(json.dumps(described | {"slots": slots}))
            with self.subTest(slots=slots):
                self.fails(INPUT, ["emulation.json"], "join", "pieces", "-o", "joined.stipple")
        for text in ("", "[]", "{"):
            identity.write_text(text)
            self.fails(INPUT, ["does not describe an emulation"], "join", "pieces", "-o", "joined.stipple")

    def test_sensors_whose_slots_depend_on_all_before_are_refused(self):
        self.write_noise("light.npy", 70, 8, 8)
        for term in ("lag", "blooming"):
            self.fails(INPUT, [f"has {term} = 0.1", "in one run", f"sensor.{term}=0"], "emulate", "light.npy", "-o",
                       "pieces", "--part", "1/2", "--sensor", "grasshopper", "--set", f"sensor.{term}=0.1")

    def test_wrong_parts_and_options_are_usage_errors(self):
        self.write_noise("light.npy", 70, 8, 8)
        emulate = ("emulate", "light.npy", "-o", "pieces")
        for part in ("0/2", "3/2", "1", "a/b"):
            self.fails(USAGE, ["--part", "1/16"], *emulate, f"--part={part}")
        for option in (("--truth", "light"), ("--vcd", "a.vcd")):
            self.fails(USAGE, [option[0]], *emulate, "--part", "1/2", *option)
        self.fails(USAGE, ["no extension"], "emulate", "light.npy", "-o", "out.stipple", "--part", "1/2")
        os.mkfifo(self.folder / "pipe.npy")
        self.fails(INPUT, ["needs files"], "emulate", "pipe.npy", "-o", "pieces", "--part", "1/2")
        self.emulate_part("1/1")
        self.fails(USAGE, [".stipple"], "join", "pieces", "-o", "joined.npy")
        self.fails(USAGE, ["--images"], "join", "pieces", "-o", "joined.stipple", "--images", "png")


if __name__ == "__main__":
    unittest.main()
