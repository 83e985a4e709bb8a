"""Writes a report on one or several runs as a self-contained HTML file.

  tactus report LOG... [--out FILE.html] [--name NAME]... [--json FILE]

  LOG          run.lcmlog of a run, or its folder. With several, the first is described and the others are overlaid
  --out FILE   default: report.html beside the first log. Figures are also written to FILE_figures, as PNG and SVG
  --run N      number of the run, of logs with several; default: 1
  --name NAME  name of a log in the report, in the order of the logs; default: the name of its folder
  --json FILE  also writes the figures of the report as JSON

Contents: scene and versions; contacts and their outcomes; rates, missed ticks and time per phase; latency of each hop; asynchrony of
onsets with published thresholds; events; force with just noticeable differences, position, temperature; the degradation profile and
its measured effect; the three metrics that predict success best. The same logs give the same bytes.
"""
import argparse
import json
import os
import sys
import tempfile

from tactus import own_files, terminal
from tactus.log import description
from tactus.option_parser import OptionParser
from tactus.paths import packages_remedy
from tactus.refusal import Refusal


def refuse(sentence):
    sys.exit(f"report: {sentence}")


def arguments(words):
    parser = OptionParser(prog="tactus report", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", nargs="+", metavar="LOG")
    parser.add_argument("--out", metavar="FILE.html")
    parser.add_argument("--name", action="append", default=[])
    parser.add_argument("--json", metavar="FILE")
    parser.add_argument("--run", default="1", metavar="N")
    options = parser.parse_args(words)
    for log in options.log:
        if not os.path.exists(log):
            refuse(f"{log} does not exist; give the run.lcmlog of a run, or its folder")
    if len(options.name) > len(options.log):
        refuse(f"{len(options.name)} names for {len(options.log)} logs; give at most one --name for each log")
    if description.run_number(options.run) is None:
        refuse(f"--run {options.run}: is not the number of a run; give a whole number from 1, as in the column run of tactus export")
    folder = lambda log: os.path.abspath(log) if os.path.isdir(log) else os.path.dirname(os.path.abspath(log))
    options.out = options.out or os.path.join(folder(options.log[0]), "report.html")
    options.name += [os.path.basename(folder(log)) or log for log in options.log[len(options.name):]]
    options.name = [terminal.readable(name) for name in options.name]
    if len(set(options.name)) < len(options.name):
        options.name = [f"{name} ({i + 1})" for i, name in enumerate(options.name)]
    return options


def tables_of(log, folder, run):
    """Exports the tables of one run of a log for the report into the folder."""
    from tactus.log import exported, log_tables
    try:
        exported.tables_of(log, folder, run, log_tables.CHANNELS)
    except Refusal as refusal:
        refuse(refusal)


def main(words):
    options = arguments(words)
    try:
        from tactus.report import figures
        from tactus.log import log_tables
        from tactus.report import report
    except ImportError as error:
        refuse(f"{error.name} is missing; {packages_remedy('report')}")
    with tempfile.TemporaryDirectory() as folder:
        logs = []
        for i, (log, name) in enumerate(zip(options.log, options.name)):
            if sys.stderr.isatty():
                terminal.report_refusal(f"report: reading {log}")
            tables_of(log, os.path.join(folder, str(i)), options.run)
            try:
                description.report_warnings(f"report: {log}", description.describe(log, options.run))
            except Refusal as refusal:
                refuse(refusal)
            logs.append(log_tables.LogTables(os.path.join(folder, str(i)), name))
        try:
            figures_folder = os.path.splitext(options.out)[0] + "_figures"
            with own_files.results_folder(figures_folder):
                gallery = figures.Gallery(figures_folder)
                made = report.Report(logs, gallery)
                text = made.html()
            with open(options.out + ".part", "w", encoding="utf-8") as file:
                file.write(text)
            os.replace(options.out + ".part", options.out)
            if options.json:
                with open(options.json, "w", encoding="utf-8") as file:
                    json.dump({"logs": [{"name": log.name, "contacts": log.summary["contacts"], "nodes": log.summary["nodes"],
                                         "asynchrony_ms": {f"{a}_{b}": {"n": len(v), "p50": float(sorted(v)[len(v) // 2])}
                                                           for (a, b), v in log_tables.asynchronies_ms(log.presented_ns()).items()}} for log in logs],
                               "figures": gallery.count, "tables": made.tables}, file, indent=1)
        except OSError as error:
            refuse(f"cannot write {error.filename or options.out} ({error.strerror}); give --out and --json files in writable folders")
    terminal.show(f"report: {options.out}, {os.path.getsize(options.out) // 1000} kB, {gallery.count} figures in {gallery.folder}")
    return 0

