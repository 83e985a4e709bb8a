"""Maximum likelihood parameters of psychometric functions, for many sets of answers together, by Fisher scoring within bounds.

There are always four parameters, theta = (location q, log spread t, guess, lapse); functions.py defines them for each function. q is the point at which
u = `anchor`: the location m for an anchor of 0, or a derived point, m + s u. Arrays: n sets of answers, k levels.

Fisher scoring (McCullagh and Nelder 1989, section 2.5) with Levenberg-Marquardt damping (Marquardt 1963); parameters at a bound are held there (projected
Newton; Bertsekas 1982). A set is done when the expected gain of a step is below TOLERANCE of log likelihood.
"""
import dataclasses

import numpy as np

from tactus.psychophysics.functions import GUESS_PRIOR, within

TOLERANCE = 1e-7    # of the log likelihood; negligible against the drop of 1.9 of an interval; design
MAX_STEPS = 200     # scoring takes 5 to 30; design
FLOOR = 1e-6        # of the information; 100 trials give 1 to 1e4; design
LEAST_P = 1e-10     # smallest distance of probabilities to 0 and 1: an impossible answer costs 23 of log likelihood, not infinity; design
Q, T, GUESS, LAPSE = range(4)


@dataclasses.dataclass
class Answers:
    """z (n, k): levels on the axis of the function; yes, total (n, k): counts; total 0 pads sets with fewer levels."""
    function: object
    z: np.ndarray
    yes: np.ndarray
    total: np.ndarray

    def rows(self, index):
        return Answers(self.function, self.z[index], self.yes[index], self.total[index])


def probability(function, z, theta, anchor=None):
    """(p (n, k), dp/dtheta (n, k, 4)) at z (n, k) for theta (n, 4). anchor: name of the derived point that q stands for, or None."""
    q, t, guess, lapse = (theta[:, i:i + 1] for i in range(4))
    s = np.exp(t)
    u0 = 0.0 if anchor is None else function.anchor(anchor, guess)
    u = (z - q) / s + u0
    core, slope = function.core.both(within(u, -1e6, 1e6))
    a, b = function.rates(guess, lapse)
    p = within(a + b * core, LEAST_P, 1 - LEAST_P)
    by = np.empty(p.shape + (4,))
    by[..., Q] = -b * slope / s
    by[..., T] = -b * slope * (u - u0)
    by[..., GUESS] = 0.0 if function.symmetric else 1 - core
    by[..., LAPSE] = 0.5 - core if function.symmetric else -core
    if anchor is not None and function.anchors()[anchor] is None:
        # u0 moves with the guess rate: F(u0) = (0.75 - guess) / (1 - guess).
        by[..., GUESS] += b * slope * -0.25 / (1 - guess) ** 2 / function.core.both(u0)[1]
    return p, by


def log_likelihood(answers, p):
    """(n,) log likelihood without the binomial coefficients."""
    return (answers.yes * np.log(p) + (answers.total - answers.yes) * np.log1p(-p)).sum(axis=-1)


def log_prior(theta, free):
    """(n,) log prior: Beta(1, GUESS_PRIOR) on fitted guess rates; lapse rates have bounds only."""
    return np.where(free[GUESS], (GUESS_PRIOR - 1) * np.log1p(-theta[:, GUESS]), 0.0)


def maximise(answers, start, free, low, high, anchor=None):
    """(theta (n, 4), value (n,), done (n,)): value is log likelihood plus log prior at the maximum.

    start (n, 4); free (4,) of bool: fitted parameters, the others keep their start; low, high (n, 4): bounds."""
    free = np.asarray(free, dtype=bool)
    theta = np.where(free, within(start, low, high), start)
    n = len(theta)
    value = np.full(n, -np.inf)
    done = np.zeros(n, dtype=bool)
    damping = np.full(n, 1e-3)
    index = np.arange(n)
    p, by = probability(answers.function, answers.z, theta, anchor)
    value = log_likelihood(answers, p) + log_prior(theta, free)
    some = answers
    for _ in range(MAX_STEPS):
        if not len(index):
            break
        step, gain = scoring_step(some, p, by, theta[index], free, low[index], high[index], damping[index])
        tried = np.where(free, within(theta[index] + step, low[index], high[index]), theta[index])
        new_p, new_by = probability(some.function, some.z, tried, anchor)
        new = log_likelihood(some, new_p) + log_prior(tried, free)
        better = new >= value[index]
        finished = (better & (np.abs(new - value[index]) < TOLERANCE) & (gain < 1e3 * TOLERANCE)) | (~better & (gain < TOLERANCE)) | (damping[index] > 1e12)
        # For unlikely answers the expected information is smaller than the observed one: steps overshoot and oscillate, so they are damped as well.
        poor = new - value[index] < 0.1 * gain
        theta[index[better]], value[index[better]] = tried[better], new[better]
        p, by = np.where(better[:, None], new_p, p), np.where(better[:, None, None], new_by, by)
        damping[index] = within(damping[index] * np.where(~better, 10, np.where(poor, 4, 0.2)), 1e-9, 1e13)
        done[index[finished]] = True
        if finished.any():
            keep = ~finished
            index, p, by, some = index[keep], p[keep], by[keep], some.rows(keep)
    return theta, value, done


def scoring_step(answers, p, by, theta, free, low, high, damping):
    """(step (n, 4), its expected gain (n,) of log likelihood)."""
    weight = 1 / (p * (1 - p))
    score = np.einsum("nk,nki->ni", (answers.yes - answers.total * p) * weight, by)
    information = np.einsum("nk,nki,nkj->nij", answers.total * weight, by, by)
    if free[GUESS]:
        score[:, GUESS] -= (GUESS_PRIOR - 1) / (1 - theta[:, GUESS])
        information[:, GUESS, GUESS] += (GUESS_PRIOR - 1) / (1 - theta[:, GUESS]) ** 2
    held = ~free | ((theta <= low) & (score <= 0)) | ((theta >= high) & (score >= 0))
    score = np.where(held, 0.0, score)
    information[held[:, :, None] | held[:, None, :]] = 0.0
    diagonal = np.einsum("nii->ni", information)
    # The floor prevents a singular matrix if the answers carry no information about a parameter.
    diagonal += np.where(held, 1.0, damping[:, None] * diagonal + FLOOR)
    step = np.linalg.solve(information, score[..., None])[..., 0]
    step[:, T] = within(step[:, T], -1.0, 1.0)  # at most a factor of e in a step
    return step, np.einsum("ni,ni->n", step, score)
