"""Data for training: what emulation makes of crops of footage, by index."""

import multiprocessing
import os
import tempfile
import unittest

import numpy as np
import stipple

try:
    import zarr
except ImportError:
    zarr = None

SIZE = (18, 8, 12)  # slots, rows, columns


def clip(seed=1, shape=(24, 16, 20)):
    return np.random.default_rng(seed).uniform(0, 1.5, shape).astype(np.float32)


def one_pixel(lengths=(1, 2, 4, 8)):
    """A schedule that is the same for any seed."""
    ends = np.cumsum(lengths)
    rows = [(0, 0, int(end - length), 2**length - 1) for length, end in zip(lengths, ends)]
    return stipple.Schedule.from_exposures(rows, (1, 1), int(ends[-1]), size=SIZE[1:])


def dataset(footage, *args, **kwargs):
    return stipple.dataset(footage, *args, **{"crop": SIZE[1:], "slots": SIZE[0], "seeds": 3} | kwargs)


def places(truth, footage):
    """(frame, row, column) where footage has these values."""
    slots, rows, cols = truth.shape[:3]
    windows = np.lib.stride_tricks.sliding_window_view(footage, truth.shape[:3], (0, 1, 2))
    return np.argwhere([[[np.array_equal(windows[t, r, c], truth) for c in range(windows.shape[2])]
                         for r in range(windows.shape[1])] for t in range(windows.shape[0])])


def item_bytes(data_and_index):
    data, index = data_and_index
    return [array.tobytes() for array in data[index]]


class DatasetTest(unittest.TestCase):
    def test_items_are_those_of_a_stream(self):
        for sensor in ("paper", "paper_black", "ideal"):
            for schedule in (one_pixel(), one_pixel((3, 5))):
                data = dataset([clip(), clip(2)], sensor, schedule, seeds=[5, 6])
                for index, seed in ((0, 5), (3, 6)):
                    item = data[index]
                    stream = stipple.emulate(item.truth, sensor, schedule, seed)
                    for model in (stipple.ForwardModel(stream), data.model(index)):
                        np.testing.assert_array_equal(item.measurement, model.y)
                        np.testing.assert_array_equal(item.noise, model.variance)
                        np.testing.assert_array_equal(item.mask & 4 != 0, model.is_sample)
                        np.testing.assert_array_equal(item.mask & 8 != 0, model.is_saturated)
                        np.testing.assert_array_equal(item.mask & 64 != 0, model.is_zero)
                        np.testing.assert_array_equal(item.mask & 1 != 0, model.adjoint(model.is_sample) > 0)

    def test_named_schedules_are_made_for_the_crop_and_the_sensor(self):
        data = dataset(clip(), "lux1310", ["random", "hardware_tiled"], seeds=[1])
        for index, name in enumerate(("random", "hardware_tiled")):
            model = stipple.ForwardModel(stipple.emulate(data[index].truth, "lux1310", name, 1))
            np.testing.assert_array_equal(data[index].measurement, model.y)

    def test_colour_has_its_planes_last(self):
        data = dataset(clip(1, (24, 16, 20, 3)), "paper", one_pixel())
        item = data[1]
        self.assertEqual(item.truth.shape, (*SIZE, 3))
        np.testing.assert_array_equal(
            item.measurement, stipple.ForwardModel(stipple.emulate(item.truth, "paper", one_pixel(), 2)).y)

    def test_the_index_counts_clips_sensors_schedules_and_seeds(self):
        clips, sensors = [clip(), clip(2)], ["paper", "paper_black"]
        plans = [one_pixel(), one_pixel((3, 5)), one_pixel((2,))]
        data = dataset(clips, sensors, plans, seeds=[7, 9])
        self.assertEqual(len(data), 2 * 2 * 3 * 2)
        for index in range(len(data)):
            number, seed = index % 2, (7, 9)[index // 12]
            found = places(data[index].truth, clips[number])
            self.assertEqual(len(found), 1)
            stream = stipple.emulate(data[index].truth, sensors[index // 2 % 2], plans[index // 4 % 3], seed)
            np.testing.assert_array_equal(data[index].measurement, stipple.ForwardModel(stream).y)
            np.testing.assert_array_equal(data[index].truth, data[index - index % 12 + index % 2].truth)
        np.testing.assert_array_equal(data[-1].measurement, data[len(data) - 1].measurement)

    def test_crops_lie_everywhere(self):
        found = np.array([places(item.truth, clip())[0] for item in dataset(clip(), seeds=300)])
        np.testing.assert_array_equal(found.min(0), (0, 0, 0))
        np.testing.assert_array_equal(found.max(0), (24 - 18, 16 - 8, 20 - 12))

    def test_each_clip_has_its_own_crops(self):
        data = dataset([clip(), clip()], seeds=20)
        self.assertTrue(any(not np.array_equal(data[2 * i].truth, data[2 * i + 1].truth) for i in range(20)))

    def test_light_and_contrast(self):
        factors, powers = [], []
        data = dataset(clip(), light=(0.25, 4), contrast=(0.5, 2), seeds=200)
        for index in range(len(data)):
            # log light = power log crop + log factor, of the same crop.
            before, after = unchanged_crop(data, index), data[index].truth
            slope, level = np.polyfit(np.log(before[before > 0.01]), np.log(after[before > 0.01]), 1)
            powers.append(slope)
            factors.append(np.exp(level))
        for values, (low, high) in ((factors, (0.25, 4)), (powers, (0.5, 2))):
            self.assertGreater(min(values), low * 0.99)
            self.assertLess(max(values), high * 1.01)
            # The logarithm is uniform: its mean is the middle, its variance a twelfth of the squared width.
            width = np.log(high / low)
            self.assertAlmostEqual(np.mean(np.log(values)), np.log(low * high) / 2, delta=5 * width / np.sqrt(12 * 200))

    def test_speed_is_the_mean_of_frames(self):
        footage = clip(1, (60, 16, 20))
        item = dataset(footage, speed=3)[0]
        means = footage.astype(np.float64)
        means = np.stack([means[i:i + 3].mean(0) for i in range(len(means) - 2)])
        self.assertTrue(any(np.allclose(item.truth, means[first:first + 54:3, row:row + 8, col:col + 12], atol=1e-6)
                            for first in range(7) for row in range(9) for col in range(9)))
        # Of light that rises with time, the slots rise as fast as the speed.
        ramp = np.broadcast_to(np.arange(60, dtype=np.float32)[:, None, None] / 60, (60, 16, 20))
        speeds = [np.diff(item.truth[:, 0, 0]).mean() * 60 for item in dataset(ramp, speed=(1, 3), seeds=200)]
        self.assertGreater(min(speeds), 0.9)
        self.assertLess(max(speeds), 3.1)
        self.assertAlmostEqual(np.median(speeds), np.sqrt(3), delta=0.3)

    def test_shake_moves_the_camera_smoothly(self):
        row, col = np.indices((120, 140), dtype=np.float32)
        ways = []
        for footage in (row, col):
            video = np.broadcast_to(footage / 128, (18, 120, 140))
            data = dataset(video, shake=0.7, seeds=300)
            ways.append([item.truth[:, 0, 0] * 128 for item in data])
            # Bilinear interpolation has no error on a ramp.
            np.testing.assert_allclose(np.diff(data[0].truth, axis=1 if footage is row else 2), 1 / 128, atol=1e-6)
        steps = np.diff(np.array(ways), axis=2)
        # Steps of 2 x 300 ways of 17, correlated by 0.9: some 1000 independent squares.
        self.assertAlmostEqual(np.std(steps), 0.7, delta=0.7 * 5 * np.sqrt(0.5 / 1000))
        self.assertAlmostEqual(np.mean(steps[:, :, 1:] * steps[:, :, :-1]) / np.var(steps), 0.9, delta=0.03)

    def test_items_do_not_depend_on_process_or_order(self):
        data = dataset([clip(), clip(2)], "paper", "tiled", speed=(1, 1.2), shake=0.3, light=(0.5, 2),
                       contrast=(0.8, 1.2))
        indices = [(data, index) for index in (5, 0, 3, 3)]
        here = [item_bytes(pair) for pair in indices]
        self.assertEqual(here[2], here[3])
        for method in ("fork", "spawn"):
            with multiprocessing.get_context(method).Pool(2) as pool:
                self.assertEqual(pool.map(item_bytes, indices, 1), here, method)

    @unittest.skipUnless(zarr, "Zarr (python3-zarr) is not installed")
    def test_zarr(self):
        data = dataset(clip())
        with tempfile.TemporaryDirectory(prefix="stipple_") as folder:
            path = os.path.join(folder, "train.zarr")
            data.to_zarr(path, [2, 0])
            group = zarr.open_group(path, "r")
            for name in stipple.TrainingItem._fields:
                np.testing.assert_array_equal(group[name][0], getattr(data[2], name))
                np.testing.assert_array_equal(group[name][1], getattr(data[0], name))
            with self.assertRaisesRegex(FileExistsError, "is there already"):
                data.to_zarr(path)
            with self.assertRaises(IndexError):
                data.to_zarr(os.path.join(folder, "other.zarr"), [0, 3])
            self.assertEqual(os.listdir(folder), ["train.zarr"])

    def test_refuses_what_is_wrong(self):
        for message, arguments in (
            ("clip 1: has frames of 20 x 7 pixels; a crop needs 12 x 8", {"footage": [clip(), clip(1, (24, 7, 20))]}),
            ("clip 0: has 17 frames; 18 slots need 18", {"footage": clip(1, (17, 16, 20))}),
            ("clip 0: has 24 frames; 18 slots at a speed of 1.5 need 27", {"speed": (0.5, 1.5)}),
            ("clip 1: has other planes", {"footage": [clip(), clip(1, (24, 16, 20, 3))]}),
            ("footage: give at least one", {"footage": []}),
            ("clip 1: frame 0: .*not a number", {"footage": [clip(), np.where(clip() > 1.4, np.nan, clip())]}),
            ("clip 0: frame 0: .*negative", {"footage": -clip()}),
            ("nonesuch", {"sensors": "nonesuch"}),
            ("nonesuch", {"schedules": "nonesuch"}),
            ("schedules: give at least one", {"schedules": []}),
            ("charge stores", {"schedules": "two_bucket"}),
            ("schedule: was made for", {"schedules": stipple.Schedule("random", size=(4, 4))}),
            (r"seeds: \[-1\] are not whole", {"seeds": [-1]}),
            ("seeds: 0 is below 1", {"seeds": 0}),
            (r"seeds: \[1.5\] are not whole", {"seeds": [1.5]}),
            (r"slots, crop: \[0, 8, 12\] are not whole", {"slots": 0}),
            ("129 slots are more", {"slots": 129, "footage": clip(1, (130, 16, 20))}),
            (r"crop, slots: \(8,\) are not", {"crop": (8,)}),
            (r"slots, crop: \[18, 8, 2.5\] are not whole", {"crop": (8, 2.5)}),
            ("speed: 0 is not", {"speed": 0}),
            (r"light: \(2, 1\) is not", {"light": (2, 1)}),
            ("contrast: nan is not", {"contrast": float("nan")}),
            ("shake: -1 is not", {"shake": -1}),
        ):
            with self.assertRaisesRegex(ValueError, message, msg=message):
                dataset(**({"footage": clip()} | arguments))
        with self.assertRaises(OSError):
            dataset("missing.npy")
        data = dataset(clip())
        for index in (3, -4):
            with self.assertRaisesRegex(IndexError, f"index: {index} is outside 0..2"):
                data[index]
        with self.assertRaises(TypeError):
            data["1"]
        self.assertEqual(len(list(data)), 3)


def unchanged_crop(data, index):
    """The crop of an item before its light changes: that of the same data set without these changes."""
    same = stipple.Dataset(data._clips, data._chips, data._size, data._seeds,
                           data._augmentation._replace(light=(1.0, 1.0), contrast=(1.0, 1.0)))
    return same[index].truth


if __name__ == "__main__":
    unittest.main()
