"""L_appear: the level at which a felt property differs by more than its JND, from matches and ratings; presses.py adds measured stiffness.

Each answer is compared with the mean of the same participant's answers about the undegraded stimulus, because people use scales differently. The JND is
published (study/just_noticeable.csv), at the criterion of 75 %: a share of that reference, or an absolute step.
"""
import dataclasses
import math

import numpy as np
from scipy.stats import t as student

from tactus.analysis import limits, monotone_fit, operators, resampling
from tactus.study import felt_properties

TASKS = ("matching", "rating")
LEAST_SD, MAX_CORRELATION = 1e-3, 0.95  # of a shift, in JNDs; correlation of the errors of two shifts; design


@dataclasses.dataclass
class Felt:
    """One property under one factor. levels with shift (mean of answer minus reference) and its interval; jnd in the answers' unit."""
    property: str
    factor: operators.Factor
    levels: list
    shifts: list
    intervals: list
    counts: list
    reference: float
    jnd: float
    source: felt_properties.JustNoticeable
    limit: limits.Limit
    toward: str  # less, more: direction of the change
    left_out: int  # answers of participants without an answer to the undegraded stimulus, or with a mean of 0 for it
    observer: str
    measured: bool = False  # measured at the hand; else judged by the participant


def judged(trials, stated):
    """[(property, Trials)] of numeric answers about a property with a published JND. stated(study): the property in the study file; "": the question
    names it."""
    known = felt_properties.just_noticeable()
    mine = trials.where(np.isin(trials["task"], TASKS) & ~np.isnan(trials["answer_value"]))
    names = np.array([stated(study) or felt_properties.property_of(question, known) for study, question in zip(mine["study"], mine["question"])], dtype=object)
    return [(name, rows) for name in known for _, rows in mine.where(names == name).groups("study")]


def felt(property, trials, rng):
    """[Felt] for each factor of these trials."""
    jnd = felt_properties.just_noticeable()[property][0]
    plain = np.array([not (m and o) or operators.factor(m, o, u, level).undegraded(level) for m, o, u, level in
                      zip(*(trials[name] for name in ("modality_degraded", "operator", "unit", "level")))], dtype=bool)
    own = {name: float(np.mean(rows["answer_value"])) for (name,), rows in trials.where(plain).groups("participant_id")}
    own = {name: reference for name, reference in own.items() if reference or jnd.unit != "%"}  # no relative shift to a reference of 0
    known = np.array([p in own for p in trials["participant_id"]], dtype=bool)
    single = known & (trials["second_modality"] == "")
    made = []
    for factor, rows in operators.factors(trials.where(single & ~plain)):
        if factor.removal:
            continue
        # The reference is that of the same participant.
        baseline = trials.where(known & plain & np.isin(trials["participant_id"], rows["participant_id"]))
        made.append(of_factor(property, jnd, factor, rows, baseline, own, int(np.count_nonzero(~known)), rng))
    return made


def of_factor(property, jnd, factor, rows, baseline, own, left_out, rng):
    resampler = resampling.Resampler(np.concatenate([rows["participant_id"], baseline["participant_id"]]), rng)
    relative = jnd.unit == "%"
    shift = lambda t: np.array([value / own[p] - 1 if relative else value - own[p] for p, value in zip(t["participant_id"], t["answer_value"])])
    bound = jnd.at75 / 100 if relative else jnd.at75
    base, _ = resampler.of_cell(baseline["participant_id"], shift(baseline)[:, None])
    return of_levels(property, jnd, bound, factor, rows, shift, resampler, base[:, 0], float(np.mean(list(own.values()))), left_out)


def of_levels(property, jnd, bound, factor, rows, shift, resampler, base, reference, left_out, measured=False):
    """Felt of the shifts, shift(Trials) -> (n,), at each level. bound: the JND as a shift. base: draws of the shift of the undegraded, or 0."""
    groups = sorted(rows.groups("level"), key=lambda g: factor.severity(g[0][0]))
    levels, shifts, intervals, counts, draws = [], [], [], [], []
    for (level,), cell in groups:
        values = shift(cell)
        drawn, _ = resampler.of_cell(cell["participant_id"], values[:, None])
        drawn = drawn[:, 0] - base
        levels.append(level), shifts.append(float(values.mean())), counts.append(len(values)), draws.append(drawn)
        # Draws of few people have the right variance, but too short tails: Student's t.
        half = student.ppf(0.975, max(1, (len(resampler.people) if resampler.clustered else len(values)) - 1)) * float(np.nanstd(drawn))
        intervals.append((shifts[-1] - half, shifts[-1] + half) if len(values) > 1 else (math.nan, math.nan))
    sign = 1 if shifts[int(np.argmax(np.abs(shifts)))] >= 0 else -1
    severities = np.array([factor.severity(x) for x in levels])
    drawn = crossing_draws(severities, sign * np.array(shifts), np.stack(draws), bound, resampler)
    limit = limits.from_draws("appear", factor, f"{property}, measured" if measured else property, limits.middle(drawn), drawn, float(severities.max()), rows.observer(),
                              len(rows))
    return Felt(property, factor, levels, shifts, intervals, counts, reference, bound, jnd, limit,
                "more" if sign > 0 else "less", left_out, rows.observer(), measured)


def crossing_draws(severities, shifts, draws, bound, resampler):
    """(draws,) severities at which the shift reaches the bound, of a smooth monotone fit. draws (k, draws): of the shifts. The shift is 0 at severity 0."""
    drawn = draws[:, ~np.isnan(draws).any(axis=0)]
    variance = np.maximum(drawn.var(axis=1), (LEAST_SD * bound) ** 2)
    # Shifts share the undegraded answers and the people; few people do not determine each correlation.
    scaled = drawn / np.sqrt(variance)[:, None]
    k = len(severities)
    common = (np.cov(scaled).sum() - k) / (k * (k - 1)) if k > 1 else 0.0
    correlation = np.full((k, k), min(max(common, 0.0), MAX_CORRELATION))
    np.fill_diagonal(correlation, 1.0)
    covariance = np.zeros((k + 1, k + 1))
    covariance[1:, 1:] = correlation * np.sqrt(np.outer(variance, variance))
    covariance[0, 0] = (LEAST_SD * bound) ** 2
    df = len(resampler.people) - 1 if resampler.clustered else np.inf
    return monotone_fit.of_values(np.concatenate([[0.0], severities]), np.concatenate([[0.0], shifts]), covariance, resampler.rng, bound, df).crossing(bound)
