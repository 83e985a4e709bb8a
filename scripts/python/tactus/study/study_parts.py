"""Parts of a study file as data: items of a questionnaire, the stimulus, simulated participants, falsifiers."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Item:
    """A question of a questionnaire, answered by one of choices, or by a number from lowest to highest in steps."""
    id: str
    text: str
    choices: tuple
    lowest: float
    highest: float
    step: float


@dataclasses.dataclass(frozen=True)
class Stimulus:
    """by: apparatus or participant. The hand of the apparatus starts at `rest_m`, `above_m` over the surface, and taps or presses `depth_m` into the
    surface; a press goes down and up `times` times, each in `period_s`. limit_s: time limit of a game. common_starts: whether game n has the same seed in all
    conditions, so that conditions are compared with common random numbers."""
    by: str = "apparatus"
    rest_m: tuple = (0.0, 0.0, 0.04)
    above_m: float = 0.032
    depth_m: float = 0.012
    period_s: float = 1.0
    times: int = 2
    limit_s: float = 30.0
    common_starts: bool = False


@dataclasses.dataclass(frozen=True)
class Observer:
    """A simulated participant in a condition. function: a psychometric function of the level, or one of observers.PERCEPTS, which judge the felt
    stiffness. sources: {parameter: source of its value}."""
    function: str
    params: dict
    sources: dict


@dataclasses.dataclass(frozen=True)
class Falsifier:
    """A result, stated before the study, that would refute its simulated players; decided_by: the command that decides it."""
    name: str
    text: str
    decided_by: str
