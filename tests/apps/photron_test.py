""".mraw files of Photron cameras: the light of each number, what the header tells, what is refused."""

import unittest

from camera_files import MOSAIC, CameraFilesTest, msb_packed
from program import INPUT


def photron_header(kind="cihx", **changed):
    """A header in the forms of Photron's viewer: `shutter` is the N of 1/N s, `ns` the same in nanoseconds."""
    values = {"format": "MRaw", "frames": 4, "width": 8, "height": 6, "colour": "Mono", "bits": 12, "depth": 12,
              "side": "Lower", "rate": 5000, "shutter": 5263, "ns": 190000, "step": 1, "processed": 0, "automatic": ("0" if kind == "cihx" else "Off"),
              "camera": "FASTCAM SA-Z type 2100K-C-64GB"} | changed
    text = """#Camera Information Header
Camera Type : {camera}
Record Rate(fps) : {rate}
Shutter Speed(s) : 1/{shutter}
Total Frame : {frames}
Save Step : {step}
Image Width : {width}
Image Height : {height}
Color Type : {colour}
Color Bit : {bits}
File Format : {format}
EffectiveBit Depth : {depth}
EffectiveBit Side : {side}
Shutter Type2(nsec) : {ns}
Auto Exposure : {automatic}
Comment Text : a : b
""" if kind == "cih" else """\x7f\x05\x01<cih>
<fileInfo><date>2020/1/1</date></fileInfo>
<imageFileInfo><fileFormat>{format}</fileFormat></imageFileInfo>
<deviceInfo><deviceName>{camera}</deviceName></deviceInfo>
<frameInfo><totalFrame>{frames}</totalFrame><skipFrame>{step}</skipFrame></frameInfo>
<recordInfo><recordRate>{rate}</recordRate><shutterSpeed>{shutter}</shutterSpeed>
<shutterSpeedNsec>{ns}</shutterSpeedNsec><autoExposure>{automatic}</autoExposure></recordInfo>
<imageDataInfo><resolution><width>{width}</width><height>{height}</height></resolution>
<colorInfo><type>{colour}</type><bit>{bits}</bit></colorInfo>
<effectiveBit><depth>{depth}</depth><side>{side}</side></effectiveBit>
<applyImageProc>{processed}</applyImageProc></imageDataInfo>
</cih>\r\nmore"""
    return text.format(**values).encode("latin-1")


class PhotronTest(CameraFilesTest):
    def photron(self, content=None, kind="cihx", **changed):
        self.write("clip.mraw", msb_packed(MOSAIC, 12) if content is None else content)
        for old in ("cih", "cihx"):
            (self.folder / f"clip.{old}").unlink(missing_ok=True)
        return self.write(f"clip.{kind}", photron_header(kind, **changed))

    def test_depths_and_packings_by_any_of_the_two_files(self):
        words = MOSAIC.astype("<u2").tobytes()
        for content, most, what in ((None, 4095, {}), (words, 4095, {"bits": 16}),
                                   ((MOSAIC * 16).astype("<u2").tobytes(), 4095, {"bits": 16, "side": "Higher"}),
                                   ((MOSAIC % 256).astype("u1").tobytes(), 255, {"bits": 8, "depth": 8})):
            for kind in ("cihx", "cih"):
                header = self.photron(content, kind, **what)
                for name in (header, "clip.mraw"):
                    with self.subTest(name=name, kind=kind, **what):
                        self.assert_light(MOSAIC % (most + 1) / most, name, "--set", "sensor.slot_us=200")
                        self.assertEqual(self.said, "")

    def test_raw_pixels_of_a_grey_camera_are_grey(self):
        for camera in ("FASTCAM Nova S16 type 1100K-M-64GB 10GbE model", "FASTCAM SA5 model 775K-M2", "FASTCAM X-M"):
            for kind in ("cihx", "cih"):
                with self.subTest(camera=camera, kind=kind):
                    self.assert_light(MOSAIC / 4095, self.photron(kind=kind, colour="Raw", camera=camera))

    def test_raw_pixels_of_another_camera_are_refused_with_their_formats(self):
        formats = (({"bits": 12}, "12msb", msb_packed(MOSAIC, 12)), ({"bits": 16}, "12", MOSAIC.astype("<u2").tobytes()),
                   ({"bits": 8, "depth": 8}, "8", (MOSAIC % 256).astype("u1").tobytes()),
                   ({"bits": 16, "side": "Higher"}, "16", (MOSAIC * 16).astype("<u2").tobytes()))
        for what, bits, content in formats:
            for camera in ("FASTCAM SA-Z type 2100K-C-64GB", "FASTCAM-Mini", ""):
                with self.subTest(camera=camera, **what):
                    header = self.photron(content, colour="Raw", camera=camera, **what)
                    self.refuse([f"--raw 8x6:bayerrg{bits} ", f"--raw 8x6:mono{bits} if it is grey"], header)
            light = {"8": MOSAIC % 256 / 255, "16": MOSAIC * 16 / 65535}.get(bits, MOSAIC / 4095)
            self.assert_light(light, "clip.mraw", "--raw", f"8x6:mono{bits}")
            self.light("clip.mraw", "--raw", f"8x6:bayerrg{bits}", "--set", "sensor.mode=physical", "--set",
                       "sensor.cfa=rggb")

    def test_a_header_without_a_kind_of_colour_is_of_grey(self):
        self.photron()
        self.write("clip.cihx", photron_header().replace(b"<type>Mono</type>", b""))
        self.assert_light(MOSAIC / 4095, "clip.mraw")

    def test_rate_and_exposure(self):
        for kind in ("cihx", "cih"):
            with self.subTest(kind=kind):
                self.light(self.photron(kind=kind, shutter=20000, ns=50000))
                self.assertIn("has 5000 frames/s, but a slot of sensor \"paper\" takes 5000 us", self.said)
                self.assertIn("its frames were exposed for 50 of 200 us each", self.said)

    def test_the_exposures_of_public_recordings(self):
        """N of 1/N s and nanoseconds, as in the samples of pyMRAW."""
        for kind, rate, shutter, ns in (("cihx", 50000, 200000, 5000), ("cihx", 30000, 50000, 20000),
                                        ("cih", 60000, 800000, 1250)):
            for left_out in ("", "shutter", "ns"):
                with self.subTest(ns=ns, left_out=left_out):
                    name = self.photron(kind=kind, rate=rate, **{"shutter": shutter, "ns": ns} |
                                        ({left_out: "-"} if left_out else {}))
                    figures = self.figures("info", name)
                    self.assertAlmostEqual(figures["exposure_us"], ns / 1000)
                    self.assertEqual(figures["frames_hz"], rate)

    def test_two_exposures_that_differ_are_said(self):
        for kind in ("cihx", "cih"):
            with self.subTest(kind=kind):
                self.light(self.photron(kind=kind, shutter=10000, ns=190000))
                self.assertIn("clip.%s: declares two exposures, 190 us and 100 us" % kind, self.said)
                self.light(self.photron(kind=kind, shutter=5263, ns=190000))
                self.assertNotIn("two exposures", self.said)

    def test_a_file_of_every_36th_frame_has_that_rate(self):
        for kind in ("cihx", "cih"):
            with self.subTest(kind=kind):
                name = self.photron(kind=kind, rate=60000, step=36)
                self.assertAlmostEqual(self.figures("info", name)["frames_hz"], 60000 / 36)
                self.light(name)
                self.assertIn("has one in 36 of the 60000 frames per second recorded, so 1666.66", self.said)

    def test_automatic_exposure_is_told(self):
        for kind, on in (("cih", "On"), ("cihx", "1")):
            self.light(self.photron(kind=kind, automatic=on))
            self.assertIn("was recorded with automatic exposure: its frames may differ in exposure", self.said)
            self.light(self.photron(kind=kind))
            self.assertNotIn("automatic", self.said)

    def test_image_processing_is_said(self):
        self.light(self.photron(processed=1))
        self.assertIn("was saved with image processing, after which its numbers may not be linear light", self.said)

    def test_the_stream_names_both_files_by_their_hash(self):
        self.light(self.photron())
        before = self.succeed("info", "clip.stipple")
        self.light(self.photron(shutter=5264))
        self.assertNotEqual(self.succeed("info", "clip.stipple"), before)

    def test_what_is_not_read(self):
        for part, what in (("declares the format \"TIFF\"", {"format": "TIFF"}),
                           ("colour (\"Color\")", {"colour": "Color"}),
                           ("10 bits per pixel", {"bits": 10}), ("\"Total Frame\" is \"0\"", {"frames": 0}),
                           ("\"Image Width\" is \"-8\"", {"width": -8}), ("is \"many\"", {"frames": "many"}),
                           ("outside 1..65535", {"width": 70000}), ("end within a byte", {"width": 7}),
                           ("neither Lower nor Higher", {"side": "Middle"})):
            for kind in ("cihx", "cih"):
                with self.subTest(kind=kind, **what):
                    self.refuse([part], self.photron(kind=kind, **what))

    def test_damage(self):
        name = self.photron(msb_packed(MOSAIC, 12)[:-1])
        self.fails(INPUT, ["clip.mraw: has 287 bytes, but 4 frames of 72 bytes"], "emulate", name, "-o", "x.stipple")
        self.photron()
        self.write("clip.cihx", photron_header(frames=2 ** 32 - 1))
        self.refuse(["announces 4294967295 frames"], "clip.mraw")
        header = photron_header()
        for content in (b"", b"<cih>", b"</cih><cih>", header[:200], header.replace(b"</frameInfo>", b"")):
            with self.subTest(content=content):
                self.refuse(["holds no XML from <cih> to </cih>"], self.write("clip.cihx", content))
        self.refuse(["has no \"Color Bit\""], self.write("clip.cihx", b"<cih></cih>"))
        self.refuse(["too long for the header"], self.write("clip.cihx", bytes(2 ** 20 + 1)))
        (self.folder / "clip.cihx").unlink()
        self.refuse(["needs the .cihx file of the same name"], "clip.mraw")
        self.refuse(["needs the .mraw file of the same name"], self.write("alone.cihx", header))


if __name__ == "__main__":
    unittest.main()
