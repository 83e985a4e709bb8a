"""Hands of known impedance that touch a wall, simulated tick by tick: the data of the tests of the fit."""
import numpy as np

from tactus.rerun import hand_model

DT_S = 1e-3


def smooth_path(rng, seconds, size_m=0.02):
    """An intention (n, 3): the sum of sines of random phase and of frequencies of voluntary motion, up to 2 Hz. m."""
    t = np.arange(int(round(seconds / DT_S))) * DT_S
    path = np.zeros((len(t), 3))
    for axis in range(3):
        for frequency in rng.uniform(0.2, 2.0, 4):
            path[:, axis] += size_m / 4 / frequency * np.sin(2 * np.pi * (frequency * t + rng.random()))
    return path - path[0]


def touching(hand, path, rng, wall_N_m=800.0, force=None):
    """(positions, forces), each (n, 3), of a hand on its path through walls that appear at random times: bumps that the intention does not expect.
    force: changes the force (n_tick, force) -> force; None: none."""
    n = len(path)
    H, push = hand_model.response(hand, DT_S)
    state = np.vstack([path[0], np.zeros(3)])
    positions, forces = np.empty((n, 3)), np.zeros((n, 3))
    wall, until, axis = None, 0, 0
    later = rng.integers(200, 400)
    for i in range(n):
        positions[i] = state[0]
        if wall is None and i >= later:  # a surface appears at the hand and moves 5 mm against it
            wall, until, axis = state[0].copy(), i + rng.integers(150, 350), rng.integers(3)
            sign, depth = rng.choice([-1.0, 1.0]), rng.uniform(0.003, 0.008)
        if wall is not None:
            ramp = min(1.0, (i - (until - 350)) / 30) if i > until - 350 else 0.0
            penetration = sign * (wall[axis] - state[0, axis]) + depth * max(ramp, 0.0)
            forces[i, axis] = sign * wall_N_m * max(0.0, penetration)
            if i >= until:
                wall, later = None, i + rng.integers(200, 500)
        if force is not None:
            forces[i] = force(i, forces[i])
        if i + 1 < n:
            state = H @ np.vstack([state, path[i:i + 1], path[i + 1:i + 2]]) + push[:, None] * forces[i]
    return positions, forces
