"""L_detect: the level at which a degradation is detected.

  synchrony judgement   the edges of the window, where the curve is at 75 % of its peak; one for each late sense
  temporal order        PSS ± JND, where 75 % of the orders are right, without lapses
  two intervals         75 % correct; if the study asks which of two felt softer, this is L_appear as judged

With FEWEST_PARTICIPANTS people or more, the limit is the mean of their own values, of thresholds the geometric mean, with Student's t over people. People
whose answers have no fit are named in the note of the limit. With fewer people, it comes from the fit to all
answers, with draws from the interval of the fit: a normal distribution with a separate width for each half. (PSS and JND of an order judgement are
estimated independently of each other if the levels surround the PSS, because the curve is symmetric.) A limit below 0 counts as 0.
"""
import numpy as np
from scipy.stats import norm

from tactus.analysis import limits, resampling
from tactus.analysis.operators import Factor

ALL_PARTICIPANTS = ""  # the participant of a curve of all together


def draws_of(value, interval, rng, draws=resampling.DRAWS):
    """Draws that have this value as median and this 95 % interval."""
    z = rng.standard_normal(draws)
    halves = np.array([value - interval[0], interval[1] - value]) / norm.ppf(0.975)
    return value + z * np.where(z < 0, halves[0], halves[1])


def edges(curve, sign, rng):
    """(value, draws) of the largest lateness of one sense, ms, in one fit; sign: +1 for the second of the pair, -1 for the first."""
    if curve.condition.kind == "sj":
        name = "high75" if sign > 0 else "low75"
        return sign * curve.window_value(name), None if rng is None else sign * draws_of(*curve.window(name), rng)
    value = sign * curve.value("pss") + curve.value("jnd")
    if rng is None:
        return value, None
    return value, sign * draws_of(curve.value("pss"), curve.intervals["pss"], rng) + draws_of(curve.value("jnd"), curve.intervals["jnd"], rng)


def threshold(curve, rng):
    return curve.value("threshold75"), None if rng is None else draws_of(curve.value("threshold75"), curve.intervals["threshold75"], rng)


def severities(values):
    """(n,) severities; values below 0 become 0."""
    return np.array([max(v, 0.0) for v in values])


def of_people(values, logarithmic, rng, draws=resampling.DRAWS):
    """(mean of the values of people, or their geometric mean; draws of it by Student's t)."""
    on = np.log(values) if logarithmic else values
    drawn = on.mean() + on.std(ddof=1) / np.sqrt(len(on)) * rng.standard_t(len(on) - 1, draws)
    return (float(np.exp(on.mean())), np.exp(drawn)) if logarithmic else (float(on.mean()), severities(drawn))


def condition_limits(condition, curves, rng, felt=""):
    """[Limit] of one condition from its curves, also if some have no fit. felt: the property by which its two intervals were compared, or ""."""
    fitted = [c for c in curves if c.fit is not None]
    all_participants = [c for c in fitted if c.participant == ALL_PARTICIPANTS]
    fitted_people = [c for c in fitted if c.participant != ALL_PARTICIPANTS]
    without = [c.participant for c in curves if c.fit is None and c.participant != ALL_PARTICIPANTS]
    note = f"without {len(without)} of {len(without) + len(fitted_people)} participants, whose answers have no fit: {', '.join(without)}" if without else ""
    sides = [(+1, condition.pair[1], condition.pair[0]), (-1, condition.pair[0], condition.pair[1])] if condition.pair else [(0, None, None)]
    made = []
    for sign, late, early in sides:
        factor = Factor(late, "delay", "ms") if condition.pair else condition.factor
        one = (lambda c, r: edges(c, sign, r)) if condition.pair else threshold
        by = f"{early} → {late}, {condition.kind}" if condition.pair else f"{felt}, judged" if felt else condition.kind
        if len(fitted_people) >= resampling.FEWEST_PARTICIPANTS:
            values = severities([one(c, None)[0] for c in fitted_people])
            point, draws = of_people(values, condition.pair is None and (values > 0).all(), rng)
        elif all_participants:
            point, draws = one(all_participants[0], rng)
            point, draws = severities([point])[0], severities(draws)
        else:
            continue
        used = fitted_people if len(fitted_people) >= resampling.FEWEST_PARTICIPANTS else all_participants
        tried = np.abs(np.concatenate([c.levels for c in used]))
        made.append(limits.from_draws("appear" if felt else "detect", factor, by, point, draws, float(tried.max()),
                                      " and ".join(sorted({c.observer for c in used})), int(sum(c.total.sum() for c in used)), note=note))
    return made


def detection_limits(curves, seed, felt=lambda study: ""):
    """[Limit] of all conditions. felt(study): the property in its study file, or ""."""
    made = []
    conditions = []
    for c in curves:
        if c.condition not in conditions:
            conditions.append(c.condition)
    for i, condition in enumerate(conditions):
        made += condition_limits(condition, [c for c in curves if c.condition == condition], np.random.default_rng([seed, 1000 + i]),
                             felt(condition.study) if condition.kind == "2ifc" else "")
    return made
