"""Which property of a simulated player goes with its success under degradation: tactus --module tactus.analysis.sensitivity GAMES.csv

For each degraded sense and stage of touch, and for undegraded games, the share of games that a player wins over all levels is compared with its properties
(bin/observer_players players) by Spearman's rank correlation. Its square is the share of the variance of ranks that the property explains. Few games of a player make
both smaller, and correlated properties share them. A property that already decides undegraded games is one of skill. p values are those of all properties and
groups together (Benjamini and Hochberg 1995); rows are shown for a small p only, so that their correlations are on average too large. Intervals are of players
drawn again.
"""
import argparse
import sys

import numpy as np
from scipy import stats
from statsmodels.stats.multitest import multipletests

from tactus import players, terminal
from tactus.analysis import operators
from tactus.option_parser import OptionParser
from tactus.refusal import Refusal
from tactus.sweep import adopted

RESAMPLES = 1999
UNDEGRADED = "undegraded"
FEWEST = 20    # players; design: below, a rank correlation of 0.44 is chance
SHOWN_P = 0.05


def group_of(row):
    """The name of the group of a condition: the degraded sense and stage, or undegraded; "" for a removed sense, or two degraded senses."""
    if not row["modality_degraded"]:
        return UNDEGRADED
    return "" if row["second_modality"] or operators.kind(row["operator"]) in operators.REMOVALS else row["modality_degraded"]


def shares(rows):
    """(population, [numbers], {group: (players,) shares of games that were won}) of the rows of games of one population, of players that played all games.
    Raises Refusal."""
    won = {}
    for row in rows:
        if row["missed"] or not (group := group_of(row)):
            continue
        number, population = player_of(row["player"])
        won.setdefault((population, number), {}).setdefault(group, []).append(row["success"])
    if len({population for population, _ in won}) > 1:
        raise Refusal("the games are of players of several populations; give those of one")
    groups = sorted({group for of_player in won.values() for group in of_player})
    most = {group: max(len(of_player.get(group, [])) for of_player in won.values()) for group in groups}
    complete = sorted(player for player, of_player in won.items() if all(len(of_player.get(group, [])) == most[group] for group in groups))
    if len(complete) < FEWEST:
        raise Refusal(f"{len(complete)} players played all games, but a rank correlation needs {FEWEST}; play games of more players")
    mean = {group: np.array([np.mean(won[player][group]) for player in complete]) for group in groups}
    degraded = [group for group in groups if group != UNDEGRADED]
    if degraded:
        mean["all degraded"] = np.mean([mean[group] for group in degraded], axis=0)
    return complete[0][0], [number for _, number in complete], mean


def player_of(words):
    """(number, population) of a player of a trial table, "observer:3 of population 1, ...". Raises Refusal."""
    name, _, rest = words.partition(" of population ")
    try:
        return int(name.removeprefix("observer:")), int(rest.partition(",")[0])
    except ValueError:
        raise Refusal(f"{words[:40] or 'a player'}: is no player of a population; give games of --player observer:NUMBERS") from None


def table(values, outcomes, seed=1):
    """Rows {group, property, correlation, low, high, share, p}, the largest share of each group first."""
    rng, rows = np.random.default_rng(seed), []
    draws = rng.integers(0, len(next(iter(values.values()))), (RESAMPLES, len(next(iter(values.values())))))
    for group, outcome in outcomes.items():
        mine = []
        for name, value in values.items():
            rho, p = stats.spearmanr(value, outcome) if np.ptp(outcome) > 0 and np.ptp(value) > 0 else (0.0, 1.0)
            mine.append({"group": group, "property": name, "correlation": float(rho), "share": float(rho**2), "p": float(p)})
        rows += sorted(mine, key=lambda row: -row["share"])
    for row, adjusted in zip(rows, multipletests([row["p"] for row in rows], method="fdr_bh")[1]):
        row["p"] = float(adjusted)
        if adjusted < SHOWN_P:
            x, y = stats.rankdata(values[row["property"]])[draws], stats.rankdata(outcomes[row["group"]])[draws]
            x, y = x - x.mean(1, keepdims=True), y - y.mean(1, keepdims=True)
            size = np.sqrt((x**2).sum(1) * (y**2).sum(1))
            drawn = (x * y).sum(1)[size > 0] / size[size > 0]  # players drawn again may all be alike
            row["low"], row["high"] = map(float, np.quantile(drawn, [0.025, 0.975]))
    return rows


def show(rows, count):
    terminal.show(f"{count} players; properties whose adjusted p is below {SHOWN_P:g}")
    terminal.show(f"{'games under':24} {'property':36} {'correlation':>24} {'share':>6} {'p':>8}")
    for group in dict.fromkeys(row["group"] for row in rows):
        mine = [row for row in rows if row["group"] == group and row["p"] < SHOWN_P]
        for row in mine:
            interval = f"{row['correlation']:.2f} [{row['low']:.2f}, {row['high']:.2f}]"
            terminal.show(f"{group:24} {row['property']:36} {interval:>24} {row['share']:6.2f} {row['p']:8.2g}")
        if not mine:
            terminal.show(f"{group:24} none")


def main(words):
    parser = OptionParser(prog="tactus --module tactus.analysis.sensitivity", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("games", metavar="GAMES", help="games.csv, or .csv.xz, of a sweep with players of a population")
    options = parser.parse_args(words)
    try:
        population, numbers, outcomes = shares(adopted.read(options.games).values())
        properties = {name: np.array(values) for name, values in players.properties(population, numbers).items()}
        show(table(properties, outcomes), len(numbers))
    except Refusal as refused:
        sys.exit(f"sensitivity: {refused}")
    return 0
