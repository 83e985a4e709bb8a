"""Scenes, motions and profiles of measure_rerun: hands whose impedance and intention are known."""
import dataclasses

import numpy as np

from tactus.rerun.hand_model import Hand

DT_S = 1e-3
SECONDS = 8.0
HANDS = {"stylus": (0.10, 10.0, 300.0), "light": (0.05, 5.0, 120.0), "arm": (0.8, 22.0, 300.0)}
WORLD = """<?xml version="1.0"?><sdf version="1.9" xmlns:tactus="https://tactus.dev/sdf"><world name="w"><gravity>0 0 -9.81</gravity>
<model name="board"><static>true</static><link name="l"><pose>0 0 -0.05 0 0 0</pose><tactus:surface material="oak"/>
<collision name="c"><geometry><box><size>0.8 0.8 0.1</size></box></geometry></collision></link></model>{body}
<tactus:tool name="hand" radius="8mm" mass="0.1kg" material="rubber" device="virtual_hand" loop="false">
<tactus:waypoint time="0s" position="0 0 0.04"/></tactus:tool></world></sdf>"""
BOX = """<model name="box"><pose>0.06 0 0.0302 0 0 0</pose><link name="l"><inertial><mass>0.25</mass><inertia><ixx>0.00015</ixx><iyy>0.00015</iyy><izz>0.00015</izz></inertia>
</inertial><tactus:surface material="oak"/><collision name="c"><geometry><box><size>0.06 0.2 0.06</size></box></geometry></collision></link></model>"""
# {name: (attributes of the rule, whether a hand with the intention of the log is expected to answer as the true one)}
PROFILES = {"gain 0.5": 'stage="force" gain="0.5"', "quantise 0.5 N": 'stage="force" quantise="0.5N"', "deadband 20 %": 'stage="force" deadband="20% force"',
            "force 2 ms late": 'stage="force" delay="2ms"', "force 5 ms late": 'stage="force" delay="5ms"', "force 20 ms late": 'stage="force" delay="20ms"',
            "model 10 ms late": 'stage="model" delay="10ms network"', "hand 10 ms late": 'stage="action" delay="10ms"', "off": 'stage="force" off="true"'}


@dataclasses.dataclass(frozen=True)
class Task:
    scene: str            # SDF text
    points: object        # rng -> [(duration s, (x, y, z) m)]


def taps(rng):
    points = [(0.3, (0, 0, 0.04))]
    while sum(t for t, _ in points) < SECONDS:
        points += [(rng.uniform(0.12, 0.3), (0, 0, rng.uniform(-0.012, 0.004))), (rng.uniform(0.12, 0.3), (0, 0, rng.uniform(0.02, 0.045))), (rng.uniform(0.05, 0.4), None)]
    return points


def presses(rng):
    points = [(0.3, (0, 0, 0.03))]
    while sum(t for t, _ in points) < SECONDS:
        depth = rng.uniform(-0.01, 0.005)
        points += [(rng.uniform(0.2, 0.5), (0, 0, depth)), (rng.uniform(0.2, 0.8), None), (rng.uniform(0.2, 0.4), (0, 0, depth - rng.uniform(-0.004, 0.006))),
                   (rng.uniform(0.1, 0.4), None), (rng.uniform(0.2, 0.4), (0, 0, 0.03))]
    return points


def strokes(rng):
    points, x = [(0.3, (-0.1, 0, 0.02))], -0.1
    while sum(t for t, _ in points) < SECONDS:
        points += [(0.3, (x, 0, rng.uniform(-0.004, 0.003)))]
        x = -x
        points += [(rng.uniform(0.5, 1.0), (x, 0, rng.uniform(-0.004, 0.003))), (0.25, (x, 0, 0.02))]
    return points


def pushes(rng):
    points = [(0.3, (-0.02, 0, 0.03))]
    for reach in np.sort(rng.uniform(0.03, 0.12, 6)):
        points += [(rng.uniform(0.4, 0.8), (reach, 0, 0.03)), (rng.uniform(0.1, 0.3), None), (rng.uniform(0.3, 0.5), (reach - 0.04, 0, 0.03))]
    return points


TASKS = {"taps": Task(WORLD.format(body=""), taps), "presses": Task(WORLD.format(body=""), presses), "strokes": Task(WORLD.format(body=""), strokes),
         "pushes of a box": Task(WORLD.format(body=BOX), pushes)}


def hand(name):
    return Hand(*HANDS[name], jerk=0, jumps=0)


def intention(task, rng):
    """(time s, positions (n, 3) m) of the intention: movements of minimum jerk (Flash and Hogan 1985) between the points of the task."""
    pieces, here = [], None
    for duration, point in task.points(rng):
        n = int(round(duration / DT_S))
        there = here if point is None else np.array(point, dtype=float)
        here = there if here is None else here
        s = np.arange(n) / n
        pieces.append(here + (10 * s**3 - 15 * s**4 + 6 * s**5)[:, None] * (there - here))
        here = there
    path = np.concatenate(pieces)[:int(round(SECONDS / DT_S))]
    return np.arange(len(path)) * DT_S, path


def profile(attributes):
    return f'<profile name="p"><degrade modality="haptic" {attributes}/></profile>'
