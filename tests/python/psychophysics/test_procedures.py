"""Procedures converge to their published targets, end, and are restored by the same answers."""
import math
import pathlib
import random
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.psychophysics.observers import SimulatedObserver
from tactus.psychophysics.procedures import counts, make_procedure, run, stacked
from tactus.psychophysics.staircases import NEEDED, RATIO, TARGET, TRIALS_PER_REVERSAL, Staircase

STAIRCASE = {"kind": "staircase", "rule": "1up2down", "start": 100, "step": 32, "minimum_step": 8, "lowest": 0, "highest": 150, "reversals": 8}
QUEST = {"kind": "quest_plus", "function": "cumulative_gaussian", "levels": [0, 20, 40, 60, 80], "trials": 20,
         "parameters": {"threshold": [20, 40, 60], "sd": [10, 20], "guess": [0.5], "lapse": [0.02]}}
SPECS = ({"kind": "constant", "levels": [1, 2, 3], "repetitions": 4}, STAIRCASE, {**STAIRCASE, "rule": "weighted", "step": 16}, {**STAIRCASE, "rule": "1up1down"}, QUEST)


def stationary_mean(rule, p_of, step, lowest, highest):
    """Mean probability of a yes over the stationary distribution of the Markov chain of a staircase; states are (level, yes in a row)."""
    levels = np.arange(lowest, highest + step / 2, step)
    row, up = NEEDED[rule], int(RATIO[rule])
    size = len(levels) * row
    chain = np.zeros((size, size))
    for i, level in enumerate(levels):
        for k in range(row):
            p = p_of(level)
            chain[i * row + k, (min(i + up, len(levels) - 1)) * row] += 1 - p
            chain[i * row + k, (max(i - 1, 0)) * row if k + 1 == row else i * row + k + 1] += p
    values, vectors = np.linalg.eig(chain.T)
    share = np.real(vectors[:, np.argmin(np.abs(values - 1))])
    share = (share / share.sum()).reshape(len(levels), row).sum(axis=1)
    return share @ levels


class Staircases(unittest.TestCase):
    def test_targets_agree_with_the_literature(self):
        # Levitt 1971, table I: 0.500 and 0.707; Kaernbach 1991: a step up of three times that down, 0.75.
        for rule, printed in (("1up1down", 0.500), ("1up2down", 0.707), ("weighted", 0.750)):
            self.assertAlmostEqual(TARGET[rule], printed, places=3)

    def test_they_stay_near_their_targets(self):
        # For p = level, the mean of the Markov chain and the reversals of a long run lie near the target, to about one step.
        for rule, target in TARGET.items():
            self.assertAlmostEqual(stationary_mean(rule, lambda x: min(max(x, 0), 1), 0.02, 0, 1), target, delta=0.03)
            dice, stairs = random.Random(3), Staircase(rule, target, 0.02, 0.02, 0, 1, 3000, 10 ** 6)
            while not stairs.finished:
                stairs.answer(stairs.next_level(), dice.random() < stairs.level)
            self.assertAlmostEqual(stairs.estimate()["threshold"], target, delta=0.015)
            self.assertLess(stairs.estimate()["at_end"], 0.01)

    def test_a_fixed_run_of_answers(self):
        stairs = make_procedure({**STAIRCASE, "start": 64, "reversals": 4}, 1)
        seen = []
        for yes in (1, 1, 1, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1, 1):
            seen.append(stairs.next_level())
            stairs.answer(seen[-1], yes)
        # Two yes: down 32, twice; a no at 0: reversal, steps of 16; two yes: reversal, steps of 8, the smallest; two no: reversal at 8, up to
        # 24; two yes: reversal there; a no at 16: reversal; two yes at 24.
        self.assertEqual(seen, [64, 64, 32, 32, 0, 16, 16, 8, 16, 24, 24, 16, 24, 24])
        self.assertEqual(stairs.turned, [8, 24, 16, 24])
        self.assertTrue(stairs.finished)
        self.assertEqual({k: stairs.estimate()[k] for k in ("threshold", "reversals", "at_end")}, {"threshold": 18, "reversals": 4, "at_end": 1 / 14})

    def test_the_number_of_trials_between_reversals_is_that_of_the_plan(self):
        for rule, wanted in TRIALS_PER_REVERSAL.items():
            dice, stairs = random.Random(5), Staircase(rule, TARGET[rule], 0.05, 0.05, 0, 1, 3000, 10 ** 6)
            while not stairs.finished:
                stairs.answer(stairs.next_level(), dice.random() < stairs.level)
            self.assertAlmostEqual(stairs.done / len(stairs.turned), wanted, delta=0.15)

    def test_the_expected_number_of_trials_is_near_the_actual_one(self):
        params = {"threshold": 50, "sd": 18, "guess": 0.5, "lapse": 0.02}
        taken = [len(run(make_procedure(STAIRCASE, 1), SimulatedObserver("cumulative_gaussian", params, i))) for i in range(200)]
        self.assertLess(abs(np.mean(taken) / make_procedure(STAIRCASE, 1).expected - 1), 0.3)

    def test_a_staircase_without_reversals_ends_and_reports_it(self):
        stairs = make_procedure({**STAIRCASE, "max_trials": 30}, 1)
        while not stairs.finished:
            stairs.answer(stairs.next_level(), True)
        self.assertEqual((stairs.done, stairs.level, stairs.estimate()), (30, 0.0, None))
        self.assertGreater(stairs.at_end, 15)

    def test_reversals_give_the_threshold_at_their_target(self):
        params = {"threshold": 60, "sd": 15, "guess": 0.0, "lapse": 0.0}
        for rule in TARGET:
            spec = {**STAIRCASE, "rule": rule, "step": 16, "minimum_step": 2, "reversals": 40}
            found = []
            for i in range(60):
                stairs = make_procedure(spec, i)
                run(stairs, SimulatedObserver("cumulative_gaussian", params, [9, i]))
                found.append(stairs.estimate()["threshold"])
            target = 60 + 15 * {"1up1down": 0.0, "1up2down": 0.5449, "weighted": 0.6745}[rule]  # Phi^-1
            self.assertLess(abs(np.mean(found) - target), 1.5 + 4 * np.std(found) / math.sqrt(60), rule)


class AnyProcedure(unittest.TestCase):
    def test_constant_stimuli_present_every_level_once_in_each_round(self):
        p = make_procedure(SPECS[0], 7)
        seen = []
        while not p.finished:
            seen.append(p.next_level())
            p.answer(seen[-1], True)
        self.assertEqual([sorted(seen[i:i + 3]) for i in range(0, 12, 3)], [[1, 2, 3]] * 4)
        self.assertNotEqual(seen, [make_procedure(SPECS[0], 8).levels[i] for i in range(12)])
        self.assertEqual((p.done, p.expected), (12, 12))

    def test_the_same_answers_restore_each_procedure(self):
        for spec in SPECS:
            dice, first = random.Random(2), make_procedure(spec, 11)
            answers = []
            while not first.finished:
                again = make_procedure(spec, 11)
                for level, yes in answers:
                    self.assertEqual(again.next_level(), level)
                    again.answer(level, yes)
                self.assertEqual((again.next_level(), again.done, again.expected, again.estimate()),
                                 (first.next_level(), first.done, first.expected, first.estimate()))
                answers.append((first.next_level(), dice.random() < 0.7))
                first.answer(*answers[-1])
            self.assertEqual(first.history, answers)
            self.assertRaises(IndexError, first.next_level)

    def test_a_missed_trial_is_repeated(self):
        for spec in SPECS:
            p = make_procedure(spec, 3)
            self.assertEqual([p.next_level() for _ in range(5)], [p.next_level()] * 5)
            self.assertEqual(p.done, 0)

    def test_answers_of_equal_levels_are_counted_together(self):
        levels, yes, total = counts([(20.0, True), (10.0, False), (20.0, False)])
        self.assertEqual((levels.tolist(), yes.tolist(), total.tolist()), ([10, 20], [0, 1], [1, 2]))
        levels, yes, total = stacked([[(1.0, True)], [(1.0, True), (2.0, False)]])
        self.assertEqual(total.tolist(), [[1, 0], [1, 1]])

    def test_invalid_specifications_are_refused(self):
        for words, spec in (("no procedure 'pest'", {"kind": "pest"}), ("lacks repetitions", {"kind": "constant", "levels": [1]}),
                            ("has no speed", {**STAIRCASE, "speed": 1}), ("no staircase '2up'", {**STAIRCASE, "rule": "2up"}),
                            ("cannot start at 200", {**STAIRCASE, "start": 200}), ("smallest step", {**STAIRCASE, "minimum_step": 64}),
                            ("2 reversals are too few", {**STAIRCASE, "reversals": 2}), ("one of trials and stop_sd", {**QUEST, "stop_sd": 3}),
                            ("'lapse' is missing", {**QUEST, "parameters": {"threshold": [1], "sd": [1], "guess": [0]}}),
                            ("not a parameter of", {k: v for k, v in {**QUEST, "stop_sd": {"slope": 1}}.items() if k != "trials"})):
            with self.assertRaisesRegex(ValueError, words):
                make_procedure(spec, 1)


if __name__ == "__main__":
    unittest.main()
