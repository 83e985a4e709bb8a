"""Which property of a player decides a limit: total Sobol indices from a polynomial of second degree in the normal scores of the properties.

The polynomial has orthonormal Hermite terms, so the squares of its coefficients are shares of variance (Sudret 2008, Reliability Engineering and System Safety 93:964). Its
quality is the share of the variance of left-out players that it explains (Q2). The players passed checks, so their properties are only nearly independent, and
the indices only nearly add up.
"""
import itertools
import math

import numpy as np
from scipy import stats


def normal_scores(values):
    """Normal quantiles of the ranks (Blom 1958)."""
    ranks = stats.rankdata(values)
    return stats.norm.ppf((ranks - 0.375) / (len(values) + 0.25))


def terms(count):
    """[(exponent of each of `count` properties)] of the monomials up to the second degree, without the constant."""
    return [powers for powers in itertools.product(range(3), repeat=count) if 0 < sum(powers) <= 2]


def design(scores):
    """Orthonormal Hermite polynomials [player, term] of scores [player, property]."""
    basis = (np.ones_like(scores), scores, (scores**2 - 1) / math.sqrt(2))
    return np.stack([np.prod([basis[p][:, i] for i, p in enumerate(powers)], axis=0) for powers in terms(scores.shape[1])], axis=1)


def total_indices(properties, limits):
    """({property: total index}, Q2) of finite limits of players. properties: {name: values}. (None, nan) when the limits do not vary."""
    names = list(properties)
    y = np.log(np.asarray(limits, dtype=float))
    if len(y) < 4 * len(terms(len(names))) or y.std() < 1e-9:
        return None, math.nan
    x = np.column_stack([np.ones(len(y)), design(np.column_stack([normal_scores(properties[name]) for name in names]))])
    coefficients, *_ = np.linalg.lstsq(x, y, rcond=None)
    hat = np.einsum("ij,ji->i", x, np.linalg.pinv(x))
    left_out = (y - x @ coefficients) / np.maximum(1 - hat, 1e-9)
    squares = coefficients[1:] ** 2
    total = {name: float(sum(s for s, powers in zip(squares, terms(len(names))) if powers[i]) / squares.sum()) for i, name in enumerate(names)}
    return total, float(1 - np.mean(left_out**2) / y.var())
