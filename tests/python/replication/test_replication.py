"""Published experiments: files are read or refused with line and reason, verdicts follow from the numbers, and no trial receives a published result."""
import contextlib
import csv
import dataclasses
import io
import json
import math
import pathlib
import re
import sys
import tempfile
import unittest

import numpy as np
from scipy.stats import t as student

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.paths import BIN
from tactus.refusal import Refusal
from tactus.replication import experiment_file, main, measures, participants, verdict
from tactus.study import study_file

GOOD = """<replication name="s" version="1" participants="3" seed="2">
  <paper authors="Doe, Roe" year="1999" doi="10.1000/182">Doe and Roe 1999, A paper, Journal 1:2</paper>
  <trial paradigm="two_events" answer="together"><setting name="first" value="touch" source="design: a choice"/></trial>
  <condition id="tap" varies="soa_ms" levels="-200 -100 0 100 200"/>
  <condition id="plain"><setting name="soa_ms" value="0" source="design: a choice"/></condition>
  <procedure kind="constant" repetitions="4"/>
  <measure id="pss" kind="fit" of="tap" function="synchrony_window" value="pss"/>
  <measure id="together" kind="mean" of="plain" outcome="together"/>
  <expect quantity="simultaneity" measure="pss" unit="ms" value="10" within="20%" source="Doe and Roe 1999, abstract" evidence="read"/>
  <expect quantity="share together" measure="together" low="0.5" source="Doe and Roe 1999, abstract" evidence="unverified"/>
</replication>
"""


def read(text):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "s.xml")
        path.write_text(text, encoding="utf-8")
        return experiment_file.read(path)


def called(words):
    """(exit status, stdout, stderr) of the command."""
    out, error = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2))
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        status = main.main([*map(str, words)])
    for stream in (out, error):
        stream.flush()
    return status, out.buffer.getvalue().decode(), error.buffer.getvalue().decode()


def expectation(**changes):
    return dataclasses.replace(read(GOOD).expectations[0], **changes)


class Files(unittest.TestCase):
    def refused(self, old, new, *words):
        self.assertIn(old, GOOD)
        with self.assertRaises(Refusal) as caught:
            read(GOOD.replace(old, new, 1))
        self.assertRegex(str(caught.exception), r"s\.xml:\d+: ")
        self.assertNotIn("\n", str(caught.exception))
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_a_file_is_read_completely(self):
        e = read(GOOD)
        self.assertEqual(("s", "Doe, Roe", 1999, "10.1000/182", "two_events", "together", 3, 2), (e.name, e.authors, e.year, e.doi, e.paradigm, e.answer, e.participants, e.seed))
        self.assertEqual(((-200.0, -100.0, 0.0, 100.0, 200.0), (0.0,)), tuple(c.levels for c in e.conditions))
        self.assertEqual({"first": "touch", "soa_ms": "0"}, e.condition("plain").settings)
        self.assertEqual((8.0, 12.0), (e.expectations[0].low, e.expectations[0].high))
        self.assertEqual((0.5, None), (e.expectations[1].low, e.expectations[1].high))

    def test_an_expectation_without_a_source_is_refused(self):
        self.refused(' source="Doe and Roe 1999, abstract" evidence="read"', ' evidence="read"', "source")
        self.refused('source="Doe and Roe 1999, abstract" evidence="read"', 'source="" evidence="read"', "source")

    def test_an_expectation_without_its_evidence_is_refused(self):
        self.refused(' evidence="read"', "", "evidence")
        self.refused(' evidence="read"', ' evidence="guessed"', "guessed")

    def test_an_expectation_without_a_tolerance_is_refused(self):
        self.refused(' within="20%"', "", "within=")
        self.refused('within="20%"', 'within="0"', "positive")
        self.refused('value="10" within="20%"', 'value="10" within="20%" low="3"', "value= with within=")
        self.refused('low="0.5"', "", "low= or high=")
        self.refused('low="0.5"', 'low="0.5" high="0.4"', "below")

    def test_settings_without_a_source_are_refused(self):
        self.refused(' source="design: a choice"', "", "source")

    def test_measures_of_other_things_are_refused(self):
        self.refused('of="tap"', 'of="tip"', "tip")
        self.refused('measure="pss"', 'measure="pse"', "pse")
        self.refused('value="pss"/>', 'value="pse"/>', "pse")
        self.refused('function="synchrony_window"', 'function="window"', "window")
        self.refused('id="together" kind="mean"', 'id="pss" kind="mean"', "twice")
        self.refused('kind="mean" of="plain" outcome="together"', 'kind="mean" of="plain"', "outcome")
        self.refused('kind="mean" of="plain" outcome="together"', 'kind="ratio" of="pss"', "2")

    def test_impossible_conditions_and_procedures_are_refused(self):
        self.refused(' levels="-200 -100 0 100 200"', "", "belong together")
        self.refused('levels="-200 -100', 'levels="-100 -100', "once")
        self.refused('id="plain"', 'id="tap"', "twice")
        self.refused('repetitions="4"', "", "repetitions")
        self.refused('kind="constant" repetitions="4"', 'kind="constant" repetitions="4" rule="weighted"', "rule")
        self.refused('<setting name="first"', '<setting name="soa_ms" value="0" source="design: a choice"/><setting name="first"', "also set")

    def test_a_study_and_an_experiment_are_distinguished(self):
        self.refused(GOOD, '<study name="x"/>', "study file")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "s.xml")
            path.write_text(GOOD, encoding="utf-8")
            with self.assertRaisesRegex(Refusal, "tactus study replicate"):
                study_file.read(path)


class Verdicts(unittest.TestCase):
    VALUES = [8.0, 9.0, 10.0, 11.0, 14.0]  # mean 10.4, standard deviation 2.302

    def test_mean_interval_and_range_are_those_of_the_participants(self):
        v = verdict.of_values(expectation(), self.VALUES)
        half = student.ppf(0.975, 4) * np.std(self.VALUES, ddof=1) / math.sqrt(5)
        self.assertAlmostEqual(10.4, v.mean)
        self.assertAlmostEqual(10.4 - half, v.low)
        self.assertAlmostEqual(10.4 + half, v.high)
        self.assertAlmostEqual(8.2, v.from5)
        self.assertAlmostEqual(13.4, v.to95)
        self.assertEqual((5, 5, verdict.AGREES), (v.count, v.total, v.verdict))

    def test_a_mean_outside_the_range_differs(self):
        self.assertEqual(verdict.DIFFERS, verdict.of_values(expectation(low=10.5, high=12), self.VALUES).verdict)
        self.assertEqual(verdict.DIFFERS, verdict.of_values(expectation(low=8, high=10.3), self.VALUES).verdict)

    def test_a_published_value_outside_all_participants_differs(self):
        v = verdict.of_values(expectation(value=10, low=8, high=12), [11.0, 11.1, 11.2])
        self.assertEqual(verdict.DIFFERS, v.verdict)
        self.assertIn("outside", v.why)

    def test_an_order_needs_95_percent_certainty(self):
        error = np.std(self.VALUES, ddof=1) / math.sqrt(5)
        bound = 10.4 - student.ppf(0.95, 4) * error
        order = lambda low: verdict.of_values(expectation(value=None, low=low, high=None), self.VALUES)
        self.assertEqual(verdict.AGREES, order(bound - 0.01).verdict)
        self.assertEqual(verdict.DIFFERS, order(bound + 0.01).verdict)
        self.assertIn("not certain", order(bound + 0.01).why)
        self.assertEqual("", order(11).why)
        below = verdict.of_values(expectation(value=None, low=None, high=20.8 - bound + 0.01), self.VALUES)
        self.assertEqual(verdict.AGREES, below.verdict)
        self.assertEqual(verdict.DIFFERS, verdict.of_values(expectation(value=None, low=None, high=20.8 - bound - 0.01), self.VALUES).verdict)

    def test_one_participant_is_no_order(self):
        self.assertEqual(verdict.DIFFERS, verdict.of_values(expectation(value=None, low=0, high=None), [5.0]).verdict)

    def test_too_few_values_are_not_reproducible(self):
        self.assertEqual(verdict.NOT_REPRODUCIBLE, verdict.of_values(expectation(), [10.0, math.nan, math.nan]).verdict)
        self.assertEqual(verdict.AGREES, verdict.of_values(expectation(), [9.0, 11.0, math.nan]).verdict)
        self.assertEqual(verdict.NOT_REPRODUCIBLE, verdict.of_values(expectation(), []).verdict)
        self.assertEqual(verdict.NOT_REPRODUCIBLE, verdict.of_expectation(expectation(lacks="no such sense"), {}).verdict)

    def test_a_level_of_all_together_is_compared_with_the_range_only(self):
        e = expectation(value=10, low=8, high=12)
        self.assertEqual(verdict.AGREES, verdict.of_values(e, [12.0, 12.0], 12.0).verdict)
        self.assertEqual(verdict.DIFFERS, verdict.of_values(e, [12.0, 20.0], 20.0).verdict)
        self.assertEqual(verdict.NOT_REPRODUCIBLE, verdict.of_values(e, [12.0], math.nan).verdict)
        uncertain = verdict.of_values(e, [12.0, 4.0, 50.0, 11.0, 50.0], 12.0)
        self.assertEqual(verdict.DIFFERS, uncertain.verdict)
        self.assertIn("resamples", uncertain.why)

    def test_a_property_from_the_same_paper_is_no_replication(self):
        e = read(GOOD)
        self.assertIn("noise", verdict.calibration(e, e.expectations[0], {"noise": "Doe and Roe 1999, Journal 1:2"}))
        self.assertEqual("", verdict.calibration(e, e.expectations[0], {"noise": "Doe and Roe 1998"}))
        self.assertEqual("fitted by hand", verdict.calibration(e, expectation(calibrated="fitted by hand"), {}))


class Tables(unittest.TestCase):
    def test_texts_of_a_file_are_no_formulas_and_no_cells_of_their_own(self):
        row = main.Row(read(GOOD), expectation(quantity="=HYPERLINK(1) | x"), verdict.of_values(expectation(), [9.0, 11.0]), "")
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            main.write_table(folder, [row])
            with open(folder / "replications.csv", encoding="utf-8", newline="") as file:
                self.assertEqual("'=HYPERLINK(1) | x", next(csv.DictReader(file))["quantity"])
            lines = (folder / "replications.md").read_text(encoding="utf-8").splitlines()
            self.assertIn("=HYPERLINK(1) \\| x", lines[2])
            self.assertEqual(1, len({len(re.split(r"(?<!\\)\|", line)) for line in lines}))

    def test_a_program_that_fails_is_named(self):
        with self.assertRaisesRegex(Refusal, "ended with status 1"):
            participants.sources("/bin/false")


class Measures(unittest.TestCase):
    def test_slopes_changes_and_means_are_those_of_exact_answers(self):
        m = lambda kind, of, **more: experiment_file.Measure("m", kind, of, "t", **more)
        of = {"a": [(x, {"t": 2 + 3 * x}) for x in (0.0, 1.0, 4.0)], "b": [(x, {"t": 1 + 5 * x}) for x in (0.0, 1.0, 4.0)]}
        one = lambda measure, known={}: measures.measured(measure, of, "", known)
        self.assertAlmostEqual(3, one(m("slope", ("a",))))
        self.assertAlmostEqual(0.2, one(m("slope_growth", ("a", "b"), against=(10, 20))))
        self.assertAlmostEqual(7, one(m("mean", ("a",))))
        self.assertAlmostEqual(5, one(m("mean", ("a",), level=1.0)))
        self.assertAlmostEqual(100 * (6 / 5 - 1), one(m("change_percent", ("a", "b"), level=1.0)))
        self.assertAlmostEqual(9.5, one(m("mean_at", ("a",), at="k"), {"k": 2.5}))
        self.assertTrue(math.isnan(one(m("mean_at", ("a",), at="k"), {"k": 5.0})))
        known = {"x": 0.6, "y": 1.0, "z": 0.75}
        self.assertAlmostEqual(1, measures.measured(m("optimal_ratio", ("x", "y", "z")), of, "", known))
        self.assertAlmostEqual(-0.4, measures.measured(m("difference", ("x", "y")), of, "", known))
        self.assertAlmostEqual(0.6, measures.measured(m("ratio", ("x", "y")), of, "", known))

    def test_the_first_worse_level_is_the_first_significant_one(self):
        dice = np.random.default_rng(3)
        table = dice.normal(0, 1, (12, 1)) + np.array([0.0, 0.0, 2.0, 4.0]) + dice.normal(0, 0.2, (12, 4))
        self.assertEqual(2, measures.first_worse(table))
        self.assertIsNone(measures.first_worse(np.zeros((5, 3))))
        self.assertEqual(1, measures.first_worse(np.array([[0.0, 1.0, 0.0]] * 5)))

    def test_a_level_that_harms_nothing_is_named_in_five_of_a_hundred_experiments(self):
        dice = np.random.default_rng(6)
        named = sum(measures.first_worse(dice.normal(0, 1, (12, 7))) is not None for _ in range(2000))
        self.assertLessEqual(named, 100 + 3 * 10)  # 5 % and three standard errors; without the correction about 340

    def test_a_threshold_that_the_levels_do_not_reach_has_no_value(self):
        never = [(x, {"right": i % 2}) for x in (1.0, 2.0, 4.0) for i in range(40)]
        self.assertTrue(math.isnan(measures.fitted(never, "right", "weibull", "threshold75")))
        step = [(x, {"right": 1.0 if x > 3 else i % 2}) for x in (1.0, 2.0, 4.0, 8.0) for i in range(40)]
        self.assertTrue(2 <= measures.fitted(step, "right", "weibull", "threshold75") <= 4)


class Shipped(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.experiments = [experiment_file.read(path) for path in experiment_file.shipped()]
        cls.sources = participants.sources(BIN / participants.PROGRAM)

    def test_the_experiments_of_the_field_are_there_with_sources(self):
        names = {e.name for e in self.experiments}
        self.assertGreaterEqual(len(names), 14)
        for name in ("jay_hubbold_2005", "jay_glencross_hubbold_2007", "mackenzie_ware_1993", "rank_2010", "knoerlein_2009", "kaaresoja_2014", "vogels_2004",
                     "di_luca_mahnan_2019", "adelstein_2003", "ernst_banks_2002", "chaudhari_2011", "hinterseer_2008", "de_pra_2020", "ho_jones_2006"):
            self.assertIn(name, names)
        for e in self.experiments:
            self.assertEqual(e.name, e.path.stem)
            for x in e.expectations:
                self.assertRegex(x.source, r"\b(19|20)\d\d\b", f"{e.name}: {x.quantity}")

    def test_the_order_of_the_senses_is_opposite_in_one_and_in_two_people(self):
        by = {e.name: e for e in self.experiments}
        one = next(m for m in by["jay_hubbold_2005"].measures if m.id == "order")
        two = next(m for m in by["jay_glencross_hubbold_2007"].measures if m.id == "order")
        self.assertEqual(("visual_slope", "haptic_slope"), one.of)
        self.assertEqual(("haptic_slope", "visual_slope"), two.of)

    def test_results_from_which_the_player_was_set_are_marked(self):
        marked = {e.name for e in self.experiments for x in e.expectations if verdict.calibration(e, x, self.sources[e.paradigm])}
        self.assertEqual({"bergmann_tiest_kappers_2009", "ernst_banks_2002", "mackenzie_ware_1993"}, marked)

    def run_quick(self, folder, *files):
        status, text, error = called([*files, "--participants", 2, "--repetitions", 1, "--out", folder, "--json", folder / "r.json"])
        self.assertEqual((0, ""), (status, error))
        return text, json.loads((folder / "r.json").read_text(encoding="utf-8"))["replications"]

    def test_a_quick_run_of_all_prints_every_result_of_every_experiment(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            text, rows = self.run_quick(folder)
            for e in self.experiments:
                lines = [line for line in text.splitlines() if line.startswith(e.name + " ")]
                self.assertEqual(len(e.expectations), len(lines), e.name)
                with open(folder / "answers" / f"{e.name}.csv", encoding="utf-8") as file:
                    self.assertEqual({"simulated"}, {row["observer"] for row in csv.DictReader(file)})
            with open(folder / "replications.csv", encoding="utf-8") as file:
                self.assertEqual([r["quantity"] for r in rows], [row["quantity"] for row in csv.DictReader(file)])
            self.assertEqual(len(rows) + 2, len((folder / "replications.md").read_text(encoding="utf-8").splitlines()))
            self.assertLessEqual({r["verdict"] for r in rows}, {verdict.AGREES, verdict.DIFFERS, verdict.NOT_REPRODUCIBLE})

    def test_no_trial_depends_on_a_published_result(self):
        for name in ("vogels_2004", "knoerlein_2009"):
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                text = (experiment_file.SHIPPED / f"{name}.xml").read_text(encoding="utf-8")
                changed = re.sub(r' (value|low|high)="(-?[\d.]+)"(?=[^<]*evidence=)', lambda m: f' {m[1]}="{float(m[2]) + 977}"', text)
                self.assertNotEqual(text, changed)
                results = []
                for place, content in (("a", text), ("b", changed)):
                    path = folder / place / f"{name}.xml"
                    path.parent.mkdir()
                    path.write_text(content, encoding="utf-8")
                    _, rows = self.run_quick(folder / place, path)
                    results.append(([r["ours"] for r in rows], (folder / place / "answers" / f"{name}.csv").read_text(encoding="utf-8"), [r["verdict"] for r in rows]))
                self.assertEqual(results[0][:2], results[1][:2])

    def test_a_file_that_does_not_fit_its_paradigm_is_refused_with_one_sentence(self):
        for old, new, word in (('<setting name="first"', '<setting name="colour" value="red" source="design: a choice"/><setting name="first"', "colour"),
                               ('paradigm="two_events"', 'paradigm="flying"', "flying"), ('answer="together"', 'answer="apart"', "apart"),
                               ('outcome="together"', 'outcome="apart"', "apart"), ('levels="-200', 'levels="-99999', "soa_ms")):
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder, "s.xml")
                path.write_text(GOOD.replace(old, new, 1), encoding="utf-8")
                status, _, error = called([path, "--participants", 2])
                self.assertEqual((1, 1), (status, error.count("\n")), error)
                self.assertIn(word, error)

    def test_wrong_options_are_refused_with_one_sentence(self):
        for words in (["--participants", "0"], ["--seed", "-1"], ["--repetitions", "0"], ["no_such"], ["vogels_2004", "vogels_2004"], ["--colour"]):
            status, _, error = called(words)
            self.assertEqual((1, 1), (status, error.count("\n")), error)


if __name__ == "__main__":
    unittest.main()
