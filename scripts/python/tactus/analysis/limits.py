"""Limits of the degradation of one sense: L_detect, L_appear and L_break of an operator, and their ratio.

  L_detect  noticed                  detection.py: 75 % detected, or the edge of the window in which the senses are judged synchronous
  L_appear  a felt property changes  appearance.py: the property differs by more than its JND
  L_break   the task suffers         here: success or time is worse than undegraded by the study's margin

L_break is the level at which the worsening, made non-decreasing over the played levels and interpolated linearly, reaches the margin. Its interval comes
from a joint bootstrap of the levels and the baseline.
"""
import dataclasses

import numpy as np

from tactus.analysis import resampling
from tactus.analysis.crossing import crossing
from tactus.analysis.operators import Factor


EITHER = "either"  # by success or by time, the earlier of both


@dataclasses.dataclass
class Limit:
    """One limit of one factor. value, low, high: levels in the factor's unit; infinite: not reached up to `up_to`; 0: reached when nothing is degraded."""
    kind: str  # detect, appear, break
    factor: Factor
    by: str  # criterion: success, time, either; the pair of senses; the property
    value: float
    low: float
    high: float
    up_to: float
    draws: np.ndarray  # severities
    observer: str
    n: int
    participant: str = ""  # "" = all together

    @property
    def reached(self):
        return np.isfinite(self.value)


def from_draws(kind, factor, by, point, draws, up_to, observer, n):
    """A Limit from a severity and its draws."""
    low, high = resampling.interval(draws)
    def at(s):
        if not np.isfinite(s):
            return float(s)
        return factor.level(s) if np.isfinite(factor.level(s)) else 0.0  # a rate is undegraded at infinity, but an infinite limit means "not reached"
    return Limit(kind, factor, by, at(float(point)), at(low), at(high), factor.level(up_to), draws, observer, n)


def series(cells, factor):
    """Cells of this factor alone, by severity."""
    mine = [cell for degraded, cell in cells.items() if len(degraded) == 1 and degraded[0][0] == factor]
    return sorted(mine, key=lambda cell: factor.severity(cell.achieved))


def factors_of(cells):
    """Factors with levels that were played without another degradation."""
    return sorted({degraded[0][0] for degraded in cells if len(degraded) == 1 and not degraded[0][0].removal})


def break_limits(cells, factor, margins, observer):
    """[Limit] by success, by time, and by whichever comes first."""
    baseline, mine = cells[()], series(cells, factor)
    severities = np.array([factor.severity(cell.achieved) for cell in mine])
    weights = np.array([cell.n for cell in mine], dtype=float)
    n = int(weights.sum()) + baseline.n

    def both(of_cell, of_baseline):
        shares = np.stack([of_baseline[:, 0] - d[:, 0] for d in of_cell])
        times = np.stack([d[:, 1] / of_baseline[:, 1] - 1 for d in of_cell])
        return crossing(severities, shares, weights, margins[0]), crossing(severities, times, weights, margins[1] - 1)

    points = both([np.array([[cell.share, cell.mean_time_s]]) for cell in mine], np.array([[baseline.share, baseline.mean_time_s]]))
    whole = ~np.isnan(np.stack([d.draws[:, 0] for d in [*mine, baseline]])).any(axis=0)
    draws = both([cell.draws[whole] for cell in mine], baseline.draws[whole])
    up_to = float(severities.max())
    make = lambda by, point, draw: from_draws("break", factor, by, point, draw, up_to, observer, n)
    return [make("success", points[0][0], draws[0]), make("time", points[1][0], draws[1]),
            make(EITHER, min(points[0][0], points[1][0]), np.minimum(*draws))]


@dataclasses.dataclass
class Ratio:
    """L_break / L_detect, a ratio of severities: above 1, the degradation is noticed before it harms the task."""
    upper: Limit
    lower: Limit
    value: float
    low: float
    high: float


def ratio(upper, lower, rng):
    """Ratio of two limits. Their draws come from different trials, so they are paired at random."""
    a, b = upper.draws[~np.isnan(upper.draws)], lower.draws[~np.isnan(lower.draws)]
    if not len(a) or not len(b):
        return Ratio(upper, lower, *[float("nan")] * 3)
    n = max(len(a), len(b))
    a, b = rng.permutation(np.resize(a, n)), np.resize(b, n)
    with np.errstate(invalid="ignore", divide="ignore"):
        draws = np.where(np.isinf(b), np.where(np.isinf(a), np.nan, 0.0), a / b)
        severity = upper.factor.severity
        point = severity_of(upper) / severity_of(lower)
    return Ratio(upper, lower, float(point), *resampling.interval(draws))


def severity_of(limit):
    """Severity of a limit; infinite: not reached."""
    return limit.value if np.isinf(limit.value) or limit.value == 0 else limit.factor.severity(limit.value)
