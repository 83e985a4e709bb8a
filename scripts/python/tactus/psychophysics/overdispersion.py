"""Over-dispersion and goodness of fit: answers vary more than independent ones, because people differ, learn or tire.

Yes of m answers are beta-binomial with mean mu and correlation rho of two answers; their variance is that of independent ones times the design effect
1 + (m - 1) rho (Williams 1975, Biometrics 31:949; for psychometric functions Schuett et al. 2016, Vision Research 122:105).
"""
import dataclasses
import math

import numpy as np
from scipy.optimize import minimize
from scipy.special import betaln, gammaln
from scipy.stats import t

from tactus.psychophysics import intervals
from tactus.psychophysics.likelihood import Answers, log_likelihood, log_prior, maximise, probability
from tactus.psychophysics.posterior import ETA_MOST

# The parameter b of the prior Beta(1, b) on eta (posterior.py), for up to three free parameters and for four. Design: with 10, as published, 80 % to 83 % of the intervals hold
# the truth at rho = 0.15; tests/measure/measure_coverage shows the coverage with these.
ETA_PRIOR = {3: 2.0, 4: 4.0}
RANGE = 2.0  # the range of the posterior allows for this many times the design effect that is found; design
DRAWS = 300  # of the deviance; standard error of p at 0.05: 0.013; design


@dataclasses.dataclass
class BetaBinomial:
    """mu, rho; log_likelihood with binomial coefficients."""
    mu: float
    rho: float
    log_likelihood: float

    def design_effect(self, m):
        return 1 + (m - 1) * self.rho


def beta_binomial(yes, total):
    """Maximum likelihood of groups (k,) of answers."""
    yes, total = np.asarray(yes, dtype=float), np.asarray(total, dtype=float)

    def value(theta):
        mu, rho = 1 / (1 + np.exp(-theta))
        a, b = mu * (1 - rho) / rho, (1 - mu) * (1 - rho) / rho
        return float(np.sum(betaln(yes + a, total - yes + b) - betaln(a, b)))

    share = (yes.sum() + 0.5) / (total.sum() + 1)
    found = max((minimize(lambda x: -value(x), [math.log(share / (1 - share)), start], method="L-BFGS-B", bounds=[(-12, 12), (-12, 8)], options={"ftol": 1e-13, "gtol": 1e-6})
                 for start in (-4.0, -1.0)), key=lambda r: -r.fun)
    mu, rho = 1 / (1 + np.exp(-found.x))
    coefficients = float(np.sum(gammaln(total + 1) - gammaln(yes + 1) - gammaln(total - yes + 1)))
    return BetaBinomial(float(mu), float(rho), coefficients - float(found.fun))


def moment_rho(yes, total):
    """rho of groups of equal size, by the sum of squared residuals (Pearson's statistic over its degrees of freedom is the design effect)."""
    yes, total = np.asarray(yes, dtype=float), np.asarray(total, dtype=float)
    p = yes.sum() / total.sum()
    return float((np.sum((yes - p * total) ** 2 / (total * p * (1 - p))) / (len(yes) - 1) - 1) / (total.mean() - 1))


@dataclasses.dataclass
class Dispersion:
    """p: goodness of fit, the share of refits to answers drawn from the fit with a larger deviance (Wichmann and Hill 2001, Perception & Psychophysics
    63:1293; few answers at a level have no chi-square distribution). factor: deviance over its mean in those refits, the design effect. df: degrees of
    freedom of a chi-square distribution of their mean and variance."""
    p: float
    factor: float
    df: float

    def width(self, level=0.95):
        """Factor of the variance of estimates, 1 or more. The factor itself is uncertain (Student's t), and it counts only as far as the answers show that
        they are over-dispersed: fully for a p up to 0.25, not for 0.5."""
        shown = min(1.0, max(0.0, 2 - 4 * self.p))
        longer = float(t.ppf((1 + level) / 2, max(self.df, 1)) / t.ppf((1 + level) / 2, np.inf)) ** 2
        return 1 + shown * max(0.0, self.factor * longer - 1)


def dispersion(fitted, rng, draws=DRAWS):
    """Dispersion of a Fit."""
    many = fitted.many
    p, total = probability(many.function, many.answers.z, many.theta)[0][0], many.answers.total[0]
    yes = rng.binomial(total.astype(int), p, size=(draws, len(p))).astype(float)
    again = Answers(many.function, np.repeat(many.answers.z, draws, axis=0), yes, np.tile(total, (draws, 1)))
    start, low, high = (np.repeat(x, draws, axis=0) for x in (many.theta, many.low, many.high))  # the truth of these answers is the best start
    found = log_likelihood(again, probability(many.function, again.z, maximise(again, start, many.free, low, high)[0])[0])
    no = total - yes
    with np.errstate(divide="ignore", invalid="ignore"):
        best = np.where(yes > 0, yes * np.log(yes / total), 0).sum(axis=1) + np.where(no > 0, no * np.log(no / total), 0).sum(axis=1)
    drawn = 2 * (best - found)
    mean = max(float(drawn.mean()), 1e-9)
    return Dispersion(float((np.count_nonzero(drawn >= fitted.deviance - 1e-9) + 1) / (draws + 1)), fitted.deviance / mean, 2 * mean**2 / max(float(drawn.var()), 1e-9))


def over_dispersed(fitted, factor):
    """The Fits with intervals that integrate over the correlation of answers at a level. factor: the design effect that was found."""
    most = 1 + (float(fitted.answers.total.max()) - 1) * ETA_MOST**2
    fewer = min(RANGE * max(1.0, factor), most)
    # The same maximum, apart from the weak prior of a guess rate.
    answers = Answers(fitted.function, fitted.answers.z, fitted.answers.yes / fewer, fitted.answers.total / fewer)
    value = log_likelihood(answers, probability(fitted.function, answers.z, fitted.theta)[0]) + log_prior(fitted.theta, fitted.free)
    wide = dataclasses.replace(fitted, answers=answers, value=value)
    return dataclasses.replace(fitted, eta_prior=ETA_PRIOR[3 if fitted.free.sum() < 4 else 4], wide=wide)


def inflated(fitted, factor):
    """The Fits with answers that count less by the factor, so that variances of estimates are larger by it (quasi-likelihood; McCullagh and Nelder 1989,
    section 4.5)."""
    if factor <= 1:
        return fitted
    return intervals.refit(fitted, fitted.answers.yes / factor, fitted.answers.total / factor)
