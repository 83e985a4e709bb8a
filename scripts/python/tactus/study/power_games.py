"""Power of a study of games, by simulation of assumed games or of those of a pilot: the smallest loss of success and the smallest slowing that are found
with 80 % power, and how often a level without effect is shown to be harmless.

The tests approximate those of tactus/analysis, whose fits are too slow here. Times are those of won games, as the analysis separates them from success.
Five or more participants: paired t-tests over people. Fewer: over games, Newcombe's interval of a difference of shares, and the normal interval of a
difference of mean logarithms of times.
"""
import collections
import dataclasses
import math

import numpy as np
from scipy.stats import norm, t

from tactus.study import quantities

FEWEST_PEOPLE = 5  # as in tactus/analysis: with fewer, the games are the sample
FEWEST_DRAWS, MAX_DRAWN = 100, 200_000  # studies, and games of each condition, in a step of the search for participants: 1 to 4 points of power; design
MAX_PEOPLE = 500  # design
STEPS = 12         # of a bisection; design
SIMULATIONS = 10   # factor on the number of simulated observers, since a game costs less; design


@dataclasses.dataclass(frozen=True)
class Games:
    """Games without degradation. success: share won. time_s: median time to win, None: half the limit. spread, between: standard deviations of the logarithm
    of times within and between people; success_between: standard deviation of the logits of success between people. source: origin of these values."""
    success: float = 0.95
    time_s: float = None
    spread: float = 0.35
    between: float = 0.25
    success_between: float = 0.5
    source: str = "assumed (design); give --pilot to use measured games"


def pilot(rows, path):
    """Games of rows of a trial table (trial_table.read). Raises ValueError if they are too few."""
    games = [r for r in rows if r["task"] == "game" and r.get("success") is not None and not r.get("missed") and not r.get("modality_degraded")]
    won = [r for r in games if r["success"] and r.get("completion_time_s")]
    if len(games) < 10 or len(won) < 5:
        raise ValueError(f"{path}: holds {len(games)} games with nothing degraded, {len(won)} of them won; 10 with 5 won are needed")
    logs = {}
    for r in won:
        logs.setdefault(r["participant_id"], []).append(math.log(r["completion_time_s"]))
    means = [np.mean(v) for v in logs.values()]
    within = np.concatenate([np.asarray(v) - np.mean(v) for v in logs.values()])
    spread = math.sqrt((within ** 2).sum() / max(1, len(within) - len(logs)))
    between = float(np.std(means, ddof=1)) if len(means) > 1 else Games.between
    success = min(len(won) / len(games), 1 - 0.5 / len(games))  # if all are won: half a game counts as lost
    return Games(success, math.exp(np.mean(means)), spread, between, Games.success_between, f"{len(games)} games of {len(logs)} participants in {path}")


def drawn(games, limit_s, people, each, loss, slower, dice, count):
    """Random games: (won, time_s), each (count, 2, people, each). Index 0 of the second axis: undegraded; 1: success reduced by `loss`, times multiplied by
    `slower`."""
    odds = math.log(games.success / (1 - games.success)) + games.success_between * dice.standard_normal((count, 1, people, 1))
    p = 1 / (1 + np.exp(-odds))
    p = np.concatenate([p, np.clip(p - loss, 0, 1)], axis=1)
    time = math.log(games.time_s or limit_s / 2) + games.between * dice.standard_normal((count, 1, people, 1)) + games.spread * dice.standard_normal((count, 2, people, each))
    time = np.exp(time + np.array([0, math.log(slower)])[None, :, None, None])
    won = (dice.random((count, 2, people, each)) < p) & (time <= limit_s)
    return won, np.where(won, time, limit_s)


@np.errstate(divide="ignore", invalid="ignore")
def interval(won, time_s, alpha):
    """((low, high) of the difference of success, (low, high) of the logarithm of the ratio of the times of won games), each (count,); NaN without won games."""
    count, _, people, each = won.shape
    logs = np.where(won, np.log(time_s), 0.0)
    if people >= FEWEST_PEOPLE:
        share, mean = won.mean(axis=3), logs.sum(axis=3) / won.sum(axis=3)
        return tuple(paired(x[:, 1] - x[:, 0], alpha) for x in (share, mean))
    n = people * each
    p = won.reshape(count, 2, n).mean(axis=2)
    low, high = wilson(p, n, alpha)
    apart = p[:, 1] - p[:, 0]  # Newcombe 1998, Statistics in Medicine 17:873, method 10
    shares = (apart - np.hypot(p[:, 1] - low[:, 1], high[:, 0] - p[:, 0]), apart + np.hypot(high[:, 1] - p[:, 1], p[:, 0] - low[:, 0]))
    kept, flat = won.reshape(count, 2, n), logs.reshape(count, 2, n)
    wins = kept.sum(axis=2)
    mean = flat.sum(axis=2) / wins
    variance = (np.where(kept, flat - mean[:, :, None], 0.0) ** 2).sum(axis=2) / (wins - 1) / wins
    half = norm.ppf(1 - alpha / 2) * np.sqrt(variance.sum(axis=1))
    ratio = mean[:, 1] - mean[:, 0]
    return shares, (ratio - half, ratio + half)


def paired(differences, alpha):
    people = differences.shape[1]
    half = t.ppf(1 - alpha / 2, people - 1) * differences.std(axis=1, ddof=1) / math.sqrt(people)
    return differences.mean(axis=1) - half, differences.mean(axis=1) + half


def wilson(p, n, alpha):
    z = norm.ppf(1 - alpha / 2)
    middle, half = p + z * z / (2 * n), z * np.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return (middle - half) / (1 + z * z / n), (middle + half) / (1 + z * z / n)


def smallest(finds, lowest, highest, wanted):
    """The smallest effect at which finds(effect), a share, reaches `wanted`, by bisection; None: the highest effect does not reach it."""
    if finds(highest) < wanted:
        return None
    for _ in range(STEPS):
        middle = (lowest + highest) / 2
        lowest, highest = (lowest, middle) if finds(middle) >= wanted else (middle, highest)
    return highest


def family_of(condition):
    """Family of a condition; conditions of one family are tested together (tactus/analysis): removals, or those with the same senses and operators. None:
    nothing is degraded."""
    if condition.kind == "remove":
        return "removal"
    levels = condition.fixed if condition.kind == "pair" else (condition.fixed,)
    if condition.kind == "asynchrony":
        return condition.senses if condition.fixed else None
    return tuple(f for f, level in zip(condition.factors, levels) if not quantities.nothing(f.operator, level)) or None


def of(study, assumed, wanted, alpha):
    """{baseline: whether some games are undegraded, tests: number of tests of the largest family without an order (levels of one factor are tested in their
    order, each without correction), rows: [{participants, games, loss, slower, harmless}],
    needed}. loss, slower: the smallest detected loss of success and ratio of times, None: none; harmless: share of levels without effect that are shown to
    be within the margins of the study; needed: the smallest number of participants at which that share is `wanted`, None: more than MAX_PEOPLE."""
    each, limit_s, games = study.procedure["repetitions"], study.stimulus.limit_s, assumed.games
    families = collections.Counter(map(family_of, study.conditions))
    baseline, tests = bool(families.pop(None, 0)), max((n for family, n in families.items() if family == "removal" or len(family) > 1), default=1)
    count = assumed.simulations * SIMULATIONS

    def ends(people, loss, slower, level, many):
        return interval(*drawn(games, limit_s, people, each, loss, slower, np.random.default_rng([assumed.seed, people]), many), level)

    def harmless(people, many=count):
        shares, ratios = ends(people, 0.0, 1.0, alpha / tests, many)  # each side alpha / 2: one-sided 2.5 %; Bonferroni
        return float(np.mean((shares[0] > -study.margin["success"]) & (ratios[1] < math.log(1 + study.margin["time"]))))

    rows = []
    with np.errstate(divide="ignore", invalid="ignore"):
        for people in assumed.participants:
            row = {"participants": people, "games": each, "loss": None, "slower": None, "harmless": 0.0}
            if people * each > 1:  # one game has no spread
                row["loss"] = smallest(lambda x: np.mean(ends(people, x, 1.0, alpha, count)[0][1] < 0), 0.0, games.success, wanted)
                slower = smallest(lambda x: shows_slowing(*ends(people, 0.0, math.exp(x), alpha, count)), 0.0, math.log(1 + limit_s / (games.time_s or limit_s / 2)), wanted)
                row["slower"] = None if slower is None else math.exp(slower)
                row["harmless"] = harmless(people)
            rows.append(row)
        needed = fewest(lambda people: harmless(people, min(count, max(FEWEST_DRAWS, MAX_DRAWN // (people * each)))), wanted)
    return {"baseline": baseline, "tests": tests, "rows": rows, "needed": needed}


def shows_slowing(shares, ratios):
    """Share of studies in which the times of won games are longer, or, since strong slowing leaves few of them, in which fewer games are won."""
    return float(np.mean((ratios[0] > 0) | (shares[1] < 0)))


def fewest(shows, wanted):
    """The smallest number of participants, to 10 %, at which shows(participants) reaches `wanted`; None: more than MAX_PEOPLE."""
    people = FEWEST_PEOPLE
    while shows(people) < wanted:
        people = max(people + 1, round(1.1 * people))
        if people > MAX_PEOPLE:
            return None
    return people


def words(found, assumed, wanted):
    g = assumed.games
    lines = [f"effects that are found with {wanted:.0%} power between undegraded games and a level, and how often a level without effect is shown to be within the margins:",
             "  participants  games of each  loss of success  slower by  shown harmless"]
    for f in found["rows"]:
        loss = "none" if f["loss"] is None else f"{100 * f['loss']:.0f} points"
        slower = "none" if f["slower"] is None else f"{100 * (f['slower'] - 1):.0f} %"
        lines.append(f"  {f['participants']:12d}  {f['games']:13d}  {loss:>15s}  {slower:>9s}  {f['harmless']:14.0%}")
    time = "half the limit" if g.time_s is None else f"{g.time_s:.3g} s"
    lines.append(f"  shown harmless with {wanted:.0%} power: " + (f"from about {found['needed']} participants on" if found["needed"] else f"not with {MAX_PEOPLE} participants"))
    lines.append(f"  games undegraded: {g.success:.0%} won, after {time} (median), spread {g.spread:.2g} within and {g.between:.2g} between people (sd of log time); {g.source}")
    lines.append("  shown harmless needs both outcomes within their margins, one-sided 2.5 %"
                 + (f", with Bonferroni's correction over {found['tests']} conditions; Holm's correction in the analysis shows it at least as often" if found["tests"] > 1 else "; levels are tested from the mildest on"))
    if not found["baseline"]:
        lines.append("no condition is undegraded, so the others have no baseline; add <nothing/>")
    return lines
