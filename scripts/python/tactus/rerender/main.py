"""Renders a recorded run again, once for each degradation profile, and prints the changes.

  tactus rerender LOG [--degrade PROFILE.xml]... [--only SENSE]... [--out DIR] [--json FILE]
  tactus rerender LOG --twice     renders twice and compares all bytes and pixels
  tactus rerender LOG --live      compares the log with the results of the run

  LOG          run.lcmlog of a run, or its folder: all parts of its recording. The profile of the run is not applied
  --run N      number of the run, of a log with several; default: 1
  --degrade    a profile (sync/degradation/README.md); "logged": the profile of the run
  --only       haptic, audio, visual or thermal; may be repeated; default: all four
  --out        new or empty folder (default: rerendered, beside LOG)
  --tool       tool of haptic and thermal (default: as live, the first of the scene)
  --set        SENSE:NAME=VALUE, a setting of one modality in all renderings: visual:width=320

DIR/reference is the rendering without a profile, DIR/PROFILE with one: audio.wav, video.mp4, haptic.csv and thermal.csv as in
the folder of a run, presented_SENSE.csv with the outcome of each event, frames.csv with the pixel hash of each frame.

Columns: presented events, events of the reference only (dropped) and of this rendering only (added), delay of the common events;
then for each modality the change against the reference:
  haptic   RMS and peak of the force difference; share of ticks with force in which it exceeds 7 and 10 % of the reference force
           (the just noticeable difference; below 0.5 N that of 0.5 N)
  audio    shift of clear onsets in the samples, level, share of different samples
  visual   different frames, mean and maximum CIEDE2000, share of their pixels above 1
  thermal  RMS and peak of the differences of skin temperature and of the command
The motion of the hand is that of the run; the log cannot show how it would have reacted to other forces.
Exit status 1: a modality could not be rendered; with --twice a difference; with --live an onset of sound that is off by more
than 1 ms.
"""
import argparse
import glob
import itertools
import json
import os
import sys
import time

from tactus import ending, own_files, terminal
from tactus.log import description
from tactus.option_parser import OptionParser
from tactus.paths import BIN, remedy
from tactus.rerender import changed, live, render

REFERENCE = "reference"
MAX_ONSET_SHIFT_MS = 1.0  # maximum shift of onsets, live and rerendered


def arguments(words):
    parser = OptionParser(prog="tactus rerender", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", metavar="LOG")
    parser.add_argument("--degrade", action="append", default=[], metavar="PROFILE.xml")
    parser.add_argument("--only", action="append", choices=list(render.SENSES))
    parser.add_argument("--out", metavar="DIR")
    parser.add_argument("--tool")
    parser.add_argument("--run", dest="run_number", default="1", metavar="N")
    parser.add_argument("--set", action="append", default=[], metavar="SENSE:NAME=VALUE")
    parser.add_argument("--twice", action="store_true", help="render the reference twice and compare all bytes")
    parser.add_argument("--live", action="store_true", help="compare with the results of the run")
    parser.add_argument("--json", metavar="FILE", help="also write the tables to FILE")
    options = parser.parse_args(words)
    refuse = lambda sentence: sys.exit(f"rerender: {sentence}")
    options.run = os.path.abspath(options.log) if os.path.isdir(options.log) else os.path.dirname(os.path.abspath(options.log))
    if not os.path.isfile(options.log) and not (os.path.isdir(options.log) and glob.glob(os.path.join(glob.escape(options.log), "run*.lcmlog"))):
        refuse(f"{options.log} is neither a log nor the folder of a run; give the run.lcmlog of a run, or its folder")
    if description.run_number(options.run_number) is None:
        refuse(f"--run {options.run_number}: is not the number of a run; give a whole number from 1, as in the column run of tactus export")
    options.out = options.out or os.path.join(options.run, "rerendered")
    if os.path.exists(options.out) and (not os.path.isdir(options.out) or os.listdir(options.out)):
        refuse(f"{options.out} exists and is not empty; remove it or give another --out")
    options.settings = {}
    for setting in options.set:
        sense, colon, rest = setting.partition(":")
        if sense not in render.SENSES or not colon or "=" not in rest:
            refuse(f'--set {setting}: is not SENSE:NAME=VALUE with one of {", ".join(render.SENSES)}')
        options.settings.setdefault(sense, []).append(rest)
    options.only = [s for s in render.SENSES if s in (options.only or render.SENSES)]
    options.profiles = profile_names(options.degrade, refuse)
    options.programs = str(BIN)
    for sense in options.only:
        if not os.access(os.path.join(options.programs, render.SENSES[sense][0]), os.X_OK):
            refuse(f"{render.SENSES[sense][0]} is missing; {remedy('--programs')}")
    return options


def profile_names(files, refuse):
    """{folder name: file} of the profiles; files of the same name get numbers."""
    profiles = {}
    for file in files:
        if file != "logged" and not os.path.isfile(file):
            refuse(f'--degrade {file}: is not a file; give the path of a profile (XML) or "logged"')
        stem = os.path.splitext(os.path.basename(file))[0]
        names = itertools.chain([stem], (f"{stem}_{n}" for n in itertools.count(2)))
        profiles[next(n for n in names if n not in profiles and n not in (REFERENCE, "again", "as_run"))] = file
    return profiles


class Renderings:
    """Executes the renderings one after the other and stores the output of the nodes."""

    def __init__(self, options, folders):
        self.options, self.folders = options, folders
        self.output, self.failed = {}, {}
        self.terminal = sys.stderr.isatty()

    def run(self):
        todo = [(name, sense) for name in self.folders for sense in self.options.only]
        for number, (name, sense) in enumerate(todo, 1):
            folder = os.path.join(self.options.out, name)
            os.makedirs(folder, exist_ok=True)
            words = render.command(self.options.programs, sense, self.options.log, folder, self.folders[name], self.options.tool,
                                   self.options.settings, self.options.run_number)
            head = f"rerender: {number} of {len(todo)}: {name}, {sense}"
            self.show_progress(head)
            try:
                self.output[name, sense] = render.render(words, lambda share, head=head: self.show_progress(f"{head}, {share} %", True))
            except render.Refused as e:
                self.failed[name, sense] = str(e)
                terminal.report_error(("\n" if self.terminal else "") + terminal.one_line(f"{head}: {e}"))
        if self.terminal:
            print(file=sys.stderr)

    def show_progress(self, text, passing=False):
        """Prints a progress line; on a terminal it overwrites the last one, elsewhere passing lines are skipped."""
        if self.terminal:
            print(f"\r\033[K{terminal.one_line(text)}", end="", file=sys.stderr, flush=True)
        elif not passing:
            terminal.report_refusal(text)

    def facts(self, name, sense):
        return render.facts(self.output[name, sense])

    def done(self, name, sense):
        return (name, sense) in self.output

    def first_ns(self, *names):
        return tuple(self.facts(name, "audio")["first_sample_ns"] for name in names)


def compare_all(renderings, options):
    """Yields a row for each modality and profile."""
    for sense in options.only:
        for name in options.profiles:
            if renderings.done(REFERENCE, sense) and renderings.done(name, sense):
                renderings.show_progress(f"rerender: compares {name}, {sense}", True)
                folders = [os.path.join(options.out, n) for n in (REFERENCE, name)]
                first = renderings.first_ns(REFERENCE, name) if sense == "audio" else None
                yield {"sense": sense, "profile": name, **changed.changed(sense, *folders, first), **renderings.facts(name, sense)}


def number(value, digits=2):
    return "-" if value is None else f"{value:.{digits}f}"


def percent(share):
    return f"{100 * share:.1f}"


# (title, cell) of the additional columns of each modality.
COLUMNS = {
    "haptic": [("differs by RMS N", lambda r: number(r["difference_rms_N"], 3)), ("peak N", lambda r: number(r["difference_peak_N"])),
               ("beyond 7 %", lambda r: percent(r["beyond_7_percent"]) + " %"), ("10 %", lambda r: percent(r["beyond_10_percent"]) + " %")],
    "audio": [("heard later p50", lambda r: number(r["heard_shift_p50_ms"])), ("p99 ms", lambda r: number(r["heard_shift_p99_ms"])),
              ("of", lambda r: str(r["onsets_found"])), ("level dB", lambda r: number(r["level_dB"])),
              ("samples differ", lambda r: percent(r["samples_differ"]) + " %")],
    "visual": [("frames differ", lambda r: f'{r["frames_differ"]} of {r["frames"]}'), ("CIEDE2000", lambda r: number(r["mean_CIEDE2000"])),
               ("worst", lambda r: number(r["worst_CIEDE2000"])), ("pixels seen", lambda r: percent(r["pixels_seen_to_differ"]) + " %")],
    "thermal": [("skin RMS K", lambda r: number(r["skin_rms_K"], 3)), ("peak K", lambda r: number(r["skin_peak_K"])),
                ("command RMS K", lambda r: number(r["command_rms_K"], 3)), ("peak K", lambda r: number(r["command_peak_K"]))],
}
COMMON_COLUMNS = [("presented", lambda r: str(r["presented"])), ("dropped", lambda r: str(r["dropped"])), ("added", lambda r: str(r["added"])),
          ("later p50", lambda r: number(r["shift_p50_ms"])), ("p99 ms", lambda r: number(r["shift_p99_ms"]))]


def show(head, lines):
    """Prints a table with fitted columns, the first left-aligned."""
    widths = [max(len(line[i]) for line in [head, *lines]) for i in range(len(head))]
    for line in [head, *lines]:
        terminal.show("  ".join(cell.ljust(w) if i == 0 else cell.rjust(w) for i, (cell, w) in enumerate(zip(line, widths))))


def print_changes(rows):
    for sense in render.SENSES:
        mine = [r for r in rows if r["sense"] == sense]
        columns = COMMON_COLUMNS + COLUMNS[sense]
        if mine:
            print()
            show([sense, *(title for title, _ in columns)], [[r["profile"], *(cell(r) for _, cell in columns)] for r in mine])


def print_renderings(renderings, options):
    lines = []
    for name, sense in itertools.product(renderings.folders, options.only):
        if renderings.done(name, sense):
            f = renderings.facts(name, sense)
            lines.append([f"{name}, {sense}", number(f["took_s"]), number(f["times_as_fast_as_time"], 1)])
        else:
            lines.append([f"{name}, {sense}", "not rendered:", renderings.failed[name, sense]])
    show(["rendered", "in s", "times real time"], lines)


def compare_twice(renderings, options):
    rows = []
    for sense in options.only:
        if renderings.done(REFERENCE, sense) and renderings.done("again", sense):
            rows.append({"sense": sense, **changed.same_bytes(sense, *(os.path.join(options.out, n) for n in (REFERENCE, "again")))})
    print()
    show(["rendered twice", "bytes", "compared", "result"],
         [[r["sense"], str(r["bytes"]), ", ".join(r["compared"]), "differ: " + ", ".join(r["differ"]) if r["differ"] else "the same"] for r in rows])
    return rows


def against_live(renderings, options):
    run, rows = options.run, []
    for sense in options.only:
        if renderings.done("as_run", sense):
            first = renderings.first_ns("as_run")[0] if sense == "audio" else None
            rows += live.against_live(sense, run, os.path.join(options.out, "as_run"), first)
    print()
    if not rows:
        terminal.show(f"live: {run} has no results of the run")
        return rows
    show(["live and again", "n", "p50", "p99", "most", "unit", "what"],
         [[r["sense"], str(r["n"]), *(number(r[k], 4) for k in ("p50", "p99", "max")), r["unit"], r["what"] + (f' ({r["note"]})' if r["note"] else "")]
          for r in rows])
    return rows


def main(words):
    return ending.status("rerender", lambda: rerender(words))


def rerender(words):
    options = arguments(words)
    begin = time.monotonic()
    folders = {REFERENCE: None, **options.profiles}
    if options.twice:
        folders["again"] = None
    if options.live:
        folders["as_run"] = "logged"
    description.report_warnings("rerender", description.describe(options.log, options.run_number))
    renderings = Renderings(options, folders)
    with own_files.results_folder(options.out):
        renderings.run()
    result = {"log": os.path.abspath(options.log), "out": os.path.abspath(options.out), "profiles": options.profiles}
    result["changed"] = list(compare_all(renderings, options))
    if renderings.terminal:
        print("\r\033[K", end="", file=sys.stderr)
    print_renderings(renderings, options)
    print_changes(result["changed"])
    result["not_rendered"] = [{"profile": n, "sense": s, "why": why} for (n, s), why in renderings.failed.items()]
    if options.twice:
        result["twice"] = compare_twice(renderings, options)
    if options.live:
        result["live"] = against_live(renderings, options)
    terminal.show(f"\nrerender: results in {options.out}, after {time.monotonic() - begin:.0f} s")
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(result, file, indent=2)
    late = [r for r in result.get("live", []) if r["what"].startswith("onsets") and r["n"] and r["max"] > MAX_ONSET_SHIFT_MS]
    return 1 if renderings.failed or late or any(r["differ"] for r in result.get("twice", [])) else 0

