"""Compares games of the same seeds, live and in virtual time: success and time of each condition, and the order of conditions. No side effects.

Games of one seed start with the same positions of the balls only; their course depends on the exact wake-up times of all loops. Shares are therefore
compared as those of two independent samples (Newcombe 1998, Statistics in Medicine 17:873, method 10), which is conservative if equal seeds correlate.
Times are compared by the differences of equal seeds (Student's t).
"""
import dataclasses
import math

import numpy as np
from scipy.stats import kendalltau, norm, spearmanr
from statsmodels.stats.proportion import confint_proportions_2indep

from tactus.study import power_games
from tactus.virtual_time_check import bounds

ALPHA = 0.05
SUCCESS = 0.15     # largest difference of success; tests/measure/measure_agreement gives the reasons for all bounds
LEAST_TAU = 0.6
DRAWS = 2000       # of the attainable tau; gives its percentiles to 0.01


@dataclasses.dataclass
class Pairs:
    """The games of one condition, one entry for each seed. won: 0 or 1; time_s: the limit for a game not won."""
    condition: str
    limit_s: float
    live_won: list = dataclasses.field(default_factory=list)
    live_s: list = dataclasses.field(default_factory=list)
    virtual_won: list = dataclasses.field(default_factory=list)
    virtual_s: list = dataclasses.field(default_factory=list)

    def add(self, live, virtual):
        """Adds a game: (won, time_s) live and in virtual time."""
        for (won, time_s), wons, times in ((live, self.live_won, self.live_s), (virtual, self.virtual_won, self.virtual_s)):
            won = bool(won) and time_s <= self.limit_s
            wons.append(int(won))
            times.append(float(time_s) if won else self.limit_s)

    @property
    def n(self):
        return len(self.live_won)

    def success(self):
        return bounds.of_means(f"won: {self.condition}", "", self.live_won, self.virtual_won, SUCCESS, newcombe(self.virtual_won, self.live_won))

    def time(self):
        return bounds.of_means(f"time: {self.condition}", "s", self.live_s, self.virtual_s, SUCCESS * self.limit_s, of_times([self], newcombe(self.virtual_won, self.live_won)))

    def row(self):
        """Row of the table: the comparisons, and the intervals of both shares."""
        shares = [wilson(won) if won else (None, None) for won in (self.live_won, self.virtual_won)]
        return {"condition": self.condition, "games": self.n, "live_interval": shares[0], "virtual_interval": shares[1],
                "success": self.success().row(), "time": self.time().row()}


def wilson(won):
    """(low, high) of a share: Wilson's 95 % interval."""
    return tuple(float(x) for x in power_games.wilson(np.float64(np.mean(won)), len(won), ALPHA))


def newcombe(a, b):
    """(low, high) of share(b) - share(a)."""
    if not (a and b):
        return math.nan, math.nan
    return tuple(float(x) for x in confint_proportions_2indep(sum(b), len(b), sum(a), len(a), method="newcomb", compare="diff", alpha=ALPHA))


def paired(a, b):
    """(low, high) of the mean of a - b over equal seeds; NaN: fewer than two."""
    if len(a) < 2:
        return math.nan, math.nan
    low, high = power_games.paired(np.array([np.subtract(a, b)], dtype=float), ALPHA)
    return float(low[0]), float(high[0])


def of_times(cells, of_success):
    """(low, high) of the mean difference of times. If no two times differ, for example because no game was won, the interval of success times the limit is
    used."""
    pairs = [(a, b) for c in cells for a, b in zip(c.live_s, c.virtual_s)]
    if any(a != b for a, b in pairs):
        return paired(*zip(*pairs))
    low, high = of_success
    limit_s = max(c.limit_s for c in cells)
    return -high * limit_s, -low * limit_s


def stratified(cells):
    """(low, high) of the mean difference of success over conditions: the normal interval. The variance of each share adds half a won and half a lost game,
    because 5 of 5 does not prove 100 % (Agresti and Caffo 2000, The American Statistician 54:280, add a whole game)."""
    apart = np.mean([np.mean(c.live_won) - np.mean(c.virtual_won) for c in cells])
    smoothed = [((sum(won) + 0.5) / (c.n + 1), c.n) for c in cells for won in (c.live_won, c.virtual_won)]
    half = norm.ppf(1 - ALPHA / 2) * math.sqrt(sum(p * (1 - p) / n for p, n in smoothed)) / len(cells)
    return apart - half, apart + half


def together(cells):
    """[bounds.BoundCheck] of all games: the mean differences of success and of time, which are more precise than those of one condition."""
    cells = [c for c in cells if c.n]
    of_success = stratified(cells) if cells else (math.nan, math.nan)
    means = lambda name: [np.mean(getattr(c, name)) for c in cells]
    limit_s = max((c.limit_s for c in cells), default=math.nan)
    return [bounds.of_means("won: all conditions", "", means("live_won"), means("virtual_won"), SUCCESS, of_success),
            bounds.of_means("time: all conditions", "s", means("live_s"), means("virtual_s"), SUCCESS * limit_s, of_times(cells, of_success) if cells else of_success)]


@dataclasses.dataclass(frozen=True)
class Order:
    """Rank correlation of the conditions, live and in virtual time. reached: 5 % quantile of tau between two sets of virtual games of the same size; below
    the bound, the games are too few."""
    of: str
    tau: float
    rho: float
    reached: float

    @property
    def verdict(self):
        if math.isnan(self.tau) or self.tau < LEAST_TAU and not self.reached >= LEAST_TAU:
            return bounds.OPEN
        return bounds.HOLDS if self.tau >= LEAST_TAU else bounds.MISSED

    def row(self):
        figures = {k: None if isinstance(v, float) and math.isnan(v) else v for k, v in dataclasses.asdict(self).items()}
        return {**figures, "least_tau": LEAST_TAU, "says": self.verdict}


def correlation(of, a, b):
    """kendalltau (tau-b) or spearmanr; NaN: one of both is constant, or there are fewer than three values."""
    return math.nan if len(a) < 3 or np.ptp(a) == 0 or np.ptp(b) == 0 else float(of(a, b).statistic)


def redrawn(cells, dice, draws):
    """Two random sets of games with the same true shares: ((success, mean time), (success, mean time)), each (draws, conditions). The true share is drawn
    around the virtual one with Jeffreys' prior, because 5 of 5 does not prove 100 %; times to win are drawn from those of the condition, or of all."""
    sets = [([], []), ([], [])]
    won_s = [t for c in cells for won, t in zip(c.virtual_won, c.virtual_s) if won]
    for c in cells:
        n, k = c.n, sum(c.virtual_won)
        share = dice.beta(k + 0.5, n - k + 0.5, draws)
        pool = [t for won, t in zip(c.virtual_won, c.virtual_s) if won] or won_s or [c.limit_s]
        for success, time_s in sets:
            wins = dice.binomial(n, share)
            success.append(wins / n)
            time_s.append(np.where(np.arange(n) < wins[:, None], dice.choice(pool, (draws, n)), c.limit_s).mean(axis=1))
    return [tuple(np.array(values).T for values in each) for each in sets]


def orders(cells, seed=1, draws=DRAWS):
    """[Order] by success and by mean time."""
    cells = [c for c in cells if c.n]
    one, other = redrawn(cells, np.random.default_rng(seed), draws)
    found = []
    for i, (name, of) in enumerate((("won", "success"), ("s", "mean time"))):
        live, virtual = ([np.mean(getattr(c, f"{kind}_{name}")) for c in cells] for kind in ("live", "virtual"))
        taus = [tau for a, b in zip(one[i], other[i]) if not math.isnan(tau := correlation(kendalltau, a, b))]
        found.append(Order(of, correlation(kendalltau, live, virtual), correlation(spearmanr, live, virtual), float(np.quantile(taus, 0.05)) if taus else math.nan))
    return found
