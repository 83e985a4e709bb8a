"""The command line of `tactus study analyse`."""
import argparse
import json
import math
import os
import pathlib
import sys

from tactus import own_files, terminal
from tactus.paths import packages_remedy
from tactus.refusal import Refusal

USAGE = """Analyses trials and games: limits of detection, of a felt change and of the task for each degradation.

  tactus study analyse PLACE... [--out DIR] [--json FILE] [--seed N] [--time-limit S] [--margin-success POINTS] [--margin-time PERCENT] [--alpha A]
                              [--window symmetric|asymmetric]

  PLACE                    a results folder of `study run` or `study sweep` (all trials.csv and games.csv in it), or one such table
  --out DIR                folder of tables, figures and report.html; default: analysis, in the first PLACE
  --json FILE              also writes all tables to FILE as JSON
  --seed N                 seed of the bootstrap; the same input and seed give the same bytes; default: 1
  --time-limit S           time limit of a game, which games not won count with; default: that of the study file, else of the tables
  --margin-success POINTS  smallest relevant loss of success, in points; default: that of the study file, else 10
  --margin-time PERCENT    smallest relevant increase of time; default: that of the study file, else 10
  --alpha A                one-sided level of the tests of non-inferiority; default: 0.025
  --window KIND            window of synchrony judgements: symmetric (default), or asymmetric, of two independent channels; intervals take seconds each

Levels are measured ones where the apparatus measured them. Missed trials are left out and counted. Writes report.html, figures/, and those of
psychometric.csv, limits.csv, limit_curves.csv, ratios.csv, conditions.csv, frontier.csv, felt.csv and mixed_models.csv that have rows.
"""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus study analyse --help")


def parsed(words):
    parser = Parser(add_help=False, allow_abbrev=False)
    parser.add_argument("place", nargs="+")
    parser.add_argument("--out")
    parser.add_argument("--json")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--time-limit", type=float)
    parser.add_argument("--margin-success", type=float)
    parser.add_argument("--margin-time", type=float)
    parser.add_argument("--alpha", type=float, default=0.025)
    parser.add_argument("--window", choices=("symmetric", "asymmetric"), default="symmetric")
    options = parser.parse_args(words)
    for name, value, low, high in (("--margin-success", options.margin_success, 0, 100), ("--margin-time", options.margin_time, 0, 1000),
                                   ("--alpha", options.alpha, 0, 0.5), ("--time-limit", options.time_limit, 0, 1e6)):
        if value is not None and not low < value < high:
            raise Refusal(f"{name} {value:g}: is out of range; give a number above {low} and below {high:g}")
    if options.seed < 0:
        raise Refusal(f"--seed {options.seed}: is negative; give a number of 0 or more")
    first = pathlib.Path(options.place[0])
    options.out = options.out or str((first if first.is_dir() else first.parent) / "analysis")
    return options


def analyse(options):
    try:
        from tactus.analysis import study_files
        from tactus.analysis import trials
        files = trials.files_of(options.place)
        rows = trials.read(files)
        from tactus.analysis import result_tables  # loads slowly
        from tactus.analysis import study_analysis
    except ImportError as error:
        raise Refusal(f"{error.name} is missing; {packages_remedy('study')}") from None
    share = lambda percent: None if percent is None else percent / 100
    settings = study_analysis.Settings(share(options.margin_success), share(options.margin_time), options.alpha, options.time_limit, options.seed, options.window == "asymmetric",
                                       study_files.stated(files))
    analysis = study_analysis.analyse(rows, settings)
    made = result_tables.all_rows(analysis)
    if not made:
        raise Refusal(f"{options.place[0]}: holds no judgements, no matches of a known property and no games; give results of a study")
    with own_files.results_folder(options.out):
        write(options, analysis, made)


def write(options, analysis, made):
    """Writes tables, figures and the page, and prints the summary."""
    from tactus.analysis import result_tables
    from tactus.analysis import study_report
    result_tables.write(made, options.out)
    report = study_report.Report(analysis, os.path.join(options.out, "figures"))
    text = report.html(", ".join(sorted({s for s in analysis.trials["study"] if s})))
    page = os.path.join(options.out, "report.html")
    with open(page + ".part", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(page + ".part", page)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({"trials": len(analysis.trials), "left_out": analysis.left_out, "observer": analysis.observer, **result_tables.for_programs(made)}, file, indent=1, ensure_ascii=False)
            file.write("\n")
    print_summary(analysis, made, page, report)


def print_summary(analysis, made, page, report):
    from tactus.analysis import incomplete, operators
    who = f", observer = {analysis.observer}" if "simulated" in analysis.observer else ""
    notes = "".join(f", {clause}" for clause in incomplete.words(analysis.trials))
    terminal.show(f"study analyse: {len(analysis.trials)} trials, {analysis.left_out} left out because the apparatus missed its tolerance{notes}{who}")
    if "limits" in made:
        terminal.show(f"{'limit':9} {'sense':9} {'operator':10} {'by':34} {'value':>9} {'low':>9} {'high':>9} unit")
        for row in made["limits"]:
            beyond = "unknown" if math.isnan(row["value"]) else ("<" if operators.kind(row["operator"]) in operators.LOWER_IS_WORSE else ">") + f"{row['up_to']:.4g}"  # not reached up to this level
            fields = [f"{row[k]:9.4g}" if math.isfinite(row[k]) else f"{beyond:>9}" for k in ("value", "low", "high")]
            terminal.show(f"{row['limit']:9} {row['modality']:9} {row['operator']:10} {row['by']:34} {' '.join(fields)} {row['unit']}")
        for note in dict.fromkeys(row["note"] for row in made["limits"] if row["note"]):
            terminal.show(f"  note: {note}")
    terminal.show(f"study analyse: {page}, {os.path.getsize(page) // 1000} kB, {report.gallery.count} figures, tables {', '.join(name + '.csv' for name in made)}")


def main(argv):
    if not argv or any(word in ("-h", "--help") for word in argv):
        print(USAGE, end="", file=sys.stdout if argv else sys.stderr)
        return 0 if argv else 1
    try:
        analyse(parsed(argv))
    except Refusal as error:
        terminal.report_refusal(f"study analyse: {error}")
        return 1
    except OSError as error:
        terminal.report_refusal(f"study analyse: {error.filename or 'a file'}: {error.strerror or error}; give folders with permission to read and write")
        return 1
    return 0
