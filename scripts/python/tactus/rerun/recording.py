"""Reads the hand of a log: its motion, the displayed forces, and the circumstances of the run."""
import dataclasses
import json
import os
import pathlib
import subprocess
import tempfile

import numpy as np

from tactus import own_files, tables
from tactus.log import description
from tactus.log.log_tables import LogTables
from tactus.paths import BIN, SCENES, remedy
from tactus.refusal import Refusal, reason_of

CHANNELS = "LOG_INFO|DEGRADATION|PLAYOUT|SIM_COMMAND|DEVICE_FORCE"
SHORTEST_S, LONGEST_S = 1.0, 1800.0  # design: a contact with its approach; the size of the motion file
LOST = ("none", "stale")  # status of the touch model without a world
BEFORE_S = 0.3     # design: the hand before the world, from which its motion at the start follows
GAP_S = 0.02       # design: longer gaps of the record are reported
LARGEST_SUMMARY_BYTES = 10_000_000  # design
EVEN = 0.02        # ticks whose spacing varies by less than this share of it are even


@dataclasses.dataclass
class Recording:
    """The hand of one tool. One row a tick; time_s: simulated time, negative before the world."""
    tool: int
    name: str            # of the tool
    first_tool: bool
    time_s: np.ndarray   # (n,)
    position_m: np.ndarray  # (n, 3)
    force_N: np.ndarray  # (n, 3), on the hand
    dt_s: float
    external: bool       # another program held the device
    commands: int        # messages to the simulation in the log
    profile: str         # XML of the profile of the run; "": none
    policy: str          # playout policy; "": not known
    scene: str           # file name in the log
    seed: int
    gap_s: float         # longest gap between two ticks


def run_program(words):
    """Runs a program of the build. Raises Refusal when it fails, with its reason."""
    if not os.access(words[0], os.X_OK):
        raise Refusal(f"{words[0]} is missing; {remedy('--programs')}")
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, errors="replace", check=False)
    if done.returncode != 0:
        raise Refusal(reason_of(done.stderr) or f"{words[0]} ended with status {done.returncode} without a message")


def rows_of(path, tool):
    """(time, positions, forces) of one tool in haptic.csv, in the order of the ticks. The last BEFORE_S before the world have negative times;
    those after it are left out. tool: its number."""
    found = [[float(row["time_s"] or "nan"), float(row["host_s"]), *(float(row[f"device_{a}_m"]) for a in "xyz"), *(float(row[f"force_{a}_N"]) for a in "xyz"),
              row["touch_status"] not in LOST] for row in tables.read_rows(path) if row["tool"] == tool and row["host_s"]]
    data = np.array(found).reshape(-1, 9)
    data = data[np.argsort(data[:, 1], kind="stable")]
    data = data[:np.max(np.flatnonzero(data[:, 8]), initial=-1) + 1]  # at the end of a run the world stops first
    world = np.flatnonzero(np.isfinite(data[:, 0]))
    if len(world) == 0:
        return np.empty(0), np.empty((0, 3)), np.empty((0, 3))
    first = world[0]
    data[:first, 0] = data[:first, 1] - data[first, 1] + data[first, 0]
    data = data[np.isfinite(data[:, 0]) & (data[:, 0] > -BEFORE_S)]
    later = np.concatenate([[True], np.diff(np.maximum.accumulate(data[:, 0])) > 0])
    data = data[later]
    return data[:, 0], data[:, 2:5], data[:, 5:8]


def even_ticks(time_s, position_m, force_N):
    """(time, positions, forces, dt) at equal distances: as they are if they are even, otherwise positions by a cubic and forces held."""
    steps = np.diff(time_s)
    dt_s = float(np.median(steps))
    if np.all(np.abs(steps - dt_s) < EVEN * dt_s):
        return time_s, position_m, force_N, float(np.mean(steps))
    even = np.arange(time_s[0], time_s[-1], dt_s)
    held = np.clip(np.searchsorted(time_s, even, side="right") - 1, 0, len(time_s) - 1)
    from scipy import interpolate  # loads slowly
    return even, interpolate.CubicSpline(time_s, position_m)(even), force_N[held], dt_s


def hand_of(path, tool):
    """(time, positions, forces, dt, longest gap) of a tool in the haptic.csv of a run. Raises Refusal without a hand."""
    time_s, position_m, force_N = rows_of(path, tool)
    if len(time_s) < 2:
        raise Refusal("the log has no motion of this hand; give a log of a run with a haptic_node, or another --tool")
    gap_s = float(np.max(np.diff(time_s)))
    time_s, position_m, force_N, dt_s = even_ticks(time_s, position_m, force_N)
    return time_s, position_m, force_N, dt_s, gap_s


def read(log, tool, run):
    """Reads a log, or the folder of one. tool: its name; None: the first. run: its number in the log. Raises Refusal."""
    described = description.describe(log, run)
    names = described["tools"]
    if not names:
        raise Refusal(f"{log} has no scene with a tool; give the log of a run that recorded its scene")
    if tool is not None and tool not in names:
        raise Refusal(f"--tool {tool}: the scene of the log has no such tool; it has {', '.join(names)}")
    number = names.index(tool) if tool is not None else 0
    with tempfile.TemporaryDirectory() as folder:
        run_program([BIN / "export_csv", log, "--out", folder, "--quiet", "--run", str(run)])
        run_program([BIN / "export_log", log, "--out", folder, "--quiet", "--run", str(run), "--channels", CHANNELS])
        pathlib.Path(folder, "summary.json").write_text("{}", encoding="utf-8")
        time_s, position_m, force_N, dt_s, gap_s = hand_of(os.path.join(folder, "haptic.csv"), str(number))
        others = LogTables(folder, "log")
        profile = others.profile()
        commands = len({row["value"] for row in others.rows("SIM_COMMAND.csv", ",id,")})
        external = others.has("DEVICE_FORCE.csv")
        policy = others.policy() or ""
    if not SHORTEST_S <= time_s[-1] - time_s[0] <= LONGEST_S:
        raise Refusal(f"the hand moves for {time_s[-1] - time_s[0]:.3g} s in {log}; give a log of {SHORTEST_S:g} to {LONGEST_S:g} s")
    description.report_warnings("rerun", described)
    return Recording(number, names[number], number == 0, time_s, position_m, force_N, dt_s, external, commands, profile[0] if profile else "", policy,
                     described.get("scene", ""), int(described.get("seed", 0)), gap_s)


def scene_of(log, name, given):
    """The file of the scene: --scene, that of the summary of the run, or the shipped one of this name. Raises Refusal."""
    folder = log if os.path.isdir(log) else os.path.dirname(os.path.abspath(log))
    if given:
        if not os.path.isfile(given):
            raise Refusal(f"--scene {given}: is not a file; give the SDF world of the log")
        return os.path.abspath(given)
    try:
        text = json.loads(own_files.read_regular(os.path.join(folder, "summary.json"), LARGEST_SUMMARY_BYTES))["scene"]
    except (OSError, ValueError, RecursionError, KeyError, TypeError):
        text = ""
    for path in (text if isinstance(text, str) else "", os.path.join(folder, name), SCENES / name):
        if name and path and os.path.isfile(path) and os.path.basename(path) == name:
            return os.path.abspath(path)
    raise Refusal(f"the scene {name or 'of the log'} is not found; give its SDF world with --scene")
