"""Limits of players: the level at which a curve over levels passes a margin, and their distribution over the players."""
import math

import numpy as np
from scipy import stats

BELOW, ABOVE = 0.0, math.inf  # severities of a limit below the mildest level, and of one that no level reaches
CONFIDENCE = 0.95
ROUNDING = 1e-9


def rising(curve):
    """The least-squares fit that never falls to values over levels from mild to severe: pool adjacent violators (Ayer et al. 1955)."""
    pools = []  # [mean, count]
    for value in curve:
        pools.append([float(value), 1])
        while len(pools) > 1 and pools[-2][0] > pools[-1][0]:
            mean, count = pools.pop()
            pools[-1] = [(pools[-1][0] * pools[-1][1] + mean * count) / (pools[-1][1] + count), pools[-1][1] + count]
    return np.concatenate([np.full(count, mean) for mean, count in pools])


def crossing(levels, curve, margin):
    """The level from mild to severe at which a curve that never falls reaches a margin, linear over the logarithm of the level; BELOW: the mildest level exceeds it;
    ABOVE: no level reaches it."""
    fitted = rising(curve)
    reached = np.flatnonzero(fitted >= margin - ROUNDING)
    if not len(reached):
        return ABOVE
    i = reached[0]
    if i == 0:
        return BELOW
    share = min(1.0, (margin - fitted[i - 1]) / (fitted[i] - fitted[i - 1]))
    return float(levels[i - 1] * (levels[i] / levels[i - 1]) ** share)


def severities(found, levels):
    """The limits as numbers that grow with the level that is tolerated: for levels that fall towards a severe one, 1/level."""
    falls = levels[-1] < levels[0]
    return np.array([value if value in (BELOW, ABOVE) or not falls else 1 / value for value in found])


def at_quantile(found, levels, share):
    """The limit below which this share of the players lies: the smallest limit with at least this share at or below it."""
    order = np.argsort(severities(found, levels), kind="stable")
    return float(np.asarray(found)[order[min(len(order) - 1, max(0, math.ceil(share * len(order)) - 1))]])


def median_interval(found, levels):
    """(low, high) of the median over the players with at least 95 %: order statistics, without an assumption about the distribution (Conover 1999, section 3.2)."""
    n = len(found)
    rank = int(stats.binom.ppf((1 - CONFIDENCE) / 2, n, 0.5))
    order = np.asarray(found)[np.argsort(severities(found, levels), kind="stable")]
    low = max(0, rank - 1)
    return float(order[low]), float(order[n - 1 - low])


def tolerated(limit, other, levels):
    """Compares two limits: the ratio of the tolerated severities limit / other; nan: both are outside the levels on the same side."""
    a, b = severities([limit, other], levels)
    if a == b and a in (BELOW, ABOVE):
        return math.nan
    if a in (BELOW, ABOVE) or b in (BELOW, ABOVE):
        return math.inf if a > b else 0.0
    return float(a / b)
