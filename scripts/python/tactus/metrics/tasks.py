"""Ranks the metrics of a degraded rendering by how well they predict success in a task that was left out: leave one task out of the shipped tasks.

The answers are those of a naive player of typical noise in the battery (tactus study battery), under delays, jitters, losses and rates of each sense that a task is for. A curve that
never rises gives the success, relative to chance and to the undegraded success of its task, from a metric; it is fitted to all other tasks and predicts the one that was left out. The
metrics of a condition come from a test signal that passes its operator (ranking.py).

--keep DIR keeps the renderings, and takes those of a battery. --write stores the ranking in ranking_by_task.json.
"""
import argparse
import json
import os
import pathlib
import sys
import tempfile

from tactus import terminal
from tactus.battery import answers, perceivers, renderings
from tactus.battery import conditions as degradations
from tactus.information import rendering, task_file
from tactus.metrics import ranking
from tactus.option_parser import OptionParser
from tactus.refusal import Refusal

STORED = pathlib.Path(__file__).with_name("ranking_by_task.json")


def conditions_of(parts, draws, seed):
    """The conditions of a task (answers.Parts), for ranking.rank_by_task."""
    task = parts.stored.task
    success = lambda degraded: answers.Question(parts, degraded, answers.NAIVE).success(perceivers.TYPICAL, draws, seed)
    same = {"task": task.name, "games": draws, "chance": 1 / len(task.values), "undegraded": success({})}
    return [{**same, "modality": sense, "operator": operator, "level": level, "success": success({sense: degradations.Condition(operator, level)}),
             "metrics": ranking.of_condition(sense, operator, level)}
            for sense in task.senses for operator, levels in degradations.curves(sense).items() if operator in ranking.OPERATORS for level in levels]


def show(conditions, ranked):
    print(f"{'task':30} {'sense':8} {'operator':8} {'level':>6} {'right':>6} {'undegraded':>10}")
    for c in conditions:
        terminal.show(f"{c['task']:30} {c['modality']:8} {c['operator']:8} {c['level']:6g} {c['success']:6.2f} {c['undegraded']:10.2f}")
    print(f"\n{'metric':22} {'loss, bits':>10} {'skill':>8} {'explained':>9}  loss of each task that is left out")
    for row in ranked:
        terminal.show(f"{row['metric']:22} {row['loss_bits']:10.3f} {row['skill']:8.3f} {row['explained']:9.3f}  " + ", ".join(f"{name} {loss:.2f}" for name, loss in row["groups"].items()))


def main(words):
    parser = OptionParser(prog="tactus --module tactus.metrics.tasks", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tasks", nargs="*", metavar="TASK", help="tasks (default: all shipped ones)")
    parser.add_argument("--draws", type=int, default=4000, metavar="N", help="answers for each condition (default: 4000)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the answers (default: 1)")
    parser.add_argument("--keep", metavar="DIR", help="folder of renderings, as of tactus study battery")
    parser.add_argument("--write", action="store_true", help="store the ranking in scripts/python/tactus/metrics/ranking_by_task.json")
    options = parser.parse_args(words)
    if options.draws < 10 or options.seed < 0:
        parser.error("give --draws of 10 or more and --seed of 0 or more")
    names = options.tasks or task_file.shipped()
    if len(names) < 3:
        sys.exit("tasks: a task is predicted from the others; give three tasks or more")
    conditions = []
    with tempfile.TemporaryDirectory() as scratch:
        try:
            rendering.require_programs()
            tasks = [task_file.read(name) for name in names]
            renderings.render_all(tasks, options.keep or scratch, len(os.sched_getaffinity(0)))
            for task in tasks:
                conditions += conditions_of(answers.Parts(renderings.Stored(task, options.keep or scratch)), options.draws, options.seed)
        except Refusal as refused:
            sys.exit(f"tasks: {refused}")
    ranked = ranking.rank_by_task(conditions)
    show(conditions, ranked)
    if options.write:
        plain = [{k: round(v, 4) if isinstance(v, float) else v for k, v in c.items() if k != "metrics"} for c in conditions]
        STORED.write_text(json.dumps({"command": " ".join(["tactus --module tactus.metrics.tasks --write", *options.tasks]), "ranking": ranked, "conditions": plain}, indent=1) + "\n", encoding="utf-8")
    return 0
