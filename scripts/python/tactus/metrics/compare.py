"""Differences of two signals or pictures. Arrays in, numbers out; no file, no clock.

Signals are arrays of n samples, or of n samples in several axes, at the same instants.
"""
import numpy as np

# Bounds of a just noticeable difference of force, as in scripts/python/tactus/rerender/compare.py: Weber fraction and floor.
JND, JND_FLOOR_N = 0.10, 0.5
# Of the map from force to sensation: force of the logarithmic law, N, and exponent of the power law (design; the constants of the published measure were not
# available, so its name is "like").
LOG_N, POWER = 0.1, 0.8
# Of ETVO-like: cost of a change of the lag by one sample, in squared units of signals with a range of about one (design).
LAG_COST = 0.002
WINDOW, HOP = 64, 32  # samples of a window of hssim_like
SSIM_SIDE = 8         # pixels of a window of a picture


def rows(signal):
    """The signal as an array (n, axes)."""
    signal = np.asarray(signal, dtype=float)
    return signal[:, None] if signal.ndim == 1 else signal


def rmse(reference, other):
    """Root of the mean squared distance, in the unit of the signals; 0 for empty ones."""
    apart = rows(other) - rows(reference)
    return float(np.sqrt(np.mean(np.sum(apart ** 2, axis=1)))) if len(apart) else 0.0


def jnd_tube(reference, other, fraction=JND, floor=0.0):
    """Share of the samples outside the tube |other - reference| <= fraction max(|reference|, floor)."""
    apart, size = np.linalg.norm(rows(other) - rows(reference), axis=1), np.linalg.norm(rows(reference), axis=1)
    return float(np.mean(apart > fraction * np.maximum(size, floor))) if len(apart) else 0.0


def etvo_like(reference, other, rate_hz, max_lag_s=0.2, lag_cost=LAG_COST):
    """Errors of time and of value apart, after the idea of ETVO (Kroep, Gokhale, Verburg and Prasad 2020): the path of lags l, at most max_lag_s, that minimises
    the sum of (reference[i] - other[i + l[i]])^2 + lag_cost |l[i] - l[i-1]|, with steps of at most one sample, a free begin and a free end.

    Returns {"time_ms": mean lag, "time_median_ms", "time_variation": sum of the changes of the lag over the duration, s/s, "value": RMS of the residual}. lag_cost has
    the squared unit of the signals: divide both by the RMS of the reference first, unless that is about one.
    """
    x, y = rows(reference), rows(other)
    n, lags = len(x), int(round(max_lag_s * rate_hz)) + 1
    if n == 0:
        return {"time_ms": 0.0, "time_median_ms": 0.0, "time_variation": 0.0, "value": 0.0}
    lags = min(lags, n)
    step = np.zeros((n, lags), dtype=np.int8)  # lag of the sample before, minus this lag
    ends = np.full(n, np.inf)                  # mean cost of a path that ends at sample i, at the last sample of other
    padded = np.concatenate([y, np.full((lags, y.shape[1]), np.inf)])
    distance = lambda i: np.sum((x[i] - padded[i:i + lags]) ** 2, axis=1)
    cost = distance(0)
    for i in range(n):
        if i > 0:
            same, shorter, longer = cost, np.append(np.inf, cost[:-1]) + lag_cost, np.append(cost[1:], np.inf) + lag_cost
            choice = np.argmin([same, shorter, longer], axis=0)
            step[i] = np.array([0, -1, 1], dtype=np.int8)[choice]
            cost = np.choose(choice, [same, shorter, longer]) + distance(i)
        last = n - 1 - i  # the lag with which this sample meets the end of other
        if last < lags:
            ends[i] = cost[last] / (i + 1)
    end = int(np.argmin(ends))
    path = np.zeros(end + 1, dtype=int)
    lag = n - 1 - end
    for i in range(end, -1, -1):
        path[i] = lag
        lag += step[i, lag]
    residual = x[:end + 1] - y[np.arange(end + 1) + path]
    return {"time_ms": float(path.mean() / rate_hz * 1e3), "time_median_ms": float(np.median(path) / rate_hz * 1e3),
            "time_variation": float(np.abs(np.diff(path)).sum() / (end + 1)), "value": float(np.sqrt(np.mean(np.sum(residual ** 2, axis=1))))}


def sensation(force_n, law="log"):
    """A signed force as sensation: ln(1 + |f|/LOG_N) ("log") or |f|^POWER ("power"), with the sign of the force."""
    size = np.abs(force_n)
    return np.sign(force_n) * (np.log1p(size / LOG_N) if law == "log" else size ** POWER)


def similarity(x, y, reach, axis):
    """SSIM (Wang, Bovik, Sheikh and Simoncelli 2004) of windows along the axes, with uniform weights; reach: range of the values."""
    c1, c2 = (0.01 * reach) ** 2, (0.03 * reach) ** 2
    mx, my = x.mean(axis=axis), y.mean(axis=axis)
    vx, vy = x.var(axis=axis), y.var(axis=axis)
    both = (x * y).mean(axis=axis) - mx * my
    return (2 * mx * my + c1) * (2 * both + c2) / ((mx ** 2 + my ** 2 + c1) * (vx + vy + c2))


def hssim_like(reference, other, law="log"):
    """Mean SSIM of windows of the sensation of two forces, 1 for equal ones: like HSSIM (Hassen and Steinbach 2018), with our map and constants. Signals of
    several axes: the mean over the axes that have a force. It rates a delay of 20 ms better than a deadband of 5 %, so use it beside etvo_like."""
    found = []
    for x, y in zip(sensation(rows(reference), law).T, sensation(rows(other), law).T):
        if not x.any() and not y.any():
            continue
        reach = max(x.max(), y.max()) - min(x.min(), y.min())
        starts = np.arange(0, max(1, len(x) - WINDOW + 1), HOP)
        index = starts[:, None] + np.arange(min(WINDOW, len(x)))
        found.append(similarity(x[index], y[index], reach, 1).mean() if reach > 0 else 1.0)
    return float(np.mean(found)) if found else 1.0


def ssim_picture(reference, other):
    """Mean SSIM of two grey pictures of values 0 .. 255, in windows of SSIM_SIDE pixels that do not overlap; 1 for equal ones."""
    height, width = (n // SSIM_SIDE * SSIM_SIDE for n in reference.shape[:2])
    tiles = lambda p: np.asarray(p, dtype=float)[:height, :width].reshape(height // SSIM_SIDE, SSIM_SIDE, width // SSIM_SIDE, SSIM_SIDE)
    return float(similarity(tiles(reference), tiles(other), 255, (1, 3)).mean()) if height and width else 1.0
