#!/usr/bin/env python3
"""Mixed models recover known effects, and report when they cannot be fitted."""
import unittest

import analysis_tables  # noqa: F401 (the path)
import numpy as np
from scipy import integrate, stats

from tactus.analysis import laplace, mixed


def people(rng, participants, intercept, slope, levels, repetitions):
    """(names, x, log odds) with normal intercepts and slopes."""
    x = np.tile(np.repeat(levels, repetitions).astype(float), participants)
    each = len(levels) * repetitions
    names = np.repeat([f"P{i:02}" for i in range(participants)], each)
    own = lambda mean_sd: np.repeat(rng.normal(*mean_sd, participants), each)
    return names, x, own(intercept) + own(slope) * x


class Logistic(unittest.TestCase):
    def test_the_interval_covers_the_slope_in_95_of_100(self):
        inside, between = np.zeros(2), []
        for seed in range(60):
            rng = np.random.default_rng(seed)
            names, x, odds = people(rng, 12, (2.0, 0.6), (-0.012, 0.004), (0, 50, 100, 150, 200, 300), 12)
            model = mixed.logistic(names, x, (rng.random(len(x)) < 1 / (1 + np.exp(-odds))) * 1.0, "delay")
            inside += [model.effects[0].low <= 2 <= model.effects[0].high, model.effects[1].low <= -0.012 <= model.effects[1].high]
            between.append((model.sd_intercept, model.sd_slope))
        # 57 expected, binomial standard deviation 1.7.
        self.assertTrue((inside >= 53).all(), inside)
        # Maximum likelihood underestimates the spread of 12 people by about (1 - 1/12)^0.5.
        np.testing.assert_allclose(np.median(between, axis=0), (0.57, 0.0038), rtol=0.15)

    def test_laplaces_integral_is_near_the_true_one(self):
        # One participant, 40 answers, random intercept only: the integral over it by quadrature.
        rng = np.random.default_rng(2)
        yes = (rng.random(40) < 0.7) * 1.0
        fixed, beta, sd = np.ones((40, 1)), 0.5, 0.8
        of = lambda u: np.exp(np.sum(yes * (beta + u) - np.logaddexp(0, beta + u))) * stats.norm.pdf(u, 0, sd)
        truth = -np.log(integrate.quad(of, -5, 5)[0])
        found = laplace.negative_log_likelihood(np.array([beta, sd, 0, 0]), fixed, np.stack([np.ones(40), np.zeros(40)], axis=1), np.zeros(40, int), yes, 1, np.zeros((1, 2)))
        self.assertAlmostEqual(found, truth, delta=0.01)

    def test_without_differences_between_people_it_is_logistic_regression(self):
        from statsmodels.discrete.discrete_model import Logit
        rng = np.random.default_rng(4)
        names, x, odds = people(rng, 10, (1.0, 0.0), (-0.01, 0.0), (0, 100, 200, 300), 20)
        yes = (rng.random(len(x)) < 1 / (1 + np.exp(-odds))) * 1.0
        plain = Logit(yes, np.stack([np.ones_like(x), x], axis=1)).fit(disp=0).params
        model = mixed.logistic(names, x, yes, "delay")
        np.testing.assert_allclose([e.estimate for e in model.effects], plain, rtol=0.05)

    def test_the_pss_of_people_is_the_peak_of_the_parabola(self):
        rng = np.random.default_rng(5)
        soa = np.tile(np.repeat(np.arange(-200, 201, 40.0), 10), 10)
        names = np.repeat([f"P{i}" for i in range(10)], 110)
        pss = np.repeat(rng.normal(25, 8, 10), 110)
        yes = (rng.random(len(soa)) < 0.96 * np.exp(-((soa - pss) ** 2) / (2 * 80**2))) * 1.0
        model = mixed.logistic(names, soa, yes, "SOA", parabola=True)
        found = next(e for e in model.effects if e.name == "PSS")
        self.assertTrue(found.low <= 25 <= found.high and found.high - found.low < 25, found)

    def test_one_participant_permits_no_model(self):
        self.assertEqual(mixed.logistic(["P01"] * 10, np.arange(10.0), np.arange(10) % 2, "delay"), mixed.ONE)
        self.assertEqual(mixed.log_linear(["P01"] * 10, np.arange(10.0), np.ones(10), "delay"), mixed.ONE)
        self.assertIn("same", mixed.logistic(["P01", "P02"] * 5, np.arange(10.0), np.ones(10), "delay"))

    def test_few_participants_cause_a_warning(self):
        rng = np.random.default_rng(6)
        names, x, odds = people(rng, 3, (1.0, 0.3), (-0.01, 0.002), (0, 100, 200), 20)
        self.assertIn("3 participants are too few", mixed.logistic(names, x, (rng.random(len(x)) < 1 / (1 + np.exp(-odds))) * 1.0, "delay").words)


class Times(unittest.TestCase):
    def test_the_interval_covers_the_ratio_of_times_in_95_of_100(self):
        inside = 0
        for seed in range(100):
            rng = np.random.default_rng(seed)
            names, x, mean = people(rng, 10, (2.0, 0.2), (0.001, 0.0005), (0, 50, 100, 200, 300), 10)
            model = mixed.log_linear(names, x, np.exp(mean + rng.normal(0, 0.3, len(x))), "delay")
            inside += model.effects[1].low <= 0.001 <= model.effects[1].high
        self.assertTrue(inside >= 89, inside)


if __name__ == "__main__":
    unittest.main()
