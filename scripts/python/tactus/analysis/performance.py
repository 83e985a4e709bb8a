"""Games at each level of degradation compared with undegraded games: success, time, and whether the level is harmless.

A game that was not won counts with the time limit, so the mean time is the restricted mean of the time to win (Royston and Parmar 2013, BMC Medical
Research Methodology 13:152): all games are observed for the same time, so the area under the Kaplan-Meier curve up to the limit equals the mean of
min(time, limit). No assumption about the later course of a lost game is needed.

Non-inferiority: for success, the score test of Farrington and Manning 1990 (Statistics in Medicine 9:1447) and the interval of Newcombe 1998 (Statistics
in Medicine 17:873, method 10); for time, and for both if people are the sample, the bootstrap of resampling.py. The levels of one factor are several
tests: Holm 1979, over all levels and both outcomes of the factor.
"""
import dataclasses
import math

import numpy as np
from scipy.stats import norm
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.proportion import confint_proportions_2indep, proportion_confint

from tactus.analysis import answers, operators, resampling
from tactus.refusal import Refusal

TASK = "game"
EXTRAS = ("errors", "peak_force_n", "force_rmse_n", "path_m")  # reported, not tested


@dataclasses.dataclass
class Cell:
    """The games of one condition. degraded: ((Factor, level), ...), empty for the baseline."""
    degraded: tuple
    participants: np.ndarray
    success: np.ndarray
    time_s: np.ndarray
    extras: dict
    achieved: float = float("nan")
    draws: np.ndarray = None  # (draws, 2): share of success, restricted mean time

    @property
    def n(self):
        return len(self.success)

    @property
    def share(self):
        return float(self.success.mean())

    @property
    def mean_time_s(self):
        return float(self.time_s.mean())

    def share_interval(self):
        return tuple(float(v) for v in proportion_confint(int(self.success.sum()), self.n, method="wilson"))


def degraded_of(row):
    """((Factor, level), ...) of one row's columns, without levels that have no effect."""
    found = []
    for prefix, modality in (("", "modality_degraded"), ("second_", "second_modality")):
        level = row[prefix + "level"]
        factor = operators.factor(row[modality], row[prefix + "operator"], row[prefix + "unit"], level)
        if factor.modality and factor.operator and not factor.undegraded(level):
            found.append((factor, 0.0 if factor.removal or level != level else level))
    return tuple(sorted(found))


def limit_s(games, stated):
    """Time limit of the games, s: as stated, or the longest time of a game that was not won. Infinite if all were won."""
    lost = games["success"] == 0
    times = games["completion_time_s"]
    if np.isnan(times[~lost & ~np.isnan(games["success"])]).any():
        raise Refusal("a game that was won has no completion_time_s; add the time of each won game")
    if (times[games["success"] == 1] <= 0).any():
        raise Refusal("a game was won after 0 s: it was won before it began; remove it, or mark it as missed")
    if stated is not None:
        return stated
    if not lost.any():
        return float("inf")
    if np.isnan(times[lost]).any():
        raise Refusal("games that were not won have no completion_time_s and no time limit is known; give --time-limit SECONDS, or the study file beside the table")
    return float(times[lost].max())


def games_of(trials):
    task = trials["task"] == TASK
    return trials.where(task & ~np.isnan(trials["success"]))


def achieved_of(games, degraded):
    """Mean measured level of a condition with one factor; the requested level if none was measured."""
    (factor, level), = degraded
    if factor.operator == "loss" and not np.isnan(games["loss_achieved"]).all():
        return float(np.nanmean(games["loss_achieved"])) * (100 if factor.unit == "%" else 1)
    if factor.operator == "delay" and not np.isnan(games["soa_achieved_ms"]).all():
        first, second = answers.pair_of(games["pair"][0])
        sign = 1 if second == factor.modality else -1 if first == factor.modality else 0
        if sign and factor.unit == "ms":
            return sign * float(np.nanmean(games["soa_achieved_ms"]))
    return level


def cells_of(games, limit, rng, draws=resampling.DRAWS):
    """({degraded: Cell}, all drawn jointly; whether people are the sample)."""
    keys = ("modality_degraded", "operator", "level", "unit", "second_modality", "second_operator", "second_level", "second_unit")
    merged = {}
    for key, rows in games.groups(*keys):
        row = {name: (float("nan") if value == "" and "level" in name else value) for name, value in zip(keys, key)}
        merged.setdefault(degraded_of(row), []).append(rows)
    resampler = resampling.Resampler(games["participant_id"], rng, draws)
    cells = {}
    for degraded in sorted(merged):
        parts = merged[degraded]
        join = lambda name: np.concatenate([p[name] for p in parts])
        success = join("success")
        times = np.where(success == 1, np.minimum(join("completion_time_s"), limit), limit)
        # A game won after the limit counts as not won.
        success = np.where((success == 1) & (join("completion_time_s") <= limit), 1.0, 0.0)
        cell = Cell(degraded, join("participant_id"), success, times, {name: join(name) for name in EXTRAS})
        if len(degraded) == 1 and not degraded[0][0].removal:
            cell.achieved = float(np.average([achieved_of(p, degraded) for p in parts], weights=[len(p) for p in parts]))
        means, mass = resampler.of_cell(cell.participants, np.stack([cell.success, cell.time_s], axis=1))
        means[:, 0] = resampler.share(means[:, 0], mass)
        cell.draws = means
        cells[degraded] = cell
    return cells, resampler.clustered


@dataclasses.dataclass
class Difference:
    """A condition compared with the baseline. success: share(cell) - share(baseline); time: mean(cell) / mean(baseline)."""
    cell: Cell
    success: float
    success_interval: tuple
    time: float
    time_interval: tuple
    p_success: float  # of the hypothesis that success is worse by the margin or more; small: shown harmless; 1: the baseline is too low to fall by the margin
    p_time: float
    harmless: bool = False  # after Holm, in success and time
    harmful: bool = False  # an interval lies completely beyond its margin


def sampled(cell, clustered):
    """Size of the sample: people, or games."""
    return len(set(cell.participants)) if clustered else cell.n


def difference(cell, baseline, clustered, margins, limit=math.inf):
    """margins: (share of success, ratio of time), e.g. (0.1, 1.1). limit: no time is longer."""
    apart = cell.draws[:, 0] - baseline.draws[:, 0]
    ratio = cell.draws[:, 1] / baseline.draws[:, 1]
    counts = int(cell.success.sum()), cell.n, int(baseline.success.sum()), baseline.n
    if clustered:
        success_interval, p_success = resampling.interval(apart), resampling.share_beyond(-apart, margins[0])
    else:
        success_interval = tuple(float(v) for v in confint_proportions_2indep(*counts, method="newcomb", compare="diff"))
        p_success = farrington_manning(*counts, margins[0])
    made = Difference(cell, cell.share - baseline.share, success_interval, cell.mean_time_s / baseline.mean_time_s, resampling.interval(ratio),
                      p_success, resampling.share_beyond(ratio, margins[1]))
    if min(sampled(cell, clustered), sampled(baseline, clustered)) < 2:  # a sample of one has no interval
        made.time_interval, made.p_time = (math.nan, math.nan), 1.0
        if clustered:
            made.success_interval, made.p_success = (math.nan, math.nan), 1.0
    if baseline.share < margins[0]:  # success cannot fall by the margin
        made.p_success = 1.0
    if baseline.mean_time_s * margins[1] > limit:
        made.p_time = 1.0
    made.harmful = made.success_interval[1] < -margins[0] or made.time_interval[0] > margins[1]
    return made


def farrington_manning(yes, n, yes_baseline, n_baseline, margin):
    """p of the hypothesis that the share is lower than the baseline's by the margin or more (one-sided).

    Their appendix: the maximum likelihood shares among those that differ by the margin solve a cubic. statsmodels 0.13 also has this test, but with shares
    that are not of maximum likelihood."""
    p, q = yes / n, yes_baseline / n_baseline
    ratio, apart = n_baseline / n, -margin
    a = 1 + ratio
    b = -(1 + ratio + p + ratio * q + apart * (ratio + 2))
    c = apart**2 + apart * (2 * p + ratio + 1) + p + ratio * q
    d = -p * apart * (1 + apart)
    v = (b / (3 * a)) ** 3 - b * c / (6 * a**2) + d / (2 * a)
    u = math.copysign(math.sqrt(max(0.0, (b / (3 * a)) ** 2 - c / (3 * a))), v)
    w = (math.pi + math.acos(min(1.0, max(-1.0, v / u**3)))) / 3 if u else math.pi / 3
    p0 = min(1 - margin, max(0.0, 2 * u * math.cos(w) - b / (3 * a)))
    q0 = p0 + margin
    variance = p0 * (1 - p0) / n + q0 * (1 - q0) / n_baseline
    return float(norm.sf((p - q + margin) / math.sqrt(variance))) if variance > 0 else 1.0


def differences(cells, clustered, margins, alpha=0.05, limit=math.inf):
    """{degraded: Difference} of all conditions except the baseline, with Holm's correction within each set of factors."""
    if () not in cells:
        raise Refusal("no game was played undegraded; play the baseline too, since every comparison needs it")
    made = {degraded: difference(cell, cells[()], clustered, margins, limit) for degraded, cell in cells.items() if degraded}
    families = {}
    for degraded, d in made.items():
        families.setdefault("removal" if all(f.removal for f, _ in degraded) else tuple(f for f, _ in degraded), []).append(d)
    for family in families.values():
        rejected = multipletests([p for d in family for p in (d.p_success, d.p_time)], alpha=alpha, method="holm")[0]
        for d, both in zip(family, rejected.reshape(-1, 2)):
            d.harmless = bool(both.all())
    return made
