"""stipple schedule: making, showing, checking and importing schedules."""

import re
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np

from program import INPUT, USAGE, ProgramTest


class MakeTest(ProgramTest):
    def test_a_file_that_records_what_its_schedule_records(self):
        light = np.random.default_rng(1).random((20, 16, 24))
        self.write_array("light.npy", light)
        for name in ("random", "two_bucket", "global_flutter", "rolling"):
            self.succeed("schedule", "make", name, "-o", f"{name}.toml", "--size", "24x16")
            for schedule in (name, f"{name}.toml"):
                self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--schedule", schedule,
                             "--set", "sensor.charge_stores=2", "--force")
                self.succeed("decode", "clip.stipple", "-o", f"{schedule}.npy", "--method", "naive")
            np.testing.assert_array_equal(self.array(f"{name}.npy"), self.array(f"{name}.toml.npy"))

    def test_settings_change_the_schedule(self):
        figures = self.figures("schedule", "make", "pixel_flutter", "-o", "mine.toml", "-q",
                               "--set", "schedule.tile_rows=2", "--set", "schedule.tile_cols=3",
                               "--set", "schedule.code_slots=6", "--set", "schedule.open_slots=2", "--size", "30x20")
        self.assertEqual(figures, {
            "name": "pixel_flutter", "tile_rows": 2, "tile_cols": 3, "period_slots": 6,
            "compression_ratio": 6, "light_throughput": 1 / 3, "min_exposures": 1,
            "max_exposures": 1, "min_due": figures["min_due"], "mean_due": 100,
            "max_due": figures["max_due"], "charge_stores": 1, "code_memory_bits": 72})
        self.assertIn('kind = "code"', (self.folder / "mine.toml").read_text())

    def test_what_is_too_large_is_refused(self):
        self.fails(INPUT, ["2^24", "smaller"], "schedule", "make", "random", "-o", "large.toml",
                   "--size", "2000x1000")

    def test_wrong_command_lines(self):
        for arguments in (["--size", "3"], ["--size", "0x3"], ["--seed", "-1"], ["--what"]):
            self.fails(USAGE, [arguments[0]], "schedule", "make", "random", "-o", "x.toml",
                       *arguments)
        self.fails(USAGE, [], "schedule")
        self.fails(INPUT, ["random", "two_bucket"], "schedule", "make", "nobody", "-o", "x.toml")
        self.fails(INPUT, ["tile_row"], "schedule", "make", "tiled", "-o", "x.toml", "--set",
                   "schedule.tile_row=3")


class ShowTest(ProgramTest):
    def test_text_names_each_reading(self):
        (self.folder / "mine.toml").write_text(
            'kind = "code"\nname = "it\'s"\ntile_cols = 2\nperiod_slots = 6\ncode = ["AaaA..", "ABaBab"]\n')
        lines = self.succeed("schedule", "show", "mine.toml", "--pixels", "2", "--slots",
                             "12").splitlines()
        self.assertEqual(lines[0], "pixel, store  0   4   8")
        self.assertEqual([line.split()[-2:] for line in lines[1:5]], [
            ["1", "--31..--31.."], ["2", "............"], ["1", "-.-.3.-.-.3."], ["2", ".1.-.2.1.-.2"]])
        self.assertEqual([line[:10].strip() for line in lines[1:5]], ["(0, 0)", "", "(0, 1)", ""])
        self.assertIn("1 to 9 read at its end, after so many open slots", lines[5])
        self.assertIn("2 charge stores", "\n".join(lines))
        self.succeed("schedule", "show", "mine.toml", "-o", "mine.svg")
        image = (self.folder / "mine.svg").read_text()
        for words in ("Schedule it's", "(0, 1)  1", ">read<", "charge store"):
            self.assertIn(words, image)

    def test_one_exposure_is_one(self):
        told = self.succeed("schedule", "show", "full4x")
        self.assertIn(" 1 exposure a pixel, 1 charge store\n", told)

    def test_the_ruler_stands_over_the_slots(self):
        for slots, every in ((24, 4), (64, 4), (1024, 8)):
            ruler, line = self.succeed("schedule", "show", "full4x", "--pixels", 1, "--slots",
                                       slots).splitlines()[:2]
            first = line.index(")") + 3
            self.assertEqual(len(line), first + slots)
            for number in re.finditer(r"\d+", ruler):
                self.assertEqual(number.start() - first, int(number.group()))
                self.assertEqual(int(number.group()) % every, 0)
            self.assertEqual(len(ruler.split()), 1 + -(-slots // every))

    def test_images(self):
        for name in ("random", "two_bucket", "global_flutter", "rolling"):
            text = self.succeed("schedule", "show", name, "-o", f"{name}.svg", "--size", "32x32")
            self.assertTrue(text.startswith(f"{name}.svg: {name}: tile of "), text)
            image = ElementTree.parse(self.folder / f"{name}.svg").getroot()
            self.assertTrue(image.tag.endswith("svg"))

    def test_an_image_has_a_dot_for_each_reading_of_the_text(self):
        for name in ("random", "two_bucket", "global_flutter", "rolling"):
            show = ("schedule", "show", name, "--size", "32x32", "--slots", 60)
            self.succeed(*show, "-o", f"{name}.svg")
            dots = re.findall("<use [^>]*#gpPt6' transform", (self.folder / f"{name}.svg").read_text())
            lanes = re.findall(r"^ .*[12)] +([-.\d+]{60})$", self.succeed(*show), re.M)
            self.assertEqual(len(dots) - 1, len(re.findall(r"[\d+]", "".join(lanes))), name)  # 1: of the legend

    def test_an_image_has_each_colour_as_often_as_pixels_expose_so_long(self):
        """Viridis, the longest exposures darkest. Borders of boxes take more of the short ones."""
        self.succeed("schedule", "show", "random", "-o", "random.png", "--pixels", 16, "--slots", 60)
        self.succeed("emulate", "random.png", "-o", "x.stipple", "--transfer", "linear", "--truth", "image.npy")
        image = np.rint(255 * self.array("image.npy")).astype(int).reshape(-1, 3)
        colours, counts = np.unique(image[np.ptp(image, axis=1) > 0], axis=0, return_counts=True)
        order = np.argsort(counts)[:-5:-1]
        self.assertEqual(colours[order[[0, 3]]].tolist(), [[68, 1, 84], [253, 231, 37]])
        np.testing.assert_allclose(counts[order] / counts[order].sum(), np.array([8, 4, 2, 1]) / 15, rtol=0.1)

    def test_a_image_of_another_kind_is_refused(self):
        self.fails(USAGE, ["chart.pdf", ".png"], "schedule", "show", "random", "-o", "chart.pdf")


class CheckTest(ProgramTest):
    def test_pixels_with_one_store_cannot_do_two_exposures_at_once(self):
        self.fails(INPUT, ["two_bucket", "pixel (0, 0) slot", "charge_stores=2"],
                   "schedule", "check", "two_bucket", "--sensor", "paper")
        figures = self.figures("schedule", "check", "two_bucket", "--set",
                               "sensor.charge_stores=2")
        self.assertTrue(figures["legal"])
        light = self.write_flat("light.npy")
        self.fails(INPUT, ["pixel (0, 0) slot", "charge_stores=2"], "emulate", light, "-o",
                   "clip.stipple", "--schedule", "two_bucket")

    def test_a_readout_must_fit_its_slot(self):
        arguments = ("schedule", "check", "tiled", "--sensor", "lux1310", "--size", "320x240")
        self.assertTrue(self.figures(*arguments)["legal"])
        self.fails(INPUT, ["tiled", "lux1310", "slot ", "us"], *arguments, "--set",
                   "sensor.slot_us=10")

    def test_the_array_is_that_of_the_sensor(self):
        """The whole array of lux1310 takes longer than its slot, a part of it does not."""
        self.fails(INPUT, ["tiled on sensor lux1310, 1280 x 1024: slot "], "schedule", "check", "tiled", "--sensor",
                   "lux1310")
        told = self.succeed("schedule", "check", "tiled", "--sensor", "lux1310", "--size", "320x240")
        self.assertIn("can run tiled at 320 x 240", told)
        for sensor, size in {"lux1310": (1280, 1024), "imx273": (1408, 1080), "paper": (640, 480)}.items():
            figures = self.figures("schedule", "check", "hardware_tiled", "--sensor", sensor, "--set",
                                   "sensor.slot_us=20000")
            self.assertEqual((figures["width"], figures["height"]), size)

    def test_pixels_that_differ_from_their_group_are_remarked_on(self):
        check = ("schedule", "check", "tiled", "--sensor", "lux1310", "--size", "320x240", "--set",
                 "sensor.timing.addressing=group")
        figures = self.figures(*check)
        self.assertTrue(figures["legal"])
        self.assertIn("pixel (0, 1)", figures["remark"])
        self.assertIn("at 320 x 240; " + figures["remark"], self.succeed(*check))


class ImportTest(ProgramTest):
    def test_masks_of_every_type_are_one_exposure_per_period_and_pixel(self):
        masks = np.random.default_rng(2).random((8, 16, 16)) < 0.5
        masks[:, 3, 4] = False
        codes = set()
        for dtype in (bool, np.uint8, np.int64, np.float32, np.float64):
            self.write_array("masks.npy", masks, dtype)
            figures = self.figures("schedule", "import", "masks.npy", "-o", "masks.toml", "--force")
            self.assertEqual(figures["light_throughput"], masks.mean())
            self.assertEqual((figures["min_exposures"], figures["max_exposures"]), (0, 1))
            codes.add((self.folder / "masks.toml").read_text())
        self.assertEqual(len(codes), 1)

    def test_masks_that_are_stored_as_images(self):
        masks = np.random.default_rng(4).random((4, 8, 8)) < 0.5
        for name, values in (("one", masks), ("white", 255 * masks)):
            self.write_array("masks.npy", values, np.uint8)
            self.succeed("schedule", "import", "masks.npy", "-o", f"{name}.toml", "--name", "masks")
        self.assertEqual((self.folder / "one.toml").read_text(), (self.folder / "white.toml").read_text())
        mixed = np.where(masks, 255, 0)
        mixed[2, 3, 4] = 1
        self.write_array("masks.npy", mixed, np.uint8)
        self.succeed("schedule", "import", "masks.npy", "-o", "grey.toml")
        self.assertIn("0101", (self.folder / "grey.toml").read_text())  # 1 / 255 of 65535 is 257

    def test_masks_sample_what_they_let_through(self):
        rng = np.random.default_rng(3)
        masks = rng.random((8, 12, 10)) < 0.5
        light = rng.random((8, 12, 10)) * 0.2
        self.write_array("masks.npy", masks, np.uint8)
        self.write_array("light.npy", light)
        self.succeed("schedule", "import", "masks.npy", "-o", "masks.toml")
        self.succeed("emulate", "light.npy", "-o", "clip.stipple", "--schedule", "masks.toml",
                     "--sensor", "ideal")
        self.succeed("decode", "clip.stipple", "-o", "naive.npy", "--method", "naive")
        # The naive estimate gives each open slot its sample over the number of open slots.
        measured = (self.array("naive.npy") * masks).sum(axis=0)
        np.testing.assert_allclose(measured, (light * masks).sum(axis=0), atol=2e-3)

    def test_grey_masks_weigh_the_light(self):
        rng = np.random.default_rng(3)
        masks = rng.integers(0, 256, (8, 12, 10)) * (rng.random((8, 12, 10)) < 0.8)
        light = np.broadcast_to(rng.random((12, 10)) * 0.2, (8, 12, 10))
        self.write_array("masks.npy", masks, np.uint8)
        self.write_array("light.npy", light)
        self.succeed("schedule", "import", "masks.npy", "-o", "masks.toml")
        figures = self.figures("emulate", "light.npy", "-o", "clip.stipple", "--schedule", "masks.toml",
                               "--sensor", "ideal")
        self.assertAlmostEqual(figures["light_throughput"], masks.mean() / 255, delta=1e-5)
        self.assertAlmostEqual(figures["light_read"], masks.mean() / 255, delta=1e-5)
        info = self.figures("info", "clip.stipple")
        self.assertEqual((info["version"], info["schedule"]["weighted"]), (3, True))
        self.succeed("decode", "clip.stipple", "-o", "naive.npy", "--method", "naive")
        # At rest the naive estimate is the light; weights are rounded to 1/65535, samples to 3e-5 of light.
        read = masks.any(axis=0)
        weight = masks.sum(axis=0)[read] / 255
        errors = np.abs(self.array("naive.npy") - light)[:, read]
        self.assertLess((errors * weight).max(), 2e-3)

    def test_lengths_follow_each_other(self):
        lengths = np.zeros((3, 1, 2), int)
        lengths[:, 0, 0] = 2, 1, 3
        lengths[:, 0, 1] = 0, 4, 0
        self.write_array("lengths.npy", lengths, np.uint8)
        self.succeed("schedule", "import", "lengths.npy", "-o", "a.toml", "--lengths")
        self.assertIn('"AaAAaa", "Aaaa..",', (self.folder / "a.toml").read_text())
        self.succeed("schedule", "import", "lengths.npy", "-o", "b.toml", "--lengths", "--period",
                     "8", "--name", "mine")
        self.assertIn('"AaAAaa..", "Aaaa....",', (self.folder / "b.toml").read_text())
        self.assertIn('name = "mine"', (self.folder / "b.toml").read_text())
        self.write_array("one.npy", lengths[0], np.uint8)  # one exposure of each pixel
        self.write_array("layer.npy", lengths[:1], np.uint8)
        for name in ("one", "layer"):
            self.succeed("schedule", "import", f"{name}.npy", "-o", f"{name}.toml", "--lengths", "--name", "x")
        self.assertEqual((self.folder / "one.toml").read_text(), (self.folder / "layer.toml").read_text())

    def test_a_long_name_of_the_output_is_cut_between_two_characters(self):
        self.write_array("masks.npy", np.ones((2, 2, 2)))
        self.succeed("schedule", "import", "masks.npy", "-o", "x" + 40 * "ä" + ".toml")
        self.assertIn(f'name = "x{31 * "ä"}" ', (self.folder / ("x" + 40 * "ä" + ".toml")).read_text())

    def refuse(self, parts, values, *arguments, dtype=np.float64):
        self.write_array("bad.npy", values, dtype)
        self.fails(INPUT, ["bad.npy", *parts] if parts else [], "schedule", "import", "bad.npy",
                   "-o", "x.toml", *arguments)

    def test_what_is_wrong_is_named_by_pixel_and_slot(self):
        masks = np.zeros((70, 2, 3))
        for value in (-1, 1e7, np.nan, np.inf):
            masks[4, 1, 2] = value
            self.refuse(["pixel (1, 2) slot 4", "is not a weight"], masks)
        masks[4, 1, 2] = 0
        self.refuse(["all weights are 0"], masks)
        masks[4, 1, 2] = 1.5
        self.write_array("bad.npy", masks)
        self.fails(INPUT, ["pixel (1, 2) slot 4", "1.5 is above 1"], "schedule", "import", "bad.npy", "-o", "x.toml")
        masks[4, 1, 2] = masks[68, 1, 2] = 1
        self.refuse(["pixel (1, 2) slot 68", "64"], masks)
        lengths = np.ones((2, 2, 2))
        for value in (0.5, -1, 65, np.nan):
            lengths[1, 0, 1] = value
            self.refuse(["pixel (0, 1) exposure 1", "0 to 64"], lengths, "--lengths")
        self.refuse(["pixel (0, 0) exposure 1", "period is 1"], np.ones((2, 2, 2)), "--lengths",
                    "--period", "1")

    def test_what_is_no_volume_is_refused(self):
        self.refuse(["2 dimensions"], np.ones((2, 2)))
        self.refuse(["sides"], np.ones((2, 0, 2)))
        self.refuse(["type"], np.ones((2, 3, 4)), dtype=np.complex64)
        self.write_array("masks.npy", np.ones((2, 3, 4)))
        self.fails(INPUT, ["--period", "--lengths"], "schedule", "import", "masks.npy", "-o",
                   "x.toml", "--period", "3")
        self.fails(INPUT, ["a\\u001b.toml", "--name"], "schedule", "import", "masks.npy", "-o", "a\x1b.toml")
        self.fails(USAGE, ["--name", "control characters"], "schedule", "import", "masks.npy", "-o",
                   "x.toml", "--name", "a\nb")
        content = (self.folder / "masks.npy").read_bytes()
        (self.folder / "masks.npy").write_bytes(content[:-1])
        self.fails(INPUT, ["masks.npy", "truncated"], "schedule", "import", "masks.npy", "-o",
                   "x.toml")


if __name__ == "__main__":
    unittest.main()
