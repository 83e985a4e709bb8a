"""Fits of psychometric functions to answers: maximum likelihood with lapse and guess rates.

  fit(levels, yes, total, "order")          one set of answers -> Fit
  fit_many(levels, yes, total, "order")     n sets at once, arrays (n, k) -> Fits
  interval(fit, "pss")                      (low, high)

Lapse rates are sought within [0, 0.06] (Wichmann and Hill 2001), guess rates of yes/no tasks within [0, 0.5] under the weak prior Beta(1, 10)
(Schuett et al. 2016); of forced choice the guess rate is fixed by the number of choices: fixed={"guess": 0.5}.
"""
import dataclasses
import math

import numpy as np

from tactus.psychophysics import intervals
from tactus.psychophysics.functions import GUESS as GUESS_BOUNDS, LAPSE as LAPSE_BOUNDS, function
from tactus.psychophysics.likelihood import GUESS, LAPSE, Q, T, Answers, log_likelihood, probability
from tactus.psychophysics.starts import fit_from_grid

FARTHEST = 3.0              # locations are sought so many spans of the levels to either side of their middle; design
SPREAD = (1e-3, 30.0)       # and spreads within so many spans; design
WIDEST = 1.5                # spans of the levels: a wider spread was not measured; design
FIRST_RATES = (0.02, 0.02)  # guess and lapse of a first guess; design


@dataclasses.dataclass
class Fits:
    """n fits of one function. theta (n, 4) and answers are on an axis where the levels of each set span 1, from -0.5 to 0.5: z = middle +
    span * axis. free (4,): what was fitted. value (n,): log likelihood and prior. done (n,): scoring reached its end."""
    function: object
    answers: Answers
    theta: np.ndarray
    value: np.ndarray
    done: np.ndarray
    free: np.ndarray
    low: np.ndarray
    high: np.ndarray
    middle: np.ndarray
    span: np.ndarray
    fixed: dict

    def __len__(self):
        return len(self.theta)

    def rows(self, index):
        return dataclasses.replace(self, answers=self.answers.rows(index), **{name: getattr(self, name)[index] for name in (
            "theta", "value", "done", "low", "high", "middle", "span")})

    def inner(self):
        """(m, s, guess, lapse), each (n,), on the axis of the function."""
        return self.middle + self.span * self.theta[:, Q], self.span * np.exp(self.theta[:, T]), self.theta[:, GUESS], self.theta[:, LAPSE]

    def estimates(self, name):
        """(n,) of a parameter or a derived value."""
        m, s, guess, lapse = self.inner()
        found = self.function.outer(m, s, guess, lapse)
        if name in found:
            return np.asarray(found[name])
        if name in self.function.widths():
            return self.function.widths()[name] * s
        if name in self.function.anchors():
            return self.function.level_of(m + s * self.function.anchor(name, guess))
        raise ValueError(f"{self.function.name} has no parameter '{name}'; it has {', '.join([*found, *self.function.anchors(), *self.function.widths()])}")

    def placed(self):
        """(n,) whether the levels reach the threshold: answers differ, the location is within the levels or a spread beside them, and the spread is
        at most WIDEST."""
        spread, yes = np.exp(self.theta[:, T]), self.answers.yes.sum(axis=1)
        return (np.abs(self.theta[:, Q]) <= 0.5 + spread) & (spread <= WIDEST) & (yes > 0) & (yes < self.answers.total.sum(axis=1))


@dataclasses.dataclass
class Fit:
    """One fit.

    params, derived: name -> value in the units of the levels. log_likelihood: at the maximum, without binomial coefficients and prior.
    deviance: twice what the log likelihood is below that of the observed shares (Wichmann and Hill 2001). converged: scoring
    came to its end, and the levels reach the threshold (Fits.placed). at_bound: names of what ended at the end of where it was sought."""
    function: str
    params: dict
    derived: dict
    log_likelihood: float
    deviance: float
    converged: bool
    at_bound: tuple
    fixed: dict
    many: Fits

    def value(self, name):
        return float(self.many.estimates(name)[0])


def arranged(levels, yes, total):
    """Arrays (n, k) of float; ValueError when they are no answers."""
    levels, yes, total = (np.asarray(a, dtype=float) for a in (levels, yes, total))
    levels = np.broadcast_to(levels, yes.shape)
    if yes.ndim != 2 or total.shape != yes.shape:
        raise ValueError(f"levels, yes and total have the shapes {levels.shape}, {yes.shape} and {total.shape}; give as many of each")
    if not (np.isfinite(levels).all() and np.isfinite(yes).all() and np.isfinite(total).all()):
        raise ValueError("levels, yes or total hold what is no number; leave such trials out")
    if (yes < 0).any() or (yes > total).any():
        raise ValueError("there are more yes than trials at a level, or fewer than none; yes counts the trials of total that were answered so")
    if (((total > 0).sum(axis=1)) < 1).any():
        raise ValueError("a set without any trial cannot be fitted; leave it out")
    return levels, yes, total


def fit_many(levels, yes, total, name, fixed=None):
    """Fits of n sets of answers. levels (k,) or (n, k), yes and total (n, k); total 0 fills up shorter sets. fixed: name -> value of guess or
    lapse."""
    shape, fixed = function(name), dict(fixed or {})
    if shape.dimensions != 1:
        raise ValueError(f"{name} has two levels in each trial; it is estimated by QUEST+ and not fitted here")
    wrong = set(fixed) - set(shape.parameters[2:])
    if wrong:
        raise ValueError(f"'{sorted(wrong)[0]}' of {name} cannot be fixed; {' and '.join(shape.parameters[2:])} can")
    levels, yes, total = arranged(levels, yes, total)
    z = shape.z(levels)
    used = total > 0
    lowest, highest = np.where(used, z, np.inf).min(axis=1), np.where(used, z, -np.inf).max(axis=1)
    middle, span = (lowest + highest) / 2, np.where(highest > lowest, highest - lowest, 1.0)
    answers = Answers(shape, np.where(used, (z - middle[:, None]) / span[:, None], 0.0), yes, total)
    n = len(z)
    rates = np.tile([0.0 if shape.symmetric else fixed.get("guess", FIRST_RATES[0]), fixed.get("lapse", FIRST_RATES[1])], (n, 1)).astype(float)
    free = np.array([True, True, "guess" not in fixed and not shape.symmetric, "lapse" not in fixed])
    low = np.tile([-FARTHEST, math.log(SPREAD[0]), GUESS_BOUNDS[0], LAPSE_BOUNDS[0]], (n, 1))
    high = np.tile([FARTHEST, math.log(SPREAD[1]), GUESS_BOUNDS[1], LAPSE_BOUNDS[1]], (n, 1))
    theta, value, done = fit_from_grid(answers, rates, free, low, high)
    return Fits(shape, answers, theta, value, done, free, low, high, middle, span, fixed)


def fit(levels, yes, total, name, fixed=None, rng=None):
    """Fit of one set: levels, yes, total (k,). rng is not needed: the maximum is found without chance."""
    levels, yes, total = (np.asarray(a, dtype=float).reshape(1, -1) for a in (levels, yes, total))
    many = fit_many(levels, yes, total, name, fixed)
    m, s, guess, lapse = (float(v[0]) for v in many.inner())
    params = {k: float(v) for k, v in many.function.outer(m, s, guess, lapse).items()}
    likelihood = float(log_likelihood(many.answers, probability(many.function, many.answers.z, many.theta)[0])[0])
    named = dict(zip((many.function.location, many.function.spread, "guess", "lapse"), range(4)))
    at = tuple(n for n, i in named.items() if many.free[i] and (many.theta[0, i] <= many.low[0, i] or many.theta[0, i] >= many.high[0, i]))
    return Fit(name, params, many.function.derived(m, s, guess), likelihood, 2 * (saturated(yes[0], total[0]) - likelihood),
               bool(many.done[0] and many.placed()[0]), at, dict(many.fixed), many)


def saturated(yes, total):
    """Log likelihood of the observed shares themselves."""
    no = total - yes
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.where(yes > 0, yes * np.log(yes / total), 0).sum() + np.where(no > 0, no * np.log(no / total), 0).sum())


def interval(fitted, name, level=0.95, rng=None, method="posterior"):
    """(low, high) of a parameter or derived value of a Fit; what was fixed has no width. intervals.py says what the methods are; rng is for the bootstrap."""
    low, high = intervals.of_many(fitted.many, name, level, method, rng)
    return float(low[0]), float(high[0])
