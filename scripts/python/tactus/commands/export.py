"""Makes tables of the log of a run."""
import glob
import json
import os
import subprocess

from tactus import own_files
from tactus.commands import prepare
from tactus.paths import BIN, remedy
from tactus.refusal import Refusal

VALUES = ("--channels", "--since", "--until", "--run")
USAGE = """Usage: tactus export LOG... [option]...

Makes tables of a log for pandas, R, MATLAB and PlotJuggler: one for each channel, one for all tagged variables, and tables of the
contact events and of their presentation by each modality. docs/export.md and schema.json in the folder describe them.

  LOG                    run.lcmlog of a run, or its folder: all parts of its recording
  --out DIR              folder for the tables; default: tables, beside the log
  --channels REGEX       only channels whose complete name matches: 'TOOL_STATE|CONTACT.*'; default: all
  --run N                only this run, of a log with several; default: all, with their number in the column run
  --since S, --until S   only messages that were recorded from and up to this second of the log, in every table
  --wide                 one row for each message with a column for each scalar field, for PlotJuggler; default: one row for
                         each value
  --json FILE            also writes the names and sizes of the tables to FILE
  --help                 this text

A message that is in the logs twice has one row. Damaged logs are read without the damage, which is reported at the end."""


def parsed(words):
    """(logs, options for export_log, folder of the tables or "", file of --json or ""). Raises Refusal."""
    logs, options, out, listing, words = [], [], "", "", list(words)
    while words:
        word = words.pop(0)
        if word in ("--out", "--json", *VALUES) and not words:
            raise Refusal("--out needs a folder" if word == "--out" else f"{word} needs a value")
        if word == "--out":
            out = words.pop(0)
        elif word == "--json":
            listing = words.pop(0)
        elif word in VALUES:
            options += [word, words.pop(0)]
        elif word == "--wide":
            options.append(word)
        elif word.startswith("-"):
            raise Refusal(f"there is no option {word}; see tactus export --help")
        else:
            logs.append(word)
    if not logs:
        raise Refusal("name a log; see tactus export --help")
    for log in logs:
        is_log = os.access(log, os.R_OK) and not os.path.isdir(log)
        if not is_log and not glob.glob(os.path.join(glob.escape(log), "run*.lcmlog")):
            raise Refusal(f"cannot read {log}; give the run.lcmlog of a run, or its folder")
    return logs, options, out, listing


def main(words):
    if {"--help", "-h"} & set(words):
        return prepare.print_usage(USAGE)
    try:
        logs, options, out, listing = parsed(words)
        out = out or os.path.join(logs[0] if os.path.isdir(logs[0]) else os.path.dirname(logs[0]), "tables")
    except Refusal as refusal:
        return prepare.refuse("export", refusal)
    prepare.install_and_build()
    try:
        with own_files.results_folder(out):
            status = run_programs(logs, out, options)
    except OSError:
        return prepare.refuse("export", f"cannot create the folder {out}; give a writable folder with --out")
    if status == 0 and listing:
        write_listing(listing, out)
    return status


def write_listing(path, out):
    """Writes [{"table", "bytes"}] of the files in `out` as JSON. Raises OSError."""
    tables = [{"table": name, "bytes": os.path.getsize(os.path.join(out, name))} for name in sorted(os.listdir(out))]
    with open(path, "w", encoding="utf-8") as file:
        json.dump(tables, file, indent=1)


def run_programs(logs, out, options):
    """Writes all tables; returns the exit status of the first program that fails, or 0."""
    chosen = ["--quiet"]
    for option in ("--run", "--since", "--until"):
        if option in options:
            at = len(options) - 1 - options[::-1].index(option)
            chosen += options[at:at + 2]
    for name, own in (("export_log", options), ("export_events", chosen), ("export_csv", chosen)):
        try:
            status = subprocess.run([BIN / name, *logs, "--out", out, *own], check=False).returncode
        except OSError as error:
            return prepare.refuse("export", f"{BIN / name}: {error.strerror}; {remedy()}")
        if status != 0:
            return status
    return 0
