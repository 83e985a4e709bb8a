"""Psychometric functions of each condition: for each participant and for all together, over measured levels.

A condition of a synchrony or order judgement is the pair of senses; of a detection task it is the sense, the operator and the unit. Fits are those of
tactus/psychophysics (maximum likelihood with guess and lapse rates).
"""
import collections.abc
import dataclasses
import functools
import math

import numpy as np

from tactus.analysis import answers, operators
from tactus.analysis.detection import ALL_PARTICIPANTS
from tactus.analysis.operators import Factor
from tactus.psychophysics import fits, independent_channels, intervals, overdispersion

MAX_LEVELS = 60  # design; more measured values are grouped into this number of bins, each at its mean
FOLLOW = ("peak", "absolute_low75", "absolute_high75")  # without an interval: peak is 1 - lapse
RATES = ("guess", "lapse")  # of over-dispersed answers their intervals are widened; those of the others integrate over the dispersion
TOO_FAR = "the levels are too far apart to estimate the spread; it may be 0, and its interval gives the largest one"
FEWEST_TRIALS = 20  # needed for a fit; design


@dataclasses.dataclass
class Condition:
    """kind: sj, toj, 2ifc. pair: (a, b), or None. factor: the degraded sense and its operator, or None for a pair."""
    study: str
    kind: str
    pair: tuple
    factor: Factor
    measured: bool  # whether the levels are measured, else requested. If a lower level is worse, they are severities, so that functions rise

    def words(self):
        what = f"{self.pair[0]}–{self.pair[1]}" if self.pair else self.factor.words() + (f" as {self.factor.severity_axis()}" if self.factor.lower_is_worse else "")
        return f"{what}, {answers.TASK_NAMES[self.kind]}"

    def axis(self):
        if self.pair:
            return f"SOA({self.pair[0]}, {self.pair[1]}) = t({self.pair[1]}) − t({self.pair[0]}), achieved (ms)"
        return self.factor.severity_axis() + (", achieved" if self.measured else ", requested")

    def slug(self):
        what = "_".join(self.pair) if self.pair else f"{self.factor.modality}_{self.factor.operator}"
        return f"{what}_{self.kind}"


@dataclasses.dataclass
class Curve:
    """One fit. levels, yes, total: (k,) data of the fit. Without a fit, fit is None and why the reason; with one, why names a value that the answers do
    not determine, or is empty. rng: random numbers of the dispersion."""
    condition: Condition
    participant: str
    levels: np.ndarray
    yes: np.ndarray
    total: np.ndarray
    trials: object
    observer: str
    fit: object = None
    why: str = ""
    asymmetric: independent_channels.Fit = None  # of judgements of synchrony
    aic: dict = dataclasses.field(default_factory=dict)  # {model: Akaike's criterion}; the smallest describes the answers best
    rng: object = None

    @functools.cached_property
    def dispersion(self):
        """overdispersion.Dispersion of the fit, or None; computed when first asked for."""
        return overdispersion.dispersion(self.fit, self.rng) if self.fit else None

    @functools.cached_property
    def intervals(self):
        """Intervals of parameters and derived values, empty without a fit."""
        return Intervals(self)

    def value(self, name):
        return {**self.fit.params, **self.fit.derived}[name]

    def window(self, name):
        """(value, interval) of low75, high75 or pss: of the asymmetric window if its intervals were asked for, else of the symmetric one."""
        return self.window_value(name), self.asymmetric.intervals[name] if self.has_asymmetric() else self.intervals[name]

    def window_value(self, name):
        return self.asymmetric.values[name] if self.has_asymmetric() else self.value(name)

    def has_asymmetric(self):
        return bool(self.asymmetric and self.asymmetric.intervals)


class Intervals(collections.abc.Mapping):
    """{name: (low, high)} of a Curve. Each is computed when first asked for, because it takes up to a second."""

    def __init__(self, curve):
        self.curve, self.found = curve, {}
        self.names = wanted(curve.fit) if curve.fit else []

    def __iter__(self):
        return iter(self.names)

    def __len__(self):
        return len(self.names)

    def __getitem__(self, name):
        if name not in self.names:
            raise KeyError(name)
        if name not in self.found:
            low, high = (float(v[0]) for v in intervals.of_many(self.of_rates if name in RATES else self.of_others, name))
            self.found[name] = min(low, self.curve.value(name)), max(high, self.curve.value(name))
        return self.found[name]

    @functools.cached_property
    def of_rates(self):
        return overdispersion.inflated(self.curve.fit.many, self.curve.dispersion.width())

    @functools.cached_property
    def of_others(self):
        return overdispersion.over_dispersed(self.curve.fit.many, self.curve.dispersion.factor)


def achieved(rows, condition):
    """((n,) levels of the trials, whether they were measured)."""
    if condition[1] is not None:
        return rows["soa_achieved_ms"], True
    factor = condition[2]
    if operators.kind(factor.operator) == "loss" and not np.isnan(rows["loss_achieved"]).all():
        return rows["loss_achieved"] * (100 if factor.unit == "%" else 1), True
    if operators.kind(factor.operator) == "delay" and factor.unit == "ms" and not np.isnan(rows["soa_achieved_ms"]).all():
        return np.abs(rows["soa_achieved_ms"]), True
    return np.array([factor.severity(level) for level in rows["level"]]), False


def binned(levels, yes):
    """(levels, yes, total): joins answers at the same level; many levels are grouped into bins of equal counts, each at its mean level."""
    order = np.argsort(levels, kind="stable")
    levels, yes = levels[order], yes[order]
    same = np.unique(levels)
    if len(same) <= MAX_LEVELS:
        index = np.searchsorted(same, levels)
    else:
        index = np.minimum(np.arange(len(levels)) * MAX_LEVELS // len(levels), MAX_LEVELS - 1)
    total = np.bincount(index).astype(float)
    return np.bincount(index, weights=levels) / total, np.bincount(index, weights=yes), total


def conditions_of(trials):
    """[(Condition, Trials)] of the trials with a psychometric function."""
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


def curve(condition, participant, rows, rng, asymmetric=False):
    """The Curve of these rows; its fit is None, with the reason, if they do not permit one."""
    levels, _ = achieved(rows, (None, condition.pair, condition.factor))
    answered, yes = answers.answered(condition.kind, rows, condition.pair)
    keep = answered & ~np.isnan(levels)
    rows, levels, yes = rows.where(keep), levels[keep], yes[keep]
    made = Curve(condition, participant, *(binned(levels, yes) if len(levels) else (np.array([]),) * 3), rows, rows.observer() if len(rows) else "", rng=rng)
    if len(levels) < FEWEST_TRIALS:
        made.why = f"{len(levels)} answers with a measured level are too few for a fit; {FEWEST_TRIALS} are needed"
    elif len(set(yes)) < 2:
        made.why = "all answers are the same: the levels did not reach the threshold"
    elif len(made.levels) < 2:
        made.why = "there is only one level"
    else:
        fitted = fits.fit(made.levels, made.yes, made.total, answers.FUNCTION[condition.kind], fixed={"guess": answers.GUESS_2IFC} if condition.kind == "2ifc" else {},
                          rng=rng)
        if not fitted.converged or not all(math.isfinite(v) for v in fitted.params.values()):
            made.why = "the fit did not converge; use more levels on either side of the threshold"
        else:
            made.fit = fitted
            made.why = TOO_FAR if intervals.unresolved(fitted.many)[0] else ""
            if condition.kind == "sj" and (asymmetric or participant == ALL_PARTICIPANTS):
                made.asymmetric = independent_channels.fit(made.levels, made.yes, made.total, rng if asymmetric else None)
                forced = fits.fit(made.levels, made.yes, made.total, answers.FUNCTION["sj"], forced_peak=True)
                made.aic = {"free peak": fitted.aic, "peak near 1": forced.aic, "asymmetric": made.asymmetric.aic}
    return made


def wanted(fitted):
    """Names of the parameters and derived values with an interval: all except fixed ones, and those that follow from others."""
    return [name for name in [*fitted.params, *fitted.derived] if name not in fitted.fixed and name not in FOLLOW]


def curves(trials, seed, asymmetric=False):
    """[Curve]: for each condition first that of all participants, then one for each. Each has its own random numbers, so an additional participant does
    not change the intervals of the others. asymmetric: also intervals of asymmetric windows, which take seconds each."""
    made = []
    for i, (condition, rows) in enumerate(conditions_of(trials)):
        people = rows.participants()
        parts = [(ALL_PARTICIPANTS, rows)] + ([(p, rows.where(rows["participant_id"] == p)) for p in people] if len(people) > 1 else [])
        for participant, mine in parts:
            made.append(curve(condition, participant, mine, np.random.default_rng([seed, i, *participant.encode()]), asymmetric))
    return made
