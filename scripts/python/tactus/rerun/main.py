"""Runs the scene of a log again with the hand of the log, in closed loop, under another degradation profile.

  tactus rerun LOG --degrade PROFILE.xml... [--out DIR] [--draws N] [--seed N] [--json FILE]

  LOG          run.lcmlog of a run, or its folder: all parts of its recording
  --degrade    a profile (sync/degradation/README.md); may be repeated; without it only the profile of the log
  --out        new or empty folder (default: rerun, beside LOG)
  --draws      simulated hands for each profile: default 8
  --tool       tool of the scene whose hand is fitted; default: the first
  --scene      SDF world of the log; default: that of the run
  --set        NODE.NAME=VALUE, a setting that the run had; may be repeated
  --run N      number of the run, of a log with several; default: 1
  --seed       seed of the draws; default: 1

Fits mass, damping and stiffness of the hand, and its intention: the path that it follows without force. Then the scene runs in virtual time with
hands drawn from the fit, once under the profile of the log, and once under each other profile. Such a hand yields to the new forces;
`tactus rerender` keeps the recorded motion.

DIR/hand.json holds the fit; DIR/intention.csv the intention with its 95 % interval; DIR/as_logged.csv and DIR/PROFILE.csv the
median and the 95 % interval of force and position beside those of the log; DIR/runs the log of each run, for rerender and report.

Columns: share of the ticks with force in which the median of the draws is within 10 % of the recorded force (the just noticeable difference;
below 0.5 N that of 0.5 N); RMS and peak of the difference of force; RMS of the difference of position; share of these ticks in which the
interval of the draws is wider than the just noticeable difference.
The intention is that of the log: a person who notices the profile changes it, and no log can show how.
"""
import argparse
import dataclasses
import glob
import itertools
import json
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the matrices are small

import numpy as np

from tactus import ending, own_files, tables, terminal
from tactus.log import description
from tactus.option_parser import OptionParser
from tactus.paths import BIN, remedy
from tactus.refusal import Refusal
from tactus.rerun import comparison, play, recording

AS_LOGGED = "as_logged"
UNKNOWN = ("the hand touches nothing in this log, so its impedance is unknown: the hands are drawn from the population (hands that hold a stylus, and arms), "
           "and only their spread is a result")
REPRODUCED = 0.95  # design: below this share the fit does not explain the log
STIFF_N_M, HEAVY_KG = 4000.0, 4.0  # near the limits of the virtual hand: the device did not yield
PROGRAMS = ("replay", "export_csv", "export_log", "virtual_time", "sync_node")


def arguments(words):
    parser = OptionParser(prog="tactus rerun", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", metavar="LOG")
    parser.add_argument("--degrade", action="append", default=[], metavar="PROFILE.xml")
    parser.add_argument("--out", metavar="DIR")
    parser.add_argument("--draws", default="8", metavar="N")
    parser.add_argument("--tool")
    parser.add_argument("--scene", metavar="FILE")
    parser.add_argument("--set", action="append", default=[], metavar="NODE.NAME=VALUE")
    parser.add_argument("--run", dest="run_number", default="1", metavar="N")
    parser.add_argument("--seed", default="1", metavar="N")
    parser.add_argument("--json", metavar="FILE", help="also write the figures to FILE")
    options = parser.parse_args(words)
    if not os.path.isfile(options.log) and not (os.path.isdir(options.log) and glob.glob(os.path.join(glob.escape(options.log), "run*.lcmlog"))):
        raise Refusal(f"{options.log} is neither a log nor the folder of a run; give the run.lcmlog of a run, or its folder")
    if description.run_number(options.run_number) is None:
        raise Refusal(f"--run {options.run_number}: is not the number of a run; give a whole number from 1, as in the column run of tactus export")
    for name, least, most in (("draws", 1, 200), ("seed", 0, 2**63 - 1)):
        text = getattr(options, name)
        value = tables.whole_number(text, least, most)
        if value is None:
            raise Refusal(f"--{name} {text}: give a whole number from {least} to {most}")
        setattr(options, name, value)
    beside = options.log if os.path.isdir(options.log) else os.path.dirname(os.path.abspath(options.log))
    options.out = options.out or os.path.join(beside, "rerun")
    if os.path.exists(options.out) and (not os.path.isdir(options.out) or os.listdir(options.out)):
        raise Refusal(f"{options.out} exists and is not empty; remove it or give another --out")
    options.profiles = profile_names(options.degrade)
    for program in PROGRAMS:
        if not os.access(BIN / program, os.X_OK):
            raise Refusal(f"{BIN / program} is missing; {remedy('--programs')}")
    for file in options.profiles.values():
        recording.run_program([BIN / "sync_node", "--check", "--degrade", file])
    return options


def profile_names(files):
    """{name: file} of the profiles; files of the same name get numbers. Raises Refusal."""
    profiles = {}
    for file in files:
        if not os.path.isfile(file):
            raise Refusal(f"--degrade {file}: is not a file; give the path of a profile (XML)")
        stem = os.path.splitext(os.path.basename(file))[0]
        names = itertools.chain([stem], (f"{stem}_{n}" for n in itertools.count(2)))
        profiles[next(n for n in names if n not in profiles and n not in (AS_LOGGED, "intention", "runs", "hand"))] = os.path.abspath(file)
    return profiles


def notes_of(record, posterior, figures):
    """Sentences about the limits of this result. figures: {name: figures of the reruns}."""
    notes = [] if posterior.contact else [UNKNOWN]
    if record.gap_s > recording.GAP_S:
        notes.append(f"the motion of the hand has gaps of up to {1e3 * record.gap_s:.0f} ms, which are interpolated")
    if posterior.contact and (posterior.best.stiffness_N_m > STIFF_N_M or posterior.best.mass_kg > HEAVY_KG):
        notes.append("the fitted hand hardly yields to the force: the log is that of a playback, or its intention answered the force or the motion of the hand, "
                     "as that of the simulated player; the impedance is not that of the arm")
    reproduced = figures[AS_LOGGED]["within_10_percent"]
    if reproduced < REPRODUCED:
        notes.append(f"under the profile of the log, the reruns agree with the log in {100 * reproduced:.0f} % of the ticks with force, so do not use the other rows: "
                     "the world is chaotic, its settings differ (--set), or the hand does not fit")
    return notes


def draw_hands(record, posterior, count, rng):
    """[(Hand, intention (n, 3))]: hands drawn from the fit, each with its own intention. Mass, damping and stiffness may vary; the motion stays that
    of the log under the recorded force."""
    chosen = [posterior.hands[i] for i in rng.choice(len(posterior.hands), count, replace=count > len(posterior.hands))]
    from tactus.rerun import hand_model  # loads slowly
    return [(hand, hand_model.drawn_intention(hand, record.position_m, record.force_N, record.dt_s, rng)) for hand in chosen]


def rerun_all(options, record, scene, drawn, profiles):
    """{name: (forces (draws, n, 3), positions (draws, n, 3))} of the reruns under each profile, at the times of the log from 0. profiles: {name: file or None}."""
    found, motions, times = {}, [], record.time_s[record.time_s >= 0]
    folder = os.path.join(os.path.abspath(options.out), "runs")
    os.makedirs(folder)
    for number, (_, intention) in enumerate(drawn, 1):
        motions.append(os.path.join(folder, f"intention_{number}.csv"))
        play.write_motion(motions[-1], record.time_s, intention, 0.0 if record.external else play.PATH_BEGINS_S)
    seconds = max(1.0, float(record.time_s[-1]) + 0.05)
    for name, profile in profiles.items():
        forces, positions = [], []
        for number, ((hand, _), motion) in enumerate(zip(drawn, motions), 1):
            terminal.report_refusal(f"rerun: {name}, hand {number} of {len(drawn)}")
            out = os.path.join(folder, name, str(number))
            words = play.words_of(scene, record, hand, motion, profile, options.set, seconds, out)
            time_s, position_m, force_N = play.play(words, record, hand, motion, options.log, options.run_number)
            forces.append(play.at(times, time_s, force_N))
            positions.append(play.at(times, time_s, position_m))
        found[name] = np.array(forces), np.array(positions)
    return found


def write_table(path, times_s, bands):
    """Writes a table with time_s and, for each name of bands {name_unit: (recorded, (median, lower, upper))}, its columns for x, y, z. Raises OSError."""
    names, columns = ["time_s"], [times_s]
    for name, (recorded, parts) in bands.items():
        quantity, _, unit = name.rpartition("_")
        for label, values in (("recorded", recorded), *zip(("median", "low", "high"), parts)):
            for i, axis in enumerate("xyz"):
                names.append(f"{quantity}_{axis}_{label}_{unit}")
                columns.append(values[:, i])
    np.savetxt(path, np.column_stack(columns), fmt="%.9g", delimiter=",", header=",".join(names), comments="")


def hand_figures(posterior):
    """The fit as JSON: median and 95 % interval of each parameter."""
    from tactus.rerun import identify
    intervals = {name: dict(zip(("median", "low", "high"), posterior.interval(name))) for name in (*identify.POPULATION, "delay_s", "noise_m", "jerk", "jumps")}
    return {"contact": posterior.contact, **intervals, "most_probable": dataclasses.asdict(posterior.best)}


def print_results(hand, figures, notes):
    print(f"{'hand':16}{'median':>9}   95 % interval")
    for name, unit in (("mass_kg", "kg"), ("damping_N_s_m", "N s/m"), ("stiffness_N_m", "N/m")):
        print(f"{name.split('_')[0] + ', ' + unit:16}{hand[name]['median']:9.3g}   {hand[name]['low']:.3g} to {hand[name]['high']:.3g}")
    print(f"\n{'profile':16}{'within 10 %':>12}{'RMS N':>9}{'peak N':>9}{'position mm':>13}{'wide interval':>15}")
    for name, f in figures.items():
        terminal.show(f"{name:16}{100 * f['within_10_percent']:10.1f} %{f['difference_rms_N']:9.3f}{f['difference_peak_N']:9.2f}"
              f"{1e3 * f['position_rms_m']:13.2f}{100 * f['spread_beyond_10_percent']:13.1f} %")
    for note in notes:
        terminal.show(f"\nNote: {note}.")


def rerun(words):
    options = arguments(words)
    record = recording.read(options.log, options.tool, options.run_number)
    scene = recording.scene_of(options.log, record.scene, options.scene)
    from tactus.rerun import identify  # loads slowly
    rng = np.random.default_rng(options.seed)
    try:
        posterior = identify.fit(record.position_m, record.force_N, record.dt_s, rng, record.external)
    except ValueError as error:
        raise Refusal(f"{options.log}: {error}; give a log in which it moves, or another --tool") from None
    drawn = draw_hands(record, posterior, options.draws, rng)
    with own_files.results_folder(options.out):
        profiles = {AS_LOGGED: None, **options.profiles}
        if record.profile:
            profiles[AS_LOGGED] = os.path.join(os.path.abspath(options.out), "as_logged.xml")
            with open(profiles[AS_LOGGED], "w", encoding="utf-8") as file:
                file.write(record.profile)
        found = rerun_all(options, record, scene, drawn, profiles)
        world = record.time_s >= 0
        times, force_N, position_m = record.time_s[world], record.force_N[world], record.position_m[world]
        figures = {}
        for name, (forces, positions) in found.items():
            figures[name] = comparison.figures(force_N, position_m, forces, positions)
            write_table(os.path.join(options.out, f"{name}.csv"), times, {"force_N": (force_N, comparison.band(forces)),
                                                                         "device_m": (position_m, comparison.band(positions))})
        write_table(os.path.join(options.out, "intention.csv"), record.time_s,
                    {"intention_m": (record.position_m, comparison.band(np.array([r for _, r in drawn])))})
        hand, notes = hand_figures(posterior), notes_of(record, posterior, figures)
        result = {"log": os.path.abspath(options.log), "scene": str(scene), "profiles": options.profiles, "hand": hand, "notes": notes, "figures": figures}
        with open(os.path.join(options.out, "hand.json"), "w", encoding="utf-8") as file:
            json.dump({**hand, "notes": notes}, file, indent=1)
    print_results(hand, figures, notes)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(result, file, indent=1)
    return 0


def main(words):
    return ending.status("rerun", lambda: rerun(words))
