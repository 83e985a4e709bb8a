"""A smooth, monotone curve over the level of a degradation, without an assumed form, and the levels at which it is worse by a margin.

The values at the levels are measurements with a known covariance of a Gaussian process with a Matern kernel of order 5/2 (Rasmussen and Williams 2006,
Gaussian Processes for Machine Learning, sections 2.2, 4.2 and 5.4). The squared exponential kernel is too smooth: its intervals hold the truth in 85 to 93 %
(tests/measure/measure_coverage). Lengths and scales of the kernel are averaged over, weighted by their marginal likelihood.
Draws of the process are projected to monotone curves (Lin and Dunson 2014, Biometrika 101:303). Straight lines between the levels instead are biased
by the curvature, and their intervals hold the truth less often the more games are played.
"""
import functools
import math

import numpy as np
from scipy.special import expit

DRAWS = 1000  # Efron and Tibshirani 1993, section 12.5: at least 1000 for the ends of an interval
GRID = 161    # points of a curve; design
LENGTHS = (0.08, 0.15, 0.3, 0.6, 1.2)  # of the kernel, in ranges of the levels; design
SCALES = (1.0, 2.0, 4.0, 8.0)          # of the kernel, in units of the values; design
MEAN_SD = 3.0  # prior standard deviation of the mean, in the same units; design
JITTER = 1e-8  # share of the variance that keeps a covariance invertible; design
WIDE = 10.0    # largest over smallest level above which levels count by their logarithm; design


def axis_of(levels):
    """(function from levels to positions, its inverse): 0 stays 0; logarithmic if the levels span more than WIDE."""
    positive = levels[levels > 0]
    least, most = float(positive.min()), float(positive.max())
    if most <= WIDE * least:
        return lambda x: x / most, lambda u: u * most
    top = np.log1p(most / least)
    return lambda x: np.log1p(x / least) / top, lambda u: least * np.expm1(u * top)


def logits(yes, total):
    """(values, variances) of the log odds of shares, with half a yes and half a no added (Cox and Snell 1989, section 2.1.6)."""
    yes, no = np.asarray(yes, dtype=float) + 0.5, np.asarray(total, dtype=float) - yes + 0.5
    return np.log(yes / no), 1 / yes + 1 / no


def matern(distance):
    """The correlation of order 5/2 at a distance in lengths."""
    d = math.sqrt(5) * distance
    return (1 + d + d * d / 3) * np.exp(-d)


class Prior:
    """Covariance of the process at the points of the grid and at the positions. The levels of a study repeat, so each is computed once."""

    def __init__(self, positions, length, scale, unit):
        points = np.concatenate([np.linspace(0, 1, GRID), positions])
        self.of_points = scale**2 * matern(np.abs(points[:, None] - points[None]) / length) + (MEAN_SD * unit) ** 2
        self.whole = self.of_points + JITTER * scale**2 * np.eye(len(points))

    @functools.cached_property
    def upper(self):
        """The transposed root, in the order in which a product with draws is fastest."""
        return np.ascontiguousarray(np.linalg.cholesky(self.whole).T)

    @staticmethod
    @functools.lru_cache(maxsize=4 * len(LENGTHS) * len(SCALES))
    def of(positions, length, scale, unit):
        return Prior(positions, length, scale, unit)


def draws_at(positions, values, covariance, rng, unit=1.0, df=np.inf, draws=DRAWS):
    """(draws, GRID) curves of the process at GRID positions from 0 to 1, by Matheron's rule: draws of the prior, corrected by their distance to the measurements.

    positions (k,): within 0 and 1. values (k,), covariance (k, k): of the measurements. unit: scale of the values, 1 for log odds. df: degrees of freedom
    of the covariance; with few, its size is drawn too."""
    k, kinds = len(positions), [(length, scale * unit) for length in LENGTHS for scale in SCALES]
    priors = [Prior.of(tuple(positions), length, scale, unit) for length, scale in kinds]
    logs = np.empty(len(kinds))
    for i, ((_, scale), prior) in enumerate(zip(kinds, priors)):
        root = np.linalg.cholesky(prior.of_points[GRID:, GRID:] + covariance + JITTER * scale**2 * np.eye(k))
        logs[i] = -0.5 * np.sum(np.linalg.solve(root, values) ** 2) - np.log(np.diag(root)).sum()
    weights = np.exp(logs - logs.max())
    made = []
    noise = np.linalg.cholesky(covariance + 1e-12 * unit**2 * np.eye(k))
    for prior, n in zip(priors, rng.multinomial(draws, weights / weights.sum())):
        if not n:
            continue
        whole = prior.whole
        drawn = rng.standard_normal((n, len(whole))) @ prior.upper
        size = np.ones(n) if np.isinf(df) else df / rng.chisquare(df, n)
        missed = values - drawn[:, GRID:] - np.sqrt(size)[:, None] * (rng.standard_normal((n, k)) @ noise.T)
        inner = whole[None, GRID:, GRID:] + size[:, None, None] * covariance
        made.append(drawn[:, :GRID] + np.linalg.solve(inner, missed[:, :, None])[:, :, 0] @ whole[GRID:, :GRID])
    return np.concatenate(made)


def falling(curves):
    """Curves (n, g), made non-increasing: the mean of the largest such curve below and the smallest above."""
    below = np.minimum.accumulate(curves, axis=1)
    above = np.maximum.accumulate(curves[:, ::-1], axis=1)[:, ::-1]
    return (below + above) / 2


class Worsening:
    """Draws of a monotone worsening. positions (GRID,) severities; curves (draws, GRID): the worsening, which rises, relative to `reference`."""

    def __init__(self, positions, curves, reference):
        self.positions, self.curves = positions, curves - reference[:, None]

    def crossing(self, margin):
        """(draws,) severities at which the worsening first reaches the margin; infinite: it does not; 0: at severity 0."""
        reached = self.curves >= margin
        first, b = np.argmax(reached, axis=1), np.arange(len(self.curves))
        before = np.maximum(first - 1, 0)
        rise = self.curves[b, first] - self.curves[b, before]
        part = np.divide(margin - self.curves[b, before], rise, out=np.ones_like(rise), where=rise > 0)
        at = self.positions[before] + part * (self.positions[first] - self.positions[before])
        return np.where(reached.any(axis=1), np.where(first == 0, 0.0, at), np.inf)


def of_shares(severities, values, covariance, rng, df=np.inf, reference=None, draws=DRAWS):
    """Worsening of a share that falls: log odds at the severities, ascending. reference: (draws,) share to compare with; None: the share at severity 0."""
    to, back = axis_of(severities)
    shares = expit(falling(draws_at(to(severities), values, covariance, rng, df=df, draws=draws)))
    return Worsening(back(np.linspace(0, 1, GRID)), -shares, -(shares[:, 0] if reference is None else reference))


def of_values(severities, values, covariance, rng, unit, df=np.inf, reference=None, draws=DRAWS):
    """Worsening of a value that rises, such as the logarithm of a time. unit: its scale."""
    to, back = axis_of(severities)
    curves = -falling(-draws_at(to(severities), values, covariance, rng, unit, df, draws))
    return Worsening(back(np.linspace(0, 1, GRID)), curves, curves[:, 0] if reference is None else reference)
