"""Factors of a degradation: a sense and an operator, and the conversion of its levels to a severity that is 0 undegraded and grows with the degradation."""
import dataclasses
import math

NO_GAIN = "gain_of_0"
REMOVALS = ("off", "freeze", "remove", NO_GAIN)  # operators without levels: the sense is absent
# Operators whose lower level is worse. Their severity is 1/level: the period of a rate, the time constant of a low-pass; for shares (FROM_ONE) 1/level - 1.
LOWER_IS_WORSE = ("rate", "frame_rate", "lowpass", "resolution", "gain")
FROM_ONE = ("resolution", "gain")
GAIN_ABOVE = "gain_above_1"  # a gain above 1 is a separate factor, whose severity grows with the level
NAME = {"haptic": "touch", "audio": "sound", "visual": "vision", "thermal": "warmth"}


def kind(operator):
    """The operator without its choices: "deadband" of "deadband predict=linear"."""
    return operator.partition(" ")[0]


def factor(modality, operator, unit="", level=math.nan):
    """The Factor of a row of a table; the level matters only for a gain."""
    if kind(operator) == "gain" and (level == 0 or level > 1):
        return Factor(modality, (GAIN_ABOVE if level else NO_GAIN) + operator.removeprefix("gain"), unit)
    return Factor(modality, operator, unit)


def factors(trials):
    """[(Factor, Trials)] of the rows with the same sense, operator and unit."""
    of_row = [factor(*values) for values in zip(*(trials[name] for name in ("modality_degraded", "operator", "unit", "level")))]
    return [(one, trials.where([i for i, other in enumerate(of_row) if other == one])) for one in sorted(set(of_row))]


@dataclasses.dataclass(frozen=True, order=True)
class Factor:
    """A sense and the operator that degrades it, with the choices of the operator after a blank."""
    modality: str
    operator: str
    unit: str = ""

    @property
    def removal(self):
        return kind(self.operator) in REMOVALS

    @property
    def lower_is_worse(self):
        """Whether a lower level is worse."""
        return kind(self.operator) in LOWER_IS_WORSE

    @property
    def from_one(self):
        return kind(self.operator) in FROM_ONE

    @property
    def gain_above(self):
        return kind(self.operator) == GAIN_ABOVE

    def severity(self, level):
        """Severity, 0 or more, of a level that trials.read accepts."""
        return 1.0 / level - self.from_one if self.lower_is_worse else level - self.gain_above

    def level(self, severity):
        """The level of a severity; inverse of severity()."""
        if not self.lower_is_worse:
            return severity + self.gain_above
        inverse = severity + self.from_one
        return 1.0 / inverse if inverse else math.inf

    def undegraded(self, level):
        """Whether the level has no effect."""
        return not self.removal and level == (1 if self.from_one else math.nan if self.lower_is_worse else 0)

    def sense(self):
        """The sense as text, with its stage of touch: "touch (percept)"."""
        modality, _, stage = self.modality.partition(":")
        return NAME.get(modality, modality) + (f" ({stage})" if stage else "")

    def words(self):
        return f"{self.sense()}: {self.operator.replace('_', ' ')}"

    def axis(self):
        return f"{self.operator.replace('_', ' ')} of {self.sense()}" + (f" ({self.unit})" if self.unit else "")

    def severity_axis(self):
        return f"1 / {self.axis()}" + (" − 1" if self.from_one else "") if self.lower_is_worse else self.axis()
