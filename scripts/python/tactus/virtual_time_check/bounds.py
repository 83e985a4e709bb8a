"""What is held against a bound: a figure of the live cluster, the same in virtual time, and how far apart the two may be."""
import dataclasses
import math

HOLDS, OPEN, MISSED = "holds", "open", "missed"


def verdict(low, high, bound):
    """Of a difference that lies from low to high: within the bound whole, beyond it whole, or neither: then more runs would tell."""
    if math.isnan(low) or math.isnan(high):
        return OPEN
    if -bound <= low and high <= bound:
        return HOLDS
    return MISSED if low > bound or high < -bound else OPEN


@dataclasses.dataclass(frozen=True)
class Held:
    """A figure of both. low, high: the interval of the difference live - virtual; both are the difference where the figure is told by itself."""
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
    def says(self):
        return verdict(self.low, self.high, self.bound)

    def row(self):
        """For a table of JSON, which has no NaN."""
        found = {**dataclasses.asdict(self), "difference": self.difference, "says": self.says}
        return {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in found.items()}


def told(figure, unit, live, virtual, bound):
    """A figure that needs no interval; NaN where one of both has none, which agrees with nothing and stays open."""
    return Held(figure, unit, live, virtual, live - virtual, live - virtual, bound)


def of_means(figure, unit, live, virtual, bound, interval):
    """The means of both, each of some runs or games. interval: (low, high) of their difference."""
    return Held(figure, unit, mean(live), mean(virtual), *(float(x) for x in interval), bound)


def mean(values):
    return float(sum(values)) / len(values) if len(values) else math.nan


def count(rows):
    """{verdict: how many}."""
    return {word: sum(r["says"] == word for r in rows) for word in (HOLDS, OPEN, MISSED)}
