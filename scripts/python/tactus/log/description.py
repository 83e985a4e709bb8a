"""Reads the contents of a log through `replay --describe`: Python parses no log itself."""
import json
import os
import subprocess

from tactus import tables, terminal
from tactus.paths import BIN, remedy
from tactus.refusal import Refusal


def describe(log, run=1, command=lambda words: words, folder=BIN):
    """Description of one run of a log: scene, tools, seed, recovered, runs, warnings. run: its number, from 1.

    command: changes the command line before it is executed. folder: of the program. Raises Refusal with the message of the program.
    """
    program = folder / "replay"
    if not os.access(program, os.X_OK):
        raise Refusal(f"replay: {program} is missing; {remedy()}")
    done = subprocess.run(command([program, log, "--describe", "--run", str(run)]), capture_output=True, text=True, errors="replace", check=False)
    if done.returncode != 0:
        raise Refusal(done.stderr.strip().split("\n")[-1] or f"replay: cannot read {log}")
    try:
        return json.loads(done.stdout)
    except ValueError:
        raise Refusal(f"replay: {program} gave no description of {log}; {remedy()}") from None


def report_warnings(name, description):
    """Prints each warning about a log after the name of the command, on stderr."""
    for sentence in description.get("warnings", []):
        terminal.report_error(f"{name}: {sentence}")


def run_number(text):
    """The number of --run, or None when the text is no whole number from 1 to a million."""
    return tables.whole_number(text, 1, 1_000_000)
