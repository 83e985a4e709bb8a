"""Exports the tables of one run of a log by the programs of the log."""
import json
import os
import subprocess

from tactus import terminal
from tactus.paths import BIN, remedy
from tactus.refusal import Refusal


def tables_of(log, folder, run, channels):
    """Writes summary.json, the tables of these channels ("A|B"), and those of events and of the tools into the new folder. run: its number in the log, as text.
    Reports messages that could not be decoded on stderr. Raises Refusal with one sentence."""
    os.makedirs(folder)
    quiet = ["--run", run, "--quiet"]
    for words in ([BIN / "summarise", log, "--out", os.path.join(folder, "summary.json"), "--run", run],
                  [BIN / "export_log", log, "--out", folder, "--channels", channels, *quiet],
                  [BIN / "export_events", log, "--out", folder, *quiet], [BIN / "export_csv", log, "--out", folder, *quiet]):
        if not os.access(words[0], os.X_OK):
            raise Refusal(f"{words[0]} is missing; {remedy('--programs')}")
        done = subprocess.run(words, capture_output=True, text=True, errors="replace", check=False)
        # summarise also exits with 1 after a lost event, which the report shows.
        if done.returncode != 0 and not (words[0].name == "summarise" and os.path.exists(os.path.join(folder, "summary.json"))):
            raise Refusal((done.stderr.strip().splitlines() or [f"{words[0].name} failed on {log}"])[-1])
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        for sentence in json.load(file)["damage"]:
            terminal.report_refusal(f"{log}: {sentence}")
