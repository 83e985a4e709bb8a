"""Observers that are simulated: they answer as a psychometric function of the level says, or by what they felt, each time by chance of their own seed.

Everything that is made of their answers has to say so (observer=simulated).
"""
import math

import numpy as np

from tactus.psychophysics.functions import Gaussian, function

NO_STIFFNESS_N_m = 0.1  # what gives way like this, or draws, is as soft as anything; design: 2 mN at 2 cm, of which nobody feels anything


class SimulatedObserver:
    """name: of the psychometric function; params: its parameters; seed: an integer, or a list of them."""

    def __init__(self, name, params, seed):
        self.function, self.params = function(name), {k: float(v) for k, v in params.items()}
        wrong = set(self.params) ^ set(self.function.parameters)
        if wrong:
            raise ValueError(f"an observer of {name} has the parameters {', '.join(self.function.parameters)}; {sorted(wrong)[0]} is missing or too much")
        self.dice = np.random.default_rng(seed)

    def probability(self, level):
        """Of a yes at this level (a number, or a pair for two senses)."""
        return float(self.function.p(level, **self.params))

    def answer(self, level):
        """True for yes, or for right."""
        return bool(self.dice.random() < self.probability(level))


class Presser:
    """Has felt two surfaces and calls one of them the softer, by nothing but their stiffness. weber: the share by which two have to differ so that three
    in four answers are right, lapses aside (design: the `jnd` of functions.py); stiffnesses are told apart by their ratio, whichever came first.
    lapse: share of answers by chance alone."""
    parameters = ("weber", "lapse")

    def __init__(self, weber, lapse, seed):
        if not (0 < weber < math.inf and 0 <= lapse <= 1):
            raise ValueError("a weber fraction is above 0, and a lapse rate from 0 to 1")
        self.weber, self.lapse = weber, lapse
        self.dice = np.random.default_rng(seed)

    def first_is_softer(self, first_N_m, second_N_m):
        """Probability that he says so."""
        ratio = max(second_N_m, NO_STIFFNESS_N_m) / max(first_N_m, NO_STIFFNESS_N_m)
        return self.lapse / 2 + (1 - self.lapse) * float(Gaussian.both(Gaussian.quartile * math.log(ratio) / math.log1p(self.weber))[0])

    def softer(self, first_N_m, second_N_m):
        """0 or 1: which of the two."""
        return 0 if self.dice.random() < self.first_is_softer(first_N_m, second_N_m) else 1


PERCEPTS = {"felt_stiffness": Presser}  # by the name that a study file gives them: observers who are told what was felt, not the level
