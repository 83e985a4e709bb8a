"""Comparison of a published result with that of simulated participants. The range of agreement is that of the file; nothing here changes it."""
import dataclasses
import math

import numpy as np
from scipy.special import stdtrit

AGREES, DIFFERS, NOT_REPRODUCIBLE = "agrees", "differs", "not reproducible with this player"
CALIBRATED = "calibrated, not a replication"
ONE_SIDED = 0.95   # probability of the bound when the expectation has one end only
FEWEST_SHARE = 0.5  # of participants with a value, below which there is no verdict; design


@dataclasses.dataclass(frozen=True)
class Verdict:
    """mean, low, high: of the participants with a 95 % interval of the mean. from5, to95: their 5 and 95 % points. count: participants with a value, of all.
    verdict: AGREES, DIFFERS or NOT_REPRODUCIBLE; why: the reason for the last, or a note."""
    mean: float
    low: float
    high: float
    from5: float
    to95: float
    count: int
    total: int
    verdict: str
    why: str


NOTHING = dict(mean=math.nan, low=math.nan, high=math.nan, from5=math.nan, to95=math.nan, count=0, total=0)


def of_values(expectation, values, group=None):
    """Verdict for the values of participants; NaN: a participant without a value. group: the estimate of all participants together, whose values are then
    those of resampled participants (first_level)."""
    values = np.asarray(values, dtype=float)
    finite = values[np.isfinite(values)]
    if len(finite) < max(1, FEWEST_SHARE * len(values)) or group is not None and not math.isfinite(group):
        return Verdict(**{**NOTHING, "count": len(finite), "total": len(values)}, verdict=NOT_REPRODUCIBLE,
                       why="no level has the effect" if group is not None else f"{len(values) - len(finite)} of {len(values)} participants have no value")
    mean = float(finite.mean()) if group is None else group
    from5, to95 = (float(x) for x in np.quantile(finite, [0.05, 0.95]))
    n = len(finite)
    error = float(finite.std(ddof=1)) / math.sqrt(n) if n > 1 else math.nan
    if group is None:
        half = float(stdtrit(n - 1, 0.975)) * error if n > 1 else math.nan
        low, high = mean - half, mean + half
    else:
        low, high = (float(x) for x in np.quantile(finite, [0.025, 0.975]))
    agrees, why = compared(expectation, mean, n, error, group is not None, from5, to95)
    if agrees and group is not None and np.mean([in_range(expectation, x) for x in values]) <= 0.5:
        agrees, why = False, "the level is in the range, but not in most resamples of the participants"
    return Verdict(mean, low, high, from5, to95, n, len(values), AGREES if agrees else DIFFERS, why)


def in_range(e, x):
    """Whether a number lies in the range of the file; NaN does not."""
    return math.isfinite(x) and (e.low is None or x >= e.low) and (e.high is None or x <= e.high)


def compared(e, mean, n, error, is_group, from5, to95):
    """(agrees, reason of a difference). A range with two ends contains the mean, and the published value lies between the 5 and 95 % points of the
    participants. A range with one end contains the one-sided 95 % bound of the mean."""
    if e.low is not None and e.high is not None:
        if not e.low <= mean <= e.high:
            return False, ""
        if e.value is not None and not is_group and not from5 <= e.value <= to95:
            return False, "the mean is in the range, but the published value is outside the participants"
        return True, ""
    # One participant has no bound.
    margin = float(stdtrit(n - 1, ONE_SIDED)) * error if n > 1 and not is_group else 0.0 if is_group else math.inf
    if e.low is not None:
        agrees = mean - margin > e.low
        inside = mean > e.low
    else:
        agrees = mean + margin < e.high
        inside = mean < e.high
    return agrees, "" if agrees or not inside else "the direction is right, but not certain with these participants"


def of_expectation(expectation, found):
    """Verdict of one expectation. found: {measure id: (estimate, values, whether they are resampled)}."""
    if expectation.lacks:
        return Verdict(**NOTHING, verdict=NOT_REPRODUCIBLE, why=expectation.lacks)
    estimate, values, resampled = found[expectation.measure]
    return of_values(expectation, values, estimate if resampled else None)


def calibration(experiment, expectation, sources):
    """Why a result is no replication: a property of the participants rests on this paper, or the file states it. "": it is one. sources: {property: source} of
    the paradigm."""
    first = experiment.authors.split(",")[0].strip()
    for name, source in sources.items():
        if first in source and str(experiment.year) in source:
            return f"the property {name} is from this paper"
    return expectation.calibrated
