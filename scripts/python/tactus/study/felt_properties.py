"""Felt properties and their published just noticeable differences (JND), from just_noticeable.csv. Every value has a source."""
import dataclasses
import math
import pathlib
from statistics import NormalDist

from tactus.tables import read_rows

JUST_NOTICEABLE = pathlib.Path(__file__).with_name("just_noticeable.csv")


@dataclasses.dataclass(frozen=True)
class JustNoticeable:
    """The JND of a felt property: `jnd` as published, in its unit, a share of the property where the unit is %. percent: share of yes, in percent, of a
    cumulative Gaussian of one presentation at a distance of the JND from its centre; NaN: not published, or not checked. A JND of two
    presentations is listed as that of one. situation, criterion and source: in words."""
    jnd: float
    unit: str
    situation: str
    criterion: str
    percent: float
    source: str

    @property
    def sigma(self):
        """Standard deviation of one presentation; only these compare between criteria. NaN with an unknown criterion."""
        return self.jnd / NormalDist().inv_cdf(self.percent / 100) if self.percent == self.percent else math.nan

    @property
    def at75(self):
        """The JND at 75 %, the criterion of all thresholds of Tactus; as published with an unknown criterion."""
        return self.sigma * QUARTILE if self.percent == self.percent else self.jnd

    def of(self, reference):
        """The JND at 75 % of a property of this size."""
        return abs(reference) * self.at75 / 100 if self.unit == "%" else self.at75


QUARTILE = NormalDist().inv_cdf(0.75)


def apart(percent, intervals=1):
    """Distance, in standard deviations of one presentation, at which this share of the answers is yes (one interval) or right (forced choice of two)."""
    return math.sqrt(intervals) * NormalDist().inv_cdf(percent / 100)


def just_noticeable():
    """{property: [JustNoticeable]}; L_appear is compared with the first of each."""
    found = {}
    for r in read_rows(JUST_NOTICEABLE):
        found.setdefault(r["property"], []).append(JustNoticeable(float(r["jnd"]), r["unit"], r["situation"], r["criterion"], float(r["percent"] or "nan"), r["source"]))
    return found


def property_of(text, known):
    """The property that a question names; "" if it names none or several."""
    named = [name for name in known if name in text.lower()]
    return named[0] if len(named) == 1 else ""
