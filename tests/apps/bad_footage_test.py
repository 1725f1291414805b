"""Footage that cannot be used is refused with what is wrong and where."""

import ctypes
import struct
import unittest

import numpy as np
from program import INPUT, ProgramTest


def obey_permissions():
    """Takes the rights to read every file from the superuser, and from nobody else."""
    drop, dac_override, dac_read_search = 24, 1, 2
    for capability in (dac_override, dac_read_search):
        ctypes.CDLL(None).prctl(drop, capability, 0, 0, 0)


class BadFootageTest(ProgramTest):
    def refuse(self, footage, *parts, **options):
        self.fails(INPUT, [footage, *parts], "emulate", footage, "-o", "clip.stipple", "--truth",
                   "truth.npy", "--json", "figures.json", **options)

    def test_missing(self):
        self.refuse("nothing", "no such file or folder")

    def test_a_folder_without_images(self):
        (self.folder / "empty").mkdir()
        self.refuse("empty", "PNG, TIFF, EXR or DNG")

    def test_an_empty_file(self):
        (self.folder / "light.npy").touch()
        self.refuse("light.npy")

    def test_another_kind_of_file(self):
        (self.folder / "notes.txt").write_text("no light here")
        self.refuse("notes.txt")

    def test_text_that_is_called_a_image_or_a_video(self):
        for name in ("light.mp4", "frames/a.png", "frames2/a.exr", "frames3/a.tif"):
            path = self.folder / name
            path.parent.mkdir(exist_ok=True)
            path.write_text("no light here")
            self.refuse(name.split("/")[0], name)

    def test_unreadable(self):
        self.write_flat("light.npy")
        (self.folder / "light.npy").chmod(0)
        self.refuse("light.npy", "Permission denied", preexec_fn=obey_permissions)

    def test_truncated_array(self):
        path = self.folder / self.write_flat("light.npy")
        path.write_bytes(path.read_bytes()[:-1])
        self.refuse("light.npy")

    def test_truncated_image_names_the_image(self):
        for name in ("frames/f1.png", "frames/f2.png"):
            self.write_png(name, np.zeros((9, 9)))
        path = self.folder / "frames/f2.png"
        path.write_bytes(path.read_bytes()[:-20])
        self.refuse("frames", "f2.png")

    def write_exr(self, name, *channels):
        """4 x 2 pixels of the half 0.5; of each channel its name and how many pixels share a sample."""
        def attribute(name, kind, value):
            return b"%s\0%s\0%s" % (name.encode(), kind.encode(), struct.pack("<i", len(value)) + value)

        listed = b"".join(name.encode() + struct.pack("<xi4x2i", 1, share, share) for name, share in channels) + b"\0"
        box, rows = struct.pack("<4i", 0, 0, 3, 1), [sum(4 // n for _, n in channels if y % n == 0) for y in (0, 1)]
        head = b"".join((struct.pack("<2i", 20000630, 2), attribute("channels", "chlist", listed),
                         attribute("compression", "compression", b"\0"), attribute("dataWindow", "box2i", box),
                         attribute("displayWindow", "box2i", box), attribute("lineOrder", "lineOrder", b"\0"),
                         attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
                         attribute("screenWindowCenter", "v2f", bytes(8)),
                         attribute("screenWindowWidth", "float", struct.pack("<f", 1)))) + b"\0"
        first = len(head) + 16
        rows = [struct.pack("<2i", y, 2 * count) + count * np.float16(0.5).tobytes() for y, count in enumerate(rows)]
        (self.folder / name).write_bytes(head + struct.pack("<2Q", first, first + len(rows[0])) + b"".join(rows))

    def test_luminance_with_chroma_of_fewer_pixels(self):
        self.write_exr("grey.exr", ("Y", 1))
        self.succeed("emulate", "grey.exr", "-o", "grey.stipple", "--truth", "grey.npy")
        np.testing.assert_array_equal(self.array("grey.npy"), np.full((1, 2, 4), 0.5))
        self.write_exr("yc.exr", ("BY", 2), ("RY", 2), ("Y", 1))
        self.refuse("yc.exr", "holds the channels BY, RY, Y; give R, G, B or Y alone")

    def test_wrong_shape(self):
        self.refuse(self.write_array("flat.npy", np.zeros(5)), "(5)")
        self.refuse(self.write_array("two.npy", np.zeros((4, 5, 5, 2))), "(4, 5, 5, 2)")

    def test_no_frames_or_no_pixels(self):
        self.refuse(self.write_array("a.npy", np.zeros((0, 5, 5))))
        self.refuse(self.write_array("b.npy", np.zeros((5, 0, 5))))

    def test_frames_of_differing_size_name_the_frame_and_both_sizes(self):
        self.write_png("frames/f1.png", np.zeros((9, 9)))
        self.write_png("frames/f2.png", np.zeros((9, 8)))
        self.refuse("frames", "f2.png", "9", "8")

    def test_a_number_that_a_pattern_skips(self):
        for number in (1, 2, 4):
            self.write_png(f"frames/f{number}.png", np.zeros((9, 9)))
        self.fails(INPUT, ["frames/f3.png", "missing"], "emulate", "frames/f%d.png", "-o",
                   "clip.stipple")

    def test_light_that_is_no_light_is_named_by_its_place(self):
        for value in (np.nan, np.inf, -np.inf, -0.5):
            light = np.full((30, 6, 7, 3), 0.2)
            light[20, 4, 5, 1] = value
            self.write_array("light.npy", light)
            with self.subTest(value=value):
                self.refuse("light.npy", "20", "row 4", "column 5", "plane 1")


if __name__ == "__main__":
    unittest.main()
