"""Staircases: the level falls after yes (or right) and rises after no, in steps that halve at the reversals until they are the smallest.

1up1down          up after a no, down after a yes: seeks p = 0.5
1up2down          up after a no, down after two yes in a row: p^2 = 0.5, p = 0.7071 (Levitt 1971, JASA 49:467, table I)
weighted          up three times as far as down: p = 0.75 (Kaernbach 1991, Perception & Psychophysics 49:227: S_up (1 - p) = S_down p)

The estimate is the mean of the levels of the reversals at the smallest step, an even number of them, so that peaks and valleys count alike
(Levitt 1971). In forced choice of two, 1up1down has nothing to seek: chance alone gives 0.5.
"""
import math

TARGET = {"1up1down": 0.5, "1up2down": math.sqrt(0.5), "weighted": 0.75}
NEEDED = {"1up1down": 1, "1up2down": 2, "weighted": 1}  # yes in a row before a step down
RATIO = {"1up1down": 1.0, "1up2down": 1.0, "weighted": 3.0}  # step up over step down
# Trials between two reversals at steps of 5 % on a straight function, by simulation (test_procedures.py holds them against it).
TRIALS_PER_REVERSAL = {"1up1down": 1.9, "1up2down": 3.2, "weighted": 2.4}
FEWEST_REVERSALS = 4  # design: of fewer no mean is told
MOST_TRIALS = 200     # design: a staircase that does not turn ends here


class Staircase:
    """start, step (the first one down), minimum_step, lowest, highest: in the unit of the levels; reversals: so many at the smallest step end
    it; most_trials: so many do so anyway."""

    def __init__(self, rule, start, step, minimum_step, lowest, highest, reversals, most_trials=MOST_TRIALS):
        if rule not in TARGET:
            raise ValueError(f"there is no staircase '{rule}'; choose one of {', '.join(TARGET)}")
        if not (lowest <= start <= highest and lowest < highest):
            raise ValueError(f"a staircase cannot start at {start:g} between {lowest:g} and {highest:g}; start within lowest and highest")
        if not 0 < minimum_step <= step:
            raise ValueError(f"the smallest step {minimum_step:g} is to be above 0 and at most the first step {step:g}")
        if reversals < FEWEST_REVERSALS or most_trials < 1:
            raise ValueError(f"{reversals} reversals are too few for a mean; ask for {FEWEST_REVERSALS} or more")
        self.rule, self.level, self.step, self.minimum_step = rule, float(start), float(step), float(minimum_step)
        self.lowest, self.highest, self.wanted, self.most_trials = float(lowest), float(highest), int(reversals), int(most_trials)
        self.first_steps = math.ceil(math.log2(step / minimum_step))
        self.in_a_row, self.direction = 0, 0
        self.turned, self.at_end = [], 0  # levels of the reversals at the smallest step; trials at lowest or highest
        self.history = []

    @property
    def done(self):
        return len(self.history)

    @property
    def expected(self):
        return min(self.most_trials, round((self.wanted + self.first_steps) * TRIALS_PER_REVERSAL[self.rule]) + 2)

    @property
    def finished(self):
        return len(self.turned) >= self.wanted or self.done >= self.most_trials

    def next_level(self):
        if self.finished:
            raise IndexError("this staircase has ended; ask `finished` first")
        return self.level

    def answer(self, level, yes):
        """Of a trial at `level`, which need not be quite the one asked for: what was presented is what is kept, the rule goes on from its own."""
        self.history.append((level, bool(yes)))
        self.at_end += self.level in (self.lowest, self.highest)
        self.in_a_row = self.in_a_row + 1 if yes else 0
        if not yes:
            self.move(1)
        elif self.in_a_row >= NEEDED[self.rule]:
            self.in_a_row = 0
            self.move(-1)

    def move(self, direction):
        if self.direction == -direction:
            if self.step <= self.minimum_step:
                self.turned.append(self.level)
            self.step = max(self.step / 2, self.minimum_step)
        self.direction = direction
        to = self.level + direction * self.step * (RATIO[self.rule] if direction > 0 else 1.0)
        self.level = min(max(to, self.lowest), self.highest)

    def estimate(self):
        """{threshold, target, reversals, sd_reversals, at_end}: threshold is the level at which `target` of the answers are yes; at_end: share of
        trials at the lowest or highest level, where the staircase could not go on. None before FEWEST_REVERSALS."""
        count = len(self.turned) - len(self.turned) % 2
        if count < FEWEST_REVERSALS:
            return None
        last = self.turned[-count:]
        mean = sum(last) / count
        return {"threshold": mean, "target": TARGET[self.rule], "reversals": count, "sd_reversals": math.sqrt(sum((x - mean) ** 2 for x in last) / (count - 1)),
                "at_end": self.at_end / self.done}
