"""Trials of simulated participants: the client of the program experiment_trials, and the procedure of an experiment. Nothing here reads a published result."""
import contextlib
import csv
import io
import subprocess

from tactus.psychophysics import procedures
from tactus.refusal import Refusal

PROGRAM = "experiment_trials"
AT_ONCE = 200  # lines without a read: fewer bytes than a pipe holds (64 KiB)
NUMBERS_OF_A_CONDITION = 1_000_000


class TrialProgram:
    """The running program. A context manager."""

    def __init__(self, path):
        try:
            self.process = subprocess.Popen([str(path), "answer"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8")
        except OSError as error:
            raise Refusal(f"{path}: cannot be started ({error.strerror}); run scripts/build {PROGRAM}") from None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        with contextlib.suppress(OSError):  # it has ended
            self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()

    def answers(self, lines):
        """{name: number} of each line. Raises Refusal with the sentence of the program."""
        found = []
        for first in range(0, len(lines), AT_ONCE):
            part = lines[first:first + AT_ONCE]
            try:
                self.process.stdin.write("".join(line + "\n" for line in part))
                self.process.stdin.flush()
            except OSError:
                pass  # it has ended; the missing answers say so
            for line in part:
                text = self.process.stdout.readline().rstrip("\n")
                if text.startswith("error "):
                    raise Refusal(f"{PROGRAM}: {text.removeprefix('error ')} (in '{line}')")
                if not text.startswith("ok"):
                    raise Refusal(f"{PROGRAM}: ended at '{line}'; run it with this line to see its message")
                found.append({name: float(value) for name, value in (word.split("=") for word in text.split()[1:])})
        return found


def sources(path):
    """{paradigm: {property: source}} of the program. Raises Refusal."""
    done = subprocess.run([str(path), "properties"], stdout=subprocess.PIPE, text=True, check=False, encoding="utf-8", errors="replace")
    if done.returncode != 0:
        raise Refusal(f"{path}: ended with status {done.returncode}; run scripts/build {PROGRAM}")
    found = {}
    for row in csv.DictReader(io.StringIO(done.stdout)):
        found.setdefault(row["paradigm"], {})[row["property"]] = row["source"]
    return found


def line_of(experiment, condition, level, number):
    settings = {**condition.settings, **({condition.varies: f"{level:.9g}"} if condition.varies else {})}
    return " ".join(["trial", experiment.paradigm, str(number), *(f"{name}={value}" for name, value in settings.items())])


def rows_of(experiment, program, index, seed):
    """The trials of one participant: (condition id, level, number, {outcome: value})."""
    program.answers([f"participant {index} {seed}"])
    for place, condition in enumerate(experiment.conditions):
        start = 0 if experiment.common_noise else place * NUMBERS_OF_A_CONDITION
        procedure = procedures.make_procedure(experiment.specification(condition), seed * 4096 + index)
        if experiment.procedure["kind"] == "constant":
            levels = list(procedure.levels)
            # With common noise, equal repetitions have equal numbers.
            numbers = [i // len(condition.levels) if experiment.common_noise else start + i for i in range(len(levels))]
            answers = program.answers([line_of(experiment, condition, level, number) for level, number in zip(levels, numbers)])
            yield from ((condition.id, level, number, answer) for level, number, answer in zip(levels, numbers, answers))
            continue
        while not procedure.finished:
            level, number = procedure.next_level(), start + procedure.done
            answer, = program.answers([line_of(experiment, condition, level, number)])
            procedure.answer(level, answer[experiment.answer] > 0.5)
            yield condition.id, level, number, answer


def collected(experiment, program, participants, seed):
    """All trials: [(participant, condition id, level, number, {outcome: value})]."""
    rows = [(index, *row) for index in range(participants) for row in rows_of(experiment, program, index, seed)]
    names = {name for *_, outcomes in rows for name in outcomes}
    for wanted in {m.outcome for m in experiment.measures if m.outcome} | ({experiment.answer} if experiment.answer else set()):
        if wanted not in names:
            raise Refusal(f"{experiment.path}: the paradigm {experiment.paradigm} answers {', '.join(sorted(names))}, not {wanted}; correct answer= or outcome=")
    return rows
