"""tactus study check: validates a study file and prints its plan, its duration and its statistical power."""
import argparse
import dataclasses
import json
import pathlib
import subprocess
import tempfile

from tactus import terminal
from tactus.paths import BIN, remedy
from tactus.refusal import Refusal, sentence_of
from tactus.study import felt_properties, fonts, study_file, texts

USAGE = """Validates a study file, and refuses it with line and reason if it has an error. Prints the plan of a participant, the number of trials, the
duration, and the power of the study from simulated observers: the width of the 95 % interval of each estimate, or the smallest loss of success and the
smallest slowing that games show."""
MAX_SHOWN = 20       # trials of the plan, in --json
MAX_PARTICIPANTS = 10_000
CHECK_TIMEOUT_S = 60
MAX_RULES = 64  # of one profile: sync/degradation/parse_profile.cpp


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus study check --help")


def parsed(words):
    p = Parser(prog="tactus study check", description=USAGE, allow_abbrev=False)
    p.add_argument("study", help="a study file, or the name of a shipped one")
    p.add_argument("--participant", default="P01", help="participant whose plan is printed; default: P01")
    p.add_argument("--participants", default="1,12,24", metavar="N,...", help="numbers of participants for which power is computed; default: 1,12,24")
    p.add_argument("--pilot", metavar="TRIALS.csv", help="trial table of a pilot: its undegraded games, or the felt stiffness of its presses, replace assumed values")
    p.add_argument("--simulations", type=int, default=100, help="number of simulated participants; default: 100")
    p.add_argument("--seed", type=int, default=1, help="seed of the simulated participants; default: 1")
    p.add_argument("--json", metavar="FILE", help="also writes the results to FILE")
    a = p.parse_args(words)
    a.participant = texts.participant_name(a.participant)
    if not (2 <= a.simulations <= 100_000 and a.seed >= 0):
        raise Refusal("--simulations must be from 2 to 100000, and --seed 0 or more; see tactus study check --help")
    try:
        a.participants = tuple(int(n) for n in a.participants.split(","))
    except ValueError:
        a.participants = (0,)
    if not all(1 <= n <= MAX_PARTICIPANTS for n in a.participants):
        raise Refusal(f"--participants needs numbers from 1 to {MAX_PARTICIPANTS}, for example 1,12,24; see tactus study check --help")
    return a


def profiles(study):
    """Checks all degradations of the study with sync_node; returns a line that reports the result. Raises Refusal with the reason of sync_node."""
    elements = list(dict.fromkeys([*study.base, *(e for c in study.conditions for level in (c.levels or (None,)) for e in c.elements(level))]))
    if not (BIN / "sync_node").is_file():
        return f"profiles not checked: {BIN} holds no sync_node; {remedy()}"
    if not elements:
        return "the study has no degradations"
    for begin in range(0, len(elements), MAX_RULES):
        if sentence := invalid(elements[begin:begin + MAX_RULES]):
            raise Refusal(f"{study.path}: {sentence}")
    return f"all {len(elements)} degradations are valid"


def invalid(elements):
    """The reason why sync_node does not accept these elements of one profile, at most MAX_RULES, as a sentence; "": it accepts them."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "profile.xml"
        file.write_text("<profile>\n" + "\n".join(elements) + "\n</profile>\n", encoding="utf-8")
        try:
            done = subprocess.run([BIN / "sync_node", "--degrade", file, "--check"], capture_output=True, text=True, errors="replace", timeout=CHECK_TIMEOUT_S, check=False)
        except subprocess.TimeoutExpired:
            raise Refusal(f"sync_node does not check the profiles in {CHECK_TIMEOUT_S} s; stop other programs, and repeat the command") from None
    if not done.returncode:
        return ""
    said = (done.stderr.strip().splitlines() or ["no message"])[-1]
    line, _, reason = said.partition(f"{file}:")[2].partition(": ")
    of = elements[int(line) - 2] if line.isdigit() and 2 <= int(line) < len(elements) + 2 else "a profile"
    return f"{of} is not valid: {reason or said}"


def sequence(plan):
    """The first trials as text; an adaptive procedure receives the answer yes each time."""
    for _ in range(MAX_SHOWN):
        trial = plan.next()
        if trial is None:
            return
        yield trial.condition.words(trial.level)
        plan.answered(trial, True)


def assumed_of(study, options):
    """power.Assumed of the command line."""
    from tactus.psychophysics import observers
    from tactus.study import power
    from tactus.study import power_felt
    from tactus.study import power_games
    from tactus.study import trial_table
    assumed = power.Assumed(options.simulations, options.seed, options.participants)
    if not options.pilot:
        return assumed
    presses = any(o.function in observers.PERCEPTS for o in study.observers.values())
    if study.response != "performance" and not presses:
        raise Refusal(f"--pilot applies to games, and to presses with an <observer> of felt stiffness; {study.name} has neither; remove --pilot")
    try:
        rows = trial_table.read(options.pilot)
        made = {"presses": power_felt.pilot(rows, options.pilot)} if presses else {"games": power_games.pilot(rows, options.pilot)}
    except ValueError as error:
        raise Refusal(str(error)) from None
    return dataclasses.replace(assumed, **made)


def unnamed(study):
    """[a warning] if the analysis cannot determine the rated property; else []."""
    if study.response != "rating" or study.of:
        return []
    known = felt_properties.just_noticeable()
    if study.number and felt_properties.property_of(study.question, known):
        return []
    return [f"these ratings are stored but not analysed; an analysis needs numbers, and of= or a question that names one of {', '.join(known)}"]


def checked(study, options):
    """(lines for the terminal, {figure: value} for --json)."""
    from tactus.study import duration
    from tactus.study import power
    from tactus.study.plan import Plan
    plan, assumed = Plan(study, options.participant), assumed_of(study, options)
    lines = [*plan.describe(), profiles(study), *fonts.words(study)]
    parts, about = duration.of_session(study, plan.expected_trials), "at most" if study.task == "game" else "about"
    minutes = sum(seconds for _, seconds in parts) / 60
    lines.append(f"{plan.expected_trials} {'games' if study.task == 'game' else 'trials'}, {about} {minutes:.0f} minutes: "
                 + ", ".join(f"{part} {seconds / 60:.1f}" for part, seconds in parts))
    first = list(sequence(plan))
    lines.append(f"first trials{'' if study.procedure['kind'] == 'constant' else ' (if every answer is yes)'}: " + ", ".join(first[:6]))
    found = power.of(study, assumed)
    figures = {"study": study.name, "trials": Plan(study, options.participant).expected_trials, "blocks": study.blocks, "conditions": [c.id for c in study.conditions],
               "minutes": round(minutes, 2), "parts_s": dict(parts), "sequence": first, "power": found}
    return lines + power.words(study, found, assumed) + unnamed(study), figures


def main(words):
    terminal.prepare()
    try:
        options = parsed(words)
        lines, figures = checked(study_file.read(options.study), options)
        for line in lines:
            terminal.report(line)
        if options.json:
            pathlib.Path(options.json).write_text(json.dumps(figures, indent=2, ensure_ascii=False) + "\n", encoding="utf-8", errors="backslashreplace")
        return 0
    except Refusal as refusal:
        terminal.report_refusal(f"study: {refusal}")
    except (OSError, subprocess.TimeoutExpired) as error:
        terminal.report_error(f"study: {sentence_of(error) if isinstance(error, OSError) else f'sync_node did not end in time; {remedy()}'}")
    return 1
