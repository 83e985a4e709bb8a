"""Prints metrics of runs: how late, how coarse and how old the rendering was.

  tactus metrics RUN... [--reference RUN] [--tool N] [--json FILE] [--csv FILE]

  RUN               the folder of a run, its run.lcmlog, or a folder of `tactus rerender`
  --reference RUN   the same run without degradation, with the same motion of the hand: forces and pictures are compared with it.
                    Default: the folder `reference` beside a folder of `tactus rerender`
  --run N           number of the run, of logs with several; default: 1
  --tool N          number of the tool in the scene; default: the first of the table
  --pictures        also compares the videos (slow)
  --json FILE       also writes the metrics as JSON
  --csv FILE        also writes them as a table, one row for each run

Metrics: the largest median asynchrony of onsets, the age of information, the share of the time outside the just noticeable difference
of force, errors of time and value of force apart (ETVO-like), similarity of sensation (HSSIM-like) and of pictures (SSIM), and the energy that
the channel of touch has injected and generated. A metric without data is left out. scripts/python/tactus/metrics/README.md defines them.
"""
import argparse
import csv
import glob
import json
import os
import sys
import tempfile

from tactus import own_files, terminal
from tactus.log import description
from tactus.option_parser import OptionParser
from tactus.paths import packages_remedy
from tactus.refusal import Refusal, sentence_of
from tactus.tables import escaped


def arguments(words):
    parser = OptionParser(prog="tactus metrics", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", nargs="+", metavar="RUN")
    parser.add_argument("--reference", metavar="RUN")
    parser.add_argument("--run", dest="number", default="1", metavar="N")
    parser.add_argument("--tool", metavar="N")
    parser.add_argument("--pictures", action="store_true")
    parser.add_argument("--json", metavar="FILE")
    parser.add_argument("--csv", metavar="FILE")
    options = parser.parse_args(words)
    for path in [*options.run, *([options.reference] if options.reference else [])]:
        if not os.path.exists(path):
            raise Refusal(f"{path} does not exist; give the folder of a run, its run.lcmlog, or a folder of tactus rerender")
        if os.path.isdir(path) and not is_log(path) and not os.path.exists(os.path.join(path, "haptic.csv")):
            raise Refusal(f"{path} has neither a log nor a haptic.csv; give the folder of a run or of tactus rerender")
        if not os.path.isdir(path) and not is_log(path):
            raise Refusal(f"{path} is neither a file nor a folder; give the folder of a run, its run.lcmlog, or a folder of tactus rerender")
    for option, path in (("--csv", options.csv), ("--json", options.json)):
        own_files.require_writable(option, path, [*options.run, *([options.reference] if options.reference else [])])
    if description.run_number(options.number) is None:
        raise Refusal(f"--run {options.number}: is not the number of a run; give a whole number from 1, as in the column run of tactus export")
    return options


def is_log(path):
    return os.path.isfile(path) or bool(glob.glob(os.path.join(glob.escape(path), "run*.lcmlog")))


def read(path, scratch, number):
    """(folder of its tables, LogTables or None). A log is exported into the folder scratch."""
    from tactus.log import description, exported, log_tables
    if not is_log(path):
        return path, None
    folder = os.path.join(scratch, str(len(os.listdir(scratch))))
    exported.tables_of(path, folder, number, "LOG_INFO|DEGRADED|DEGRADATION")
    description.report_warnings(f"metrics: {path}", description.describe(path, number))
    return folder, log_tables.LogTables(folder, path)


def beside(path):
    """The folder of the reference of a folder of tactus rerender; None."""
    folder = os.path.join(os.path.dirname(os.path.abspath(path)), "reference")
    return folder if os.path.isdir(path) and not is_log(path) and os.path.exists(os.path.join(folder, "haptic.csv")) else None


def show(found, left_out):
    """left_out: {path: [reason]} of comparisons that were not made."""
    from tactus.metrics import of_run
    for path, metrics in found.items():
        print(terminal.one_line(path))
        for name, value in metrics.items():
            unit, meaning, _ = of_run.MEANING[name]
            print(f"  {name:22} {value:12.6g} {'' if unit == '1' else unit:4} {meaning}")
        if not metrics:
            print("  no data for any metric")
        for reason in left_out.get(path, []):
            print(terminal.one_line(f"  {reason}"))


def write(options, found):
    from tactus.metrics import of_run
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({"runs": found, "units": {name: of_run.MEANING[name][0] for name in of_run.MEANING}}, file, indent=1)
    if options.csv:
        with open(options.csv, "w", encoding="utf-8", newline="", errors="backslashreplace") as file:
            table = csv.DictWriter(file, ["run", *of_run.MEANING], lineterminator="\n")
            table.writeheader()
            table.writerows({"run": escaped(path), **metrics} for path, metrics in found.items())


def main(words):
    try:
        options = arguments(words)
        from tactus.metrics import of_run
        from tactus.rerender import read as rendered
        found, left_out = {}, {}
        with tempfile.TemporaryDirectory() as scratch:
            shared = read(options.reference, scratch, options.number)[0] if options.reference else None
            for path in options.run:
                folder, tables = read(path, scratch, options.number)
                found[path] = of_run.metrics(folder, shared or beside(path), tables, options.tool, rendered.pictures if options.pictures else None,
                                             left_out.setdefault(path, []).append)
        show(found, left_out)
        write(options, found)
    except Refusal as refusal:
        sys.exit(f"metrics: {refusal}")
    except ImportError as error:
        sys.exit(f"metrics: {error.name} is missing; {packages_remedy('report')}")
    except OSError as error:
        sys.exit(f"metrics: {sentence_of(error)}")
    return 0
