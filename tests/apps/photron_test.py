""".mraw files of Photron cameras: the light of each number, what the header tells, what is refused."""

import unittest

from camera_files import MOSAIC, CameraFilesTest, msb_packed
from program import INPUT


def photron_header(kind="cihx", **changed):
    """A header by the keys that pyMRAW reads."""
    values = {"format": "MRaw", "frames": 4, "width": 8, "height": 6, "colour": "Mono", "bits": 12, "depth": 12,
              "side": "Lower", "rate": 5000, "shutter": 0.00019} | changed
    text = """#Camera Information Header
Record Rate(fps) : {rate}
Shutter Speed(s) : {shutter}
Total Frame : {frames}
Image Width : {width}
Image Height : {height}
Color Type : {colour}
Color Bit : {bits}
File Format : {format}
EffectiveBit Depth : {depth}
EffectiveBit Side : {side}
Comment Text : a : b
""" if kind == "cih" else """\x7f\x05\x01<cih>
<fileInfo><date>2020/1/1</date></fileInfo>
<imageFileInfo><fileFormat>{format}</fileFormat></imageFileInfo>
<frameInfo><totalFrame>{frames}</totalFrame></frameInfo>
<recordInfo><recordRate>{rate}</recordRate><shutterSpeed>{shutter}</shutterSpeed></recordInfo>
<imageDataInfo><resolution><width>{width}</width><height>{height}</height></resolution>
<colorInfo><type>{colour}</type><bit>{bits}</bit></colorInfo>
<effectiveBit><depth>{depth}</depth><side>{side}</side></effectiveBit></imageDataInfo>
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

    def test_a_header_without_a_kind_of_colour_is_of_grey(self):
        self.photron()
        self.write("clip.cihx", photron_header().replace(b"<type>Mono</type>", b""))
        self.assert_light(MOSAIC / 4095, "clip.mraw")

    def test_rate_and_exposure(self):
        for shutter in ("0.00005", "1/20000"):
            self.light(self.photron(shutter=shutter))
            self.assertIn("has 5000 frames/s, but a slot of sensor \"paper\" takes 5000 us", self.said)
            self.assertIn("its frames were exposed for 50 of 200 us each", self.said)

    def test_the_stream_names_both_files_by_their_hash(self):
        self.light(self.photron())
        before = self.succeed("info", "clip.stipple")
        self.light(self.photron(shutter=0.00018))
        self.assertNotEqual(self.succeed("info", "clip.stipple"), before)

    def test_what_is_not_read(self):
        for part, what in (("declares the format \"TIFF\"", {"format": "TIFF"}),
                           ("colour (\"Color\")", {"colour": "Color"}),
                           ("10 bits per pixel", {"bits": 10}), ("\"Total Frame\" is \"0\"", {"frames": 0}),
                           ("\"Image Width\" is \"-8\"", {"width": -8}), ("is \"many\"", {"frames": "many"}),
                           ("outside 1..65535", {"width": 70000}), ("end within a byte", {"width": 7})):
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
