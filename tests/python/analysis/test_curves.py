#!/usr/bin/env python3
"""Psychometric functions per condition, L_detect and L_appear, from answers of observers with known thresholds."""
import math
import unittest

import analysis_tables
import numpy as np
from analysis_tables import judgements

from tactus.analysis import answers, appearance, detection, limits, presses, psychometric, published, trials
from tactus.analysis.operators import Factor
from tactus.psychophysics import observers
from tactus.refusal import Refusal
from tactus.study import felt_properties

EDGE = math.sqrt(2 * math.log(4 / 3))  # in sd: exp(-x^2 / 2 sd^2) = 3/4
LEVELS = np.arange(-200, 201, 40)


def matches(rng, people, cost, levels=(0, 20, 40, 80, 120), each=8, study="stiffness", question="How stiff was it? (stiffness)"):
    """Stiffness matched by people with individual scales; it falls by the share `cost` a ms."""
    rows = []
    for p in range(people):
        scale = 200 * math.exp(rng.normal(0, 0.4))
        for x in levels:
            for _ in range(each):
                rows.append({"study": study, "participant_id": f"P{p:02}", "task": "matching", "observer": "human", "trial": len(rows) + 1, "question": question,
                             "modality_degraded": "haptic", "operator": "delay", "level": float(x), "unit": "ms",
                             "answer_value": scale * (1 - cost * x) * (1 + rng.normal(0, 0.1))})
    return rows


def pressings(rng, people, cost, levels=(5, 10, 20, 40, 60), each=20):
    """Two presses a trial: stiffness falls by the share `cost` a ms and is measured to 3 %; a Presser with a Weber fraction of 0.2 judges the softer one."""
    rows = []
    for p in range(people):
        presser = observers.Presser(0.2, 0.02, [p, int(rng.integers(1 << 30))])
        for x in levels:
            for _ in range(each):
                degraded, felt = int(rng.integers(2)), 50 * (1 + rng.normal(0, 0.03, 2))
                felt[degraded] *= 1 - cost * x
                says = presser.softer(*felt)
                rows.append({"study": "pressed", "participant_id": f"P{p:02}", "task": "2ifc", "observer": "simulated", "trial": len(rows) + 1,
                             "modality_degraded": "haptic", "operator": "delay", "level": float(x), "unit": "ms", "response": ("first", "second")[says],
                             "correct": int(says == degraded), "degraded_interval": degraded + 1, "stiffness_first_n_m": felt[0], "stiffness_second_n_m": felt[1]})
    return rows


class Curves(unittest.TestCase):
    def test_the_fit_uses_measured_levels_and_not_requested_ones(self):
        rows = judgements(np.random.default_rng(1), 10, 60, 0.02, LEVELS, 40)
        for row in rows:
            row["soa_achieved_ms"] += 25  # an apparatus with a constant delay
        pooled, = psychometric.curves(trials.of_rows(rows), 1)
        self.assertTrue(pooled.intervals["pss"][0] <= 35 <= pooled.intervals["pss"][1], pooled.intervals)

    def test_each_participant_has_a_curve_that_others_do_not_change(self):
        rows = [r for i in range(3) for r in judgements(np.random.default_rng(i), 20 * i, 60, 0.02, LEVELS, 20, f"P{i:02}")]
        three = psychometric.curves(trials.of_rows(rows), 1)
        two = psychometric.curves(trials.of_rows(rows[:-len(rows) // 3]), 1)
        self.assertEqual([c.participant for c in three], ["", "P00", "P01", "P02"])
        self.assertEqual([c.intervals for c in three[1:3]], [c.intervals for c in two[1:3]])

    def test_order_and_synchrony_share_their_sign(self):
        rng = np.random.default_rng(3)
        rows = judgements(rng, 30, 60, 0.02, LEVELS, 40)
        for i, level in enumerate(rng.permutation(np.repeat(LEVELS, 40))):
            first = rng.random() < 0.5 * (1 + math.erf((level - 30) / 40 / math.sqrt(2)))  # "audio first" gets more likely the later vision is
            rows.append({**rows[0], "task": "toj", "trial": 10_000 + i, "soa_nominal_ms": level, "soa_achieved_ms": float(level), "response": "audio" if first else "visual"})
        synchrony, order = psychometric.curves(trials.of_rows(rows), 1)
        for curve in (synchrony, order):
            self.assertTrue(curve.intervals["pss"][0] <= 30 <= curve.intervals["pss"][1], curve.intervals)
        # 0.6745 * 40 = 27; 440 answers give a standard error of about 3.
        self.assertAlmostEqual(order.value("jnd"), 27, delta=9)

    def test_a_curve_without_a_fit_has_a_reason(self):
        few = psychometric.curves(trials.of_rows(judgements(np.random.default_rng(1), 0, 60, 0, [0, 40], 4)), 1)
        self.assertIn("too few", few[0].why)
        same = psychometric.curves(trials.of_rows(judgements(np.random.default_rng(1), 0, 1e6, 0, LEVELS, 10)), 1)
        self.assertIn("all answers are the same", same[0].why)

    def test_an_unknown_answer_is_refused(self):
        for kind, response, pair in (("sj", "perhaps", ("audio", "visual")), ("toj", "haptic", ("audio", "visual"))):
            with self.assertRaisesRegex(Refusal, "is unknown"):
                answers.is_yes(kind, response, math.nan, pair)
        with self.assertRaisesRegex(Refusal, "is not two senses"):
            answers.pair_of("audio")

    def test_many_levels_are_binned_without_loss_of_answers(self):
        rng = np.random.default_rng(2)
        x, yes = rng.normal(0, 50, 5000), (rng.random(5000) < 0.4) * 1.0
        levels, said, total = psychometric.binned(x, yes)
        self.assertEqual((said.sum(), total.sum(), len(levels)), (yes.sum(), 5000, psychometric.MAX_LEVELS))
        self.assertAlmostEqual((levels * total).sum(), x.sum(), places=6)
        self.assertTrue((np.diff(levels) > 0).all())


    def test_a_sharp_observer_between_far_levels_has_no_lower_end_of_the_spread_and_the_reason(self):
        rows = []
        for x in (-120.0, -80.0, -40.0, 0.0, 40.0, 80.0, 120.0):
            rows += [{"study": "s", "participant_id": "P01", "task": "toj", "pair": "audio,visual", "observer": "human", "trial": len(rows) + i, "soa_nominal_ms": x,
                      "soa_achieved_ms": x, "response": "audio" if x > 20 else "visual"} for i in range(20)]
        curve, = psychometric.curves(trials.of_rows(rows), 1)
        self.assertEqual(curve.why, psychometric.TOO_FAR)
        for name in ("pss", "sd", "jnd"):
            low, high = curve.intervals[name]
            self.assertTrue(low <= curve.value(name) <= high, name)
        self.assertEqual(curve.intervals["sd"][0], 0)


class Detection(unittest.TestCase):
    def test_the_edges_of_the_window_are_recovered_from_one_person(self):
        inside = np.zeros(2)
        for seed in range(60):
            curves = psychometric.curves(trials.of_rows(judgements(np.random.default_rng(seed), 15, 60, 0.02, LEVELS, 25)), 1)
            late = {l.factor.modality: l for l in detection.detection_limits(curves, 1)}
            inside += [late["visual"].low <= 15 + 60 * EDGE <= late["visual"].high, late["audio"].low <= 60 * EDGE - 15 <= late["audio"].high]
        # 57 expected, binomial standard deviation 1.7.
        self.assertTrue((inside >= 53).all(), inside)

    def test_with_many_people_the_limit_is_of_people(self):
        inside = 0
        for seed in range(25):
            rng = np.random.default_rng(seed)
            rows = [r for i in range(10) for r in judgements(rng, rng.normal(15, 20), 60, 0.02, LEVELS, 15, f"P{i:02}", jitter_ms=0.0)]
            late = {l.factor.modality: l for l in detection.detection_limits(psychometric.curves(trials.of_rows(rows), 1), 1)}["visual"]
            inside += late.low <= 15 + 60 * EDGE <= late.high
            # People differ by 20 ms: the standard error of the mean of ten is 6 ms, so the interval is about 25 ms wide.
            self.assertTrue(14 < late.high - late.low < 45, late)
        self.assertGreaterEqual(inside, 21)

    def test_participants_without_a_fit_are_named(self):
        rng = np.random.default_rng(6)
        rows = [r for i in range(6) for r in judgements(rng, 15, 60, 0.02, LEVELS, 12, f"P{i:02}")]
        rows += [{**r, "participant_id": "P99", "response": "yes"} for r in rows[:len(LEVELS) * 12]]  # judges everything together
        for limit in detection.detection_limits(psychometric.curves(trials.of_rows(rows), 1), 1):
            self.assertEqual(limit.note, "without 1 of 7 participants, whose answers have no fit: P99")

    def test_for_two_intervals_the_limit_is_at_75_percent_right(self):
        rng = np.random.default_rng(4)
        rows = []
        for i in range(600):
            x = float(rng.choice([5, 10, 20, 30, 40, 60, 80]))
            p = 0.5 + 0.49 * (1 - math.exp(-((x / 25) ** 2.5)))
            rows.append({"study": "lag", "participant_id": "P01", "task": "2ifc", "observer": "human", "trial": i + 1, "modality_degraded": "haptic", "operator": "delay",
                         "level": x, "unit": "ms", "correct": int(rng.random() < p)})
        found, = detection.detection_limits(psychometric.curves(trials.of_rows(rows), 1), 1)
        truth = 25 * math.log(2) ** (1 / 2.5)  # half way from 0.5 to 1
        self.assertEqual(found.factor, Factor("haptic", "delay", "ms"))
        self.assertTrue(found.low <= truth <= found.high, found)

    def test_the_limit_of_a_rate_is_found_by_its_period(self):
        rng = np.random.default_rng(5)
        rows = []
        for i in range(600):
            hz = float(rng.choice([2, 5, 8, 12, 20, 40, 80]))
            p = 0.5 + 0.49 * (1 - math.exp(-((10 / hz) ** 2.5)))
            rows.append({"study": "slow", "participant_id": "P01", "task": "2ifc", "observer": "human", "trial": i + 1, "modality_degraded": "visual", "operator": "rate",
                         "level": hz, "unit": "Hz", "correct": int(rng.random() < p)})
        found, = detection.detection_limits(psychometric.curves(trials.of_rows(rows), 1), 1)
        truth = 10 / math.log(2) ** (1 / 2.5)
        self.assertTrue(found.low >= truth >= found.high, found)  # from the mildest to the most severe end
        self.assertEqual(found.up_to, 2)


class Appearance(unittest.TestCase):
    def test_the_level_of_a_stiffness_change_by_one_jnd_is_recovered(self):
        inside, truth = 0, felt_properties.just_noticeable()["stiffness"][0].at75 / 100 / 0.0023
        for seed in range(60):
            rng = np.random.default_rng(seed)
            (name, rows), = appearance.judged(trials.of_rows(matches(rng, 6, 0.0023)), lambda study: "")
            felt, = appearance.felt(name, rows, rng)
            self.assertEqual((felt.property, felt.toward, felt.limit.factor), ("stiffness", "less", Factor("haptic", "delay", "ms")))
            inside += felt.limit.low <= truth <= felt.limit.high
        # 57 expected, binomial standard deviation 1.7.
        self.assertGreaterEqual(inside, 53)

    def test_the_property_of_the_study_file_takes_precedence_over_the_question(self):
        rows = matches(np.random.default_rng(1), 2, 0.0023, question="How much was it?")
        self.assertEqual(appearance.judged(trials.of_rows(rows), lambda study: ""), [])
        self.assertEqual([name for name, _ in appearance.judged(trials.of_rows(rows), lambda study: "temperature")], ["temperature"])

    def test_participants_without_an_undegraded_answer_are_left_out_and_counted(self):
        rows = matches(np.random.default_rng(1), 3, 0.0023)
        rows = [r for r in rows if r["participant_id"] != "P02" or r["level"]]
        (name, kept), = appearance.judged(trials.of_rows(rows), lambda study: "")
        felt, = appearance.felt(name, kept, np.random.default_rng(1))
        self.assertEqual((felt.left_out, sum(felt.counts)), (32, 64))

    def test_participants_with_an_undegraded_answer_of_0_are_left_out_and_counted(self):
        rows = [{**r, "answer_value": 0.0} if r["participant_id"] == "P02" else r for r in matches(np.random.default_rng(1), 3, 0.0023)]
        (name, kept), = appearance.judged(trials.of_rows(rows), lambda study: "")
        felt, = appearance.felt(name, kept, np.random.default_rng(1))
        self.assertEqual((felt.left_out, sum(felt.counts)), (40, 64))

    def test_a_gain_above_1_is_a_separate_factor(self):
        rows = [{**r, "operator": "gain", "unit": "", "level": {0.0: 1.0, 20.0: 0.8, 40.0: 0.4, 80.0: 2.0, 120.0: 0.0}[r["level"]]} for r in matches(np.random.default_rng(1), 2, 0.0023)]
        (name, kept), = appearance.judged(trials.of_rows(rows), lambda study: "")
        self.assertEqual([(f.factor.operator, f.levels) for f in appearance.felt(name, kept, np.random.default_rng(1))], [("gain", [0.8, 0.4]), ("gain_above_1", [2.0])])


class Presses(unittest.TestCase):
    def test_the_delay_of_a_measured_stiffness_change_by_one_jnd_is_recovered(self):
        inside = 0
        for seed in range(60):
            rng = np.random.default_rng(seed)
            felt, = presses.felt(trials.of_rows(pressings(rng, 2, 0.008)), rng)
            self.assertEqual((felt.measured, felt.toward, felt.limit.kind, felt.limit.by, felt.limit.factor),
                             (True, "less", "appear", "stiffness, measured", Factor("haptic", "delay", "ms")))
            inside += felt.limit.low <= felt_properties.just_noticeable()["stiffness"][0].at75 / 100 / 0.008 <= felt.limit.high
        # 57 expected, binomial standard deviation 1.7.
        self.assertGreaterEqual(inside, 52)

    def test_the_delay_of_75_percent_right_answers_is_recovered(self):
        truth = (1 - 1 / 1.2) / 0.008  # at a difference of the Weber fraction
        inside = 0
        for seed in range(25):
            rows = trials.of_rows(pressings(np.random.default_rng(seed), 1, 0.008, each=40))
            found, = detection.detection_limits(psychometric.curves(rows, 1), 1, lambda study: "stiffness")
            self.assertEqual((found.kind, found.by, found.observer), ("appear", "stiffness, judged", "simulated"))
            inside += found.low <= truth <= found.high
        # 24 expected; the fitted function differs slightly from that of the observer.
        self.assertGreaterEqual(inside, 21)
        found, = detection.detection_limits(psychometric.curves(rows, 1), 1)
        self.assertEqual((found.kind, found.by), ("detect", "2ifc"))  # the study does not ask which was the softer

    def test_a_delay_that_changes_nothing_reaches_no_limit(self):
        felt, = presses.felt(trials.of_rows(pressings(np.random.default_rng(1), 2, 0.0)), np.random.default_rng(1))
        self.assertFalse(felt.limit.reached)
        self.assertEqual(felt.limit.low, math.inf)
        self.assertTrue(all(abs(s) < 0.03 for s in felt.shifts), felt.shifts)

    def test_trials_without_both_stiffnesses_are_left_out(self):
        rows = pressings(np.random.default_rng(1), 1, 0.008)
        for row, name in zip(rows, presses.COLUMNS):
            del row[name]
        felt, = presses.felt(trials.of_rows(rows), np.random.default_rng(1))
        self.assertEqual(sum(felt.counts), len(rows) - 3)
        self.assertEqual(presses.felt(trials.of_rows(matches(np.random.default_rng(1), 2, 0.002)), np.random.default_rng(1)), [])


class Published(unittest.TestCase):
    def test_signs_follow_the_pair(self):
        found = published.of_pair("haptic", "visual")
        self.assertIn((15.0, "Di Luca and Mahnan 2019"), [(x, t.short()) for x, t in found])
        self.assertEqual(sorted(-x for x, _ in found), sorted(x for x, _ in published.of_pair("visual", "haptic")))

    def test_every_number_has_a_source(self):
        self.assertTrue(all(t.source and t.ms > 0 for t in published.thresholds()))
        self.assertTrue(all(j.source and j.jnd > 0 for several in felt_properties.just_noticeable().values() for j in several))
        self.assertTrue(all(j.criterion for several in felt_properties.just_noticeable().values() for j in several))

    def test_a_jnd_counts_at_75_percent_whatever_its_criterion(self):
        stiffness = felt_properties.just_noticeable()["stiffness"][0]
        # Jones and Hunter 1990: 23 % is the standard deviation of matches, the 84.13 % point; 75 % lies at 0.6745 of it.
        self.assertAlmostEqual(stiffness.sigma, 23, places=4)
        self.assertAlmostEqual(stiffness.at75, 15.513, places=3)
        self.assertAlmostEqual(stiffness.of(200), 31.0265, places=3)
        unknown = felt_properties.just_noticeable()["temperature"][0]
        self.assertTrue(math.isnan(unknown.sigma))
        self.assertEqual((unknown.at75, unknown.criterion), (unknown.jnd, "unverified"))

    def test_criteria_lie_at_published_distances(self):
        # Quantiles of the normal distribution (Macmillan and Creelman 2005, table A5.1), in standard deviations of one presentation.
        for percent, one, two in ((70.7, 0.54464, None), (75, 0.67449, 0.95387), (79.4, 0.82038, 1.16018), (84, 0.99446, 1.40638)):
            self.assertAlmostEqual(felt_properties.apart(percent), one, delta=2e-5)
            if two:
                self.assertAlmostEqual(felt_properties.apart(percent, 2), two, delta=2e-5)
        self.assertAlmostEqual(felt_properties.apart(84) / felt_properties.apart(75), 1.4744, places=4)

    def test_the_ratio_to_a_limit_that_was_not_reached_has_no_upper_end(self):
        rng = np.random.default_rng(1)
        delay = Factor("visual", "delay", "ms")
        never = limits.from_draws("break", delay, "either", math.inf, np.full(100, np.inf), 400.0, "human", 10)
        seen = limits.from_draws("detect", delay, "sj", 50.0, np.full(100, 50.0), 200.0, "human", 10)
        self.assertEqual(limits.ratio(never, seen, rng).high, math.inf)


class Points(unittest.TestCase):
    def test_nearby_measured_levels_are_drawn_as_one_without_loss_of_answers(self):
        from tactus.analysis import curve_plots
        rng = np.random.default_rng(4)
        levels = np.repeat(LEVELS, 20) + rng.uniform(-4, 4, 20 * len(LEVELS))
        at, yes, total = curve_plots.together(levels, np.ones(len(levels)), np.full(len(levels), 2.0))
        self.assertEqual([40.0] * len(LEVELS), list(total))
        self.assertEqual([20.0] * len(LEVELS), list(yes))
        self.assertLess(np.abs(at - LEVELS).max(), 4)

    def test_evenly_spread_levels_stay_separate(self):
        from tactus.analysis import curve_plots
        at, yes, total = curve_plots.together(np.arange(0, 100, 0.5), np.zeros(200), np.ones(200))
        self.assertGreater(len(at), 12)
        self.assertEqual(200, total.sum())


if __name__ == "__main__":
    unittest.main()
