"""A chip with gradients, the codes that sensors can run, and data sets of tensors."""

import importlib.util
import subprocess
import sys
import unittest

import numpy as np
import stipple
from program import ProgramTest, project_path

try:
    import torch
except ImportError:
    torch = None
else:
    import stipple.torch as st

SIZE = (8, 8)


def light(shape, seed=1):
    return torch.rand(shape, generator=torch.Generator().manual_seed(seed))


def by_last_slot(samples, weights, period, slots):
    """Samples (repetition, exposure, row, column) of hard codes where ForwardModel has them."""
    result = np.zeros((slots, *samples.shape[-2:]), np.float32)
    rows, cols = np.indices(samples.shape[-2:])
    span = weights.shape[1]
    before = (span - 1) // period * period
    for exposure in range(weights.shape[0]):
        open_slots = weights[exposure][:, rows % weights.shape[2], cols % weights.shape[3]].numpy() > 0
        last = span - 1 - np.argmax(open_slots[::-1], axis=0)
        for repetition in range(samples.shape[0]):
            slot = repetition * period - before + last
            there = (samples[repetition, exposure] != 0) & (slot >= 0) & (slot < slots)
            result[slot[there], rows[there], cols[there]] += samples[repetition, exposure][there]
    return result


class MissingTorchTest(unittest.TestCase):
    def test_says_what_is_missing(self):
        code = "import sys; sys.modules['torch'] = None\nimport stipple, stipple.torch"
        done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True)
        self.assertIn("ImportError: PyTorch is not installed (Debian: python3-torch)", done.stderr)

    def test_is_imported_on_demand(self):
        code = "import sys, stipple; assert 'torch' not in sys.modules"
        self.assertEqual(subprocess.run([sys.executable, "-B", "-c", code]).returncode, 0)


@unittest.skipUnless(torch, "PyTorch (python3-torch) is not installed")
class CodedSensorTest(unittest.TestCase):
    def test_exposes_as_the_forward_model(self):
        for name, slots in (("tiled", 40), ("single_bump", 30), ("full4x", 3), ("pixel_flutter", 21), ("full1x", 9)):
            schedule = stipple.Schedule(name, size=(20, 24))
            weights = st.weights_of(schedule)
            chip = st.CodedSensor("paper", schedule.period_slots)
            x = light((slots, 20, 24)) + 0.01
            model = stipple.ForwardModel(schedule, "paper", (slots, 20, 24))
            there = chip.is_sample(x.shape, weights)
            y = (chip.expose(x, weights) * there).numpy()
            np.testing.assert_allclose(by_last_slot(y, weights, schedule.period_slots, slots), model.forward(x),
                                       rtol=1e-5, err_msg=name)
            self.assertEqual(int(there.sum()), int(model.is_sample.sum()), name)

    def test_adjoint(self):
        weights = light((3, 19, 4, 4), 2)
        chip = st.CodedSensor("paper", 8)
        x = light((2, 30, 8, 8), 3).double()
        y = chip.expose(x, weights.double())
        other = light(y.shape, 4).double()
        back = chip.adjoint(other, weights.double(), 30)
        self.assertEqual(back.shape, x.shape)
        self.assertAlmostEqual(float((y * other).sum()), float((x * back).sum()), delta=1e-9 * float((y * other).sum()))

    def moments(self, sensor, level, lengths=(1, 2, 4, 8), runs=12):
        """Mean and variance of the samples of an even light, of each exposure: of emulator and chip."""
        ends = np.cumsum(lengths)
        plan = stipple.Schedule.from_exposures(
            [(0, 0, int(end - length), 2**length - 1) for length, end in zip(lengths, ends)], (1, 1), int(ends[-1]))
        weights = st.weights_of(plan)
        chip = st.CodedSensor(sensor, int(ends[-1]))
        x = np.full((int(ends[-1]), 200, 200), level, np.float32)
        emulated, modelled = [], []
        gain = stipple.Sensor(sensor).gain_e_per_dn if isinstance(sensor, str) else sensor.gain_e_per_dn
        for seed in range(1, runs + 1):
            stream = stipple.emulate(x, sensor, plan, seed)
            emulated.append([stream.samples(int(end) - 1)["dn"].astype(np.float64) for end in ends])
            samples = chip(torch.from_numpy(x), weights, torch.Generator().manual_seed(seed))
            dn = samples.y[-1].double() * chip._numbers["electrons_per_unit"]
            dn = (dn + chip._numbers["dark_e_per_slot"] * weights.sum(1)) / gain + chip._numbers["black_level_dn"]
            dn -= 0.5 * chip._numbers["floor"]  # light is that of the middle of a level
            modelled.append(dn.flatten(1).numpy())
        for all_samples in (np.concatenate(emulated, 1), np.concatenate(modelled, 1)):
            yield all_samples.mean(1), all_samples.var(1)

    def test_has_the_moments_of_the_emulator(self):
        cases = [(stipple.Sensor("paper"), level) for level in (0.001, 0.02, 0.3, 1.0)]  # DN 0 ... full scale
        cases += [(stipple.Sensor("paper_black", settings), 0.2) for settings in (
            {}, {"rounding": "floor", "bit_depth": 4}, {"full_well_e": 900}, {"shot_noise": False},
            {"quantum_efficiency": 0.6, "dark_current_e_per_s": 9000, "reset_noise_e": 12})]
        for sensor, level in cases:
            (mean, variance), (its_mean, its_variance) = self.moments(sensor, level)
            # 480 000 samples: the variance is known to 0.2 %, the mean of n DN to less.
            for exposure in range(4):
                message = f"{sensor}, light {level}, exposure {exposure}"
                self.assertLess(abs(its_mean[exposure] - mean[exposure]),
                                0.01 * max(mean[exposure], 0.1 * variance[exposure] ** 0.5), message)
                self.assertLess(abs(its_variance[exposure] - variance[exposure]),
                                0.01 * variance[exposure] + 1e-4, message)

    def test_samples_are_light_with_the_noise_of_the_model(self):
        weights = st.weights_of(stipple.Schedule("tiled", {"tile_rows": 8, "tile_cols": 8}))
        chip = st.CodedSensor("paper_black", 15)
        x = 0.02 + 0.2 * light((4, 45, 64, 64))
        samples = chip(x, weights, torch.Generator().manual_seed(1))
        error = (samples.y - chip.expose(x, weights))[:, samples.is_sample]
        variance = samples.variance[:, samples.is_sample]
        # Chi-squared of 4 x 12 x 4096 samples: 5 standard deviations of its mean.
        self.assertAlmostEqual(float((error**2 / variance).mean()), 1, delta=5 * (2 / error.numel()) ** 0.5)

    def test_gradients_are_those_of_the_mean(self):
        weights = torch.full((1, 4, 1, 1), 0.5, requires_grad=True)
        x = torch.full((4, 100, 100), 0.3, requires_grad=True)
        samples = st.CodedSensor("paper_black", 4)(x, weights, torch.Generator().manual_seed(1))
        samples.y.mean().backward()
        # y is w x: 5 standard deviations of the mean of the noise, 0.03 of 10 000 samples.
        np.testing.assert_allclose(x.grad.mean() * 10_000, 0.5, atol=5 * 0.03 / 100)
        np.testing.assert_allclose(weights.grad.flatten(), 0.3, atol=5 * 0.03 / 100)

    def test_saturation_and_darkness_still_pull(self):
        for level, weaker in ((0.4, 1.0), (0.55, 0.5), (10.0, 0.01)):
            x = torch.full((4, 50, 50), level, requires_grad=True)
            chip = st.CodedSensor(stipple.Sensor("paper_black", {"shot_noise": False, "full_well_e": 1e6}), 4, 0.1)
            weights = torch.ones(1, 4, 1, 1)
            chip(x, weights, torch.Generator().manual_seed(1)).y.sum().backward()
            self.assertLess(float(x.grad.mean()), weaker)
            if level < 1:
                self.assertGreater(float(x.grad.mean()), 0)

    def test_refuses_what_is_wrong(self):
        with self.assertRaisesRegex(ValueError, "period_slots: 0"):
            st.CodedSensor("paper", 0)
        with self.assertRaisesRegex(ValueError, "softness: 0"):
            st.CodedSensor("paper", 4, 0)
        with self.assertRaisesRegex(ValueError, "sensor grasshopper.*: has terms of mode"):
            st.CodedSensor("grasshopper", 4)
        with self.assertRaisesRegex(ValueError, r"weights: \(4, 2, 2\) is not"):
            st.CodedSensor("paper", 4)(torch.ones(4, 8, 8), torch.ones(4, 2, 2))
        with self.assertRaises(ValueError):
            st.CodedSensor("nonesuch", 4)


@unittest.skipUnless(torch, "PyTorch (python3-torch) is not installed")
class ProjectTest(unittest.TestCase):
    def test_legal_codes_are_all_orders_from_all_slots(self):
        codes = st.legal_codes(15, (1, 2, 4, 8), 4)
        self.assertEqual(tuple(codes.shape), (6 * 15, 4, 29))
        self.assertEqual(len({code.numpy().tobytes() for code in codes}), 90)
        np.testing.assert_array_equal(np.sort(codes.sum(2), axis=1), np.tile([1, 2, 4, 8], (90, 1)))
        np.testing.assert_array_equal(codes[:, :, :15].sum(1)[:, :14].numpy() <= 1, True)
        circular = torch.nn.functional.pad(codes, (0, 1)).reshape(90, 4, 2, 15).sum((1, 2))
        np.testing.assert_array_equal(circular, 1)
        self.assertEqual(len(st.legal_codes(15, range(1, 16), 4)), 1365)  # any 4 readouts of 15 slots

    def test_hard_weights_are_their_own_projection(self):
        plan = stipple.Schedule("tiled", {"tile_rows": 8, "tile_cols": 8}, size=SIZE, seed=3)
        made = st.project(st.weights_of(plan), 15, size=SIZE)
        self.assertEqual(sorted(map(tuple, made.exposures())), sorted(map(tuple, plan.exposures())))

    def test_soft_weights_go_to_the_nearest_code(self):
        plan = stipple.Schedule("tiled", {"tile_rows": 4, "tile_cols": 4}, size=SIZE, seed=3)
        weights = st.weights_of(plan)
        noisy = 0.7 * weights + 0.2 * light(weights.shape, 5)
        made = st.project(noisy, 15, size=SIZE)
        self.assertEqual(sorted(map(tuple, made.exposures())), sorted(map(tuple, plan.exposures())))
        # By trying all codes, in all cyclic orders of the exposures.
        random = light((2, 9, 2, 3), 6)
        codes = st.legal_codes(5, (1, 2, 3, 4), 2)
        soft = torch.nn.functional.pad(random, (0, 0, 0, 0, 0, 1)).reshape(2, 2, 5, 2, 3).sum(1).numpy()
        hard = torch.nn.functional.pad(codes, (0, 1)).reshape(-1, 2, 2, 5).sum(2).numpy()
        made = st.project(random, 5, lengths=(1, 2, 3, 4), size=SIZE).weights()
        exposures = st.project(random, 5, lengths=(1, 2, 3, 4), size=SIZE).exposures()
        self.assertEqual(made.min(), 1)  # without gaps
        for row in range(2):
            for col in range(3):
                best = min(range(len(codes)), key=lambda i: min(
                    np.sum((hard[i, list(order)] - soft[:, :, row, col]) ** 2) for order in ((0, 1), (1, 0))))
                begins = sorted(int(np.argmax(exposure.numpy())) for exposure in codes[best])
                there = (exposures["row"] == row) & (exposures["col"] == col)
                self.assertEqual(begins, sorted(exposures["first_slot"][there]))

    def test_sensors_can_run_it(self):
        weights = st.weights_of(stipple.Schedule("tiled", {"tile_rows": 8, "tile_cols": 8}, size=SIZE))
        for sensor, size in (("lux1310", (1024, 1280)), ("lux2100", (1080, 1920)), ("vita", (1024, 1280))):
            made = st.project(weights, 15, sensor, size=size)
            self.assertIsNone(made.check(sensor))
            self.assertEqual(made.samples_per_pixel_slot, 4 / 15)
        # Each tile is that on its left and that above it, later.
        later = st.project(weights, 15, "lux1310", delay_slots=(3, 4), size=(1024, 1280))
        self.assertEqual(later.tile, (40, 120))
        self.assertEqual(later.weights().min(), 1)  # without gaps
        exposures = set(later.exposures().tolist())
        self.assertEqual(len(exposures), 40 * 120 * 4)
        for row, col, first, open_slots in exposures:
            self.assertIn((row, (col + 8) % 120, (first + 4) % 15, open_slots), exposures)
            self.assertIn(((row + 8) % 40, col, (first + 3) % 15, open_slots), exposures)

    def test_delayed_weights_are_those_of_the_projection(self):
        weights = st.weights_of(stipple.Schedule("tiled", {"tile_rows": 4, "tile_cols": 8}, size=SIZE))
        made = st.weights_of(st.project(weights, 15, delay_slots=(3, 4), size=(64, 64)))
        self.assertEqual(made.shape[2:], (20, 120))
        chip, x = st.CodedSensor("paper", 15), light((45, 12, 32)) + 0.01
        values = []
        for codes in (made, st.delayed(weights, 15, (3, 4), (3, 4))):
            values.append(np.sort((chip.expose(x, codes) * chip.is_sample(x.shape, codes)).flatten().numpy()))
        np.testing.assert_allclose(*(value[value > 0] for value in values), rtol=1e-5)

    def test_refuses_what_is_wrong(self):
        weights = torch.ones(4, 15, 2, 2)
        with self.assertRaisesRegex(ValueError, "lengths: 0 codes of 4 exposures"):
            st.project(weights, 15, lengths=(1, 2))
        with self.assertRaisesRegex(ValueError, r"lengths: \[0, 1\] are not"):
            st.project(weights, 15, lengths=(0, 1))
        with self.assertRaisesRegex(ValueError, "too many codes"):
            st.legal_codes(64, range(1, 33), 16)
        with self.assertRaisesRegex(ValueError, "not finite"):
            st.project(weights * float("nan"), 15)
        with self.assertRaisesRegex(ValueError, "weights: slot .*; give other lengths"):
            st.project(weights, 15, stipple.Sensor("lux1310", {"slot_us": 100}), size=(1024, 1280))


@unittest.skipUnless(torch, "PyTorch (python3-torch) is not installed")
class DatasetTest(unittest.TestCase):
    def test_a_loader_stacks_items(self):
        data = stipple.dataset(np.random.default_rng(1).uniform(0, 1, (20, 16, 16)), crop=(8, 8), slots=16, seeds=6)
        wrapped = st.Dataset(data)
        self.assertIsInstance(wrapped, torch.utils.data.Dataset)
        loader = torch.utils.data.DataLoader(wrapped, batch_size=3, num_workers=2)
        batches = list(loader)
        self.assertEqual([tuple(batch.truth.shape) for batch in batches], [(3, 16, 8, 8)] * 2)
        for name in stipple.TrainingItem._fields:
            np.testing.assert_array_equal(getattr(batches[1], name)[2], getattr(data[5], name))


@unittest.skipUnless(torch and importlib.util.find_spec("scipy"), "PyTorch or SciPy (python3-scipy) is not installed")
class ExampleTest(ProgramTest):
    def test_a_learned_schedule_runs_on_the_chip(self):
        example = project_path("docs/examples/learned_schedule.py")
        out = self.folder / "out"
        done = subprocess.run([sys.executable, "-B", example, out, "--steps", "1", "--scenes", "1", "--seeds", "1"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("the sensor lux1310 can run learned", done.stdout)
        self.assertRegex(done.stdout, r"fast +psnr_db +\d+\.\d\d +[+-]")
        image = stipple.Schedule(out / "learned.mem", size=(1024, 1280))
        file = stipple.Schedule(out / "learned.toml", size=(1024, 1280))
        self.assertEqual(sorted(map(tuple, image.exposures())), sorted(map(tuple, file.exposures())))
        self.assertIsNone(image.check("lux1310"))


if __name__ == "__main__":
    unittest.main()
