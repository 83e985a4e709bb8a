"""Draws of means, and intervals from draws.

The Bayesian bootstrap (Rubin 1981, Annals of Statistics 9:130) gives random weights to the rows. With enough participants, people are the sample, and all
rows of one participant get the same weight. Otherwise each row has its own weight, and the results hold for these participants only. Weights are gamma
distributed with shape 1 - 2/n, so that the variance of a mean of n equal clusters is the unbiased s^2/n; Rubin's (shape 1) is smaller by (n-1)/(n+1).
"""
import numpy as np

DRAWS = 2000  # Efron and Tibshirani 1993, section 12.5: at least 1000 for percentile intervals
FEWEST_PARTICIPANTS = 5  # for an estimate of the variance between people; design
AT_ONCE = 4_000_000  # weights in memory; design


def weights(n, draws, rng):
    """(draws, n) random weights of n clusters."""
    return rng.standard_gamma(max(1 - 2 / n, 1 / n), size=(draws, n))


def by_participant(participants):
    return len(set(participants)) >= FEWEST_PARTICIPANTS


class Resampler:
    """Draws of means of cells (conditions) that share their participants. Each analysis uses one Resampler, which draws its cells jointly."""

    def __init__(self, participants, rng, draws=DRAWS):
        self.draws, self.rng = draws, rng
        self.people = sorted(set(participants))
        self.clustered = by_participant(self.people)
        self.of_people = weights(len(self.people), draws, rng) if self.clustered else None

    def of_cell(self, participants, values):
        """(draws, k) weighted means of values (n, k), and the sums of the weights (draws,). No value may be NaN."""
        values = np.asarray(values, dtype=float)
        if self.clustered:
            at = {name: i for i, name in enumerate(self.people)}
            index = np.array([at[p] for p in participants])
            sums = np.stack([np.bincount(index, weights=v, minlength=len(self.people)) for v in values.T], axis=1)
            counts = np.bincount(index, minlength=len(self.people))
            mass = self.of_people @ counts
            # A cell of few people may get no weight in a draw; the draw is NaN there.
            return np.divide(self.of_people @ sums, mass[:, None], out=np.full((self.draws, values.shape[1]), np.nan), where=mass[:, None] > 0), mass
        sums, mass = np.empty((self.draws, values.shape[1])), np.empty(self.draws)
        step = max(1, AT_ONCE // len(values))
        for first in range(0, self.draws, step):
            w = weights(len(values), min(step, self.draws - first), self.rng)
            mass[first:first + step] = w.sum(axis=1)
            sums[first:first + step] = (w @ values) / mass[first:first + step, None]
        return sums, mass

    def share(self, share, mass):
        """Draws of a share with Jeffreys' prior, half a success and half a failure, added (Brown, Cai and DasGupta 2001, Statistical
        Science 16:101): 20 of 20 successes do not prove 100 %."""
        yes, no = self.rng.standard_gamma(0.5, size=(2, self.draws))
        return (share * mass + yes) / (mass + yes + no)


def interval(draws, level=0.95):
    """(low, high) percentiles of draws; infinite draws (not reached) count as the largest, NaN are left out."""
    kept = np.sort(draws[~np.isnan(draws)])
    if not len(kept):
        return float("nan"), float("nan")
    ends = [(1 - level) / 2, (1 + level) / 2]
    low, high = (kept[min(len(kept) - 1, max(0, int(np.ceil(q * len(kept))) - 1))] for q in ends)
    return float(low), float(high)


def share_beyond(draws, bound):
    """One-sided p: share of draws at or above the bound; never 0 (Davison and Hinkley 1997, equation 4.11)."""
    kept = draws[~np.isnan(draws)]
    return (np.count_nonzero(kept >= bound) + 1) / (len(kept) + 1)
