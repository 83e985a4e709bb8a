"""Limits of the degradation of one sense: L_detect, L_appear and L_break of an operator, and their ratio.

  L_detect  noticed                  detection.py: 75 % detected, or the edge of the window in which the senses are judged synchronous
  L_appear  a felt property changes  appearance.py: the property differs by more than its JND
  L_break   the task suffers         break_limits.py: success, or time given success, is worse than undegraded by the study's margin
"""
import dataclasses
import math

import numpy as np

from tactus.analysis import resampling
from tactus.analysis.operators import Factor

EITHER = "either"  # by success or by time, the earlier of both
NO_BRACKET = (math.nan, math.nan)


@dataclasses.dataclass
class Limit:
    """One limit of one factor. value, low, high: levels in the factor's unit; infinite: not reached up to `up_to`; 0: reached when nothing is degraded; NaN:
    not identified, and note is the reason."""
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
    bracket: tuple = NO_BRACKET  # two levels between which the limit lies, without an assumption but that it gets no better with the level
    note: str = ""  # levels or participants that were left out

    @property
    def reached(self):
        return np.isfinite(self.value)


def level_of(factor, severity):
    """The level of a severity; infinite: not reached."""
    if not np.isfinite(severity):
        return float(severity)
    return factor.level(severity) if np.isfinite(factor.level(severity)) else 0.0  # a rate is undegraded at infinity, but an infinite limit means "not reached"


def from_draws(kind, factor, by, point, draws, up_to, observer, n, bracket=NO_BRACKET, note=""):
    """A Limit from a severity, its draws, and a bracket of severities."""
    low, high = resampling.interval(draws)
    return Limit(kind, factor, by, *(level_of(factor, float(s)) for s in (point, low, high)), factor.level(up_to) if up_to > 0 else math.nan, draws, observer, n,
                 bracket=tuple(level_of(factor, float(s)) for s in bracket), note=note)


def middle(draws):
    """The median of draws of a limit; infinite if half of them do not reach it; NaN without draws."""
    kept = np.sort(draws[~np.isnan(draws)])
    return float(kept[(len(kept) - 1) // 2]) if len(kept) else math.nan


def series(cells, factor):
    """Cells of this factor alone, by severity."""
    mine = [cell for degraded, cell in cells.items() if len(degraded) == 1 and degraded[0][0] == factor]
    return sorted(mine, key=lambda cell: factor.severity(cell.achieved))


def factors_of(cells):
    """Factors with levels that were played without another degradation."""
    return sorted({degraded[0][0] for degraded in cells if len(degraded) == 1 and not degraded[0][0].removal})


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
        point = np.divide(severity_of(upper), severity_of(lower))
    return Ratio(upper, lower, float(point), *resampling.interval(draws))


def severity_of(limit):
    """Severity of a limit; infinite: not reached."""
    return limit.value if not np.isfinite(limit.value) or limit.value == 0 else limit.factor.severity(limit.value)
