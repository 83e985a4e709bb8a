"""Comparison with a bound: a figure of the live cluster, the same figure in virtual time, and their largest permitted difference."""
import dataclasses
import math

HOLDS, OPEN, MISSED = "holds", "open", "missed"


def verdict(low, high, bound):
    """Verdict on a difference with the interval low to high: HOLDS inside the bound, MISSED outside it, OPEN if it straddles the bound and needs more runs."""
    if math.isnan(low) or math.isnan(high):
        return OPEN
    if -bound <= low and high <= bound:
        return HOLDS
    return MISSED if low > bound or high < -bound else OPEN


@dataclasses.dataclass(frozen=True)
class BoundCheck:
    """A figure of both. low, high: interval of the difference live - virtual; both equal the difference for a figure without an interval."""
    figure: str
    unit: str
    live: float
    virtual: float
    low: float
    high: float
    bound: float

    @property
    def difference(self):
        return self.live - self.virtual

    @property
    def verdict(self):
        return verdict(self.low, self.high, self.bound)

    def row(self):
        """{member: value} for JSON, which has no NaN: null."""
        found = {**dataclasses.asdict(self), "difference": self.difference, "says": self.verdict}
        return {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in found.items()}


def single(figure, unit, live, virtual, bound):
    """A figure without an interval. NaN: one of both has no value; the verdict is OPEN."""
    return BoundCheck(figure, unit, live, virtual, live - virtual, live - virtual, bound)


def of_means(figure, unit, live, virtual, bound, interval):
    """The means of both over runs or games. interval: (low, high) of their difference."""
    return BoundCheck(figure, unit, mean(live), mean(virtual), *(float(x) for x in interval), bound)


def mean(values):
    return float(sum(values)) / len(values) if len(values) else math.nan


def count(rows):
    """{verdict: number of rows}."""
    return {word: sum(r["says"] == word for r in rows) for word in (HOLDS, OPEN, MISSED)}
