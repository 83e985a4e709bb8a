"""Published thresholds of asynchrony (sync/presentation/thresholds.csv). Nothing is said here without a source."""
import csv
import dataclasses
import re

from tactus.analysis.operators import Factor
from tactus.paths import REPOSITORY

THRESHOLDS = REPOSITORY / "sync" / "presentation" / "thresholds.csv"


@dataclasses.dataclass(frozen=True)
class Threshold:
    """How late `later` may come after `earlier`, in ms."""
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
        """Who and when: the source up to its year, three names and more as the first of them."""
        whole = re.match(r"(.*?)((?:, )?\b(?:19|20)\d\d)\b", self.source)
        if not whole:
            return self.source.split(",")[0]
        names, year = whole.groups()
        return (names.split(",")[0] + " et al." if "," in names and " and " in names else names.rstrip()) + (year if year[0] == "," else f" {year}")


def thresholds(path=THRESHOLDS):
    with open(path, newline="", encoding="utf-8") as file:
        return [Threshold(r["earlier"], r["later"], float(r["threshold_ms"]), r["what"], r["situation"], r["source"]) for r in csv.DictReader(file)]


def of_pair(a, b):
    """[(SOA, Threshold)] of SOA(a, b) = t(b) - t(a): positive where b is the later."""
    return sorted(((t.ms if t.later == b else -t.ms, t) for t in thresholds() if {t.earlier, t.later} == {a, b}), key=lambda pair: (pair[0], pair[1].source))


def of_factor(factor):
    """Thresholds that a delay of one sense can be held against, by whatever sense it is late after."""
    return [t for t in thresholds() if t.factor == factor]
