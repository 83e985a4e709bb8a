"""Judgements of synchrony and order by two independent channels (Garcia-Perez and Alcala-Quintana 2012, Psychonomic Bulletin & Review 19:820).

The latency of each sense is exponential, with means mean_a and mean_b. The second arrives d = SOA + tau + latency_b - latency_a after the first, and both
are judged together if |d| is at most delta. So the window is asymmetric, and its peak may lie far below 1 without any lapse. delta is a criterion, the
means are sensitivity. The PSS is the maximum of the curve. Times in the unit of the levels.
"""
import dataclasses
import math

import numpy as np
from scipy.optimize import brentq, minimize, minimize_scalar

ERROR = 0.06     # largest rate of wrong keys: Wichmann and Hill 2001, as of lapses
DRAWS = 200      # of the bootstrap of an interval; design
FARTHEST = 10.0  # distance from the peak at which the edges are searched, in spans of the levels; design
WINDOW = 0.75    # share of the peak
VALUES = ("pss", "low75", "high75", "window75")


def cumulative(d, soa, mean_a, mean_b, tau):
    """(probability that the difference of arrival is at most d, their equation 4; its derivatives by log mean_a, log mean_b and d)."""
    a, b = 1 / mean_a, 1 / mean_b
    x = d - np.asarray(soa, dtype=float) - tau
    before = x <= 0
    tail = np.exp(np.where(before, a, -b) * x)
    value = np.where(before, b / (a + b) * tail, 1 - a / (a + b) * tail)
    by_a = np.where(before, b * tail * (x * (a + b) - 1), -b * tail) / (a + b) ** 2
    by_b = np.where(before, a * tail, a * tail * (1 + x * (a + b))) / (a + b) ** 2
    return value, -a * by_a, -b * by_b, a * b / (a + b) * tail


def probabilities(soa, mean_a, mean_b, tau, delta):
    """(b first, together, a first) at asynchronies t(b) - t(a)."""
    below, above = (cumulative(d, soa, mean_a, mean_b, tau)[0] for d in (-delta, delta))
    return below, above - below, 1 - above


def together_and_slopes(soa, theta):
    """(share of the answer "together" (k,), its derivatives (k, 6) by theta) with theta as in searched()."""
    mean_a, mean_b, tau, delta, missed, false = math.exp(theta[0]), math.exp(theta[1]), theta[2], math.exp(theta[3]), theta[4], theta[5]
    low, high = cumulative(-delta, soa, mean_a, mean_b, tau), cumulative(delta, soa, mean_a, mean_b, tau)
    p, size = high[0] - low[0], 1 - missed - false
    by = [size * (high[1] - low[1]), size * (high[2] - low[2]), -size * (high[3] - low[3]), size * delta * (high[3] + low[3]), -p, 1 - p]
    return false + size * p, np.stack(by, axis=1)


@dataclasses.dataclass
class Fit:
    """params: mean_a, mean_b, tau, delta, missed (together, but answered apart), false (apart, but answered together). values: pss, low75, high75, window75,
    peak. intervals: {name: (low, high)}, 95 %, or {} if they were not asked for."""
    params: dict
    values: dict
    log_likelihood: float
    intervals: dict = dataclasses.field(default_factory=dict)

    @property
    def aic(self):
        return 2 * len(self.params) - 2 * self.log_likelihood


def together(soa, params):
    """Share of the answer "together", wrong keys included."""
    p = probabilities(soa, params["mean_a"], params["mean_b"], params["tau"], params["delta"])[1]
    return params["false"] + (1 - params["missed"] - params["false"]) * p


def log_likelihood(p, yes, total):
    p = np.clip(p, 1e-10, 1 - 1e-10)
    return float(np.sum(yes * np.log(p) + (total - yes) * np.log1p(-p)))


def named(theta, span):
    return {"mean_a": span * math.exp(theta[0]), "mean_b": span * math.exp(theta[1]), "tau": span * theta[2], "delta": span * math.exp(theta[3]), "missed": theta[4],
            "false": theta[5]}


def searched(levels, yes, total, starts):
    """(theta of the maximum, on an axis where the levels span 1; log likelihood)."""
    x = levels / (float(np.ptp(levels)) or 1.0)
    bounds = [(math.log(1e-3), math.log(3.0))] * 2 + [(-2.0, 2.0), (math.log(1e-3), math.log(3.0)), (0.0, ERROR), (0.0, ERROR)]

    def cost(theta):
        p, by = together_and_slopes(x, theta)
        p = np.clip(p, 1e-10, 1 - 1e-10)
        return -log_likelihood(p, yes, total), -((yes - total * p) / (p * (1 - p))) @ by

    found = min((minimize(cost, start, jac=True, method="L-BFGS-B", bounds=bounds, options={"ftol": 1e-10}) for start in starts), key=lambda r: r.fun)
    return found.x, -float(found.fun)


def values_of(params, levels):
    """{pss, low75, high75, window75, peak} of the curve."""
    span, f = float(np.ptp(levels)) or 1.0, lambda x: float(probabilities(x, params["mean_a"], params["mean_b"], params["tau"], params["delta"])[1])
    around = -params["tau"] + span * np.linspace(-1, 1, 401)
    first = around[int(np.argmax(probabilities(around, params["mean_a"], params["mean_b"], params["tau"], params["delta"])[1]))]
    pss = float(minimize_scalar(lambda x: -f(x), bounds=(first - span / 200, first + span / 200), method="bounded", options={"xatol": 1e-9 * span}).x)
    peak, edge = f(pss), lambda x: f(x) - WINDOW * f(pss)
    low, high = brentq(edge, pss - FARTHEST * span, pss), brentq(edge, pss, pss + FARTHEST * span)
    return {"pss": pss, "low75": low, "high75": high, "window75": high - low, "peak": peak}


def fit(levels, yes, total, rng=None):
    """Fit to answers "together": yes of total at levels (k,). rng: also computes intervals, percentiles of refits to answers drawn from the fit, corrected for
    bias (Efron 1987, JASA 82:171)."""
    levels, yes, total = (np.asarray(a, dtype=float) for a in (levels, yes, total))
    centre = float(np.average(levels, weights=yes + 1e-9) / (np.ptp(levels) or 1.0))
    starts = [[math.log(a), math.log(b), -centre, math.log(d), 0.01, 0.01] for a, b in ((0.05, 0.05), (0.15, 0.05), (0.05, 0.15), (0.15, 0.15)) for d in (0.1, 0.25)]
    best, value = searched(levels, yes, total, starts)
    params = named(best, float(np.ptp(levels)) or 1.0)
    made = Fit(params, values_of(params, levels), value)
    if rng is not None:
        p = np.clip(together(levels, params), 0, 1)
        drawn = []
        for _ in range(DRAWS):
            again, _ = searched(levels, rng.binomial(total.astype(int), p).astype(float), total, [best])
            drawn.append(values_of(named(again, float(np.ptp(levels)) or 1.0), levels))
        made.intervals = {name: corrected([d[name] for d in drawn], made.values[name]) for name in VALUES}
    return made


def corrected(drawn, estimate, level=0.95):
    """(low, high) percentiles of draws, corrected for the bias of their median."""
    from scipy.special import ndtr, ndtri
    drawn = np.asarray(drawn)
    share = (np.count_nonzero(drawn < estimate) + 0.5 * np.count_nonzero(drawn == estimate)) / len(drawn)
    bias = float(ndtri(np.clip(share, 1 / len(drawn), 1 - 1 / len(drawn))))
    ends = ndtr(2 * bias + ndtri([(1 - level) / 2, (1 + level) / 2]))
    return tuple(float(v) for v in np.quantile(drawn, ends))
