"""The noise of the senses: noise.csv, with the source of each value. The values that the simulated player also has are those of its median."""
import functools
import math
import pathlib

from tactus.tables import read_rows

FILE = pathlib.Path(__file__).with_name("noise.csv")
UPPER_QUARTILE = 0.6744897501960817  # normal quantile of 75 %


@functools.lru_cache(maxsize=None)
def values():
    """{property: value}, in the units of the table."""
    return {row["property"]: float(row["value"]) for row in read_rows(FILE)}


def weber_sd(weber):
    """Standard deviation of one percept, as a share of its value, whose difference at 75 % right answers between two intervals is this share: w / (0.6745
    sqrt 2). Percepts with a Weber fraction are normal on a logarithmic scale here."""
    return weber / (UPPER_QUARTILE * math.sqrt(2))


def confusion(right, choices):
    """Share of percepts that are those of a random choice, when this share of answers is right: right = 1 - c + c / choices."""
    return (1 - right) / (1 - 1 / choices)
