"""The method of constant stimuli: fixed levels, presented equally often in a random order."""
import random


class ConstantStimuli:
    """levels: numbers, or pairs for two senses; repetitions of each. Each round presents all levels once, in a random order, so that a drift over the
    session affects all levels equally."""

    def __init__(self, levels, repetitions, seed):
        if len(levels) < 1 or repetitions < 1:
            raise ValueError("constant stimuli need levels and at least one repetition of each")
        dice = random.Random(f"{seed}")
        self.levels = []
        for _ in range(repetitions):
            once = list(levels)
            dice.shuffle(once)
            self.levels += once
        self.history = []

    @property
    def done(self):
        return len(self.history)

    @property
    def expected(self):
        return len(self.levels)

    @property
    def finished(self):
        return self.done >= self.expected

    def next_level(self):
        if self.finished:
            raise IndexError("all trials of these constant stimuli are answered; check `finished` first")
        return self.levels[self.done]

    def answer(self, level, yes):
        self.history.append((level, bool(yes)))

    def estimate(self):
        """None: constant stimuli have no running estimate; fit the answers."""
        return None
