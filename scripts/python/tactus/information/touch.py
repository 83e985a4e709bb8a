"""Features of touch and warmth that a run presented: force, direction, stiffness, vibration, place of the hand, heat flow."""
import math
import os

import numpy as np

from tactus.information import noise
from tactus.refusal import Refusal
from tactus.tables import read_rows

CONTACT_S = 1.0  # of a touch whose heat flow is judged: the initial rate is the main cue (Bergmann Tiest and Kappers 2009)
MIN_TRAVEL_M = 1e-3  # of the hand, for a stiffness; design


def columns(path, *names):
    """Columns of the first tool in a table of touch or warmth, with rows of the world only."""
    rows = [row for row in read_rows(path) if row["time_s"] and row["tool"] == "0"]
    if not rows:
        raise Refusal(f"the first tool has no row in {os.path.basename(path)}, so nothing is felt; give a scene with a <tactus:tool>")
    return [np.array([float(row[name]) for row in rows]) for name in names]


class Touch:
    """haptic.csv of a run."""

    def __init__(self, path):
        names = [f"{what}_{axis}_{unit}" for what, unit in (("device", "m"), ("force", "N"), ("transient", "N")) for axis in "xyz"]
        self.time, self.host, *rest = columns(path, "time_s", "host_s", *names)
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
    """thermal.csv of a run."""

    def __init__(self, path):
        self.time, self.material, self.flux, self.skin = columns(path, "time_s", "material", "heat_flux_W_m2", "skin_degC")

    def features(self, begin_s, end_s):
        """As Touch.features: whether a change is felt, its sign, and the heat flow of the first second of the touch."""
        n = noise.values()
        inside = (self.time >= begin_s) & (self.time < end_s)
        time, touched, flux, skin = self.time[inside], self.material[inside] >= 0, self.flux[inside], self.skin[inside]
        if not touched.any() or np.ptp(skin) < n["heat_floor"]:
            return [("felt", [0.0], [0.01], 0.0), ("sign", [0.0], [0.01], 0.0), ("flow", [0.0], [1.0], 0.0)]
        first = touched & (time < time[touched][0] + CONTACT_S)
        mean = float(flux[first].mean())
        return [("felt", [1.0], [0.01], 0.0), ("sign", [math.copysign(1.0, mean)], [0.01], 0.0),
                ("flow", [math.log(max(abs(mean), 1e-3))], [noise.weber_sd(n["heat_flow"])], 0.0)]
