"""Staircases: the level falls after yes (or right) and rises after no, in steps that halve at each reversal down to the smallest step.

1up1down          up after a no, down after a yes: p = 0.5
1up2down          up after a no, down after two yes in a row: p^2 = 0.5, p = 0.7071 (Levitt 1971, JASA 49:467, table I)
weighted          up three times as far as down: p = 0.75 (Kaernbach 1991, Perception & Psychophysics 49:227: S_up (1 - p) = S_down p)

The estimate is the mean of the levels of an even number of reversals at the smallest step, so that peaks and valleys count equally (Levitt 1971). In
forced choice of two, 1up1down has no target, because chance gives 0.5.
"""
import math

TARGET = {"1up1down": 0.5, "1up2down": math.sqrt(0.5), "weighted": 0.75}
NEEDED = {"1up1down": 1, "1up2down": 2, "weighted": 1}  # yes in a row before a step down
RATIO = {"1up1down": 1.0, "1up2down": 1.0, "weighted": 3.0}  # step up over step down
# Trials between two reversals at steps of 5 % on a linear function, by simulation (checked by test_procedures.py).
TRIALS_PER_REVERSAL = {"1up1down": 1.9, "1up2down": 3.2, "weighted": 2.4}
FEWEST_REVERSALS = 4  # for an estimate; design
MAX_TRIALS = 200      # ends a staircase without reversals; design


class Staircase:
    """start, step (first step down), minimum_step, lowest, highest: in the unit of the levels. Ends after `reversals` at the smallest step, or after
    `max_trials` trials."""

    def __init__(self, rule, start, step, minimum_step, lowest, highest, reversals, max_trials=MAX_TRIALS):
        if rule not in TARGET:
            raise ValueError(f"there is no staircase '{rule}'; choose one of {', '.join(TARGET)}")
        if not (lowest <= start <= highest and lowest < highest):
            raise ValueError(f"a staircase cannot start at {start:g} between {lowest:g} and {highest:g}; start within lowest and highest")
        if not 0 < minimum_step <= step:
            raise ValueError(f"the smallest step {minimum_step:g} must be above 0 and at most the first step {step:g}")
        if reversals < FEWEST_REVERSALS or max_trials < 1:
            raise ValueError(f"{reversals} reversals are too few for a mean; give {FEWEST_REVERSALS} or more")
        self.rule, self.level, self.step, self.minimum_step = rule, float(start), float(step), float(minimum_step)
        self.lowest, self.highest, self.wanted, self.max_trials = float(lowest), float(highest), int(reversals), int(max_trials)
        self.first_steps = math.ceil(math.log2(step / minimum_step))
        self.in_a_row, self.direction = 0, 0
        self.turned, self.at_end = [], 0  # levels of the reversals at the smallest step; trials at lowest or highest
        self.history = []

    @property
    def done(self):
        return len(self.history)

    @property
    def expected(self):
        return min(self.max_trials, round((self.wanted + self.first_steps) * TRIALS_PER_REVERSAL[self.rule]) + 2)

    @property
    def finished(self):
        return len(self.turned) >= self.wanted or self.done >= self.max_trials

    def next_level(self):
        if self.finished:
            raise IndexError("this staircase has ended; check `finished` first")
        return self.level

    def answer(self, level, yes):
        """Adds the answer at `level`, which may differ from the requested level: the history stores the presented one, the rule continues from its own."""
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
        """{threshold, target, reversals, sd_reversals, at_end}: threshold is the level at which the share `target` of the answers is yes; at_end: share of
        trials at the lowest or highest level, which limit the staircase. None: fewer than FEWEST_REVERSALS."""
        count = len(self.turned) - len(self.turned) % 2
        if count < FEWEST_REVERSALS:
            return None
        last = self.turned[-count:]
        mean = sum(last) / count
        return {"threshold": mean, "target": TARGET[self.rule], "reversals": count, "sd_reversals": math.sqrt(sum((x - mean) ** 2 for x in last) / (count - 1)),
                "at_end": self.at_end / self.done}
