"""Tables of trials for tests, in the format of a study's results."""
import csv
import math
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))


def write(path, rows):
    """rows: [{column: value}]; NaN and absent become empty."""
    columns = list(dict.fromkeys(name for row in rows for name in row))
    with open(path, "w", newline="", encoding="utf-8") as file:
        out = csv.DictWriter(file, columns, lineterminator="\n")
        out.writeheader()
        out.writerows({k: "" if isinstance(v, float) and math.isnan(v) else v for k, v in row.items()} for row in rows)
    return path


def game(number, won, time_s, degraded=(), participant="P01", study="dark room", observer="simulated", limit_s=30.0, **more):
    """One row. degraded: [(modality, operator, level, unit)], at most two."""
    row = {"study": study, "participant_id": participant, "task": "game", "observer": observer, "trial": number, "success": int(won),
           "completion_time_s": round(time_s, 6) if won else limit_s}
    for prefix, name in (("", "modality_degraded"), ("second_", "second_modality")):
        modality, operator, level, unit = (list(degraded) + [("", "", "", "")] * 2)[1 if prefix else 0]
        row.update({name: modality, prefix + "operator": operator, prefix + "level": level, prefix + "unit": unit})
    return {**row, **more}


def games(rng, n, degraded, share, mean_s, first=0, **more):
    """n games won with this probability in times of mean mean_s (gamma, shape 16, so that few take twice the mean)."""
    return [game(first + i, rng.random() < share, rng.gamma(16, mean_s / 16), degraded, **more) for i in range(n)]


def judgements(rng, pss, sd, lapse, levels, repetitions, participant="P01", pair=("audio", "visual"), jitter_ms=2.0, observer="simulated", study="synchrony", first=0):
    """Synchrony judgements of an observer with a Gaussian window; the measured asynchrony has an error of jitter_ms (sd)."""
    rows = []
    for i, level in enumerate(rng.permutation(np.repeat(levels, repetitions))):
        achieved = level + rng.normal(0, jitter_ms)
        together = rng.random() < (1 - lapse) * math.exp(-((achieved - pss) ** 2) / (2 * sd**2))
        rows.append({"study": study, "participant_id": participant, "task": "sj", "pair": ",".join(pair), "observer": observer, "trial": first + i,
                     "soa_nominal_ms": float(level), "soa_achieved_ms": round(achieved, 4), "soa_uncertainty_ms": 0.1, "response": "yes" if together else "no",
                     "missed": 0})
    return rows
