"""The forward model as an operator: its algebra, and what others make of it."""

import unittest

import numpy as np
import stipple

try:
    import torch
except ImportError:
    torch = None
try:
    from scipy.sparse.linalg import lsqr
except ImportError:
    lsqr = None

SHAPE = (24, 12, 16)


def light(seed=1, shape=SHAPE):
    return np.random.default_rng(seed).uniform(0.05, 1, shape).astype(np.float32)


def dot(a, b):
    return float(np.sum(a.astype(np.float64) * b.astype(np.float64)))


class ForwardModelTest(unittest.TestCase):
    def setUp(self):
        self.truth = light()
        self.model = stipple.ForwardModel(stipple.emulate(self.truth))

    def test_adds_up_the_slots_of_each_exposure(self):
        stream = stipple.emulate(self.truth)
        y = self.model.forward(self.truth)
        expected = np.zeros(SHAPE)
        for slot, samples in enumerate(stream):
            for sample in samples:
                row, col, slots = sample["row"], sample["col"], sample["exposure_slots"]
                expected[slot, row, col] = self.truth[slot + 1 - slots:slot + 1, row, col].sum(dtype=np.float64)
        np.testing.assert_allclose(y, expected, rtol=1e-6)
        np.testing.assert_array_equal(self.model.is_sample, expected > 0)

    def test_the_samples_differ_from_it_by_noise(self):
        is_exact = self.model.is_sample & ~self.model.is_saturated & ~self.model.is_zero
        error = (self.model.y - self.model.forward(self.truth))[is_exact]
        variance = self.model.noise_variance(self.truth)[is_exact]
        # Chi-squared of some 2000 samples: 5 standard deviations of its mean.
        self.assertAlmostEqual(np.mean(error**2 / variance), 1, delta=5 * np.sqrt(2 / error.size))

    def test_adjoint(self):
        for model in (self.model, stipple.ForwardModel("random", "paper", SHAPE),
                      stipple.ForwardModel("two_bucket", stipple.Sensor("paper", {"charge_stores": 2}), SHAPE),
                      stipple.ForwardModel("tiled", "paper", (*SHAPE, 3))):
            x, y = light(2, model.shape), light(3, model.shape) * model.is_sample
            forward = model.forward(x)
            self.assertAlmostEqual(dot(forward, y), dot(x, model.adjoint(y)),
                                   delta=1e-6 * np.sqrt(dot(forward, forward) * dot(y, y)))

    def test_prox_has_no_better_neighbour(self):
        v, step = light(4), 0.01
        x = self.model.prox(v, step)
        self.assertEqual(self.model.prox(v, np.full(SHAPE, step)).tobytes(), x.tobytes())
        bounds = np.where(self.model.is_saturated, -1, np.where(self.model.is_zero, 1, 0))

        def objective(x):
            error = self.model.y.astype(np.float64) - self.model.forward(x)
            error[(bounds * error > 0)] = 0
            error = error[self.model.is_sample] ** 2 / self.model.variance[self.model.is_sample]
            return np.sum((x.astype(np.float64) - v) ** 2) / (2 * step) + error.sum() / 2

        best = objective(x)
        for seed in range(50):
            move = np.random.default_rng(seed).normal(0, 0.003, SHAPE).astype(np.float32)
            self.assertLess(best, objective(x + move))

    def test_prox_l2_solves_its_equation(self):
        z, gamma, y = light(5), 0.7, self.model.y
        x = self.model.prox_l2(z, y, gamma)
        left = x + gamma * self.model.adjoint(self.model.forward(x))
        np.testing.assert_allclose(left, z + gamma * self.model.adjoint(y), atol=1e-4)

    def test_score_is_the_gradient(self):
        x = light(6)
        way = np.random.default_rng(7).normal(0, 1, SHAPE).astype(np.float32)
        step = 1e-3
        difference = self.model.log_likelihood(x + step * way) - self.model.log_likelihood(x - step * way)
        score = self.model.score(x)
        self.assertAlmostEqual(dot(score, way), difference / (2 * step), delta=1e-3 * np.sqrt(dot(score, score)))
        self.assertGreater(self.model.log_likelihood(self.truth), self.model.log_likelihood(0.9 * self.truth))

    def test_variances_of_an_estimate(self):
        self.model.set_variance(self.truth)
        np.testing.assert_array_equal(self.model.variance, self.model.noise_variance(self.truth))

    def test_batches_and_types(self):
        batch = np.stack([light(8), light(9), light(10)]).reshape(3, 1, *SHAPE)
        self.assertEqual(self.model.forward(batch).shape, batch.shape)
        np.testing.assert_array_equal(self.model.forward(batch)[1, 0], self.model.forward(light(9)))
        self.assertEqual(self.model.log_likelihood(batch).shape, (3, 1))
        strided = np.asfortranarray(light(8).astype(np.float64))
        np.testing.assert_array_equal(self.model.forward(strided), self.model.forward(light(8)))
        colour = stipple.ForwardModel("random", "paper", (*SHAPE, 3))
        x = light(11, (2, *SHAPE, 3))
        self.assertEqual(colour.A(x).shape, x.shape)
        np.testing.assert_array_equal(colour.forward(x)[1, ..., 2],
                                      stipple.ForwardModel("random", "paper", SHAPE).forward(x[1, ..., 2]))

    def test_other_samples(self):
        model = stipple.ForwardModel("random", "paper", SHAPE)
        self.assertEqual(float(np.abs(model.y).max()), 0)
        model.set_y(model.forward(self.truth))
        np.testing.assert_array_equal(model.y, model.forward(self.truth))
        # With samples and no other information, a large step gives light that has them.
        x = model.prox(np.zeros(SHAPE), 1e3)
        np.testing.assert_allclose(model.forward(x), model.y, rtol=1e-4, atol=1e-4)

    @unittest.skipUnless(lsqr, "SciPy (python3-scipy) is not installed")
    def test_linear_operator(self):
        operator = self.model.as_linear_operator()
        self.assertEqual(operator.shape, (int(self.model.is_sample.sum()), np.prod(SHAPE)))
        y = self.model.forward(self.truth)[self.model.is_sample]
        x = lsqr(operator, y)[0]
        # The least solution of a row of ones is its sample, spread evenly.
        spread = self.model.adjoint(self.model.forward(self.truth) /
                                    np.maximum(self.model.forward(self.model.adjoint(self.model.is_sample)), 1))
        np.testing.assert_allclose(x.reshape(SHAPE), spread, atol=1e-4)

    @unittest.skipUnless(torch, "PyTorch (python3-torch) is not installed")
    def test_torch(self):
        x = torch.tensor(light(12), requires_grad=True)
        y = self.model.torch(x)
        np.testing.assert_array_equal(y.detach().numpy(), self.model.forward(light(12)))
        weight = light(13) * self.model.is_sample
        (y * torch.tensor(weight)).sum().backward()
        np.testing.assert_array_equal(x.grad.numpy(), self.model.adjoint(weight))
        x.grad = None
        batch = x.reshape(1, *SHAPE)
        (2 * self.model.torch_log_likelihood(batch)).sum().backward()
        np.testing.assert_allclose(x.grad.numpy(), 2 * self.model.score(light(12)), rtol=1e-6)
        np.testing.assert_array_equal(self.model.forward(torch.tensor(light(12))), self.model.forward(light(12)))
        with self.assertRaisesRegex(ValueError, "x: ndarray is not a torch tensor"):
            self.model.torch(light(12))
        with self.assertRaisesRegex(ValueError, "x: cannot be read"):
            self.model.forward(x)

    def test_refuses_what_is_wrong(self):
        model, x = self.model, light()
        with self.assertRaisesRegex(ValueError, r"shape \(24, 12, 15\), not \(24, 12, 16\)"):
            model.forward(x[:, :, 1:])
        with self.assertRaisesRegex(ValueError, "not finite"):
            model.forward(np.where(x > 0.9, np.nan, x))
        with self.assertRaisesRegex(ValueError, "x: complex64 is not a real number"):
            model.forward(x.astype(np.complex64))
        with self.assertRaisesRegex(ValueError, "step: has 3 values"):
            model.prox(x, [1, 2, 3])
        with self.assertRaisesRegex(ValueError, "step: has values that are negative"):
            model.prox(x, -1)
        with self.assertRaisesRegex(ValueError, "slots: 129 are more than 128"):
            stipple.ForwardModel("random", "paper", (129, 4, 4))
        with self.assertRaisesRegex(ValueError, r"shape: \(4, 4\) is not"):
            stipple.ForwardModel("random", "paper", (4, 4))
        with self.assertRaisesRegex(ValueError, "needs a sensor"):
            stipple.ForwardModel(stipple.Schedule("random", size=(4, 4)))
        with self.assertRaisesRegex(ValueError, "has its own"):
            stipple.ForwardModel(stipple.emulate(x), "paper", SHAPE)
        with self.assertRaises(OSError):
            stipple.ForwardModel("missing.stipple")


if __name__ == "__main__":
    unittest.main()
