"""Psychometric functions per condition: of each participant and of all together, over achieved levels.

What a condition is: of a synchrony or order judgement, the pair of senses; of a detection task, the sense, what is done to it, and in which
unit. Fits are those of scripts/python/tactus/psychophysics (maximum likelihood with guess and lapse rates).
"""
import dataclasses
import math

import numpy as np

from tactus.analysis import answers, operators
from tactus.analysis.detection import EVERYBODY
from tactus.analysis.operators import Factor
from tactus.psychophysics import fits

MOST_LEVELS = 60  # design: more achieved values than these are put into as many bins, each at its mean
FEWEST_TRIALS = 20  # design: of fewer no function is fitted


@dataclasses.dataclass
class Condition:
    """kind: sj, toj, 2ifc. pair: (a, b), or None. factor: what is degraded, or None for a pair. condition: the study's own name for it."""
    study: str
    kind: str
    pair: tuple
    factor: Factor
    measured: bool  # whether the levels are achieved ones; else those asked for. Where less is worse they are severities, so that functions rise

    def words(self):
        what = f"{self.pair[0]}–{self.pair[1]}" if self.pair else self.factor.words() + (f" as {self.factor.severity_axis()}" if self.factor.falling else "")
        return f"{what}, {answers.CALLED[self.kind]}"

    def axis(self):
        if self.pair:
            return f"SOA({self.pair[0]}, {self.pair[1]}) = t({self.pair[1]}) − t({self.pair[0]}), achieved (ms)"
        return self.factor.severity_axis() + (", achieved" if self.measured else ", as asked for")

    def slug(self):
        what = "_".join(self.pair) if self.pair else f"{self.factor.modality}_{self.factor.operator}"
        return f"{what}_{self.kind}"


@dataclasses.dataclass
class Curve:
    """One fit. levels, yes, total: (k,) what it was fitted to; intervals: {name: (low, high)} of parameters and derived values.

    fit is None, and why a sentence, where there is none."""
    condition: Condition
    participant: str
    levels: np.ndarray
    yes: np.ndarray
    total: np.ndarray
    trials: object
    observer: str
    fit: object = None
    intervals: dict = dataclasses.field(default_factory=dict)
    why: str = ""

    def value(self, name):
        return {**self.fit.params, **self.fit.derived}[name]


def achieved(rows, condition):
    """(n,) levels of the trials and whether they were measured."""
    if condition[1] is not None:
        return rows["soa_achieved_ms"], True
    factor = condition[2]
    if factor.operator == "loss" and not np.isnan(rows["loss_achieved"]).all():
        return rows["loss_achieved"] * (100 if factor.unit == "%" else 1), True
    if factor.operator == "delay" and factor.unit == "ms" and not np.isnan(rows["soa_achieved_ms"]).all():
        return np.abs(rows["soa_achieved_ms"]), True
    return np.array([factor.severity(level) for level in rows["level"]]), False


def binned(levels, yes):
    """(levels, yes, total): answers at the same level together; many levels into bins of equal counts, each at the mean of its levels."""
    order = np.argsort(levels, kind="stable")
    levels, yes = levels[order], yes[order]
    same = np.unique(levels)
    if len(same) <= MOST_LEVELS:
        index = np.searchsorted(same, levels)
    else:
        index = np.minimum(np.arange(len(levels)) * MOST_LEVELS // len(levels), MOST_LEVELS - 1)
    total = np.bincount(index).astype(float)
    return np.bincount(index, weights=levels) / total, np.bincount(index, weights=yes), total


def conditions_of(trials):
    """[(Condition, Trials)] of the trials that have a psychometric function."""
    kinds = np.array([answers.kind_of(t) or "" for t in trials["task"]], dtype=object)
    found = []
    for kind in answers.FUNCTION:
        mine = trials.where(kinds == kind)
        if kind == "2ifc":
            groups = [((study, None, factor), rows) for (study,), of_study in mine.groups("study") for factor, rows in operators.factors(of_study)
                      if factor.modality and not factor.removal]
        else:
            groups = [((study, answers.pair_of(pair), None), rows) for (study, pair), rows in mine.groups("study", "pair")]
        for key, rows in groups:
            levels, measured = achieved(rows, key)
            found.append((Condition(key[0], kind, key[1], key[2], measured), rows))
    return found


def curve(condition, participant, rows, rng):
    """The Curve of these rows; its fit is None, with the reason, when they do not bear one."""
    levels, _ = achieved(rows, (None, condition.pair, condition.factor))
    answered, yes = answers.answered(condition.kind, rows, condition.pair)
    keep = answered & ~np.isnan(levels)
    rows, levels, yes = rows.where(keep), levels[keep], yes[keep]
    made = Curve(condition, participant, *(binned(levels, yes) if len(levels) else (np.array([]),) * 3), rows, rows.observer() if len(rows) else "")
    if len(levels) < FEWEST_TRIALS:
        made.why = f"{len(levels)} answers with an achieved level are too few to fit a function to; {FEWEST_TRIALS} are needed"
    elif len(set(yes)) < 2:
        made.why = "all answers are the same: the levels did not reach the threshold"
    elif len(made.levels) < 2:
        made.why = "there is one level only"
    else:
        fitted = fits.fit(made.levels, made.yes, made.total, answers.FUNCTION[condition.kind], fixed={"guess": answers.GUESS_2IFC} if condition.kind == "2ifc" else {},
                          rng=rng)
        if not fitted.converged or not all(math.isfinite(v) for v in fitted.params.values()):
            made.why = "the fit did not converge; were there enough levels on either side of the threshold?"
        else:
            made.fit = fitted
            made.intervals = {name: tuple(float(v) for v in fits.interval(fitted, name, rng=rng)) for name in wanted(fitted)}
    return made


def wanted(fitted):
    """What intervals are told of: all but a guess that is fixed."""
    return [name for name in [*fitted.params, *fitted.derived] if name not in fitted.fixed]


def curves(trials, seed):
    """[Curve]: of each condition that of everybody first, then of each participant. Each has random numbers of its own, so that one more
    participant changes nobody's interval."""
    made = []
    for i, (condition, rows) in enumerate(conditions_of(trials)):
        people = rows.participants()
        parts = [(EVERYBODY, rows)] + ([(p, rows.where(rows["participant_id"] == p)) for p in people] if len(people) > 1 else [])
        for participant, mine in parts:
            made.append(curve(condition, participant, mine, np.random.default_rng([seed, i, *participant.encode()])))
    return made
