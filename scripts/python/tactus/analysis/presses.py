"""Measured stiffness of two presses, one of them degraded: the slope of the force over the depth of the hand.

L_appear by measurement is the level at which the degraded press is softer or stiffer than the other press of its trial by a published JND. It needs no
answers; it describes the effect of the apparatus on the hand. The answers to "which felt softer" give a psychometric function. If the study asks for
them (of="stiffness"), the level of 75 % right answers is L_appear as judged (detection.py).
"""
import numpy as np

from tactus.analysis import appearance, operators, resampling
from tactus.study import felt_properties

PROPERTY = "stiffness"
COLUMNS = ("stiffness_first_n_m", "stiffness_second_n_m", "degraded_interval")


def pressed(trials):
    """The Trials with both stiffnesses measured, one degraded sense, and a positive stiffness of the undegraded press."""
    first, second, degraded = (trials[name] for name in COLUMNS)
    _, plain = stiffnesses(first, second, degraded)
    return trials.where(~np.isnan(first + second + degraded) & (plain > 0) & (trials["modality_degraded"] != "") & (trials["second_modality"] == ""))


def stiffnesses(first, second, degraded):
    """(stiffness of the degraded press, of the other), each (n,), N/m."""
    return np.where(degraded == 1, first, second), np.where(degraded == 1, second, first)


def shift(trials):
    """(n,) relative difference of stiffness of the degraded press to the other press of the same trial; above 0: stiffer."""
    degraded, plain = stiffnesses(*(trials[name] for name in COLUMNS))
    return degraded / plain - 1


def felt(trials, rng):
    """[appearance.Felt] of each study and factor."""
    jnd, made = felt_properties.just_noticeable()[PROPERTY][0], []
    for factor, rows in (found for _, of_study in pressed(trials).groups("study") for found in operators.factors(of_study)):
        rows = rows.where(np.array([not factor.undegraded(level) for level in rows["level"]]))
        if factor.removal or not len(rows):
            continue
        _, plain = stiffnesses(*(rows[name] for name in COLUMNS))
        resampler = resampling.Resampler(rows["participant_id"], rng)
        made.append(appearance.of_levels(PROPERTY, jnd, jnd.at75 / 100, factor, rows, shift, resampler, 0.0, float(plain.mean()), 0, measured=True))
    return made
