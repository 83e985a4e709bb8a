"""Does a lag of warmth delay the choice of the warm knob by the closed form of a first-order system? A falsifier of the study percept_limits.

The task knob_by_warmth is simulated once, and its warmth is rendered again with time constants (operator response). A person can choose when the plate is half
way from its rest to the temperature of the touched knob: the median of the undegraded plate in the second half of the touch. With a time constant T, a
first-order system goes from T_begin to T_knob as T_knob + (T_begin - T_knob) exp(-t / T), so that it is half way at t = T ln((T_begin - T_knob) / (T_half - T_knob))
after the contact. The falsifier holds when every measured time is within two ticks of the plate and a tenth of this time. Exit status: 0: it holds; 2: refuted; 1: no touch allowed a choice,
or an error.
"""
import argparse
import csv
import math
import pathlib
import sys
import tempfile

import numpy as np

from tactus import terminal
from tactus.information import percepts, rendering, task_file
from tactus.option_parser import OptionParser
from tactus.paths import BIN
from tactus.refusal import Refusal
from tactus.rerender import render

LAGS_MS = (200, 500, 1000)
TICKS, SHARE = 2, 0.1  # tolerance
REFUTED = 2


def plate(path):
    """(time s, commanded temperature degC, whether a knob is touched) of thermal.csv."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return np.array([float(r["host_s"]) for r in rows]), np.array([float(r["commanded_degC"]) for r in rows]), np.array([int(r["material"]) >= 0 for r in rows])


def touches(touched):
    """[(first, last)] indices of each touch."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], touched.astype(int), [0]])))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2])]


def expected_s(begin, knob, half, lag_s):
    """Time until a first-order system passes `half` on its way from `begin` to `knob`, s; 0 when it is beyond it already."""
    ratio = (begin - knob) / (half - knob)
    return lag_s * math.log(ratio) if ratio > 1 else 0.0


def measured_s(time, value, half, rising):
    """Time from the first sample until the value passes `half`, linear between two samples; NaN: never."""
    beyond = np.flatnonzero(value >= half if rising else value <= half)
    if not len(beyond):
        return math.nan
    i = int(beyond[0])
    if i == 0:
        return 0.0
    part = (half - value[i - 1]) / (value[i] - value[i - 1])
    return float(time[i - 1] + part * (time[i] - time[i - 1]) - time[0])


def choices(undegraded, lagged, lag_s):
    """Rows {lag_s, touch, knob_degC, expected_s, measured_s, holds} of one time constant, of touches in which a choice is possible and not yet made.
    undegraded: plate(); lagged: temperatures at the same times."""
    time, plain, touched = undegraded
    rest, tick, rows = float(plain[0]), float(np.median(np.diff(time))), []
    for number, (first, last) in enumerate(touches(touched), start=1):
        knob, begin = float(np.median(plain[(first + last) // 2:last + 1])), max(first - 1, 0)  # the lag acts on the touch from its first tick
        half = (rest + knob) / 2
        if half == knob:
            continue  # the touch is too short for the plate to move
        expected = expected_s(float(lagged[begin]), knob, half, lag_s)
        if expected == 0 or expected > time[last] - time[begin]:
            continue
        measured = measured_s(time[begin:last + 1], lagged[begin:last + 1], half, knob > rest)
        rows.append({"lag_s": lag_s, "touch": number, "knob_degC": knob, "expected_s": expected, "measured_s": measured,
                     "holds": abs(measured - expected) <= TICKS * tick + SHARE * expected})
    return rows


def rendered(log, folder, lag_ms):
    """plate() of a log under a time constant. Raises Refusal."""
    profile = None
    if lag_ms:
        profile = str(folder / "profile.xml")
        pathlib.Path(profile).write_text(f'<profile><degrade modality="thermal" response="{lag_ms}ms"/></profile>\n', encoding="utf-8")
    try:
        render.render(render.command(str(BIN), "thermal", str(log), str(folder), profile, None, {}), lambda _: None)
    except render.Refused as refused:
        raise Refusal(str(refused)) from None
    return plate(folder / "thermal.csv")


def run():
    """The rows of all time constants. Raises Refusal."""
    rendering.require_programs()
    task = task_file.read("knob_by_warmth")
    _, _, changes = next(iter(percepts.renderings(task)))
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        rendering.simulate(task_file.changed_scene(task.scene, changes), task.scene.parent, scratch / "run", task.seconds)
        of_lag = {}
        for lag_ms in (0, *LAGS_MS):
            folder = scratch / f"lag_{lag_ms}"
            folder.mkdir()
            of_lag[lag_ms] = rendered(scratch / "run" / "run.lcmlog", folder, lag_ms)
    if any(not np.array_equal(of_lag[0][0], other[0]) for other in of_lag.values()):
        raise Refusal("the renderings of one log have different times; run scripts/build")
    return [row for lag_ms in LAGS_MS for row in choices(of_lag[0], of_lag[lag_ms][1], lag_ms / 1000)]


def main(words):
    OptionParser(prog="tactus --module tactus.metrics.thermal_lag", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args(words)
    try:
        rows = run()
    except Refusal as refused:
        sys.exit(f"thermal_lag: {refused}")
    terminal.show(f"{'lag, s':>7} {'touch':>6} {'knob, degC':>11} {'expected, s':>12} {'measured, s':>12}  verdict")
    for row in rows:
        terminal.show(f"{row['lag_s']:7.1f} {row['touch']:6} {row['knob_degC']:11.2f} {row['expected_s']:12.3f} {row['measured_s']:12.3f}  {'holds' if row['holds'] else 'refuted'}")
    if not rows:
        sys.exit("thermal_lag: no touch allowed a choice, so nothing was measured; change the task knob_by_warmth back")
    holds = all(row["holds"] for row in rows)
    terminal.show("The falsifier thermal_lag " + ("holds." if holds else "is refuted."))
    return 0 if holds else REFUTED
