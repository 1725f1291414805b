"""What info says of each kind of file."""

import struct
import unittest

import numpy as np
from camera_files import MOSAIC, CameraFilesTest, lsb_packed
from cine_test import Cine
from dng_test import GRBG, SHORT, dng
from fits_test import fits
from photron_test import photron_header
from program import INPUT

UNKNOWN = {"frames_hz": None, "exposure_us": None, "black_level_dn": None, "white_level_dn": None, "curve": None}


class InfoTest(CameraFilesTest):
    def expect(self, told, *arguments):
        figures = self.figures("info", *arguments)
        self.assertEqual({key: figures[key] for key in told}, told)
        return figures

    def test_arrays_and_their_light(self):
        light = np.linspace(0.25, 0.75, 3 * 4 * 5).reshape(3, 4, 5)
        for dtype, bits in (("float16", None), ("float32", None), ("float64", None)):
            name = self.write_array("a.npy", light, dtype)
            figures = self.expect({"kind": "footage", "format": ".npy file", "frames": 3, "announced_frames": 3,
                                   "width": 5, "height": 4, "planes": 1, "sample_format": dtype, "bits": bits,
                                   "cfa": "none", "gamma_coded": False, "complete": True, **UNKNOWN}, name)
            for key, value in (("min_light", 0.25), ("mean_light", 0.5), ("max_light", 0.75)):
                self.assertAlmostEqual(figures[key], value, 3)
        self.expect({"bits": 16, "sample_format": "uint16", "max_light": 1},
                    self.write_array("b.npy", np.full((2, 4, 5, 3), 65535), "uint16"))
        said = self.succeed("info", "b.npy")
        for part in ("5 x 4 x 3 (width x height x planes), 2 of them", "rate         not declared",
                     "complete, all frames are read"):
            self.assertIn(part, said)
        for name in ("exposure", "levels", "filter"):
            self.assertNotIn(name, said)

    def test_the_header_alone(self):
        self.write_flat("a.npy", slots=7)
        self.expect({"announced_frames": 7, "frames": None, "mean_light": None, "complete": False}, "a.npy", "--header")
        self.assertIn("7 announced", self.succeed("info", "a.npy", "--header"))

    def test_files_of_cameras(self):
        camera = {"width": 8, "height": 6, "frames": 4, "frames_hz": 5000, "exposure_us": 190}
        self.write("a.cine", Cine(MOSAIC, filter=4, compression=2, levels=(64, 4000)).content())
        self.expect({"format": ".cine file", "bits": 12, "black_level_dn": 64, "white_level_dn": 4000, "cfa": "rggb",
                     "curve": "linear", **camera}, "a.cine")
        self.write("b.cine", Cine(MOSAIC % 1024, packing=256, bits=10).content())
        self.expect({"bits": 10, "black_level_dn": 63, "white_level_dn": 1014, "curve": "bt709", "gamma_coded": False,
                     **camera}, "b.cine")
        self.assertIn("bt709, undone in reading", self.succeed("info", "b.cine"))
        self.write("c.mraw", MOSAIC.astype("<u2").tobytes())
        self.write("c.cihx", photron_header(bits=16, depth=12))
        self.expect({"format": ".mraw file", "bits": 12, "white_level_dn": 4095, **camera}, "c.mraw")
        self.write("d.fits", fits(MOSAIC, 16))
        self.expect({"format": ".fits file", "bits": 16, "sample_format": "BITPIX 16", "frames": 4}, "d.fits")

    def test_images(self):
        for slot in range(2):
            tags = GRBG | {50714: (SHORT, [100]), 50717: (SHORT, [4000])}
            self.write(f"raw/{slot}.dng", dng(MOSAIC[slot], tags=tags))
            self.write_png(f"grey/{slot}.png", MOSAIC[slot] % 256)
            self.write_png(f"srgb/{slot}.png", np.zeros((4, 5, 3)), [(b"sRGB", b"\0")])
            self.write_png(f"half/{slot}.png", np.zeros((4, 5)), [(b"gAMA", struct.pack(">I", 50000))])
        self.expect({"format": "DNG images", "frames": 2, "bits": 16, "cfa": "grbg", "black_level_dn": 100,
                     "white_level_dn": 4000, "curve": "linear"}, "raw")
        self.expect({"format": "PNG images", "bits": 8, "planes": 1, "gamma_coded": False, "curve": None}, "grey")
        self.expect({"planes": 3, "gamma_coded": True, "curve": "srgb"}, "srgb/%d.png")
        self.expect({"gamma_coded": True, "curve": "power 0.5"}, "half")
        self.expect({"format": "PNG image", "frames": 1}, "grey/0.png")
        self.succeed("synth", "still", "-o", "scene", "--frames", 2, "--size", "16x8")
        self.expect({"format": "EXR images", "sample_format": "float32", "bits": None, "width": 16, "height": 8},
                    "scene")

    def test_video(self):
        self.succeed("synth", "still", "-o", "a.mkv", "--frames", 3, "--size", "16x8")
        self.expect({"format": "video", "frames": 3, "frames_hz": 30, "bits": 8, "sample_format": "yuv420p",
                     "gamma_coded": True}, "a.mkv")
        self.write("b.y4m", b"YUV4MPEG2 W8 H6 F25:1 Cmono\n" + 2 * (b"FRAME\n" + bytes(48)))
        self.expect({"format": "video", "frames": 2, "frames_hz": 25, "planes": 1}, "b.y4m")

    def test_frames_without_a_header(self):
        self.write("a.bin", lsb_packed(MOSAIC, 12))
        self.expect({"format": "frames without a header", "sample_format": "Mono12p", "bits": 12, "frames": 4,
                     "black_level_dn": 64, "white_level_dn": 4095, "frames_hz": 1000}, "a.bin", "--raw",
                    "8x6:mono12p:black=64:hz=1000")
        self.fails(INPUT, ["a.bin: is not a file type stipple can read", "--raw"], "info", "a.bin")

    def test_unknown_files_are_named_by_their_first_bytes(self):
        for content, kind in ((b"", "an empty file"), (b"\n <!DOCTYPE HTML>\n<html>", "a web page (HTML)"),
                              (b"time,light\r\n0,1\r\n", 'text that begins "time,light"'),
                              (("\u00b5 " * 50).encode(), 'text that begins "\u00b5 \u00b5'),
                              (b"PK\3\4" + bytes(80), "a ZIP archive"),
                              (b"\x89\0\x1b" + bytes(80), "the bytes 89 00 1b 00 00 00 00 00")):
            for name in ("a.dat", "noextension"):
                self.write(name, content)
                said = self.fails(INPUT, [f"{name}: is not a file type stipple can read: it is ", kind,
                                          "not a sample stream"], "info", name)
                self.assertEqual(said.count("\n"), 1, said)

    def test_damage_ends_it_after_what_was_found(self):
        self.write("a.y4m", b"YUV4MPEG2 W8 H6 F25:1 Cmono\n" + 2 * (b"FRAME\n" + bytes(48)) + b"FRAME\n" + bytes(9))
        done = self.run_program("info", "a.y4m")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("25 per second", done.stdout)
        self.assertIn("a.y4m: ends within frame 2", done.stderr)
        self.assertNotIn("condition", done.stdout)

    def test_streams_and_recordings_are_known_by_their_content(self):
        self.write_stream("clip.stipple")
        (self.folder / "clip.stipple").rename(self.folder / "clip.npy")
        self.expect({"kind": "stream", "slots": 30}, "clip.npy")

        self.fails(INPUT, ["clip.npy: --header applies to footage only"], "info", "clip.npy", "--header")

    def test_sensors(self):
        figures = self.expect({"kind": "sensor", "name": "imx273"}, "imx273")
        keys = {row["name"]: (row["value"], row["unit"]) for row in figures["keys"]}
        self.assertEqual(keys["bit_depth"], ("12", "bits"))
        self.assertEqual(keys["full_scale_e"], ("10000", "electrons"))
        self.assertNotIn("prnu", keys, "of mode physical")
        derived = {row["name"]: float(row["value"]) for row in figures["derived"]}
        self.assertAlmostEqual(derived["gain_e_per_dn"], 10000 / 4095, 4)
        self.assertEqual({key: figures["timing"][key] for key in ("width", "height", "clock_hz")},
                         {"width": 1408, "height": 1080, "clock_hz": 74250000})
        timing = {row["name"]: (row["value"], row["unit"]) for row in figures["timing"]["keys"]}
        self.assertEqual(timing["code_bit_pj"], ("4.7", "pJ"))
        self.assertEqual(timing["clock_hz"], ("74250000", "Hz"))
        self.write("own.toml", b'mode = "physical"\nprnu = 0.02\nbit_depth = 10\n')
        figures = self.expect({"kind": "sensor", "timing": None}, "own.toml")
        keys = {row["name"]: row["value"] for row in figures["keys"]}
        self.assertEqual((keys["prnu"], keys["bit_depth"]), ("0.02", "10"))

    def test_schedules(self):
        figures = self.expect({"kind": "schedule", "schedule_kind": "flutter", "charge_stores": 2,
                               "array": {"width": 640, "height": 480}}, "two_bucket")
        verdicts = {row["sensor"]: row["problem"] for row in figures["sensors"]}
        self.assertEqual(set(verdicts), {row["name"] for row in self.figures("list", "sensors")["sensors"]})
        self.assertIn("charge store", verdicts["paper"])
        self.assertEqual(verdicts["t6"], "")
        shown = self.figures("schedule", "show", "tiled")
        figures = self.figures("info", "tiled")
        self.assertEqual({key: figures[key] for key in shown}, shown)
        self.succeed("schedule", "compile", "tiled", "-o", "tiled.mem")
        self.expect({"kind": "schedule", "schedule_kind": "compiled", "period_slots": shown["period_slots"]},
                    "tiled.mem")

    def test_spaces_of_explore(self):
        figures = self.expect({"kind": "space", "points": 46, "frames": 36,
                               "scene": {"width": 128, "height": 96, "planes": 1},
                               "readout": {"width": None, "height": None, "sensor": "lux1310"}}, "rivals")
        axes = {axis["name"]: axis["values"] for axis in figures["axes"]}
        self.assertEqual((axes["sensor"], len(axes["system"])), (["paper_black"], 46))
        self.assertNotIn("method", axes, "the systems set it")
        self.assertEqual(figures["systems"][0],
                         {"name": "coded best", "values": {"schedule": "random", "method": "best"}})
        space = b'[axes]\nsensor = ["paper", "t6"]\n[set]\n"sensor.slot_us" = { from = 100, to = 900, count = 9 }\n'
        self.write("own.toml", space)
        for part in ("own.toml: 18 points", "paper, t6", "100, 200, 300, 400, 500, 600, ... 900 (9 values)"):
            self.assertIn(part, self.succeed("info", "own.toml"))
        for content, problem in ((space + b"colour = 1\n", "set.colour: begins neither with sensor."),
                                 (b"[axes]\nseed = 1\n", "axes.sensor: is missing"),
                                 (b"[[systems]]\nname = 1\n", "axes.sensor: is missing")):
            self.write("bad.toml", content)
            self.fails(INPUT, ["bad.toml: " + problem], "info", "bad.toml")

    def test_scenes_and_names(self):
        self.expect({"kind": "scene", "name": "pan", "width": 320, "height": 240, "frames": 48}, "pan")
        self.fails(INPUT, ["nd_mosaic", "sensor and of a schedule", "schedules/nd_mosaic.toml"], "info", "nd_mosaic")
        self.write("camera.toml", b"Gain = 3\n")
        self.fails(INPUT, ["camera.toml: holds the keys of neither"], "info", "camera.toml")
        self.fails(INPUT, ["nothing.npy"], "info", "nothing.npy")


if __name__ == "__main__":
    unittest.main()
