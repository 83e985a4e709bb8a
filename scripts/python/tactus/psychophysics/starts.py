"""Starting points of fits: the most likely cell of a grid of locations and spreads, one among narrow and one among wide spreads.

The likelihood of a psychometric function may have several maxima (few trials, a lapse at an easy level), and scoring finds the nearest.
"""
import numpy as np

from tactus.psychophysics.likelihood import GUESS, LAPSE, Q, T, Answers, log_likelihood, maximise, probability

LOCATIONS = np.linspace(-0.6, 0.6, 25)                     # of the span of the levels, from its middle; design
SPREADS = np.log(np.geomspace(0.02, 1.5, 10))              # design
LOW_PEAK = 0.35  # lapse rate of a further start, if the bounds permit it; design
AT_ONCE = 4_000_000                                        # probabilities held in memory; design


def grid_starts(answers, rates):
    """(narrow, wide), each (n, 4): the best cells of the grid. answers lie on an axis from -0.5 to 0.5. rates (n, 2): guess and lapse."""
    n, k = answers.z.shape
    cells = np.stack(np.meshgrid(LOCATIONS, SPREADS, indexing="ij"), axis=-1).reshape(-1, 2)
    values = np.empty((n, len(cells)))
    step = max(1, AT_ONCE // (len(cells) * k))
    for first in range(0, n, step):
        some = answers.rows(slice(first, first + step))
        m = len(some.z)
        theta = np.empty((m * len(cells), 4))
        theta[:, [Q, T]] = np.tile(cells, (m, 1))
        theta[:, [GUESS, LAPSE]] = np.repeat(rates[first:first + m], len(cells), axis=0)
        many = Answers(some.function, *(np.repeat(x, len(cells), axis=0) for x in (some.z, some.yes, some.total)))
        values[first:first + m] = log_likelihood(many, quick(many, theta)).reshape(m, -1)
    narrow = cells[:, 1] < SPREADS[len(SPREADS) // 2]
    found = []
    for part in (narrow, ~narrow):
        best = np.flatnonzero(part)[values[:, part].argmax(axis=1)]
        found.append(np.concatenate([cells[best], rates], axis=1))
    return found


def quick(answers, theta):
    """p without its derivatives."""
    return probability(answers.function, answers.z, theta)[0]


def fit_from_grid(answers, rates, free, low, high, more=()):
    """maximise() from the starts of the grid and from `more`; returns the best of each set: (theta, value, done)."""
    best = None
    lower = rates.copy()  # a window whose peak is far below 1
    lower[:, 1] = LOW_PEAK
    lows = grid_starts(answers, lower) if free[LAPSE] and (high[:, LAPSE] > LOW_PEAK).all() else []
    for start in [*grid_starts(answers, rates), *lows, *more]:
        theta, value, done = maximise(answers, start, free, low, high)
        if best is None:
            best = [theta, value, done]
            continue
        better = value > best[1] + 1e-6
        best = [np.where(better[:, None], theta, best[0]), np.where(better, value, best[1]), np.where(better, done, best[2])]
    return best
