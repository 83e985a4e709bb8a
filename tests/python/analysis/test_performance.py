#!/usr/bin/env python3
"""Limits of performance: intervals and tests against published figures and independent programs, and L_break recovered from games with a known one."""
import math
import unittest

import analysis_tables
import numpy as np
from analysis_tables import game, games
from scipy import optimize, stats

from tactus.analysis import crossing, frontier, limits, performance, resampling, trials
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


class Crossings(unittest.TestCase):
    def test_the_isotonic_curve_is_the_nearest_that_does_not_fall(self):
        rng = np.random.default_rng(3)
        for _ in range(20):
            values, weights = rng.normal(0, 1, (5, 1)), rng.uniform(1, 4, 5)
            found = crossing.isotonic(values, weights)[:, 0]
            best = optimize.minimize(lambda v: np.sum(weights * (v - values[:, 0]) ** 2), np.sort(values[:, 0]), method="SLSQP", options={"ftol": 1e-14},
                                     constraints=[{"type": "ineq", "fun": np.diff}]).x
            np.testing.assert_allclose(found, best, atol=1e-4)

    def test_a_straight_worsening_crosses_where_algebra_says(self):
        at = crossing.crossing(np.array([10.0, 20, 40]), np.array([[0.05], [0.1], [0.2]]), [1, 1, 1], 0.08)
        self.assertAlmostEqual(at[0], 16)
        self.assertEqual(crossing.crossing(np.array([10.0, 20]), np.array([[0.01], [0.02]]), [1, 1], 0.08)[0], np.inf)
        self.assertEqual(crossing.crossing(np.array([10.0, 20]), np.array([[0.3], [0.4]]), [1, 1], 0.08, np.array([0.2]))[0], 0)


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
            made, _ = cells(rows, seed, 400)
            found = limits.break_limits(made, DELAY, MARGINS, "simulated")[0]
            inside[0] += found.low <= 120 <= found.high
            values.append(found.value)
        # 285 expected, binomial standard deviation 3.8.
        self.assertTrue(273 <= inside[0] <= 297, inside)
        self.assertTrue(90 < np.median(values) < 150, np.median(values))

    def test_l_break_by_time_is_recovered_in_95_of_100(self):
        inside = 0
        for seed in range(300):
            rng = np.random.default_rng(1000 + seed)
            rows = [row for x in (0, *self.LEVELS) for row in games(rng, 100, [("visual", "delay", x, "ms")], 1.1, 6 * (1 + 0.1 * x / 120), first=1000 * x)]
            made, _ = cells(rows, seed, 400)
            found = limits.break_limits(made, DELAY, MARGINS, "simulated")[1]
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
            found = limits.break_limits(made, DELAY, MARGINS, "simulated")[1]
            inside += found.low <= 120 <= found.high
        # 190 expected; a percentile interval of 12 clusters is known to hold a little less (Davison and Hinkley 1997, section 5.3).
        self.assertGreaterEqual(inside, 178)

    def test_a_rate_counts_by_its_period(self):
        rate = Factor("visual", "rate", "Hz")
        rows = [game(i, True, 6.0) for i in range(50)]
        for hz in (60, 30, 10, 5):
            rows += [game(1000 * hz + i, True, 6.0 * (1 + 2 / hz), [("visual", "rate", hz, "Hz")]) for i in range(50)]
        made, _ = cells(rows)
        found = limits.break_limits(made, rate, MARGINS, "simulated")
        self.assertAlmostEqual(found[1].value, 20, places=6)  # 2 / hz = 0.1
        self.assertFalse(found[0].reached)
        self.assertEqual(found[0].up_to, 5)

    def test_a_limit_that_was_not_reached_names_the_largest_level(self):
        rows = [row for x in (0, 40, 80) for row in games(np.random.default_rng(x), 100, [("visual", "delay", x, "ms")], 1.1, 6, first=1000 * x)]
        found = limits.break_limits(cells(rows)[0], DELAY, (0.1, 1.5), "simulated")
        self.assertEqual([(l.reached, l.up_to) for l in found], [(False, 80)] * 3)

    def test_harmless_needs_evidence(self):
        for n, harmless in ((20, False), (600, True)):
            rows = [row for x in (0, 40) for row in games(np.random.default_rng(x + 1), n, [("visual", "delay", x, "ms")], 0.95, 6, first=1000 * x)]
            made, clustered = cells(rows)
            d, = performance.differences(made, clustered, MARGINS).values()
            self.assertEqual((d.harmless, d.harmful), (harmless, False), n)

    def test_holm_corrects_the_tests_of_each_factor_separately(self):
        # All won in the same time: p of time is the smallest possible, p of success lies between alpha/2 and alpha, which passes Holm's second test but not Bonferroni's.
        alike = lambda factor, first: [game(first + i, True, 5, factor) for i in range(27)]
        sight = alike((), 0) + alike([("visual", "delay", 40, "ms")], 100)
        one, = performance.differences(*cells(sight), MARGINS).values()
        self.assertTrue(0.025 < one.p_success < 0.05 and one.p_time < 0.025, one)
        self.assertTrue(one.harmless)
        other = performance.differences(*cells(sight + alike([("audio", "delay", 40, "ms")], 200)), MARGINS)
        self.assertTrue(all(d.harmless for d in other.values()))
        second = performance.differences(*cells(sight + alike([("visual", "delay", 80, "ms")], 200)), MARGINS)
        self.assertFalse(any(d.harmless for d in second.values()))  # two tests of success: the smaller p must be at most alpha/2

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
        found = frontier.frontier(made, touch, sight, MARGINS, "simulated")
        self.assertEqual((found.first_levels, found.second_levels), ([0, 20, 40], [0, 50, 100, 200]))
        np.testing.assert_allclose([l.value for _, l in found.edge], [100, 50, 0], atol=1e-6)
        self.assertFalse(np.isnan(found.grid(lambda c: c.share)).any())

    def test_if_the_first_alone_reaches_the_margin_the_limit_of_the_second_is_0(self):
        slow = {None: [], 20: [("visual", "rate", 20, "Hz")], 5: [("visual", "rate", 5, "Hz")]}
        rows = [game(100 * i + j, not late, 6, ([("haptic", "delay", late, "ms")] if late else []) + slow[hz]) for i, (late, hz) in enumerate((late, hz) for late in (0, 200) for hz in slow)
                for j in range(20)]
        made, _ = cells(rows)
        found = frontier.frontier(made, *frontier.pairs_of(made)[0], MARGINS, "simulated")
        (_, borne), (_, none) = found.edge
        self.assertFalse(borne.reached)
        self.assertEqual((none.reached, none.value, limits.severity_of(none)), (True, 0, 0))


if __name__ == "__main__":
    unittest.main()
