"""tactus study information: the information that each sense carries about the hidden variable of a task."""
import json
import math
import os
import pathlib
import signal
import tempfile

from tactus import ending, signals, terminal
from tactus.information import noise, percepts, rendering, task_file
from tactus.information.estimate import Observer
from tactus.option_parser import OptionParser
from tactus.refusal import Refusal

USAGE = """Renders every value of the hidden variable of a task in virtual time without any degradation, adds the noise of human senses, and prints the mutual
information of the percepts and the hidden variable, in bits, and the share of right answers of an ideal observer, with 95 % intervals: with all senses, with
all but one, and with one alone. `gain` is what all senses have more than all but this one. `share` is the Shapley share of the information. Touch is
the force; the place of the hand (proprioception) is a sense of its own, which no profile removes. Exit status 1: the gain of a sense that the task is for
is not above 0, in bits and in right answers."""
LEAST_BITS = 1e-6  # above rounding
MAX_DRAWS = 1_000_000


def parsed(words):
    p = OptionParser(prog="tactus study information", description=USAGE, allow_abbrev=False)
    p.add_argument("tasks", nargs="*", metavar="TASK", help="a task file, or the name of a shipped task; default: all shipped tasks: " + ", ".join(task_file.shipped()))
    p.add_argument("--draws", type=int, default=4000, metavar="N", help="draws of noise for each task; default: 4000")
    p.add_argument("--seed", type=int, default=1, metavar="N", help="seed of the draws; default: 1")
    p.add_argument("--width", type=int, default=640, metavar="PIXELS", help="width of the pictures, 320 to 4096; the height is three quarters of it; default: 640")
    p.add_argument("--jobs", type=int, metavar="J", help="renderings at a time; default: one for each core")
    p.add_argument("--keep", metavar="DIR", help="keep the renderings in DIR, a new or empty folder")
    p.add_argument("--json", metavar="FILE", help="also write the figures to FILE; -: print only them")
    a = p.parse_args(words)
    for name, value, least, most in (("--draws", a.draws, 10, MAX_DRAWS), ("--seed", a.seed, 0, 2**53), ("--width", a.width, 320, 4096), ("--jobs", a.jobs, 1, 1024)):
        if value is not None and not least <= value <= most:
            raise Refusal(f"{name} {value}: is out of range; give {least} to {most}")
    a.size = (a.width // 4 * 4, a.width * 3 // 4 // 4 * 4)
    if a.keep and os.path.exists(a.keep) and (not os.path.isdir(a.keep) or os.listdir(a.keep)):
        raise Refusal(f"--keep {a.keep}: exists and is not empty; remove it, or give another folder")
    return a


def measure(task, a, folder):
    """The figures of a task. Raises Refusal."""
    perceived, warnings = percepts.render(task, folder, a.size, a.jobs or len(os.sched_getaffinity(0)))
    observer = Observer(percepts.percepts(task, perceived, a.size[0]), a.draws, a.seed, noise.values()["lapse"])
    shares = observer.shares()
    senses = {}
    for sense in observer.senses:
        senses[sense] = {"gain": observer.gain(sense), "without": observer.result([s for s in observer.senses if s != sense]), "only": observer.result([sense]),
                         "share_bits": shares[sense], "needed": sense in task.senses}
    return {"task": task.name, "scene": task.scene.name, "question": task.question, "values": list(task.values), "variants": len(task.variants),
            "hidden_bits": math.log2(len(task.values)), "chance": 1 / len(task.values), "draws": a.draws, "seed": a.seed, "picture": list(a.size),
            "warnings": warnings, "all": observer.result(observer.senses), "senses": senses,
            "holds": all(holds(senses[s]["gain"]) for s in task.senses)}


def holds(gain):
    return gain["bits_interval"][0] > LEAST_BITS and gain["success_interval"][0] > 0


def interval(figures, what, digits=2):
    low, high = figures[f"{what}_interval"]
    return f"{zero(figures[what], digits)} [{zero(low, digits)}, {zero(high, digits)}]"


def zero(number, digits):
    """The number as text, without a minus sign before zero."""
    return f"{round(number, digits) + 0.0:.{digits}f}"


def print_task(f):
    terminal.report(f"\n{f['task']}: {f['question']}")
    terminal.report(f"  {len(f['values'])} values, {f['hidden_bits']:.2f} bits, chance {f['chance']:.2f}; {f['variants']} variants, {f['draws']} draws")
    terminal.report(f"  all senses: {interval(f['all'], 'bits')} bits, right {interval(f['all'], 'success')}")
    terminal.report(f"  {'sense':15} {'gain, bits':20} {'gain, right':20} {'without':>11} {'alone':>11} {'share':>6}")
    for sense, s in f["senses"].items():
        pair = lambda r: f"{zero(r['bits'], 2)} {zero(r['success'], 2)}"
        terminal.report(f"  {sense:15} {interval(s['gain'], 'bits'):20} {interval(s['gain'], 'success'):20} {pair(s['without']):>11} {pair(s['only']):>11} {zero(s['share_bits'], 2):>6}"
              + ("  needed" + ("" if holds(s["gain"]) else ", does not hold") if s["needed"] else ""))
    for line in f["warnings"]:
        terminal.report(f"  {line}")


def stop(number, frame):
    raise KeyboardInterrupt


def run(a):
    rendering.require_programs()
    tasks = [task_file.read(text) for text in a.tasks or task_file.shipped()]
    figures = []
    with tempfile.TemporaryDirectory() as scratch:
        for task in tasks:
            terminal.report_error(terminal.one_line(f"study information: {task.name}, {len(task.values) * len(task.variants)} renderings"))
            figures.append(measure(task, a, pathlib.Path(a.keep).absolute() if a.keep else pathlib.Path(scratch)))
            if a.json != "-":
                print_task(figures[-1])
    text = json.dumps(figures, indent=1) + "\n"
    if a.json == "-":
        print(text, end="")
    elif a.json:
        pathlib.Path(a.json).write_text(text, encoding="utf-8")
    return 0 if all(f["holds"] for f in figures) else 1


def main(words):
    def handled():
        a = parsed(words)
        signals.handle([signal.SIGTERM], stop)
        return run(a)
    return ending.status("study information", handled)
