"""Power of a study, compared with closed forms and with tests of other programs."""
import dataclasses
import math
import pathlib
import sys
import unittest
import warnings
from unittest import mock

import numpy as np
from scipy import stats
from statsmodels.stats.power import TTestPower

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.refusal import Refusal
from tactus.study import check, duration, power, power_games, study_file

ALIKE = power_games.Games(success=0.9, time_s=10.0, spread=0.3, between=0.0, success_between=0.0)
FOREVER_S = 1e6


class OfYesAndNo(unittest.TestCase):
    def setUp(self):
        self.study = study_file.read("audio_visual_synchrony")

    def rows(self, **assumed):
        return {r["parameter"]: r for r in power.of(self.study, power.Assumed(**assumed))}

    def test_the_interval_is_as_wide_as_the_estimates_spread(self):
        for r in self.rows(simulations=100).values():
            # 1.96 standard deviations, which 100 participants estimate to 7 %; the intervals are not quite normal.
            self.assertAlmostEqual(r["half_width"] / (1.96 * r["sd"]), 1, delta=0.2)
            self.assertLess(abs(r["bias"]), 4 * r["sd"] / math.sqrt(100))
            self.assertEqual((r["no_fit"], r["trials"]), (0, 240))

    def test_four_times_the_trials_halve_it(self):
        once = self.rows(simulations=40)["pss"]["half_width"]
        self.study = dataclasses.replace(self.study, procedure={"kind": "constant", "repetitions": 80})
        self.assertAlmostEqual(self.rows(simulations=40)["pss"]["half_width"] / once, 0.5, delta=0.07)

    def test_the_mean_of_several_has_student_s_interval(self):
        r = self.rows(simulations=40, participants=(1, 4, 9))["pss"]
        self.assertEqual(list(r["groups"]), [4, 9])
        self.assertAlmostEqual(r["groups"][4], stats.t.ppf(0.975, 3) * r["sd"] / 2)

    def test_an_adaptive_procedure_reports_its_number_of_trials(self):
        study = study_file.read("haptic_delay_stiffness")
        study = dataclasses.replace(study, observers={"": study_file.Observer("cumulative_gaussian", {"threshold": 36.0, "sd": 15.0, "guess": 0.5, "lapse": 0.02}, {})})
        self.study = dataclasses.replace(study, procedure={
            "kind": "staircase", "rule": "1up2down", "start": 80.0, "step": 20.0, "minimum_step": 5.0, "lowest": 0.0, "highest": 150.0, "reversals": 8})
        r = self.rows(simulations=40)["threshold"]
        self.assertTrue(20 < r["trials"] < 80, r)
        self.assertLess(abs(r["bias"]), 4 * r["sd"] / math.sqrt(40) + 3)  # plus half of the smallest step

    def test_answers_at_chance_give_no_threshold_and_a_warning(self):
        study = study_file.read("haptic_delay_stiffness")
        deaf = study_file.Observer("cumulative_gaussian", {"threshold": 5000.0, "sd": 1.0, "guess": 0.5, "lapse": 0.0}, {})
        self.study = dataclasses.replace(study, observers={"": deaf})
        found = power.of(self.study, power.Assumed(simulations=30))
        self.assertGreater(found[0]["no_fit"], 0.2)
        said = power.words(self.study, found, power.Assumed(simulations=30))
        self.assertTrue(any("no threshold found" in line for line in said))
        self.assertTrue(any("too many simulated sessions find no threshold" in line for line in said))

    def test_the_same_seed_gives_the_same_figures_and_a_study_without_observer_a_message(self):
        self.assertEqual(self.rows(simulations=10), self.rows(simulations=10))
        blind = dataclasses.replace(self.study, observers={})
        self.assertIn("no <observer>", power.words(blind, power.of(blind, power.Assumed()), power.Assumed())[0])


    def test_figures_have_the_unit_of_the_levels(self):
        said = power.words(self.study, power.of(self.study, power.Assumed(simulations=10)), power.Assumed(simulations=10))
        self.assertRegex(said[0], r"pss of -40 ms will be known to \+-[0-9.]+ ms ")
        row = {"condition": "haptic delay", "parameter": "slope"}
        self.assertEqual(power.unit_of(study_file.read("haptic_delay_stiffness"), row), "")


class OfNumbers(unittest.TestCase):
    def test_the_library_warns_of_nothing(self):
        study = dataclasses.replace(study_file.read("audio_visual_synchrony"), response="rating", procedure={"kind": "constant", "repetitions": 2})
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(len(power.of(study, power.Assumed())), 3)

    def test_a_t_test_finds_the_difference_with_80_percent_power(self):
        study = dataclasses.replace(study_file.read("audio_visual_synchrony"), response="rating", procedure={"kind": "constant", "repetitions": 10})
        dice = np.random.default_rng(1)
        for f in power.of(study, power.Assumed(participants=(1, 8))):
            n, people, effect = 10, f["participants"], f["smallest_in_sd"]
            a, b = dice.standard_normal((4000, people, n)), dice.standard_normal((4000, people, n)) + effect
            p = stats.ttest_ind(a[:, 0], b[:, 0], axis=1)[1] if people == 1 else stats.ttest_rel(a.mean(axis=2), b.mean(axis=2), axis=1)[1]
            self.assertAlmostEqual(np.mean(p < 0.05), 0.8, delta=0.03, msg=f)  # four standard errors of 4000


class OfGames(unittest.TestCase):
    def setUp(self):
        self.study = study_file.read("senses_removed")

    def rows(self, games, each=10, limit_s=FOREVER_S, **assumed):
        study = dataclasses.replace(self.study, procedure={"kind": "constant", "repetitions": each}, stimulus=dataclasses.replace(self.study.stimulus, limit_s=limit_s))
        found = power.of(study, power.Assumed(games=games, **assumed))
        return found, {r["participants"]: r for r in found["rows"]}

    def test_the_slowing_of_people_agrees_with_a_paired_t_test(self):
        _, rows = self.rows(dataclasses.replace(ALIKE, success=1 - 1e-9), each=10, simulations=300, participants=(16,))
        spread = ALIKE.spread * math.sqrt(2 / 10)  # of the difference of two means of 10 logarithms
        wanted = TTestPower().solve_power(nobs=16, alpha=0.05, power=0.8) * spread
        self.assertAlmostEqual(math.log(rows[16]["slower"]) / wanted, 1, delta=0.06)

    def test_a_test_of_proportions_finds_the_loss_of_one_person_with_80_percent_power(self):
        _, rows = self.rows(ALIKE, each=60, simulations=200, participants=(1,))
        dice, n = np.random.default_rng(3), 60
        a, b = dice.binomial(n, 0.9, 4000), dice.binomial(n, 0.9 - rows[1]["loss"], 4000)
        pooled = (a + b) / (2 * n)
        z = (a - b) / n / np.sqrt(pooled * (1 - pooled) * 2 / n)
        self.assertAlmostEqual(np.mean(z > 1.96), 0.8, delta=0.05)  # this test pools the variance

    def test_people_who_differ_more_need_larger_effects_of_one_game_each_and_more_games_smaller_ones(self):
        _, few = self.rows(power_games.Games(), each=3, limit_s=30, participants=(12,))
        _, many = self.rows(power_games.Games(), each=30, limit_s=30, participants=(12,))
        self.assertGreater(few[12]["slower"], many[12]["slower"])
        self.assertGreater(few[12]["loss"], many[12]["loss"])

    def test_a_level_without_effect_is_rarely_called_worse(self):
        for people in (1, 12):
            won, time_s = power_games.drawn(power_games.Games(), 30.0, people, 20, 0.0, 1.0, np.random.default_rng(people), 4000)
            shares, ratios = power_games.interval(won, time_s, 0.05)
            for low, high in (shares, ratios):
                outside = np.mean((low > 0) | (high < 0))
                self.assertLess(outside, 0.05 + 4 * math.sqrt(0.05 * 0.95 / 4000))

    def test_enough_participants_show_that_a_level_without_effect_is_harmless(self):
        found, rows = self.rows(power_games.Games(), each=10, limit_s=30, participants=(5, 60))
        self.assertLess(rows[5]["harmless"], 0.3)
        self.assertTrue(5 < found["needed"] <= 60)
        self.assertGreater(rows[60]["harmless"], 0.8)

    def test_conditions_are_tested_in_families_and_a_missing_baseline_is_reported(self):
        found, _ = self.rows(power_games.Games(), participants=(1,))
        self.assertEqual((found["tests"], found["baseline"]), (4, True))  # four removals
        self.study = dataclasses.replace(self.study, conditions=tuple(c for c in self.study.conditions if c.kind != "nothing"))
        found, _ = self.rows(power_games.Games(), participants=(1,))
        self.assertFalse(found["baseline"])
        self.assertTrue(any("<nothing/>" in line for line in power_games.words(found, power.Assumed(), 0.8)))
        self.study = study_file.read("two_senses")
        found, _ = self.rows(power_games.Games(), participants=(1,))
        self.assertEqual((found["tests"], found["baseline"]), (9, True))  # nine conditions with both senses late

    def test_a_pilot_recovers_the_parameters_of_its_games(self):
        games = power_games.Games(success=0.8, time_s=12.0, spread=0.3, between=0.2, success_between=0.0)
        won, time_s = power_games.drawn(games, FOREVER_S, 60, 40, 0.0, 1.0, np.random.default_rng(5), 1)
        rows = [{"task": "game", "participant_id": f"P{i}", "success": int(won[0, 0, i, k]), "completion_time_s": float(time_s[0, 0, i, k]), "modality_degraded": ""}
                for i in range(60) for k in range(40)]
        rows += [{**rows[0], "modality_degraded": "audio", "success": 0}] * 500 + [{**rows[0], "missed": 1, "success": 0}] * 500
        made = power_games.pilot(rows, "trials.csv")
        for name, near in (("success", 0.04), ("spread", 0.03), ("between", 0.06)):
            self.assertAlmostEqual(getattr(made, name), getattr(games, name), delta=near)
        self.assertAlmostEqual(made.time_s / 12, 1, delta=0.1)
        with self.assertRaises(ValueError):
            power_games.pilot(rows[:9], "trials.csv")


class OfTime(unittest.TestCase):
    def test_a_session_lasts_the_sum_of_its_trials_breaks_and_texts(self):
        study = study_file.read("audio_visual_synchrony")
        parts = dict(duration.of_session(study, 240))
        self.assertEqual((parts["breaks"], parts["answer"]), (180.0, 240 * duration.ANSWER_S))
        apparatus = sum(s for part, s in duration.of_trial(study) if part != "answer")
        self.assertTrue(1.25 < apparatus < 1.55, apparatus)  # 1.36 s on a live cluster, with an observer that answers at once
        games = dict(duration.of_session(study_file.read("senses_removed"), 50))
        self.assertEqual(games["game, at the most"], 1500)
        self.assertGreater(games["questionnaire"], 2 * duration.ITEM_S)


@unittest.skipUnless((check.BIN / "sync_node").is_file(), "needs the programs")
class OfProfiles(unittest.TestCase):
    def test_an_invalid_degradation_is_refused_with_its_element(self):
        study = study_file.read("audio_visual_synchrony")
        self.assertIn("11 degradations", check.profiles(study))
        with self.assertRaises(Refusal) as caught:
            check.profiles(dataclasses.replace(study, base=('<degrade modality="visual" off="true"/>', '<degrade modality="audio" colour="blue"/>')))
        self.assertIn('<degrade modality="audio" colour="blue"/> is not valid: there is no operator "colour"', str(caught.exception))


if __name__ == "__main__":
    unittest.main()
