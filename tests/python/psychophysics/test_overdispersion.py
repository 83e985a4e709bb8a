"""Over-dispersed answers are found, and their intervals hold the truth."""
import math
import pathlib
import sys
import unittest

import numpy as np
from scipy.special import gammaln
from scipy.stats import betabinom, binom

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.psychophysics import fits, intervals, overdispersion, posterior
from tactus.psychophysics.functions import FUNCTIONS

YES, TOTAL = np.array([20, 19, 20, 14, 18, 20, 9, 17, 20, 16]), np.full(10, 20)
SOA = np.array([-240, -160, -110, -70, -35, 0, 35, 70, 110, 160, 240.0])
TRUTH = {"pss": 10, "sd": 60, "lapse": 0.02}


def answers(rho, n, seed):
    """(n, k) yes of 20 answers at each SOA, beta-binomial with correlation rho."""
    rng, p = np.random.default_rng(seed), FUNCTIONS["order"].p(SOA, **TRUTH)
    shares = np.tile(p, (n, 1)) if rho == 0 else rng.beta(p * (1 - rho) / rho, (1 - p) * (1 - rho) / rho, (n, len(p)))
    return rng.binomial(20, shares).astype(float)


class BetaBinomial(unittest.TestCase):
    def test_the_maximum_agrees_with_published_values(self):
        # Ten groups of 20, computed independently: binomial -32.792564; beta-binomial mu 0.867802, rho 0.223175, -21.019639, design effect 5.2403.
        self.assertAlmostEqual(float(binom.logpmf(YES, TOTAL, 0.865).sum()), -32.792564, places=6)
        found = overdispersion.beta_binomial(YES, TOTAL)
        self.assertAlmostEqual(found.mu, 0.867802, places=5)
        self.assertAlmostEqual(found.rho, 0.223175, places=5)
        self.assertAlmostEqual(found.log_likelihood, -21.019639, places=5)
        self.assertAlmostEqual(found.design_effect(20), 5.2403, places=3)

    def test_the_moments_agree_with_published_values(self):
        # Pearson's statistic 48.854635 with 9 degrees of freedom: 5.4283 = 1 + 19 rho.
        self.assertAlmostEqual(overdispersion.moment_rho(YES, TOTAL), 0.233068, places=6)

    def test_independent_answers_have_no_correlation(self):
        rng = np.random.default_rng(1)
        rho = [overdispersion.beta_binomial(rng.binomial(40, 0.8, 30), np.full(30, 40)).rho for _ in range(30)]
        self.assertLess(np.median(rho), 0.01)
        rho = [overdispersion.beta_binomial(rng.binomial(40, rng.beta(7.2, 1.8, 200)), np.full(200, 40)).rho for _ in range(10)]
        self.assertAlmostEqual(np.mean(rho), 0.1, delta=0.02)


class Dispersion(unittest.TestCase):
    def found(self, rho, n, seed=1):
        rng = np.random.default_rng(seed)
        return [overdispersion.dispersion(fits.fit(SOA, yes, np.full(len(SOA), 20.0), "order"), rng, 100) for yes in answers(rho, n, seed)]

    def test_the_p_of_independent_answers_is_even(self):
        p = np.array([d.p for d in self.found(0, 80)])
        # 5 % and 50 %; standard errors 2.4 % and 5.6 %.
        self.assertLess(np.mean(p < 0.05), 0.05 + 3 * 0.024)
        self.assertLess(abs(np.mean(p < 0.5) - 0.5), 4 * 0.056)

    def test_over_dispersed_answers_are_found_with_their_design_effect(self):
        found = self.found(0.15, 60)
        self.assertGreater(np.mean([d.p < 0.05 for d in found]), 0.5)  # of 8 degrees of freedom
        # 1 + 19 * 0.15 = 3.85; levels near 0 and 1 vary less.
        self.assertTrue(2.5 < np.mean([d.factor for d in found]) < 4.5, np.mean([d.factor for d in found]))
        self.assertGreater(min(d.width() for d in found), 0.999)

    def test_intervals_of_over_dispersed_answers_hold_the_truth_where_binomial_ones_do_not(self):
        n = 60
        held, widths = [], []
        for rho in (0.15, 0.0):
            yes = answers(rho, n, 2)
            many = fits.fit_many(SOA, yes, np.full(yes.shape, 20.0), "order")
            for sets in (many, overdispersion.over_dispersed(many, 3.0)):
                low, high = intervals.of_many(sets, "pss")
                held.append(np.mean((low <= TRUTH["pss"]) & (TRUTH["pss"] <= high)))
                widths.append(np.median(high - low))
        self.assertLess(held[0], 0.85)
        for share in held[1::2]:
            self.assertGreater(share, 0.95 - 3 * math.sqrt(0.95 * 0.05 / n))
        # Independent answers show that they are, so their intervals become less longer than those of others, whose design effect is 3.85 or less.
        self.assertTrue(1.0 <= widths[3] / widths[2] < 1.6, widths)
        self.assertTrue(1.6 < widths[1] / widths[0] < 2.6, widths)

    def test_the_tables_of_the_posterior_are_the_beta_binomial_likelihood(self):
        rng = np.random.default_rng(4)
        for _ in range(50):
            total = rng.integers(1, 60, 5).astype(float)
            yes, eta, p = np.floor(rng.uniform(size=5) * (total + 1)), rng.uniform(0.01, 0.7, 1), rng.uniform(0.001, 0.999, (1, 1, 1, 5))
            of = posterior.OverDispersedAnswers(yes[None], total[None], eta, np.zeros(1))
            nu = 1 / eta[0] ** 2 - 1
            exact = betabinom.logpmf(yes, total, nu * p[0, 0, 0], nu * (1 - p[0, 0, 0])) - (gammaln(total + 1) - gammaln(yes + 1) - gammaln(total - yes + 1))
            self.assertAlmostEqual(float(of.integrated(p)[0, 0, 0]), float(exact.sum()), delta=2e-3)

    def test_single_answers_at_a_level_have_no_dispersion(self):
        rng = np.random.default_rng(5)
        levels = np.linspace(-240, 240, 121)
        yes = (rng.random(121) < FUNCTIONS["order"].p(levels, **TRUTH)).astype(float)
        many = fits.fit(levels, yes, np.ones(121), "order").many
        same = overdispersion.over_dispersed(many, 1.0)
        for name in ("pss", "sd"):
            np.testing.assert_allclose(np.ravel(intervals.of_many(same, name)), np.ravel(intervals.of_many(many, name)), rtol=0.01, atol=0.5)

    def test_without_over_dispersion_nothing_is_widened(self):
        fitted = fits.fit(SOA, answers(0, 1, 3)[0], np.full(len(SOA), 20.0), "order")
        self.assertIs(overdispersion.inflated(fitted.many, 1.0), fitted.many)
        self.assertEqual(overdispersion.Dispersion(0.7, 1.5, 8).width(), 1.0)
        # Half as sure: 1 + 0.5 (2 * (t / z)^2 - 1).
        self.assertAlmostEqual(overdispersion.Dispersion(0.375, 2.0, 8).width(), 1 + 0.5 * (2 * (2.306004 / 1.959964) ** 2 - 1), places=5)


if __name__ == "__main__":
    unittest.main()
