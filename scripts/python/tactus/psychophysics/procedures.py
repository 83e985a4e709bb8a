"""Procedures, which choose the next level, made from the specification of a study file.

A procedure has next_level(), answer(level, yes), finished, done, expected (estimated total of trials), estimate() (a dict, or None) and history,
[(level, yes)]. Its state depends on the specification, the seed and the answers only, so the same answers restore it. A missed trial is not passed to
answer(); next_level() then returns the same level again.
"""
import numpy as np

from tactus.psychophysics.constant_stimuli import ConstantStimuli
from tactus.psychophysics.quest_plus import QuestPlus
from tactus.psychophysics.staircases import MAX_TRIALS, Staircase

# Required and optional members of the specification of each kind.
NEEDED = {"constant": {"levels", "repetitions"}, "staircase": {"rule", "start", "step", "minimum_step", "lowest", "highest", "reversals"},
          "quest_plus": {"levels", "parameters", "function"}}
ALLOWED = {"constant": set(), "staircase": {"max_trials"}, "quest_plus": {"trials", "stop_sd", "prior"}}


def make_procedure(spec, seed):
    """A procedure. Raises ValueError with one sentence if the specification is invalid. Only constant stimuli use the seed; the others depend on the answers
    only."""
    kind = spec.get("kind")
    if kind not in NEEDED:
        raise ValueError(f"there is no procedure '{kind}'; choose one of {', '.join(NEEDED)}")
    given = set(spec) - {"kind"}
    missing, more = NEEDED[kind] - given, given - NEEDED[kind] - ALLOWED[kind]
    if missing:
        raise ValueError(f"the procedure {kind} lacks {', '.join(sorted(missing))}; add it")
    if more:
        raise ValueError(f"the procedure {kind} has no {', '.join(sorted(more))}; it takes {', '.join(sorted(NEEDED[kind] | ALLOWED[kind]))}")
    if kind == "constant":
        return ConstantStimuli(spec["levels"], spec["repetitions"], seed)
    if kind == "staircase":
        return Staircase(*(spec[k] for k in ("rule", "start", "step", "minimum_step", "lowest", "highest", "reversals")), spec.get("max_trials", MAX_TRIALS))
    return QuestPlus(spec["function"], spec["parameters"], spec["levels"], spec.get("trials"), spec.get("stop_sd"), spec.get("prior"))


def run(procedure, observer):
    """Runs the procedure with a simulated observer until it has finished; returns its history."""
    while not procedure.finished:
        level = procedure.next_level()
        procedure.answer(level, observer.answer(level))
    return procedure.history


def counts(history):
    """(levels, yes, total), arrays (k,): answers counted by level, for a fit."""
    levels, where = np.unique([level for level, _ in history], return_inverse=True)
    yes = np.array([says for _, says in history], dtype=float)
    return levels, np.bincount(where, weights=yes), np.bincount(where).astype(float)


def stacked(histories):
    """(levels, yes, total), arrays (n, k) of n histories; shorter ones are padded with total 0."""
    many = [counts(h) for h in histories]
    k = max(len(levels) for levels, _, _ in many)
    made = np.zeros((3, len(many), k))
    for i, parts in enumerate(many):
        for j, part in enumerate(parts):
            made[j, i, :len(part)] = part
    return made[0], made[1], made[2]
