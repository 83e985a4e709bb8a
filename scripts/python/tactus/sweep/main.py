"""tactus study sweep: plays the games of a study with the simulated player in virtual time, on this machine or a Slurm cluster."""
import argparse
import os
import signal
import sys
import time

from tactus import signals, terminal
from tactus.paths import remedy
from tactus.refusal import Refusal, sentence_of
from tactus.study import study_file
from tactus.sweep import adopted, player, progress
from tactus.sweep.runners import Parallel, Slurm
from tactus.sweep.sweep_folder import SweepFolder

USAGE = """Plays N games in each condition of a study whose task is a game, with the simulated player (scripts/simulated_player) in virtual time. Each game has its
own seed. Writes rows of the trial table to DIR/games.csv, observer=simulated. After a stop at any moment, even by SIGKILL, --resume continues; no finished
game is lost or repeated."""
MAX_GAMES = 1_000_000
POLL_S = 0.2
REPORT_S = 5.0


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus study sweep --help")


def parsed(words):
    p = Parser(prog="tactus study sweep", description=USAGE, allow_abbrev=False)
    p.add_argument("study", nargs="?", help="a study file, or the name of a shipped one; not with --resume")
    p.add_argument("--games", type=int, metavar="N", help="games in each condition; not with --resume")
    p.add_argument("--out", required=True, metavar="DIR", help="folder of the sweep")
    p.add_argument("--resume", action="store_true", help="continues the sweep in DIR")
    p.add_argument("--from", dest="table", metavar="TABLE", help="games.csv, or .csv.xz, of an earlier sweep, whose matching games are reused")
    p.add_argument("--jobs", type=int, metavar="J", help="parallel jobs on this machine, each on one processor; default: one for each processor")
    p.add_argument("--slurm", action="store_true", help="plays as an array job of a Slurm cluster, which needs access to DIR and this repository")
    p.add_argument("--partition", help="partition of Slurm; default: that of the cluster")
    p.add_argument("--array-size", type=int, default=64, metavar="K", help="tasks of the array job; default: 64")
    a = p.parse_args(words)
    if a.resume and (a.study or a.games):
        raise Refusal("--resume takes the study and the number of games from DIR; remove both")
    if not a.resume and not (a.study and a.games):
        raise Refusal("the study or --games is missing; give both, or --resume")
    for name, value, most in (("--games", a.games, MAX_GAMES), ("--jobs", a.jobs, 1024), ("--array-size", a.array_size, 1000)):
        if value is not None and not 1 <= value <= most:
            raise Refusal(f"{name} {value}: is out of range; give 1 to {most}")
    if a.resume and a.table:
        raise Refusal("--from applies to a new sweep; remove it, or --resume")
    if a.slurm and a.jobs:
        raise Refusal("--jobs applies to this machine, --slurm to a cluster; remove one of them")
    if a.partition and not a.slurm:
        raise Refusal("--partition applies to a Slurm cluster; add --slurm")
    return a


def new(a):
    study = study_file.read(a.study)
    if study.task != "game":
        raise Refusal(f"{a.study}: its task is {study.task}, but a sweep plays games; give a study with task=\"game\"")
    return SweepFolder.begin(a.out, study, a.games)


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
            print(progress.sentence(done, of, (done - before) / max(now, 1e-9), progress.remaining(chunks, runner.workers)), flush=True)
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
            print(f"sweep: {adopted.adopt(folder, a.table)} games are reused from {a.table}", flush=True)
        left = folder.unfinished()
        print(f"sweep: {folder.study.name}, {len(folder.study.conditions)} conditions, {folder.games_each} games each, into {folder.path}", flush=True)
        if left:
            signals.handle([signal.SIGTERM], stop)
            runner = Slurm(folder, left, a.partition, a.array_size) if a.slurm else Parallel(folder, left, a.jobs or len(os.sched_getaffinity(0)))
            try:
                follow(folder, runner)
            finally:
                runner.end()
        rows = folder.merge()
        missed = sum(r.get("missed") == 1 for r in rows)
        print(f"sweep: {len(rows)} games in {folder.path / 'games.csv'}" + (f"; {missed} failed, see the column missed_reason" if missed else ""))
        if folder.unfinished():
            raise Refusal(f"not all games were played ({runner.said()}); continue with --resume")
        return 0
    except KeyboardInterrupt:
        print("study sweep: interrupted; no finished game is lost; continue with --resume", file=sys.stderr)
        return 130
    except (Refusal, OSError) as error:
        terminal.report_refusal(f"study sweep: {sentence_of(error) if isinstance(error, OSError) else error}")
        return 1
