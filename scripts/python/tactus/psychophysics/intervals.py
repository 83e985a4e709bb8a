"""Intervals of fitted parameters.

posterior: central credible intervals under weak priors (posterior.py). This is the default, because only these have the nominal coverage in every
procedure of tests/measure/measure_recovery, including adaptive ones with about 100 trials.

profile: the values at which the log likelihood, maximised over all other parameters, is less than half a chi-square quantile below its maximum (Venzon and
Moolgavkar 1988, Applied Statistics 37:87; Meeker and Escobar 1995). They are valid for adaptive procedures, whose rule is not part of the likelihood. An end
that is not reached within the bounds is infinite, or the bound of a rate.

bootstrap: percentiles of refits to answers drawn from the fit at the same levels, corrected for bias and acceleration (Efron 1987, JASA 82:171; Wichmann
and Hill 2001b, Perception & Psychophysics 63:1314). It ignores that the levels of an adaptive procedure depend on the answers, so use it for constant
stimuli only.
"""
import dataclasses

import numpy as np
from scipy.special import ndtr, ndtri
from scipy.stats import chi2

from tactus.psychophysics.likelihood import FLOOR, GUESS, LAPSE, Q, T, Answers, maximise, probability
from tactus.psychophysics.posterior import WIDE, credible
from tactus.psychophysics.starts import fit_from_grid

DRAWS = 2000          # Efron and Tibshirani 1993, section 12.5: at least 1000 for the ends of an interval
STEPS = 14            # of the search for an end, whose error is then below 1e-3 of a standard error; design
STEP, OFFSETS = 0.05, (-1.5, -0.5, 0.5, 1.5)  # spread of a step, in gaps of the levels; its distances to a level, in spreads; design
METHODS = ("posterior", "profile", "bootstrap")


def of_many(fits, name, level=0.95, method="posterior", rng=None):
    """(low, high), each (n,), of a Fits."""
    if method not in METHODS:
        raise ValueError(f"there are no intervals '{method}'; choose posterior, profile or bootstrap")
    if not 0 < level < 1:
        raise ValueError(f"the level {level} of an interval is not between 0 and 1; give for example 0.95")
    estimate = fits.estimates(name)
    if name in fits.fixed:
        return estimate, estimate
    if method == "bootstrap":
        rng = np.random.default_rng(0) if rng is None else rng
        ends = np.array([bootstrap(fits.rows(slice(i, i + 1)), name, level, rng) for i in range(len(fits))])
        return ends[:, 0], ends[:, 1]
    return (posterior if method == "posterior" else profile)(fits, name, level)


def index_of(fits, name):
    """(index in theta, name of the anchor or None, function from that parameter to the named value)."""
    f = fits.function
    guess, lapse = fits.theta[:, GUESS], fits.theta[:, LAPSE]

    def location(q):
        return fits.middle + fits.span * q

    def spread(t):
        return fits.span * np.exp(t)

    if name == f.location:
        return Q, None, lambda q: f.outer(location(q), 1.0, guess, lapse)[name]
    if name == f.spread:
        return T, None, lambda t: f.outer(0.0, spread(t), guess, lapse)[name]
    if name in f.widths():
        return T, None, lambda t: f.widths()[name] * spread(t)
    if name in f.anchors():
        return Q, name, lambda q: f.level_of(location(q))
    return {"guess": GUESS, "lapse": LAPSE}[name], None, lambda rate: rate


def posterior(fits, name, level):
    """Credible interval of a location, a spread or a value derived from them; for a rate, which bounds and priors dominate, the profile interval."""
    which, anchor, out = index_of(fits, name)
    if which not in (Q, T):
        return profile(fits, name, level)
    ranges = fits if fits.wide is None else fits.wide
    theta = list(credible(fits, which, anchor, level, lambda w, a: profile_ends(ranges, w, a, WIDE)))
    steps = np.flatnonzero(unresolved(fits, level))
    if len(steps):  # the location may be anywhere between two levels, which spreads above the smallest of the grid do not permit
        wider = profile_ends(ranges.rows(steps), which, anchor, level)
        theta[0][steps] = -np.inf if which == T else np.minimum(theta[0][steps], wider[0])
        theta[1][steps] = np.maximum(theta[1][steps], wider[1])
    with np.errstate(divide="ignore"):
        ends = [out(end) for end in theta]
    estimate = fits.estimates(name)
    # The grid of the posterior ends at a smallest spread, which a maximum of the likelihood may lie below.
    return np.fmin(np.minimum(*ends), estimate) + 0 * estimate, np.fmax(np.maximum(*ends), estimate) + 0 * estimate


def unresolved(fits, level=0.95):
    """(n,) whether the levels are too far apart to estimate the spread: a step explains the answers as well, within half a chi-square quantile of log
    likelihood, so the spread has no lower end (separation; Albert and Anderson 1984, Biometrika 71:1)."""
    z = np.where(fits.answers.total > 0, fits.answers.z, np.nan)
    found = np.zeros(len(fits), dtype=bool)
    gaps = np.nanmax(np.diff(np.sort(z, axis=1), axis=1), axis=1, initial=0.0)
    free = fits.free.copy()
    free[T] = False
    for i in np.flatnonzero(np.exp(fits.theta[:, T]) < gaps):
        levels = np.unique(z[i][~np.isnan(z[i])])
        step = STEP * np.diff(levels).min(initial=1.0)
        q = np.concatenate([(levels[1:] + levels[:-1]) / 2, *(levels + step * offset for offset in OFFSETS)])
        start = np.repeat(fits.theta[i:i + 1], len(q), axis=0)
        start[:, Q], start[:, T] = q, np.log(step)
        rows = np.full(len(q), i)
        value = maximise(fits.answers.rows(rows), start, free, fits.low[rows], fits.high[rows])[1]
        found[i] = fits.value[i] - value.max() < chi2.ppf(level, 1) / 2
    return found


def profile(fits, name, level):
    which, anchor, out = index_of(fits, name)
    with np.errstate(over="ignore", divide="ignore"):
        ends = [out(end) for end in profile_ends(fits, which, anchor, level)]
    return tuple(np.where(np.isnan(fits.estimates(name)), np.nan, e) for e in (np.minimum(*ends), np.maximum(*ends)))


def profile_ends(fits, which, anchor, level):
    """(low, high), each (n,), of theta; infinite: the profile does not drop far enough within the bounds of a location or spread."""
    theta = fits.theta.copy()
    if anchor is not None:
        theta[:, Q] += np.exp(theta[:, T]) * fits.function.anchor(anchor, theta[:, GUESS])
    drop = chi2.ppf(level, 1) / 2
    ends = []
    for side in (-1, 1):
        at, reached = end(fits, theta, which, anchor, side, drop)
        bound = np.full(len(theta), side * np.inf) if which in (Q, T) else (fits.low if side < 0 else fits.high)[:, which]
        ends.append(np.where(reached, at, bound))
    return ends


def end(fits, theta, which, anchor, side, drop):
    """(end of the profile interval, whether it lies within the bounds), each (n,). Searches on the square root of the drop, which is nearly linear: first
    outwards in doubled steps, then by regula falsi (Illinois variant; Dowell and Jarratt 1971)."""
    n = len(theta)
    free = fits.free.copy()
    free[which] = False
    limit = (fits.low if side < 0 else fits.high)[:, which]
    if anchor is not None:
        limit = limit + 0 * theta[:, which]
    goal = np.sqrt(2 * drop)
    warm = theta.copy()

    def root(at, rows):
        start = warm[rows].copy()
        start[:, which] = at
        found, value, _ = maximise(fits.answers.rows(rows), start, free, fits.low[rows], fits.high[rows], anchor)
        warm[rows] = found
        return np.sqrt(np.maximum(2 * (fits.value[rows] - value), 0)) - goal

    inner, f_inner = theta[:, which].copy(), np.full(n, -goal)
    step = np.clip(first_step(fits, theta, free, which, anchor, goal), 1e-6, 1.0)
    outer, f_outer = inner.copy(), np.full(n, -goal)
    open_ = np.flatnonzero(np.isfinite(inner) & (side * (limit - inner) > 0))
    while len(open_):
        at = side * np.minimum(side * (inner[open_] + side * step[open_]), side * limit[open_])
        f = root(at, open_)
        over = f > 0
        outer[open_[over]], f_outer[open_[over]] = at[over], f[over]
        inner[open_[~over]], f_inner[open_[~over]] = at[~over], f[~over]
        step[open_] *= 2
        open_ = open_[~over & (side * (limit[open_] - at) > 1e-12)]
    rows = np.flatnonzero(f_outer > 0)
    last = np.zeros(n)
    for _ in range(STEPS):
        rows = rows[np.abs(outer[rows] - inner[rows]) > 1e-7 * (1 + np.abs(inner[rows]))]
        if not len(rows):
            break
        a, b, fa, fb = inner[rows], outer[rows], f_inner[rows], f_outer[rows]
        at = np.where(np.abs(fb - fa) > 1e-12, b - fb * (b - a) / (fb - fa), (a + b) / 2)
        f = root(at, rows)
        over = f > 0
        up, down = rows[over], rows[~over]
        outer[up], f_outer[up] = at[over], f[over]
        inner[down], f_inner[down] = at[~over], f[~over]
        f_inner[up] = np.where(last[up] > 0, f_inner[up] / 2, f_inner[up])
        f_outer[down] = np.where(last[down] < 0, f_outer[down] / 2, f_outer[down])
        last[rows] = np.where(over, 1, -1)
        rows = rows[np.abs(f) > 1e-4]
    reached = f_outer > 0
    close = np.abs(f_outer) < np.abs(f_inner)
    return np.where(close, outer, inner), reached


def first_step(fits, theta, free, which, anchor, goal):
    """(n,) first step: `goal` standard errors by the information matrix, with the other parameters free."""
    p, by = probability(fits.function, fits.answers.z, np.where(np.isfinite(theta), theta, 0), anchor)
    information = np.einsum("nk,nki,nkj->nij", fits.answers.total / (p * (1 - p)), by, by)
    others = np.flatnonzero(free)
    part = information[:, others][:, :, others].copy()
    diagonal = np.einsum("nii->ni", part)
    diagonal += 1e-9 * diagonal + FLOOR
    cross = information[:, which][:, others]
    left = information[:, which, which] - np.einsum("ni,ni->n", cross, np.linalg.solve(part, cross[..., None])[..., 0])
    return goal / np.sqrt(np.maximum(left, 1e-6))


def refit(fits, yes, total):
    """Fits of other answers (b, k) at the levels of the one fit in `fits`."""
    b = len(yes)
    answers = Answers(fits.function, np.repeat(fits.answers.z, b, axis=0), yes, total)
    low, high, start = (np.repeat(x, b, axis=0) for x in (fits.low, fits.high, fits.theta))
    rates = start[:, [GUESS, LAPSE]]
    theta, value, done = fit_from_grid(answers, rates, fits.free, low, high, more=[start])
    return dataclasses.replace(fits, answers=answers, theta=theta, value=value, done=done, low=low, high=high, middle=np.repeat(fits.middle, b),
                               span=np.repeat(fits.span, b))


def bootstrap(fits, name, level, rng, draws=DRAWS):
    """(low, high) of one fit."""
    estimate = fits.estimates(name)[0]
    p = probability(fits.function, fits.answers.z, fits.theta)[0][0]
    total = fits.answers.total[0]
    yes = rng.binomial(total.astype(int), p, size=(draws, len(p))).astype(float)
    drawn = refit(fits, yes, np.tile(total, (draws, 1))).estimates(name)
    below = (np.count_nonzero(drawn < estimate) + np.count_nonzero(drawn == estimate) / 2) / len(drawn)
    bias = ndtri(np.clip(below, 1 / draws, 1 - 1 / draws))
    acceleration = jackknife(fits, name)
    z = bias + ndtri(np.array([(1 - level) / 2, (1 + level) / 2]))
    ends = np.quantile(drawn, ndtr(bias + z / (1 - acceleration * z)))
    return float(ends[0]), float(ends[1])


def jackknife(fits, name):
    """Acceleration (Efron and Tibshirani 1993, equation 14.15) by leaving out one trial; trials of equal level and answer are computed once."""
    yes, total = fits.answers.yes[0], fits.answers.total[0]
    kinds = [(i, says) for i in range(len(total)) for says in (1, 0) if (yes if says else total - yes)[i] >= 1]
    counts = np.array([yes[i] if says else total[i] - yes[i] for i, says in kinds])
    less = np.array([np.eye(len(total))[i] for i, _ in kinds])
    without = refit(fits, yes - less * np.array([[says] for _, says in kinds]), total - less).estimates(name)
    off = np.average(without, weights=counts) - without
    square = (counts * off ** 2).sum()
    return float((counts * off ** 3).sum() / (6 * square ** 1.5)) if square > 0 else 0.0
