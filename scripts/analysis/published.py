"""Published thresholds: of asynchrony (sync/presentation/thresholds.csv) and of properties that are felt (just_noticeable.csv). Nothing is said here without a source."""
import csv
import dataclasses
import pathlib
import re

from operators import Factor

HERE = pathlib.Path(__file__).resolve().parent
THRESHOLDS = HERE.parents[1] / "sync" / "thresholds.csv"
JUST_NOTICEABLE = HERE / "just_noticeable.csv"


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


@dataclasses.dataclass(frozen=True)
class JustNoticeable:
    """The JND of a felt property: `jnd` in its unit, a share of the property where the unit is %."""
    jnd: float
    unit: str
    situation: str
    source: str

    def of(self, reference):
        return abs(reference) * self.jnd / 100 if self.unit == "%" else self.jnd


def just_noticeable():
    """{property: [JustNoticeable]}; the first of each is what L_appear is held against."""
    found = {}
    with open(JUST_NOTICEABLE, newline="", encoding="utf-8") as file:
        for r in csv.DictReader(file):
            found.setdefault(r["property"], []).append(JustNoticeable(float(r["jnd"]), r["unit"], r["situation"], r["source"]))
    return found
