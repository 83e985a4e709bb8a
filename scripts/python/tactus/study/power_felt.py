"""Power of a comparison of two presses by an observer of felt stiffness. The stiffness at a level is the result of the study, so without a pilot only
the smallest detectable difference of stiffness is computed. With the presses of a pilot the level of 75 % right answers is simulated, and its uncertainty
for one participant.
"""
import bisect
import collections
import dataclasses
import math

import numpy as np
from scipy.stats import binom

from tactus.psychophysics.observers import PERCEPTS

FEWEST = 3  # presses at a level of a pilot, and levels; design: enough to show a spread
FIT, PARAMETER = "weibull", "threshold75"  # as in tactus/analysis
STEPS = 40  # of a bisection, to far below the printed precision; design


@dataclasses.dataclass(frozen=True)
class Presses:
    """Presses of a pilot. felt: {condition: {level: ((N/m of the degraded press, N/m of the other), ...)}}, levels ascending."""
    felt: dict
    source: str


def pilot(rows, path):
    """Presses of rows of a trial table (trial_table.read). Raises ValueError if they are too few."""
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
    """Observer who feels at a level the presses of the pilot at that level. Between two levels one of them is drawn, the nearer with higher probability."""

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
    """The level of 75 % right answers of an observer without lapses, by linear interpolation between levels; nan: none."""
    presser = PERCEPTS[observer.function](**{**observer.params, "lapse": 0.0}, seed=1)
    right = [np.mean([presser.first_is_softer(*p) for p in presses]) for presses in levels.values()]
    x, y = np.array([0.0, *levels]), np.maximum.accumulate([0.5, *right])
    first = int(np.argmax(y >= 0.75))
    return math.nan if y[-1] < 0.75 else float(x[first - 1] + (0.75 - y[first - 1]) / (y[first] - y[first - 1]) * (x[first] - x[first - 1]))


def differences(study, condition, participants, wanted, alpha):
    """[{condition, participants, answers, softer}]: the smallest share by which one press must be softer so that the answers at one level differ from chance
    (two-sided binomial test) with this power; None: no share. [] for a procedure without fixed levels."""
    observer = study.observer(condition)
    presser, found = PERCEPTS[observer.function](**observer.params, seed=1), []
    for people in participants if study.procedure["kind"] == "constant" else ():
        n = people * study.procedure["repetitions"]
        needed = int(binom.isf(alpha / 2, n, 0.5)) + 1  # right answers out of n that chance exceeds with probability alpha / 2
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
        shares = (f"{f['answers']} answers of {f['participants']} participant{'s' * (f['participants'] > 1)} " + ("none" if f["softer"] is None else f"{100 * f['softer']:.0f} %")
                for f in found if f["condition"] == condition)
        lines.append(f"{condition}: smallest difference of stiffness that the answers at one level show with 80 % power: " + ", ".join(shares))
    if presses is None:
        return [*lines, "the threshold level is not simulated, because the stiffness at a level is what the study measures; add --pilot TRIALS.csv with the presses of a session"]
    for condition in (c for c in study.conditions if study.observer(c) and study.observer(c).function in PERCEPTS):
        levels = presses.felt.get(condition.id)
        if levels is None:
            lines.append(f"{condition.id}: {presses.source} belong to other conditions")
        elif math.isnan(truth(levels, study.observer(condition))):
            lines.append(f"{condition.id}: at no level of the pilot do 75 % of the answers call the degraded press the softer")
    return [*lines, f"felt stiffness from {presses.source}"]
