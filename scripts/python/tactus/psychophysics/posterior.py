"""Credible intervals: integrates the likelihood over a grid (Kuss, Jaekel and Wichmann 2005, Journal of Vision 5(5):8; Schuett et al. 2016, Vision
Research 122:105).

Priors: flat over the location (or the derived point), flat over the logarithm of the spread within SPREAD, flat over the lapse rate within its bounds,
Beta(1, 10) over a fitted guess rate. For a location and a scale these priors give intervals with the nominal coverage (Welch and Peers 1963, JRSS B
25:318). Grid and nodes cover the wide profile interval, so that they resolve the narrow likelihood of many trials.

Answers may be over-dispersed (overdispersion.py): then the likelihood is beta-binomial, and it is integrated over eta, the root of the correlation of two answers, with the
prior Beta(1, b) on eta (Schuett et al. 2016, who use b = 10). The intervals then include the uncertainty of the dispersion.
"""
import functools
import math

import numpy as np
from scipy import sparse
from scipy.special import gammaln, roots_legendre

from tactus.psychophysics.functions import GUESS_PRIOR, within
from tactus.psychophysics.likelihood import GUESS, LAPSE, LEAST_P, Q, T

SPREAD = (0.01, 0.9)       # in spans of the levels: 3.3 spreads (5 to 95 %) are at most three spans (Schuett et al. 2016); the lower end resolves a step
CELLS = (49, 33)           # of the grid over location and spread; design
NODES, WIDE_NODES = 6, 9   # of each rate, at most 1.3 standard deviations apart, also in the wider range of over-dispersed answers; design
WIDE = 0.9998              # level of the profile interval that grid and nodes span; design
AT_ONCE = 3_000_000        # probabilities in memory; design
ETA_MOST, ETA_NODES = 0.75, 10  # eta of the integral, from 0; its Gauss-Legendre nodes; design
LOGITS = np.linspace(-14, 14, 1401)  # of the probabilities of a table, between which its entries are linear; design


@functools.lru_cache
def legendre(count):
    """(nodes, weights), each (count,), of Gauss-Legendre quadrature."""
    return roots_legendre(count)


def rate_nodes(fits, rate, profile_range):
    """[(values (n,), log weights (n,))] of one rate: Gauss-Legendre nodes within its profile interval, which is narrow for many trials; one node for a
    fixed rate."""
    if not fits.free[rate]:
        return [(fits.theta[:, rate], np.zeros(len(fits)))]
    low, high = profile_range(rate, None)
    low, high = np.minimum(low, fits.theta[:, rate]), np.maximum(np.maximum(high, fits.theta[:, rate]), low + 1e-6)
    x, w = legendre(WIDE_NODES if fits.eta_prior else NODES)
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


def eta_nodes(prior):
    """(eta (e,), log weights (e,)) of the prior Beta(1, prior)."""
    x, w = legendre(ETA_NODES)
    eta = ETA_MOST * (1 + x) / 2
    return eta, np.log(w) + (prior - 1) * np.log1p(-eta)


def beta_binomial_tables(eta, yes, total):
    """(e, c, u) log likelihood of c pairs of counts (c,) at the probabilities of LOGITS. eta^2 = 1 / (nu + 1) is the correlation of two answers; nu p and
    nu (1 - p) are the parameters of the beta distribution."""
    p = 1 / (1 + np.exp(-LOGITS))
    nu = (1 / eta**2 - 1)[:, None, None]
    yes, total, a, b = yes[:, None], total[:, None], nu * p, nu / (1 + np.exp(LOGITS))
    return gammaln(yes + a) - gammaln(a) + gammaln(total - yes + b) - gammaln(b) - gammaln(total + nu) + gammaln(nu)


class OverDispersedAnswers:
    """Log likelihood of answers (m, k), for nodes of eta (e,) and their log weights (e,)."""

    def __init__(self, yes, total, eta, log_weights):
        self.log_weights = log_weights
        pairs, index = np.unique(np.stack([yes.ravel(), total.ravel()], axis=1), axis=0, return_inverse=True)
        tables = beta_binomial_tables(eta, pairs[:, 0], pairs[:, 1])
        # One row for each entry of a table, with the values of all nodes.
        self.tables = np.ascontiguousarray(np.moveaxis(tables, 0, -1)).reshape(-1, len(eta))
        # The last row of a table has no next one; no share falls on it.
        self.rises = np.diff(self.tables, axis=0, append=self.tables[-1:])
        self.first_row = (index.reshape(yes.shape) * len(LOGITS)).astype(np.int32)[:, None, None, :]

    def integrated(self, p):
        """(m, i, j) for probabilities (m, i, j, k), which likelihood.LEAST_P keeps from 0 and 1."""
        place = np.log(p / (1 - p))
        place -= LOGITS[0]
        place /= LOGITS[1] - LOGITS[0]
        place = within(place, 0, len(LOGITS) - 1.001)
        if not math.isfinite(place.sum()):  # the sparse product does not check its indices
            raise ValueError("a probability of the posterior is not a number; the fit did not converge")
        low = place.astype(np.int32)
        place -= low
        low += self.first_row
        # Interpolation and the sum over the counts are two products with sparse matrices that have an entry for each count.
        cells, each = math.prod(p.shape[:-1]), p.shape[-1]
        starts = np.arange(0, cells * each + 1, each, dtype=np.int32)

        def sum_of(tables, shares):
            return sparse.csr_matrix((shares.ravel(), low.ravel(), starts), shape=(cells, len(tables)), copy=False) @ tables

        values = sum_of(self.tables, np.ones(low.shape)) + sum_of(self.rises, place)
        values += self.log_weights
        most = values.max(axis=1)
        values -= most[:, None]
        return (most + np.log(np.exp(values, out=values).sum(axis=1))).reshape(p.shape[:-1])


def integrated(fits, rows, anchor, q, t, nodes):
    """Likelihood (m, i, j), integrated over the nodes of the rates (guess, lapse), relative to the largest of each set."""
    f = fits.function
    z, yes, total = (a[rows][:, None, None, :] for a in (fits.answers.z, fits.answers.yes, fits.answers.total))
    total_log = None
    dispersed = OverDispersedAnswers(fits.answers.yes[rows], fits.answers.total[rows], *eta_nodes(fits.eta_prior)) if fits.eta_prior else None
    for guess, of_guess in nodes[0]:
        guess = guess[rows][:, None, None, None]
        offset = 0.0 if anchor is None else f.anchor(anchor, guess)
        core = f.core.both(within((z - q[:, :, None, None]) / np.exp(t)[:, None, :, None] + offset, -1e6, 1e6))[0]
        for lapse, of_lapse in nodes[1]:
            a, b = f.rates(guess, lapse[rows][:, None, None, None])
            p = within(a + b * core, LEAST_P, 1 - LEAST_P)
            of_answers = dispersed.integrated(p) if dispersed else (yes * np.log(p) + (total - yes) * np.log1p(-p)).sum(axis=-1)
            value = (of_guess + of_lapse)[rows][:, None, None] + of_answers
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
        q_range, t_range = ([within(end, *limits) for end in profile_of(w, a)] for w, a, limits in
                            ((Q, anchor, (-4.0, 4.0)), (T, None, tuple(math.log(s) for s in SPREAD))))
        t_range = [np.minimum(t_range[0], t_range[1] - 1e-3), t_range[1]]
        nodes = [rate_nodes(fits, rate, profile_of) for rate in (GUESS, LAPSE)]
        _, _, joint = marginals(fits, anchor, q_range, t_range, nodes)
        return {Q: (*q_range, joint.sum(axis=2)), T: (*t_range, joint.sum(axis=1))}

    return shared(anchor, compute)
