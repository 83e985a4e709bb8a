"""Exports the journal to standard file formats, which docs/study_formats.md describes.

  trials.csv                             long format, a row a trial (trial_table.py)
  psignifit/CONDITION.csv                level, yes, total: n x 3, for psignifit, Palamedes and quickpsy; of a judgement of synchrony each flank
  bids/                                  a data set of the Brain Imaging Data Structure (bids.py)
  psychopy.csv                           wide format of PsychoPy's ExperimentHandler
  questionnaire.csv                      item, answer
"""
import collections
import csv
import io
import math
import pathlib
import re

from tactus.refusal import Refusal
from tactus.study import bids, bids_labels, journal, trial_table
from tactus.study.trial_table import COLUMNS, replace, text_of
from tactus.tables import escaped

# Columns that psychopy.csv stores under PsychoPy's names.
RENAMED = ("participant_id", "session", "trial", "study", "response", "correct", "response_time", "observer", "repeated_as", "missed", "missed_reason")


def rows_of(entries, path=journal.NAME):
    """Rows of the trial table from entries of a journal. A missed trial names its repetition. Raises Refusal with the line of the journal."""
    trials = [e for e in entries if e["kind"] == "trial"]
    rows, later = [], {}
    for entry in reversed(trials):
        row = dict(entry["row"])
        asked = entry["trial"], entry["question"]
        if entry["missed"]:
            row["repeated_as"] = later.get(asked)
        later[asked] = row.get("trial")
        wrong = trial_table.wrong(row)
        if wrong:
            raise Refusal(f"{path}:{entry['n']}: {wrong}; export it with the version of Tactus that wrote it")
        rows.append(row)
    return rows[::-1]


def counted(entries):
    """{condition: {requested level: [entries]}} of yes/no answers, without missed trials."""
    found = collections.defaultdict(lambda: collections.defaultdict(list))
    for e in entries:
        if e["kind"] == "trial" and not e["missed"] and e["yes"] is not None and isinstance(e["level"], (int, float)):
            found[e["condition"]][e["level"]].append(e)
    return found


def achieved(level, entries):
    """Mean measured asynchrony of answers at one requested level; the requested level if one was not measured."""
    measured = [e["row"].get("soa_achieved_ms") for e in entries]
    return level if None in measured or "" in measured else sum(measured) / len(measured)


def file_names(texts):
    """{text: file name}; the names differ even without regard to case."""
    names, taken = {}, set()
    for text in texts:
        plain = name = re.sub(r"[^A-Za-z0-9]+", "-", text).strip("-") or "condition"
        number = 1
        while name.lower() in taken:
            number += 1
            name = f"{plain}-{number}"
        names[text] = name
        taken.add(name.lower())
    return names


def psignifit(folder, entries):
    """Writes level, yes and total of each condition. The answers to a judgement of synchrony rise and fall again, which no sigmoid does: its flanks are
    two files, each with a share that rises with the level."""
    tables = {}
    for condition, levels in counted(entries).items():
        lines = sorted((achieved(level, es), sum(bool(e["yes"]) for e in es), len(es)) for level, es in levels.items())
        if any(e["row"].get("task") == "sj" for es in levels.values() for e in es):
            top = peak(lines)
            tables[f"{condition} rising"] = lines[:top + 1]
            tables[f"{condition} falling"] = [(level, total - yes, total) for level, yes, total in lines[top:]]  # yes: apart
        else:
            tables[condition] = lines
    names = file_names(tables)
    for name, lines in tables.items():
        replace(folder / "psignifit" / f"{names[name]}.csv", "\n".join(["level,yes,total"] + [",".join(map(text_of, line)) for line in lines]) + "\n")


def peak(lines):
    """Index of the line (level, yes, total) up to which the share rises and from which it falls, by maximum likelihood (unimodal regression; Turner and Wollan
    1997, Computational Statistics & Data Analysis 25:305)."""
    def likelihood(part):
        blocks = []  # [yes, total] of pooled lines, whose shares do not fall
        for _, yes, total in part:
            blocks.append([yes, total])
            while len(blocks) > 1 and blocks[-2][0] * blocks[-1][1] > blocks[-1][0] * blocks[-2][1]:
                yes, total = blocks.pop()
                blocks[-1] = [blocks[-1][0] + yes, blocks[-1][1] + total]
        return sum(y * math.log(y / n) + (n - y) * math.log(1 - y / n) for y, n in blocks if 0 < y < n)

    # Of likelihoods that are equal but for rounding, the one with the largest share in the middle.
    share = [yes / total for _, yes, total in lines]
    return max(range(len(lines)), key=lambda i: (round(likelihood(lines[:i + 1]) + likelihood(lines[:i:-1]), 9), share[i], -abs(i - (len(lines) - 1) / 2)))


def table(columns, rows):
    file = io.StringIO()
    out = csv.writer(file)
    out.writerow(columns)
    out.writerows([escaped(v) if isinstance(v, str) else text_of(v) for v in row] for row in rows)
    return file.getvalue()


def psychopy(folder, session, entries):
    """Writes psychopy.csv with the column names of PsychoPy's ExperimentHandler and TrialHandler: thisRepN counts repetitions of a stimulus, thisTrialN
    trials within a repetition, thisIndex is the index of the stimulus."""
    answered = [e for e in entries if e["kind"] == "trial" and not e["missed"]]
    filled = [name for name in COLUMNS if name not in RENAMED and any(e["row"].get(name) not in (None, "") for e in answered)]
    stimuli = list(dict.fromkeys((e["condition"], str(e["level"])) for e in answered))
    repeated, within = collections.Counter(), collections.Counter()
    rows = []
    for n, e in enumerate(answered):
        stimulus = e["condition"], str(e["level"])
        repetition = repeated[stimulus]
        rows.append([repetition, within[repetition], n, stimuli.index(stimulus), *(e["row"].get(name) for name in filled), e["response"], e["row"].get("correct"),
                     e["row"].get("response_time"), session["participant"], e["row"].get("session", 1), session["time_utc"], session["study"], session["observer"]])
        repeated[stimulus] += 1
        within[repetition] += 1
    replace(folder / "psychopy.csv", table(["trials.thisRepN", "trials.thisTrialN", "trials.thisN", "trials.thisIndex", *filled, "key_resp.keys", "key_resp.corr",
                                            "key_resp.rt", "participant", "session", "date", "expName", "observer"], rows))


def questionnaire(folder, session, entries):
    rows = [(session["participant"], session["observer"], e["item"], e["answer"]) for e in entries if e["kind"] == "questionnaire"]
    if rows:
        replace(folder / "questionnaire.csv", table(("participant_id", "observer", "item", "answer"), rows))


def export(folder):
    """Writes all formats beside the journal. Raises Refusal, like the journal."""
    folder = pathlib.Path(folder)
    entries = journal.read(folder)
    if not entries:
        return
    session, rows = entries[0], rows_of(entries, folder / journal.NAME)
    trial_table.write(folder / "trials.csv", rows)
    psignifit(folder, entries)
    bids.write(folder / "bids", session, entries, rows, bids_labels.of_session(folder, session))
    psychopy(folder, session, entries)
    questionnaire(folder, session, entries)
