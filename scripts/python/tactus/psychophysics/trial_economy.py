"""Number of trials that QUEST+ needs, compared with published numbers and with the theoretical optimum.

Designs are those of Watson 2017 (Journal of Vision 17(3):10), figures 2 and 3: forced choice of two, Weibull's function of levels from -40 to 0 dB,
threshold -20 dB, slope 3.5 or 3, lapse rate 0.02; 32 trials with the threshold alone unknown, 64 with slope and lapse unknown as well. The figures show
one session each and no spread of estimates. So the spread is compared with

  the ideal        with the slope known, n trials at the best level give a standard deviation of sqrt(K / n), K = min over x of p (1 - p) /
                   (dp/dthreshold)^2: the ideal sweat factor (Taylor and Creelman 1967, JASA 41:782; Watson and Pelli 1983, Perception & Psychophysics
                   33:113)
  published        threshold and slope unknown: a threshold within 2 dB takes less than 30 trials, a slope within 2 dB about 300 (Kontsevich and
                   Tyler 1999, Vision Research 39:2729, abstract; minimum expected entropy too). Required for the threshold; the slope is
                   only reported, because it depends on the range of possible slopes (here 1 to 12), which the abstract does not state
"""
import math

import numpy as np

from tactus.psychophysics.functions import function
from tactus.psychophysics.observers import SimulatedObserver
from tactus.psychophysics.quest_plus import QuestPlus

DB = [float(x) for x in range(-40, 1)]
SLOPES = [float(x) for x in np.round(np.geomspace(1, 12, 12), 3)]
PUBLISHED_DB = 2.0
THRESHOLD_TRIALS, SLOPE_TRIALS = 30, 300  # Kontsevich and Tyler 1999, abstract
DESIGNS = {
    "threshold": ({"threshold": DB, "slope": [3.5], "guess": [0.5], "lapse": [0.02]}, 32, 3.5),
    "threshold, slope, lapse": ({"threshold": DB, "slope": [2.0, 3.0, 4.0, 5.0], "guess": [0.5], "lapse": [0.0, 0.01, 0.02, 0.03, 0.04]}, 64, 3.0),
    "threshold, slope": ({"threshold": DB, "slope": SLOPES, "guess": [0.5], "lapse": [0.02]}, 400, 3.5),
}


def sweat_factor(slope, guess=0.5, lapse=0.02):
    """K in dB^2 of Weibull's function over dB: the smallest variance times trials over all levels."""
    f, x, h = function("weibull_dB"), np.linspace(-8, 8, 1601), 1e-4
    p, up, down = (f.p(x, threshold=t, slope=slope, guess=guess, lapse=lapse) for t in (0, h, -h))
    return float((p * (1 - p) / ((up - down) / (2 * h)) ** 2).min())


def errors(design, participants, seed):
    """(threshold errors in dB, slope errors in dB), each (participants, trials): errors of the posterior means after each trial. Thresholds are drawn
    uniformly from -25 to -15 dB, off the grid."""
    parameters, trials, slope = DESIGNS[design]
    made = np.empty((2, participants, trials))
    dice = np.random.default_rng([seed, 99])
    for i in range(participants):
        truth = {"threshold": dice.uniform(-25, -15), "slope": slope, "guess": 0.5, "lapse": 0.02}
        observer, quest = SimulatedObserver("weibull_dB", truth, [seed, i]), QuestPlus("weibull_dB", parameters, DB, trials=trials)
        cells = np.stack([quest.tables.cells[:, 0], 20 * np.log10(quest.tables.cells[:, 1])])
        for j in range(trials):
            level = quest.next_level()
            quest.answer(level, observer.answer(level))
            made[:, i, j] = cells @ quest.posterior - (truth["threshold"], 20 * math.log10(slope))
    return made


def first_within(errors_dB, bound_dB):
    """Number of trials after which the root mean square error stays within the bound, or None."""
    over = np.flatnonzero(np.sqrt((errors_dB ** 2).mean(axis=0)) > bound_dB)
    last = over[-1] + 1 if len(over) else 0
    return int(last) + 1 if last < errors_dB.shape[1] else None


def rows(participants, seed):
    """[dict] of each design: root mean square error of the threshold at the last trial, its ideal value, trials to 2 dB."""
    found = []
    for design, (_, trials, slope) in DESIGNS.items():
        of_threshold, of_slope = errors(design, participants, seed)
        rms = float(np.sqrt((of_threshold[:, -1] ** 2).mean()))
        found.append({"design": design, "trials": trials, "rms_dB": rms, "rms_se_dB": rms / math.sqrt(2 * participants), "ideal_dB": math.sqrt(sweat_factor(slope) / trials),
                      "bias_dB": float(of_threshold[:, -1].mean()), "threshold_trials": first_within(of_threshold, PUBLISHED_DB),
                      "slope_trials": first_within(of_slope, PUBLISHED_DB) if design == "threshold, slope" else None})
    return found


def missed(found):
    """[sentence] if the threshold takes more trials than published."""
    trials = next(r["threshold_trials"] for r in found if r["design"] == "threshold, slope")
    return [] if trials is not None and trials <= THRESHOLD_TRIALS else [f"QUEST+ takes {trials or 'too many'} trials to a threshold within 2 dB; the published number is {THRESHOLD_TRIALS}"]


def table(found):
    said = [f"{'QUEST+, unknown are':26} {'trials':>6} {'rms error/dB':>13} {'ideal/dB':>8} {'trials to 2 dB: threshold':>25} {'slope':>6}"]
    for r in found:
        said.append(f"{r['design']:26} {r['trials']:6d} {r['rms_dB']:6.2f} ± {r['rms_se_dB']:4.2f} {r['ideal_dB']:8.2f} {r['threshold_trials'] or '-':>25} {r['slope_trials'] or '-':>6}")
    return "\n".join(said + [f"published{'':38} {'':16} {'<' + str(THRESHOLD_TRIALS):>19} {SLOPE_TRIALS:>6}"])
