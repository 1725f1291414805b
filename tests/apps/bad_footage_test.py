"""Footage that cannot be used is refused with what is wrong and where."""

import ctypes
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
