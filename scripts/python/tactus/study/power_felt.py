"""What two presses can show, of an observer who judges the stiffness that he feels. Which stiffness follows from a level is what the study measures; so
without presses that were made, all that is told is how small a difference of stiffness his answers show. With those of a pilot it is simulated where three
in four answers call the degraded press the softer, and how well that is known from one participant.
"""
import bisect
import collections
import dataclasses
import math

import numpy as np
from scipy.stats import binom

from tactus.psychophysics.observers import PERCEPTS

FEWEST = 3  # presses of a level in a pilot, and levels; design: a spread can be seen
FIT, PARAMETER = "weibull", "threshold75"  # as scripts/python/tactus/analysis fits them
STEPS = 40  # of a search by halves, to far below what is printed; design


@dataclasses.dataclass(frozen=True)
class Presses:
    """Of a pilot. felt: {condition: {level: ((N/m of the degraded press, N/m of the other), ...)}}, levels ascending."""
    felt: dict
    source: str


def pilot(rows, path):
    """Presses of rows of a trial table (trial_table.read); ValueError where they say too little."""
    felt = collections.defaultdict(lambda: collections.defaultdict(list))
    for r in rows:
        both, degraded = (r.get("stiffness_first_n_m"), r.get("stiffness_second_n_m")), r.get("degraded_interval")
        if None not in both and degraded in (1, 2) and r.get("level") is not None and not r.get("missed"):
            felt[r.get("condition", "")][r["level"]].append((both[degraded - 1], both[2 - degraded]))
    enough = {c: {l: tuple(p) for l, p in sorted(levels.items()) if len(p) >= FEWEST} for c, levels in felt.items()}
    enough = {c: levels for c, levels in enough.items() if len(levels) >= FEWEST}
    if not enough:
        raise ValueError(f"{path}: holds no condition with {FEWEST} trials of two presses at each of {FEWEST} levels; their stiffnesses are in its columns "
                         "stiffness_first_n_m and stiffness_second_n_m")
    return Presses(enough, f"{sum(len(p) for levels in enough.values() for p in levels.values())} trials in {path}")


class Felt:
    """Answers as one who feels at a level what somebody felt at it in the pilot; between two of its levels at one of them, the nearer the likelier."""

    def __init__(self, levels, observer, seed):
        self.levels, self.presses = list(levels), list(levels.values())
        self.presser = PERCEPTS[observer.function](**observer.params, seed=seed)

    def answer(self, level):
        dice, above = self.presser.dice, bisect.bisect_left(self.levels, level)
        i = min(above, len(self.levels) - 1)
        if 0 < above < len(self.levels) and dice.random() > (level - self.levels[above - 1]) / (self.levels[above] - self.levels[above - 1]):
            i = above - 1
        presses = self.presses[i]
        return self.presser.softer(*presses[dice.integers(len(presses))]) == 0


def truth(levels, observer):
    """The level at which one who never lapses is right in three of four, by straight lines between the levels; nan: at none."""
    presser = PERCEPTS[observer.function](**{**observer.params, "lapse": 0.0}, seed=1)
    right = [np.mean([presser.first_is_softer(*p) for p in presses]) for presses in levels.values()]
    x, y = np.array([0.0, *levels]), np.maximum.accumulate([0.5, *right])
    first = int(np.argmax(y >= 0.75))
    return math.nan if y[-1] < 0.75 else float(x[first - 1] + (0.75 - y[first - 1]) / (y[first] - y[first - 1]) * (x[first] - x[first - 1]))


def differences(study, condition, participants, wanted, alpha):
    """[{condition, participants, answers, softer}]: the smallest share by which one press has to be softer so that the answers at one level differ from chance
    (binomial test, two-sided) with this power; None: at no share. [] for a procedure without fixed levels."""
    observer = study.observer(condition)
    presser, found = PERCEPTS[observer.function](**observer.params, seed=1), []
    for people in participants if study.procedure["kind"] == "constant" else ():
        n = people * study.procedure["repetitions"]
        needed = int(binom.isf(alpha / 2, n, 0.5)) + 1  # right answers, of n, that chance seldom gives
        shows = lambda softer: binom.sf(needed - 1, n, presser.first_is_softer(1 - softer, 1.0)) >= wanted
        low, high = 0.0, 0.99
        for _ in range(STEPS):
            middle = (low + high) / 2
            low, high = (low, middle) if shows(middle) else (middle, high)
        found.append({"condition": condition.id, "participants": people, "answers": n, "softer": high if shows(high) else None})
    return found


def words(study, found, presses):
    """Lines for a terminal. found: of differences()."""
    lines = []
    for condition in dict.fromkeys(f["condition"] for f in found):
        told = (f"{f['answers']} answers of {f['participants']} participant{'s' * (f['participants'] > 1)} " + ("none" if f["softer"] is None else f"{100 * f['softer']:.0f} %")
                for f in found if f["condition"] == condition)
        lines.append(f"{condition}: a press that is so much softer than the other is told from chance at one level with 80 % power: " + ", ".join(told))
    if presses is None:
        return [*lines, "how soft a press is at a level is what the study measures: at which level it is noticed is not simulated; --pilot TRIALS.csv takes the presses of a session"]
    for condition in (c for c in study.conditions if study.observer(c) and study.observer(c).function in PERCEPTS):
        levels = presses.felt.get(condition.id)
        if levels is None:
            lines.append(f"{condition.id}: {presses.source} are of other conditions")
        elif math.isnan(truth(levels, study.observer(condition))):
            lines.append(f"{condition.id}: at no level were the presses so soft that three of four answers call them the softer")
    return [*lines, f"felt as in {presses.source}"]
