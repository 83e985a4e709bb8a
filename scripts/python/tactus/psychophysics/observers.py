"""Simulated observers: they answer randomly, by a psychometric function of the level or by felt stiffness, each with its own seed.

All results of their answers must be marked (observer=simulated).
"""
import math

import numpy as np

from tactus.psychophysics.functions import Gaussian, function

NO_STIFFNESS_N_m = 0.1  # smaller or negative stiffnesses count as this; design: 2 mN at 2 cm is not noticeable


class SimulatedObserver:
    """name: of the psychometric function; params: its parameters; seed: an integer, or a list of them."""

    def __init__(self, name, params, seed):
        self.function, self.params = function(name), {k: float(v) for k, v in params.items()}
        wrong = set(self.params) ^ set(self.function.parameters)
        if wrong:
            raise ValueError(f"an observer of {name} needs the parameters {', '.join(self.function.parameters)}; {sorted(wrong)[0]} is missing or unknown")
        self.dice = np.random.default_rng(seed)

    def probability(self, level):
        """Probability of a yes at this level (a number, or a pair for two senses)."""
        return float(self.function.p(level, **self.params))

    def answer(self, level):
        """True for yes, or for right."""
        return bool(self.dice.random() < self.probability(level))


class Presser:
    """Judges which of two felt surfaces is softer, by their stiffness only. weber: relative difference with 75 % right answers without lapses (the
    criterion of the `jnd` of functions.py; a published JND with another criterion is converted first: felt_properties.py). Only the ratio of the stiffnesses counts, not their order. lapse: share of random answers."""
    parameters = ("weber", "lapse")

    def __init__(self, weber, lapse, seed):
        if not (0 < weber < math.inf and 0 <= lapse <= 1):
            raise ValueError("a parameter is out of range; a weber fraction is above 0, and a lapse rate from 0 to 1")
        self.weber, self.lapse = weber, lapse
        self.dice = np.random.default_rng(seed)

    def first_is_softer(self, first_N_m, second_N_m):
        """Probability of the answer "the first is softer"."""
        ratio = max(second_N_m, NO_STIFFNESS_N_m) / max(first_N_m, NO_STIFFNESS_N_m)
        return self.lapse / 2 + (1 - self.lapse) * float(Gaussian.both(Gaussian.quartile * math.log(ratio) / math.log1p(self.weber))[0])

    def softer(self, first_N_m, second_N_m):
        """The answer: 0, the first is softer, or 1."""
        return 0 if self.dice.random() < self.first_is_softer(first_N_m, second_N_m) else 1


PERCEPTS = {"felt_stiffness": Presser}  # name in a study file: observer that receives felt quantities instead of the level
