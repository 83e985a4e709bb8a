"""Times to win of games with a time limit: a game that was not won is censored, at the limit or where it ended.

The time of those who win is log-normal, and a share `winnable` of the games can be won at all (a mixture cure model; Farewell 1982, Biometrics 38:1041). So
lost games make the time longer only as far as the times of won games reach the limit: success and time are separate outcomes. The restricted mean time
contains both; decomposition() separates its parts.
"""
import dataclasses
import math

import numpy as np
from scipy.optimize import minimize
from scipy.special import expit, log_ndtr, ndtr
from scipy.stats import norm

FEWEST_WON = 3     # of a spread of times; design
SMALLEST_SD = 1e-4  # of the logarithm of times; design
SEEN = 0.7         # share of the times to win that must lie below the limit, else slow and unwinnable games cannot be distinguished; design
PRIOR = 0.5        # of a winnable and of an unwinnable game, added (Jeffreys): the share stays below 1


@dataclasses.dataclass
class Times:
    """mu, sd: of the logarithm of the time to win; winnable: share of games that can be won (1 if it was not fitted). variance: of mu; influence (n,): share
    of each game in the error of mu. seen: share of the times to win below the limit. mu is NaN with fewer than FEWEST_WON won games."""
    mu: float
    sd: float
    winnable: float
    log_likelihood: float
    variance: float
    influence: np.ndarray
    seen: float
    won: int

    @property
    def identified(self):
        return math.isfinite(self.mu) and self.seen >= SEEN


def terms(theta, logs, won, cure):
    """(log likelihood (n,), its derivatives (n, 3)) by mu, log sd and the log odds of winnable, without the constant of the logarithm."""
    mu, sd, share = theta[0], math.exp(theta[1]), expit(theta[2]) if cure else 1.0
    z = (logs - mu) / sd
    rest = 1 - share if cure else 0.0
    density, cumulative = norm.pdf(z), ndtr(z)
    survive = np.where(won, 1.0, np.maximum(rest + share * ndtr(-z), 1e-300))
    lost_value = np.log(survive) if cure else np.where(won, 0.0, log_ndtr(-z))
    hazard = share * density / survive if cure else np.exp(norm.logpdf(z) - np.where(won, 0.0, log_ndtr(-z)))
    value = np.where(won, (math.log(share) if cure else 0.0) - 0.5 * z * z - theta[1] - logs - 0.5 * math.log(2 * math.pi), lost_value)
    by = np.stack([np.where(won, z, hazard) / sd, np.where(won, z * z - 1, hazard * z),
                   np.where(won, rest, -share * rest * cumulative / survive) if cure else np.zeros_like(z)], axis=1)
    return value, by


def fit(times_s, won, cure=True):
    """Times of games. times_s (n,): time to win, or when a game that was not won ended; won (n,) of bool."""
    logs, won = np.log(np.maximum(np.asarray(times_s, dtype=float), 1e-9)), np.asarray(won, dtype=bool)
    n, cure = len(logs), cure and not won.all()
    count = int(won.sum())
    if count < FEWEST_WON:
        return Times(math.nan, math.nan, math.nan, math.nan, math.inf, np.zeros(n), math.nan, count)
    free = [0, 1, 2] if cure else [0, 1]

    def cost(theta):
        theta = np.append(theta, [0.0] * (3 - len(theta)))
        value, by = terms(theta, logs, won, cure)
        share = expit(theta[2])
        prior = PRIOR * (math.log(share) + math.log1p(-share)) if cure else 0.0
        slope = by.sum(axis=0) + np.array([0, 0, PRIOR * (1 - 2 * share) if cure else 0.0])
        return -(value.sum() + prior), -slope[free]

    low = math.log(SMALLEST_SD)
    first = [float(logs[won].mean()), max(low, math.log(max(float(logs[won].std()), SMALLEST_SD))), math.log((count + 0.5) / (n - count + 0.5))][:len(free)]
    found = minimize(cost, first, jac=True, method="L-BFGS-B", bounds=[(None, None), (low, 5.0), (-12.0, 12.0)][:len(free)], options={"maxiter": 500, "ftol": 1e-13, "gtol": 1e-8})
    theta = np.append(found.x, [0.0] * (3 - len(free)))
    information = curvature(cost, found.x)
    value, by = terms(theta, logs, won, cure)
    inverse = np.linalg.pinv(information)
    influence = by[:, free] @ inverse[0]
    sd = math.exp(theta[1])
    # The prior and bounds leave influences whose sum is not 0.
    seen = float(ndtr((logs[~won].max() - theta[0]) / sd)) if not won.all() else 1.0
    return Times(float(theta[0]), sd, float(expit(theta[2])) if cure else 1.0, float(value.sum()), float(max(inverse[0, 0], (SMALLEST_SD**2) / count)),
                 influence - influence.mean(), seen, count)


def curvature(cost, at):
    """Second derivatives by central differences of the gradient."""
    step = 1e-5
    rows = [(cost(at + step * e)[1] - cost(at - step * e)[1]) / (2 * step) for e in np.eye(len(at))]
    return (np.array(rows) + np.array(rows).T) / 2


def decomposition(share, time_s, share_before, time_before_s, limit_s):
    """(part by success, part by time) of the change of the restricted mean time, s: share of games won and mean time of won games, now and before, each
    change weighted with the mean of the other (Kitagawa 1955, JASA 50:1168)."""
    return (share - share_before) * ((time_s + time_before_s) / 2 - limit_s), (share + share_before) / 2 * (time_s - time_before_s)
