"""The intervals for the power of games agree with other programs."""
import pathlib
import sys
import unittest

import numpy as np
from scipy.stats import ttest_rel
from statsmodels.stats.proportion import confint_proportions_2indep, proportion_confint

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.study import power_games


class Intervals(unittest.TestCase):
    def test_intervals_of_one_and_two_shares_agree_with_statsmodels(self):
        dice = np.random.default_rng(1)
        for n in (3, 10, 80):
            won = dice.random((50, 2, 1, n)) < dice.random((50, 2, 1, 1))
            (low, high), _ = power_games.interval(won, dice.gamma(4, 1, won.shape), 0.1)
            for i, (a, b) in enumerate(won.sum(axis=(2, 3))):
                self.assertTrue(np.allclose(power_games.wilson(np.float64(a / n), n, 0.1), proportion_confint(int(a), n, 0.1, "wilson"), atol=1e-12))
                expected = confint_proportions_2indep(int(b), n, int(a), n, method="newcomb", compare="diff", alpha=0.1)
                self.assertTrue(np.allclose((low[i], high[i]), expected, atol=1e-9), (a, b, n))

    def test_intervals_of_five_or_more_people_agree_with_the_paired_test_of_scipy(self):
        dice = np.random.default_rng(2)
        won, time_s = dice.random((20, 2, 7, 9)) < 0.8, dice.gamma(4, 1, (20, 2, 7, 9))
        shares, ratios = power_games.interval(won, time_s, 0.05)
        for i in range(20):
            for (low, high), means in ((shares, won[i].mean(axis=2)), (ratios, np.log(time_s[i]).mean(axis=2, where=won[i]))):
                self.assertTrue(np.allclose((low[i], high[i]), ttest_rel(means[1], means[0]).confidence_interval(0.95), atol=1e-9))


if __name__ == "__main__":
    unittest.main()
