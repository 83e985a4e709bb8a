"""Trials that the apparatus did not miss, but that no fit uses: without an answer, or without the measured level that other trials of their kind have."""
import numpy as np

from tactus.analysis import answers, operators

# Columns of the answer by the task of a trial; one of them is enough.
ANSWER = {"sj": ("response",), "toj": ("response",), "2ifc": ("correct", "stiffness_first_n_m"), "matching": ("answer_value",), "rating": ("response", "answer_value"),
          "game": ("success",)}
MEASURED = {"loss": "loss_achieved", "delay": "soa_achieved_ms"}  # by the kind of the operator


def unanswered(trials):
    """Mask of the trials without an answer."""
    kinds, mask = np.array(tasks(trials), dtype=object), np.zeros(len(trials), dtype=bool)
    for task, columns in ANSWER.items():
        mine = kinds == task
        mask[mine] = np.all([is_empty(trials[name][mine]) for name in columns], axis=0)
    return mask


def unmeasured(trials):
    """Mask of the answered trials without a measured level: of an asynchrony, or where another trial of the same task, sense and operator has one."""
    mask = np.zeros(len(trials), dtype=bool)
    kinds = np.array(tasks(trials), dtype=object)
    judged = np.isin(kinds, ("sj", "toj"))
    mask[judged] = np.isnan(trials["soa_achieved_ms"][judged])
    found = {}
    for i in np.flatnonzero(kinds == "2ifc"):
        if column := MEASURED.get(operators.kind(trials["operator"][i])):
            found.setdefault((trials["modality_degraded"][i], trials["operator"][i], column), []).append(i)
    for (_, _, column), rows in found.items():
        empty = np.isnan(trials[column][rows])
        mask[np.array(rows)[empty]] = not empty.all()
    return mask & ~unanswered(trials)


def words(trials):
    """Clauses about them for a summary, in order; none: all trials are used."""
    counts = (int(unanswered(trials).sum()), "have no answer"), (int(unmeasured(trials).sum()), "have no measured level")
    return [f"{n} are not used because they {why}" for n, why in counts if n]


def tasks(trials):
    return [answers.OTHER_NAMES.get(task, task) for task in trials["task"]]


def is_empty(values):
    return np.char.strip(values.astype(str)) == "" if values.dtype == object else np.isnan(values)
