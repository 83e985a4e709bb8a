"""Maximum likelihood of a linear model of the logarithm of times, with random effects of each participant and censored times.

log T = fixed beta + random u + sd e, with u ~ N(0, covariance) of intercept, or of intercept and slope, and e ~ N(0, 1). A game that was not won is
known only to take longer than its time. Adaptive Gauss-Hermite quadrature integrates the random effects out (Pinheiro and Bates 1995, Journal of
Computational and Graphical Statistics 4:12). A model of min(time, limit) instead takes lost games for games of just that time, and its slope is too small.
"""
import dataclasses
import functools
import math

import numpy as np
from scipy.optimize import minimize
from scipy.special import log_ndtr
from statsmodels.tools.numdiff import approx_hess

from tactus.analysis.laplace import fixed_covariance, sums

NODES = {1: 20, 2: 7}  # of the quadrature in each random effect, by their number; 7 agree with 15 to 1e-6 of the log likelihood; design
NEWTON_STEPS, NEWTON_DONE = 50, 1e-9  # of the mode; it converges in 5 to 10
SMALLEST_SD = 1e-3  # of a random effect and of the errors, so that no variance is 0; design


@dataclasses.dataclass
class Fitted:
    """beta: (k,); covariance: (k, k); random: (q, q) covariance of the random effects between participants; sd: of the errors."""
    beta: np.ndarray
    covariance: np.ndarray
    random: np.ndarray
    sd: float
    log_likelihood: float
    converged: bool


def terms(residual, won, log_sd):
    """(log likelihood of the logarithm of each time, first and second derivative by the prediction) of residuals in sd."""
    sd = math.exp(log_sd)
    z = np.where(won, 0.0, residual)
    tail = log_ndtr(-z)
    hazard = np.exp(-0.5 * z * z - 0.5 * math.log(2 * math.pi) - tail)
    value = np.where(won, -0.5 * residual**2 - log_sd - 0.5 * math.log(2 * math.pi), tail)
    return value, np.where(won, residual, hazard) / sd, np.where(won, -1.0, -hazard * (hazard - z)) / sd**2


@functools.lru_cache
def hermite(count):
    """(nodes, weights), each (count,), of Gauss-Hermite quadrature for a standard normal distribution."""
    return np.polynomial.hermite_e.hermegauss(count)


def log_likelihood(theta, fixed, random, at, logs, won, groups, start, count=None):
    """theta: beta, log sd, then the lower triangle of L, row by row, with covariance L L'. start: (groups, q) initial modes, overwritten. at: (n,) index of
    the participant. count: nodes in each random effect; 1 is Laplace's approximation; None: NODES."""
    k, q = fixed.shape[1], random.shape[1]
    sd = math.exp(theta[k])
    factor = np.zeros((q, q))
    factor[np.tril_indices(q)] = theta[k + 1:]
    base, design = fixed @ theta[:k], random @ factor
    outer = design[:, :, None] * design[:, None, :]
    v = start.copy()
    for _ in range(NEWTON_STEPS):
        _, first, second = terms((logs - base - (design * v[at]).sum(axis=1)) / sd, won, theta[k])
        slope = sums(at, first[:, None] * design, groups) - v
        curve = sums(at, -second[:, None, None] * outer, groups) + np.eye(q)
        step = np.linalg.solve(curve, slope[:, :, None])[:, :, 0]
        v = v + step
        if np.abs(step).max() < NEWTON_DONE:
            break
    start[:] = v
    nodes, weights = hermite(count or NODES[q])
    grid = np.stack(np.meshgrid(*[nodes] * q, indexing="ij"), axis=-1).reshape(-1, q)
    logw = np.log(np.stack(np.meshgrid(*[weights] * q, indexing="ij"), axis=-1).reshape(-1, q)).sum(axis=1) - q / 2 * math.log(2 * math.pi)
    spread = np.linalg.inv(np.linalg.cholesky(curve)).transpose(0, 2, 1)  # L^-T: covariance is the inverse of the curvature
    values = np.empty((groups, len(grid)))
    for j, node in enumerate(grid):
        u = v + spread @ node
        value = terms((logs - base - (design * u[at]).sum(axis=1)) / sd, won, theta[k])[0]
        values[:, j] = np.bincount(at, weights=value, minlength=groups) - 0.5 * np.sum(u**2, axis=1) + 0.5 * np.sum(node**2) + logw[j]
    top = values.max(axis=1)
    determinant = -0.5 * np.linalg.slogdet(curve)[1]
    return float(np.sum(top + np.log(np.exp(values - top[:, None]).sum(axis=1)) + determinant))


def fit(fixed, random, at, logs, won):
    """fixed: (n, k), intercept first; random: (n, q) variables of the random effects, q 1 or 2; at: (n,) index of the participant; logs: (n,) logarithm of the
    time to win, or of when a game that was not won ended; won: (n,) of bool."""
    fixed, random, won = np.asarray(fixed, dtype=float), np.asarray(random, dtype=float), np.asarray(won, dtype=bool)
    groups, k, q = int(at.max()) + 1, fixed.shape[1], random.shape[1]
    start = np.zeros((groups, q))
    beta = np.linalg.lstsq(fixed, logs, rcond=None)[0]
    spread = max(float(np.std(logs - fixed @ beta)), 10 * SMALLEST_SD)
    first = np.concatenate([beta, [math.log(spread)], np.where(np.equal(*np.tril_indices(q)), 0.5 * spread, 0.0)])
    low = [None] * k + [math.log(SMALLEST_SD)] + [SMALLEST_SD if i == j else None for i, j in zip(*np.tril_indices(q))]
    cost = lambda theta, count=None: -log_likelihood(theta, fixed, random, at, logs, won, groups, start, count)
    for count in (1, None):  # Laplace's approximation is near, and 20 to 50 times as fast
        found = minimize(cost, first, (count,), method="L-BFGS-B", bounds=[(l, None) for l in low], options={"maxiter": 300, "ftol": 1e-11})
        first = found.x
    theta = found.x
    hessian = approx_hess(theta, cost)
    covariance = fixed_covariance(hessian, k)
    factor = np.zeros((q, q))
    factor[np.tril_indices(q)] = theta[k + 1:]
    return Fitted(theta[:k], covariance, factor @ factor.T, math.exp(theta[k]), -float(found.fun), bool(found.success) and bool(np.all(np.diag(covariance) > 0)))
