"""Features of touch and warmth that a run presented: force, direction, stiffness, vibration, place of the hand, heat flow."""
import math
import os

import numpy as np

from tactus.information import noise
from tactus.refusal import Refusal
from tactus.tables import read_rows

CONTACT_S = 1.0  # of a touch whose heat flow is judged: the initial rate is the main cue (Bergmann Tiest and Kappers 2009)
MIN_TRAVEL_M = 1e-3  # of the hand, for a stiffness; design
MIN_RATE_S = 0.1     # of a change of temperature; design


def columns(path, *names):
    """Columns of the first tool in a table of touch or warmth, with rows of the world only."""
    rows = [row for row in read_rows(path) if row["time_s"] and row["tool"] == "0"]
    if not rows:
        raise Refusal(f"the first tool has no row in {os.path.basename(path)}, so nothing is felt; give a scene with a <tactus:tool>")
    return [np.array([float(row[name]) for row in rows]) for name in names]


class Touch:
    """haptic.csv of a run."""

    def __init__(self, path, offset_ns=None):
        """offset_ns: host time minus time of the world; None: a tick has the time of the world that it shows."""
        names = [f"{what}_{axis}_{unit}" for what, unit in (("device", "m"), ("force", "N"), ("transient", "N")) for axis in "xyz"]
        self.time, self.host, *rest = columns(path, "time_s", "host_s", *names)
        if offset_ns is not None:
            self.time = self.host - offset_ns * 1e-9
        self.place, self.force, self.transient = (np.stack(rest[i:i + 3], axis=1) for i in (0, 3, 6))

    def offset_ns(self):
        """Host time minus time of the world, ns."""
        return float(np.median(self.host - self.time)) * 1e9

    def features(self, begin_s, end_s):
        """[(name, values, standard deviations, share of confused percepts)] of one window."""
        n = noise.values()
        inside = (self.time >= begin_s) & (self.time < end_s)
        time, force, place = self.time[inside], self.force[inside], self.place[inside]
        size = np.linalg.norm(force, axis=1)
        felt = size >= n["force_floor"]
        confused = noise.confusion(n["vibration_material_right"], 3)
        if not felt.any():
            return [("felt", [0.0], [0.01], 0.0), ("force", [0.0], [1.0], 0.0), ("direction", [0.0] * 3, [1.0] * 3, 0.0), ("stiffness", [0.0], [1.0], 0.0),
                    ("onset", [0.0], [1.0], 0.0), ("vibration", [0.0], [1.0], confused)]
        mean = force[felt].mean(axis=0)
        direction = mean / max(float(np.linalg.norm(mean)), 1e-9)
        turned = math.sin(math.radians(n["force_direction"])) / math.sqrt(2)  # of each axis across it; along it the same, which changes little
        onset = float(time[felt][0] - begin_s)
        return [("felt", [1.0], [0.01], 0.0), ("force", [math.log(float(size[felt].mean()))], [noise.weber_sd(n["force"])], 0.0),
                ("direction", list(direction), [turned] * 3, 0.0),
                ("stiffness", [stiffness_log(size[felt], place[felt] @ direction)], [noise.weber_sd(n["stiffness"])], 0.0),
                ("onset", [onset], [math.hypot(n["touch_onset"] * 1e-3, n["duration"] * onset)], 0.0),
                ("vibration", [vibration_log(self.transient[inside] @ direction, n["force_floor"], float(np.median(np.diff(time))) if len(time) > 1 else 1e-3)], [noise.weber_sd(n["vibration_frequency"])], confused)]

    def hand(self, begin_s, end_s):
        """The felt place of the hand, m."""
        inside = (self.time >= begin_s) & (self.time < end_s)
        return [("place", list(self.place[inside].mean(axis=0)), [noise.values()["place"] * 1e-3] * 3, 0.0)]


def stiffness_log(force_N, along_m):
    """Logarithm of the stiffness in N/m: least squares of force over the motion of the hand against it; 0 when the hand hardly moves."""
    if np.ptp(along_m) < MIN_TRAVEL_M:
        return 0.0
    slope = -float(np.polyfit(along_m, force_N, 1)[0])
    return math.log(max(slope, 1.0))


def vibration_log(transient_N, floor_N, step_s):
    """Logarithm of the mean frequency of the vibration in Hz, of samples every step_s; 0 when none is felt."""
    if len(transient_N) < 8 or np.abs(transient_N).max() < floor_N:
        return 0.0
    power = np.abs(np.fft.rfft(transient_N))**2
    return math.log(max(float(np.sum(np.fft.rfftfreq(len(transient_N), step_s) * power) / power.sum()), 1.0))


class Warmth:
    """thermal.csv of a run: the temperature that the display is commanded, at the time at which it is sent."""

    def __init__(self, path, offset_ns):
        """offset_ns: host time minus time of the world."""
        host, self.shown = columns(path, "host_s", "commanded_degC")
        self.time = host - offset_ns * 1e-9

    def features(self, begin_s, end_s):
        """As Touch.features: whether a change is felt, its sign, and its rate in the first second, which is proportional to the heat flow into the skin."""
        n = noise.values()
        inside = (self.time >= begin_s) & (self.time < end_s)
        time, shown = self.time[inside], self.shown[inside]
        if not len(shown) or np.abs(shown - shown[0]).max() < n["heat_floor"]:
            return [("felt", [0.0], [0.01], 0.0), ("sign", [0.0], [0.01], 0.0), ("flow", [0.0], [1.0], 0.0)]
        onset = int(np.argmax(np.abs(shown - shown[0]) >= n["heat_floor"]))
        first = np.flatnonzero(time < time[onset] + CONTACT_S)
        rate = float(shown[first[-1]] - shown[0]) / max(float(time[first[-1]] - time[onset]), MIN_RATE_S)
        return [("felt", [1.0], [0.01], 0.0), ("sign", [math.copysign(1.0, rate)], [0.01], 0.0),
                ("flow", [math.log(max(abs(rate), 1e-6))], [noise.weber_sd(n["heat_flow"])], 0.0)]
