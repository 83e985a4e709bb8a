"""QUEST+ chooses the most informative level, in one dimension and in two, and needs at most the published number of trials."""
import itertools
import math
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.psychophysics import trial_economy
from tactus.psychophysics.functions import FUNCTIONS
from tactus.psychophysics.observers import SimulatedObserver
from tactus.psychophysics.procedures import run
from tactus.psychophysics.quest_plus import QuestPlus

LEVELS = [float(x) for x in range(0, 121, 10)]
PARAMETERS = {"threshold": [20.0, 40.0, 60.0, 80.0], "sd": [8.0, 16.0, 32.0], "guess": [0.5], "lapse": [0.0, 0.04]}


def entropy(p):
    p = p[p > 0]
    return -(p * np.log(p)).sum()


class Quest(unittest.TestCase):
    def test_the_next_level_leaves_the_least_expected_entropy(self):
        # By the definition (Watson 2017), for each level both answers, from posteriors in several states.
        quest = QuestPlus("cumulative_gaussian", PARAMETERS, LEVELS, trials=12)
        observer = SimulatedObserver("cumulative_gaussian", {"threshold": 50, "sd": 15, "guess": 0.5, "lapse": 0.02}, 1)
        f = FUNCTIONS["cumulative_gaussian"]
        cells = list(itertools.product(*(PARAMETERS[n] for n in f.parameters)))
        while not quest.finished:
            expected = []
            for level in LEVELS:
                yes = np.array([f.p(level, **dict(zip(f.parameters, c))) for c in cells])
                expected.append(sum((quest.posterior * q).sum() * entropy(quest.posterior * q / (quest.posterior * q).sum()) for q in (yes, 1 - yes)))
            level = quest.next_level()
            self.assertAlmostEqual(expected[LEVELS.index(level)], min(expected), places=10)
            quest.answer(level, observer.answer(level))

    def test_the_posterior_is_bayes_rule(self):
        quest = QuestPlus("cumulative_gaussian", PARAMETERS, LEVELS, trials=4, prior={"threshold": [1, 2, 1, 0]})
        f = FUNCTIONS["cumulative_gaussian"]
        cells = list(itertools.product(*(PARAMETERS[n] for n in f.parameters)))
        want = np.array([{20.0: 1, 40.0: 2, 60.0: 1, 80.0: 0}[c[0]] for c in cells], dtype=float)
        for level, yes in ((40.0, True), (60.0, False), (100.0, True)):
            p = np.array([f.p(level, **dict(zip(f.parameters, c))) for c in cells])
            want *= p if yes else 1 - p
            quest.answer(level, yes)
        np.testing.assert_allclose(quest.posterior, want / want.sum(), atol=1e-12)

    def test_it_ends_at_the_requested_precision(self):
        quest = QuestPlus("cumulative_gaussian", {**PARAMETERS, "threshold": [float(x) for x in range(10, 101, 2)]}, LEVELS, stop_sd={"threshold": 6.0})
        run(quest, SimulatedObserver("cumulative_gaussian", {"threshold": 50, "sd": 12, "guess": 0.5, "lapse": 0.0}, 4))
        self.assertLessEqual(quest.estimate()["threshold_sd"], 6.0)
        self.assertTrue(10 < quest.done < 300)
        self.assertEqual(quest.expected, quest.done)

    def test_credible_intervals_are_quantiles_of_the_marginal(self):
        # A flat marginal over four values 20 apart covers 10 to 90.
        quest = QuestPlus("cumulative_gaussian", PARAMETERS, LEVELS, trials=4)
        low, high = quest.credible("threshold", 0.5)
        self.assertAlmostEqual(low, 30)
        self.assertAlmostEqual(high, 70)
        self.assertEqual(quest.credible("guess"), (0.5, 0.5))

    def test_two_senses_degraded_together_give_the_surface_of_their_thresholds(self):
        levels = [[0.0, 20.0, 40.0, 60.0, 80.0, 120.0, 160.0]] * 2
        parameters = {"threshold_a": [20.0, 40.0, 60.0, 80.0], "threshold_b": [40.0, 70.0, 100.0, 130.0], "slope": [3.0], "summation": [1.0, 3.0, 12.0],
                      "guess": [0.02], "lapse": [0.02]}
        truth = {"threshold_a": 40, "threshold_b": 100, "slope": 3, "summation": 3, "guess": 0.02, "lapse": 0.02}
        found = []
        for i in range(12):
            quest = QuestPlus("threshold_surface", parameters, levels, trials=150)
            history = run(quest, SimulatedObserver("threshold_surface", truth, [6, i]))
            found.append(quest.estimate())
        self.assertTrue(any(a > 0 and b > 0 for (a, b), _ in history), "both senses were never degraded together")
        for name, tolerance in (("threshold_a", 4), ("threshold_b", 8)):
            self.assertLess(abs(np.mean([f[name] for f in found]) - truth[name]), tolerance, name)
        self.assertLess(np.mean([f["entropy_bits"] for f in found]), 0.5 * math.log2(48))

    def test_invalid_input_is_refused(self):
        with self.assertRaisesRegex(ValueError, "coarser"):
            QuestPlus("cumulative_gaussian", {**PARAMETERS, "threshold": [float(x) for x in range(10 ** 6)]}, LEVELS, trials=1)
        with self.assertRaisesRegex(ValueError, "4 weights"):
            QuestPlus("cumulative_gaussian", PARAMETERS, LEVELS, trials=1, prior={"threshold": [1, 2]})
        certain = QuestPlus("cumulative_gaussian", {"threshold": [20.0, 30.0], "sd": [0.1], "guess": [0.0], "lapse": [0.0]}, LEVELS, trials=3)
        with self.assertRaisesRegex(ValueError, "impossible for every parameter"):
            certain.answer(120.0, False)


class Economy(unittest.TestCase):
    def test_the_ideal_sweat_factor_follows_from_the_information(self):
        # A yes/no observer with a logistic function has K = 4 scale^2; Weibull's has no closed form, and is searched on a finer axis here.
        x = np.linspace(-5, 5, 40001)
        e = 10 ** (3.5 * x / 20)
        p, by = 0.98 - 0.48 * np.exp(-e), 0.48 * np.exp(-e) * e * 3.5 / 20 * math.log(10)
        self.assertAlmostEqual(trial_economy.sweat_factor(3.5), (p * (1 - p) / by ** 2).min(), places=3)

    def test_the_number_of_trials_lies_between_the_ideal_and_the_published_one(self):
        # Kontsevich and Tyler 1999: a threshold within 2 dB takes less than 30 trials. The prior (40 dB wide) improves little on the ideal.
        threshold, _ = trial_economy.errors("threshold, slope", 60, 3)
        self.assertLessEqual(trial_economy.first_within(threshold, 2.0), 30)
        rms, ideal = math.sqrt((threshold[:, 99] ** 2).mean()), math.sqrt(trial_economy.sweat_factor(3.5) / 100)
        self.assertGreater(rms * (1 + 3 / math.sqrt(120)), ideal)  # three standard errors
        self.assertLess(rms, 2.2 * ideal)


if __name__ == "__main__":
    unittest.main()
