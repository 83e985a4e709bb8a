"""The degradations of the battery: operators and levels of each sense. Every level is played by every player, so that each player's limit is searched on the whole grid."""
import dataclasses

from tactus.study import quantities

# Levels from mild to severe. Design: from below any published threshold to a loss of nearly everything, in steps of a factor of 2 where the unit permits it.
COMMON = {
    "delay": (10, 20, 40, 80, 160, 320, 640),
    "jitter": (5, 10, 20, 40, 80, 160),
    "loss": (10, 25, 50, 75, 90, 97),
    "rate": (200, 100, 50, 25, 12.5, 6.25, 3, 1.5),
}
OF_SENSE = {
    # A picture is looked at four times a second, so shorter times do not show.
    "visual": {"jitter": (20, 40, 80, 160), "loss": (25, 50, 75, 90), "rate": (12.5, 6.25, 3, 1.5), "resolution": (0.5, 0.25, 0.12, 0.06, 0.03)},
    "audio": {},
    "haptic": {"quantise": (0.05, 0.1, 0.2, 0.4, 0.8, 1.6)},
    "thermal": {"response": (100, 200, 400, 800, 1600, 3200, 6400)},
}
# Stages of touch beside its input: the force on the hand.
OF_STAGE = {("haptic", "force"): {"delay": COMMON["delay"], "loss": COMMON["loss"], "rate": COMMON["rate"], "deadband": (5, 10, 20, 40, 80)}}
DRAWN = ("jitter", "loss")  # operators with random draws: each draw is one presentation
SEEDS = (1, 2, 3)                     # of the draws


@dataclasses.dataclass(frozen=True)
class Condition:
    """One operator at one level, of one sense and stage ("": its input); without an operator: undegraded."""
    operator: str = ""
    level: float = 0.0
    stage: str = ""

    @property
    def seeds(self):
        return SEEDS if self.operator in DRAWN else SEEDS[:1]


UNDEGRADED = Condition()


def curves(sense):
    """{(stage, operator): levels from mild to severe} of a sense."""
    found = {("", operator): levels for operator, levels in {**COMMON, **OF_SENSE[sense]}.items()}
    found.update({(stage, operator): levels for (of, stage), each in OF_STAGE.items() if of == sense for operator, levels in each.items()})
    return found


def of(sense):
    """All degraded conditions of a sense."""
    return [Condition(operator, level, stage) for (stage, operator), levels in curves(sense).items() for level in levels]


def pairs(first, second):
    """[((sense, operator, levels), (sense, operator, levels))] of two senses that are degraded together; level 0 is undegraded."""
    return [tuple((sense, operator, (0, *curves(sense)["", operator][1::2])) for sense in (first, second)) for operator in COMMON]


def unit(operator):
    return quantities.OPERATORS[operator][0]


def written(operator, level):
    """A level with its unit, as 12.5Hz."""
    return f"{level:g}{unit(operator)}"
