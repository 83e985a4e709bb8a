"""Observers that are simulated: they answer as a psychometric function says, each time by chance of their own seed.

Everything that is made of their answers has to say so (observer=simulated).
"""
import numpy as np

from functions import function


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
