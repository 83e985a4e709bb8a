"""The degradations of the battery: operators and levels of each sense. All players answer at all levels, so the limit of each is searched on the whole grid."""
import dataclasses

from tactus.study import quantities

# Levels from mild to severe. Design: from below any published threshold to a loss of nearly everything, in steps of a factor of 2 where the unit permits it.
COMMON = {
    "delay": (10, 20, 40, 80, 160, 320, 640),
    "jitter": (5, 10, 20, 40, 80, 160),
    "loss": (10, 25, 50, 75, 90, 97),
    "rate": (25, 12.5, 6.25, 3, 1.5),
}
OF_SENSE = {
    # A picture is looked at four times a second, and the scene with vision is at rest, so a jitter does not show.
    "visual": {"loss": (25, 50, 75, 90), "rate": (12.5, 6.25, 3, 1.5), "resolution": (0.5, 0.25, 0.12, 0.06, 0.03)},
    "audio": {"delay": (*COMMON["delay"], 1280, 2560)},
    "haptic": {"rate": (200, 100, 50, *COMMON["rate"]), "deadband": (5, 10, 20, 40, 80), "quantise": (0.05, 0.1, 0.2, 0.4, 0.8, 1.6)},
    "thermal": {"response": (100, 200, 400, 800, 1600, 3200, 6400)},
}
WITHOUT = {"visual": ("jitter",)}
# Touch is degraded at the force on the hand. A late touch model would soften the coupling between hand and body, and the recorded hand would not yield to it.
STAGE = {"haptic": "force"}
DRAWN = ("jitter", "loss", "rate")  # operators with random draws, or with a phase: each draw is one presentation
SEEDS = (1, 2, 3)                   # of the draws


@dataclasses.dataclass(frozen=True)
class Condition:
    """One operator at one level, of one sense; without an operator: undegraded."""
    operator: str = ""
    level: float = 0.0

    @property
    def seeds(self):
        return SEEDS if self.operator in DRAWN else SEEDS[:1]


UNDEGRADED = Condition()


def element(sense, condition, seed):
    """Element of a profile; "": undegraded. The phases of a rate are spread evenly over its period."""
    if not condition.operator:
        return ""
    found = quantities.degrade(sense, condition.operator, condition.level, STAGE.get(sense, ""))
    phase_ms = 1e3 / condition.level * (seed - 0.5) / len(SEEDS) if condition.operator == "rate" else None
    return found if phase_ms is None else found.replace('Hz"', f'Hz phase={phase_ms:.3f}ms"')


def curves(sense):
    """{operator: levels from mild to severe} of a sense."""
    return {operator: levels for operator, levels in {**COMMON, **OF_SENSE[sense]}.items() if operator not in WITHOUT.get(sense, ())}


def of(sense):
    """All degraded conditions of a sense."""
    return [Condition(operator, level) for operator, levels in curves(sense).items() for level in levels]


def pairs(first, second):
    """[((sense, operator, levels), (sense, operator, levels))] of two senses that are degraded together; level 0 is undegraded."""
    return [tuple((sense, operator, (0, *curves(sense)[operator][1::2])) for sense in (first, second)) for operator in COMMON
            if operator in curves(first) and operator in curves(second)]


def unit(operator):
    return quantities.OPERATORS[operator][0]


def written(operator, level):
    """A level with its unit, as 12.5Hz."""
    return f"{level:g}{unit(operator)}"
