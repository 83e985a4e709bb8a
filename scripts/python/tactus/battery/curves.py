"""The curves of all players over the levels of one operator: right answers naive and adapted, and detection."""
import dataclasses

import numpy as np

from tactus.battery import answers, conditions, limits

MARGIN = 0.10     # of right answers that a limit takes; as in the studies of games
DETECTED = 0.75   # right answers of a threshold of detection in two intervals


@dataclasses.dataclass(frozen=True)
class Curve:
    """task: name. success: {expectation: [player, level]}; undegraded: [player]; detected: [player, level]."""
    task: str
    sense: str
    stage: str
    operator: str
    levels: tuple
    undegraded: np.ndarray
    success: dict
    detected: np.ndarray

    def limits(self, expectation):
        """The level of each player at which MARGIN fewer answers are right than undegraded."""
        return [limits.crossing(self.levels, before - of_player, MARGIN) for before, of_player in zip(self.undegraded, self.success[expectation])]

    def thresholds(self):
        """The level of each player at which the degradation is detected."""
        return [limits.crossing(self.levels, of_player, DETECTED) for of_player in self.detected]


def measure(parts, sense, stage, operator, players, draws, seed):
    """The Curve of these Perceivers. parts: answers.Parts of the task. draws: of answers for each level; detection has a fifth of them for each scene and kind."""
    levels = conditions.curves(sense)[stage, operator]
    found = [conditions.Condition(operator, level, stage) for level in levels]
    table = lambda question: [question.success(player, draws, seed) for player in players]
    undegraded = np.array(table(answers.Question(parts, {}, answers.NAIVE)))
    success = {expectation: np.array([table(answers.Question(parts, {sense: one}, expectation)) for one in found]).T for expectation in answers.EXPECTATIONS}
    scenes = parts.stored.shape[0] * parts.stored.shape[1]
    compared = max(8, draws // (5 * scenes))
    detected = np.array([[answers.Comparison(parts, sense, one).right(player, compared, seed) for player in players] for one in found]).T
    return Curve(parts.stored.task.name, sense, stage, operator, levels, undegraded, success, detected)


def frontier(parts, pairs, players, draws, seed):
    """Mean right answers of the players under two degraded senses: {(level, level)}. pairs: ((sense, operator, levels), (sense, operator, levels))."""
    (a, of_a, first), (b, of_b, second) = pairs
    found = np.zeros((len(first), len(second)))
    for i, x in enumerate(first):
        for j, y in enumerate(second):
            both = {sense: conditions.Condition(operator, level) for sense, operator, level in ((a, of_a, x), (b, of_b, y)) if level}
            question = answers.Question(parts, both, answers.NAIVE)
            found[i, j] = np.mean([question.success(player, draws, seed) for player in players])
    return found
