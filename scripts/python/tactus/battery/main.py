"""tactus study battery: how far each sense can degrade in each shipped task before a population of players answers worse."""
import argparse
import concurrent.futures
import functools
import os
import pathlib
import signal
import tempfile

from tactus import ending, players, signals, terminal
from tactus.battery import answers, conditions, curves, figure, perceivers, renderings, results
from tactus.information import rendering, task_file
from tactus.option_parser import OptionParser
from tactus.refusal import Refusal
from tactus.sweep import verdicts

USAGE = """Renders each task under every operator and level of the senses that it is for, and asks a population of simulated players. For each operator, prints the level at which a player
answers 10 percentage points worse: the median over the players with its 95 % interval, and the 10 % and 90 % quantiles; for naive players, who expect undegraded percepts, and for
adapted ones. `detected` is the level that the same players notice in 75 % of pairs. Both are only for operators without draws. The players have the noise of the population; the hand follows the path of the scene, so action is
not part of the answer."""
FEWEST_PLAYERS = 20  # of a distribution; design


def parsed(words):
    p = OptionParser(prog="tactus study battery", description=USAGE, allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("tasks", nargs="*", metavar="TASK", help="a task file, or the name of a shipped task; default: all shipped tasks")
    p.add_argument("--players", type=int, default=91, metavar="N", help="players of the population; default: 91")
    p.add_argument("--verdicts", metavar="TABLE", help="table of `observer_players admit`: only players that pass all checks are asked; default: no checks")
    p.add_argument("--draws", type=int, default=1200, metavar="N", help="answers of a player at a level; default: 1200")
    p.add_argument("--seed", type=int, default=1, metavar="N", help="seed of the draws; default: 1")
    p.add_argument("--jobs", type=int, metavar="J", help="processes; default: one for each core")
    p.add_argument("--keep", metavar="DIR", help="keep the renderings in DIR for further commands; remove DIR after a change of programs or of files that a scene names")
    p.add_argument("--out", metavar="DIR", help="write limits.csv, players.csv, curves.csv, pairs.csv and a figure of each operator into DIR")
    a = p.parse_args(words)
    for name, value, least, most in (("--players", a.players, FEWEST_PLAYERS, players.MOST), ("--draws", a.draws, 30, 1_000_000), ("--seed", a.seed, 0, 2**53), ("--jobs", a.jobs, 1, 1024)):
        if value is not None and not least <= value <= most:
            raise Refusal(f"{name} {value}: is out of range; give {least} to {most}")
    for option, folder in (("--keep", a.keep), ("--out", a.out)):  # before half an hour of renderings
        if folder and os.path.exists(folder) and not (os.path.isdir(folder) and os.access(folder, os.W_OK)):
            raise Refusal(f"{option} {folder}: is not a folder that you can write to; give another one")
    a.jobs = a.jobs or len(os.sched_getaffinity(0))
    return a


def asked(count, table):
    """Numbers of the players of population 1. Raises Refusal."""
    if not table:
        return list(range(count))
    known = verdicts.read(table)
    numbers = [number for (population, number), failed in sorted(known.items()) if population == 1 and not failed][:count]
    if len(numbers) < count:
        raise Refusal(f"{table}: {len(numbers)} players of population 1 pass all checks, but --players is {count}; give --players {len(numbers)}, or check more players")
    verdicts.verified(table, [players.Player(f"observer:{number}") for _, number in sorted(known)])
    return numbers


@functools.lru_cache(maxsize=1)
def parts_of(task, folder):
    """The features of a task, once in each process."""
    return answers.Parts(renderings.Stored(task_file.read(task), folder))


def curve(task, folder, sense, operator, people, draws, seed):
    """A curves.Curve, in a process of its own."""
    return curves.measure(parts_of(task, folder), sense, operator, people, draws, seed)


def pair(task, folder, first, second, people, draws, seed):
    return curves.frontier(parts_of(task, folder), (first, second), people, draws, seed)


def play(tasks, folder, people, a):
    """([Curve], [(task, first, second, right answers)]) of all tasks, senses and operators. Raises Refusal."""
    with concurrent.futures.ProcessPoolExecutor(a.jobs) as pool:
        wanted = [(name, sense, operator) for name, task in tasks for sense in task.senses for operator in conditions.curves(sense)]
        running = [pool.submit(curve, name, folder, sense, operator, people, a.draws, a.seed) for name, sense, operator in wanted]
        crossed = [(name, *both) for name, task in tasks if len(task.senses) == 2 for both in conditions.pairs(*task.senses)]
        surfaces = [pool.submit(pair, name, folder, first, second, people, a.draws, a.seed) for name, first, second in crossed]
        try:
            for done, _ in enumerate(concurrent.futures.as_completed(running + surfaces), 1):
                if done % 10 == 0 or done == len(running + surfaces):
                    terminal.report_error(f"study battery: {done} of {len(running + surfaces)} operators are played")
            return [one.result() for one in running], [(*which, one.result()) for which, one in zip(crossed, surfaces)]
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def run(a):
    rendering.require_programs()
    numbers = asked(a.players, a.verdicts)
    properties = {name.rpartition(" [")[0]: values for name, values in players.properties(1, numbers).items()}
    people = [perceivers.of_properties({name: float(values[i]) for name, values in properties.items()}) for i in range(len(numbers))]
    tasks = [(name, task_file.read(name)) for name in a.tasks or task_file.shipped()]
    with tempfile.TemporaryDirectory() as scratch:
        folder = str(pathlib.Path(a.keep or scratch).absolute())
        renderings.render_all([task for _, task in tasks], folder, a.jobs)
        found, surfaces = play(tasks, folder, people, a)
    results.show(found, properties)
    if a.out:
        folder = pathlib.Path(a.out)
        results.write(folder, found, surfaces, numbers, properties)
        for operator in dict.fromkeys(one.operator for one in found):
            figure.draw(found, operator, folder / f"{operator}.svg")
    return 0


def stop(number, frame):
    raise KeyboardInterrupt


def main(words):
    def handled():
        a = parsed(words)
        signals.handle([signal.SIGTERM], stop)
        return run(a)
    return ending.status("study battery", handled)
