"""Tests of the battery: right answers, detection, limits and deciding properties agree with closed forms."""
import math
import pathlib
import sys
import types
import unittest

import numpy as np
from scipy import stats

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.battery import answers, conditions, curves, deciding, limits, perceivers
from tactus.information import degraded, pictures

TYPICAL = perceivers.Perceiver({}, 0.0)
DRAWS = 40_000


class OneFeature:
    """The features of a task with one direction of a sound: -1 and 1 degrees undegraded. shift(condition, seed): added by a degradation."""

    def __init__(self, shift, sd=1.0, wrong=0.0, variants=1):
        self.task = types.SimpleNamespace(name="one", senses=("audio",))
        self.shape, self.shift, self.sd, self.wrong = (2, variants), shift, sd, wrong

    def features(self, sense, condition, seed):
        shift = self.shift(condition, seed) if condition.operator else 0.0
        direction = np.repeat(np.array([-1.0, 1.0])[:, None], self.shape[1], axis=1) + shift
        return np.stack([np.ones(self.shape), direction], axis=2), np.stack([np.full(self.shape, 0.01), np.full(self.shape, self.sd)], axis=2)

    def columns(self, sense):
        return np.array([0, 1]), np.array(["heard", "direction"]), np.array([0.0, self.wrong])


def success(stored, condition, expectation, perceiver=TYPICAL):
    return answers.Question(answers.Parts(stored), {"audio": condition} if condition.operator else {}, expectation).success(perceiver, DRAWS, 1)


class Answers(unittest.TestCase):
    delay, jitter = conditions.Condition("delay", 40), conditions.Condition("jitter", 40)

    def assert_share(self, expected, found, draws=DRAWS):
        self.assertLess(abs(found - expected), 4.5 * math.sqrt(max(expected * (1 - expected), 1e-4) / draws), (expected, found))

    def test_undegraded_answers_follow_the_distance_of_the_values(self):
        for sd in (0.5, 1, 3):
            self.assert_share(stats.norm.cdf(1 / sd), success(OneFeature(None, sd), conditions.UNDEGRADED, answers.NAIVE))

    def test_a_constant_shift_misleads_a_naive_player_and_not_an_adapted_one(self):
        for shift in (0.5, 2.0, -3.0):
            stored = OneFeature(lambda condition, seed: shift)
            self.assert_share((stats.norm.cdf(1 + shift) + stats.norm.cdf(1 - shift)) / 2, success(stored, self.delay, answers.NAIVE))
            self.assert_share(stats.norm.cdf(1), success(stored, self.delay, answers.ADAPTED))

    def test_an_adapted_player_of_a_drawn_operator_is_refused(self):
        with self.assertRaises(ValueError):
            success(OneFeature(lambda condition, seed: 0.0), self.jitter, answers.ADAPTED)

    def test_the_draws_of_a_drawn_operator_count_equally(self):
        stored = OneFeature(lambda condition, seed: (-2.0, 0.0, 2.0)[seed - 1])
        expected = np.mean([(stats.norm.cdf(1 + shift) + stats.norm.cdf(1 - shift)) / 2 for shift in (-2.0, 0.0, 2.0)])
        self.assert_share(expected, success(stored, self.jitter, answers.NAIVE))

    def test_an_outlier_in_one_feature_does_not_outweigh_another_feature(self):
        """Two features with the same information; one is shifted so far that its tail alone would decide."""
        class Two(OneFeature):
            def features(self, sense, condition, seed):
                values, sds = super().features(sense, condition, seed)
                far = values[:, :, 1:] + (60.0 if condition.operator else 0.0)
                return np.concatenate([values, far], axis=2), np.concatenate([sds, sds[:, :, 1:]], axis=2)

            def columns(self, sense):
                return np.array([0, 1, 2]), np.array(["heard", "direction", "loudness"]), np.zeros(3)
        found = success(Two(lambda condition, seed: 0.0, sd=0.5), self.delay, answers.NAIVE)
        self.assertGreater(found, stats.norm.cdf(1 / 0.5) - 0.03)

    def test_a_late_first_sound_leaves_the_interval_between_two_sounds(self):
        class Times(OneFeature):
            def features(self, sense, condition, seed):
                values, sds = super().features(sense, condition, seed)
                late = np.full((2, 1, 1), 80.0 if condition.operator else 0.0)
                return np.concatenate([values[:, :, :1], late, values[:, :, 1:]], axis=2), np.concatenate([sds, sds[:, :, 1:]], axis=2)

            def columns(self, sense):
                return np.array([0, 1, 1]), np.array(["heard", "times", "times"]), np.zeros(3)
        stored = Times(lambda condition, seed: 0.0)
        self.assertAlmostEqual(success(stored, conditions.UNDEGRADED, answers.NAIVE), success(stored, self.delay, answers.NAIVE), delta=1e-9)

    def test_silence_leaves_the_answer_to_the_other_senses(self):
        class Silent(OneFeature):
            def features(self, sense, condition, seed):
                values, sds = super().features(sense, condition, seed)
                return (values * 0, sds) if condition.operator else (values, sds)
        self.assert_share(0.5, success(Silent(lambda condition, seed: 0.0), self.delay, answers.NAIVE))

    def test_lapses_and_confusions_lower_the_answers_to_chance_in_proportion(self):
        certain = OneFeature(None, sd=0.01)
        self.assert_share(0.8 + 0.2 / 2, success(certain, conditions.UNDEGRADED, answers.NAIVE, perceivers.Perceiver({}, 0.2)))
        self.assert_share(0.7 + 0.3 / 2, success(OneFeature(None, sd=0.01, wrong=0.3), conditions.UNDEGRADED, answers.NAIVE))

    def test_the_noise_of_a_player_counts(self):
        noisy = perceivers.Perceiver({"azimuth noise": 3.0}, 0.0)
        self.assert_share(stats.norm.cdf(1 / 3), success(OneFeature(None), conditions.UNDEGRADED, answers.NAIVE, noisy))

    def test_detection_is_that_of_two_intervals_with_known_signals(self):
        for shift in (0.3, 1.0, 2.5):
            comparison = answers.Comparison(answers.Parts(OneFeature(lambda condition, seed: shift, variants=2)), "audio", self.delay)
            self.assert_share(stats.norm.cdf(shift / math.sqrt(2)), comparison.right(TYPICAL, 400, 1), 400)
        nothing = answers.Comparison(answers.Parts(OneFeature(lambda condition, seed: 0.0)), "audio", self.delay)
        self.assertEqual(0.5, nothing.right(TYPICAL, 50, 1))
        inattentive = perceivers.Perceiver({}, 1.0)
        self.assertEqual(0.5, answers.Comparison(answers.Parts(OneFeature(lambda condition, seed: 9.0)), "audio", self.delay).right(inattentive, 50, 1))

    def test_pictures_are_seen_by_the_distance_of_their_pixels(self):
        size = degraded.SIZE[0] * degraded.SIZE[1] * 3 // degraded.SKIPPED**2
        sets = {"": [np.zeros(size, np.uint8), np.zeros(size, np.uint8)], "delay": [np.zeros(size, np.uint8)] * 2}
        sets[""][1] = sets[""][1].copy()
        sets[""][1][:30] = 20
        stored = types.SimpleNamespace(task=types.SimpleNamespace(senses=("visual",)), shape=(2, 1), pixels=lambda condition, seed: sets[condition.operator])
        distance = 20 / 255 * math.sqrt(30) / pictures.channel_sd(degraded.SIZE[0]) * degraded.SKIPPED
        for factor in (1.0, 2.0, 20.0):
            perceiver = perceivers.Perceiver({"visual noise": factor}, 0.0)
            self.assert_share(stats.norm.cdf(distance / factor / 2), answers.Question(answers.Parts(stored), {}, answers.NAIVE).success(perceiver, DRAWS, 1))
        frozen = answers.Question(answers.Parts(stored), {"visual": self.delay}, answers.ADAPTED)
        self.assert_share(0.5, frozen.success(TYPICAL, DRAWS, 1))

    def test_the_limits_of_players_follow_their_noise(self):
        stored = OneFeature(lambda condition, seed: condition.level / 100)  # degrees for each ms
        people = [perceivers.Perceiver({"azimuth noise": factor}, 0.0) for factor in (0.3, 0.5, 0.7)]
        curve = curves.measure(answers.Parts(stored), "audio", "delay", people, 20_000, 1)
        found = curve.limits(answers.NAIVE)
        for perceiver, limit in zip(people, found):
            sd = perceiver.factors["azimuth noise"]
            loss = lambda ms: stats.norm.cdf(1 / sd) - (stats.norm.cdf((1 + ms / 100) / sd) + stats.norm.cdf((1 - ms / 100) / sd)) / 2
            exact = next(ms for ms in np.arange(10, 640, 0.5) if loss(ms) >= curves.MARGIN)
            self.assertTrue(0.8 < limit / exact < 1.25, (sd, limit, exact))
        self.assertEqual([limits.ABOVE] * 3, curve.limits(answers.ADAPTED))


class Noise(unittest.TestCase):
    def test_the_typical_player_has_the_typical_noise(self):
        row = {"visual noise": 0.12, "azimuth noise": 4, "force Weber": 0.09, "force direction noise": 22, "stiffness Weber": 0.15, "thermal Weber": 0.43, "lapse": 0.02}
        found = perceivers.of_properties(row)
        self.assertEqual(perceivers.TYPICAL.lapse, found.lapse)
        for factor in found.factors.values():
            self.assertAlmostEqual(1.0, factor, 12)


class Limits(unittest.TestCase):
    def test_the_rising_fit_is_the_nearest_curve_that_never_falls(self):
        random = np.random.default_rng(1)
        for _ in range(200):
            y = random.normal(size=random.integers(1, 8))
            # Max-min formula of the isotonic regression (Robertson, Wright and Dykstra 1988, theorem 1.4.4).
            exact = [max(min(y[i:j + 1].mean() for j in range(k, len(y))) for i in range(k + 1)) for k in range(len(y))]
            np.testing.assert_allclose(limits.rising(y), exact, atol=1e-12)

    def test_a_crossing_lies_between_its_levels_on_a_logarithmic_axis(self):
        self.assertAlmostEqual(20.0, limits.crossing((10, 40, 80), (0.0, 0.2, 0.3), 0.1), 9)
        self.assertAlmostEqual(50.0, limits.crossing((100, 25, 5), (0.0, 0.2, 0.3), 0.1), 9)
        self.assertEqual(limits.BELOW, limits.crossing((10, 20), (0.2, 0.3), 0.1))
        self.assertEqual(limits.ABOVE, limits.crossing((10, 20), (0.0, 0.05), 0.1))
        self.assertAlmostEqual(30.0, limits.crossing((10, 30, 60, 90), (0, 0.12, 0.1, 0.08), 0.1), 6)  # pools to a mean of 0.1, but for rounding

    def test_quantiles_order_rates_from_mild_to_severe(self):
        rates = (100, 50, 10)
        self.assertEqual(limits.BELOW, limits.at_quantile([20.0, limits.ABOVE, limits.BELOW], rates, 0.1))
        self.assertEqual(20.0, limits.at_quantile([20.0, limits.ABOVE, limits.BELOW], rates, 0.5))
        self.assertEqual(15.0, limits.at_quantile([40.0, 15.0, limits.ABOVE, 20.0], rates, 0.75))
        self.assertEqual(limits.ABOVE, limits.at_quantile([40.0, 15.0, limits.ABOVE], rates, 0.9))

    def test_the_interval_of_the_median_holds_the_true_median(self):
        random = np.random.default_rng(2)
        for players in (20, 91, 128):
            held = [low <= 1.0 <= high for low, high in (limits.median_interval(np.exp(random.normal(size=players)), (1, 2)) for _ in range(2000))]
            self.assertGreater(np.mean(held), 0.95 - 3 * math.sqrt(0.05 * 0.95 / 2000))
            self.assertLess(np.mean(held), 0.98 if players > 20 else 0.995)

    def test_two_limits_are_compared_by_the_severity_that_they_tolerate(self):
        self.assertEqual(2.0, limits.tolerated(40.0, 20.0, (10, 80)))
        self.assertEqual(0.5, limits.tolerated(40.0, 20.0, (80, 10)))
        self.assertEqual(math.inf, limits.tolerated(limits.ABOVE, 20.0, (80, 10)))
        self.assertEqual(0.0, limits.tolerated(limits.BELOW, 20.0, (10, 80)))
        self.assertTrue(math.isnan(limits.tolerated(limits.ABOVE, limits.ABOVE, (10, 80))))


class Deciding(unittest.TestCase):
    def test_total_indices_are_those_of_the_closed_form(self):
        random = np.random.default_rng(3)
        a, b, c = random.normal(size=(3, 512))
        properties = {"a": np.exp(a), "b": np.exp(b), "c": np.exp(c)}
        total, explained = deciding.total_indices(properties, np.exp(2 * a + b + 0.5 * a * b))
        # Variances 4, 1 and 1/4 of the terms: totals (4 + 1/4) / 5.25 and (1 + 1/4) / 5.25.
        self.assertAlmostEqual(4.25 / 5.25, total["a"], delta=0.04)
        self.assertAlmostEqual(1.25 / 5.25, total["b"], delta=0.04)
        self.assertLess(total["c"], 0.02)
        self.assertGreater(explained, 0.95)

    def test_noise_has_no_deciding_property(self):
        random = np.random.default_rng(4)
        properties = {name: random.normal(size=128) for name in "abc"}
        self.assertLess(deciding.total_indices(properties, np.exp(random.normal(size=128)))[1], 0.1)
        self.assertEqual((None, True), (lambda total, q: (total, math.isnan(q)))(*deciding.total_indices(properties, np.ones(128))))


class Conditions(unittest.TestCase):
    def test_levels_go_from_mild_to_severe(self):
        for sense in ("visual", "audio", "haptic", "thermal"):
            for operator, levels in conditions.curves(sense).items():
                rising = operator not in ("rate", "resolution")
                self.assertEqual(sorted(levels, reverse=not rising), list(levels), (sense, operator))


if __name__ == "__main__":
    unittest.main()
