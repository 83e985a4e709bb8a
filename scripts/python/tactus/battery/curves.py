"""The curves of all players over the levels of one operator: right answers naive and adapted, and detection."""
import dataclasses

import numpy as np

from tactus.battery import answers, conditions, limits

MARGIN = 0.10     # of right answers that a limit takes; as in the studies of games
DETECTED = 0.75   # right answers of a threshold of detection in two intervals


@dataclasses.dataclass(frozen=True)
class Curve:
    """task: name. success: {expectation: [player, level]}; undegraded: [player]; detected: [player, level]. Operators with draws have neither adapted players nor
    detection: None."""
    task: str
    sense: str
    operator: str
    levels: tuple
    undegraded: np.ndarray
    success: dict
    detected: object

    def limits(self, expectation):
        """The level of each player at which MARGIN fewer answers are right than undegraded; None for a drawn operator and adapted players."""
        return None if expectation not in self.success else [limits.crossing(self.levels, before - of_player, MARGIN) for before, of_player in zip(self.undegraded, self.success[expectation])]

    def thresholds(self):
        """The level of each player at which the degradation is detected; None for a drawn operator."""
        return None if self.detected is None else [limits.crossing(self.levels, of_player, DETECTED) for of_player in self.detected]


def measure(parts, sense, operator, players, draws, seed):
    """The Curve of these Perceivers. parts: answers.Parts of the task. draws: of answers for each level; detection has a fifth of them for each scene and kind. A player
    has the same draws at all levels, and players have others."""
    levels = conditions.curves(sense)[operator]
    found = [conditions.Condition(operator, level) for level in levels]
    expectations = answers.EXPECTATIONS if len(found[0].seeds) == 1 else (answers.NAIVE,)
    of_players = lambda question: [question.success(player, draws, (seed, number)) for number, player in enumerate(players)]
    undegraded = np.array(of_players(answers.Question(parts, {}, answers.NAIVE)))
    success = {expectation: np.array([of_players(answers.Question(parts, {sense: one}, expectation)) for one in found]).T for expectation in expectations}
    detected = None
    if len(expectations) > 1:
        compared = max(8, draws // (5 * parts.stored.shape[0] * parts.stored.shape[1]))
        comparisons = [answers.Comparison(parts, sense, one) for one in found]
        detected = np.array([[comparison.right(player, compared, (seed, number)) for comparison in comparisons] for number, player in enumerate(players)])
    return Curve(parts.stored.task.name, sense, operator, levels, undegraded, success, detected)


def frontier(parts, pair, players, draws, seed):
    """Mean right answers of naive players under two degraded senses [first level, second level]. pair: ((sense, operator, levels), (sense, operator, levels))."""
    (a, of_a, first), (b, of_b, second) = pair
    found = np.zeros((len(first), len(second)))
    for i, x in enumerate(first):
        for j, y in enumerate(second):
            both = {sense: conditions.Condition(operator, level) for sense, operator, level in ((a, of_a, x), (b, of_b, y)) if level}
            question = answers.Question(parts, both, answers.NAIVE)
            found[i, j] = np.mean([question.success(player, draws, (seed, number)) for number, player in enumerate(players)])
    return found
