"""Games at each level of degradation compared with undegraded games: success, time given success, and whether the level is harmless.

Success and time are separate outcomes: the time is that of a game that can be won, with games that were not won as censored (survival.py). The mean time
with the limit for games not won is reported as well. It contains the success, so it is no criterion: with 96 % won in 12.2 s and a limit of 30 s, it
grows by 10 % when success alone falls by 7.2 points.

Non-inferiority, one-sided (ICH E9, section 3.3.2: half of the two-sided level): for success, the score test of Farrington and Manning 1990 (Statistics in
Medicine 9:1447) and the interval of Newcombe 1998 (Statistics in Medicine 17:873, method 10), for time, Student's t of the logarithm. With enough
participants, people are the sample (people.py). A level is harmless if both outcomes are (intersection-union test, Berger 1982, Technometrics 24:295). The
levels of a factor are tested from the mildest on, up to the first that is not shown to be harmless (Maurer, Hothorn and Lehmacher 1995); conditions without
an order by Holm 1979.
"""
import dataclasses
import functools
import math

import numpy as np
from scipy.stats import norm, t as student
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.proportion import confint_proportions_2indep, proportion_confint

from tactus.analysis import answers, operators, people, resampling, survival
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
    ended_s: np.ndarray = None  # time to win, or when a game that was not won ended

    @functools.cached_property
    def times(self):
        """survival.Times of the games."""
        return survival.fit(self.ended_s, self.success == 1)

    @property
    def n(self):
        return len(self.success)

    @property
    def share(self):
        return float(self.success.mean())

    @property
    def mean_time_s(self):
        return float(self.time_s.mean())

    def share_interval(self, clustered=False):
        """(low, high) of the share of success: of people, or by Wilson 1927 of games."""
        if clustered:
            return people.Share(*counted(self, sorted(set(self.participants)))).interval()
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
    if operators.kind(factor.operator) == "loss" and not np.isnan(games["loss_achieved"]).all():
        return float(np.nanmean(games["loss_achieved"])) * (100 if factor.unit == "%" else 1)
    if operators.kind(factor.operator) == "delay" and not np.isnan(games["soa_achieved_ms"]).all():
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
        ended = np.fmin(join("completion_time_s"), limit)  # a game that was not won may have no time
        times = np.where(success == 1, ended, limit)
        # A game won after the limit counts as not won.
        success = np.where((success == 1) & (join("completion_time_s") <= limit), 1.0, 0.0)
        cell = Cell(degraded, join("participant_id"), success, times, {name: join(name) for name in EXTRAS}, ended_s=ended)
        if len(degraded) == 1 and not degraded[0][0].removal:
            cell.achieved = float(np.average([achieved_of(p, degraded) for p in parts], weights=[len(p) for p in parts]))
        means, mass = resampler.of_cell(cell.participants, np.stack([cell.success, cell.time_s], axis=1))
        means[:, 0] = resampler.share(means[:, 0], mass)
        cell.draws = means
        cells[degraded] = cell
    return cells, resampler.clustered


def shortened(cells, limit_s):
    """The cells as if the time limit had been shorter; without draws and further outcomes."""
    return {degraded: Cell(c.degraded, c.participants, np.where((c.success == 1) & (c.ended_s <= limit_s), 1.0, 0.0), np.minimum(c.time_s, limit_s), {}, c.achieved,
                           ended_s=np.minimum(c.ended_s, limit_s)) for degraded, c in cells.items()}


def counted(cell, names):
    """((people,) games won, (people,) games) of these participants."""
    at = {name: i for i, name in enumerate(names)}
    index = [at[name] for name in cell.participants]
    return np.bincount(index, weights=cell.success, minlength=len(names)), np.bincount(index, minlength=len(names)).astype(float)


def influences(cell, names):
    """(people,) shares of the participants in the error of the mean logarithm of the time to win."""
    at = {name: i for i, name in enumerate(names)}
    return np.bincount([at[name] for name in cell.participants], weights=cell.times.influence, minlength=len(names))


@dataclasses.dataclass
class Difference:
    """A condition compared with the baseline. success: share(cell) - share(baseline); time: ratio of the times of games that can be won; NaN: not
    identified. restricted: ratio of the mean times with the limit for games not won; parts_s: its change by success and by time, s."""
    cell: Cell
    success: float
    success_interval: tuple
    time: float
    time_interval: tuple
    restricted: float
    parts_s: tuple
    p_success: float  # of the hypothesis that success is worse by the margin or more; small: shown harmless; 1: the baseline is too low to fall by the margin
    p_time: float
    harmless: bool = False  # in success and time, after the earlier levels of its factor
    harmful: bool = False  # an interval lies completely beyond its margin


def sampled(cell, clustered):
    """Size of the sample: people, or games."""
    return len(set(cell.participants)) if clustered else cell.n


def compared_success(cell, baseline, clustered, level):
    """(low, high) of share(cell) - share(baseline)."""
    if clustered:
        names = sorted({*cell.participants, *baseline.participants})
        return people.difference(people.Share(*counted(cell, names)), people.Share(*counted(baseline, names)), level)
    counts = int(cell.success.sum()), cell.n, int(baseline.success.sum()), baseline.n
    return tuple(float(v) for v in confint_proportions_2indep(*counts, method="newcomb", compare="diff", alpha=1 - level))


def log_time_ratio(cell, baseline, clustered):
    """(logarithm of the ratio of the times to win, its standard error, degrees of freedom); NaN: not identified."""
    if not (cell.times.identified and baseline.times.identified):
        return math.nan, math.nan, 1
    value = cell.times.mu - baseline.times.mu
    if not clustered:
        return value, math.sqrt(cell.times.variance + baseline.times.variance), cell.times.won + baseline.times.won - 2
    names = sorted({*cell.participants, *baseline.participants})
    apart = influences(cell, names) - influences(baseline, names)
    n = len(names)
    return value, math.sqrt(n / (n - 1) * float(np.sum((apart - apart.mean()) ** 2)) + survival.SMALLEST_SD**2 / n), n - 1


def compared_time(cell, baseline, clustered, level):
    """(low, high) of the ratio of the times to win; NaN: not identified."""
    value, se, df = log_time_ratio(cell, baseline, clustered)
    half = student.ppf((1 + level) / 2, df) * se
    return math.exp(value - half), math.exp(value + half)


def difference(cell, baseline, clustered, margins, limit=math.inf):
    """margins: (share of success, ratio of time), e.g. (0.1, 1.1). limit: no time is longer."""
    value, se, df = log_time_ratio(cell, baseline, clustered)
    success, time = compared_success(cell, baseline, clustered, 0.95), compared_time(cell, baseline, clustered, 0.95)
    if clustered:
        names = sorted({*cell.participants, *baseline.participants})
        p_success = people.p_inferior(people.Share(*counted(cell, names)), people.Share(*counted(baseline, names)), margins[0])
    else:
        p_success = farrington_manning(int(cell.success.sum()), cell.n, int(baseline.success.sum()), baseline.n, margins[0])
    p_time = float(student.sf((math.log(margins[1]) - value) / se, df)) if se == se else 1.0
    made = Difference(cell, cell.share - baseline.share, success, math.exp(value), time, cell.mean_time_s / baseline.mean_time_s, parts(cell, baseline, limit), p_success, p_time)
    if min(sampled(cell, clustered), sampled(baseline, clustered)) < 2:  # a sample of one has no interval
        made.time_interval, made.p_time = (math.nan, math.nan), 1.0
        if clustered:
            made.success_interval, made.p_success = (math.nan, math.nan), 1.0
    if baseline.share < margins[0]:  # success cannot fall by the margin
        made.p_success = 1.0
    if not baseline.times.identified or math.exp(baseline.times.mu) * margins[1] > limit:
        made.p_time = 1.0
    made.harmful = made.success_interval[1] < -margins[0] or made.time_interval[0] > margins[1]
    return made


def parts(cell, baseline, limit):
    """Change of the restricted mean time, s, by success and by the time of won games; NaN without a limit or without won games."""
    if not math.isfinite(limit) or not (cell.success.any() and baseline.success.any()):
        return math.nan, math.nan
    mean = lambda c: float(c.time_s[c.success == 1].mean())
    return survival.decomposition(cell.share, mean(cell), baseline.share, mean(baseline), limit)


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


ALPHA = 0.025  # one-sided; ICH E9, section 5.5


def differences(cells, clustered, margins, alpha=ALPHA, limit=math.inf):
    """{degraded: Difference} of all conditions except the baseline, corrected within each set of factors for the number of tests."""
    if () not in cells:
        raise Refusal("no game was played undegraded; play the baseline too, since every comparison needs it")
    made = {degraded: difference(cell, cells[()], clustered, margins, limit) for degraded, cell in cells.items() if degraded}
    families = {}
    for degraded, d in made.items():
        families.setdefault("removal" if all(f.removal for f, _ in degraded) else tuple(f for f, _ in degraded), []).append(d)
    for factors, family in families.items():
        p = [max(d.p_success, d.p_time) for d in family]
        if factors != "removal" and len(factors) == 1:
            shown = in_order(p, np.argsort([factors[0].severity(d.cell.achieved) for d in family], kind="stable"), alpha)
        else:
            shown = multipletests(p, alpha=alpha, method="holm")[0]
        for d, one in zip(family, shown):
            d.harmless = bool(one)
    return made


def in_order(p, order, alpha):
    """Whether each hypothesis is rejected, tested in this order up to the first that is not (Maurer, Hothorn and Lehmacher 1995)."""
    shown = np.zeros(len(p), dtype=bool)
    for i in order:
        if p[i] > alpha:
            break
        shown[i] = True
    return shown
