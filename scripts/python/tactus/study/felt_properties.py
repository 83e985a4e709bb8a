"""Felt properties and their published just noticeable differences (JND), from just_noticeable.csv. Every value has a source."""
import dataclasses
import pathlib

from tactus.tables import read_rows

JUST_NOTICEABLE = pathlib.Path(__file__).with_name("just_noticeable.csv")


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
    """{property: [JustNoticeable]}; L_appear is compared with the first of each."""
    found = {}
    for r in read_rows(JUST_NOTICEABLE):
        found.setdefault(r["property"], []).append(JustNoticeable(float(r["jnd"]), r["unit"], r["situation"], r["source"]))
    return found


def property_of(text, known):
    """The property that a question names; "" if it names none or several."""
    named = [name for name in known if name in text.lower()]
    return named[0] if len(named) == 1 else ""
