"""The order of trials. The next trial depends only on the study, the participant, the seed and the answers so far, so an interrupted session resumes
with the same trial."""
import dataclasses
import math
import random
import re
import zlib

from tactus.study import quantities, study_file

FUNCTIONS = {"synchrony": ("synchrony_window", None), "order": ("order", None), "two_interval": ("cumulative_gaussian", {"guess": 0.5})}
FEWEST_FOR_A_FIT = 30  # answers; a running estimate from fewer is meaningless (design)


@dataclasses.dataclass(frozen=True)
class Trial:
    """number: from 1, counts answered trials. level: of the condition. degraded_interval: which of two intervals is degraded, 0 or 1."""
    number: int
    block: int
    condition: object
    level: object
    degraded_interval: int = 0


def place_of(participant):
    """Row of the square for a participant: the number in the name, else a hash of the name."""
    digits = re.search(r"(\d+)\D*$", participant)
    return int(digits.group(1)) if digits else zlib.crc32(participant.encode())


def williams(n):
    """Rows of a Williams square: each condition occurs once in each column, and each follows every other equally often (Williams 1949, Australian
    Journal of Scientific Research A 2:149). For odd n these are two squares, one the mirror of the other."""
    first = [0]
    low, high = 1, n - 1
    while len(first) < n:
        first.append(low if len(first) % 2 else high)
        low, high = (low + 1, high) if len(first) % 2 == 0 else (low, high - 1)
    rows = [[(x + i) % n for x in first] for i in range(n)]
    return rows if n % 2 == 0 else rows + [row[::-1] for row in rows]


def order_of(n, kind, participant, block, seed):
    """The order of n conditions in one block."""
    if kind == "latin_square":
        rows = williams(n)
        return rows[(place_of(participant) + block) % len(rows)]
    order = list(range(n))
    if kind == "random":
        random.Random(f"{seed} {participant} order {block}").shuffle(order)
    return order


class Plan:
    """All trials of one participant. `next()` returns the trial, `answered(trial, yes)` counts it. A missed trial is not counted, so `next()` returns it
    again."""

    def __init__(self, study, participant, seed=None):
        self.study, self.participant = study, participant
        self.seed = study.seed if seed is None else seed
        self.done = 0
        self.performs = study.response == "performance"
        if self.performs:
            self.games = study.procedure.get("repetitions", 1)
            self.sequence = [i for block in range(self.games) for i in order_of(len(study.conditions), study.counterbalance, participant, block, self.seed)]
        else:
            from tactus.psychophysics import procedures  # loads slowly
            from tactus.study import procedure_element
            self.procedures = [procedures.make_procedure(procedure_element.of_condition(study.procedure, c), self.draw(f"procedure {c.id}")) for c in study.conditions]

    def draw(self, what):
        """A separate seed for each use."""
        return zlib.crc32(f"{self.seed} {self.participant} {what}".encode())

    @property
    def expected_trials(self):
        return len(self.sequence) if self.performs else sum(p.expected for p in self.procedures)

    @property
    def finished(self):
        return self.done >= len(self.sequence) if self.performs else all(p.finished for p in self.procedures)

    @property
    def trials_a_block(self):
        return max(1, math.ceil(self.expected_trials / self.study.blocks))

    def block_of(self, number):
        """Block of the trial with this number, from 1. Trials beyond the expected number belong to the last block."""
        return min(self.study.blocks, 1 + (number - 1) // self.trials_a_block)

    def next(self):
        """The next Trial; None: all are done."""
        if self.finished:
            return None
        number = self.done + 1
        if self.performs:
            condition = self.study.conditions[self.sequence[self.done]]
            return Trial(number, self.block_of(number), condition, condition.fixed)
        # Draws an unfinished procedure with a probability proportional to its remaining trials, which interleaves them evenly.
        left = [i for i, p in enumerate(self.procedures) if not p.finished]
        weights = [max(1, self.procedures[i].expected - self.procedures[i].done) for i in left]
        chance = random.Random(f"{self.seed} {self.participant} trial {number}")
        i = chance.choices(left, weights)[0]
        condition, level = self.study.conditions[i], self.procedures[i].next_level()
        if condition.kind == "pair":
            level = condition.levels[int(level)]
        return Trial(number, self.block_of(number), condition, level, chance.randrange(2))

    def answered(self, trial, yes):
        """Counts an answer. yes: input of the procedure, True or False; ignored for a game, rating or matching."""
        if not self.performs:
            i = self.study.conditions.index(trial.condition)
            level = trial.condition.levels.index(trial.level) if trial.condition.kind == "pair" else trial.level
            self.procedures[i].answer(level, bool(yes))
        self.done += 1

    def estimates(self):
        """{condition id: running estimate of its procedure}. A procedure without an estimate (constant stimuli) gets a fit of its answers; None: too few
        answers."""
        if self.study.response not in study_file.YES_OR_NO:
            return {}
        return {c.id: p.estimate() or (None if any(f.operator in quantities.LOWER_IS_WORSE for f in c.factors) else self.fitted(p)) for c, p in zip(self.study.conditions, self.procedures)}

    def fitted(self, procedure):
        name, fixed = FUNCTIONS[self.study.response]
        if procedure.done < FEWEST_FOR_A_FIT:
            return None
        from tactus.psychophysics import fits, procedures  # loads slowly
        fit = fits.fit(*procedures.counts(procedure.history), name, fixed)
        return {k: float(v) for k, v in list(fit.params.items())[:2]} if fit.converged else None

    def describe(self):
        """Lines that describe the plan."""
        s = self.study
        lines = [f"{s.name}: {s.response}, {self.expected_trials} {'games' if self.performs else 'trials'} in {s.blocks} block{'s' * (s.blocks > 1)}"
                 f"{f' with breaks of {s.break_s:g} s' if s.break_s and s.blocks > 1 else ''}, scene {s.scene.name}, seed {self.seed}"]
        for c in s.conditions:
            levels = "" if self.performs or not c.levels else f": {len(c.levels)} levels" if s.procedure["kind"] != "staircase" else ""
            lines.append(f"  {c.id}{levels}")
        return lines
