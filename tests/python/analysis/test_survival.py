"""Times to win with censored games agree with published and independently computed values."""
import math
import unittest

import analysis_tables  # noqa: F401 (the path)
import numpy as np
from scipy.optimize import minimize
from scipy.stats import norm
from statsmodels.duration.survfunc import SurvfuncRight

from tactus.analysis import survival

# Ten games with a limit of 30 s; some were not won and ended earlier.
ENDED = np.array([5, 8, 8, 12, 15, 20, 25, 30, 30, 30.0])
WON = np.array([1, 1, 0, 1, 0, 1, 1, 0, 0, 0], dtype=bool)


class Survival(unittest.TestCase):
    def test_the_example_is_that_of_kaplan_and_meier(self):
        # The product limit and Greenwood's standard error, computed by hand.
        found = SurvfuncRight(ENDED, WON)
        np.testing.assert_allclose(found.surv_prob, [0.90000, 0.80000, 0.68571, 0.54857, 0.41143], atol=5e-6)
        np.testing.assert_allclose(found.surv_prob_se, [0.09487, 0.12649, 0.15149, 0.17244, 0.17559], atol=5e-6)
        steps = np.concatenate([[0], found.surv_times, [30]])
        self.assertAlmostEqual(float(np.sum(np.diff(steps) * np.concatenate([[1], found.surv_prob]))), 21.185714, places=5)

    def test_the_log_normal_of_censored_times_is_the_maximum(self):
        # Computed by an independent search: mu 3.154772, sigma 0.921568, log likelihood -22.239123.
        found = survival.fit(ENDED, WON, cure=False)
        np.testing.assert_allclose((found.mu, found.sd, found.log_likelihood), (3.154772, 0.921568, -22.239123), atol=2e-6)

    def test_with_a_share_that_cannot_be_won_it_is_the_maximum_too(self):
        rng = np.random.default_rng(1)
        drawn = np.exp(rng.normal(2.5, 0.4, 400))
        won = (rng.random(400) < 0.8) & (drawn < 30)
        ended = np.where(won, drawn, 30.0)
        found = survival.fit(ended, won)

        def cost(theta):
            mu, sd, share = theta[0], math.exp(theta[1]), 1 / (1 + math.exp(-theta[2]))
            z = (np.log(ended) - mu) / sd
            return -np.where(won, np.log(share) + norm.logpdf(z) - theta[1] - np.log(ended), np.log(1 - share * norm.cdf(z))).sum() - 0.5 * math.log(share * (1 - share))

        best = minimize(cost, [2.0, 0.0, 0.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-9, "maxiter": 5000})
        np.testing.assert_allclose((found.mu, math.log(found.sd), math.log(found.winnable / (1 - found.winnable))), best.x, atol=2e-4)
        self.assertAlmostEqual(found.winnable, 0.8, delta=3 * math.sqrt(0.16 / 400))

    def test_the_variance_is_that_of_the_influences_and_of_repetitions(self):
        rng, values, variances, influences = np.random.default_rng(2), [], [], []
        for _ in range(300):
            drawn = np.exp(rng.normal(2.5, 0.4, 200))
            won = (rng.random(200) < 0.8) & (drawn < 20)
            found = survival.fit(np.where(won, drawn, 20.0), won)
            values.append(found.mu), variances.append(found.variance), influences.append(np.sum(found.influence**2))
        self.assertAlmostEqual(np.var(values), np.mean(variances), delta=0.25 * np.mean(variances))
        # Both estimate the information, by its curvature and by the scores.
        self.assertAlmostEqual(np.mean(influences), np.mean(variances), delta=0.1 * np.mean(variances))
        self.assertAlmostEqual(np.mean(values), 2.5, delta=0.01)

    def test_the_interval_of_the_time_ratio_covers_the_truth_whatever_the_success(self):
        rng = np.random.default_rng(3)
        for share, ratio in ((0.96, 1.0), (0.8, 1.15), (0.6, 1.0)):
            inside = 0
            for _ in range(300):
                both = []
                for p, slower in ((0.96, 1.0), (share, ratio)):
                    drawn = np.exp(rng.normal(math.log(12 * slower), 0.35, 150))
                    won = (rng.random(150) < p) & (drawn < 30)
                    both.append(survival.fit(np.where(won, drawn, 30.0), won))
                inside += abs(both[1].mu - both[0].mu - math.log(ratio)) < 1.96 * math.sqrt(both[0].variance + both[1].variance)
            self.assertTrue(0.95 - 4 * 0.0126 < inside / 300 < 0.95 + 4 * 0.0126, (share, ratio, inside / 300))

    def test_a_success_of_72_permille_reaches_the_time_criterion_of_a_restricted_mean(self):
        # Restricted mean p T + (1 - p) 30 s with p = 0.96 and 12.9 s: T = 12.1875 s, and a loss of 7.24 points makes it longer by 10 %.
        self.assertAlmostEqual((12.9 - 0.04 * 30) / 0.96, 12.1875)
        self.assertAlmostEqual(0.1 * 12.9 / (30 - 12.1875), 0.0724211, places=7)
        loss = 0.0724211
        by_success, by_time = survival.decomposition(0.96 - loss, 12.1875, 0.96, 12.1875, 30)
        self.assertAlmostEqual(by_success, 1.29, places=5)
        self.assertEqual(by_time, 0)

    def test_the_parts_of_a_change_add_up_to_it(self):
        # Kitagawa 1955; a limit of 420 s.
        rng = np.random.default_rng(4)
        for _ in range(50):
            p0, p1, t0, t1 = *rng.uniform(0.1, 1, 2), *rng.uniform(10, 400, 2)
            change = p1 * t1 + (1 - p1) * 420 - p0 * t0 - (1 - p0) * 420
            self.assertAlmostEqual(sum(survival.decomposition(p1, t1, p0, t0, 420)), change, places=9)

    def test_times_are_identified_only_if_most_of_them_are_seen(self):
        few = survival.fit([5.0, 6.0, 30.0], [True, True, False])
        self.assertTrue(math.isnan(few.mu) and not few.identified)
        rng = np.random.default_rng(5)
        drawn = np.exp(rng.normal(math.log(28), 0.4, 300))
        self.assertFalse(survival.fit(np.minimum(drawn, 20), drawn < 20).identified)
        self.assertTrue(survival.fit(np.minimum(drawn, 60), drawn < 60).identified)
        self.assertTrue(survival.fit([5.0] * 10, [True] * 10).identified)


if __name__ == "__main__":
    unittest.main()
