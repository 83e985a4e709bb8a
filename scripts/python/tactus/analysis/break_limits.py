"""L_break: the level at which success, or the time given success, is worse than undegraded by the study's margin.

The estimate and its interval come from a smooth monotone fit (monotone_fit.py). Beside it stands a bracket that assumes only that performance gets no
better with the level: from the severest level whose loss is shown to be below the margin to the mildest whose loss is shown to be above it, with intervals
that hold over all levels together (Sidak 1967, JASA 62:626).
"""
import math

import numpy as np
from scipy.special import expit

from tactus.analysis import limits, monotone_fit, performance, people

UNIT_LOG_TIME = 0.25  # scale of the logarithm of times, for the kernel; design: 28 %
NOT_SEEN = "time is not identified at {}: too few games were won, or more than 30 % of the times to win lie above the time limit"


def covariance(influence, variance):
    """(covariance (k, k), degrees of freedom) of k means of the same people. influence (people, k): their shares in the errors; variance (k,): of each mean
    if people were alike.

    Few people cannot determine k (k + 1) / 2 covariances, so the matrix has a common covariance, and variances that are between those of each mean and
    their common ratio to the variances of people who are alike."""
    n, k = influence.shape
    raw = n / (n - 1) * influence.T @ influence
    common = max(0.0, (raw.sum() - np.trace(raw)) / (k * (k - 1))) if k > 1 else 0.0
    ratio = np.maximum((np.diag(raw) - common) / variance, 1e-9)
    size = np.maximum(1.0, np.sqrt(ratio * ratio.mean()))
    return np.diag(size * variance) + common, n - 1


def measured_success(cells, clustered):
    """(log odds (k,), covariance (k, k), degrees of freedom) of the shares of success."""
    values, variances = monotone_fit.logits([c.success.sum() for c in cells], [c.n for c in cells])
    if not clustered:
        return values, np.diag(variances), np.inf
    names = sorted(set(np.concatenate([c.participants for c in cells])))
    shares = [people.Share(*performance.counted(c, names)) for c in cells]
    return values, *covariance(np.stack([s.residuals / (s.smoothed * (1 - s.smoothed)) for s in shares], axis=1), variances)


def measured_times(cells, clustered):
    """(mean logarithms of the time to win (k,), covariance (k, k), degrees of freedom)."""
    values, variances = np.array([c.times.mu for c in cells]), np.array([c.times.variance for c in cells])
    if not clustered:
        return values, np.diag(variances), np.inf
    names = sorted(set(np.concatenate([c.participants for c in cells])))
    return values, *covariance(np.stack([performance.influences(c, names) for c in cells], axis=1), variances)


def worsening(cells, severities, clustered, rng, outcome, reference=None):
    """monotone_fit.Worsening of `outcome`, success or time, of the cells at ascending severities. reference: the undegraded cell; None: the first cell, at
    severity 0."""
    values, cov, df = (measured_success if outcome == "success" else measured_times)(cells, clustered)
    if outcome == "success":
        made = None if reference is None else expit(reference_draws(measured_success([reference], clustered), rng))
        return monotone_fit.of_shares(severities, values, cov, rng, df, made)
    made = None if reference is None else reference_draws(measured_times([reference], clustered), rng) - values[0]
    return monotone_fit.of_values(severities, values - values[0], cov, rng, UNIT_LOG_TIME, df, made)


def reference_draws(measured, rng):
    (value,), ((variance,),), df = measured
    size = 1.0 if np.isinf(df) else df / rng.chisquare(df, monotone_fit.DRAWS)
    return value + np.sqrt(variance * size) * rng.standard_normal(monotone_fit.DRAWS)


def bracket(mine, severities, baseline, clustered, margins, outcome):
    """(low, high) severities: the severest level whose loss is shown to be below the margin, or 0; the mildest whose loss is shown to be above it, or
    infinite."""
    level = 0.95 ** (1 / len(mine))
    if outcome == "success":
        ends = [(-high, -low) for low, high in (performance.compared_success(c, baseline, clustered, level) for c in mine)]
    else:
        ends = [performance.compared_time(c, baseline, clustered, level) for c in mine]
    margin = margins[0] if outcome == "success" else margins[1]
    low = max((s for s, (_, most) in zip(severities, ends) if most < margin), default=0.0)
    high = min((s for s, (least, _) in zip(severities, ends) if least > margin), default=math.inf)
    return min(low, high), high


def seen(mine, baseline):
    """(cells whose time to win is identified, note about the others)."""
    kept = [c for c in mine if c.times.identified and baseline.times.identified]
    left = [performance_words(c) for c in mine if c not in kept]
    return kept, NOT_SEEN.format(", ".join(left)) if left else ""


def performance_words(cell):
    (factor, level), = cell.degraded
    return f"{level:g} {factor.unit}".rstrip()


def worsenings(cells, factor, clustered, rng):
    """{outcome: (Worsening or None, [cells], severities, note)} of a factor."""
    baseline, mine = cells[()], limits.series(cells, factor)
    found = {}
    for outcome, (kept, note) in (("success", (mine, "")), ("time", seen(mine, baseline))):
        severities = np.array([factor.severity(c.achieved) for c in kept])
        one = worsening([baseline, *kept], np.concatenate([[0.0], severities]), clustered, rng, outcome) if kept else None
        found[outcome] = one, kept, severities, note
    return found


def crossing_of(one, margins, outcome):
    """(draws,) severities of the margin; None: not identified."""
    if one is None:
        return np.full(monotone_fit.DRAWS, np.nan)
    return one.crossing(margins[0] if outcome == "success" else math.log(margins[1]))


def break_limits(cells, factor, clustered, margins, observer, rng, found=None):
    """[Limit] by success, by time given success, and by whichever comes first. found: worsenings(), if known."""
    baseline = cells[()]
    found = found or worsenings(cells, factor, clustered, rng)
    made = []
    for outcome, (one, kept, severities, note) in found.items():
        drawn = crossing_of(one, margins, outcome)
        n = int(sum(c.n for c in kept)) + baseline.n
        ends = bracket(kept, severities, baseline, clustered, margins, outcome) if kept else limits.NO_BRACKET
        made.append(limits.from_draws("break", factor, outcome, limits.middle(drawn), drawn, float(severities.max()) if kept else 0.0, observer, n, ends, note))
    success, time = made
    either = np.fmin(success.draws, time.draws)
    # The order of the outcomes: a limit that is not identified is not the first.
    first = success if not limits.severity_of(time) < limits.severity_of(success) else time
    note = f"first by {first.by}" + (f"; {time.note}" if time.note else "") if first.reached else time.note
    low, high = np.fmin(*([factor.severity(v) if np.isfinite(v) and v else v for v in l.bracket] for l in (success, time)))
    made.append(limits.from_draws("break", factor, limits.EITHER, limits.middle(either), either, max(float(s.max()) if len(s) else 0.0 for _, _, s, _ in found.values()), observer,
                                  success.n, (low, high), note))
    return made


MARGINS = tuple(range(1, 51))  # points of success, and percent of time, of the curves over the margin
SHORTER = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)  # shares of the time limit of the curves over the limit; design


def curves(cells, factor, clustered, margins, limit_s, rng, found):
    """Rows {outcome, margin, limit_s, value, low, high} of the limit over the margin, and over the time limit at the study's margins. Levels of the factor."""
    rows = []

    def add(worse, outcome, margin, limit):
        one = worse[outcome][0]
        drawn = crossing_of(one, (margin, 1 + margin), outcome)
        made = limits.from_draws("break", factor, outcome, limits.middle(drawn), drawn, float(worse[outcome][2].max()) if one else 0.0, "", 0)
        rows.append({"outcome": outcome, "margin": margin, "limit_s": limit, "value": made.value, "low": made.low, "high": made.high, "up_to": made.up_to})

    for outcome in found:
        for percent in MARGINS:
            add(found, outcome, percent / 100, limit_s)
    if math.isfinite(limit_s):
        for share in SHORTER[:-1]:
            worse = worsenings(performance.shortened(cells, share * limit_s), factor, clustered, rng)
            for outcome, margin in (("success", margins[0]), ("time", margins[1] - 1)):
                add(worse, outcome, margin, share * limit_s)
    return rows
