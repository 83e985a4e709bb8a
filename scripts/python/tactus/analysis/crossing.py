"""The severity at which a worsening, made non-decreasing, crosses a margin."""
import numpy as np


def isotonic(values, weights):
    """(K, B) columns made non-decreasing along K by weighted least squares (Barlow et al. 1972, the max-min formula); weights: (K,)."""
    k = len(weights)
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values * weights[:, None], axis=0)])
    mass = np.concatenate([[0.0], np.cumsum(weights)])
    out = np.empty_like(values)
    # least[i] at j: the smallest mean of i..j' over j' >= j; out[j] = max over i <= j.
    best = np.full((k, values.shape[1]), -np.inf)
    for i in range(k):
        means = (sums[i + 1:] - sums[i]) / (mass[i + 1:] - mass[i])[:, None]
        least = np.minimum.accumulate(means[::-1], axis=0)[::-1]
        best[i:] = np.maximum(best[i:], least)
    out[:] = best
    return out


def crossing(severities, worsening, weights, margin, at_zero=0.0):
    """(B,) severities at which the worsening (K, B), made non-decreasing, first reaches the margin; infinite: it does not.

    severities: (K,) ascending, above 0. at_zero: (B,) worsening at severity 0; 0 by definition if that is the baseline itself. Interpolates linearly
    between the severities."""
    severities = np.concatenate([[0.0], severities])
    begin = np.broadcast_to(at_zero, worsening.shape[1:])[None]
    curve = np.concatenate([begin, np.maximum(isotonic(worsening, np.asarray(weights, dtype=float)), begin)])
    reached = curve >= margin
    first = np.argmax(reached, axis=0)
    never = ~reached.any(axis=0)
    b = np.arange(worsening.shape[1])
    before = np.maximum(first - 1, 0)
    rise = curve[first, b] - curve[before, b]
    part = np.divide(margin - curve[before, b], rise, out=np.ones_like(rise), where=rise > 0)
    at = severities[before] + part * (severities[first] - severities[before])
    return np.where(never, np.inf, np.where(first == 0, 0.0, at))
