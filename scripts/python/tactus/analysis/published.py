"""Published thresholds of asynchrony, from sync/presentation/thresholds.csv. Every value has a source."""
import dataclasses
import re

from tactus.analysis.operators import Factor
from tactus.paths import THRESHOLDS
from tactus.tables import read_rows


@dataclasses.dataclass(frozen=True)
class Threshold:
    """Largest lateness of `later` after `earlier`, in ms."""
    earlier: str
    later: str
    ms: float
    what: str
    situation: str
    source: str

    @property
    def factor(self):
        return Factor(self.later, "delay", "ms")

    def short(self):
        """Authors and year of the source; three or more authors are shortened to the first."""
        whole = re.match(r"(.*?)((?:, )?\b(?:19|20)\d\d)\b", self.source)
        if not whole:
            return self.source.split(",")[0]
        names, year = whole.groups()
        return (names.split(",")[0] + " et al." if "," in names and " and " in names else names.rstrip()) + (year if year[0] == "," else f" {year}")


def thresholds(path=THRESHOLDS):
    return [Threshold(r["earlier"], r["later"], float(r["threshold_ms"]), r["what"], r["situation"], r["source"]) for r in read_rows(path)]


def of_pair(a, b):
    """[(SOA in ms, Threshold)] with SOA(a, b) = t(b) - t(a), positive if b is later."""
    return sorted(((t.ms if t.later == b else -t.ms, t) for t in thresholds() if {t.earlier, t.later} == {a, b}), key=lambda pair: (pair[0], pair[1].source))


def of_factor(factor):
    """Thresholds for a delay of one sense after any other sense."""
    return [t for t in thresholds() if t.factor == factor]
