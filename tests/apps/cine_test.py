""".cine files of Phantom cameras: the light of each number, what the camera tells, what is refused."""

import shutil
import struct
import subprocess
import unittest

import numpy as np
from camera_files import MOSAIC, CameraFilesTest, msb_packed
from program import INPUT


class Cine:
    """Writes .cine files of Phantom cameras by the offsets of FFmpeg's reader (libavformat/cinedec.c)."""

    def __init__(self, frames, **what):
        self.slots, self.rows, self.cols = frames.shape
        self.bits, self.packing, self.real_bits, self.compression = 16, 0, 12, 0
        self.filter, self.flip, self.levels, self.hz, self.exposure_ns = 0, 0, (0, 0), 5000, 190000
        self.annotation, self.setup_bytes, self.images = 8, 5740, self.slots
        self.seconds, self.exposed_s, self.mirrored, self.turned, self.bright_ns = (), (), 0, 0, 0
        self.__dict__.update(what)
        rows = frames if self.packing else frames[:, ::-1]
        if self.flip:
            rows = rows[:, ::-1]
        pack = {256: 10, 1024: 12}
        self.payload = [msb_packed(frame, pack[self.packing]) if self.packing else
                        frame.astype("u1" if self.bits == 8 else "<u2").tobytes() for frame in rows]

    def content(self):
        setup = bytearray(self.setup_bytes)
        for offset, form, value in ((140, "2s", b"ST"), (142, "H", self.setup_bytes), (756, "I", self.mirrored),
                                    (760, "I", self.flip), (884, "i", self.turned), (1572, "I", self.bright_ns),
                                    (768, "I", self.hz), (808, "I", self.filter), (896, "I", self.real_bits),
                                    (1568, "I", self.exposure_ns), (5732, "2i", self.levels)):
            if offset + 8 <= len(setup) or offset < 1572:
                struct.pack_into("<" + form, setup, offset, *(value if isinstance(value, tuple) else (value,)))
        bitmap = struct.pack("<IiiHHIIiiII", 40, self.cols, self.rows, 1, self.bits, self.packing,
                             len(self.payload[0]), 0, 0, 0, 0)
        ticks = [[round(time * 2 ** 32) for time in times] for times in (self.seconds, self.exposed_s)]
        tags = struct.pack("<IHH", 12, 1001, 0) + b"more"
        for kind, form, numbers in ((1002, "Q", ticks[0]), (1003, "I", ticks[1])):
            numbers = struct.pack(f"<{len(numbers)}{form}", *numbers)
            tags += struct.pack("<IHH", 8 + len(numbers), kind, 0) + numbers if numbers else b""
        setup += tags
        offsets_at = 84 + len(setup)
        offsets, records = [], b""
        for payload in self.payload:
            offsets.append(offsets_at + 8 * self.slots + len(records))
            records += struct.pack("<I", self.annotation) + bytes(self.annotation - 8)
            records += struct.pack("<I", len(payload)) + payload
        header = struct.pack("<2sHHHiIiIIIIQ", b"CI", 44, self.compression, 1, -7, self.images, -7, self.images, 44, 84,
                             offsets_at, 0)
        return header + bitmap + bytes(setup) + struct.pack(f"<{self.slots}Q", *offsets) + records


class CineTest(CameraFilesTest):
    def cine(self, frames=MOSAIC, **what):
        return self.write("clip.cine", Cine(frames, **what).content())

    def test_depths_and_packings(self):
        for most, what in ((255, {"bits": 8, "real_bits": 8}), (4095, {}), (65535, {"real_bits": 16}),
                           (4095, {"packing": 1024, "bits": 12}), (4095, {"annotation": 24}), (4095, {"flip": 1}),
                           (4095, {"packing": 1024, "flip": 1}), (4095, {"setup_bytes": 1572})):
            with self.subTest(**what):
                values = MOSAIC % (most + 1)
                self.assert_light(values / most, self.cine(values, **what), "--set", "sensor.slot_us=200")
                self.assertEqual(self.said, "")

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_ffmpeg_reads_the_same_numbers(self):
        for pixels, what in (("gray16le", {}), ("gray16le", {"flip": 1}), ("gray", {"bits": 8, "real_bits": 8}),
                             ("bayer_gbrg16le", {"compression": 2, "filter": 3}),
                             ("bayer_rggb16le", {"compression": 2, "filter": 4})):
            with self.subTest(**what):
                values = MOSAIC % 256 if pixels == "gray" else MOSAIC
                name = self.cine(values, **what)
                frames = subprocess.run(["ffmpeg", "-v", "error", "-i", name, "-f", "rawvideo", "-pix_fmt", pixels,
                                         "-"], cwd=self.folder, capture_output=True, check=True).stdout
                read = np.frombuffer(frames, "u1" if pixels == "gray" else "<u2").reshape(values.shape)
                # ffmpeg shifts 12 bits to the top of 16.
                self.assert_light(read / 255 if pixels == "gray" else (read >> 4) / 4095, name)

    def test_levels_that_the_file_declares(self):
        self.assert_light(np.maximum(MOSAIC - 100, 0) / 3900, self.cine(levels=(100, 4000)))
        for levels in ((100, 100), (-5, 4000), (0, 5000)):  # of no use
            self.assert_light(MOSAIC / 4095, self.cine(levels=levels))

    def test_another_black_level_than_that_of_the_sensor_is_said(self):
        name = self.cine(levels=(100, 4000))
        self.light(name, "--sensor", "grasshopper")
        self.assertIn('its black level is 100 DN, that of sensor "grasshopper" 64 DN, both of 12 bits', self.said)
        self.light(name, "--sensor", "grasshopper", "--set", "sensor.black_level_dn=100")
        self.assertNotIn("black level", self.said)

    def test_ten_bits_are_companded_by_the_published_table(self):
        # Of 12 bits, black 64 and white 4064 (pycine).
        table = {64: 64, 96: 94, 160: 156, 256: 290, 384: 578, 512: 998, 768: 2267, 896: 3130, 1008: 4014, 1014: 4064}
        light = self.light(self.cine(np.array([[[0, 1, *table]]]), packing=256, bits=10)).ravel()
        np.testing.assert_allclose(light[2:], (np.array(list(table.values())) - 64) / 4000, atol=1.3 / 4000)
        self.assertEqual(list(light[:2]), [0, 0])

    def test_rate_and_exposure(self):
        self.light(self.cine(hz=1000, exposure_ns=990000))
        self.assertIn("has 1000 frames/s, but a slot of sensor \"paper\" takes 5000 us", self.said)
        self.assertNotIn("exposed", self.said)
        self.light(self.cine(hz=1000, exposure_ns=250000), "--set", "sensor.slot_us=1000")
        self.assertIn("its frames were exposed for 250 of 1000 us each", self.said)
        self.light(self.cine(hz=0, exposure_ns=0))
        self.assertEqual(self.said, "")

    def test_time_stamps_are_the_rate_where_frames_were_left_out_at_saving(self):
        for declared, stamped in ((90000, 9000), (1000, 250), (0, 500), (200, 1000)):
            with self.subTest(declared=declared, stamped=stamped):
                name = self.cine(hz=declared, exposure_ns=0, seconds=[1.6e9 + i / stamped for i in range(4)])
                self.assertAlmostEqual(self.figures("info", name)["frames_hz"] / stamped, 1, delta=1e-4)
                self.light(name)
                said = f"declares {declared} frames per second, but its time stamps are {1 / stamped:.4g} s apart"
                self.assertEqual(said in self.said, declared > 0)

    def test_time_stamps_that_agree_but_for_their_rounding_leave_the_rate(self):
        for hz in (1000, 35087, 400000):
            name = self.cine(hz=hz, exposure_ns=0, seconds=[1.6e9 + round(i / hz, 6) for i in range(4)])
            self.assertEqual(self.figures("info", name)["frames_hz"], hz)
            self.light(name)
            self.assertNotIn("time stamps", self.said)

    def test_unequal_time_stamps_are_said(self):
        frames = np.repeat(MOSAIC, 2, axis=0)
        times = [i / 1000 for i in (0, 1, 2, 3, 7, 8, 9, 10)]
        name = self.cine(frames, hz=1000, seconds=times)
        self.assertEqual(self.figures("info", name)["frames_hz"], 1000)
        self.light(name)
        self.assertIn("clip.cine: its frames are 0.001 to 0.004 s apart, but each becomes one slot", self.said)
        self.assertNotIn("declares", self.said)
        light = self.light(name, "--resample", "hold", "--set", "sensor.slot_us=1000")
        self.assertNotIn("apart", self.said)
        np.testing.assert_allclose(light, frames[[0, 1, 2, 3, 3, 3, 3, 4, 5, 6, 7]] / 4095, rtol=1e-6)
        self.light(self.cine(frames, hz=1000, seconds=times[::-1]))
        self.assertIn("its time stamps do not increase; they are left out", self.said)
        self.light(self.cine(frames, hz=1000, seconds=times[:5]))
        self.assertIn("holds times of 5 frames in place of 8; they are left out", self.said)

    def test_what_is_declared_and_not_applied_is_said(self):
        for part, what in (("its frames were exposed for 100 to 150 us", {"exposed_s": [1e-4, 1.5e-4, 1e-4, 1e-4]}),
                           ("bright pixels were exposed for 20 of 190 us", {"bright_ns": 20000}),
                           ("is to be shown mirrored", {"mirrored": 1}), ("is to be shown turned", {"turned": -90})):
            with self.subTest(**what):
                self.light(self.cine(**what))
                self.assertIn(part, self.said)
        self.light(self.cine(hz=0, exposed_s=[1e-4] * 4, bright_ns=190000))
        self.assertEqual(self.said, "")

    def test_a_mosaic_keeps_its_filters(self):
        name = self.cine(compression=2, filter=3, hz=200, exposure_ns=0)
        self.assert_light(MOSAIC / 4095, name, "--set", "sensor.mode=physical", "--set", "sensor.cfa=gbrg")
        self.assertEqual(self.said, "")
        self.refuse(["no --luminance"], name, "--luminance")

    def test_a_replay_plays_a_mosaic_as_what_it_is(self):
        """Its colours come back from a sensor with that array, as from `emulate`; another array is refused."""
        name = self.cine(np.repeat(MOSAIC[:1], 12, axis=0), compression=2, filter=3, hz=200, exposure_ns=0)
        sensor = ["--sensor", "ideal", "--schedule", "full1x", "--set", "sensor.cfa=gbrg"]
        fast = ["--set", "camera.AcquisitionFrameRate=0", "--buffers", 1024]
        self.succeed("emulate", name, "-o", "a.stipple", *sensor)
        self.succeed("capture", "live", "replay:" + name, "-o", "b.stipple", *sensor, *fast)
        for clip in "ab":
            self.assertEqual(self.figures("info", clip + ".stipple")["cfa"], "gbrg")
            self.succeed("decode", clip + ".stipple", "-o", clip + ".npy", "--method", "naive")
        self.assertEqual(self.array("b.npy").shape, (12, 6, 8, 3))
        # Two roundings of 16 bits, of the replay and of the sensor, whose full scale is 16 times light 1.0.
        np.testing.assert_allclose(self.array("b.npy"), self.array("a.npy"), atol=20 / 65535)
        other = [*sensor[:-1], "sensor.cfa=rggb"]
        self.fails(INPUT, ["gbrg"], "capture", "live", "replay:" + name, "-o", "c.stipple", *other, *fast)
        self.succeed("capture", "record", "replay:" + name, "-o", "clip.strec", *fast)
        self.assertEqual(self.figures("info", "clip.strec")["format"], "BayerGB16")
        self.fails(INPUT, ["PixelFormat: the footage is a mosaic that begins as gbrg"], "capture", "record",
                   "replay:" + name, "-o", "d.strec", "--set", "camera.PixelFormat=BayerRG16", *fast)
        self.succeed("capture", "record", "replay:" + name, "-o", "e.strec", "--set", "camera.PixelFormat=Mono16",
                     *fast)

    def test_kinds_that_are_not_read(self):
        for parts, what in ((["is compressed (kind 1)"], {"compression": 1}),
                            (["24 bits per pixel in packing 0"], {"bits": 24}), (["packing 77"], {"packing": 77}),
                            (["says that 8 of 16 bits"], {"real_bits": 8}),
                            (["colour filter array of kind 1"], {"compression": 2, "filter": 1}),
                            (["holds no frame"], {"images": 0})):
            with self.subTest(**what):
                content = Cine(MOSAIC, **{key: what[key] for key in what if key not in ("packing", "bits")})
                content.__dict__.update(what)
                self.refuse(parts, self.write("clip.cine", content.content()))
        self.refuse(["end within a byte"], self.cine(MOSAIC[:, :, :7], packing=1024, bits=12))
        self.refuse(["does not begin with"], self.write("clip.cine", bytes(100)))
        self.fails(INPUT, ["clip.cine: byte 84: has an unsupported camera SETUP"], "emulate", self.write(
            "clip.cine", Cine(MOSAIC).content().replace(b"ST", b"XX")), "-o", "x.stipple")

    def test_damage(self):
        whole = Cine(MOSAIC).content()
        for length in (0, 43, 60, 100, 5000, 5830, len(whole) - 1):
            with self.subTest(length=length):
                said = self.fails(INPUT, ["clip.cine: "], "emulate", self.write("clip.cine", whole[:length]), "-o", "x")
                self.assertIn("damaged or cut short", said)
        self.refuse(["announces 4000000000 frames"], self.cine(images=4_000_000_000))
        start = len(whole) - 4 * (8 + 96)
        for field, value in ((0, 7), (0, 2 ** 32 - 1), (4, 95)):
            content = bytearray(whole)
            struct.pack_into("<I", content, start + field, value)
            with self.subTest(field=field, value=value):
                self.fails(INPUT, ["clip.cine"], "emulate", self.write("clip.cine", content), "-o", "x.stipple")


if __name__ == "__main__":
    unittest.main()
