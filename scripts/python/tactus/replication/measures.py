"""The analysis of a published experiment: measures of each participant, from the trials only."""
import math

import numpy as np
from scipy.stats import t as student

from tactus.psychophysics import fits, functions, procedures

ALPHA = 0.05         # of first_level, one-sided; design
RESAMPLES = 400      # of the interval of first_level; design
TWO_INTERVAL = 0.5   # guess rate of an answer "right" in two intervals


def of_participant(trials):
    """{condition: [(level, {outcome: value})]} of the rows (condition, level, number, outcomes) of one participant."""
    found = {}
    for condition, level, _, outcomes in trials:
        found.setdefault(condition, []).append((level, outcomes))
    return found


def means(trials, outcome):
    """(levels, mean of the outcome at each), levels in ascending order."""
    by = {}
    for level, outcomes in trials:
        by.setdefault(level, []).append(outcomes[outcome])
    levels = sorted(by)
    return np.array(levels), np.array([np.mean(by[x]) for x in levels])


def line_slope(x, y):
    """Slope of the least-squares line; NaN with fewer than two different x."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    dx = x - x.mean()
    return float(dx @ (y - y.mean()) / (dx @ dx)) if dx @ dx > 0 else math.nan


def fitted(trials, answer, function, value):
    """A value of a fitted psychometric function; NaN when the levels do not reach it."""
    history = [(level, outcomes[answer] > 0.5) for level, outcomes in trials]
    levels, yes, total = procedures.counts(history)
    if len(levels) < 2:
        return math.nan
    fixed = {"guess": TWO_INTERVAL} if answer == "right" and "guess" in functions.FUNCTIONS[function].parameters else {}
    made = fits.fit(levels, yes, total, function, fixed)
    if not made.converged:
        return math.nan
    return made.params[value] if value in made.params else made.derived[value]


def measured(measure, of, answer, known):
    """One measure of one participant. of: of_participant(). known: {measure id: value} of the measures before."""
    if measure.kind in ("difference", "ratio", "optimal_ratio", "magnitude"):
        v = [known[name] for name in measure.of]
        if measure.kind == "difference":
            return v[0] - v[1]
        if measure.kind == "magnitude":
            return abs(v[0])
        if measure.kind == "ratio":
            return v[0] / v[1] if v[1] else math.nan
        # First against the maximum-likelihood combination of the other two: sqrt(a^2 b^2 / (a^2 + b^2)).
        together = math.hypot(v[1], v[2])
        return v[0] * together / abs(v[1] * v[2]) if v[1] * v[2] else math.nan
    if measure.kind == "fit":
        return fitted(of[measure.of[0]], answer, measure.function, measure.value)
    curves = [means(of[name], measure.outcome) for name in measure.of]
    levels, values = curves[0]
    if measure.kind == "slope":
        return line_slope(levels, values)
    if measure.kind == "slope_growth":
        return line_slope(measure.against, [line_slope(x, y) for x, y in curves])
    if measure.kind == "mean_at":
        at = known[measure.at]
        return float(np.interp(at, levels, values)) if levels[0] <= at <= levels[-1] else math.nan
    picked = [float(y[x == measure.level].mean()) if measure.level is not None and (x == measure.level).any() else float(y.mean()) for x, y in curves]
    if measure.kind == "mean":
        return float(np.mean(picked))
    return 100 * (picked[1] / picked[0] - 1) if picked[0] else math.nan


def first_worse(table):
    """Index of the first column of (participants, levels) that is significantly larger than the first column; None: none is. Paired, one-sided, corrected for
    the number of levels by Holm 1979 (Scandinavian Journal of Statistics 6:65): a level that harms nothing is named in at most ALPHA of the experiments."""
    n = len(table)
    difference = table[:, 1:] - table[:, :1]
    mean, se = difference.mean(axis=0), difference.std(axis=0, ddof=1) / math.sqrt(n)
    equal = se == 0  # all participants differ by the same
    p = np.where(equal, np.where(mean > 0, 0.0, 1.0), student.sf(mean / np.where(equal, 1, se), n - 1))
    order = np.argsort(p, kind="stable")
    adjusted = np.maximum.accumulate(p[order] * np.arange(len(p), 0, -1))
    worse = order[adjusted < ALPHA]
    return int(worse.min()) + 1 if len(worse) else None


def first_level(measure, of_all, seed):
    """(level, [levels of resampled participants]); NaN: no level is worse."""
    curves = [means(of[measure.of[0]], measure.outcome) for of in of_all]
    levels, table = curves[0][0], np.stack([y for _, y in curves])
    if len(table) < 2:
        return math.nan, []
    level = lambda i: math.nan if i is None else float(levels[i])
    dice = np.random.default_rng(seed)
    drawn = [level(first_worse(table[dice.integers(len(table), size=len(table))])) for _ in range(RESAMPLES)]
    return level(first_worse(table)), drawn


def of_experiment(experiment, rows, seed):
    """{measure id: (estimate, values)}: the values of the participants and their mean; of first_level the level, and those of resampled participants."""
    people = {}
    for participant, *row in rows:
        people.setdefault(participant, []).append(row)
    of_all = [of_participant(trials) for _, trials in sorted(people.items())]
    values = [{} for _ in of_all]
    found = {}
    for measure in experiment.measures:
        if measure.kind == "first_level":
            found[measure.id] = first_level(measure, of_all, seed)
            continue
        for of, known in zip(of_all, values):
            known[measure.id] = measured(measure, of, experiment.answer, known)
        ours = np.array([known[measure.id] for known in values])
        finite = ours[np.isfinite(ours)]
        found[measure.id] = (float(finite.mean()) if len(finite) else math.nan, ours.tolist())
    return found
