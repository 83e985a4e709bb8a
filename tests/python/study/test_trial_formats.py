"""Exports of a journal agree with the journal in each format."""
import csv
import json
import math
import pathlib
import random
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCRIPTS = ROOT / "scripts"
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.refusal import Refusal
from tactus import tables
from tactus.study import bids, formats, journal, trial_table

LEVELS = (-100.0, 0.0, 62.5)


class Formats(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name) / "P01"
        dice = random.Random(2)
        with journal.Journal(cls.folder) as j:
            j.begin(study="of two", study_sha256="0" * 64, participant="P01", seed=1, observer="simulated")
            presented = 0
            for number in range(1, 61):
                level, yes = dice.choice(LEVELS), dice.random() < 0.5
                for missed in (["late"] if number % 7 == 0 else []) + [""]:
                    presented += 1
                    row = {"participant_id": "P01", "session": 1, "block": 1, "trial": presented, "task": "sj", "pair": "audio,visual", "soa_nominal_ms": level,
                           "soa_achieved_ms": level + 1 / 3, "observer": "simulated", "study": "of two", "condition": "audio-visual", "missed": int(bool(missed)),
                           "missed_reason": missed, "response": "" if missed else "yes" if yes else "no", "question": 'Together,\tor "apart"?', **({} if missed else {"response_time": 0.8})}
                    j.append({"kind": "trial", "trial": number, "attempt": 1, "block": 1, "condition": "audio-visual", "question": "synchrony", "level": level,
                              "response": row["response"], "yes": None if missed else yes, "missed": missed, "row": row})
            j.append({"kind": "questionnaire", "item": "age", "answer": 5.5})
        formats.export(cls.folder)
        cls.entries = journal.read(cls.folder)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def table(self, path, **how):
        with open(self.folder / path, encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file, **how))

    def test_the_long_table_has_a_row_for_each_trial_and_every_column(self):
        rows = self.table("trials.csv")
        trials = [e for e in self.entries if e["kind"] == "trial"]
        self.assertEqual(len(rows), len(trials))
        self.assertEqual(list(rows[0]), list(trial_table.COLUMNS))
        for row, entry in zip(rows, trials):
            self.assertEqual(float(row["soa_achieved_ms"]), entry["row"]["soa_achieved_ms"])
            self.assertEqual((row["observer"], row["question"]), ("simulated", entry["row"]["question"]))

    def test_a_missed_trial_names_the_one_that_repeated_it(self):
        rows = {int(r["trial"]): r for r in self.table("trials.csv")}
        missed = [r for r in rows.values() if r["missed"] == "1"]
        self.assertEqual(len(missed), 8)
        for row in missed:
            again = rows[int(row["repeated_as"])]
            self.assertEqual((again["missed"], int(again["trial"])), ("0", int(row["trial"]) + 1))

    def test_psignifit_counts_answers_at_the_measured_asynchrony_without_missed_trials(self):
        rising, falling = self.table("psignifit/audio-visual-rising.csv"), self.table("psignifit/audio-visual-falling.csv")
        answered = [e for e in self.entries if e["kind"] == "trial" and not e["missed"]]
        self.assertEqual(len(rising) + len(falling), len(LEVELS) + 1)  # both flanks have the level of the peak
        self.assertEqual(rising[-1]["level"], falling[0]["level"])
        found = {row["level"]: (int(row["yes"]), int(row["total"])) for row in rising}
        apart = {row["level"]: (int(row["total"]) - int(row["yes"]), int(row["total"])) for row in falling}
        self.assertEqual(found[rising[-1]["level"]], apart[rising[-1]["level"]])
        counts = {**found, **apart}
        self.assertEqual(sum(total for _, total in counts.values()), len(answered))
        for (level, (yes, _)), requested in zip(sorted(counts.items(), key=lambda item: float(item[0])), LEVELS):
            self.assertAlmostEqual(float(level), requested + 1 / 3)
            self.assertEqual(yes, sum(e["yes"] for e in answered if e["level"] == requested))

    def test_the_peak_between_the_flanks_is_the_most_likely(self):
        dice = random.Random(1)
        for _ in range(50):
            pss, sd = dice.uniform(-60, 60), dice.uniform(40, 90)
            lines = [(x, sum(dice.random() < 0.95 * math.exp(-((x - pss) ** 2) / (2 * sd * sd)) for _ in range(60)), 60) for x in range(-240, 241, 40)]
            self.assertLess(abs(lines[formats.peak(lines)][0] - pss), 60)
        self.assertEqual(formats.peak([(0, 1, 10), (10, 5, 10), (20, 9, 10)]), 2)
        self.assertEqual(formats.peak([(0, 9, 10), (10, 5, 10), (20, 1, 10)]), 0)
        self.assertEqual(formats.peak([(0, 3, 10)]), 0)

    def test_bids_has_a_sidecar_that_describes_every_column(self):
        where = self.folder / "bids" / "sub-P01" / "ses-1" / "beh"
        for table in [*where.glob("*.tsv"), *self.folder.glob("bids/*.tsv"), *self.folder.glob("bids/phenotype/*.tsv")]:
            rows = self.table(table.relative_to(self.folder), delimiter="\t", quoting=csv.QUOTE_NONE)
            sidecar = json.loads(table.with_suffix(".json").read_text(encoding="utf-8"))
            for name in set(rows[0]) - {"participant_id"}:
                self.assertTrue(sidecar[name]["Description"], f"{table.name} {name}")
            self.assertEqual({row["observer"] for row in rows}, {"simulated"})
        rows = self.table("bids/sub-P01/ses-1/beh/sub-P01_ses-1_task-oftwo_beh.tsv", delimiter="\t", quoting=csv.QUOTE_NONE)
        self.assertEqual(len(rows), len(self.table("trials.csv")))
        self.assertEqual({r["completion_time_s"] for r in rows}, {"n/a"})
        self.assertIn("observer=simulated", (self.folder / "bids" / "README").read_text(encoding="utf-8"))
        self.assertIn("observer=simulated", json.loads((self.folder / "bids" / "dataset_description.json").read_text(encoding="utf-8"))["Name"])

    def test_bids_events_begin_at_the_question(self):
        rows = self.table("bids/sub-P01/ses-1/beh/sub-P01_ses-1_task-oftwo_events.tsv", delimiter="\t", quoting=csv.QUOTE_NONE)
        self.assertEqual(list(rows[0])[:2], ["onset", "duration"])
        answered = [e for e in self.entries if e["kind"] == "trial" and not e["missed"]]
        self.assertEqual([int(r["trial"]) for r in rows], [e["row"]["trial"] for e in answered])
        for row, entry in zip(rows, answered):
            self.assertAlmostEqual(float(row["onset"]) + float(row["duration"]), bids.seconds_between(self.entries[0]["time_utc"], entry["time_utc"]), places=3)

    def test_psychopy_has_a_row_for_each_answer(self):
        rows = self.table("psychopy.csv")
        self.assertEqual([int(r["trials.thisN"]) for r in rows], list(range(60)))
        self.assertEqual({r["observer"] for r in rows}, {"simulated"})

    def test_psychopy_counts_repetitions_of_each_stimulus(self):
        seen = {}
        for row in self.table("psychopy.csv"):
            self.assertEqual(int(row["trials.thisRepN"]), seen.get(row["soa_nominal_ms"], 0))
            seen[row["soa_nominal_ms"]] = seen.get(row["soa_nominal_ms"], 0) + 1
            self.assertEqual((row["participant"], row["expName"], row["key_resp.rt"]), ("P01", "of two", "0.8"))
        self.assertEqual(sum(seen.values()), 60)

    def test_the_page_describes_the_same_columns_as_the_sidecars(self):
        page = (ROOT / "docs" / "study_formats.md").read_text(encoding="utf-8")
        described = re.findall(r"^\| `(\w+)` \| ([^|]*) \| ([^|]*) \|$", page, re.M)
        meaning = lambda column: column.description + (f" ({', '.join(column.levels)})" if column.levels else "")
        self.assertEqual([(name, unit.strip(), text.strip()) for name, unit, text in described],
                         [(name, column.unit, meaning(column)) for name, column in trial_table.COLUMNS.items()])


def a_value(dice, column):
    """A random valid value of this column."""
    if column.kind == "flag":
        return dice.randrange(2)
    if column.kind == "whole":
        return dice.randrange(10**6)
    if column.kind == "number":
        low, high = (max(column.within[0], -1e6), min(column.within[1], 1e6))
        return dice.choice([low, high, dice.uniform(low, high), dice.uniform(low, high) * 1e-12 if low <= 0 else high])
    if column.levels:
        return dice.choice(column.levels)
    return "".join(dice.choice("ab ,;\"'\n\r\täß\u2028\U0001f600|\\#=") for _ in range(dice.randrange(1, 12)))


def a_row(dice):
    row = {name: a_value(dice, column) for name, column in trial_table.COLUMNS.items() if dice.random() < 0.6}
    return {**row, "participant_id": "P01", "task": "sj", "observer": "simulated"}


class Tables(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.path = pathlib.Path(kept.name) / "trials.csv"

    def test_a_written_table_is_read_back(self):
        for seed in range(40):
            dice = random.Random(seed)
            rows = [a_row(dice) for _ in range(dice.randrange(12))]
            trial_table.write(self.path, rows)
            read = [{k: v for k, v in row.items() if v not in (None, "")} for row in trial_table.read(self.path)]
            self.assertEqual(read, rows)

    def test_an_invalid_row_is_not_written_and_the_table_stays(self):
        trial_table.write(self.path, [a_row(random.Random(1))])
        before = self.path.read_bytes()
        good = {"participant_id": "P01", "task": "sj", "observer": "human"}
        for wrong in ({"colour": "red"}, {"level": float("nan")}, {"trial": 1.5}, {"missed": 2}, {"task": "guess"}, {"soa_uncertainty_ms": -1}, {"level": "much"}, {"response": 3},
                      {"participant_id": ""}, {"question": "a\0b"}):
            with self.assertRaisesRegex(ValueError, f"row 2: .*{next(iter(wrong))}"):
                trial_table.write(self.path, [good, {**good, **wrong}])
            self.assertEqual(self.path.read_bytes(), before)
        self.assertEqual(list(self.path.parent.iterdir()), [self.path], "nothing is left beside it")

    def test_a_hostile_table_is_refused_with_its_line_and_reason(self):
        header, good = "participant_id,task,observer,level,missed", "P01,sj,human,1.5,0"
        for text, line, reason in (
                ("", 1, "no column participant_id"), (header.replace("level", "colour"), 1, "the column 'colour' is not a column"), (header + ",level", 1, "'level' occurs twice"),
                (f"{header}\n{good}\n{good},7", 3, "6 fields, but the header has 5"), (f"{header}\n{good}\n\n{good},7", 4, "6 fields"), (f"{header}\nP01,sj,human,much,0", 2, "level is 'much'"),
                (f"{header}\n{good}\nP01,sj,human,nan,0", 3, "level is 'nan'"), (f"{header}\nP01,sj,human,1,0.5", 2, "missed is 0.5"), (f"{header}\nP01,sj,robot,1,0", 2, "observer is 'robot'"),
                (f"{header}\n,sj,human,1,0", 2, "participant_id is empty"), (f'{header}\n"P01,sj', 2, "unexpected end"), (f"{header}\nP01,sj,human,1e999,0", 2, "level is 'inf'")):
            self.path.write_text(text, encoding="utf-8")
            with self.assertRaises(Refusal) as caught:
                trial_table.read(self.path)
            self.assertIn(f"{self.path}:{line}: ", str(caught.exception))
            self.assertIn(reason, str(caught.exception))
            self.assertNotIn("\n", str(caught.exception))
        self.path.write_bytes(f"{header}\n{good}\n".encode() + b"P\xff,sj,human,1,0\n")
        with self.assertRaisesRegex(Refusal, ":3: is not UTF-8"):
            trial_table.read(self.path)
        with self.assertRaisesRegex(Refusal, "cannot be read"):
            trial_table.read(self.path.parent / "none.csv")


def random_journal(folder, dice):
    """A journal of several conditions with yes/no answers, numbers, pairs of levels and repeatedly missed trials."""
    names = ["haptic delay", "haptic-delay", "Haptic delay", "audio x visual", "ü"]
    with journal.Journal(folder) as j:
        j.begin(study="s", study_sha256="0" * 64, participant="P_7", seed=1, observer=dice.choice(["human", "simulated"]))
        presented = 0
        for number in range(1, dice.randrange(2, 60)):
            condition = dice.choice(names)
            pair, judged = condition == "audio x visual", condition != "ü"
            level = [float(dice.randrange(4)), float(dice.randrange(4))] if pair else float(dice.randrange(-2, 3))
            for attempt in range(1, dice.choice([1, 1, 1, 2, 3]) + 1):
                missed = "late" if attempt > 1 or dice.random() < 0.2 else ""
                presented += 1
                row = {**a_row(dice), "participant_id": "P_7", "session": 2, "trial": presented, "observer": j.entries[0]["observer"], "missed": int(bool(missed)),
                       "condition": condition, "repeated_as": None, "soa_achieved_ms": dice.choice([None, dice.uniform(-3, 3)])}
                j.append({"kind": "trial", "trial": number, "attempt": attempt, "block": 1, "condition": condition, "question": "q", "level": level, "response": "r",
                          "yes": dice.random() < 0.5 if judged and not missed else None, "missed": missed, "row": row})
                if not missed:
                    break
    return journal.read(folder)


class RandomJournals(unittest.TestCase):
    def test_every_format_agrees_with_the_journal(self):
        for seed in range(25):
            with tempfile.TemporaryDirectory() as scratch:
                folder = pathlib.Path(scratch)
                entries = random_journal(folder, random.Random(seed))
                trials = [e for e in entries if e["kind"] == "trial"]
                counted = [e for e in trials if not e["missed"]]
                formats.export(folder)
                rows = trial_table.read(folder / "trials.csv")
                filled = lambda row: {k: v for k, v in row.items() if v not in (None, "") and k != "repeated_as"}
                self.assertEqual([filled(r) for r in rows], [filled(e["row"]) for e in trials])
                for row, entry in zip(rows, trials):
                    again = next((e["row"]["trial"] for e in trials if e["trial"] == entry["trial"] and e["n"] > entry["n"]), None) if entry["missed"] else None
                    self.assertEqual(row["repeated_as"], again)
                self.psignifit(folder, [e for e in counted if e["yes"] is not None and not isinstance(e["level"], list)])
                with open(next(folder.glob("bids/sub-P7/ses-2/beh/sub-P7_ses-2_task-s_beh.tsv")), encoding="utf-8", newline="\n") as file:
                    lines = file.read().split("\n")[:-1]
                self.assertEqual(lines[0].split("\t"), list(trial_table.COLUMNS))
                for line, row in zip(lines[1:], rows, strict=True):
                    fields = dict(zip(trial_table.COLUMNS, line.split("\t"), strict=True))
                    for name, value in row.items():
                        expected = "n/a" if value in (None, "") else tables.escaped(re.sub(r"[\t\r\n]", " ", value)) if isinstance(value, str) else repr(value)
                        self.assertEqual(fields[name], expected)
                with open(folder / "psychopy.csv", encoding="utf-8", newline="") as file:
                    wide = list(csv.DictReader(file))
                self.assertEqual([r["condition"] for r in wide], [tables.escaped(e["condition"]) for e in counted])

    def psignifit(self, folder, answered):
        """Each condition has its own file, even with similar names, and no answer is lost."""
        files = list(folder.glob("psignifit/*.csv"))
        windows = {e["condition"] for e in answered if e["row"].get("task") == "sj"}
        self.assertEqual(len({f.name.lower() for f in files}), len({e["condition"] for e in answered}) + len(windows))
        total = 0
        for file in files:
            with open(file, encoding="utf-8", newline="") as opened:
                lines = list(csv.DictReader(opened))
            total += sum(int(line["total"]) for line in lines)
            self.assertEqual([float(line["level"]) for line in lines], sorted(float(line["level"]) for line in lines))
        # The level of the peak is in both flanks of a window.
        self.assertGreaterEqual(total, len(answered))
        self.assertLess(total, 2 * len(answered) + 1)
        if not windows:
            self.assertEqual(total, len(answered))

    def test_an_invalid_row_is_refused_with_the_line_of_the_journal(self):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            with journal.Journal(folder) as j:
                j.begin(study="s", study_sha256="0" * 64, participant="P01", seed=1, observer="human")
                j.append({"kind": "trial", "trial": 1, "attempt": 1, "block": 1, "condition": "c", "question": "q", "level": 1.0, "response": "r", "yes": True, "missed": "",
                          "row": {"participant_id": "P01", "task": "sj", "observer": "human", "colour": "red"}})
            with self.assertRaisesRegex(Refusal, ":2: there is no column colour"):
                formats.export(folder)


if __name__ == "__main__":
    unittest.main()
