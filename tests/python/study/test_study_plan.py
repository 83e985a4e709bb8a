"""The plan: study, participant, seed and answers determine the trials, also after an interruption."""
import collections
import dataclasses
import pathlib
import random
import sys
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.study import study_file
from tactus.study.plan import Plan, order_of, williams

STAIRS = {"kind": "staircase", "rule": "1up2down", "start": 100.0, "step": 40.0, "minimum_step": 10.0, "lowest": 0.0, "highest": 200.0, "reversals": 6}


def played(plan, says, most=10_000):
    """Trials until the plan is done, each answered by says(trial)."""
    trials = []
    while (trial := plan.next()) is not None and len(trials) < most:
        trials.append(trial)
        plan.answered(trial, says(trial))
    return trials


class ThePlan(unittest.TestCase):
    def setUp(self):
        self.synchrony = study_file.read("audio_visual_synchrony")
        self.games = study_file.read("two_senses")
        self.stairs = dataclasses.replace(study_file.read("haptic_delay_stiffness"), procedure=STAIRS)

    def test_constant_stimuli_present_each_level_equally_often(self):
        trials = played(Plan(self.synchrony, "P01"), lambda t: t.level > 0)
        self.assertEqual(set(collections.Counter(t.level for t in trials).values()), {20})
        self.assertEqual([t.number for t in trials], list(range(1, 241)))
        self.assertEqual(collections.Counter(t.block for t in trials), {1: 60, 2: 60, 3: 60, 4: 60})

    def test_participants_get_different_orders_and_each_the_same_order_again(self):
        levels = lambda name: [t.level for t in played(Plan(self.synchrony, name), lambda t: True)]
        self.assertEqual(levels("P01"), levels("P01"))
        self.assertNotEqual(levels("P01"), levels("P02"))

    def test_a_plan_with_the_same_answers_continues_with_the_same_trial(self):
        for study in (self.synchrony, self.stairs, self.games):
            dice = random.Random(5)
            answers = [dice.random() < 0.7 for _ in range(5000)]
            whole = played(Plan(study, "P03"), lambda t: answers[t.number])
            for stop in (0, 1, len(whole) // 2, len(whole) - 1):
                again = Plan(study, "P03")
                for trial in whole[:stop]:
                    self.assertEqual(again.next(), trial)
                    again.answered(trial, answers[trial.number])
                self.assertEqual(again.next(), whole[stop])

    def test_a_missed_trial_is_repeated(self):
        plan = Plan(self.stairs, "P01")
        self.assertEqual(plan.next(), plan.next())

    def test_a_square_of_williams_balances_places_and_neighbours(self):
        for n in (2, 3, 4, 5, 8):
            rows = williams(n)
            places = collections.Counter((i, x) for row in rows for i, x in enumerate(row))
            neighbours = collections.Counter((a, b) for row in rows for a, b in zip(row, row[1:]))
            self.assertEqual(len(set(places.values())), 1)
            self.assertEqual(len(places), n * n)
            self.assertEqual(len(set(neighbours.values())), 1)
            self.assertEqual(len(neighbours), n * (n - 1))

    def test_each_block_of_games_has_each_condition_once(self):
        trials = played(Plan(self.games, "P07"), lambda t: None)
        for begin in range(0, len(trials), 32):
            self.assertEqual(len({t.condition.id for t in trials[begin:begin + 32]}), 32)
        self.assertEqual(order_of(4, "none", "P1", 0, 1), [0, 1, 2, 3])

    def test_either_of_two_intervals_is_degraded_about_equally_often(self):
        trials = played(Plan(study_file.read("haptic_delay_stiffness"), "P01"), lambda t: True)
        second = sum(t.degraded_interval for t in trials)
        self.assertTrue(55 <= second <= 105, second)  # 160 fair coins: 80 +- 4 standard deviations of 6.3


if __name__ == "__main__":
    unittest.main()
