"""Ranks the metrics of a degraded rendering by how well they predict success in the games of a study, out of sample.

Each operator of each modality is left out in turn: a curve of success against the metric that never rises is fitted to the other operators of the
modality, and predicts the games of the one that was left out. The loss is the mean of all, in bits per game; skill is 1 - loss / loss of the mean success
of the other operators. A table of games of one task permits no other division. The metrics of a condition come from a test signal that passes its
operator (scripts/python/tactus/metrics/ranking.py). --write stores the ranking that tactus report uses.
"""
import argparse
import json
import os
import pathlib
import sys

from tactus import terminal
from tactus.metrics import ranking
from tactus.option_parser import OptionParser
from tactus.refusal import Refusal, sentence_of
from tactus.sweep import adopted

ROOT = pathlib.Path(__file__).resolve().parents[4]


def main(words):
    try:
        return rank(words)
    except Refusal as refusal:
        sys.exit(f"rank: {refusal}")
    except OSError as error:
        sys.exit(f"rank: {sentence_of(error)}")


def rank(words):
    parser = OptionParser(prog="tactus --module tactus.metrics.rank", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("games", nargs="?", default=str(ROOT / "docs" / "how_far" / "games.csv.xz"), help="table of games (default: docs/how_far/games.csv.xz)")
    parser.add_argument("--write", action="store_true", help="store the ranking in scripts/python/tactus/metrics/ranking.json")
    parser.add_argument("--json", metavar="FILE", help="also write the ranking and the metrics of the conditions to FILE")
    options = parser.parse_args(words)
    if not os.path.isfile(options.games):
        sys.exit(f"rank: {options.games} is not a file; give a table of games, games.csv or games.csv.xz")
    conditions = ranking.conditions_of(adopted.read(options.games).values())
    ranked = ranking.rank(conditions)
    games = sum(c["games"] for c in conditions if c["operator"])
    print(f"{games} games under {len(conditions)} conditions\n\n{'metric':22} {'loss, bits':>10} {'skill':>8}  loss of each operator that is left out")
    for row in ranked:
        terminal.show(f"{row['metric']:22} {row['loss_bits']:10.3f} {row['skill']:8.3f}  " + ", ".join(f"{name} {loss:.2f}" for name, loss in row["groups"].items()))
    result = {"command": "tactus --module tactus.metrics.rank --write", "data": os.path.relpath(os.path.abspath(options.games), ROOT), "games": games, "ranking": ranked}
    if options.write:
        ranking.STORED.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps({**result, "conditions": conditions}, indent=1) + "\n", encoding="utf-8")
    return 0
