"""Statistical power of a study, by simulation: observers with known thresholds answer its procedures, and the answers are fitted as in the analysis.

For yes/no answers: the width of the 95 % interval of each estimate. For ratings and matchings: the smallest difference between two levels that a
t-test finds. Games are in power_games.py, presses judged by felt stiffness in power_felt.py.
"""
import dataclasses
import math
import warnings

import numpy as np

from tactus.psychophysics import fits, intervals, procedures
from tactus.psychophysics.functions import function
from tactus.psychophysics.observers import PERCEPTS, SimulatedObserver
from tactus.study import power_felt, power_games, study_file
from tactus.study.plan import Plan

WANTED, ALPHA = 0.8, 0.05  # usual power and size of a test (Cohen 1988, Statistical Power Analysis, sections 2.4 and 1.2)
FIXED = {"two_interval": {"guess": 0.5}}
IN_UNIT = ("pss", "sd", "threshold", "scale")  # parameters in the unit of the levels
MAX_UNPLACED = 0.2  # share of simulated sessions without a threshold; above, the figures of the others are unreliable (design)


@dataclasses.dataclass(frozen=True)
class Assumed:
    """Assumptions of the simulation. participants: numbers of participants for which power is computed. games: power_games.Games without degradation.
    presses: power_felt.Presses of a pilot, or None."""
    simulations: int = 100
    seed: int = 1
    participants: tuple = (1, 12, 24)
    games: power_games.Games = power_games.Games()
    presses: power_felt.Presses = None


def of(study, assumed):
    """[{...}] of the functions below; [] if nothing is simulated."""
    if study.response == "performance":
        return power_games.of(study, assumed, WANTED, ALPHA)
    if study.response not in study_file.YES_OR_NO:
        return differences(study, assumed)
    return [row for condition in study.conditions if study.observer(condition) is not None for row in of_condition(study, condition, assumed)]


def of_condition(study, condition, assumed):
    observer = study.observer(condition)
    if observer.function not in PERCEPTS:
        make = lambda n: SimulatedObserver(observer.function, observer.params, [assumed.seed, n])
        return estimates(study, condition, assumed, make, observer.function, {name: observer.params[name] for name in function(observer.function).parameters[:2]})
    found = power_felt.differences(study, condition, assumed.participants, WANTED, ALPHA)
    levels = assumed.presses.felt.get(condition.id) if assumed.presses else None
    truth = power_felt.truth(levels, observer) if levels else math.nan
    if math.isnan(truth):
        return found
    return found + estimates(study, condition, assumed, lambda n: power_felt.Felt(levels, observer, [assumed.seed, n]), power_felt.FIT, {power_felt.PARAMETER: truth})


def estimates(study, condition, assumed, make, fit, truths):
    """[{condition, parameter, truth, half_width, bias, sd, no_fit, trials, groups}], one for each of truths, {parameter: value}. make(n): observer of the
    n-th simulated participant; fit: name of the fitted function. half_width: median over simulated participants of half the 95 % interval; sd: standard
    deviation of their estimates; no_fit: share of participants without a threshold; groups: {participants: half width of the interval of the mean of
    this number of identical participants}."""
    histories = []
    for n in range(assumed.simulations):
        plan = Plan(dataclasses.replace(study, conditions=(condition,)), f"P{n + 1}", assumed.seed)
        histories.append(procedures.run(plan.procedures[0], make(n)))
    fitted = fits.fit_many(*procedures.stacked(histories), fit, FIXED.get(study.response))
    placed, rows = fitted.placed(), []
    for name, truth in truths.items():
        low, high = intervals.of_many(fitted, name)
        off = fitted.estimates(name)[placed] - truth
        sd = float(off.std(ddof=1)) if len(off) > 1 else math.nan
        rows.append({"condition": condition.id, "parameter": name, "truth": truth, "half_width": float(np.median((high - low) / 2)),
                     "bias": float(off.mean()) if len(off) else math.nan, "sd": sd, "no_fit": float(1 - placed.mean()),
                     "trials": float(np.mean([len(h) for h in histories])), "groups": {n: of_mean(sd, n) for n in assumed.participants if n > 1}})
    return rows


def of_mean(sd, n):
    """Half the 95 % interval of the mean of n with this standard deviation (Student 1908)."""
    from scipy.stats import t
    return float(t.ppf(1 - ALPHA / 2, n - 1) * sd / math.sqrt(n))


def differences(study, assumed):
    """[{participants, answers, smallest_in_sd}]: the smallest difference of the means of two levels, in standard deviations of one answer, that a t-test
    finds with the power WANTED. One participant: test over answers; several: paired test over their means."""
    from statsmodels.stats.power import TTestIndPower, TTestPower
    answers, found = study.procedure["repetitions"], []
    for n in assumed.participants:
        smallest = None
        with warnings.catch_warnings(action="ignore", category=RuntimeWarning):  # large trial effects underflow a tail
            if n > 1:
                smallest = TTestPower().solve_power(nobs=n, alpha=ALPHA, power=WANTED) * math.sqrt(2 / answers)
            elif answers > 1:
                smallest = TTestIndPower().solve_power(nobs1=answers, alpha=ALPHA, power=WANTED)
        found.append({"participants": n, "answers": answers, "smallest_in_sd": None if smallest is None else float(smallest)})
    return found


def unit_of(study, f):
    """Unit of an estimate, preceded by a space; "": none, or not the unit of the levels."""
    condition = next(c for c in study.conditions if c.id == f["condition"])
    observer = study.observer(condition)
    unit = condition.unit if f["parameter"] in IN_UNIT and observer.function != "weibull_dB" else ""
    return f" {unit}" if unit else ""


def words(study, found, assumed):
    """Lines for a terminal."""
    if study.response == "performance":
        return power_games.words(found, assumed, WANTED)
    if study.response not in study_file.YES_OR_NO:
        return ["smallest difference between two levels that a t-test finds with 80 % power, in standard deviations of one answer (without differences between people):",
                *(f"  {f['participants']:4d} participants, {f['answers']} answers a level: " + ("none (one answer has no spread)" if f["smallest_in_sd"] is None else f"{f['smallest_in_sd']:.2f}")
                  for f in found)]
    differ = [f for f in found if "softer" in f]
    lines = power_felt.words(study, differ, assumed.presses) if any(o.function in PERCEPTS for o in study.observers.values()) else []
    for f in found:
        if "softer" in f:
            continue
        unit = unit_of(study, f)
        if f["no_fit"] == 1:
            lines.append(f"{f['condition']}: no threshold found in any of {assumed.simulations} simulated sessions; {f['parameter']} stays unknown")
            continue
        lines.append(f"{f['condition']}: {f['parameter']} of {f['truth']:g}{unit} will be known to +-{f['half_width']:.3g}{unit} (95 %) from one participant, bias {f['bias']:+.2g} "
                     f"({assumed.simulations} simulated participants, {f['trials']:.0f} trials each" + (f"; no threshold found in {f['no_fit']:.0%}" if f["no_fit"] else "") + ")"
                     + "".join(f"; the mean of {n} to +-{w:.3g}" for n, w in f["groups"].items()))
    lines += [f"{name}: too many simulated sessions find no threshold, so these figures are unreliable; check that the levels, or the staircase, include the threshold"
              for name in dict.fromkeys(f["condition"] for f in found if f.get("no_fit", 0) > MAX_UNPLACED)]
    if len(found) > len(differ):
        lines.append("means assume identical participants; differences between people add to their uncertainty")
    return lines or ["the study file has no <observer>; its power is not simulated"]
