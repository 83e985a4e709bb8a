"""Mixed models over participants, which generalize to other people.

Yes/no outcomes (success, answers): logistic with a random intercept and slope for each participant, by maximum likelihood (laplace.py). GEE estimates the
mean over people, but its sandwich variance needs about 40 of them (Mancl and DeRouen 2001, Biometrics 57:126); a study has 5 to 20. Times: linear in the
logarithm, with the same random effects and with games that were not won as censored (censored_mixed.py). Intervals and p use Student's t with
(participants - 1) degrees of freedom.

Synchrony judgements peak at the PSS: their log odds are modelled as a parabola of the asynchrony, a + b x + c x^2, with the PSS at -b / 2c; only intercept
and slope are random. Severities and asynchronies are divided by their standard deviation for the fit; results are per unit.
"""
import dataclasses

import numpy as np
from scipy import stats

from tactus.analysis import censored_mixed, laplace

FEWEST = 2
FEWEST_WON = 10  # games, for a model of times; design
ONE = "There is only one participant: differences between people cannot be estimated, and no mixed model was fitted."
ONCE = "Each participant did one trial: differences between people cannot be separated from chance, and no mixed model was fitted."
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
    """effects; sd_intercept, sd_slope: between participants, on the scale of the model (slope: per unit of x); words: description of the model, and
    warnings."""
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
    few = f" {len(people)} participants are too few for a good estimate of differences between people." if len(people) < FEW else ""
    return few + ("" if converged else " The fit did not converge: do not use it.")


def logistic(participants, x, yes, name, parabola=False):
    """Model of the log odds of yes over x, or the reason why there is none, as a sentence."""
    people, at, scale = design(participants, x)
    if len(people) < FEWEST:
        return ONE
    if scale == 0 or len(set(yes)) < 2:
        return "All answers, or all levels, are the same: there is no slope to estimate."
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


def log_linear(participants, x, times, name, won=None):
    """Model of ln(time) over x, or the reason why there is none, as a sentence. The effect is a ratio per unit: exp(estimate). times: when the game was won,
    or when a game that was not won ended. won: (n,) of bool; None: all."""
    people, at, scale = design(participants, x)
    won = np.ones(len(x), dtype=bool) if won is None else np.asarray(won, dtype=bool)
    if len(people) < FEWEST:
        return ONE
    if scale == 0:
        return "All levels are the same: there is no slope to estimate."
    if np.count_nonzero(won) < FEWEST_WON:
        return f"{np.count_nonzero(won)} games were won: too few for a model of times."
    z, n = x / scale, len(people)
    exog = np.stack([np.ones_like(z), z], axis=1)
    fitted = censored_mixed.fit(exog, exog, at, np.log(times), won)
    # Maximum likelihood estimates the variances between n people too small by (n - 1) / n.
    sds = np.sqrt(np.maximum(0, np.diag(fitted.covariance)) * n / (n - 1))
    between = np.sqrt(np.diag(fitted.random))
    edge = " A difference between people is at its bound of 0." if (between < 2 * censored_mixed.SMALLEST_SD).any() else ""
    lost = f" {np.count_nonzero(~won)} games that were not won are censored; games that cannot be won at all count as slow." if not won.all() else ""
    effects = [effect("intercept", fitted.beta[0], sds[0], n), effect(name, fitted.beta[1], sds[1], n, scale)]
    return Model("mixed log-linear", effects, float(between[0]), float(between[1] / scale), n, len(z),
                 "Linear in ln(time) with random intercept and slope per participant (maximum likelihood, adaptive quadrature)." + lost + edge + doubts(people, fitted.converged))
