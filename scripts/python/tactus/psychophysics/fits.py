"""Fits of psychometric functions to answers: maximum likelihood with lapse and guess rates.

  fit(levels, yes, total, "order")          one set of answers -> Fit
  fit_many(levels, yes, total, "order")     n sets together, arrays (n, k) -> Fits
  interval(fit, "pss")                      (low, high)

Lapse rates are fitted within [0, 0.06] (Wichmann and Hill 2001), the peak of a synchrony window is free, guess rates of yes/no tasks within [0, 0.5] under the weak prior Beta(1, 10) (Schuett
et al. 2016). In forced choice the number of choices fixes the guess rate: fixed={"guess": 0.5}.
"""
import dataclasses
import math

import numpy as np

from tactus.psychophysics import intervals
from tactus.psychophysics.functions import GUESS as GUESS_BOUNDS, LAPSE as LAPSE_BOUNDS, function
from tactus.psychophysics.likelihood import GUESS, LAPSE, Q, T, Answers, log_likelihood, probability
from tactus.psychophysics.starts import fit_from_grid

FARTHEST = 3.0              # largest distance of a location from the middle of the levels, in spans of the levels; design
SPREAD = (1e-3, 30.0)       # range of spreads, in spans of the levels; design
WIDEST = 1.5                # largest spread of a valid fit, in spans of the levels; design
FIRST_RATES = (0.02, 0.02)  # initial guess and lapse rates; design


@dataclasses.dataclass
class Fits:
    """n fits of one function. theta (n, 4) and answers are on an axis where the levels of each set span 1, from -0.5 to 0.5: z = middle +
    span * axis. free (4,): mask of fitted parameters. value (n,): log likelihood plus log prior. done (n,): scoring converged.
    eta_prior, wide: of over-dispersed answers (overdispersion.py) the parameter b of the prior Beta(1, b) (posterior.py), and the fits whose profile
    intervals bound the posterior; 0 and None: independent answers. posteriors: results that the intervals of several parameters share (posterior.py); empty in a copy with other rows."""
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
    eta_prior: float = 0.0
    wide: "Fits" = None
    posteriors: dict = dataclasses.field(default_factory=dict, init=False, repr=False, compare=False)

    def __len__(self):
        return len(self.theta)

    def rows(self, index):
        return dataclasses.replace(self, answers=self.answers.rows(index), **{name: getattr(self, name)[index] for name in (
            "theta", "value", "done", "low", "high", "middle", "span")}, wide=None if self.wide is None else self.wide.rows(index))

    def inner(self):
        """(m, s, guess, lapse), each (n,), on the axis of the function."""
        return self.middle + self.span * self.theta[:, Q], self.span * np.exp(self.theta[:, T]), self.theta[:, GUESS], self.theta[:, LAPSE]

    def estimates(self, name):
        """(n,) values of a parameter or a derived value."""
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
        """(n,) whether the levels reach the threshold: the answers differ, the location is at most one spread outside the levels, and the spread is at most
        WIDEST."""
        spread, yes = np.exp(self.theta[:, T]), self.answers.yes.sum(axis=1)
        return (np.abs(self.theta[:, Q]) <= 0.5 + spread) & (spread <= WIDEST) & (yes > 0) & (yes < self.answers.total.sum(axis=1))


@dataclasses.dataclass
class Fit:
    """One fit.

    params, derived: name -> value in the units of the levels. log_likelihood: at the maximum, without binomial coefficients and prior. deviance: twice the
    difference of the log likelihood to that of the observed shares (Wichmann and Hill 2001). converged: scoring converged, and the levels reach the
    threshold (Fits.placed). at_bound: names of the parameters at a bound."""
    function: str
    params: dict
    derived: dict
    log_likelihood: float
    deviance: float
    converged: bool
    at_bound: tuple
    fixed: dict
    many: Fits

    @property
    def aic(self):
        """Akaike's criterion (1974, IEEE Transactions on Automatic Control 19:716); the model with the smallest describes the answers best."""
        return 2 * int(self.many.free.sum()) - 2 * self.log_likelihood

    def value(self, name):
        return float(self.many.estimates(name)[0])


def arranged(levels, yes, total):
    """Arrays (n, k) of float. Raises ValueError if they are not valid answers."""
    levels, yes, total = (np.asarray(a, dtype=float) for a in (levels, yes, total))
    levels = np.broadcast_to(levels, yes.shape)
    if yes.ndim != 2 or total.shape != yes.shape:
        raise ValueError(f"levels, yes and total have the shapes {levels.shape}, {yes.shape} and {total.shape}; give equal shapes")
    if not (np.isfinite(levels).all() and np.isfinite(yes).all() and np.isfinite(total).all()):
        raise ValueError("levels, yes or total hold values that are not finite numbers; leave such trials out")
    if (yes < 0).any() or (yes > total).any():
        raise ValueError("a level has more yes than trials, or a negative number; yes counts the yes answers among total")
    if (((total > 0).sum(axis=1)) < 1).any():
        raise ValueError("a set has no trials; leave it out")
    return levels, yes, total


def fit_many(levels, yes, total, name, fixed=None, forced_peak=False):
    """Fits of n sets of answers. levels (k,) or (n, k), yes and total (n, k); total 0 pads shorter sets. fixed: name -> value of guess or lapse. forced_peak:
    holds the peak of a window near 1, for comparison."""
    shape, fixed = function(name), dict(fixed or {})
    if shape.dimensions != 1:
        raise ValueError(f"{name} has two levels in each trial and cannot be fitted here; estimate it with QUEST+")
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
    lapse = LAPSE_BOUNDS if forced_peak else shape.bounds["lapse"]
    low = np.tile([-FARTHEST, math.log(SPREAD[0]), GUESS_BOUNDS[0], lapse[0]], (n, 1))
    high = np.tile([FARTHEST, math.log(SPREAD[1]), GUESS_BOUNDS[1], lapse[1]], (n, 1))
    theta, value, done = fit_from_grid(answers, rates, free, low, high)
    return Fits(shape, answers, theta, value, done, free, low, high, middle, span, fixed)


def fit(levels, yes, total, name, fixed=None, rng=None, forced_peak=False):
    """Fit of one set: levels, yes, total (k,). rng is not used; the search is deterministic."""
    levels, yes, total = (np.asarray(a, dtype=float).reshape(1, -1) for a in (levels, yes, total))
    many = fit_many(levels, yes, total, name, fixed, forced_peak)
    m, s, guess, lapse = (float(v[0]) for v in many.inner())
    params = {k: float(v) for k, v in many.function.outer(m, s, guess, lapse).items()}
    likelihood = float(log_likelihood(many.answers, probability(many.function, many.answers.z, many.theta)[0])[0])
    named = dict(zip((many.function.location, many.function.spread, "guess", "lapse"), range(4)))
    at = tuple(n for n, i in named.items() if many.free[i] and (many.theta[0, i] <= many.low[0, i] or many.theta[0, i] >= many.high[0, i]))
    return Fit(name, params, many.function.derived(m, s, guess, lapse), likelihood, 2 * (saturated(yes[0], total[0]) - likelihood),
               bool(many.done[0] and many.placed()[0]), at, dict(many.fixed), many)


def saturated(yes, total):
    """Log likelihood of the observed shares themselves."""
    no = total - yes
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.where(yes > 0, yes * np.log(yes / total), 0).sum() + np.where(no > 0, no * np.log(no / total), 0).sum())


def interval(fitted, name, level=0.95, rng=None, method="posterior"):
    """(low, high) of a parameter or derived value of a Fit; a fixed one has width 0. intervals.py describes the methods; rng is for the bootstrap."""
    low, high = intervals.of_many(fitted.many, name, level, method, rng)
    return float(low[0]), float(high[0])
