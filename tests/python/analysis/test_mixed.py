#!/usr/bin/env python3
"""Mixed models recover known effects, and report when they cannot be fitted."""
import unittest

import analysis_tables  # noqa: F401 (the path)
import numpy as np
from scipy import integrate, stats

from tactus.analysis import censored_mixed, laplace, mixed


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
    # Three participants, three games each, with a limit of 30 s.
    LOGS, WON = np.log([8, 12, 30, 10, 15, 9, 25, 30, 30.0]), np.array([1, 1, 0, 1, 1, 1, 1, 0, 0], dtype=bool)
    AT, ONES = np.repeat([0, 1, 2], 3), np.ones((9, 1))

    def test_the_likelihood_agrees_with_the_integral(self):
        # Computed independently by quadrature: -24.305121 at mu 2.9, sigma 0.5, tau 0.4, with the factor 1 / t of the density of times.
        found = censored_mixed.log_likelihood(np.array([2.9, np.log(0.5), 0.4]), self.ONES, self.ONES, self.AT, self.LOGS, self.WON, 3, np.zeros((3, 1)))
        self.assertAlmostEqual(found - self.LOGS[self.WON].sum(), -24.305121, places=5)
        by_hand = 0
        for i in range(3):
            mine = self.AT == i
            density = lambda u, mine=mine: np.prod(np.where(self.WON[mine], stats.norm.pdf(self.LOGS[mine], 2.9 + u, 0.5), stats.norm.sf(self.LOGS[mine], 2.9 + u, 0.5))) * stats.norm.pdf(u, 0, 0.4)
            by_hand += np.log(integrate.quad(density, -4, 4)[0])
        self.assertAlmostEqual(found, by_hand, places=6)

    def test_the_maximum_agrees_with_an_independent_search(self):
        fitted = censored_mixed.fit(self.ONES, self.ONES, self.AT, self.LOGS, self.WON)
        np.testing.assert_allclose((fitted.beta[0], fitted.sd, np.sqrt(fitted.random[0, 0])), (2.943091, 0.599622, 0.417769), atol=2e-5)
        self.assertAlmostEqual(fitted.log_likelihood - self.LOGS[self.WON].sum(), -24.164522, places=5)

    def test_seven_nodes_in_two_effects_agree_with_fifteen(self):
        rng = np.random.default_rng(1)
        names, x, mean = people(rng, 4, (2.0, 0.3), (0.004, 0.002), (0, 100, 200), 6)
        at, z = np.unique(names, return_inverse=True)[1], x / 100
        logs = np.minimum(mean + rng.normal(0, 0.4, len(x)), 2.8)
        exog, theta = np.stack([np.ones_like(z), z], axis=1), np.array([2.0, 0.4, np.log(0.4), 0.3, 0.05, 0.2])
        value = lambda: censored_mixed.log_likelihood(theta, exog, exog, at, logs, logs < 2.8, 4, np.zeros((4, 2)))
        usual, kept = value(), censored_mixed.NODES[2]
        try:
            censored_mixed.NODES[2] = 15
            self.assertAlmostEqual(usual, value(), places=4)
        finally:
            censored_mixed.NODES[2] = kept

    def held(self, limit, censored, seeds):
        """Number of intervals that hold a slope of 0.002 (0.4 over the levels) of 10 people with 10 games at each level and a time limit."""
        inside, estimates = 0, []
        for seed in range(seeds):
            rng = np.random.default_rng(seed)
            names, x, mean = people(rng, 10, (2.0, 0.2), (0.002, 0.0005), (0, 50, 100, 200), 8)
            drawn = np.exp(mean + rng.normal(0, 0.3, len(x)))
            model = mixed.log_linear(names, x, np.minimum(drawn, limit), "delay", drawn < limit if censored else None)
            inside += model.effects[1].low <= 0.002 <= model.effects[1].high
            estimates.append(model.effects[1].estimate)
        return inside, np.mean(estimates)

    def test_the_interval_covers_the_ratio_of_times_in_95_of_100(self):
        for limit in (np.inf, 12.0):  # at 12 s every fourth game is not won, at the highest level every second
            inside, mean = self.held(limit, True, 12)
            self.assertGreaterEqual(inside, 9, limit)  # 11.4 expected, standard deviation 0.8
            self.assertAlmostEqual(mean, 0.002, delta=0.0002)

    def test_lost_games_that_count_as_won_at_the_limit_hide_the_slope(self):
        _, mean = self.held(12.0, False, 12)
        self.assertLess(mean, 0.0016)

    def test_too_few_won_games_permit_no_model(self):
        self.assertIn("too few", mixed.log_linear(["P01", "P02"] * 5, np.arange(10.0), np.ones(10), "delay", np.arange(10) < 3))


if __name__ == "__main__":
    unittest.main()
