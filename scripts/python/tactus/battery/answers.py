"""Right answers of a player in a degraded task, and how well the player detects the degradation.

The player chooses the value whose renderings make the percepts most likely, with its own noise. A *naive* player expects undegraded percepts. An *adapted* one expects those of the degradation,
which it can for operators without draws. Percepts have outliers, so an unexpected percept misleads a player only as far as an outlier explains it. Where nothing is
perceived, the other features of the sense count for nothing.
"""
import dataclasses
import math

import numpy as np

from tactus.battery import conditions, perceivers
from tactus.information import degraded, pictures

NAIVE, ADAPTED = "naive", "adapted"
EXPECTATIONS = (NAIVE, ADAPTED)
OUTLIERS = 0.01  # share of a feature that comes from anywhere; design: half the share of lapses
SEPARATE = ("times",)  # the time of the first sound, and the interval between the two loudest
BROAD = 10.0     # standard deviation of an outlier, as a multiple of the spread of the feature over the renderings; design


@dataclasses.dataclass(frozen=True)
class Feature:
    """Components of one feature. values, sds: [value, variant, component] of the typical player. presence: [value, variant], whether anything is perceived; None: the feature is
    this presence itself, or always there. wrong: share of percepts of another rendering."""
    sense: str
    name: str
    values: np.ndarray
    sds: np.ndarray
    presence: object = None
    wrong: float = 0.0

    @property
    def is_presence(self):
        return self.name in perceivers.PRESENCE

    def deviations(self, perceiver):
        """The standard deviations for a player; those of an absent feature have no meaning."""
        return self.sds * perceiver.factors.get(perceivers.FEATURE_OF.get((self.sense, self.name)), 1.0)


def features(stored, sense, condition, seed):
    """[Feature] of a rendering of a sense that has no pictures, window after window."""
    number, name, wrong = stored.columns(sense)
    values, sds = stored.features(sense, condition, seed)
    found, presence = [], None
    for pick in picks(number, name):
        if name[pick][0] in perceivers.PRESENCE:
            presence = values[:, :, pick][:, :, 0] > 0.5
        found.append(Feature(sense, str(name[pick][0]), values[:, :, pick], sds[:, :, pick], None if name[pick][0] in perceivers.PRESENCE else presence, float(wrong[pick][0])))
    return found


def picks(number, name):
    """Masks of the components of each feature, in order; components that are percepts of their own are features of their own."""
    for f in np.unique(number):
        mine = np.flatnonzero(number == f)
        for part in (mine[:, None] if name[mine[0]] in SEPARATE else [mine]):
            yield np.isin(np.arange(len(number)), part)


def log_normal(y, mean, sd):
    """log density [draw, value, variant] of percepts y [draw, component] with independent components."""
    z = (y[:, None, None, :] - mean) / sd
    return -0.5 * np.sum(z * z, axis=-1) - np.sum(np.log(sd), axis=-1)


def log_likelihood(y, heard, expected, perceiver):
    """log p(percepts | value, variant) [draw, value, variant] of a Feature that is expected. heard: [draw], whether anything was perceived; None: always."""
    if expected.is_presence:
        same = (y[:, None, None, 0] > 0.5) == (expected.values[:, :, 0] > 0.5)
        return np.where(same, math.log1p(-OUTLIERS), math.log(OUTLIERS))
    sd = expected.deviations(perceiver)
    there = np.ones(expected.values.shape[:2], bool) if expected.presence is None else expected.presence
    if not there.any():
        return np.zeros((len(y), *there.shape))
    middle, spread = expected.values[there].mean(axis=0), expected.values[there].std(axis=0) + sd[there].mean(axis=0)
    broad = log_normal(y, middle, BROAD * spread)
    log_p = np.where(there, log_normal(y, expected.values, sd), broad)
    if expected.wrong > 0:
        any_p = np.logaddexp.reduce(log_p[:, there], axis=1) - math.log(there.sum())
        log_p = np.logaddexp(math.log1p(-expected.wrong) + log_p, math.log(expected.wrong) + any_p[:, None, None])
    log_p = np.logaddexp(math.log1p(-OUTLIERS) + log_p, math.log(OUTLIERS) + broad)
    return log_p if heard is None else np.where(heard[:, None, None], log_p, 0.0)


def drawn(presented, perceiver, values, variants, random):
    """(percepts [draw, component], whether anything is perceived [draw] or None) of a Feature that is presented, for the renderings (values[i], variants[i])."""
    v, e = values, variants
    if presented.wrong > 0:
        other = random.random(len(v)) < presented.wrong
        anything = random.integers(presented.values.shape[0], size=len(v)), random.integers(presented.values.shape[1], size=len(v))
        if presented.presence is not None:
            other &= presented.presence[anything] & presented.presence[v, e]
        v, e = np.where(other, anything[0], v), np.where(other, anything[1], e)
    y = presented.values[v, e] + (0 if presented.is_presence else presented.deviations(perceiver)[v, e]) * random.standard_normal((len(v), presented.values.shape[2]))
    return y, None if presented.presence is None else presented.presence[values, variants]


class Parts:
    """The features of a task under conditions of its senses."""

    def __init__(self, stored):
        self.stored = stored
        self.of_pictures = {}

    def of(self, sense, condition, seed, together):
        """[Feature] of a rendering. together: the condition whose pictures have common coordinates with the undegraded ones."""
        if sense != "visual":
            return features(self.stored, sense, condition, seed)
        values = self.coordinates(together)[condition, seed]
        return [Feature(sense, "pictures", values, np.ones(values.shape))]

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
        if expectation == ADAPTED and any(len(condition.seeds) > 1 for condition in degradations.values()):
            raise ValueError("a player cannot be adapted to one draw")
        self.shape = parts.stored.shape
        self.sides = []  # of each draw: {sense: ([expected Feature], [presented Feature])}
        for seed in max((condition.seeds for condition in degradations.values()), key=len, default=conditions.SEEDS[:1]):
            side = {}
            for sense in parts.stored.task.senses:
                condition = degradations.get(sense, conditions.UNDEGRADED)
                presented = parts.of(sense, condition, seed if seed in condition.seeds else conditions.SEEDS[0], condition)
                side[sense] = presented if expectation == ADAPTED else parts.of(sense, conditions.UNDEGRADED, conditions.SEEDS[0], condition), presented
            self.sides.append(side)

    def success(self, perceiver, draws, seed):
        """Share of right answers of a player in about `draws` draws. Among equal posteriors the answer is a random choice."""
        return float(np.mean(np.concatenate([self.right(side, perceiver, -(-draws // len(self.sides)), np.random.default_rng(seed)) for side in self.sides])))

    def right(self, side, perceiver, draws, random):
        values, variants = np.arange(draws) % self.shape[0], random.integers(self.shape[1], size=draws)
        total = np.zeros((draws, *self.shape))
        for expected, presented in side.values():
            attended = (random.random(draws) >= perceiver.lapse)[:, None, None]
            for e, p in zip(expected, presented):
                total += np.where(attended, log_likelihood(*drawn(p, perceiver, values, variants, random), e, perceiver), 0.0)
        posterior = np.logaddexp.reduce(total, axis=2)
        best = posterior >= posterior.max(axis=1, keepdims=True) - 1e-9
        return best[np.arange(draws), values] / best.sum(axis=1)


class Comparison:
    """Detection of a degradation of one sense: one of two presentations of the same scene is degraded, and the player answers which (2IFC). The player has met the
    degradation before, so the answer follows the likelihood ratio, and the share of right answers is the area below its ROC curve (Green and Swets 1966)."""

    def __init__(self, parts, sense, condition):
        self.shape = parts.stored.shape
        self.plain, self.degraded = parts.of(sense, conditions.UNDEGRADED, conditions.SEEDS[0], condition), parts.of(sense, condition, conditions.SEEDS[0], condition)

    def right(self, perceiver, draws, seed):
        """Share of right answers of a player with `draws` presentations of each kind of every value and variant."""
        random = np.random.default_rng(seed)
        values, variants = (np.tile(i.reshape(-1), draws) for i in np.indices(self.shape))
        shown = [self.ratio(side, perceiver, values, variants, random).reshape(draws, -1) for side in (self.degraded, self.plain)]
        areas = [area(shown[0][:, i], shown[1][:, i]) for i in range(shown[0].shape[1])]
        return float((1 - perceiver.lapse) * np.mean(areas) + perceiver.lapse / 2)

    def ratio(self, side, perceiver, values, variants, random):
        """log p(percepts | degraded) - log p(percepts | undegraded) of drawn percepts of known scenes (values[i], variants[i])."""
        total = np.zeros(len(values))
        for presented, plain, degraded_one in zip(side, self.plain, self.degraded):
            percepts = drawn(presented, perceiver, values, variants, random)
            of_scene = lambda expected: log_likelihood(*percepts, expected, perceiver)[np.arange(len(values)), values, variants]
            total += of_scene(degraded_one) - of_scene(plain)
        return total


def area(signal, noise):
    """Area below the ROC curve: the probability that a value of `signal` exceeds one of `noise`, equal values counted half (Mann and Whitney 1947)."""
    difference = signal[:, None] - noise[None, :]
    return float(np.mean((difference > 0) + 0.5 * (difference == 0)))
