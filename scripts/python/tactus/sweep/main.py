"""tactus study sweep: plays the games of a study with the simulated player in virtual time, on this machine or a Slurm cluster."""
import argparse
import os
import signal
import sys
import time

from tactus import players, signals, terminal
from tactus.paths import remedy
from tactus.refusal import Refusal, sentence_of
from tactus.study import study_file
from tactus.sweep import adopted, player, progress, verdicts, virtual_games
from tactus.sweep.runners import Parallel, Slurm
from tactus.sweep.sweep_folder import SweepFolder

USAGE = """Plays N games in each condition of a study whose task is a game, with each simulated player of the study (scripts/simulated_player) in virtual time.
Each game has its own seed. Writes rows of the trial table to DIR/games.csv, observer=simulated, with the name of the player. After a stop at any moment, even by SIGKILL, --resume continues; no finished
game is lost or repeated."""
MAX_GAMES = 1_000_000
POLL_S = 0.2
REPORT_S = 5.0


def say(text):
    """Prints one line, which may contain names and texts of the user."""
    terminal.show(terminal.one_line(text))
    sys.stdout.flush()


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus study sweep --help")


def parsed(words):
    p = Parser(prog="tactus study sweep", description=USAGE, allow_abbrev=False)
    p.add_argument("study", nargs="?", help="a study file, or the name of a shipped one; not with --resume")
    p.add_argument("--games", type=int, metavar="N", help="games in each condition; not with --resume")
    p.add_argument("--out", required=True, metavar="DIR", help="folder of the sweep")
    p.add_argument("--player", metavar="NAME", help="stage_model, observer (the typical person) or observer:NUMBERS, for example observer:0-7; default: those of the study")
    p.add_argument("--population", type=int, default=1, metavar="SEED", help="seed of the population of --player observer:NUMBERS; default: 1")
    p.add_argument("--practice", type=int, default=0, metavar="N", help="actions whose effects a player of --player observer perceived before each game; default: 0")
    p.add_argument("--players", type=int, metavar="K", help="only the first K players")
    p.add_argument("--checks", choices=players.CHECKS, help="for a player of a population that fails one of the twelve checks. require: the sweep is refused; leave_out: "
                   "it does not play; count: it plays, and the table names the checks. Default: that of the study, or require")
    p.add_argument("--verdicts", metavar="TABLE", help="verdicts of the checks from `observer_players admit`, so that they do not run again; two are verified")
    p.add_argument("--resume", action="store_true", help="continues the sweep in DIR")
    p.add_argument("--from", dest="table", metavar="TABLE", help="games.csv, or .csv.xz, of an earlier sweep, whose matching games are reused")
    p.add_argument("--jobs", type=int, metavar="J", help="parallel jobs on this machine, each on one processor; default: one for each processor")
    p.add_argument("--slurm", action="store_true", help="plays as an array job of a Slurm cluster, which needs access to DIR and this repository")
    p.add_argument("--partition", help="partition of Slurm; default: that of the cluster")
    p.add_argument("--array-size", type=int, default=64, metavar="K", help="tasks of the array job; default: 64")
    a = p.parse_args(words)
    if a.resume and (a.study or a.games or a.player or a.players or a.checks or a.verdicts):
        raise Refusal("--resume takes the study, the players and the number of games from DIR; remove them")
    if not a.resume and not (a.study and a.games):
        raise Refusal("the study or --games is missing; give both, or --resume")
    for name, value, most in (("--games", a.games, MAX_GAMES), ("--jobs", a.jobs, 1024), ("--array-size", a.array_size, 1000),
                              ("--players", a.players, players.MOST)):
        if value is not None and not 1 <= value <= most:
            raise Refusal(f"{name} {value}: is out of range; give 1 to {most}")
    if a.resume and a.table:
        raise Refusal("--from applies to a new sweep; remove it, or --resume")
    if a.slurm and a.jobs:
        raise Refusal("--jobs applies to this machine, --slurm to a cluster; remove one of them")
    if a.partition and not a.slurm:
        raise Refusal("--partition applies to a Slurm cluster; add --slurm")
    if not (0 <= a.population < 2**32 and 0 <= a.practice <= players.LARGEST_PRACTICE):
        raise Refusal(f"--population and --practice must be from 0, and at most {2**32 - 1} and {players.LARGEST_PRACTICE}; see tactus study sweep --help")
    if not a.player and (a.population != 1 or a.practice):
        raise Refusal("--population and --practice apply to --player observer; add it, or remove them")
    return a


def players_of(a, study):
    """The players of a new sweep, checked. Raises Refusal."""
    found = study.players
    if a.player:
        name, colon, numbers = a.player.partition(":")
        try:
            found = players.several(name, numbers if colon else None, a.population, a.practice)
        except ValueError as error:
            raise Refusal(f"--player {a.player}: {error}") from None
    virtual_games.require_few(study, a.games, len(found[:a.players]))  # before the checks, which take time
    rule = a.checks or study.checks
    if a.verdicts and rule == "count":
        raise Refusal("--verdicts holds only the first failing check of a player, and --checks count names all; remove one of them")
    known = verdicts.verified(a.verdicts, found[:a.players]) if a.verdicts else {}
    return players.checked(found[:a.players], rule, lambda line: say(f"sweep: {line}"), known)


def new(a):
    study = study_file.read(a.study)
    if study.task != "game":
        raise Refusal(f"{a.study}: its task is {study.task}, but a sweep plays games; give a study with task=\"game\"")
    SweepFolder.refuse_used(a.out)  # before the checks, which take time
    return SweepFolder.begin(a.out, study, a.games, players_of(a, study))


def follow(folder, runner):
    """Prints the progress until the runner ends."""
    begun, (before, of) = time.monotonic(), folder.done()
    said = -REPORT_S
    while True:
        over = runner.poll()
        now = time.monotonic() - begun
        if over or now - said >= REPORT_S:
            said = now
            chunks = progress.chunks_of(folder)
            done = of - sum(chunk.left for chunk in chunks)
            say(progress.sentence(done, of, (done - before) / max(now, 1e-9), progress.remaining(chunks, runner.workers)))
        if over:
            return
        time.sleep(POLL_S)


def stop(number, frame):
    raise KeyboardInterrupt


def main(words):
    try:
        a = parsed(words)
        if not os.access(player.PROGRAM, os.X_OK):
            raise Refusal(f"{player.PROGRAM}: does not exist; {remedy()}")
        folder = SweepFolder(a.out) if a.resume else new(a)
        folder.hold()
        if a.table:
            say(f"sweep: {adopted.adopt(folder, a.table)} games are reused from {a.table}")
        left = folder.unfinished()
        say(f"sweep: {folder.study.name}, {len(folder.study.conditions)} conditions, {folder.games_each} games each with {players.described(folder.players)}, into {folder.path}")
        if not a.resume:
            say(f"sweep: size of this run: {len(folder.players)} of the {len(folder.study.players)} players of the study, {len(folder.study.conditions)} conditions, "
                  f"{folder.games_each} games each, {folder.done()[1]} games in all")
            for f in folder.study.falsifiers:
                say(f"sweep: falsifier {f.name}: {f.text} Decided by {f.decided_by}, not by these games")
        if left:
            signals.handle([signal.SIGTERM], stop)
            runner = Slurm(folder, left, a.partition, a.array_size) if a.slurm else Parallel(folder, left, a.jobs or len(os.sched_getaffinity(0)))
            try:
                follow(folder, runner)
            finally:
                runner.end()
        rows = folder.merge()
        missed = sum(r.get("missed") == 1 for r in rows)
        say(f"sweep: {len(rows)} games of {players.described(folder.players)} in {folder.path / 'games.csv'}" + (f"; {missed} failed, see the column missed_reason" if missed else ""))
        if folder.unfinished():
            raise Refusal(f"not all games were played ({runner.said()}); continue with --resume")
        return 0
    except KeyboardInterrupt:
        print("study sweep: interrupted; no finished game is lost; continue with --resume", file=sys.stderr)
        return 130
    except (Refusal, OSError) as error:
        terminal.report_refusal(f"study sweep: {sentence_of(error) if isinstance(error, OSError) else error}")
        return 1
