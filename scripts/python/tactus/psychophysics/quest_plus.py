"""QUEST+: chooses the level with the smallest expected entropy of the parameters (Watson 2017, Journal of Vision 17(3):10; Kontsevich and Tyler 1999,
Vision Research 39:2729).

The posterior is a grid over the parameters; levels have one or two dimensions. With the likelihood L(r | x, theta) of the two answers r, the expected
entropy at x is H(theta) - I(x), and I(x) = h(p(x)) - E[h(L)] with the entropy h of an answer and p(x) = E[L]. This takes two products of a matrix with the
posterior for all levels together.
"""
import itertools
import math

import numpy as np

from tactus.psychophysics.functions import function

LEAST = 1e-12        # smallest probability in a logarithm; design
MAX_CELLS = 20_000_000  # levels times parameters: 160 MB for each of two tables; design
MAX_TRIALS = 300     # with a requested precision, the end if it is not reached; design


class Tables:
    """Tables shared by all procedures of one specification: cells (t, parameters), levels, likelihood of yes (levels, t), and its entropy."""
    made = {}

    def __init__(self, name, parameters, levels):
        f = function(name)
        wrong = set(parameters) ^ set(f.parameters)
        if wrong:
            raise ValueError(f"QUEST+ of {name} needs a list of values for each of {', '.join(f.parameters)}; '{sorted(wrong)[0]}' is missing or unknown")
        if not levels or any(not values for values in parameters.values()):
            raise ValueError("QUEST+ needs levels, and values of every parameter; fill the empty list")
        size = len(levels) * math.prod(len(v) for v in parameters.values())
        if size > MAX_CELLS:
            raise ValueError(f"QUEST+ would keep {size} probabilities; give coarser lists with at most {MAX_CELLS} probabilities")
        self.names = f.parameters
        self.levels = levels
        self.cells = np.array(list(itertools.product(*(parameters[n] for n in self.names))), dtype=float)
        at = np.array(levels, dtype=float)
        self.yes = np.stack([f.p(at, **dict(zip(self.names, cell))) for cell in self.cells], axis=1)
        self.entropy = answer_entropy(self.yes)

    @classmethod
    def of(cls, name, parameters, levels):
        """Tables of a specification, from a cache of four, because their computation takes longer than a simulated session."""
        key = (name, tuple((k, tuple(v)) for k, v in sorted(parameters.items())), tuple(levels))
        if key not in cls.made:
            if len(cls.made) >= 4:
                cls.made.pop(next(iter(cls.made)))
            cls.made[key] = cls(name, parameters, levels)
        return cls.made[key]


def answer_entropy(p):
    """Entropy of an answer that is yes with probability p, nats."""
    p = np.clip(p, LEAST, 1 - LEAST)
    return -(p * np.log(p) + (1 - p) * np.log1p(-p))


def level_list(levels):
    """[number], or [(a, b)]: all pairs of two lists, or the given pairs."""
    if levels and isinstance(levels[0], (list, tuple)):
        if len(levels) == 2 and (len(levels[0]) != 2 or len(levels[1]) != 2):
            return [(float(a), float(b)) for a, b in itertools.product(*levels)]
        return [(float(a), float(b)) for a, b in levels]
    return [float(x) for x in levels]


class QuestPlus:
    """function: name; parameters: name -> values, a single value for a known one; prior: name -> weights of the values; default: flat.

    Ends after `trials`, or when the standard deviation of each parameter in stop_sd is at most the given value, at the latest after MAX_TRIALS."""

    def __init__(self, function_name, parameters, levels, trials=None, stop_sd=None, prior=None):
        if (trials is None) == (stop_sd is None):
            raise ValueError("QUEST+ ends after a number of trials or at a precision; give one of trials and stop_sd")
        parameters = {k: [float(x) for x in v] for k, v in parameters.items()}
        self.tables = Tables.of(function_name, parameters, level_list(levels))
        if stop_sd is not None and not isinstance(stop_sd, dict):
            stop_sd = {self.tables.names[0]: float(stop_sd)}
        if stop_sd and set(stop_sd) - set(self.tables.names):
            raise ValueError(f"stop_sd names '{sorted(set(stop_sd) - set(self.tables.names))[0]}', which is not a parameter of {function_name}; it has {', '.join(self.tables.names)}")
        if trials is not None and trials < 1:
            raise ValueError(f"{trials} trials are too few; give one or more")
        self.trials, self.stop_sd = trials, stop_sd
        self.posterior = prior_of(self.tables.names, parameters, prior or {})
        self.history, self.next = [], None

    @property
    def done(self):
        return len(self.history)

    @property
    def expected(self):
        """Estimated number of trials; with stop_sd from the posterior variance, which falls as 1 / trials."""
        if self.trials is not None:
            return self.trials
        if self.finished:
            return self.done
        if self.done < 10:
            return 50  # design
        worst = max(self.deviation(n) / sd for n, sd in self.stop_sd.items())
        return int(min(MAX_TRIALS, max(self.done + 1, math.ceil(self.done * worst ** 2))))

    @property
    def finished(self):
        if self.trials is not None:
            return self.done >= self.trials
        return self.done >= MAX_TRIALS or (self.done > 0 and all(self.deviation(n) <= sd for n, sd in self.stop_sd.items()))

    def next_level(self):
        if self.finished:
            raise IndexError("this QUEST+ has ended; check `finished` first")
        if self.next is None:
            gain = answer_entropy(self.tables.yes @ self.posterior) - self.tables.entropy @ self.posterior
            self.next = self.tables.levels[int(gain.argmax())]
        return self.next

    def answer(self, level, yes):
        """Adds the answer at `level`; a level that is not in the list counts as the nearest one in it."""
        at = np.array(self.tables.levels, dtype=float).reshape(len(self.tables.levels), -1)
        row = self.tables.yes[int(np.abs(at - np.array(level, dtype=float)).sum(axis=1).argmin())]
        posterior = self.posterior * (row if yes else 1 - row)
        if posterior.sum() <= 0:
            raise ValueError(f"an answer at {level} is impossible for every parameter in the lists; include a lapse rate above 0")
        self.posterior = posterior / posterior.sum()
        self.history.append((level, bool(yes)))
        self.next = None

    def mean(self, name):
        return float(self.posterior @ self.tables.cells[:, self.tables.names.index(name)])

    def deviation(self, name):
        values = self.tables.cells[:, self.tables.names.index(name)]
        return math.sqrt(max(0.0, float(self.posterior @ (values - self.posterior @ values) ** 2)))

    def entropy(self):
        """Entropy of the posterior, bits."""
        p = self.posterior[self.posterior > 0]
        return float(-(p * np.log2(p)).sum())

    def credible(self, name, level=0.95):
        """(low, high): central interval of the marginal posterior. The probability of each value is spread evenly over the range half way to its
        neighbours."""
        column = self.tables.cells[:, self.tables.names.index(name)]
        values, where = np.unique(column, return_inverse=True)
        if len(values) == 1:
            return float(values[0]), float(values[0])
        weights = np.bincount(where, weights=self.posterior)
        half = np.diff(values) / 2
        edges = np.concatenate([[values[0] - half[0]], values[:-1] + half, [values[-1] + half[-1]]])
        cumulative = np.concatenate([[0], np.cumsum(weights)]) / weights.sum()
        low, high = np.interp([(1 - level) / 2, (1 + level) / 2], cumulative, edges)
        return float(low), float(high)

    def estimate(self):
        """{name: posterior mean, name_sd: standard deviation} of each parameter with several values, and entropy_bits."""
        free = [n for i, n in enumerate(self.tables.names) if len(np.unique(self.tables.cells[:, i])) > 1]
        found = {key: value for n in free for key, value in ((n, self.mean(n)), (f"{n}_sd", self.deviation(n)))}
        return {**found, "entropy_bits": self.entropy()}


def prior_of(names, parameters, prior):
    """(t,) the product of the weights of each parameter."""
    wrong = set(prior) - set(names)
    if wrong:
        raise ValueError(f"there is a prior of '{sorted(wrong)[0]}', which is not a parameter; choose from {', '.join(names)}")
    weights = []
    for n in names:
        w = np.array(prior.get(n, [1.0] * len(parameters[n])), dtype=float)
        if w.shape != (len(parameters[n]),) or (w < 0).any() or w.sum() <= 0:
            raise ValueError(f"the prior of {n} needs {len(parameters[n])} weights, none below 0 and not all 0")
        weights.append(w / w.sum())
    joint = weights[0]
    for w in weights[1:]:
        joint = np.multiply.outer(joint, w)
    return joint.ravel()
