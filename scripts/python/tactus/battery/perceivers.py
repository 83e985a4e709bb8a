"""The noise of one player in the tasks: the properties of a simulated player that the features of the tasks have. Others have their typical value."""
import dataclasses
import math

from tactus.information import noise

# {property of bin/observer_players: (property of noise.csv, factor of its unit)}.
OF_NOISE = {"visual noise": "visual_area", "azimuth noise": "azimuth", "force Weber": "force", "force direction noise": "force_direction",
            "stiffness Weber": "stiffness", "thermal Weber": "heat_flow", "lapse": "lapse"}
# The properties that matter for a sense, beside the lapse.
OF_SENSE = {"visual": ("visual noise",), "audio": ("azimuth noise",), "haptic": ("force Weber", "force direction noise", "stiffness Weber"), "thermal": ("thermal Weber",)}
TYPICAL_VISUAL_DEG = 0.12  # of the typical player; noise.csv has the area of its noise, which is proportional to the noise of a place
FEATURE_OF = {("visual", "pictures"): "visual noise", ("audio", "direction"): "azimuth noise", ("haptic", "force"): "force Weber", ("haptic", "direction"): "force direction noise",
              ("haptic", "stiffness"): "stiffness Weber", ("thermal", "flow"): "thermal Weber"}
PRESENCE = ("heard", "felt")  # features that are 1 when the sense perceives anything; without it, other features have no noise of the player


@dataclasses.dataclass(frozen=True)
class Perceiver:
    """factors: {property: its noise as a multiple of the typical noise}. lapse: share of percepts that are not attended."""
    factors: dict
    lapse: float


TYPICAL = Perceiver({}, noise.values()["lapse"])


def of_properties(row):
    """The Perceiver of a row of properties {name: value} of a player."""
    typical = noise.values()
    sine = lambda degree: math.sin(math.radians(degree))
    factors = {"visual noise": math.sqrt(row["visual noise"] / TYPICAL_VISUAL_DEG), "force direction noise": sine(row["force direction noise"]) / sine(typical["force_direction"])}
    for name in ("azimuth noise", "force Weber", "stiffness Weber", "thermal Weber"):
        factors[name] = row[name] / typical[OF_NOISE[name]]
    return Perceiver(factors, row["lapse"])
