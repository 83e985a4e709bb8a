"""A model over participants: what holds of people, beside what holds of these.

Yes or no (success, answers): logistic with a random intercept and slope for each participant, by maximum likelihood (laplace.py). GEE would
give the mean over people, with a sandwich variance that needs some 40 of them (Mancl and DeRouen 2001, Biometrics 57:126); a study has 5 to
20. Times: linear in the logarithm, with the same random effects, by restricted maximum likelihood (MixedLM of statsmodels). Intervals
and p are of Student's t with as many degrees of freedom as participants less one.

Synchrony judgements peak at the PSS: their log odds are taken as a parabola of the asynchrony, a + b x + c x^2, with the PSS at -b / 2c; only
intercept and slope are random. Severities and asynchronies enter divided by their standard deviation, and are told per unit again.
"""
import dataclasses
import warnings

import numpy as np
from scipy import stats
from statsmodels.regression.mixed_linear_model import MixedLM

from tactus.analysis import laplace

FEWEST = 2
ONE = "There is one participant only: what differs between people cannot be told, and no mixed model was fitted."
ONCE = "Each participant did one trial: what differs between people cannot be told from chance, and no mixed model was fitted."
FEW = 5  # design, as resampling.FEWEST_PARTICIPANTS


@dataclasses.dataclass
class Effect:
    """One coefficient. estimate, low, high: per unit of x, on the scale of the model."""
    name: str
    estimate: float
    low: float
    high: float
    p: float


@dataclasses.dataclass
class Model:
    """effects; sd_intercept, sd_slope: between participants, on the scale of the model (slope: per unit of x); words: what was fitted, and doubts."""
    kind: str
    effects: list
    sd_intercept: float
    sd_slope: float
    participants: int
    rows: int
    words: str


def design(participants, x):
    people = sorted(set(participants))
    at = np.array([people.index(p) for p in participants])
    scale = float(np.std(x))
    return people, at, scale


def effect(name, estimate, sd, participants, per=1.0):
    t = stats.t(participants - 1)
    p = float(2 * t.sf(abs(estimate / sd))) if sd > 0 else float("nan")
    return Effect(name, estimate / per, (estimate - t.ppf(0.975) * sd) / per, (estimate + t.ppf(0.975) * sd) / per, p)


def doubts(people, converged):
    few = f" {len(people)} participants say little of how people differ." if len(people) < FEW else ""
    return few + ("" if converged else " The fit did not converge: do not use it.")


def logistic(participants, x, yes, name, parabola=False):
    """Model of log odds of yes over x, or the sentence why there is none."""
    people, at, scale = design(participants, x)
    if len(people) < FEWEST:
        return ONE
    if scale == 0 or len(set(yes)) < 2:
        return "All answers are the same, or all levels: there is no slope to be told."
    z = x / scale
    fixed = np.stack([np.ones_like(z), z] + ([z**2] if parabola else []), axis=1)
    fitted = laplace.fit(fixed, z, at, np.asarray(yes, dtype=float))
    sd, n = np.sqrt(np.maximum(0, np.diag(fitted.covariance))), len(people)
    effects = [effect("intercept", fitted.beta[0], sd[0], n), effect(name, fitted.beta[1], sd[1], n, scale)]
    if parabola:
        effects += [effect(f"{name} squared", fitted.beta[2], sd[2], n, scale**2), peak(fitted, scale, n)]
    between = np.sqrt(np.diag(fitted.random))
    return Model("mixed logistic", effects, float(between[0]), float(between[1] / scale), n, len(z),
                 "Logistic with random intercept and slope per participant (maximum likelihood, Laplace)." + doubts(people, fitted.converged))


def peak(fitted, scale, participants):
    """The PSS, -b / 2c, by the delta method."""
    b, c = fitted.beta[1:3]
    slope = np.array([-1 / (2 * c), b / (2 * c**2)])
    sd = float(np.sqrt(max(0.0, slope @ fitted.covariance[1:3, 1:3] @ slope)))
    return effect("PSS", -b / (2 * c) * scale, sd * scale, participants)


def log_linear(participants, x, times, name):
    """Model of ln(time) over x, or the sentence why there is none. The effect is a ratio per unit: exp(estimate)."""
    people, at, scale = design(participants, x)
    if len(people) < FEWEST:
        return ONE
    if scale == 0:
        return "All levels are the same: there is no slope to be told."
    y, z = np.log(times), x / scale
    exog = np.stack([np.ones_like(z), z], axis=1)
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        fitted = MixedLM(y, exog, groups=at, exog_re=exog).fit(reml=True, method=["lbfgs", "powell"])
    good = fitted.converged and not any("converge" in str(w.message).lower() for w in said)
    edge = any(word in str(w.message).lower() for w in said for word in ("boundary", "singular"))
    boundary = " The random effects are at the edge of what can be (a variance of 0, or a correlation of 1)." if edge else ""
    sds = np.sqrt(np.maximum(0, np.diag(np.atleast_2d(fitted.cov_re))))
    effects = [effect("intercept", fitted.fe_params[0], fitted.bse_fe[0], len(people)), effect(name, fitted.fe_params[1], fitted.bse_fe[1], len(people), scale)]
    return Model("mixed log-linear", effects, float(sds[0]), float(sds[1] / scale), len(people), len(z),
                 "Linear in ln(time) with random intercept and slope per participant (MixedLM, REML)." + boundary + doubts(people, good))
