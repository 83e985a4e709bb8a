"""Interpretation of answers: yes or no at a level, for each kind of task."""
import re

import numpy as np

from tactus.refusal import Refusal

# Task of a trial: the psychometric function of tactus/psychophysics/functions.py that it follows.
FUNCTION = {"sj": "synchrony_window", "toj": "order", "2ifc": "weibull"}
TASK_NAMES = {"sj": "synchrony judgement", "toj": "temporal order judgement", "2ifc": "two intervals, which one was degraded"}
OTHER_NAMES = {"synchrony": "sj", "order": "toj", "two_interval": "2ifc", "2afc": "2ifc"}
GUESS_2IFC = 0.5
TOGETHER = {"yes", "1", "sync", "synchronous", "simultaneous", "together", "true"}
APART = {"no", "0", "async", "asynchronous", "apart", "not_synchronous", "not together", "false"}


def kind_of(task):
    """sj, toj, 2ifc, or None for a task without a psychometric function."""
    task = OTHER_NAMES.get(task, task)
    return task if task in FUNCTION else None


def pair_of(text):
    """(a, b) of the column pair; SOA(a, b) = t(b) - t(a)."""
    parts = [p for p in re.split(r"[,\-–: ]+", text) if p]
    if len(parts) != 2:
        raise Refusal(f"the pair '{text}' is not two senses; write it as audio,visual")
    return tuple(parts)


def is_yes(kind, row_response, row_correct, pair):
    """Whether one answer counts as yes: together (sj), a was first (toj), correct (2ifc). None: no answer."""
    if kind == "2ifc":
        return None if row_correct != row_correct else bool(row_correct)
    word = row_response.strip().lower()
    if not word:
        return None
    if kind == "sj":
        if word in TOGETHER | APART:
            return word in TOGETHER
        raise Refusal(f"the response '{row_response[:40]}' to a synchrony judgement is unknown; write yes or no")
    a, b = pair
    first = word.removesuffix(" first").removesuffix("_first")
    # `order` of functions.py rises with SOA(a, b) = t(b) - t(a): the later b is, the more answers name a as the first.
    if first in (a, "a", "first"):
        return True
    if first in (b, "b", "second"):
        return False
    raise Refusal(f"the response '{row_response[:40]}' to a temporal order judgement is unknown; write {a} or {b}, the first of them")


def answered(kind, trials, pair):
    """(mask of rows with an answer, yes as 0/1)."""
    answers = [is_yes(kind, r, c, pair) for r, c in zip(trials["response"], trials["correct"])]
    rows = np.array([s is not None for s in answers], dtype=bool)
    return rows, np.array([bool(s) for s in answers], dtype=float)
