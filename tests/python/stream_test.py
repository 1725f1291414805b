"""What a stream tells is what the program tells, and what its schedule says."""

import multiprocessing
import os
import pickle
import struct
import unittest

import numpy as np
import stipple
from program import ProgramTest


def crc32c(data, seed=0):
    crc = seed ^ 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0x82F63B78 * (crc & 1)
    return crc ^ 0xFFFFFFFF


class StreamTest(ProgramTest):
    def test_the_same_samples_are_the_same_bytes(self):
        light = np.random.default_rng(1).random((20, 9, 13), dtype=np.float32)
        first, second = stipple.emulate(light), stipple.emulate(light)
        for slot in range(20):
            self.assertEqual(first.samples(slot).tobytes(), second.samples(slot).tobytes())

    def test_header_and_counts_are_those_of_info(self):
        self.write_array("light.npy", np.full((20, 8, 12, 3), 0.3))
        for options in ((), ("--sensor", "t6"), ("--sensor", "nd_mosaic", "--schedule", "nd_mosaic")):
            with self.subTest(options):
                self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--force", *options)
                info = self.figures("info", "clip.stipple")
                stream = stipple.Stream.open(self.folder / "clip.stipple")
                told = stream.header | stream.counts()
                self.assertEqual(told, {key: info[key] for key in told})
                self.assertEqual(set(info) - set(told),
                                 {"kind", "stretched_slots", "mean_stretched_us", "command", "calibration_file"})

    def test_a_slot_holds_the_samples_whose_exposures_end_in_it(self):
        stream = stipple.emulate(np.full((25, 6, 10, 3), 0.2), schedule="tiled")
        period, tile = 15, 16
        due = {slot: [] for slot in range(25)}
        for row, col, first, mask in stream.exposures().tolist():
            for begin in range(first, 25, period):
                end = begin + mask.bit_length() - 1
                if end < 25 and row < 6 and col < 10:
                    due[end] += [(row, col, plane, mask.bit_length(), mask.bit_count())
                                 for plane in range(3)]
        self.assertEqual(stream.header["schedule"]["period_slots"], period)
        self.assertEqual(stream.header["schedule"]["tile_rows"], tile)
        for slot in (24, 3, 3, 4, 5, 0, *range(25)):  # in any order
            samples = stream.samples(slot)
            fields = samples[["row", "col", "plane", "exposure_slots", "light_slots"]]
            self.assertEqual(fields.tolist(), sorted(due[slot]))
            expected = 1000 * 0.2 * samples["light_slots"] * 255 / 2000  # Eq. 1 without noise
            self.assertLess(abs(samples["dn"] - expected).max(initial=0), 30)

    def test_across_a_switch_each_slot_of_a_pixel_is_in_one_exposure(self):
        self.write_array("light.npy", np.full((60, 8, 12), 0.1))
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--switch", "20:schedule=tiled,seed=3",
                     "--switch", "24:seed=4")
        stream = stipple.Stream.open(self.folder / "clip.stipple")
        begin = np.zeros((8, 12), int)
        for slot, samples in enumerate(stream):
            at = samples["row"], samples["col"]
            first = slot + 1 - samples["exposure_slots"].astype(int)
            self.assertTrue((first[begin[at] > 0] == begin[at][begin[at] > 0]).all())
            self.assertTrue((samples["light_slots"] == samples["exposure_slots"]).all())
            begin[at] = slot + 1
        self.assertTrue((begin > 50).all())
        self.assertTrue(stream.counts()["complete"])
        with self.assertRaisesRegex(ValueError, "may change its schedule"):
            stream.exposures()

    def test_switches_are_those_of_the_program(self):
        self.write_array("light.npy", np.full((60, 8, 12), 0.1))
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--switch", "20:schedule=tiled,seed=3",
                     "--switch", "24:sensor.full_scale_e=4000")
        clip = stipple.Stream.open(self.folder / "clip.stipple")
        stream = stipple.emulate(self.folder / "light.npy", switches={
            24: {"sensor": stipple.Sensor("paper", {"full_scale_e": 4000})}, 20: {"schedule": "tiled", "seed": 3}})
        for ours, theirs in zip(stream, clip):
            np.testing.assert_array_equal(ours, theirs)
        self.assertEqual(stream.slots(), clip.slots())
        for switches, text in (({0: {"seed": 2}}, "slot 0"), ({5: {"gain": 2}}, "gain"), ({5: {"sensor": "lux1310"}}, "only schedule"),
                               ({5: {"schedule": "two_bucket"}}, "interleaved")):
            with self.assertRaisesRegex(ValueError, text):
                stipple.emulate(np.full((9, 8, 12), 0.1), switches=switches)

    def test_all_samples_are_those_of_the_slots(self):
        light = np.random.default_rng(1).random((40, 9, 13), dtype=np.float32)
        stream = stipple.emulate(light, schedule="tiled")
        for first, end in ((0, 40), (17, 23), (39, 40)):
            samples = stream.samples(range(first, end))
            np.testing.assert_array_equal(samples, np.concatenate([stream.samples(slot) for slot in range(first, end)]))
        self.assertEqual(stream.samples().tobytes(), stream.samples(range(40)).tobytes())
        stream.save(self.folder / "clip.stipple")
        file = stipple.Stream.open(self.folder / "clip.stipple")
        np.testing.assert_array_equal(file.samples(range(20, 30)), stream.samples(range(20, 30)))
        first = file.samples(3)
        file.samples()
        np.testing.assert_array_equal(file.samples(3), first)

    def test_samples_add_up_the_light_of_their_open_slots(self):
        light = np.random.default_rng(1).random((30, 8, 12), dtype=np.float32)
        for schedule in ("tiled", "pixel_flutter", "two_bucket"):
            sensor = stipple.Sensor("ideal", {"charge_stores": 2}) if schedule == "two_bucket" else "ideal"
            stream = stipple.emulate(light, sensor, schedule)
            samples = stream.samples()
            open_slots = samples["open_slots"][:, None] >> np.arange(64, dtype=np.uint64) & 1
            np.testing.assert_array_equal(open_slots.sum(axis=1), samples["light_slots"])
            slots = samples["slot"] + 1 - samples["exposure_slots"]
            slots = np.minimum(slots[:, None] + np.arange(64), 29)
            sums = (light[slots, samples["row"][:, None], samples["col"][:, None]] * open_slots).sum(axis=1)
            c = stream.header["calibration"]
            step = c["gain_e_per_dn"] / c["electrons_per_unit"]
            self.assertFalse(samples["saturated"].any())
            self.assertLess(np.abs((samples["dn"] - c["black_level_dn"]) * step - sums).max(), 0.501 * step)

    def test_saturated_samples_are_marked(self):
        light = np.full((20, 4, 6), 0.1, np.float32)
        light[:, 2] = 100
        with self.assertWarnsRegex(UserWarning, "mean light"):
            samples = stipple.emulate(light, "ideal", "tiled").samples()
        np.testing.assert_array_equal(samples["saturated"], samples["row"] == 2)

    def test_ranges_that_there_are_not_are_refused(self):
        stream = stipple.emulate(np.full((5, 6, 10), 0.2))
        for slots, error, text in ((range(3, 6), IndexError, "slots 3 to 5: the stream holds 5"), (range(2, 2), ValueError, "holds no slot"),
                                   (range(-1, 3), ValueError, "slots: -1 is outside"), (range(0, 4, 2), TypeError, "is not range"),
                                   ("all", TypeError, "is not range"), (1.5, TypeError, "")):
            with self.subTest(slots), self.assertRaisesRegex(error, text):
                stream.samples(slots)
        large = stipple.emulate(np.full((20, 100, 100), 0.2), schedule="tiled")
        with stipple.MaxMemory("1M"), self.assertRaisesRegex(ValueError, "needs .* of memory for the samples"):
            large.samples()

    def test_a_slot_beyond_the_end_is_an_IndexError(self):
        stream = stipple.emulate(np.full((5, 6, 10), 0.2))
        for slot in (-1, 5):
            with self.assertRaisesRegex(IndexError, "the stream holds 5"):
                stream.samples(slot)

    def test_a_damaged_slot_lacks_its_samples(self):
        self.write_stream()
        self.change_byte("clip.stipple", (self.folder / "clip.stipple").stat().st_size // 2)
        stream = stipple.Stream.open(self.folder / "clip.stipple")
        counts = stream.counts()
        self.assertEqual(counts["missing_slots"], 1)
        self.assertTrue(counts["damage"])
        self.assertEqual(sum(len(stream.samples(slot)) for slot in range(stream.slots())),
                         counts["samples"])

    def test_an_interrupted_stream_is_read_as_far_as_it_goes(self):
        self.write_stream()
        path = self.folder / "clip.stipple"
        path.write_bytes(path.read_bytes()[:-400])
        stream = stipple.Stream.open(path)
        counts = stream.counts()
        self.assertFalse(counts["complete"])
        self.assertEqual(stream.slots(), counts["slots"])

    def test_slots_that_the_index_does_not_count_are_damage(self):
        path = self.folder / self.write_stream(slots=30)
        content = path.read_bytes()
        begin, seed = struct.unpack("<Q", content[-16:-8])[0], content[struct.unpack("<I", content[12:16])[0] - 4:][:4]
        entries = content[begin + 36:][:16 * 20]
        index = content[begin:begin + 8] + struct.pack("<QHHIII", 20, 0, 0, 20, len(entries), crc32c(entries))
        marker = content[-20:-4]
        for head, payload in ((index, entries), (marker, b"")):
            content = content[:begin] + head + struct.pack("<I", crc32c(head, *struct.unpack("<I", seed))) + payload
            begin = len(content)
        path.write_bytes(content)
        stream = stipple.Stream.open(path)
        self.assertEqual(stream.slots(), 20)
        counts = stream.counts()
        self.assertEqual((counts["slots"], counts["samples"]), (20, sum(map(len, stream))))
        self.assertEqual(counts["damage"][0]["cause"], "slot 20 is not one of the 20 in the index")

    def test_is_a_sequence_of_slots(self):
        stream = stipple.emulate(np.full((7, 6, 10), 0.2))
        self.assertEqual(len(stream), 7)
        for slot, samples in enumerate(stream):
            np.testing.assert_array_equal(samples, stream.samples(slot))
        self.assertEqual(slot, 6)

    def test_says_what_it_holds(self):
        for slots, said in ((1, "1 slot of"), (2, "2 slots of")):
            stream = stipple.emulate(np.full((slots, 6, 4, 3), 0.2))
            self.assertEqual(repr(stream), f"<stipple.Stream (temporary): {said} 4 x 6 x 3>")

    def test_is_closed_after_its_block(self):
        files = set(os.listdir("/proc/self/fd"))
        with stipple.emulate(np.full((5, 6, 10), 0.2)) as stream:
            self.assertEqual(len(stream), 5)
        self.assertEqual(set(os.listdir("/proc/self/fd")), files)
        self.assertEqual(repr(stream), "<stipple.Stream (temporary): closed>")
        for use in (stream.counts, lambda: stream.samples(0), lambda: stream.save(self.folder / "a"), stream.exposures,
                    lambda: stream.header, lambda: stipple.decode(stream)):
            with self.assertRaisesRegex(ValueError, "stream: is closed"):
                use()
        stream.close()

    def test_is_pickled_by_its_path(self):
        stream = stipple.emulate(np.full((5, 6, 10), 0.2))
        for use in (pickle.dumps, os.fspath):
            with self.assertRaisesRegex(ValueError, "stream: is in a temporary file"):
                use(stream)
        self.write_stream()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        stream = stipple.Stream.open("clip.stipple")
        with multiprocessing.get_context("spawn").Pool(1, initializer=os.chdir, initargs=("/",)) as pool:
            decoded = pool.apply(stipple.decode, (stream, "naive"))
        np.testing.assert_array_equal(decoded, stipple.decode(stream, "naive"))

    def test_an_object_that_no_constructor_made_is_a_TypeError(self):
        for kind in (stipple.Stream, stipple.Sensor, stipple.Schedule, stipple.Frame, stipple.Recording, stipple.MaxMemory,
                     stipple.ComparedVideos):
            made = kind.__new__(kind)
            for name in set(dir(kind)) & {"samples", "slots", "bit_depth", "tile", "dn", "features", "__enter__", "psnr_db"}:
                with self.subTest(kind, name=name), self.assertRaisesRegex(TypeError, "an object without a value"):
                    value = getattr(made, name)
                    if name == "__enter__" and kind is stipple.Stream:
                        made.slots()
                    value(0) if name == "samples" else value()
        with self.assertRaisesRegex(TypeError, "without a value"):
            stipple.emulate(np.full((5, 6, 10), 0.2), stipple.Sensor.__new__(stipple.Sensor))

    def test_does_not_replace_a_file_unless_told(self):
        self.write_stream()
        path = self.folder / "clip.stipple"
        before = path.read_bytes()
        stream = stipple.emulate(np.full((5, 6, 10), 0.2))
        with self.assertRaisesRegex(FileExistsError, "clip.stipple: exists already"):
            stream.save(path)
        self.assertEqual(path.read_bytes(), before)
        stream.save(path, force=True)
        self.assertEqual(stipple.Stream.open(path).slots(), 5)

    def test_opens_streams_only(self):
        self.write_flat("light.npy")
        with self.assertRaisesRegex(ValueError, "light.npy"):
            stipple.Stream.open(self.folder / "light.npy")
        with self.assertRaises(IsADirectoryError):
            stipple.Stream.open(self.folder)


if __name__ == "__main__":
    unittest.main()
