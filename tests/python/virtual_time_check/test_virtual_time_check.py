"""tests/measure/measure_agreement: comparisons with bounds, for runs and games with known figures."""
import csv
import json
import math
import pathlib
import sys
import tempfile
import unittest

import numpy as np
from scipy.stats import kendalltau, ttest_rel
from statsmodels.stats.proportion import confint_proportions_2indep, proportion_confint
from statsmodels.stats.weightstats import CompareMeans, DescrStatsW

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.study import study_file
from tactus.virtual_time_check import bounds, game_figures, plays, scene_figures

MS = 1_000_000
RATES = {"sim_node": 1000.0, "haptic_node": 1000.0, "audio_node": 375.0, "visual_node": 60.0, "thermal_node": 50.0}


class Verdicts(unittest.TestCase):
    def test_an_interval_holds_misses_or_straddles_its_bound(self):
        for low, high, says in ((-0.1, 0.1, bounds.HOLDS), (0.15, 0.15, bounds.HOLDS), (0.16, 0.3, bounds.MISSED), (-0.3, -0.16, bounds.MISSED),
                                (0.1, 0.2, bounds.OPEN), (-0.5, 0.5, bounds.OPEN), (math.nan, math.nan, bounds.OPEN)):
            self.assertEqual(says, bounds.verdict(low, high, 0.15), (low, high))

    def test_a_figure_without_interval_is_compared_by_its_difference_and_a_missing_one_is_open(self):
        self.assertEqual([bounds.HOLDS, bounds.MISSED, bounds.OPEN], [bounds.single("latency", "ms", live, 10.0, 2.0).verdict for live in (11.5, 7.0, math.nan)])
        self.assertEqual(bounds.MISSED, bounds.single("events lost", "", 1.0, 0.0, 0.0).verdict)

    def test_a_row_of_json_has_no_nan(self):
        json.dumps(bounds.single("latency", "ms", math.nan, 10.0, 2.0).row(), allow_nan=False)


class Scene(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.count = 0

    def runs(self, *each):
        """Runs of (hits, {sense: (delay, lateness)} in ms, more members of the summary)."""
        found = scene_figures.Runs()
        for hits, senses, *more in each:
            # The first two events are from before the run has settled.
            self.count += 1
            folder = self.root / str(self.count)
            folder.mkdir()
            at = [1000, 1100, *(4000 + 100 * i for i in range(hits))]
            events = [["event_id", "host_ns"], *([i, ms * MS] for i, ms in enumerate(at))]
            presented = [["modality", "event_id", "part", "scheduled_ns", "presented_ns", "uncertainty_ns", "outcome"]]
            presented += [[sense, i, "whole", (ms + delay * (ms >= 4000)) * MS, (ms + (delay + later) * (ms >= 4000)) * MS, 1, "presented"]
                          for sense, (delay, later) in senses.items() for i, ms in enumerate(at)]
            for name, rows in (("events.csv", events), ("presented.csv", presented)):
                with open(folder / name, "w", newline="", encoding="utf-8") as file:
                    csv.writer(file).writerows(rows)
            summary = {"realtime_factor": 1.0, "nodes": {name: {"rate_hz": rate, "missed_ticks": 0} for name, rate in RATES.items()},
                       "contacts": {"begin": 2 * hits, "hit": hits, "by_modality": {"audio": {"lost": 0}, "visual": {"lost": 0}}}, **(more[0] if more else {})}
            (folder / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
            found.add(scene_figures.read(folder))
        return found

    def held(self, live, virtual):
        return {h.figure: h for h in scene_figures.rows(live, virtual)}

    def test_equal_runs_hold_every_bound(self):
        senses = {"haptic": (0, 1), "audio": (20, 0), "visual": (20, -3), "thermal": (20, 10)}
        held = self.held(self.runs((40, senses), (40, senses)), self.runs((40, senses), (40, senses)))
        self.assertEqual({bounds.HOLDS}, {h.verdict for h in held.values()}, held)
        figures = ("visual: scheduled after the event", "visual: presented after that", "visual: presented after the event", "asynchrony audio to visual")
        self.assertEqual([20, -3, 17, -3], [held[f].live for f in figures])

    def test_events_before_sound_and_vision_have_settled_count_as_contacts_only(self):
        runs = self.runs((7, {"haptic": (0, 1), "audio": (20, 0), "visual": (20, 0)}))
        self.assertEqual((7, 7), (runs.each[0]["hits"], runs.each[0]["settled"]))
        self.assertEqual({sense: [delay] * 7 for sense, delay in (("haptic", 0), ("audio", 20), ("visual", 20))}, runs.scheduled)

    def test_each_sense_has_the_bound_of_its_loop_plus_a_frame_if_it_waits_for_vision(self):
        senses = {"haptic": (0, 1), "audio": (20, 0), "visual": (20, 0), "thermal": (20, 0)}
        held = self.held(self.runs((9, senses)), self.runs((9, senses)))
        frame, block = 1000 / 60, 1000 / 375
        for figure, bound in (("haptic: presented after the event", 1), ("audio: scheduled after the event", frame), ("audio: presented after that", block),
                              ("audio: presented after the event", frame + block), ("visual: presented after the event", frame), ("thermal: presented after the event", 20),
                              ("asynchrony audio to visual", frame + block), ("asynchrony haptic to visual", frame + 1), ("rate of visual_node", 0.3)):
            self.assertAlmostEqual(bound, held[figure].bound, msg=figure)

    def test_a_sense_two_frames_late_and_a_lost_event_miss_their_bounds(self):
        lost = {"contacts": {"begin": 80, "hit": 40, "by_modality": {"audio": {"lost": 1}}}}
        held = self.held(self.runs((40, {"haptic": (0, 1), "visual": (54, 0)}, lost)), self.runs((40, {"haptic": (0, 1), "visual": (20, 0)})))
        self.assertEqual([bounds.MISSED] * 3 + [bounds.HOLDS], [held[f].verdict for f in ("visual: presented after the event", "asynchrony haptic to visual", "events lost, live",
                                                                                     "haptic: presented after the event")])

    def test_counts_are_compared_by_the_interval_between_the_means_of_runs(self):
        senses = {"haptic": (0, 1)}
        few, many, wide = ([(n, senses) for n in counts] for counts in ((40, 41, 40), (60, 61, 60), (20, 60, 40)))
        says = lambda a, b: self.held(self.runs(*a), self.runs(*b))["hits in a run"].verdict
        self.assertEqual((bounds.HOLDS, bounds.MISSED, bounds.OPEN, bounds.OPEN), (says(few, few), says(few, many), says(few, wide), says(few[:1], few)))

    def test_the_interval_between_means_agrees_with_statsmodels(self):
        dice = np.random.default_rng(1)
        a, b = dice.normal(5, 1, 6), dice.normal(6, 3, 4)
        expected = CompareMeans(DescrStatsW(a), DescrStatsW(b)).tconfint_diff(usevar="unequal")
        self.assertTrue(np.allclose(scene_figures.welch(a, b), expected, atol=1e-9))


def cell(name, live, virtual, limit_s=60.0):
    """Games with these times; None: not won."""
    pairs = game_figures.Pairs(name, limit_s)
    for a, b in zip(live, virtual):
        pairs.add(*((t is not None, limit_s if t is None else t) for t in (a, b)))
    return pairs


class Games(unittest.TestCase):
    def test_the_default_conditions_are_in_the_study(self):
        self.assertLessEqual(set(plays.CONDITIONS), {c.id for c in study_file.read(plays.STUDY).conditions})

    def test_shares_and_times_agree_with_statsmodels_and_scipy(self):
        dice = np.random.default_rng(2)
        live, virtual = ([t if t < 60 else None for t in dice.uniform(10, 90, 30)] for _ in range(2))
        c = cell("some", live, virtual)
        won = [sum(t is not None for t in each) for each in (live, virtual)]
        self.assertTrue(np.allclose(game_figures.wilson(c.live_won), proportion_confint(won[0], 30, 0.05, "wilson"), atol=1e-12))
        expected = confint_proportions_2indep(won[0], 30, won[1], 30, method="newcomb", compare="diff")
        self.assertTrue(np.allclose((c.success().low, c.success().high), expected, atol=1e-9))
        self.assertAlmostEqual((won[0] - won[1]) / 30, c.success().difference)
        seconds = [np.array([60 if t is None else t for t in each]) for each in (live, virtual)]
        self.assertTrue(np.allclose((c.time().low, c.time().high), ttest_rel(*seconds).confidence_interval(0.95), atol=1e-9))
        self.assertAlmostEqual(9.0, c.time().bound)

    def test_a_game_won_after_the_limit_counts_as_not_won(self):
        c = cell("late", [61.0], [59.0])
        self.assertEqual(([0], [60.0], [1], [59.0]), (c.live_won, c.live_s, c.virtual_won, c.virtual_s))

    def test_different_games_miss_equal_games_hold_and_few_games_are_open(self):
        says = lambda live, virtual, n: cell("some", live * n, virtual * n).success().verdict
        self.assertEqual((bounds.MISSED, bounds.HOLDS, bounds.OPEN), (says([None], [20.0], 10), says([20.0], [20.0], 25), says([20.0], [20.0], 10)))
        self.assertEqual(bounds.OPEN, cell("one", [20.0], [None]).time().verdict)
        self.assertEqual([bounds.OPEN] * 2, [h.verdict for h in (cell("none", [], []).success(), cell("none", [], []).time())])
        json.dumps([cell("none", [], []).row(), *(o.row() for o in game_figures.orders([cell("none", [], [])], draws=10))], allow_nan=False)

    def test_times_without_won_games_are_as_open_as_success(self):
        for n, says in ((2, bounds.OPEN), (10, bounds.OPEN), (25, bounds.HOLDS)):
            lost = cell("ruinous", [None] * n, [None] * n)
            self.assertEqual((says, says), (lost.success().verdict, lost.time().verdict), n)
            self.assertAlmostEqual(60 * lost.success().high, lost.time().high)

    def test_all_conditions_together_are_more_precise_than_each_alone(self):
        won, lost = ([cell(str(i), [t] * 10, [t] * 9 + [u]) for i in range(4)] for t, u in ((20.0, 21.0), (None, None)))
        self.assertEqual({bounds.OPEN}, {c.success().verdict for c in won + lost})
        self.assertEqual([bounds.HOLDS] * 2, [h.verdict for h in game_figures.together(won + lost)])
        self.assertEqual([bounds.OPEN] * 2, [h.verdict for h in game_figures.together([cell("few", [20.0], [20.0])])])
        worse = [cell(str(i), [None] * 6 + [20.0] * 4, [20.0] * 10) for i in range(4)]
        self.assertEqual([bounds.MISSED] * 2, [h.verdict for h in game_figures.together(worse)])

    def test_the_interval_over_conditions_covers_the_truth(self):
        dice, inside = np.random.default_rng(5), 0
        for _ in range(300):
            cells = [game_figures.Pairs("c", 60.0, *(list((dice.random(10) < p).astype(int)) if of == "won" else [60.0] * 10 for of in ("won", "s", "won", "s")))
                     for p in (0.98, 0.9, 0.7, 0.5, 0.3, 0.02)]
            low, high = game_figures.stratified(cells)
            inside += low <= 0 <= high
        self.assertGreater(inside / 300, 0.92)

    def test_the_same_order_of_conditions_holds_and_the_reverse_is_missed(self):
        times = [10.0, 20.0, 30.0, 40.0, 50.0, None]
        cells = lambda virtual: [cell(str(a), [a] * 5, [b] * 5) for a, b in zip(times, virtual)]
        by_success, by_time = game_figures.orders(cells(times), draws=200)
        reverse = game_figures.orders(cells(times[::-1]), draws=200)[1]
        for order, value, says in ((by_time, 1, bounds.HOLDS), (by_success, 1, bounds.HOLDS), (reverse, -1, bounds.MISSED)):
            self.assertAlmostEqual(value, order.tau)
            self.assertAlmostEqual(value, order.rho)
            self.assertEqual(says, order.verdict)

    def test_an_order_within_the_scatter_of_games_is_open(self):
        dice = np.random.default_rng(3)
        cells = [cell(str(i), list(dice.uniform(10, 50, 4)), list(dice.uniform(10, 50, 4))) for i in range(8)]
        order = game_figures.orders(cells, draws=200)[1]
        self.assertLess(order.reached, game_figures.LEAST_TAU)
        self.assertEqual(bounds.OPEN, order.verdict)

    def test_redrawn_games_have_the_shares_and_times_of_the_played_ones(self):
        cells = [cell("all", [20.0] * 50, [20.0] * 50), cell("half", [30.0] * 50, [30.0, None] * 25), cell("none", [None] * 50, [None] * 50)]
        for success, time_s in game_figures.redrawn(cells, np.random.default_rng(4), 4000):
            self.assertTrue(np.allclose([0.99, 0.5, 0.01], success.mean(axis=0), atol=0.01), success.mean(axis=0))
            self.assertTrue(np.allclose([20.4, 45, 59.6], time_s.mean(axis=0), atol=0.5), time_s.mean(axis=0))

    def test_single_games_prove_no_order(self):
        cells = [cell(str(i), [a], [b]) for i, (a, b) in enumerate(((None, 17.0), (None, None), (11.0, 13.0), (20.0, None)))]
        self.assertEqual({bounds.OPEN}, {o.verdict for o in game_figures.orders(cells, draws=200)})

    def test_equal_conditions_have_no_order(self):
        by_success, _ = game_figures.orders([cell(str(i), [20.0 + i], [20.0 + i]) for i in range(4)], draws=200)
        self.assertTrue(math.isnan(by_success.tau))
        self.assertEqual(bounds.OPEN, by_success.verdict)
        json.dumps(by_success.row(), allow_nan=False)

    def test_of_eight_conditions_chance_reaches_the_bound_one_time_in_sixty(self):
        order = [0, 1, 2, 3, 7, 6, 5, 4]  # 6 of 28 pairs in reverse order: 0.571, just below; 5: 0.643
        self.assertLess(kendalltau(range(8), order).statistic, game_figures.LEAST_TAU)
        above = kendalltau(range(8), [0, 1, 2, 3, 7, 6, 4, 5], method="exact")
        self.assertGreater(above.statistic, game_figures.LEAST_TAU)
        self.assertAlmostEqual(1 / 60, above.pvalue / 2, delta=0.002)


if __name__ == "__main__":
    unittest.main()
