"""Ranks the metrics of a degraded rendering by how well they predict success in a task that was left out: leave one task out of the shipped tasks.

Each value of the hidden variable of a task (sim_node/scenes/tasks) is simulated once, and each sense that the task is for is rendered again from the log
under delays, jitters, losses and rates. The answers are those of the ideal observer of tactus study information, which expects undegraded percepts: a person
who has not adapted. A curve that never rises gives the success, relative to chance and to the undegraded success of its task, from a metric; it is fitted to all
other tasks and predicts the one that was left out. The metrics of a condition come from a test signal that passes its operator (ranking.py).

--keep FILE keeps finished renderings, so that a stopped run continues. --write stores the ranking in ranking_by_task.json.
"""
import argparse
import json
import os
import pathlib
import sys
import tempfile

import numpy as np

from tactus import terminal
from tactus.information import degraded, noise, percepts, pictures, rendering, task_file
from tactus.information.estimate import Observer, Percept
from tactus.metrics import ranking
from tactus.option_parser import OptionParser
from tactus.refusal import Refusal
from tactus.study import quantities

STORED = pathlib.Path(__file__).with_name("ranking_by_task.json")
# Levels of each operator: ms, ms (standard deviation), %, Hz. Design: a mild and a strong one, between which players fail (docs/how_far/stage_model.md).
LEVELS = {"delay": (100.0, 400.0), "jitter": (60.0,), "loss": (30.0, 70.0), "rate": (10.0, 2.0)}
UNDEGRADED = ("", 0.0)
CONDITIONS = [UNDEGRADED, *((operator, level) for operator, levels in LEVELS.items() for level in levels)]


def evenly(items, most):
    """At most `most` of a list, evenly spread, with both ends."""
    items = list(items)
    return items if len(items) <= most else [items[i] for i in np.unique(np.linspace(0, len(items) - 1, most).round().astype(int))]


def chosen(task, options):
    """[(number, changes)] of the renderings that count, by value and then by variant."""
    values = evenly(range(len(task.values)), options.values)
    return [(number, changes) for number, (value, variant, changes) in enumerate(percepts.renderings(task)) if value in values and variant < options.variants]


def shape(task, options):
    """(values, variants) of the renderings that count."""
    return min(options.values, len(task.values)), min(options.variants, len(task.variants))


def key_of(task, number, sense, condition):
    return "|".join((task.name, str(number), sense, condition[0], f"{condition[1]:g}"))


def element(sense, condition):
    """Element of a profile; "": undegraded."""
    return "" if condition == UNDEGRADED else quantities.degrade(sense, *condition)


def fill(task, options, store, save):
    """Fills store[key_of(...)] with the features of the renderings of a task. Raises Refusal."""
    mine = chosen(task, options)
    for done, (number, changes) in enumerate(mine):
        wanted = [(sense, condition) for sense in task.senses for condition in CONDITIONS if key_of(task, number, sense, condition) not in store]
        if not wanted:
            continue
        with tempfile.TemporaryDirectory() as scratch:
            place = pathlib.Path(scratch) / "run"
            rendering.simulate(task_file.changed_scene(task.scene, changes), task.scene.parent, place, task.seconds)
            offset_ns = degraded.host_offset_ns(place / "run.lcmlog", scratch)
            for sense, condition in wanted:
                store[key_of(task, number, sense, condition)] = degraded.rendered(task, sense, place / "run.lcmlog", element(sense, condition), number + 1, offset_ns)
        save()
        terminal.report_error(f"tasks: {task.name}, {done + 1} of {len(mine)}")


def percepts_of(task, options, store, sense, condition):
    """[Percept] of a sense under a condition."""
    rows = [store[key_of(task, number, sense, condition)] for number, _ in chosen(task, options)]
    table = lambda values: np.array(values, dtype=float).reshape(*shape(task, options), -1)
    return [Percept(sense, table([row[i][0] for row in rows]), table([row[i][1] for row in rows]), rows[0][i][2]) for i in range(len(rows[0]))]


def seen(task, options, store, *conditions):
    """The percepts of the pictures under each condition, in common coordinates, whose distances are the d' between the pictures. Looks count as far as all
    renderings have them: a degraded one may have fewer."""
    rows = [store[key_of(task, number, "visual", condition)][0][0] for condition in conditions for number, _ in chosen(task, options)]
    length = min(map(len, rows))
    found = pictures.coordinates([np.array(row[:length]) for row in rows], degraded.SIZE[0]) * degraded.SKIPPED
    return [Percept("visual", part.reshape(*shape(task, options), -1), np.ones((*shape(task, options), found.shape[1]))) for part in np.split(found, len(conditions))]


def success(task, options, store, sense="", condition=UNDEGRADED):
    """Share of right answers of the observer when one sense is degraded."""
    pairs = []
    for s in task.senses:
        now = condition if s == sense else UNDEGRADED
        pairs += [seen(task, options, store, UNDEGRADED, now)] if s == "visual" else zip(percepts_of(task, options, store, s, UNDEGRADED), percepts_of(task, options, store, s, now))
    observer = Observer([p for p, _ in pairs], options.draws, options.seed, noise.values()["lapse"], presented=[p for _, p in pairs])
    return observer.result(observer.senses)["success"]


def conditions_of(tasks, options, store):
    """The conditions of all tasks, for ranking.rank_by_task."""
    found = []
    for task in tasks:
        same = {"task": task.name, "games": options.draws, "chance": 1 / shape(task, options)[0], "undegraded": success(task, options, store)}
        found += [{**same, "modality": sense, "operator": operator, "level": level, "success": success(task, options, store, sense, (operator, level)),
                   "metrics": ranking.of_condition(sense, operator, level)} for sense in task.senses for operator, level in CONDITIONS[1:]]
    return found


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
    parser.add_argument("--values", type=int, default=4, metavar="N", help="values of the hidden variable of each task, at most (default: 4)")
    parser.add_argument("--variants", type=int, default=1, metavar="N", help="variants of each value, at most (default: 1)")
    parser.add_argument("--draws", type=int, default=4000, metavar="N", help="answers for each condition (default: 4000)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the answers (default: 1)")
    parser.add_argument("--keep", metavar="FILE", help="file of finished renderings, which is continued")
    parser.add_argument("--write", action="store_true", help="store the ranking in scripts/python/tactus/metrics/ranking_by_task.json")
    options = parser.parse_args(words)
    if options.values < 2 or options.variants < 1 or options.draws < 10:
        parser.error("give --values of 2 or more, --variants of 1 or more and --draws of 10 or more")
    store = json.loads(pathlib.Path(options.keep).read_text(encoding="utf-8")) if options.keep and os.path.exists(options.keep) else {}
    try:
        rendering.require_programs()
        tasks = [task_file.read(name) for name in options.tasks or task_file.shipped()]
        for task in tasks:
            fill(task, options, store, lambda: pathlib.Path(options.keep).write_text(json.dumps(store), encoding="utf-8") if options.keep else None)
    except Refusal as refused:
        sys.exit(f"tasks: {refused}")
    conditions = conditions_of(tasks, options, store)
    if len(tasks) < 3:
        sys.exit("tasks: a task is predicted from the others; give three tasks or more")
    ranked = ranking.rank_by_task(conditions)
    show(conditions, ranked)
    if options.write:
        command = " ".join(["tactus --module tactus.metrics.tasks --write", *options.tasks, f"--values {options.values} --variants {options.variants}"])
        plain = [{k: round(v, 4) if isinstance(v, float) else v for k, v in c.items() if k != "metrics"} for c in conditions]
        STORED.write_text(json.dumps({"command": command, "ranking": ranked, "conditions": plain}, indent=1) + "\n", encoding="utf-8")
    return 0
