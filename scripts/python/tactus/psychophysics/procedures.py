"""Which level comes next: procedures made from a specification, as a study file holds it.

A procedure has next_level(), answer(level, yes), finished, done, expected (trials in all, as far as known), estimate() (a dict, or None) and history,
[(level, yes)]. It is decided by its specification, its seed and the answers so far: fed the same answers again it is where it was. A trial that was
spoiled is not told to answer(); next_level() gives the same level again.
"""
import numpy as np

from tactus.psychophysics.constant_stimuli import ConstantStimuli
from tactus.psychophysics.quest_plus import QuestPlus
from tactus.psychophysics.staircases import MOST_TRIALS, Staircase

# What a specification of each kind has to hold, and what it may.
NEEDED = {"constant": {"levels", "repetitions"}, "staircase": {"rule", "start", "step", "minimum_step", "lowest", "highest", "reversals"},
          "quest_plus": {"levels", "parameters", "function"}}
ALLOWED = {"constant": set(), "staircase": {"most_trials"}, "quest_plus": {"trials", "stop_sd", "prior"}}


def make_procedure(spec, seed):
    """A procedure; ValueError in one sentence when the specification is wrong. Only constant stimuli need the seed: the others hang on the
    answers alone."""
    kind = spec.get("kind")
    if kind not in NEEDED:
        raise ValueError(f"there is no procedure '{kind}'; choose one of {', '.join(NEEDED)}")
    given = set(spec) - {"kind"}
    missing, more = NEEDED[kind] - given, given - NEEDED[kind] - ALLOWED[kind]
    if missing:
        raise ValueError(f"the procedure {kind} lacks {', '.join(sorted(missing))}")
    if more:
        raise ValueError(f"the procedure {kind} knows no {', '.join(sorted(more))}; it takes {', '.join(sorted(NEEDED[kind] | ALLOWED[kind]))}")
    if kind == "constant":
        return ConstantStimuli(spec["levels"], spec["repetitions"], seed)
    if kind == "staircase":
        return Staircase(*(spec[k] for k in ("rule", "start", "step", "minimum_step", "lowest", "highest", "reversals")), spec.get("most_trials", MOST_TRIALS))
    return QuestPlus(spec["function"], spec["parameters"], spec["levels"], spec.get("trials"), spec.get("stop_sd"), spec.get("prior"))


def run(procedure, observer):
    """Asks a simulated observer until the procedure has finished, and returns its history."""
    while not procedure.finished:
        level = procedure.next_level()
        procedure.answer(level, observer.answer(level))
    return procedure.history


def counts(history):
    """(levels, yes, total), arrays (k,) of numbers: the answers of equal levels together, for a fit."""
    levels, where = np.unique([level for level, _ in history], return_inverse=True)
    yes = np.array([says for _, says in history], dtype=float)
    return levels, np.bincount(where, weights=yes), np.bincount(where).astype(float)


def stacked(histories):
    """(levels, yes, total), arrays (n, k) of n histories; shorter ones are filled up with total 0."""
    many = [counts(h) for h in histories]
    k = max(len(levels) for levels, _, _ in many)
    made = np.zeros((3, len(many), k))
    for i, parts in enumerate(many):
        for j, part in enumerate(parts):
            made[j, i, :len(part)] = part
    return made[0], made[1], made[2]
