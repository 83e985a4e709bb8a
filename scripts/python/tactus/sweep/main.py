"""tactus study sweep: games of the artificial player in virtual time, as many as the machine or a Slurm cluster has room for."""
import argparse
import os
import signal
import sys
import time

from tactus.refusal import Refusal, sentence_of
from tactus.study import study_file
from tactus.sweep import adopted, player
from tactus.sweep.runners import Parallel, Slurm
from tactus.sweep.sweep_folder import SweepFolder

USAGE = """Plays N games in each condition of a study whose task is a game: the artificial player (scripts/participant) in virtual time, each game with a seed
of its own. Rows of the trial table come into DIR/games.csv, observer=simulated. Stopped at any moment, even by SIGKILL, it goes on with --resume:
nothing that was played is lost or played again."""
MOST_GAMES = 1_000_000
POLL_S = 0.2
SAY_S = 5.0


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus study sweep --help")


def parsed(words):
    p = Parser(prog="tactus study sweep", description=USAGE, allow_abbrev=False)
    p.add_argument("study", nargs="?", help="a study file, or the name of a shipped one; not with --resume")
    p.add_argument("--games", type=int, metavar="N", help="in each condition; with --resume as many as were asked for")
    p.add_argument("--out", required=True, metavar="DIR", help="folder of the sweep")
    p.add_argument("--resume", action="store_true", help="goes on with the sweep in DIR")
    p.add_argument("--from", dest="table", metavar="TABLE", help="games.csv, or .csv.xz, of an earlier sweep: of its games those that are asked for are not played again")
    p.add_argument("--jobs", type=int, metavar="J", help="at once on this machine; default: one for each core")
    p.add_argument("--slurm", action="store_true", help="as an array of jobs of a Slurm cluster, which must see DIR and this repository")
    p.add_argument("--partition", help="of Slurm; default: the cluster's")
    p.add_argument("--array-size", type=int, default=64, metavar="K", help="tasks of the array; default: 64")
    a = p.parse_args(words)
    if a.resume and (a.study or a.games):
        raise Refusal("--resume goes on with the study and the number of games that the sweep began with; leave both away")
    if not a.resume and not (a.study and a.games):
        raise Refusal("say which study, and how many --games of each condition; or --resume")
    for name, value, most in (("--games", a.games, MOST_GAMES), ("--jobs", a.jobs, 1024), ("--array-size", a.array_size, 1000)):
        if value is not None and not 1 <= value <= most:
            raise Refusal(f"{name} {value}: is not from 1 to {most}")
    if a.resume and a.table:
        raise Refusal("--from is for a new sweep; leave it away, or --resume")
    if a.slurm and a.jobs:
        raise Refusal("--jobs is of this machine, --slurm of a cluster; leave one away")
    if a.partition and not a.slurm:
        raise Refusal("--partition is of a Slurm cluster; add --slurm")
    return a


def new(a):
    study = study_file.read(a.study)
    if study.task != "game":
        raise Refusal(f"{a.study}: its task is {study.task}; the player plays games only, of studies with task=\"game\"")
    return SweepFolder.begin(a.out, study, a.games)


def duration(seconds):
    return f"{seconds / 3600:.1f} h" if seconds > 5400 else f"{seconds / 60:.0f} min" if seconds > 90 else f"{seconds:.0f} s"


def follow(folder, runner):
    """Tells of progress until the runner is through."""
    begun, (before, of) = time.monotonic(), folder.done()
    said = -SAY_S
    while True:
        over = runner.poll()
        now = time.monotonic() - begun
        if over or now - said >= SAY_S:
            said = now
            done = folder.done()[0]
            rate = (done - before) / max(now, 1e-9)
            rest = f", {duration((of - done) / rate)} left" if rate > 0 and done < of else ""
            print(f"sweep: {done} of {of} games, {rate:.2f} a second{rest}", flush=True)
        if over:
            return
        time.sleep(POLL_S)


def stop(number, frame):
    raise KeyboardInterrupt


def main(words):
    try:
        a = parsed(words)
        if not os.access(player.PROGRAM, os.X_OK):
            raise Refusal(f"{player.PROGRAM}: is not built; run scripts/build")
        folder = SweepFolder(a.out) if a.resume else new(a)
        folder.hold()
        if a.table:
            print(f"sweep: {adopted.adopt(folder, a.table)} games are those of {a.table}", flush=True)
        left = folder.unfinished()
        print(f"sweep: {folder.study.name}, {len(folder.study.conditions)} conditions, {folder.games_each} games each, into {folder.path}", flush=True)
        if left:
            signal.signal(signal.SIGTERM, stop)
            runner = Slurm(folder, left, a.partition, a.array_size) if a.slurm else Parallel(folder, left, a.jobs or os.cpu_count() or 1)
            try:
                follow(folder, runner)
            finally:
                runner.end()
        rows = folder.merge()
        missed = sum(r.get("missed") == 1 for r in rows)
        print(f"sweep: {len(rows)} games in {folder.path / 'games.csv'}" + (f"; {missed} failed, see its column missed_reason" if missed else ""))
        if folder.unfinished():
            raise Refusal(f"not all games were played ({runner.said()}); add --resume to go on")
        return 0
    except KeyboardInterrupt:
        print("study sweep: interrupted; nothing that was played is lost, --resume goes on", file=sys.stderr)
        return 130
    except (Refusal, OSError) as error:
        print(f"study sweep: {sentence_of(error) if isinstance(error, OSError) else error}", file=sys.stderr)
        return 1
