"""Two presses of a trial: their profiles and columns, and an observer that judges the felt stiffness and ignores the level."""
import dataclasses
import math
import pathlib
import sys
import types
import unittest

import numpy as np

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.psychophysics import observers
from tactus.refusal import Refusal
from tactus.study import check, conditions, duration, power, power_felt, quantities, simulated, stimuli, study_file
from tactus.study.plan import Plan, Trial

WEBER, LAPSE = 0.155, 0.02
SPRING_N_m = 40.0


class TrialRunnerClient:
    """A trial runner whose hand presses a spring of SPRING_N_m, or of `softer` times that if touch is degraded."""

    def __init__(self, softer):
        self.softer, self.profiles, self.felt, self.moved = softer, [], [], False

    def apply_profile(self, profile, _):
        self.profiles.append(profile)
        return True

    def wait_for(self, condition, _):
        return bool(condition())

    def send(self, press):
        stiffness = SPRING_N_m * (self.softer if "haptic" in self.profiles[-1].split(">", 1)[1] else 1)
        depth = press["depth_m"] * np.sin(np.linspace(0, math.pi, 200)) ** 2
        self.felt += [(i, -z, stiffness * z) for i, z in enumerate(depth)]
        self.moved = True


class TwoPresses(unittest.TestCase):
    def setUp(self):
        self.study = study_file.read("haptic_delay_stiffness")

    def trial(self, degraded, level=20.0, condition=None):
        return Trial(1, 1, condition or self.study.conditions[0], level, degraded)

    def test_the_stiffness_of_each_and_which_was_degraded_are_columns(self):
        for degraded in (0, 1):
            observed = stimuli.press(TrialRunnerClient(0.5), self.study, self.trial(degraded), 1)
            wanted = [SPRING_N_m * (0.5 if i == degraded else 1) for i in (0, 1)]
            self.assertEqual(observed.missed, "")
            np.testing.assert_allclose(observed.stiffnesses_N_m, wanted, rtol=1e-6)
            self.assertEqual([observed.row[name] for name in ("stiffness_first_n_m", "stiffness_second_n_m", "degraded_interval")], [*wanted, degraded + 1])

    def test_the_other_press_is_undegraded_for_every_operator(self):
        for operator, (_, _, least, most) in quantities.OPERATORS.items():
            level = least if quantities.nothing(operator, most) else most
            condition = conditions.Condition("c", "factor", factors=(conditions.Factor("haptic", operator),), levels=(level,))
            runner = TrialRunnerClient(1.0)
            stimuli.press(runner, self.study, self.trial(1, level, condition), 1)
            with self.subTest(operator):
                self.assertNotIn("haptic", runner.profiles[0].split(">", 1)[1])
                self.assertIn('<degrade modality="haptic"', runner.profiles[1])

    def test_the_observer_judges_the_felt_stiffness_and_ignores_the_level(self):
        participant = simulated.Participant(self.study, "P01", 1, "nowhere", types.SimpleNamespace())
        found = lambda degraded, level, stiffnesses: np.mean([participant.is_yes(dataclasses.replace(self.trial(degraded, level), number=n), 1, level,
                                                              stimuli.Observed(stiffnesses_N_m=stiffnesses)) for n in range(400)])
        for level in (5.0, 40.0):
            self.assertAlmostEqual(found(0, level, (40.0, 40.0)), 0.5, delta=0.1)                    # four standard errors of 400 answers
            self.assertAlmostEqual(found(1, level, (40.0 * (1 + WEBER), 40.0)), 0.745, delta=0.09)  # three of four, and lapses
            self.assertGreater(found(0, level, (20.0, 40.0)), 0.95)
            self.assertLess(found(0, level, (40.0, 20.0)), 0.05)  # the delayed press was the stiffer one: not found

    def test_a_session_includes_the_presses_with_approach_and_return(self):
        parts = dict(duration.of_trial(self.study))
        self.assertEqual(parts["presses"], 2 * (self.study.stimulus.period_s * self.study.stimulus.times + 2 * duration.APPROACH_S))


class ThePresser(unittest.TestCase):
    def test_a_difference_of_the_weber_fraction_gives_75_percent_right_answers(self):
        sure = observers.Presser(WEBER, 0.0, 1)
        self.assertAlmostEqual(sure.first_is_softer(50, 50 * (1 + WEBER)), 0.75)
        self.assertAlmostEqual(sure.first_is_softer(50 * (1 + WEBER), 50), 0.25)
        self.assertEqual(sure.first_is_softer(50, 50), 0.5)
        self.assertAlmostEqual(observers.Presser(WEBER, 0.1, 1).first_is_softer(1, 1000), 0.95)

    def test_only_the_ratio_counts_and_zero_stiffness_is_the_softest(self):
        p = observers.Presser(WEBER, LAPSE, 1)
        self.assertAlmostEqual(p.first_is_softer(10, 11), p.first_is_softer(1000, 1100))
        self.assertGreater(p.first_is_softer(-3, 1), 0.98)
        self.assertEqual(p.first_is_softer(-3, 0), 0.5)

    def test_answers_have_the_right_probability_and_depend_on_the_seed_alone(self):
        said = [observers.Presser(WEBER, LAPSE, n).softer(50, 60) for n in range(2000)]
        p = observers.Presser(WEBER, LAPSE, 1).first_is_softer(50, 60)
        self.assertAlmostEqual(1 - np.mean(said), p, delta=4 * math.sqrt(p * (1 - p) / 2000))
        self.assertEqual(said, [observers.Presser(WEBER, LAPSE, n).softer(50, 60) for n in range(2000)])


class WhatItCanFind(unittest.TestCase):
    def setUp(self):
        self.study = study_file.read("haptic_delay_stiffness")
        self.id = self.study.conditions[0].id

    def rows(self, cost, each=10):
        """Rows of a pilot in which stiffness falls by the share `cost` per ms."""
        dice = np.random.default_rng(1)
        return [{"condition": self.id, "level": level, "degraded_interval": 1, "stiffness_first_n_m": 40 * (1 - cost * level) * (1 + dice.normal(0, 0.01)),
                 "stiffness_second_n_m": 40.0} for level in self.study.conditions[0].levels for _ in range(each)]

    def test_without_a_pilot_only_the_smallest_difference_is_computed(self):
        assumed = power.Assumed(participants=(1, 12))
        found = power.of(self.study, assumed)
        one, twelve = found
        said = power.words(self.study, found, assumed)
        self.assertTrue(any("is not simulated" in line and "--pilot" in line for line in said), said)
        # Draws answers of the participant, and counts the share of samples above the 97.5 % quantile of chance.
        dice = np.random.default_rng(2)
        for f in (one, twelve):
            p = observers.Presser(WEBER, LAPSE, 1).first_is_softer(1 - f["softer"], 1.0)
            right = dice.binomial(f["answers"], p, 4000)
            chance = dice.binomial(f["answers"], 0.5, 100_000)
            limit = np.quantile(chance, 0.975)
            self.assertAlmostEqual(np.mean(right > limit), 0.8, delta=0.04)
        self.assertLess(twelve["softer"], one["softer"] / 2)

    def test_a_pilot_gives_the_level_of_75_percent_right_answers(self):
        presses = power_felt.pilot(self.rows(0.01), "trials.csv")
        assumed = power.Assumed(simulations=40, presses=presses)
        row = next(f for f in power.of(self.study, assumed) if "parameter" in f)
        self.assertAlmostEqual(row["truth"], (1 - 1 / (1 + WEBER)) / 0.01, delta=1.5)  # linear interpolation between levels 5 ms apart
        self.assertLess(abs(row["bias"]), 4 * row["sd"] / math.sqrt(40) + 1)
        self.assertAlmostEqual(row["half_width"] / (1.96 * row["sd"]), 1, delta=0.4)  # which 40 participants estimate to 11 %, and the half width is a median
        self.assertFalse(any("is not simulated" in line for line in power.words(self.study, [row], assumed)))

    def test_a_pilot_without_a_threshold_or_without_presses_is_reported(self):
        assumed = power.Assumed(simulations=20, presses=power_felt.pilot(self.rows(0.001), "trials.csv"))
        found = power.of(self.study, assumed)
        self.assertFalse(any("parameter" in f for f in found))
        self.assertTrue(any("at no level" in line for line in power.words(self.study, found, assumed)))
        with self.assertRaisesRegex(ValueError, "trials.csv: holds no condition"):
            power_felt.pilot(self.rows(0.01, each=2), "trials.csv")
        with self.assertRaisesRegex(Refusal, "has neither"):
            check.assumed_of(study_file.read("audio_visual_synchrony"), types.SimpleNamespace(pilot="trials.csv", simulations=10, seed=1, participants=(1,)))

    def test_a_staircase_uses_levels_between_those_of_the_pilot(self):
        study = dataclasses.replace(self.study, procedure={"kind": "staircase", "rule": "1up2down", "start": 38.0, "step": 8.0, "minimum_step": 2.0, "lowest": 0.0,
                                                           "highest": 40.0, "reversals": 8})
        found = power.of(study, power.Assumed(simulations=20, presses=power_felt.pilot(self.rows(0.01), "trials.csv")))
        self.assertEqual([f["parameter"] for f in found], ["threshold75"])
        self.assertLess(abs(found[0]["bias"]), 6)
        self.assertEqual(Plan(study, "P01").next().level, 38.0)


if __name__ == "__main__":
    unittest.main()
