#!/usr/bin/env python3
"""Limits of performance: intervals and tests against published figures and independent programs, and L_break recovered from games with a known one."""
import math
import unittest

import analysis_tables
import numpy as np
from analysis_tables import game, games
from scipy import optimize, stats

from tactus.analysis import break_limits, frontier, limits, performance, resampling, trials
from tactus.analysis.operators import Factor
from tactus.refusal import Refusal

DELAY = Factor("visual", "delay", "ms")
MARGINS = (0.1, 1.1)


def cells(rows, seed=1, draws=400, limit=30.0):
    return performance.cells_of(performance.games_of(trials.of_rows(rows)), limit, np.random.default_rng(seed), draws)


class Proportions(unittest.TestCase):
    def test_the_interval_of_a_difference_is_newcombes(self):
        # Newcombe 1998, Statistics in Medicine 17:873, table II, method 10: 56/70 - 48/80 and 9/10 - 3/10.
        for counts, low, high in (((56, 70, 48, 80), 0.0524, 0.3339), ((9, 10, 3, 10), 0.1705, 0.8090)):
            rows = [game(i, i < counts[0], 5, [("visual", "delay", 40, "ms")]) for i in range(counts[1])]
            rows += [game(1000 + i, i < counts[2], 5) for i in range(counts[3])]
            made, clustered = cells(rows)
            found = performance.differences(made, clustered, MARGINS)[((DELAY, 40.0),)]
            np.testing.assert_allclose(found.success_interval, (low, high), atol=6e-5)

    def test_the_test_of_non_inferiority_is_the_score_test(self):
        # Farrington and Manning 1990: z with the variance at the maximum likelihood under p1 - p2 = -margin, here by search instead of by their cubic.
        for yes, n, base, m, margin in ((95, 100, 97, 100, 0.1), (70, 80, 60, 70, 0.15), (20, 20, 20, 20, 0.1), (850, 1000, 930, 1000, 0.1)):
            cost = lambda q: -(yes * np.log(q - margin) + (n - yes) * np.log(1 - q + margin) + base * np.log(q) + (m - base) * np.log1p(-q) if base < m
                               else yes * np.log(q - margin) + (n - yes) * np.log(1 - q + margin) + base * np.log(q))
            q = optimize.minimize_scalar(cost, bounds=(margin + 1e-9, 1 - 1e-12), method="bounded", options={"xatol": 1e-12}).x
            p = q - margin
            z = (yes / n - base / m + margin) / math.sqrt(p * (1 - p) / n + q * (1 - q) / m)
            self.assertAlmostEqual(performance.farrington_manning(yes, n, base, m, margin), stats.norm.sf(z), delta=2e-4)

    def test_all_lost_and_all_won_give_no_division_by_zero(self):
        self.assertGreater(performance.farrington_manning(0, 20, 20, 20, 0.1), 0.999)
        self.assertLess(performance.farrington_manning(200, 200, 200, 200, 0.1), 1e-4)

    def test_the_test_holds_its_level_at_the_margin(self):
        rng = np.random.default_rng(5)
        p = [performance.farrington_manning(int(rng.binomial(150, 0.83)), 150, int(rng.binomial(150, 0.93)), 150, 0.1) for _ in range(1500)]
        # 0.05 with a standard error of 0.0056.
        self.assertTrue(0.033 < np.mean(np.array(p) < 0.05) < 0.067, np.mean(np.array(p) < 0.05))


class Draws(unittest.TestCase):
    def test_draws_of_a_mean_have_its_standard_error(self):
        values = np.random.default_rng(1).gamma(4, 2, 40)
        drawn, _ = resampling.Resampler(["P01"], np.random.default_rng(2), 20000).of_cell(["P01"] * 40, values[:, None])
        self.assertAlmostEqual(drawn.std(), values.std(ddof=1) / math.sqrt(40), delta=0.02 * drawn.std() * 2)
        self.assertAlmostEqual(drawn.mean(), values.mean(), delta=0.02)

    def test_of_five_participants_on_people_are_the_sample(self):
        people = [f"P{i:02}" for i in range(8)]
        own = np.random.default_rng(1).normal(10, 2, 8)
        values, names = np.repeat(own, 50), np.repeat(people, 50)
        drawn, _ = resampling.Resampler(names, np.random.default_rng(2), 20000).of_cell(names, values[:, None])
        # 400 values of 8 people carry the information of 8 values.
        self.assertAlmostEqual(drawn.std(), own.std(ddof=1) / math.sqrt(8), delta=0.03 * drawn.std())
        few, _ = resampling.Resampler(names[:200], np.random.default_rng(2), 20000).of_cell(names[:200], values[:200, None])
        self.assertLess(few.std(), 0.3 * drawn.std())

    def test_20_of_20_do_not_prove_certainty(self):
        drawer = resampling.Resampler(["P01"], np.random.default_rng(2), 20000)
        means, mass = drawer.of_cell(["P01"] * 20, np.ones((20, 1)))
        low, _ = resampling.interval(drawer.share(means[:, 0], mass), 0.9)
        self.assertAlmostEqual(low, stats.beta.ppf(0.05, 20.5, 0.5), delta=0.02)

    def test_limits_that_were_not_reached_are_the_largest(self):
        self.assertEqual(resampling.interval(np.array([1.0] * 10 + [np.inf] * 10)), (1.0, np.inf))


def broken(made, clustered=False, factor=DELAY, margins=MARGINS, seed=1):
    return break_limits.break_limits(made, factor, clustered, margins, "simulated", np.random.default_rng(seed))


class Brackets(unittest.TestCase):
    """L_break of a Hill function of 0.96 / (1 + (x / 60)^4): 35.0370 ms for 10 points, in closed form."""
    def made(self, seed, each=1000):
        rng = np.random.default_rng(seed)
        rows = [row for x in (0, 25, 50, 100, 150, 200) for row in games(rng, each, [("visual", "delay", x, "ms")], 0.96 / (1 + (x / 60) ** 4), 6, first=10_000 * x)]
        return cells(rows, draws=10)[0]

    def test_it_lies_between_levels_and_holds_the_limit_with_the_estimate_inside(self):
        held = 0
        for seed in range(20):
            success = broken(self.made(seed))[0]
            self.assertTrue(set(success.bracket) <= {0, 25, 50, 100, 150, 200, math.inf}, success.bracket)
            held += success.bracket[0] <= 35.0370 <= success.bracket[1]
        self.assertGreaterEqual(held, 19)  # at least 95 of 100

    def test_it_uses_intervals_that_hold_over_all_levels_together(self):
        # Sidak: five levels need z = 2.57 each.
        self.assertAlmostEqual(stats.norm.ppf((1 + 0.95 ** (1 / 5)) / 2), 2.57, places=2)
        # 20 games a level show nothing about a loss of 10 points at 25 and 50 ms, but that 200 ms loses all.
        made = self.made(1, each=20)
        low, high = break_limits.bracket(limits.series(made, DELAY), np.array([25, 50, 100, 150, 200.0]), made[()], False, MARGINS, "success")
        self.assertTrue(low == 0 and 50 <= high <= 150, (low, high))

    def test_success_that_falls_does_not_make_the_time_longer(self):
        # 86 % won at 40 ms instead of 96 %, in the same times: the restricted mean grows by 1.14, the time to win does not.
        rng = np.random.default_rng(4)
        rows = [row for x, share in ((0, 0.96), (40, 0.86)) for row in games(rng, 4000, [("visual", "delay", x, "ms")], share, 12.1875, first=10_000 * x)]
        d, = performance.differences(*cells(rows, draws=10), MARGINS, limit=30.0).values()
        self.assertAlmostEqual(d.time, 1.0, delta=0.02)
        self.assertAlmostEqual(d.restricted, 14.681 / 12.9, delta=0.02)
        self.assertAlmostEqual(sum(d.parts_s), d.restricted * 12.9 - 12.9, delta=0.2)
        self.assertLess(abs(d.parts_s[1]), 0.15)

    def test_a_level_at_which_few_win_has_no_time_and_the_limit_says_so(self):
        rng = np.random.default_rng(5)
        rows = [row for x in (0, 40, 80) for row in games(rng, 200, [("visual", "delay", x, "ms")], 0.95, 8 * (1 + 0.02 * x), first=10_000 * x)]
        rows += [game(900_000 + i, False, 30, [("visual", "delay", 160, "ms")]) for i in range(200)]
        _, time, either = broken(cells(rows, draws=10)[0])
        self.assertIn("not identified at 160 ms", time.note)
        self.assertEqual(time.up_to, 80)
        self.assertIn("not identified", either.note)

    def test_the_limit_over_the_margin_and_over_the_time_limit(self):
        made = self.made(6)
        found = break_limits.worsenings(made, DELAY, False, np.random.default_rng(1))
        rows = break_limits.curves(made, DELAY, False, MARGINS, 30.0, np.random.default_rng(1), found)
        over = {round(100 * r["margin"]): r for r in rows if r["outcome"] == "success" and r["limit_s"] == 30.0}
        self.assertEqual(sorted(over), list(range(1, 51)))
        # Closed form: x50 ((m / p0) / (1 - m / p0))^(1 / n).
        for percent, truth in ((5, 29.0491), (10, 35.0370), (20, 42.9740)):
            self.assertTrue(over[percent]["low"] <= truth <= over[percent]["high"], (percent, over[percent]))
        values = [over[p]["value"] for p in sorted(over)]
        self.assertEqual(values, sorted(values))
        self.assertEqual({r["limit_s"] for r in rows}, {30.0 * s for s in break_limits.SHORTER})


class Breaking(unittest.TestCase):
    """A share that falls, and a time that grows, in a straight line with the level: both margins are reached at 120 ms."""
    LEVELS = (40, 80, 160, 240)

    def rows(self, rng, n=120, participants=1, spread=0.0):
        made = []
        for p in range(participants):
            off = rng.normal(0, spread)
            for x in (0, *self.LEVELS):
                made += games(rng, n // participants, [("visual", "delay", x, "ms")], min(0.999, 0.9 - 0.1 * x / 120 + off), 6 * (1 + 0.1 * x / 120), first=len(made),
                              participant=f"P{p:02}")
        return made

    def test_l_break_is_recovered_in_95_of_100(self):
        inside, values, repetitions = np.zeros(2), [], 300
        for seed in range(repetitions):
            # No game reaches the limit, and lost games end early: time and success are separate, each with its known crossing.
            rows = self.rows(np.random.default_rng(seed))
            made, clustered = cells(rows, seed, 400)
            found = broken(made, clustered)[0]
            inside[0] += found.low <= 120 <= found.high
            values.append(found.value)
        # At least 285 expected, binomial standard deviation 3.8. The fit must hold for steep curves too, so it holds a straight one more often.
        self.assertGreaterEqual(inside[0], 273)
        self.assertTrue(90 < np.median(values) < 150, np.median(values))

    def test_l_break_by_time_is_recovered_in_95_of_100(self):
        inside = 0
        for seed in range(300):
            rng = np.random.default_rng(1000 + seed)
            rows = [row for x in (0, *self.LEVELS) for row in games(rng, 100, [("visual", "delay", x, "ms")], 1.1, 6 * (1 + 0.1 * x / 120), first=1000 * x)]
            made, clustered = cells(rows, seed, 400)
            found = broken(made, clustered)[1]
            inside += found.low <= 120 <= found.high
        self.assertTrue(273 <= inside <= 297, inside)

    def test_over_people_the_interval_is_of_people(self):
        inside = 0
        for seed in range(200):
            rng = np.random.default_rng(seed)
            rows = []
            for p in range(12):
                slope = rng.normal(0.1, 0.03)  # the effect of a delay differs between people
                for x in (0, *self.LEVELS):
                    rows += games(rng, 10, [("visual", "delay", x, "ms")], 1.1, 6 * (1 + slope * x / 120), first=len(rows), participant=f"P{p:02}")
            made, clustered = cells(rows, seed, 400)
            self.assertTrue(clustered)
            found = broken(made, clustered)[1]
            inside += found.low <= 120 <= found.high
        # 190 expected, binomial standard deviation 3.1.
        self.assertTrue(181 <= inside <= 199, inside)

    def test_a_rate_counts_by_its_period(self):
        rate = Factor("visual", "rate", "Hz")
        rows = [game(i, True, 6.0) for i in range(50)]
        for hz in (60, 30, 10, 5):
            rows += [game(1000 * hz + i, True, 6.0 * (1 + 2 / hz), [("visual", "rate", hz, "Hz")]) for i in range(50)]
        made, clustered = cells(rows)
        found = broken(made, clustered, rate)
        self.assertAlmostEqual(found[1].value, 20, delta=1)  # 2 / hz = 0.1; between the played 30 and 10 Hz
        self.assertFalse(found[0].reached)
        self.assertEqual(found[0].up_to, 5)

    def test_a_limit_that_was_not_reached_names_the_largest_level(self):
        rows = [row for x in (0, 40, 80) for row in games(np.random.default_rng(x), 100, [("visual", "delay", x, "ms")], 1.1, 6, first=1000 * x)]
        found = broken(cells(rows)[0], margins=(0.1, 1.5))
        self.assertEqual([(l.reached, l.up_to) for l in found], [(False, 80)] * 3)

    def test_harmless_needs_evidence(self):
        for n, harmless in ((20, False), (600, True)):
            rows = [row for x in (0, 40) for row in games(np.random.default_rng(x + 1), n, [("visual", "delay", x, "ms")], 0.95, 6, first=1000 * x)]
            made, clustered = cells(rows)
            d, = performance.differences(made, clustered, MARGINS).values()
            self.assertEqual((d.harmless, d.harmful), (harmless, False), n)

    def test_levels_are_tested_from_the_mildest_to_the_first_that_fails(self):
        # Success lower by 0, 9, 0 points of 600: the second level cannot be shown to be harmless, so the third is not tested.
        rows = [game(1000 * x + i, i >= lost, 5 + 0.01 * (i % 7), [("visual", "delay", x, "ms")]) for x, lost in ((0, 6), (20, 6), (40, 60), (80, 6)) for i in range(600)]
        found = performance.differences(*cells(rows), MARGINS, limit=30.0)
        self.assertEqual([found[((DELAY, x),)].harmless for x in (20.0, 40.0, 80.0)], [True, False, False])
        self.assertLess(found[((DELAY, 80.0),)].p_success, 0.025)

    def test_conditions_without_an_order_are_tested_by_holm(self):
        # Published example: p of .004 .011 .02 .03 .2 become .020 .044 .060 .060 .200 (Holm 1979).
        from statsmodels.stats.multitest import multipletests
        np.testing.assert_allclose(multipletests([0.004, 0.011, 0.02, 0.03, 0.2], method="holm")[1], [0.020, 0.044, 0.060, 0.060, 0.200])
        alike = lambda factor, first, lost: [game(first + i, i >= lost, 5 + 0.01 * (i % 7), factor) for i in range(38)]
        # One removal alone: p between alpha / 2 and alpha passes; of two such it does not.
        one = performance.differences(*cells(alike((), 0, 0) + alike([("visual", "off", "", "")], 100, 0)), MARGINS)
        p = next(iter(one.values())).p_success
        self.assertTrue(0.0125 < p < 0.025, p)
        self.assertTrue(all(d.harmless for d in one.values()))
        two = performance.differences(*cells(alike((), 0, 0) + alike([("visual", "off", "", "")], 100, 0) + alike([("audio", "off", "", "")], 200, 0)), MARGINS)
        self.assertFalse(any(d.harmless for d in two.values()))

    def test_a_level_at_the_margin_is_called_harmless_in_at_most_2_5_of_100(self):
        # 12 people who differ (standard deviation 0.5 of the log odds), 20 games each; success is lower by the margin. Standard error 0.7 %.
        rng, wrong, names = np.random.default_rng(3), 0, np.repeat([f"P{i:02}" for i in range(12)], 20)
        for _ in range(500):
            own = rng.normal(0, 0.5, 12)
            share = lambda p: (rng.random(240) < np.repeat(1 / (1 + np.exp(-(np.log(p / (1 - p)) + own))), 20)) * 1.0
            made = {(): performance.Cell((), names, share(0.955), np.ones(240), {}), "x": performance.Cell((), names, share(0.852), np.ones(240), {})}
            for c in made.values():
                c.ended_s = c.time_s
            wrong += performance.compared_success(made["x"], made[()], True, 0.95)[0] > -0.1
        self.assertLessEqual(wrong / 500, 0.025 + 3 * 0.007)

    def test_the_score_test_agrees_with_published_examples(self):
        # Farrington and Manning 1990, computed independently: 440/500 against 460/500 and 44/50 against 46/50, margin 10 points.
        self.assertAlmostEqual(performance.farrington_manning(440, 500, 460, 500, 0.1), 0.00115696, places=7)
        self.assertAlmostEqual(performance.farrington_manning(44, 50, 46, 50, 0.1), 0.167663, places=5)

    def test_a_low_baseline_shows_no_level_to_be_harmless(self):
        rows = [game(i, i % 600 < 30, 29, [("visual", "delay", 40, "ms")] if i >= 600 else ()) for i in range(1200)]
        made, clustered = cells(rows)
        self.assertTrue(performance.differences(made, clustered, (0.04, 1.001), limit=30.0)[((DELAY, 40.0),)].p_success < 1)
        d, = performance.differences(made, clustered, MARGINS, limit=30.0).values()
        self.assertEqual((d.p_success, d.p_time, d.harmless), (1, 1, False))

    def test_one_game_shows_no_harm(self):
        made, clustered = cells([game(1, True, 5), game(2, False, 0, [("visual", "delay", 40, "ms")])])
        d, = performance.differences(made, clustered, MARGINS, limit=30.0).values()
        self.assertEqual((d.harmless, d.harmful), (False, False))

    def test_the_ratio_is_of_the_limits_and_its_interval_of_both(self):
        rng = np.random.default_rng(1)
        one = lambda kind, at, sd: limits.from_draws(kind, DELAY, "x", at, rng.normal(at, sd, 20000), 400.0, "simulated", 10)
        found = limits.ratio(one("break", 120, 6), one("detect", 60, 3), rng)
        self.assertAlmostEqual(found.value, 2)
        # Fieller's interval of the ratio of two normal means with 5 % each: 2 (1 ± 1.96 sqrt(2) 0.05), to second order.
        np.testing.assert_allclose((found.low, found.high), (2 * (1 - 0.128), 2 * (1 + 0.148)), atol=0.03)


class Games(unittest.TestCase):
    def test_a_game_not_won_counts_with_the_limit(self):
        rows = [game(1, True, 10), game(2, False, 0, limit_s=math.nan), game(3, True, 45)]
        made, _ = cells(rows, limit=30.0)
        self.assertEqual(list(made[()].time_s), [10, 30, 30])
        self.assertEqual(list(made[()].success), [1, 0, 0])

    def test_a_limit_is_needed_where_games_were_lost(self):
        lost = trials.of_rows([game(1, True, 10), game(2, False, 0, limit_s=math.nan)])
        with self.assertRaisesRegex(Refusal, "--time-limit"):
            performance.limit_s(lost, None)
        self.assertEqual(performance.limit_s(trials.of_rows([game(1, True, 10), game(2, False, 0)]), None), 30)
        self.assertEqual(performance.limit_s(trials.of_rows([game(1, True, 10)]), None), math.inf)
        with self.assertRaisesRegex(Refusal, "after 0 s"):
            performance.limit_s(trials.of_rows([game(1, True, 0)]), 30.0)

    def test_a_study_without_a_baseline_is_refused(self):
        with self.assertRaisesRegex(Refusal, "baseline"):
            performance.differences(*cells([game(1, True, 5, [("visual", "delay", 40, "ms")])]), MARGINS)

    def test_a_level_of_zero_is_the_baseline_and_a_removal_needs_no_level(self):
        made, _ = cells([game(1, True, 5, [("visual", "delay", 0, "ms")]), game(2, True, 5), game(3, False, 5, [("visual", "off", "", "")]),
                         game(4, True, 5, [("visual", "delay", 40, "ms"), ("audio", "delay", 0, "ms")])])
        self.assertEqual({k: c.n for k, c in made.items()}, {(): 2, ((Factor("visual", "off"), 0.0),): 1, ((DELAY, 40.0),): 1})

    def test_the_achieved_delay_is_what_counts(self):
        rows = [game(i, True, 5) for i in range(5)] + [game(10 + i, True, 6, [("visual", "delay", 40, "ms")], pair="haptic,visual", soa_achieved_ms=47.0) for i in range(5)]
        rows += [game(20 + i, True, 6, [("visual", "delay", 80, "ms")], pair="visual,haptic", soa_achieved_ms=-85.0) for i in range(5)]
        made, _ = cells(rows)
        self.assertEqual([c.achieved for c in limits.series(made, DELAY)], [47, 85])


class Frontiers(unittest.TestCase):
    def test_two_additive_senses_give_a_straight_frontier(self):
        touch, sight = Factor("haptic", "delay", "ms"), DELAY
        rows = []
        for a in (0, 20, 40):
            for b in (0, 50, 100, 200):
                rows += [game(len(rows) + i, True, 6 * (1 + 0.05 * a / 20 + 0.1 * b / 100), [("haptic", "delay", a, "ms"), ("visual", "delay", b, "ms")]) for i in range(10)]
        made, _ = cells(rows)
        self.assertEqual(frontier.pairs_of(made), [(touch, sight)])
        found = frontier.frontier(made, touch, sight, False, MARGINS, "simulated", np.random.default_rng(1))
        self.assertEqual((found.first_levels, found.second_levels), ([0, 20, 40], [0, 50, 100, 200]))
        np.testing.assert_allclose([l.value for _, l in found.edge], [100, 50, 0], atol=3)
        self.assertFalse(np.isnan(found.grid(lambda c: c.share)).any())

    def test_if_the_first_alone_reaches_the_margin_the_limit_of_the_second_is_0(self):
        slow = {None: [], 20: [("visual", "rate", 20, "Hz")], 5: [("visual", "rate", 5, "Hz")]}
        rows = [game(100 * i + j, not late, 6, ([("haptic", "delay", late, "ms")] if late else []) + slow[hz]) for i, (late, hz) in enumerate((late, hz) for late in (0, 200) for hz in slow)
                for j in range(20)]
        made, _ = cells(rows)
        found = frontier.frontier(made, *frontier.pairs_of(made)[0], False, MARGINS, "simulated", np.random.default_rng(1))
        (_, borne), (_, none) = found.edge
        self.assertFalse(borne.reached)
        self.assertEqual((none.reached, none.value, limits.severity_of(none)), (True, 0, 0))


if __name__ == "__main__":
    unittest.main()
