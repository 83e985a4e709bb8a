"""Programs of the build and runs of scenes."""
import os
import subprocess

from tactus.paths import BIN, SCRIPTS
from tactus.refusal import Refusal


def program(name):
    """Path of a program of the build. Raises Refusal when it is not built."""
    path = BIN / name
    if not os.access(path, os.X_OK):
        raise Refusal(f"{path} is missing; build it with scripts/build {name}")
    return str(path)


def last_line(text, otherwise="no output"):
    return (text.strip().splitlines() or [otherwise])[-1]


def output(words, **options):
    """(standard output, standard error) of a program. Raises Refusal with the last line of its output when it fails."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, errors="replace", check=False, **options)
    if done.returncode != 0:
        raise Refusal(f"{os.path.basename(words[0])} ended with status {done.returncode}: {last_line(done.stderr or done.stdout)}")
    return done.stdout, done.stderr


def run_words(out, *words, settings=(), without=()):
    """Command words of scripts/run with this output folder."""
    return [str(SCRIPTS / "run"), *map(str, words), "--out", str(out), *(w for s in settings for w in ("--set", s)), *(w for n in without for w in ("--without", n))]


def run_scene(out, *words, settings=(), without=(), result="summary.json", statuses=(0, 1), **options):
    """Runs scripts/run. Raises Refusal when the run ends with another status or without the file `result`; a run that lost events ends with 1."""
    done = subprocess.run(run_words(out, *words, settings=settings, without=without), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, errors="replace", check=False, **options)
    if done.returncode not in statuses or not os.path.exists(os.path.join(out, result)):
        raise Refusal(f"the run failed with status {done.returncode}, see {out}/{result}: {last_line(done.stdout)}")
