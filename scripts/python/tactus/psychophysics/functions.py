"""Psychometric functions: the probability of a yes, or of a right answer, at a level of the stimulus.

All functions of one level x are p = A + B F((z(x) - m) / s) with a core F, a location m, a spread s, and guess and lapse rates (Wichmann and Hill 2001,
Perception & Psychophysics 63:1293, equation 1: A = guess, B = 1 - guess - lapse). Levels have the unit of the study; location and spread have the same
unit, unless a class states another one.
"""
import math

import numpy as np
from scipy.special import expit, ndtr, ndtri

LAPSE = (0.0, 0.06)  # range of plausible lapse rates: Wichmann and Hill 2001
MISSED = (0.0, 0.9)  # of judgements of synchrony: their peak may be far below 1 without lapses (independent_channels.py); design
GUESS = (0.0, 0.5)   # design; above, the fitted threshold is meaningless
GUESS_PRIOR = 10.0   # Schuett et al. 2016, Vision Research 122:105: Beta(1, 10) on rates near 0
SMALLEST_LEVEL = 1e-12  # argument of a logarithm; design


def within(x, low, high):
    """x limited to a range, as numpy.clip does, in a fifth of the time for small arrays."""
    return np.minimum(np.maximum(x, low), high)


class Gaussian:
    """Phi(u)."""
    quartile = 0.6744897501960817  # Phi^-1(0.75)

    @staticmethod
    def both(u):
        """(F, dF/du)."""
        return ndtr(u), np.exp(-0.5 * u * u) / math.sqrt(2 * math.pi)

    inverse = staticmethod(ndtri)


class Logistic:
    """1 / (1 + exp(-u))."""
    quartile = math.log(3)

    @staticmethod
    def both(u):
        f = expit(u)
        return f, f * (1 - f)

    @staticmethod
    def inverse(f):
        return np.log(f) - np.log1p(-f)


class Gumbel:
    """1 - exp(-exp(u)): Weibull's distribution over logarithmic levels."""
    quartile = None

    @staticmethod
    def both(u):
        e = np.exp(within(u, -700, 40))
        return -np.expm1(-e), e * np.exp(-e)

    @staticmethod
    def inverse(f):
        return np.log(-np.log1p(-f))


class Window:
    """exp(-u^2 / 2), which rises and falls."""
    quartile = None
    half_width75 = math.sqrt(2 * math.log(4 / 3))  # u at 75 % of the peak

    @staticmethod
    def both(u):
        f = np.exp(-0.5 * u * u)
        return f, -u * f


class OneLevel:
    """A function of one level.

    parameters: names, location and spread first. bounds: {parameter: (low, high)} of fits. core: F. symmetric: lapses go to both answers equally, and
    there is no guess rate (order judgements). z: converts a level to the axis of location and spread."""
    dimensions = 1
    symmetric = False

    def __init__(self, name, core, parameters):
        self.name, self.core, self.parameters = name, core, parameters
        self.location, self.spread = parameters[:2]
        self.bounds = {self.location: (-math.inf, math.inf), self.spread: (0.0, math.inf)}
        self.bounds.update({rate: {"guess": GUESS, "lapse": LAPSE}[rate] for rate in parameters[2:]})

    def z(self, levels):
        return np.asarray(levels, dtype=float)

    def inner(self, params):
        """(m, s, guess, lapse) of named parameters."""
        return params[self.location], params[self.spread], params.get("guess", 0.0), params["lapse"]

    def outer(self, m, s, guess, lapse):
        """Named parameters of (m, s, guess, lapse)."""
        return {self.location: m, self.spread: s, "guess": guess, "lapse": lapse}

    @staticmethod
    def rates(guess, lapse):
        """(A, B)."""
        return guess, 1 - guess - lapse

    def p(self, levels, **params):
        """Probability at levels (any shape) for parameters that broadcast against them."""
        missing = [n for n in self.parameters if n not in params]
        if missing:
            raise ValueError(f"{self.name} needs the parameters {', '.join(self.parameters)}; {missing[0]} is missing")
        m, s, guess, lapse = (np.asarray(v, dtype=float) for v in self.inner(params))
        a, b = self.rates(guess, lapse)
        return a + b * self.core.both((self.z(levels) - m) / s)[0]

    def anchors(self):
        """Derived values that are points on the axis: name -> their u, or None for the u of 75 % right answers without lapses, which depends on the guess
        rate."""
        return {"threshold75": None}

    def widths(self):
        """Derived values that are multiples of the spread: name -> factor."""
        return {"jnd": self.core.quartile} if self.core.quartile else {}

    def anchor(self, name, guess):
        """u of a derived point. NaN: guessing alone gives 75 %."""
        u = self.anchors()[name]
        if u is not None:
            return u + 0 * np.asarray(guess)
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.core.inverse((0.75 - np.asarray(guess)) / (1 - np.asarray(guess)))

    def level_of(self, z):
        """Converts a point on the axis to a level."""
        return z

    def derived(self, m, s, guess, lapse=0.0):
        """{name: value} of all derived values."""
        found = {name: float(self.level_of(m + s * self.anchor(name, guess))) for name in self.anchors()}
        return {**found, **{name: float(factor * s) for name, factor in self.widths().items()}}


class Synchrony(OneLevel):
    """Judgements of synchrony over SOA: a Gaussian window around the point of subjective simultaneity (pss), with a free peak of 1 - lapse. window75 is the
    width at 75 % of the peak, from low75 to high75; absolute_low75 and absolute_high75 are where 75 % are judged together, NaN if the peak is lower. A
    peak that is held near 1 makes the window too narrow: with a true sd of 60 and a peak of 0.75 it gives about 53."""

    def __init__(self, name, core, parameters):
        super().__init__(name, core, parameters)
        self.bounds["lapse"] = MISSED

    def derived(self, m, s, guess, lapse=0.0):
        share = (0.75 - guess) / (1 - guess - lapse)
        half = float(s) * math.sqrt(-2 * math.log(share)) if 0 < share <= 1 else math.nan
        return {**super().derived(m, s, guess), "peak": float(1 - lapse), "absolute_low75": float(m) - half, "absolute_high75": float(m) + half}

    def anchors(self):
        return {"low75": -self.core.half_width75, "high75": self.core.half_width75}

    def widths(self):
        return {"window75": 2 * self.core.half_width75}


class Order(OneLevel):
    """Judgements of order: p = lapse / 2 + (1 - lapse) Phi((x - pss) / sd), the share of "a was first" over SOA(a, b) = t(b) - t(a).
    jnd: from the pss to the 75 % point of an observer without lapses, 0.6745 sd."""
    symmetric = True

    def anchors(self):
        return {}

    @staticmethod
    def rates(guess, lapse):
        return lapse / 2, 1 - lapse

    def outer(self, m, s, guess, lapse):
        return {self.location: m, self.spread: s, "lapse": lapse}


class Weibull(OneLevel):
    """1 - exp(-(x / threshold)^slope) of levels above 0 (Quick 1974, Kybernetik 16:65; Watson 1979); the threshold is at 63 %."""

    def z(self, levels):
        return np.log(np.maximum(np.asarray(levels, dtype=float), SMALLEST_LEVEL))

    def inner(self, params):
        return np.log(params["threshold"]), 1 / np.asarray(params["slope"], dtype=float), params["guess"], params["lapse"]

    def outer(self, m, s, guess, lapse):
        return {"threshold": np.exp(m), "slope": 1 / s, "guess": guess, "lapse": lapse}

    def level_of(self, z):
        return np.exp(z)


class WeibullDecibel(Weibull):
    """Weibull's function with levels and threshold in dB: 1 - exp(-10^(slope (x - threshold) / 20)) (Watson 2017)."""
    PER_DB = math.log(10) / 20

    def z(self, levels):
        return np.asarray(levels, dtype=float) * self.PER_DB

    def inner(self, params):
        return np.asarray(params["threshold"], dtype=float) * self.PER_DB, 1 / np.asarray(params["slope"], dtype=float), params["guess"], params["lapse"]

    def outer(self, m, s, guess, lapse):
        return {"threshold": m / self.PER_DB, "slope": 1 / s, "guess": guess, "lapse": lapse}

    def level_of(self, z):
        return z / self.PER_DB


class Surface:
    """Two senses degraded together, levels (a, b) at least 0: Weibull's function of the pooled level ((a / threshold_a)^summation +
    (b / threshold_b)^summation)^(1 / summation) (Quick 1974). summation = slope: probability summation of two independent senses; 1: sum of levels; large:
    only the worse sense counts. Levels have a last axis of 2."""
    dimensions = 2
    name = "threshold_surface"
    parameters = ("threshold_a", "threshold_b", "slope", "summation", "guess", "lapse")
    bounds = {"threshold_a": (0.0, math.inf), "threshold_b": (0.0, math.inf), "slope": (0.0, math.inf), "summation": (0.0, math.inf), "guess": GUESS, "lapse": LAPSE}

    def p(self, levels, threshold_a, threshold_b, slope, summation, guess, lapse):
        levels = np.maximum(np.asarray(levels, dtype=float), SMALLEST_LEVEL)
        a, b = (summation * (np.log(levels[..., i]) - np.log(t)) for i, t in enumerate((threshold_a, threshold_b)))
        return guess + (1 - np.asarray(guess) - lapse) * Gumbel.both(slope / summation * np.logaddexp(a, b))[0]


FUNCTIONS = {f.name: f for f in (
    Synchrony("synchrony_window", Window, ("pss", "sd", "guess", "lapse")), OneLevel("cumulative_gaussian", Gaussian, ("threshold", "sd", "guess", "lapse")),
    OneLevel("logistic", Logistic, ("threshold", "scale", "guess", "lapse")), Weibull("weibull", Gumbel, ("threshold", "slope", "guess", "lapse")),
    WeibullDecibel("weibull_dB", Gumbel, ("threshold", "slope", "guess", "lapse")), Order("order", Gaussian, ("pss", "sd", "lapse")), Surface())}


def function(name):
    """The function of this name. Raises ValueError with the known names."""
    if name not in FUNCTIONS:
        raise ValueError(f"there is no psychometric function '{name}'; choose one of {', '.join(FUNCTIONS)}")
    return FUNCTIONS[name]
