"""Intervals of small samples of people hold the truth in 95 of 100."""
import functools
import math
import unittest

import analysis_tables  # noqa: F401 (the path)
import numpy as np
from scipy.stats import t

from tactus.analysis import people

YES = [20, 19, 20, 14, 18, 20, 9, 17, 20, 16]  # of 20 games of each of ten people


class Shares(unittest.TestCase):
    def test_the_standard_error_is_that_between_people(self):
        # Computed independently: share 0.865, naive standard error 0.024164, between people 0.056298; Student's t on the share itself 0.7376 to 0.9924.
        share = people.Share(YES, [20] * 10)
        self.assertAlmostEqual(share.value, 0.865)
        self.assertAlmostEqual(share.se, 0.056298, places=6)
        half = t.ppf(0.975, 9) * share.se
        np.testing.assert_allclose((share.value - half, share.value + half), (0.7376, 0.9924), atol=5e-5)
        low, high = share.interval()
        self.assertTrue(0.6 < low < 0.74 and 0.93 < high < 1, (low, high))

    def test_the_interval_holds_the_truth_in_93_to_97_of_100(self):
        # People differ by Beta(9, 1), 20 games each. A percentile bootstrap holds 81 % of five people. Standard error 0.4 %.
        for n in (5, 8, 12, 24):
            rng, held = np.random.default_rng([1, n]), 0
            for _ in range(3000):
                low, high = people.Share(rng.binomial(20, rng.beta(9, 1, n)), np.full(n, 20)).interval()
                held += low <= 0.9 <= high
            self.assertTrue(0.93 <= held / 3000 <= 0.97, (n, held / 3000))

    def test_people_who_are_all_alike_have_the_binomial_error(self):
        share = people.Share([20] * 6, [20] * 6)
        self.assertAlmostEqual(share.se, math.sqrt(share.smoothed * (1 - share.smoothed) / 120))
        low, high = share.interval()
        self.assertTrue(0.8 < low < high < 1)
        self.assertTrue(math.isnan(people.Share([5], [10]).interval()[0]))


class Differences(unittest.TestCase):
    def samples(self, n, loss, rng):
        """Success of the same people without and with a loss of 10 points; they differ by 0.5 in log odds."""
        own = rng.normal(0, 0.5, n)
        share = lambda odds: people.Share(rng.binomial(20, 1 / (1 + np.exp(-(odds + own)))), np.full(n, 20))
        return share(odds_of(0.85 if loss else 0.95)), share(odds_of(0.95))

    def test_the_interval_of_a_difference_holds_the_truth(self):
        for n in (5, 8, 12, 24):
            for loss in (False, True):
                rng, held, wrong = np.random.default_rng([2, n, loss]), 0, 0
                for _ in range(2000):
                    low, high = people.difference(*self.samples(n, loss, rng))
                    held += low <= (-0.1 if loss else 0) <= high
                    wrong += low > -0.1
                self.assertTrue(0.93 <= held / 2000 <= 0.985, (n, loss, held / 2000))
                if loss:  # one-sided 2.5 %, standard error 0.35 %
                    self.assertLessEqual(wrong / 2000, 0.025 + 3 * 0.0035, n)

    def test_p_is_the_level_at_which_the_interval_ends_at_the_margin(self):
        rng = np.random.default_rng(3)
        for _ in range(20):
            one, other = self.samples(8, True, rng)
            p = people.p_inferior(one, other, 0.15)
            if 1e-6 < p < 0.4:
                self.assertAlmostEqual(people.difference(one, other, 1 - 2 * p)[0], -0.15, places=4)
            self.assertEqual(p < 0.025, people.difference(one, other)[0] > -0.15)
        self.assertGreater(people.p_inferior(people.Share([2] * 6, [20] * 6), people.Share([19] * 6, [20] * 6), 0.1), 0.99)


@functools.lru_cache
def odds_of(mean):
    """Log odds whose mean share over people, who differ by 0.5, is `mean`."""
    z, w = np.polynomial.hermite_e.hermegauss(30)
    low, high = -10.0, 10.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if np.sum(w / w.sum() / (1 + np.exp(-(middle + 0.5 * z)))) < mean else (low, middle)
    return low


class Means(unittest.TestCase):
    def test_times_on_their_logarithm_hold_the_truth(self):
        for n in (5, 8, 12, 24):
            rng, held, inside = np.random.default_rng([4, n]), 0, 0
            for _ in range(2000):
                _, low, high = people.mean_interval(np.exp(rng.normal(2, 0.8, n)), logarithmic=True)
                held += low <= math.exp(2) <= high
                _, low, high = people.mean_interval(rng.normal(2, 0.8, n))
                inside += low <= 2 <= high
            self.assertTrue(0.93 <= held / 2000 <= 0.97 and 0.93 <= inside / 2000 <= 0.97, (n, held, inside))

    def test_the_bootstrap_t_of_normal_values_holds_the_truth(self):
        for n in (5, 8, 12, 24):
            rng, held = np.random.default_rng([5, n]), 0
            for _ in range(1000):
                low, high = people.bootstrap_t(rng.normal(2, 0.8, n), rng)
                held += low <= 2 <= high
            self.assertTrue(0.93 <= held / 1000 <= 0.97, (n, held / 1000))

    def test_values_without_spread_have_no_bootstrap_t(self):
        self.assertTrue(math.isnan(people.bootstrap_t([1.0] * 6, np.random.default_rng(1))[0]))


if __name__ == "__main__":
    unittest.main()
