"""Maximum likelihood of a logistic model with a random intercept and slope for each participant.

Laplace's approximation about their mode integrates the random effects out (Breslow and Clayton 1993, Journal of the American Statistical Association
88:9; Bates et al. 2015, Journal of Statistical Software 67:1, for the form u = L v with v ~ N(0, 1), which permits a variance of 0). statsmodels has no
such model: the mode of its BinomialBayesMixedGLM lies at a variance of 0 for any data, and its variational fit assumes independent fixed and random
effects, so that its intervals are too narrow.
"""
import dataclasses

import numpy as np
from scipy.optimize import minimize
from statsmodels.tools.numdiff import approx_hess

NEWTON_STEPS = 50  # maximum; it converges in 5 to 10; design
NEWTON_DONE = 1e-10  # largest step at convergence


@dataclasses.dataclass
class Fitted:
    """beta: (k,); covariance: (k, k); random: (2, 2) covariance of intercept and slope between participants."""
    beta: np.ndarray
    covariance: np.ndarray
    random: np.ndarray
    log_likelihood: float
    converged: bool


def sums(at, values, groups):
    """(groups, ...) sums of the rows of each group."""
    flat = values.reshape(len(values), -1)
    return np.stack([np.bincount(at, weights=c, minlength=groups) for c in flat.T], axis=1).reshape(groups, *values.shape[1:])


def negative_log_likelihood(theta, fixed, random, at, yes, groups, start):
    """theta: beta, then the lower triangle of L (00, 10, 11). start: (groups, 2) initial v, overwritten by the mode."""
    k = fixed.shape[1]
    factor = np.array([[theta[k], 0.0], [theta[k + 1], theta[k + 2]]])
    base, z = fixed @ theta[:k], random @ factor
    outer = z[:, :, None] * z[:, None, :]
    v = start.copy()
    for _ in range(NEWTON_STEPS):
        p = 1 / (1 + np.exp(-np.clip(base + (z * v[at]).sum(axis=1), -500, 500)))
        slope = sums(at, (yes - p)[:, None] * z, groups) - v
        curve = sums(at, (p * (1 - p))[:, None, None] * outer, groups) + np.eye(2)
        step = np.linalg.solve(curve, slope[:, :, None])[:, :, 0]
        # A Newton step on a logistic can overshoot if all answers agree; steps are limited to 3.
        v = v + step * np.minimum(1, 3 / np.maximum(np.abs(step).max(axis=1, keepdims=True), 1e-300))
        if np.abs(step).max() < NEWTON_DONE:
            break
    start[:] = v
    eta = base + (z * v[at]).sum(axis=1)
    p = 1 / (1 + np.exp(-np.clip(eta, -500, 500)))
    curve = sums(at, (p * (1 - p))[:, None, None] * outer, groups) + np.eye(2)
    return float(np.sum(np.logaddexp(0, eta) - yes * eta) + 0.5 * np.sum(v**2) + 0.5 * np.sum(np.linalg.slogdet(curve)[1]))


def fixed_covariance(hessian, k):
    """Covariance (k, k) of the first k parameters, from the Hessian of the negative log likelihood. Where a variance lies at its bound the likelihood
    is flat; then it is that of the fixed effects given the variances."""
    try:
        if np.all(np.linalg.eigvalsh(hessian) > 0):
            return np.linalg.inv(hessian)[:k, :k]
    except np.linalg.LinAlgError:
        pass
    return np.linalg.pinv(hessian[:k, :k])


def fit(fixed, slope, at, yes):
    """fixed: (n, k), intercept first; slope: (n,) variable of the random slope; at: (n,) index of the participant; yes: (n,) 0 or 1."""
    groups, k = int(at.max()) + 1, fixed.shape[1]
    random = np.stack([np.ones_like(slope), slope], axis=1)
    start = np.zeros((groups, 2))
    value = lambda theta: negative_log_likelihood(theta, fixed, random, at, yes, groups, start)
    found = minimize(value, np.concatenate([np.zeros(k), [0.5, 0.0, 0.3]]), method="BFGS", options={"gtol": 1e-4, "maxiter": 200})
    theta = found.x
    hessian = approx_hess(theta, value)
    covariance = fixed_covariance(hessian, k)
    factor = np.array([[theta[k], 0.0], [theta[k + 1], theta[k + 2]]])
    converged = bool(found.success or np.abs(found.jac).max() < 1e-2) and bool(np.all(np.diag(covariance) > 0))
    return Fitted(theta[:k], covariance, factor @ factor.T, -found.fun, converged)
