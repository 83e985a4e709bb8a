"""Asymmetric windows of synchrony, and the free peak of the symmetric one."""
import math
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.psychophysics import fits, independent_channels, intervals

SOA = np.array([-200, -100, -50, 0, 50, 100, 200.0])
MODEL = {"mean_a": 40, "mean_b": 60, "tau": -20, "delta": 80}
LEVELS = np.linspace(-240, 240, 13)


class Channels(unittest.TestCase):
    def test_the_answers_have_the_computed_probabilities(self):
        # Garcia-Perez and Alcala-Quintana 2012, equation 4, with means of 40 and 60, tau -20, delta 80; computed independently to six digits.
        b_first, together, a_first = independent_channels.probabilities(SOA, **MODEL)
        np.testing.assert_allclose(together, [0.054140, 0.286646, 0.639229, 0.797423, 0.713670, 0.392674, 0.032233], atol=6e-7)
        np.testing.assert_allclose(a_first, [0.004043, 0.021404, 0.049251, 0.113325, 0.260759, 0.600000, 0.967166], atol=6e-7)
        np.testing.assert_allclose(b_first + together + a_first, 1)

    def test_draws_of_latencies_agree(self):
        rng = np.random.default_rng(1)
        for soa in (0, 50):
            d = soa - 20 + rng.exponential(60, 400_000) - rng.exponential(40, 400_000)
            # Four standard errors.
            self.assertAlmostEqual(np.mean(np.abs(d) <= 80), independent_channels.probabilities(soa, **MODEL)[1], delta=4 * 0.5 / math.sqrt(400_000))

    def test_the_window_is_asymmetric_and_its_peak_below_94_percent_without_lapses(self):
        values = independent_channels.values_of(MODEL, np.array([-200, 200.0]))
        self.assertAlmostEqual(values["peak"], 0.798104, delta=1e-6)
        np.testing.assert_allclose((values["pss"], values["low75"], values["high75"]), (4.0, -55.4, 73.7), atol=0.05)

    def test_a_fit_recovers_the_channels_and_is_chosen_by_its_criterion(self):
        p = independent_channels.together(LEVELS, {**MODEL, "missed": 0, "false": 0})
        total = np.full(len(LEVELS), 2000.0)
        found = independent_channels.fit(LEVELS, total * p, total)
        for name, value in MODEL.items():
            self.assertAlmostEqual(found.params[name], value, delta=1.0, msg=name)
        free, forced = (fits.fit(LEVELS, total * p, total, "synchrony_window", forced_peak=held) for held in (False, True))
        self.assertLess(found.aic, free.aic)
        self.assertLess(free.aic, forced.aic)

    def test_the_slopes_of_the_likelihood_are_right(self):
        rng = np.random.default_rng(2)
        for _ in range(20):
            theta = np.concatenate([rng.uniform(-3, -1, 2), rng.uniform(-0.2, 0.2, 1), rng.uniform(-2.5, -1, 1), rng.uniform(0.005, 0.05, 2)])
            x, h = rng.uniform(-0.5, 0.5, 9), 1e-6
            exact = independent_channels.together_and_slopes(x, theta)[1]
            for i in range(6):
                step = h * np.eye(6)[i]
                rise = independent_channels.together_and_slopes(x, theta + step)[0] - independent_channels.together_and_slopes(x, theta - step)[0]
                np.testing.assert_allclose(rise / (2 * h), exact[:, i], atol=2e-4)

    def test_the_intervals_hold_the_edges(self):
        rng, held = np.random.default_rng(3), 0
        p = independent_channels.together(LEVELS, {**MODEL, "missed": 0.02, "false": 0.02})
        for _ in range(3):
            found = independent_channels.fit(LEVELS, rng.binomial(40, p).astype(float), np.full(len(LEVELS), 40.0), rng)
            for name, truth in (("low75", -55.383), ("high75", 73.736)):
                held += found.intervals[name][0] <= truth <= found.intervals[name][1]
        self.assertGreaterEqual(held, 4)  # 5.7 of 6 expected, standard deviation 0.5


class FreePeak(unittest.TestCase):
    def test_the_spread_does_not_depend_on_the_peak(self):
        total = np.full(9, 1000.0)
        levels = np.linspace(-200, 200, 9)
        spreads = []
        for peak in (0.95, 0.85, 0.75, 0.60):
            yes = total * peak * np.exp(-levels**2 / (2 * 60**2))
            free, forced = (fits.fit(levels, yes, total, "synchrony_window", forced_peak=held) for held in (False, True))
            self.assertAlmostEqual(free.params["sd"], 60, delta=0.01)
            self.assertAlmostEqual(free.derived["peak"], peak, delta=1e-4)
            spreads.append(forced.params["sd"])
            # The window at 75 % of the peak is always there, that at 75 % of the answers only below a higher peak.
            self.assertAlmostEqual(free.derived["window75"], 2 * 60 * math.sqrt(2 * math.log(4 / 3)), delta=0.05)
            if peak > 0.75:
                self.assertAlmostEqual(free.derived["absolute_high75"], 60 * math.sqrt(2 * math.log(peak / 0.75)), delta=0.05)
        self.assertTrue(math.isnan(free.derived["absolute_high75"]))
        # A peak held near 1 narrows the window.
        self.assertAlmostEqual(spreads[0], 60, delta=0.01)
        self.assertTrue(spreads[1] < 58 and spreads[2] < 55 and spreads[3] < 50, spreads)

    def test_the_intervals_hold_the_truth_at_every_peak(self):
        levels = np.array([-240, -160, -110, -70, -35, 0, 35, 70, 110, 160, 240.0])
        n = 100  # tests/measure/measure_coverage --only window: more
        for peak in (0.9, 0.65):
            p = 0.02 + (peak - 0.02) * np.exp(-((levels - 10) ** 2) / (2 * 60**2))
            yes = np.random.default_rng(4).binomial(20, p, (n, len(levels))).astype(float)
            many = fits.fit_many(levels, yes, np.full(yes.shape, 20.0), "synchrony_window")
            for name, truth in (("pss", 10), ("sd", 60)):
                low, high = intervals.of_many(many, name)
                held = np.mean((low <= truth) & (truth <= high))
                self.assertLess(abs(held - 0.95), 4 * math.sqrt(0.95 * 0.05 / n), (peak, name, held))


if __name__ == "__main__":
    unittest.main()
