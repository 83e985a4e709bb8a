"""Right answers of a player in a degraded task, and how well the player detects the degradation.

The answers are those of an ideal observer (information/estimate.py) with the noise of the player. A *naive* player expects undegraded percepts. An *adapted* one expects those of the
degradation: the same rendering where nothing is drawn; else renderings of other draws, and undegraded ones. Draws of percepts are the same for all
players and conditions.
"""
import dataclasses

import numpy as np

from tactus.battery import conditions, perceivers
from tactus.information import degraded, estimate, pictures

NAIVE, ADAPTED = "naive", "adapted"
EXPECTATIONS = (NAIVE, ADAPTED)


@dataclasses.dataclass(frozen=True)
class Part:
    """Features of one sense with the same confused share. values, sds: arrays [value, variant, component] of the typical player."""
    sense: str
    values: np.ndarray
    sds: np.ndarray
    columns: tuple
    wrong: float

    def percept(self, perceiver):
        sds = self.sds * perceiver.factors.get("visual noise", 1.0) if self.sense == "visual" else perceivers.deviations(perceiver, self.sense, self.values, self.sds, self.columns)
        return estimate.Percept(self.sense, self.values, sds, self.wrong)


def draws_of(condition, expectation, seed):
    """[(condition, seed)] of the renderings that a player expects when the draw `seed` of a condition is presented."""
    if expectation == NAIVE or not condition.operator:
        return [(conditions.UNDEGRADED, conditions.SEEDS[0])]
    others = [(condition, other) for other in condition.seeds if other != seed]
    return others + [(conditions.UNDEGRADED, conditions.SEEDS[0])] if others else [(condition, seed)]


class Parts:
    """The features of a task under conditions of its senses, ready for players."""

    def __init__(self, stored):
        self.stored = stored
        self.of_pictures = {}

    def of(self, sense, draws, condition):
        """[Part] of several renderings, one after the other along the variants. condition: that of the pictures among these draws, or undegraded."""
        if sense == "visual":
            values = np.concatenate([self.coordinates(condition)[draw] for draw in draws], axis=1)
            return [Part(sense, values, np.ones(values.shape), (), 0.0)]
        feature, name, wrong = columns = self.stored.columns(sense)
        values, sds = (np.concatenate(each, axis=1) for each in zip(*(self.stored.features(sense, *draw) for draw in draws)))
        chosen = [wrong == 0, *(feature == f for f in np.unique(feature[wrong > 0]))]
        deviating = lambda pick: tuple(column[pick] for column in columns)
        return [Part(sense, values[:, :, pick], sds[:, :, pick], deviating(pick), float(wrong[pick][0])) for pick in chosen if pick.any()]

    def coordinates(self, condition):
        """{(condition, seed): [value, variant, k]} of the pictures under a condition and undegraded, in common coordinates whose distances are d'. Looks count
        as far as all renderings have them."""
        if condition not in self.of_pictures:
            draws = list(dict.fromkeys([(conditions.UNDEGRADED, conditions.SEEDS[0]), *((condition, seed) for seed in condition.seeds)]))
            rows = [row for draw in draws for row in self.stored.pixels(*draw)]
            length = min(map(len, rows))
            found = pictures.coordinates([row[:length] for row in rows], degraded.SIZE[0]) * degraded.SKIPPED
            self.of_pictures[condition] = {draw: part.reshape(*self.stored.shape, -1) for draw, part in zip(draws, np.split(found, len(draws)))}
        return self.of_pictures[condition]


class Question:
    """A task under one condition for each of some senses ({sense: condition}; others are undegraded) with one expectation, for many players."""

    def __init__(self, parts, degradations, expectation):
        self.sides = []  # of each draw: ([expected Part], [presented Part])
        seeds = max((condition.seeds for condition in degradations.values()), key=len, default=conditions.SEEDS[:1])
        for seed in seeds:
            drawn = {sense: degradations.get(sense, conditions.UNDEGRADED) for sense in parts.stored.task.senses}
            one = {sense: seed if seed in condition.seeds else conditions.SEEDS[0] for sense, condition in drawn.items()}
            expected = {sense: draws_of(condition, expectation, one[sense]) for sense, condition in drawn.items()}
            count = max(map(len, expected.values()))
            if any(count % len(draws) for draws in expected.values()):
                raise ValueError("senses with 2 and 3 expected renderings cannot be combined")
            both = ([], [])
            for sense, condition in drawn.items():
                both[0].extend(parts.of(sense, expected[sense] * (count // len(expected[sense])), condition))
                both[1].extend(parts.of(sense, [(condition, one[sense])] * count, condition))
            self.sides.append(both)

    def success(self, perceiver, draws, seed):
        """Share of right answers of a player in about `draws` draws."""
        right = []
        for number, (expected, presented) in enumerate(self.sides):
            observer = estimate.Observer([p.percept(perceiver) for p in expected], -(-draws // len(self.sides)), seed + number, perceiver.lapse,
                                         presented=[p.percept(perceiver) for p in presented])
            right.append(observer.judged(observer.senses)[1])
        return float(np.mean(np.concatenate(right)))


class Comparison:
    """Detection of a degradation of one sense: one of two presentations of the same scene is degraded, and the player says which (2IFC). The player has met the
    degradation before, so the answer follows the likelihood ratio, and the share of right answers is the area below its ROC curve (Green and Swets 1966)."""

    def __init__(self, parts, sense, condition):
        plain = [(conditions.UNDEGRADED, conditions.SEEDS[0])]
        self.variants = parts.stored.shape[1]
        self.sides = []
        for seed in condition.seeds:
            others = [(condition, other) for other in condition.seeds if other != seed] or [(condition, seed)]
            self.sides.append(tuple(parts.of(sense, draws, condition) for draws in (plain, others, [(condition, seed)])))

    def right(self, perceiver, draws, seed):
        """Share of right answers of a player with `draws` presentations of each kind of every value, variant and draw."""
        random = np.random.default_rng(seed)
        areas = []
        for plain, others, presented in self.sides:
            plain, others, presented = ([p.percept(perceiver) for p in side] for side in (plain, others, presented))
            values, variants = (np.tile(i.reshape(-1), draws) for i in np.indices((plain[0].mean.shape[0], self.variants)))
            shown = [self.ratio(side, plain, others, values, variants, random).reshape(draws, -1) for side in (presented, plain)]
            areas.append(np.mean([area(shown[0][:, i], shown[1][:, i]) for i in range(shown[0].shape[1])]))
        return float((1 - perceiver.lapse) * np.mean(areas) + perceiver.lapse / 2)

    def ratio(self, side, plain, others, values, variants, random):
        """log p(percepts | degraded) - log p(percepts | undegraded) of drawn percepts of known scenes (values[i], variants[i])."""
        total = 0.0
        n = len(values)
        for shown, p, o in zip(side, plain, others):
            v, e = values, variants
            if shown.wrong > 0:
                other = random.random(n) < shown.wrong
                v = np.where(other, random.integers(shown.mean.shape[0], size=n), v)
                e = np.where(other, random.integers(self.variants, size=n), e)
            y = shown.mean[v, e] + shown.sd[v, e] * random.standard_normal((n, shown.mean.shape[2]))
            log_o, log_p = (estimate.log_density(y, percept)[np.arange(n), values] for percept in (o, p))
            of_scene = log_o.reshape(n, -1, self.variants)[np.arange(n), :, variants]
            total = total + np.logaddexp.reduce(of_scene, axis=1) - np.log(of_scene.shape[1]) - log_p[np.arange(n), variants]
        return total


def area(signal, noise):
    """Area below the ROC curve: the probability that a value of `signal` exceeds one of `noise`, equal values counted half (Mann and Whitney 1947)."""
    difference = signal[:, None] - noise[None, :]
    return float(np.mean((difference > 0) + 0.5 * (difference == 0)))
