"""Fits the impedance and the smoothness of the intention of a hand to a recorded motion, with uncertainty. Pure."""
import dataclasses
import math

import numpy as np
from scipy import optimize

from tactus.rerun.hand_model import Hand, log_likelihoods

# Population of hands, for impedances that the log leaves open: log-normal, median and standard deviation of the logarithm. Design: 95 % of it spans hands
# that hold a stylus (0.02 to 0.57 kg, 3.7 to 28 N s/m, 63 to 533 N/m: Fu and Cavusoglu 2012, table III, as others quote it) and arms (0.7 to 2 kg,
# 5 to 40 N s/m, 100 to 800 N/m: Mussa-Ivaldi, Hogan and Bizzi 1985; Tsuji et al. 1995, orders of magnitude). Unverified.
POPULATION = {"mass_kg": (0.2, 1.2), "damping_N_s_m": (12.0, 0.8), "stiffness_N_m": (230.0, 0.8)}
# Of the intention and the recording: wide.
SMOOTHNESS = {"jerk": (1e2, 5.0), "jumps": (1e-3, 5.0), "noise_m": (1e-6, 2.5)}
RANGES = {"mass_kg": (0.001, 5.0), "damping_N_s_m": (0.01, 200.0), "stiffness_N_m": (1.0, 5000.0)}  # of the virtual hand: haptic_node/settings.csv
SHORTEST_NOISE_M, LONGEST_DELAY_S, DELAY_SD = 2e-8, 0.02, 3.0
SEGMENT_S = 1.0   # design: longer than a contact force takes to rise and fall
BLOCK_S = 0.1     # design: errors of the model within a contact are not independent
MOVED_M, PUSHED_N = 1e-4, 0.05  # a segment with less is at rest and says nothing; design
DRAWS = 400


@dataclasses.dataclass
class Posterior:
    """Draws of a fitted hand. contact: the log has force changes; otherwise the impedance is that of the population."""
    best: Hand
    hands: list
    contact: bool

    def interval(self, name, share=0.95):
        """(median, lower, upper) of a parameter."""
        values = [getattr(hand, name) for hand in self.hands]
        return tuple(float(v) for v in np.quantile(values, (0.5, (1 - share) / 2, (1 + share) / 2)))


def segments(positions_m, forces_N, dt_s):
    """(positions, forces), each (n, width): pieces of SEGMENT_S of each axis in which the hand moves or is pushed, side by side."""
    n = min(int(round(SEGMENT_S / dt_s)), len(positions_m))
    columns = []
    for first in range(0, len(positions_m) - n + 1, n):
        for axis in range(positions_m.shape[1]):
            x, F = positions_m[first:first + n, axis], forces_N[first:first + n, axis]
            if np.ptp(x) > MOVED_M or np.ptp(F) > PUSHED_N:
                columns.append((x, F))
    if not columns:
        return np.empty((0, 0)), np.empty((0, 0))
    return tuple(np.array([c[i] for c in columns]).T for i in (0, 1))


def has_contact(forces_N):
    """True when the force changes by more than PUSHED_N within a segment."""
    return bool(forces_N.size and np.max(np.ptp(forces_N, axis=0)) > PUSHED_N)


class Problem:
    """Log posterior over the logarithms of the parameters. free_delay: the delay of the loop through the device is unknown."""

    def __init__(self, positions_m, forces_N, dt_s, free_delay=False):
        self.data = positions_m, forces_N, dt_s
        priors = {**POPULATION, **SMOOTHNESS}
        self.names = [*priors, *(["delay_s"] if free_delay else [])]
        self.centre = np.array([*(np.log(median) for median, _ in priors.values()), *([-1.0] if free_delay else [])])
        self.precision = np.array([*(sd**-2 for _, sd in priors.values()), *([DELAY_SD**-2] if free_delay else [])])

    def hand(self, theta):
        values = {name: math.exp(min(max(t, -40.0), 40.0)) for name, t in zip(self.names, theta)}
        values["noise_m"] += SHORTEST_NOISE_M
        for name, (least, most) in RANGES.items():
            values[name] = min(max(values[name], least), most)
        if "delay_s" in self.names:
            values["delay_s"] = LONGEST_DELAY_S / (1 + math.exp(-min(max(theta[-1], -40.0), 40.0)))
        return Hand(**values)

    def blocks(self, theta):
        """Log probabilities of the data, one for each block of BLOCK_S of each segment."""
        values = log_likelihoods(self.hand(theta), *self.data)
        edges = range(0, len(values), max(1, int(round(BLOCK_S / self.data[2]))))
        return np.add.reduceat(values, list(edges), axis=0).ravel()

    def __call__(self, theta):
        value = self.blocks(theta).sum() - 0.5 * (self.precision * (theta - self.centre) ** 2).sum()
        return float(value) if np.isfinite(value) else -1e15


def curvature(problem, theta, step=0.02):
    """Negative second derivatives of the log posterior, by central differences."""
    n = len(theta)
    E = step * np.eye(n)
    centre = problem(theta)
    H = np.empty((n, n))
    plus, minus = [problem(theta + E[i]) for i in range(n)], [problem(theta - E[i]) for i in range(n)]
    for i in range(n):
        H[i, i] = -(plus[i] - 2 * centre + minus[i]) / step**2
        for j in range(i):
            both = problem(theta + E[i] + E[j]) + problem(theta - E[i] - E[j])
            H[i, j] = H[j, i] = -(both - plus[i] - minus[i] - plus[j] - minus[j] + 2 * centre) / (2 * step**2)
    return H


def covariance(problem, theta, step=0.02):
    """Covariance of the estimate that holds also when the intention is not as smooth everywhere as in the model: H^-1 (J + prior) H^-1 with the
    sum J of the squared gradients of all blocks (White 1982, Econometrica 50), at least the inverse of H itself."""
    H = curvature(problem, theta, step)
    E = step * np.eye(len(theta))
    scores = np.array([(problem.blocks(theta + e) - problem.blocks(theta - e)) / (2 * step) for e in E])
    values, vectors = np.linalg.eigh((H + H.T) / 2)
    # The posterior is at most as wide as the prior in any direction.
    inverse = vectors / np.maximum(values, problem.precision.min()) @ vectors.T
    J = scores @ scores.T + np.diag(problem.precision)
    robust = inverse @ J @ inverse
    # The larger of both in each direction.
    values, vectors = np.linalg.eigh(robust - inverse)
    return inverse + vectors * np.maximum(values, 0) @ vectors.T


def maximum(problem):
    """The most probable parameters: of two starts, with an intention that jumps much or little."""
    found = None
    for jerk, jumps in ((3.0, -6.0), (0.0, 0.0)):
        start = problem.centre.copy()
        start[problem.names.index("jerk")] += jerk
        start[problem.names.index("jumps")] += jumps
        result = optimize.minimize(lambda theta: -problem(theta), start, method="BFGS", options={"gtol": 0.05, "maxiter": 200, "eps": 1e-5})
        if found is None or result.fun < found.fun:
            found = result
    return found.x


def fit(positions_m, forces_N, dt_s, rng, free_delay=False):
    """Posterior of the hand that made a motion. positions_m, forces_N: (n, 3), one row a tick of dt_s; forces on the hand, held until the next tick.
    free_delay: also fits the delay of the loop. rng: a numpy Generator. Raises ValueError when the hand never moves."""
    x, F = segments(positions_m, forces_N, dt_s)
    if x.shape[1] == 0:
        raise ValueError("the hand does not move")
    contact = has_contact(F)
    problem = Problem(x, F, dt_s, free_delay and contact)
    theta = maximum(problem)
    draws = rng.multivariate_normal(theta, covariance(problem, theta), DRAWS, method="eigh")
    if not contact:  # the smoothness of a motion is no evidence about an impedance
        n = len(POPULATION)
        theta[:n] = problem.centre[:n]
        draws[:, :n] = theta[:n] + rng.standard_normal((DRAWS, n)) / np.sqrt(problem.precision[:n])
    return Posterior(problem.hand(theta), [problem.hand(d) for d in draws], contact)
