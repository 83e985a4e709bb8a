"""tactus study replicate: repeats published experiments with simulated participants, and compares the results."""
import argparse
import contextlib
import csv
import dataclasses
import json
import math
import pathlib
import time

from tactus import own_files, tables, terminal
from tactus.commands import prepare
from tactus.refusal import Refusal, sentence_of
from tactus.replication import experiment_file, participants, verdict

USAGE = """Repeats published experiments with simulated participants of a population, and prints published value, own value, interval over participants and verdict.
Levels, procedure and analysis are those of the file. A participant perceives the stimuli with latency, noise and belief, and never receives the published
value. Nothing is fitted to it: a replication that fails is printed as such."""
EPILOGUE = """verdicts:
  agrees                             the mean is in the range of the file, and the published value among the participants; for an order, with 95 % certainty
  differs                            it is not
  not reproducible with this player  the player lacks this percept or decision, or too few participants have a value
  ... (calibrated, not a replication)  a property of the player was set from this paper"""
MAX_PARTICIPANTS = 4000  # of one population, the partners apart
COLUMNS = ("experiment", "quantity", "unit", "published", "low", "high", "evidence", "source", "ours", "ci_low", "ci_high", "p5", "p95", "participants", "verdict", "calibrated", "note")


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus study replicate --help")


def parsed(words):
    p = Parser(prog="tactus study replicate", description=USAGE, epilog=EPILOGUE, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    p.add_argument("files", nargs="*", metavar="FILE", help="files of published experiments, or names of shipped ones; default: all shipped ones")
    p.add_argument("--participants", type=int, metavar="N", help="simulated participants of each experiment; default: the number in the file")
    p.add_argument("--repetitions", type=int, metavar="R", help="trials of each level instead of those of the file, for a quick look; a staircase is not changed")
    p.add_argument("--seed", type=int, metavar="S", help="seed of the population and of all noise; default: that of the file")
    p.add_argument("--out", metavar="FOLDER", help="also writes the table to FOLDER/replications.csv and FOLDER/replications.md, and all answers to FOLDER/answers/NAME.csv")
    p.add_argument("--json", metavar="FILE", help="also writes the table to FILE as JSON")
    p.add_argument("--list", action="store_true", help="lists the shipped experiments and ends")
    a = p.parse_args(words)
    if a.participants is not None and not 1 <= a.participants <= MAX_PARTICIPANTS:
        raise Refusal(f"--participants {a.participants}: is not from 1 to {MAX_PARTICIPANTS}")
    if a.repetitions is not None and not 1 <= a.repetitions <= 10_000:
        raise Refusal(f"--repetitions {a.repetitions}: is not from 1 to 10000")
    if a.seed is not None and not 0 <= a.seed < 2**32:
        raise Refusal(f"--seed {a.seed}: is not from 0 to {2**32 - 1}")
    return a


@dataclasses.dataclass(frozen=True)
class Row:
    """A line of the table: an expectation and its verdict. calibrated: the reason, or ""."""
    experiment: object
    expectation: object
    verdict: object
    calibrated: str

    def fields(self):
        e, v, number = self.expectation, self.verdict, lambda x: "" if x is None or not math.isfinite(x) else f"{x:.6g}"
        return dict(zip(COLUMNS, (self.experiment.name, e.quantity, e.unit, number(e.value), number(e.low), number(e.high), e.evidence, e.source, number(v.mean),
                                  number(v.low), number(v.high), number(v.from5), number(v.to95), f"{v.count}/{v.total}" if v.total else "", v.verdict,
                                  self.calibrated, v.why)))


def replicated(experiment, program, sources, count, seed):
    """(rows of the table, all trials) of one experiment."""
    if experiment.paradigm not in sources:
        raise Refusal(f"{experiment.path}: there is no paradigm {experiment.paradigm}; choose from {', '.join(sources)}")
    from tactus.replication import measures  # loads slowly
    trials = participants.collected(experiment, program, count, seed)
    resampled = {m.id for m in experiment.measures if m.kind == "first_level"}
    found = {name: (*values, name in resampled) for name, values in measures.of_experiment(experiment, trials, seed).items()}
    return [Row(experiment, e, verdict.of_expectation(e, found), verdict.calibration(experiment, e, sources[experiment.paradigm])) for e in experiment.expectations], trials


def published_text(e):
    """The published result in words: number or range."""
    if e.value is not None:
        return f"{e.value:g}"
    if e.lacks:
        return "-"
    return f"{e.low:g} to {e.high:g}" if e.low is not None and e.high is not None else f"above {e.low:g}" if e.low is not None else f"below {e.high:g}"


def line_of(row):
    e, v = row.expectation, row.verdict
    mark = {"read": "", "second_hand": " (second hand)", "unverified": " (unverified)"}[e.evidence]
    ours = f"{v.mean:.4g} [{v.low:.4g}, {v.high:.4g}]" if math.isfinite(v.mean) and math.isfinite(v.low) else f"{v.mean:.4g}" if math.isfinite(v.mean) else "-"
    return (row.experiment.name, f"{e.quantity}{f', {e.unit}' if e.unit else ''}", published_text(e) + mark, ours,
            v.verdict + (f" ({verdict.CALIBRATED})" if row.calibrated and v.verdict != verdict.NOT_REPRODUCIBLE else ""))


HEADER = ("experiment", "quantity", "published", "ours [95 %]", "verdict")


def print_table(lines):
    widths = [max(len(line[i]) for line in (HEADER, *lines)) for i in range(len(HEADER))]
    for line in (HEADER, *lines):
        terminal.report("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())


def summary(rows):
    counted = {name: sum(r.verdict.verdict == name and not r.calibrated for r in rows) for name in (verdict.AGREES, verdict.DIFFERS)}
    lacking = sum(r.verdict.verdict == verdict.NOT_REPRODUCIBLE for r in rows)
    calibrated = sum(bool(r.calibrated) and r.verdict.verdict != verdict.NOT_REPRODUCIBLE for r in rows)
    return (f"{len(rows)} results: {counted[verdict.AGREES]} agree, {counted[verdict.DIFFERS]} differ, {lacking} not reproducible with this player, "
            f"{calibrated} calibrated and no replication")


def write_table(folder, rows):
    """replications.csv with all numbers, and replications.md, the printed table."""
    with open(folder / "replications.md", "w", encoding="utf-8") as file:
        lines = (HEADER, ("---",) * len(HEADER), *map(line_of, rows))
        file.write("\n".join(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in line)} |" for line in lines) + "\n")
    with open(folder / "replications.csv", "w", newline="", encoding="utf-8") as file:
        out = csv.DictWriter(file, COLUMNS)
        out.writeheader()
        out.writerows({name: tables.escaped(text) for name, text in row.fields().items()} for row in rows)


def write_answers(folder, experiment, trials):
    names = list(dict.fromkeys(name for *_, outcomes in trials for name in outcomes))
    with open(folder / "answers" / f"{experiment.name}.csv", "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow(["observer", "participant", "condition", "level", "number", *names])
        out.writerows(["simulated", participant, condition, f"{level:.9g}", number, *(f"{outcomes.get(n, math.nan):.9g}" for n in names)]
                      for participant, condition, level, number, outcomes in trials)


def run(a):
    experiments = [experiment_file.read(f) for f in (a.files or experiment_file.shipped())]
    if a.repetitions:
        experiments = [e.with_repetitions(a.repetitions) for e in experiments]
    names = [e.name for e in experiments]
    if len(set(names)) < len(names):
        raise Refusal(f"the experiment {next(n for n in names if names.count(n) > 1)} is given twice; give each once")
    path, rows = prepare.program(participants.PROGRAM), []
    sources, folder = participants.sources(path), pathlib.Path(a.out) if a.out else None
    with own_files.results_folder(folder / "answers") if folder else contextlib.nullcontext():
        for experiment in experiments:
            start = time.monotonic()
            with participants.TrialProgram(path) as program:
                made, trials = replicated(experiment, program, sources, a.participants or experiment.participants, experiment.seed if a.seed is None else a.seed)
            rows += made
            if folder:
                write_answers(folder, experiment, trials)
            terminal.report(f"{experiment.name}: {len(trials)} trials in {time.monotonic() - start:.1f} s")
        if folder:
            write_table(folder, rows)
    print_table([line_of(row) for row in rows])
    terminal.report(summary(rows))
    if a.json:
        with open(a.json, "w", encoding="utf-8") as file:
            json.dump({"replications": [{**row.fields(), "paper": row.experiment.paper, "doi": row.experiment.doi} for row in rows]}, file, indent=1, ensure_ascii=False)
    return 0


def main(words):
    terminal.prepare()
    try:
        a = parsed(words)
        if a.list:
            for path in experiment_file.shipped():
                terminal.report(f"{path.stem:28} {experiment_file.read(path).paper}")
            return 0
        return run(a)
    except Refusal as refusal:
        terminal.report_refusal(f"study: {refusal}")
    except OSError as error:
        terminal.report_error(f"study: {sentence_of(error)}")
    except KeyboardInterrupt:
        terminal.report_error("study: interrupted; run the same command again")
        return 130
    return 1
