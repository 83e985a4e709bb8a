"""Psychometric functions agree with published values, and their derivatives with differences."""
import math
import pathlib
import sys
import unittest

import numpy as np
from scipy.stats import norm

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.psychophysics import likelihood
from tactus.psychophysics.functions import FUNCTIONS, function
from tactus.psychophysics.observers import SimulatedObserver

SOME = {"pss": 12.0, "sd": 40.0, "threshold": 50.0, "scale": 9.0, "slope": 2.5, "guess": 0.05, "lapse": 0.03}
ONE = [f for f in FUNCTIONS.values() if f.dimensions == 1]


def of(f, **more):
    return {**{n: SOME[n] for n in f.parameters}, **more}


class Functions(unittest.TestCase):
    def test_the_limits_are_guess_and_lapse(self):
        for f in ONE:
            far = [1e6] if f.name.startswith("weibull") else [-1e6, 1e6]
            got = f.p(np.array(far), **of(f))
            want = {"synchrony_window": [0.05, 0.05], "order": [0.015, 0.985], "weibull": [0.97], "weibull_dB": [0.97]}.get(f.name, [0.05, 0.97])
            np.testing.assert_allclose(got, want, atol=1e-9, err_msg=f.name)

    def test_values_at_the_location(self):
        self.assertAlmostEqual(float(FUNCTIONS["synchrony_window"].p(12.0, pss=12, sd=40, guess=0.1, lapse=0.02)), 0.98)
        self.assertAlmostEqual(float(FUNCTIONS["order"].p(12.0, pss=12, sd=40, lapse=0.06)), 0.5)
        self.assertAlmostEqual(float(FUNCTIONS["cumulative_gaussian"].p(50.0, threshold=50, sd=10, guess=0.5, lapse=0)), 0.75)
        # Watson 1979: Weibull's threshold with guess rate 0.5 is at 1 - 0.5 / e = 0.816 right.
        self.assertAlmostEqual(float(FUNCTIONS["weibull"].p(50.0, threshold=50, slope=3.5, guess=0.5, lapse=0)), 1 - 0.5 / math.e)

    def test_decibels_are_the_same_as_their_ratios(self):
        x = np.array([-30.0, -22, -20, -15])
        in_dB = FUNCTIONS["weibull_dB"].p(x, threshold=-20, slope=3.5, guess=0.5, lapse=0.02)
        np.testing.assert_allclose(in_dB, FUNCTIONS["weibull"].p(10 ** (x / 20), threshold=0.1, slope=3.5, guess=0.5, lapse=0.02), rtol=1e-12)

    def test_the_core_of_order_is_the_normal_distribution(self):
        x = np.linspace(-150, 150, 31)
        np.testing.assert_allclose(FUNCTIONS["order"].p(x, pss=5, sd=30, lapse=0), norm(5, 30).cdf(x), atol=1e-12)
        # 75 % at 0.6745 sd above: the just noticeable difference.
        self.assertAlmostEqual(float(FUNCTIONS["order"].p(5 + 0.6744898 * 30, pss=5, sd=30, lapse=0)), 0.75, places=6)
        self.assertAlmostEqual(FUNCTIONS["order"].derived(5, 30, 0)["jnd"], 20.2347, places=3)

    def test_three_quarters_of_a_window(self):
        f = FUNCTIONS["synchrony_window"]
        derived = f.derived(10, 50, 0.0)
        self.assertAlmostEqual(derived["window75"], 2 * 50 * 0.758528, places=3)  # sqrt(2 ln(4/3))
        for edge in ("low75", "high75"):
            self.assertAlmostEqual(float(f.p(derived[edge], pss=10, sd=50, guess=0, lapse=0)), 0.75)
        self.assertAlmostEqual(derived["high75"] - derived["low75"], derived["window75"])

    def test_threshold75_is_the_level_of_75_percent_right_answers_without_lapses(self):
        for name in ("cumulative_gaussian", "logistic", "weibull", "weibull_dB"):
            f = FUNCTIONS[name]
            for guess in (0.0, 0.04, 0.5):
                params = of(f, guess=guess, lapse=0.0)
                m, s, _, _ = f.inner(params)
                self.assertAlmostEqual(float(f.p(f.derived(float(m), float(s), guess)["threshold75"], **params)), 0.75, msg=f"{name} {guess}")

    def test_derivatives_agree_with_differences(self):
        for f in ONE:
            z = np.linspace(-0.4, 0.5, 7)[None]
            for anchor in [None, *f.anchors()]:
                theta = np.array([[0.05, math.log(0.2), 0.04, 0.03]])
                by = likelihood.probability(f, z, theta, anchor)[1][0]
                for i in range(4):
                    if f.symmetric and i == likelihood.GUESS:
                        continue
                    step = np.zeros((1, 4))
                    step[0, i] = 1e-6
                    up, down = (likelihood.probability(f, z, theta + sign * step, anchor)[0][0] for sign in (1, -1))
                    np.testing.assert_allclose(by[:, i], (up - down) / 2e-6, atol=1e-6, err_msg=f"{f.name} {anchor} {i}")

    def test_independent_senses_show_probability_summation(self):
        f = FUNCTIONS["threshold_surface"]
        params = {"threshold_a": 40, "threshold_b": 90, "slope": 2.5, "summation": 2.5, "guess": 0, "lapse": 0}
        alone_a, alone_b, both = f.p(np.array([[30, 0], [0, 60], [30, 60]]), **params)
        self.assertAlmostEqual(both, 1 - (1 - alone_a) * (1 - alone_b))
        self.assertAlmostEqual(alone_a, float(FUNCTIONS["weibull"].p(30, threshold=40, slope=2.5, guess=0, lapse=0)))

    def test_unknown_names_are_refused_with_the_known_ones(self):
        with self.assertRaisesRegex(ValueError, "'gauss'; choose one of synchrony_window"):
            function("gauss")
        with self.assertRaisesRegex(ValueError, "guess is missing"):
            FUNCTIONS["weibull"].p(1.0, threshold=1, slope=2, lapse=0)
        with self.assertRaisesRegex(ValueError, "guess is missing or unknown"):
            SimulatedObserver("order", {"pss": 0, "sd": 10, "lapse": 0, "guess": 0.5}, 1)


class Observers(unittest.TestCase):
    def test_answers_follow_the_function_and_depend_on_the_seed_only(self):
        params = {"pss": 10, "sd": 40, "guess": 0.02, "lapse": 0.03}
        first, again = (SimulatedObserver("synchrony_window", params, 5) for _ in range(2))
        said = [first.answer(50.0) for _ in range(4000)]
        self.assertEqual(said, [again.answer(50.0) for _ in range(4000)])
        p = first.probability(50.0)
        self.assertLess(abs(np.mean(said) - p), 4 * math.sqrt(p * (1 - p) / 4000))  # four standard errors


if __name__ == "__main__":
    unittest.main()
