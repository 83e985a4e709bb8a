"""The hand as a mass that a spring and a damper pull along its intention, and the probability of a recorded motion under it. Pure.

    m x'' + b (x' - r') + k (x - r) = F

x is the position of the device, m; F the displayed force on the hand, N; r the intention: the path that the hand follows without force.
Mass m in kg, damping b in N s/m, stiffness k in N/m are the same in all directions. A step of the hand is that of the virtual hand of haptic_node
(haptic_node/devices/virtual_hand.cpp): exact for a constant force and an intention that moves uniformly during the step.

The intention is smooth: its acceleration is a random walk (spectral density `jerk` of the third derivative, m^2/s^5), and the acceleration
itself may jump (density `jumps` of the second derivative, m^2/s^3). A Kalman filter gives the probability of the positions; the recorded force is an
input (Durbin and Koopman 2012, Time series analysis by state space methods, chapters 4 and 5).
"""
import dataclasses

import numpy as np
from scipy import signal

STATES = 5  # x, x', r, r', r''
# Standard deviations of the state at the start of a log, around its first position: m, m/s, m, m/s, m/s^2. Design: a hand that moves, or is at rest.
MOVING_SD, RESTING_SD = np.array([1e-3, 0.1, 5e-3, 0.2, 5.0]), np.array([1e-6, 1e-5, 1e-5, 1e-4, 1e-3])
AT_REST_M, AT_REST_STEPS = 1e-6, 20
ORDER = 5   # of the step of the state
CONVERGED = 1e-8  # relative change of the gain below which it is constant


@dataclasses.dataclass(frozen=True)
class Hand:
    """Parameters of a hand and of its intention. SI units. noise_m: standard deviation of a recorded position. delay_s: from a force to its
    effect on a recorded position, beyond the step in which it is commanded."""
    mass_kg: float
    damping_N_s_m: float
    stiffness_N_m: float
    jerk: float
    jumps: float
    noise_m: float = 1e-7
    delay_s: float = 0.0

    def impedance(self):
        return np.array([self.mass_kg, self.damping_N_s_m, self.stiffness_N_m])


def response(hand, dt_s):
    """(H, f): the step of (x, x') is H (x, x', r before, r after) + f F."""
    a, w2 = hand.damping_N_s_m / (2 * hand.mass_kg), hand.stiffness_N_m / hand.mass_kg
    q = a * a - w2
    root = np.sqrt(abs(q))
    if abs(q) * dt_s * dt_s < 1e-12:
        c, s = np.exp(-a * dt_s), dt_s * np.exp(-a * dt_s)
    elif q > 0:
        slow, fast = np.exp(-w2 / (a + root) * dt_s), np.exp(-(a + root) * dt_s)
        c, s = (slow + fast) / 2, (slow - fast) / (2 * root)
    else:
        c, s = np.exp(-a * dt_s) * np.cos(root * dt_s), np.exp(-a * dt_s) * np.sin(root * dt_s) / root
    xx, xv, vx, vv = c + s * a, s, -s * w2, c - s * a
    H = np.array([[xx, xv, -xx + xv / dt_s, 1 - xv / dt_s], [vx, vv, -vx + (vv - 1) / dt_s, (1 - vv) / dt_s]])
    return H, np.array([1 - xx, -vx]) / hand.stiffness_N_m


def system(hand, dt_s):
    """(A, f, Q): the step of the state is A state + f F + noise of covariance Q."""
    H, push = response(hand, dt_s)
    t = dt_s
    path = np.array([[1, t, t * t / 2], [0, 1, t], [0, 0, 1]])
    noise = (hand.jerk * np.array([[t**5 / 20, t**4 / 8, t**3 / 6], [t**4 / 8, t**3 / 3, t**2 / 2], [t**3 / 6, t**2 / 2, t]])
             + hand.jumps * np.array([[t**3 / 3, t**2 / 2, 0], [t**2 / 2, t, 0], [0, 0, 0]]))
    A = np.zeros((STATES, STATES))
    A[:2, :2] = H[:, :2]
    A[:2, 2] = H[:, 2]
    A[:2, 2:] += np.outer(H[:, 3], path[0])
    A[2:, 2:] = path
    G = np.vstack([np.outer(H[:, 3], [1, 0, 0]), np.eye(3)])
    return A, np.concatenate([push, np.zeros(3)]), G @ noise @ G.T


def gains(A, Q, noise_m, steps, start_sd):
    """(gain (n, 5), variance of the innovation (n,), covariance of the prediction (n, 5, 5)) of the filter, the same for all segments and axes.
    n <= steps: from the last entry on they are constant."""
    P, R, identity = np.diag(start_sd**2), noise_m**2, np.eye(STATES)
    K_all, S_all, P_all = [], [], []
    for _ in range(steps):
        S = P[0, 0] + R
        K = P[:, 0] / S
        K_all.append(K)
        S_all.append(S)
        P_all.append(P)
        if len(K_all) > 20 and np.all(np.abs(K - K_all[-2]) <= CONVERGED * np.abs(K)) and abs(S - S_all[-2]) <= CONVERGED * S:
            break
        L = identity.copy()
        L[:, 0] -= K
        P = L @ P @ L.T + R * np.outer(K, K)  # the form of Joseph stays positive
        P = A @ P @ A.T + Q
        P = (P + P.T) / 2
    return np.array(K_all), np.array(S_all), np.array(P_all)


def starts_at_rest(positions_m, forces_N):
    """True when the hand (n, width) does not move or feel a force in its first steps."""
    return bool(len(positions_m) > AT_REST_STEPS and np.ptp(positions_m[:AT_REST_STEPS], axis=0).max() < AT_REST_M and not forces_N[:AT_REST_STEPS].any())


def start_state(hand, positions_m, forces_N, dt_s):
    """State (5, width) before the first step of segments: at the first position, with the intention that holds the first force at rest."""
    state = np.zeros((STATES, positions_m.shape[1]))
    state[0] = positions_m[0]
    state[1] = (positions_m[1] - positions_m[0]) / dt_s
    state[2] = positions_m[0] - forces_N[0] / hand.stiffness_N_m
    state[3] = state[1]
    return state


def delayed(forces_N, delay_s, dt_s):
    """Forces (n, width) that act delay_s later, each held for a step: between whole steps, the mean of two."""
    if delay_s <= 0:
        return forces_N
    whole, part = divmod(delay_s / dt_s, 1)
    padded = np.concatenate([np.repeat(forces_N[:1], int(whole) + 1, axis=0), forces_N])
    n = len(forces_N)
    return (1 - part) * padded[1:n + 1] + part * padded[:n]


def steady(A, Q, noise_m):
    """(gain (5,), variance of the innovation) of the filter after its start, by doubling (Chu, Fan and Lin 2005, Linear Algebra and its Applications 396)."""
    scale = np.sqrt(noise_m**2 + np.diag(Q))
    unscaled, F = noise_m / scale[0], (A / scale[:, None] * scale).T
    G, P, identity = np.zeros((STATES, STATES)), Q / np.outer(scale, scale), np.eye(STATES)
    G[0, 0] = 1 / unscaled**2
    for _ in range(60):
        W = np.linalg.solve(identity + G @ P, np.hstack([F, G]))
        step = F.T @ P @ W[:, :STATES]
        G = G + F @ W[:, STATES:] @ F.T
        P, F = P + step, F @ W[:, :STATES]
        if abs(step[0, 0]) <= 1e-9 * P[0, 0]:
            break
    P = P * np.outer(scale, scale)
    S = P[0, 0] + noise_m**2
    return P[:, 0] / S, S


def log_likelihoods(hand, positions_m, forces_N, dt_s):
    """Log probability densities (n - ORDER, width) of the positions (n, width), m, of segments side by side, given the forces (n, width), N, on the hand.

    The third differences of D x - N F, where D and N are the polynomials of the step of the hand, are a moving average of the innovations of the
    constant filter. The innovations before the segment are unknown, with the same variance, so the probability is exact (Box, Jenkins and Reinsel
    1994, Time series analysis, section 7.1.4). The first ORDER positions are given."""
    A, push, Q = system(hand, dt_s)
    K, S = steady(A, Q, hand.noise_m)
    forces_N = delayed(forces_N, hand.delay_s, dt_s)
    own = A[:2, :2]
    trace, determinant = own[0, 0] + own[1, 1], own[0, 0] * own[1, 1] - own[0, 1] * own[1, 0]
    x, F = positions_m, forces_N
    driven = (x[2:] - trace * x[1:-1] + determinant * x[:-2]) - push[0] * F[1:-1] - (own[0] @ push[:2] - trace * push[0]) * F[:-2]
    average = np.poly(np.linalg.eigvals(A - np.outer(A @ K, [1, 0, 0, 0, 0]))).real
    errors = signal.lfilter([1.0], average, np.diff(driven, 3, axis=0), axis=0)
    # before[:, k]: effect of the innovation k + 1 steps before the segment.
    before = np.zeros((len(errors), ORDER))
    for k in range(ORDER):
        before[:ORDER - k, k] = -average[k + 1:]
    before = signal.lfilter([1.0], average, before, axis=0)
    basis, root = np.linalg.qr(np.vstack([np.eye(ORDER), before]))
    residuals = -basis @ (basis[ORDER:].T @ errors)
    residuals[ORDER:] += errors
    values = -0.5 * (residuals[ORDER:]**2 / S + np.log(2 * np.pi * S))
    values[0] -= 0.5 * (residuals[:ORDER]**2).sum(axis=0) / S + np.log(np.abs(np.diag(root))).sum()
    return values


def smoothed(hand, positions_m, forces_N, dt_s):
    """Expected states (n, 5, width) given all positions (n, width): of x, x', r, r', r''."""
    forces_N = delayed(forces_N, hand.delay_s, dt_s)
    start_sd = RESTING_SD if starts_at_rest(positions_m, forces_N) else MOVING_SD
    return smoothed_from(hand, start_state(hand, positions_m, forces_N, dt_s), start_sd, positions_m, forces_N, dt_s)


def smoothed_from(hand, state, start_sd, positions_m, forces_N, dt_s):
    """Expected states (n, 5, width) given all positions and the mean (5, width) and standard deviations (5,) of the first state."""
    A, push, Q = system(hand, dt_s)
    n, width = positions_m.shape
    K_all, S_all, P_all = gains(A, Q, hand.noise_m, n, start_sd)
    last = len(K_all) - 1
    predicted, errors = np.empty((n, STATES, width)), np.empty((n, width))
    pushes = push[:2, None] * forces_N[:, None, :]
    for i in range(n):
        predicted[i] = state
        errors[i] = positions_m[i] - state[0]
        state = A @ (state + K_all[min(i, last)][:, None] * errors[i])
        state[:2] += pushes[i]
    # Backwards, the gradient by the prediction (Durbin and Koopman 2012, equation 4.44).
    gradient = np.zeros((STATES, width))
    for i in range(n - 1, -1, -1):
        j = min(i, last)
        gradient = A.T @ gradient
        gradient[0] += errors[i] / S_all[j] - K_all[j] @ gradient
        predicted[i] += P_all[j] @ gradient
    return predicted


def drawn_intention(hand, positions_m, forces_N, dt_s, rng):
    """A random intention (n, width), m, from its distribution given the positions (n, width): the simulation smoother of Durbin and Koopman 2002,
    Biometrika 89. rng: a numpy Generator."""
    A, _, Q = system(hand, dt_s)
    n, width = positions_m.shape
    start_sd = RESTING_SD if starts_at_rest(positions_m, forces_N) else MOVING_SD
    state = start_sd[:, None] * rng.standard_normal((STATES, width))
    root = square_root(Q)
    simulated, path = np.empty((n, width)), np.empty((n, width))
    for i in range(n):
        simulated[i], path[i] = state[0], state[2]
        state = A @ state + root @ rng.standard_normal((STATES, width))
    simulated += hand.noise_m * rng.standard_normal((n, width))
    without_force = smoothed_from(hand, np.zeros((STATES, width)), start_sd, simulated, np.zeros((n, width)), dt_s)
    return smoothed(hand, positions_m, forces_N, dt_s)[:, 2] + path - without_force[:, 2]


def square_root(Q):
    """A matrix B with B B' = Q, for a covariance that may be singular."""
    values, vectors = np.linalg.eigh(Q)
    return vectors * np.sqrt(np.maximum(values, 0))
