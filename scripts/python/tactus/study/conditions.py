"""Conditions of a study: a condition is one degradation at levels that a procedure chooses, or one fixed degradation."""
import dataclasses

from tactus.study import quantities, stages

SENSES = ("haptic", "audio", "visual", "thermal")


@dataclasses.dataclass(frozen=True)
class Factor:
    """One sense and the operator that degrades it, at a level in the operator's unit (quantities.OPERATORS). stage: of touch; "": its input.
    choices: ((name, value), ...) of quantities.CHOICES that change something."""
    modality: str
    operator: str
    stage: str = ""
    choices: tuple = ()

    @property
    def unit(self):
        return quantities.OPERATORS[self.operator][0]

    def degrade(self, level):
        """Element of a profile; "": this level has no effect."""
        return "" if quantities.nothing(self.operator, level) else quantities.degrade(self.modality, self.operator, level, self.stage, self.choices)

    def words(self):
        return f"{stages.named(self.modality, self.stage)} {self.name}"

    @property
    def name(self):
        """The operator with its choices, as tables name it: "deadband predict=linear"."""
        return " ".join((self.operator, *(f"{name}={value}" for name, value in self.choices)))


def factor(modality, operator, stage, levels, choices):
    """A Factor; stage: the attribute of the file, or None; choices: {name: value} of quantities.CHOICES. Raises ValueError with one sentence when the modality does not have the operator at these levels."""
    only = quantities.OUTPUT_OF.get(operator)
    if only not in (None, modality):
        raise ValueError(f"{modality} has no operator {operator}; only {only} has it")
    stage = stages.of(stage, modality, operator, levels)
    if not stage and modality in quantities.NOT_OF.get(operator, ()):
        raise ValueError(f"{operator} changes forces and has no effect on {modality}, which receives none; choose another operator, for example rate")
    low = [l for l in levels if 0 < l < quantities.SMALLEST.get(operator, 0)]
    if low:
        raise ValueError(f"the level {low[0]:g} of {operator} is too small; give 0, or at least {quantities.SMALLEST[operator]:g} {quantities.OPERATORS[operator][0]}")
    return Factor(modality, operator, stage, stages.choices(choices, operator, stage))


@dataclasses.dataclass(frozen=True)
class Condition:
    """id: its name in every file. kind: asynchrony (of two senses, levels in ms), factor, pair (of factors, levels are tuples), remove or nothing.
    levels: those of the study file. A performance study has one condition for each level, with `fixed` set to the level."""
    id: str
    kind: str
    senses: tuple = ()    # asynchrony: (a, b); a level is t(b) - t(a) in ms, positive: b later
    factors: tuple = ()   # Factors of a factor (one) or a pair (two)
    removed: str = ""     # remove: the modality, and how: off or freeze
    how: str = ""
    stage: str = ""       # of the removed modality
    levels: tuple = ()
    fixed: object = None  # the level of a performance condition

    @property
    def acts_in_participant(self):
        """Whether it degrades the perception of a simulated participant, and not the apparatus."""
        return stages.PERCEPT in (self.stage, *(f.stage for f in self.factors))

    def elements(self, level):
        """Elements of the profile at this level; None: the condition is not applied."""
        if level is None and self.levels:
            return []
        if self.kind == "asynchrony":
            later = self.senses[1] if level > 0 else self.senses[0]
            return [] if level == 0 else [quantities.degrade(later, "delay", abs(level))]
        if self.kind in ("factor", "pair"):
            levels = level if self.kind == "pair" else (level,)
            return [e for factor, l in zip(self.factors, levels) if (e := factor.degrade(l))]
        if self.kind == "remove":
            return [f'<degrade modality="{self.removed}" {stages.attribute(self.stage)}{"off" if self.how == "off" else "freeze"}="{"true" if self.how == "off" else "hold"}"/>']
        return []

    @property
    def unit(self):
        """Unit of the levels of an asynchrony or of one factor; "" for other kinds."""
        return "ms" if self.kind == "asynchrony" else self.factors[0].unit if self.kind == "factor" else ""

    def words(self, level):
        """Condition and level as text for a user; the id of a fixed condition contains its level."""
        if level is None or self.fixed is not None:
            return self.id
        if self.kind == "pair":
            return f"{self.id} " + " + ".join(f"{quantities.written(l)}{f.unit}" for f, l in zip(self.factors, level))
        return f"{self.id} {quantities.written(level)}{self.unit}"

    def row(self, level):
        """The columns of trial_table.py that describe the degradation."""
        if self.kind == "asynchrony":
            return {"pair": ",".join(self.senses), "modality_degraded": self.senses[1] if level > 0 else self.senses[0] if level < 0 else "",
                    "operator": "delay", "level": abs(level), "unit": "ms", "soa_nominal_ms": level}
        if self.kind in ("factor", "pair"):
            levels = level if self.kind == "pair" else (level,)
            names = (("modality_degraded", "operator", "level", "unit"), ("second_modality", "second_operator", "second_level", "second_unit"))
            row = {}
            for factor, l, columns in zip(self.factors, levels, names):
                row.update(zip(columns, (stages.named(factor.modality, factor.stage), factor.name, l, factor.unit)))
                if factor.operator == "loss":
                    row["loss_nominal"] = l / 100
            return row
        if self.kind == "remove":
            return {"modality_degraded": stages.named(self.removed, self.stage), "operator": self.how}
        return {}


def fixed_ones(condition):
    """One condition for each level of a condition, for a performance study."""
    if condition.kind in ("remove", "nothing"):
        return [condition]
    def name_of(level):
        parts = [f"{f.words()} {quantities.written(l)}{f.unit}" for f, l in zip(condition.factors, level if condition.kind == "pair" else (level,))]
        return " + ".join(parts) if parts else f"{condition.id} {quantities.written(level)}ms"
    return [dataclasses.replace(condition, id=name_of(level), fixed=level, levels=(level,)) for level in condition.levels]
