"""Runs the scene of a log in virtual time with a simulated hand in place of the recorded one."""
import json
import os
import pathlib

import numpy as np

from tactus.launch import arguments, cluster, hands, scene as scene_file, virtual
from tactus.launch.results import git_commit
from tactus.paths import BIN
from tactus.refusal import Refusal
from tactus.rerun import recording

# A virtual hand begins its path at the simulated instant of the first touch model: the end of the first step of the world (haptic_node/README.md).
PATH_BEGINS_S = 0.001
DEVICE, OWN_DELAY_S = "rerun", 0.001  # rerun_hand applies a force in its next tick (scripts/virtual_time/rerun_hand.cpp)
STAYS_S = 1e5  # the hand stays at the end of its path
RENDERERS = ("audio_node", "visual_node", "thermal_node")
SLOWEST_POLICIES = ("aligned", "itouch2005")  # hit transients of touch wait for the other modalities


def write_motion(path, time_s, position_m, begins_s=PATH_BEGINS_S):
    """Writes a motion file: an intention from the beginning of the world, which stays at its ends. begins_s: simulated time at the time 0 of the file.
    Raises OSError."""
    rows = np.column_stack([time_s - begins_s, position_m])
    rows = rows[rows[:, 0] >= 0]
    if rows[0, 0] > 0:
        rows = np.vstack([[0.0, *rows[0, 1:]], rows])
    rows = np.vstack([rows, [rows[-1, 0] + STAYS_S, *rows[-1, 1:]]])
    with open(path, "w", encoding="ascii") as file:
        file.write("time_s,x_m,y_m,z_m\n")
        file.writelines("%.9f,%.12g,%.12g,%.12g\n" % tuple(row) for row in rows)


def words_of(scene, record, hand, motion, profile, settings, seconds, out):
    """Arguments of tactus run for one rerun. hand: a hand_model.Hand; motion: file of its intention; profile: a file, or None."""
    words = [str(scene), "--virtual-time", "--seconds", f"{seconds:.3f}", "--seed", str(record.seed), "--out", str(out)]
    own = []
    if not record.external:
        process = hands.FIRST if record.first_tool else next(p for p, tool in hands.processes(scene_file.tools(pathlib.Path(scene))).items() if tool == record.name)
        own = [f"{process}.hand_mass={hand.mass_kg:.9g}", f"{process}.hand_damping={hand.damping_N_s_m:.9g}", f"{process}.hand_stiffness={hand.stiffness_N_m:.9g}"]
        words += ["--device", f"{record.name}=virtual_hand:{motion}"]
    words += [w for s in (*own, *settings) for w in ("--set", s)]
    if record.policy in SLOWEST_POLICIES:
        words += ["--policy", record.policy]
    else:
        words += [w for node in RENDERERS for w in ("--without", node)]
    return words + (["--degrade", str(profile)] if profile else [])


def user_command(record, hand, motion, log, run, plan):
    """Command line of rerun_hand, which holds an external device and repeats the commands of the log; None: neither is needed."""
    words = []
    if record.external:
        words += ["--device", DEVICE, "--motion", str(motion), "--mass", f"{hand.mass_kg:.9g}", "--damping", f"{hand.damping_N_s_m:.9g}",
                  "--stiffness", f"{hand.stiffness_N_m:.9g}", "--force-delay", f"{max(0.0, hand.delay_s - OWN_DELAY_S):.9g}"]
    if record.commands:
        words += ["--commands", str(log), "--run", str(run)]
    return ["rerun_hand", *words, *cluster.common(plan, plan.seed + 1)] if words else None


def play(words, record, hand=None, motion=None, log=None, run=1):
    """Executes a rerun; returns (time, positions, forces) of the hand. words: from words_of(). The log stays in the folder of --out.
    Raises Refusal, OSError."""
    plan = arguments.parse(words, os.getcwd())
    if record.external:
        plan.devices["" if record.first_tool else record.name] = f"external:{DEVICE}"
    os.makedirs(plan.out, exist_ok=True)
    (plan.out / "logs").mkdir(exist_ok=True)
    commands = virtual.commands(plan, git_commit())
    if user := user_command(record, hand, motion, log, run, plan):
        commands["rerun_hand"] = user
    file = plan.out / "logs" / "virtual_time.json"
    file.write_text(json.dumps({name: [*map(virtual.as_json, command)] for name, command in commands.items()}, indent=1) + "\n", encoding="utf-8")
    try:
        recording.run_program([BIN / "virtual_time", file, "--seconds", f"{plan.seconds:g}", "--seed", str(plan.seed), *plan.virtual])
    except Refusal as refusal:
        raise Refusal(f"the scene cannot be run again: {refusal}") from None
    recording.run_program([BIN / "export_csv", plan.out, "--out", plan.out, "--quiet"])
    time_s, position_m, force_N = recording.rows_of(plan.out / "haptic.csv", str(record.tool))
    if len(time_s) < 2:
        raise Refusal(f"{plan.out}: the rerun has no motion of the hand; see {plan.out}/logs")
    return time_s, position_m, force_N


def at(times, time_s, values):
    """Values (n, 3) of a rerun at the times of the log; the ticks of both are those of the same clock, so that most agree."""
    return np.column_stack([np.interp(times, time_s, values[:, axis]) for axis in range(values.shape[1])])
