"""Credible intervals: integrates the likelihood over a grid (Kuss, Jaekel and Wichmann 2005, Journal of Vision 5(5):8; Schuett et al. 2016, Vision
Research 122:105).

Priors: flat over the location (or the derived point), flat over the logarithm of the spread within SPREAD, flat over the lapse rate within its bounds,
Beta(1, 10) over a fitted guess rate. For a location and a scale these priors give intervals with the nominal coverage (Welch and Peers 1963, JRSS B
25:318). Grid and nodes cover the wide profile interval, so that they resolve the narrow likelihood of many trials.
"""
import math

import numpy as np
from scipy.special import roots_legendre

from tactus.psychophysics.functions import GUESS_PRIOR
from tactus.psychophysics.likelihood import GUESS, LAPSE, LEAST_P, Q, T

SPREAD = (0.01, 0.9)       # in spans of the levels: 3.3 spreads (5 to 95 %) are at most three spans (Schuett et al. 2016); the lower end resolves a step
CELLS = (49, 33)           # of the grid over location and spread; design
NODES = 6                  # of each rate, at most 1.3 standard deviations apart; design
WIDE = 0.9998              # level of the profile interval that grid and nodes span; design
AT_ONCE = 3_000_000        # probabilities in memory; design


def rate_nodes(fits, rate, profile_range):
    """[(values (n,), log weights (n,))] of one rate: Gauss-Legendre nodes within its profile interval, which is narrow for many trials; one node for a
    fixed rate."""
    if not fits.free[rate]:
        return [(fits.theta[:, rate], np.zeros(len(fits)))]
    low, high = profile_range(rate, None)
    low, high = np.minimum(low, fits.theta[:, rate]), np.maximum(np.maximum(high, fits.theta[:, rate]), low + 1e-6)
    x, w = roots_legendre(NODES)
    nodes = [(low + (high - low) * (1 + a) / 2, np.full(len(fits), math.log(b))) for a, b in zip(x, w)]
    return [(v, u + (GUESS_PRIOR - 1) * np.log1p(-v)) for v, u in nodes] if rate == GUESS else nodes


def marginals(fits, anchor, q_range, t_range, nodes):
    """(q (n, i), t (n, j), probability (n, i, j)) on a grid within the ranges, each a pair of (n,)."""
    i, j = CELLS
    steps = [(np.arange(count) + 0.5) / count for count in CELLS]
    q = q_range[0][:, None] + (q_range[1] - q_range[0])[:, None] * steps[0]
    t = t_range[0][:, None] + (t_range[1] - t_range[0])[:, None] * steps[1]
    n, k = fits.answers.z.shape
    joint = np.empty((n, i, j))
    at_once = max(1, AT_ONCE // (i * j * k))
    for first in range(0, n, at_once):
        rows = slice(first, first + at_once)
        joint[rows] = integrated(fits, rows, anchor, q[rows], t[rows], nodes)
    return q, t, joint / joint.sum(axis=(1, 2), keepdims=True)


def integrated(fits, rows, anchor, q, t, nodes):
    """Likelihood (m, i, j), integrated over the nodes of the rates (guess, lapse), relative to the largest of each set."""
    f = fits.function
    z, yes, total = (a[rows][:, None, None, :] for a in (fits.answers.z, fits.answers.yes, fits.answers.total))
    total_log = None
    for guess, of_guess in nodes[0]:
        guess = guess[rows][:, None, None, None]
        offset = 0.0 if anchor is None else f.anchor(anchor, guess)
        core = f.core.both(np.clip((z - q[:, :, None, None]) / np.exp(t)[:, None, :, None] + offset, -1e6, 1e6))[0]
        for lapse, of_lapse in nodes[1]:
            a, b = f.rates(guess, lapse[rows][:, None, None, None])
            p = np.clip(a + b * core, LEAST_P, 1 - LEAST_P)
            value = (of_guess + of_lapse)[rows][:, None, None] + (yes * np.log(p) + (total - yes) * np.log1p(-p)).sum(axis=-1)
            total_log = value if total_log is None else np.logaddexp(total_log, value)
    return np.exp(total_log - total_log.max(axis=(1, 2), keepdims=True))


def quantiles(low, high, weights, level):
    """(low, high), each (n,), of the central interval; weights (n, c) belong to c equal cells between low and high (n,)."""
    cumulative = np.concatenate([np.zeros((len(weights), 1)), np.cumsum(weights, axis=1)], axis=1)
    cumulative /= cumulative[:, -1:]
    edges = np.linspace(0, 1, weights.shape[1] + 1)
    return tuple(low + (high - low) * np.array([np.interp(at, c, edges) for c in cumulative]) for at in ((1 - level) / 2, (1 + level) / 2))


def credible(fits, which, anchor, level, profile_range):
    """(low, high) of q or of t on the axis of the fit. profile_range(which, anchor) returns their profile interval of level WIDE."""
    low, high, weights = posterior_of(fits, anchor, profile_range)[which]
    return quantiles(low, high, weights, level)


def posterior_of(fits, anchor, profile_range):
    """{Q or T: (low (n,), high (n,), weights (n, c)) of its marginal posterior}. The parameters of a fit share them, so each is computed once."""
    def shared(key, compute):
        if key not in fits.posteriors:
            fits.posteriors[key] = compute()
        return fits.posteriors[key]

    def profile_of(which, of_anchor):
        return shared((which, of_anchor), lambda: profile_range(which, of_anchor))

    def compute():
        q_range, t_range = ([np.clip(end, *limits) for end in profile_of(w, a)] for w, a, limits in
                            ((Q, anchor, (-4.0, 4.0)), (T, None, tuple(math.log(s) for s in SPREAD))))
        t_range = [np.minimum(t_range[0], t_range[1] - 1e-3), t_range[1]]
        nodes = [rate_nodes(fits, rate, profile_of) for rate in (GUESS, LAPSE)]
        _, _, joint = marginals(fits, anchor, q_range, t_range, nodes)
        return {Q: (*q_range, joint.sum(axis=2)), T: (*t_range, joint.sum(axis=1))}

    return shared(anchor, compute)
