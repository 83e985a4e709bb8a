"""Fits find the maximum of the likelihood, and intervals have the nominal coverage."""
import math
import pathlib
import sys
import unittest
from unittest import mock

import numpy as np
from scipy.optimize import minimize

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.psychophysics import fits, intervals, posterior
from tactus.psychophysics.functions import FUNCTIONS

SOA = np.array([-240, -160, -110, -70, -35, 0, 35, 70, 110, 160, 240.0])
DELAYS = np.array([0, 12, 24, 36, 48, 60, 75, 90, 110.0])


def answers(name, levels, count, truth, n, seed):
    """(yes, total) (n, k)."""
    dice = np.random.default_rng(seed)
    p = FUNCTIONS[name].p(levels, **truth)
    yes = dice.binomial(count, p, size=(n, len(levels))).astype(float)
    return yes, np.full(yes.shape, float(count))


class Fits(unittest.TestCase):
    def test_the_maximum_agrees_with_an_independent_search(self):
        for name, levels, truth, fixed in (("order", SOA, {"pss": 10, "sd": 60, "lapse": 0.03}, {}),
                                           ("cumulative_gaussian", DELAYS, {"threshold": 45, "sd": 15, "guess": 0.5, "lapse": 0.02}, {"guess": 0.5}),
                                           ("weibull", DELAYS[1:], {"threshold": 45, "slope": 3, "guess": 0.5, "lapse": 0.02}, {"guess": 0.5})):
            f = FUNCTIONS[name]
            for yes, total in zip(*answers(name, levels, 30, truth, 5, 3)):
                got = fits.fit(levels, yes, total, name, fixed)
                self.assertTrue(got.converged)
                free = [n for n in f.parameters if n not in fixed]

                def loss(x):
                    p = np.clip(f.p(levels, **dict(zip(free, x)), **fixed), 1e-12, 1 - 1e-12)
                    return -(yes * np.log(p) + (total - yes) * np.log1p(-p)).sum()

                bounds = [f.bounds["lapse"] if n == "lapse" else ((1e-3, None) if n != "pss" else (None, None)) for n in free]
                other = min((minimize(loss, [scale * truth[n] if n not in ("pss", "lapse") else truth[n] for n in free], bounds=bounds, method="L-BFGS-B")
                             for scale in (0.7, 1.0, 1.4)), key=lambda r: r.fun)
                self.assertGreater(got.log_likelihood, -other.fun - 1e-4, name)

    def test_many_fits_at_once_equal_single_fits(self):
        truth = {"pss": 20, "sd": 60, "guess": 0.02, "lapse": 0.02}
        yes, total = answers("synchrony_window", SOA, 20, truth, 12, 4)
        many = fits.fit_many(SOA, yes, total, "synchrony_window")
        for i in range(len(yes)):
            alone = fits.fit(SOA, yes[i], total[i], "synchrony_window")
            self.assertAlmostEqual(alone.params["pss"], float(many.estimates("pss")[i]), places=2)
            self.assertAlmostEqual(alone.derived["window75"], float(many.estimates("window75")[i]), places=1)

    def test_units_do_not_matter(self):
        truth = {"pss": 10, "sd": 60, "lapse": 0.03}
        (yes,), (total,) = answers("order", SOA, 20, truth, 1, 5)
        in_ms, in_ns = fits.fit(SOA, yes, total, "order"), fits.fit(SOA * 1e6, yes, total, "order")
        self.assertAlmostEqual(in_ms.params["sd"], in_ns.params["sd"] / 1e6, places=4)
        for a, b in zip(fits.interval(in_ms, "jnd"), fits.interval(in_ns, "jnd")):
            self.assertAlmostEqual(a, b / 1e6, places=3)

    def test_levels_without_trials_have_no_effect(self):
        truth = {"pss": 10, "sd": 60, "lapse": 0.03}
        (yes,), (total,) = answers("order", SOA, 20, truth, 1, 6)
        padded = fits.fit(np.append(SOA, 9e9), np.append(yes, 0), np.append(total, 0), "order")
        self.assertAlmostEqual(padded.params["pss"], fits.fit(SOA, yes, total, "order").params["pss"], places=9)

    def test_deviance_of_many_trials_is_chi_square(self):
        # 11 levels minus 3 parameters; lapse rates of 0.03 are mostly inside their bounds.
        yes, total = answers("order", SOA, 400, {"pss": 10, "sd": 80, "lapse": 0.03}, 100, 7)
        deviances = [fits.fit(SOA, y, t, "order").deviance for y, t in zip(yes, total)]
        self.assertLess(abs(np.mean(deviances) - 8), 4 * math.sqrt(2 * 8 / 100))

    def test_answers_without_a_threshold_do_not_converge(self):
        total = np.full(len(SOA), 20.0)
        for name in ("order", "synchrony_window", "cumulative_gaussian"):
            self.assertFalse(fits.fit(SOA, total * 0, total, name).converged, name)
            self.assertFalse(fits.fit(SOA, total, total, name).converged, name)
        self.assertFalse(fits.fit(SOA, total / 2, total, "order").converged)

    def test_a_step_has_a_threshold_and_only_a_bound_of_its_slope(self):
        total = np.full(len(DELAYS), 20.0)
        step = fits.fit(DELAYS, np.where(DELAYS > 50, 20.0, 0.0), total, "cumulative_gaussian", {"guess": 0.0, "lapse": 0.0})
        self.assertTrue(48 < step.params["threshold"] < 60)
        low, high = fits.interval(step, "sd", method="profile")
        self.assertEqual(low, 0.0)
        self.assertTrue(0 < high < 20)

    def test_a_fixed_parameter_stays_and_has_no_width(self):
        (yes,), (total,) = answers("cumulative_gaussian", DELAYS, 30, {"threshold": 45, "sd": 15, "guess": 0.5, "lapse": 0.02}, 1, 8)
        got = fits.fit(DELAYS, yes, total, "cumulative_gaussian", {"guess": 0.5})
        self.assertEqual((got.params["guess"], fits.interval(got, "guess")), (0.5, (0.5, 0.5)))
        low, high = fits.interval(got, "lapse")
        self.assertTrue(0 <= low <= got.params["lapse"] <= high <= 0.06)

    def test_invalid_answers_are_refused(self):
        for words, levels, yes, total, name, fixed in (
                ("more yes than trials", [1, 2], [3, 1], [2, 2], "order", {}), ("not finite numbers", [1, float("nan")], [1, 1], [2, 2], "order", {}),
                ("has no trials", [1, 2], [0, 0], [0, 0], "order", {}), ("'guess' of order cannot be fixed", [1, 2], [1, 1], [2, 2], "order", {"guess": 0}),
                ("QUEST", [1, 2], [1, 1], [2, 2], "threshold_surface", {})):
            with self.assertRaisesRegex(ValueError, words):
                fits.fit(levels, yes, total, name, fixed)


class Intervals(unittest.TestCase):
    def test_all_kinds_agree_when_there_are_many_trials(self):
        truth = {"pss": 15, "sd": 70, "guess": 0.03, "lapse": 0.03}
        (yes,), (total,) = answers("synchrony_window", SOA, 500, truth, 1, 9)
        got = fits.fit(SOA, yes, total, "synchrony_window")
        for name in ("pss", "sd", "low75"):
            ends = [fits.interval(got, name, method=m, rng=np.random.default_rng(1)) for m in intervals.METHODS]
            width = ends[0][1] - ends[0][0]
            for low, high in ends[1:]:
                self.assertLess(max(abs(low - ends[0][0]), abs(high - ends[0][1])), 0.12 * width, name)

    def test_a_profile_ends_where_the_likelihood_has_dropped(self):
        truth = {"threshold": 45, "sd": 15, "guess": 0.5, "lapse": 0.0}
        (yes,), (total,) = answers("cumulative_gaussian", DELAYS, 40, truth, 1, 10)
        fixed = {"guess": 0.5, "lapse": 0.0}
        got = fits.fit(DELAYS, yes, total, "cumulative_gaussian", fixed)

        def best(threshold):
            sds = np.geomspace(2, 100, 4000)
            p = np.clip(FUNCTIONS["cumulative_gaussian"].p(DELAYS, threshold=threshold, sd=sds[:, None], **fixed), 1e-10, 1 - 1e-10)
            return (yes * np.log(p) + (total - yes) * np.log1p(-p)).sum(axis=1).max()

        for end in fits.interval(got, "threshold", method="profile"):
            self.assertAlmostEqual(got.log_likelihood - best(end), 3.841459 / 2, delta=0.01)  # chi-square of one degree, 0.95

    def test_they_cover_the_truth_in_95_of_100(self):
        # 300 sessions: the standard error is 1.3 %, and four of them are allowed; tests/measure/measure_recovery is more precise.
        truth = {"pss": 12, "sd": 60, "guess": 0.02, "lapse": 0.02}
        yes, total = answers("synchrony_window", SOA, 20, truth, 300, 11)
        many = fits.fit_many(SOA, yes, total, "synchrony_window")
        for method in ("posterior", "profile"):
            for name in ("pss", "sd"):
                low, high = intervals.of_many(many, name, method=method)
                held = ((low <= truth[name]) & (truth[name] <= high)).mean()
                self.assertLess(abs(held - 0.95), 4 * math.sqrt(0.95 * 0.05 / 300), f"{method} {name}")

    def test_the_intervals_of_one_fit_share_their_posteriors_and_equal_separate_ones(self):
        truth = {"pss": 20, "sd": 60, "guess": 0.02, "lapse": 0.02}
        (yes,), (total,) = answers("synchrony_window", SOA, 20, truth, 1, 14)
        names = ("pss", "sd", "window75", "low75", "high75", "guess", "lapse")
        with mock.patch.object(posterior, "marginals", side_effect=posterior.marginals) as computed:
            together = fits.fit(SOA, yes, total, "synchrony_window")
            shared = [fits.interval(together, name) for name in names]
            self.assertEqual(computed.call_count, 3)  # about the location, and about each edge of the window
        self.assertEqual(shared, [fits.interval(fits.fit(SOA, yes, total, "synchrony_window"), name) for name in names])
        self.assertEqual(together.many.rows(slice(0, 1)).posteriors, {})

    def test_a_higher_level_gives_a_wider_interval(self):
        (yes,), (total,) = answers("order", SOA, 20, {"pss": 10, "sd": 60, "lapse": 0.03}, 1, 12)
        got = fits.fit(SOA, yes, total, "order")
        narrow, usual, wide = (fits.interval(got, "pss", level) for level in (0.5, 0.95, 0.99))
        self.assertTrue(wide[0] < usual[0] < narrow[0] < got.params["pss"] < narrow[1] < usual[1] < wide[1])

    def test_unknown_kinds_and_names_are_refused(self):
        (yes,), (total,) = answers("order", SOA, 20, {"pss": 10, "sd": 60, "lapse": 0.03}, 1, 13)
        got = fits.fit(SOA, yes, total, "order")
        for words, name, more in (("choose posterior", "pss", {"method": "wald"}), ("no parameter 'threshold'", "threshold", {}), ("not between", "pss", {"level": 95})):
            with self.assertRaisesRegex(ValueError, words):
                fits.interval(got, name, **more)


if __name__ == "__main__":
    unittest.main()
