"""Which metric predicts success? Metrics of the conditions of a study, on a test signal, and their ranking out of sample.

The metrics of a condition come from a test signal that passes its operator, because a table of games holds no signals: a motion of a hand of
0.4 to 3 Hz. It is compared with the undegraded one, as of_run.py compares forces. A metric predicts well when a monotone curve of success against it, fitted to all other
operators of a modality, predicts the games of the operator that was left out.
"""
import functools
import json
import pathlib

import numpy as np

from tactus.metrics import age, compare

STORED = pathlib.Path(__file__).with_name("ranking.json")
STREAM_HZ = {"haptic": 1000.0, "visual": 60.0, "audio": 60.0, "thermal": 60.0}  # rate of the undegraded stream of a modality; of the last two, CONTACTS
PLAYED = ("haptic", "visual")  # modalities of the games that the stored ranking is of; the player hardly uses the others
OPERATORS = ("delay", "jitter", "loss", "rate")
JITTER_DELAY = 3      # constant delay of a jitter, in standard deviations: scripts/python/tactus/study/quantities.py
SECONDS, GRID_HZ, MAX_LAG_S = 20.0, 200.0, 0.8
METRICS = ("age_ms", "age_p95_ms", "force_jnd_share", "force_time_ms", "force_time_variation", "force_value_N", "force_rmse_N", "force_hssim_like")


def test_signal(times_s, seed=1):
    """A smooth signal of RMS one around a mean of one: five sines of 0.4 to 3 Hz with random phases."""
    random = np.random.default_rng(seed)
    waves = [np.sin(2 * np.pi * (f * times_s + random.random())) / f for f in (0.4, 0.7, 1.1, 1.9, 3.0)]
    wave = np.sum(waves, axis=0)
    return 1 + wave / np.sqrt(np.mean(wave ** 2))


def delivered(modality, operator, level, seed=1):
    """(made, delivered), s, of the updates of a stream that passes an operator of a study at this level (ms, % or Hz); "" is no operator. The receiver shows the
    newest."""
    random = np.random.default_rng(seed)
    made = np.arange(0, SECONDS, 1 / STREAM_HZ[modality])
    if operator == "delay":
        return made, made + level * 1e-3
    if operator == "jitter":
        return made, made + np.maximum(0, JITTER_DELAY * level + level * random.standard_normal(len(made))) * 1e-3
    if operator == "loss":
        kept = made[random.random(len(made)) >= level / 100]
        return kept, kept
    if operator == "rate":
        kept = made[np.append(True, np.diff(np.floor(made * level + 1e-9)) > 0)]
        return kept, kept
    return made, made


@functools.lru_cache(maxsize=None)
def of_condition(modality, operator, level):
    """{metric: value} of METRICS for a condition of a study."""
    made, arrived = delivered(modality, operator, level)
    order = np.argsort(arrived, kind="stable")
    at, newest = arrived[order], np.maximum.accumulate(made[order])
    grid = np.arange(1.0, SECONDS - 1.0, 1 / GRID_HZ)
    shown_from = newest[np.clip(np.searchsorted(at, grid, side="right") - 1, 0, len(at) - 1)]
    fine = np.arange(0, SECONDS, 1e-3)
    x, y = np.interp(grid, fine, test_signal(fine)), np.interp(shown_from, fine, test_signal(fine))
    etvo = compare.etvo_like(x, y, GRID_HZ, MAX_LAG_S)
    return {"age_ms": 1e3 * age.measured_s(made, arrived, SECONDS), "age_p95_ms": 1e3 * float(np.percentile(grid - shown_from, 95)),
            "force_jnd_share": compare.jnd_tube(x, y, floor=0.1), "force_time_ms": etvo["time_ms"], "force_time_variation": etvo["time_variation"],
            "force_value_N": etvo["value"], "force_rmse_N": compare.rmse(x, y), "force_hssim_like": compare.hssim_like(x, y)}


def falling(x, y, weights):
    """Weighted least squares of a curve that never rises with x (pool adjacent violators): (x, y) of its points, x increasing."""
    order = np.argsort(x, kind="stable")
    blocks = []  # [sum of weighted y, weight, x of its points]
    for i in order:
        blocks.append([y[i] * weights[i], weights[i], [x[i]]])
        while len(blocks) > 1 and blocks[-2][0] / blocks[-2][1] < blocks[-1][0] / blocks[-1][1]:
            last = blocks.pop()
            blocks[-1] = [blocks[-1][0] + last[0], blocks[-1][1] + last[1], blocks[-1][2] + last[2]]
    return np.array([at for b in blocks for at in b[2]]), np.array([b[0] / b[1] for b in blocks for _ in b[2]])


def log_loss_bits(won, games, p, least=0.01):
    """Mean loss of predicted probabilities per game, bits; predictions are kept within least and 1 - least."""
    p = np.clip(p, least, 1 - least)
    return float(np.sum(-(won * np.log2(p) + (games - won) * np.log2(1 - p))) / np.sum(games))


def rank(conditions):
    """The ranking, best first: [{"metric", "loss_bits", "skill", "groups": {"MODALITY OPERATOR": loss}}]. conditions: dictionaries with modality, operator ("" for
    none), level, won, games and metrics. skill: 1 - loss / loss of the mean success of the other operators."""
    groups = [(m, o) for m in PLAYED for o in OPERATORS if any((c["modality"], c["operator"]) == (m, o) for c in conditions)]
    found = []
    for metric in METRICS:
        losses, nulls = {}, []
        for modality, operator in groups:
            train = [c for c in conditions if c["modality"] == modality and c["operator"] != operator]
            test = [c for c in conditions if (c["modality"], c["operator"]) == (modality, operator)]
            column = lambda rows, key: np.array([row[key] for row in rows], dtype=float)
            games = column(train, "games")
            x, y = falling(rising(metric, train), column(train, "won") / games, games)
            won, of = column(test, "won"), column(test, "games")
            losses[f"{modality} {operator}"] = log_loss_bits(won, of, np.interp(rising(metric, test), x, y))
            nulls.append(log_loss_bits(won, of, np.full(len(test), np.sum(column(train, "won")) / np.sum(games))))
        loss = float(np.mean(list(losses.values())))
        found.append({"metric": metric, "loss_bits": round(loss, 4), "skill": round(1 - loss / float(np.mean(nulls)), 4), "groups": {k: round(v, 4) for k, v in losses.items()}})
    return sorted(found, key=lambda row: row["loss_bits"])


def rising(metric, conditions):
    """Values of a metric of conditions, with the sign with which they rise with the degradation."""
    sign = -1 if metric == "force_hssim_like" else 1  # more similar is better
    return sign * np.array([c["metrics"][metric] for c in conditions])


def rank_by_task(conditions):
    """As rank(), with each task left out in turn: [{"metric", "loss_bits", "skill", "explained", "groups": {TASK: loss}}]. conditions: dictionaries with task,
    success (a share) and games under the condition, chance and undegraded success of the task, and metrics. The curve gives the success relative to chance and to
    the undegraded success. explained: 1 - (loss - least) / (loss of the mean - least); least is the loss of a prediction by the measured success itself."""
    found = []
    column = lambda rows, key: np.array([row[key] for row in rows], dtype=float)
    span = lambda rows: column(rows, "undegraded") - column(rows, "chance")
    relative = lambda rows: (column(rows, "success") - column(rows, "chance")) / np.maximum(span(rows), 1e-9)
    for metric in METRICS:
        losses, nulls, least = {}, [], []
        for task in dict.fromkeys(c["task"] for c in conditions):
            train, test = ([c for c in conditions if (c["task"] == task) == own] for own in (False, True))
            games = column(test, "games")
            loss = lambda r: log_loss_bits(column(test, "success") * games, games, column(test, "chance") + np.clip(r, 0, 1) * span(test))
            x, y = falling(rising(metric, train), relative(train), column(train, "games"))
            losses[task] = loss(np.interp(rising(metric, test), x, y))
            nulls.append(loss(np.full(len(test), np.average(relative(train), weights=column(train, "games")))))
            least.append(log_loss_bits(column(test, "success") * games, games, column(test, "success")))
        mean, null, best = (float(np.mean(v)) for v in (list(losses.values()), nulls, least))
        found.append({"metric": metric, "loss_bits": round(mean, 4), "skill": round(1 - mean / null, 4), "explained": round(1 - (mean - best) / max(null - best, 1e-9), 4),
                      "groups": {k: round(v, 4) for k, v in losses.items()}})
    return sorted(found, key=lambda row: row["loss_bits"])


def conditions_of(rows):
    """The conditions of the rows of a table of games (study/trial_table.py, docs/study_formats.md) that degrade one modality of PLAYED by one of OPERATORS, and the undegraded one for each
    modality, with their metrics."""
    counts = {}
    for row in rows:
        if row["second_modality"] or row["success"] not in (0, 1) or (row["operator"] and row["operator"] not in OPERATORS):
            continue
        for modality in ([row["modality_degraded"]] if row["operator"] else PLAYED):
            if modality in PLAYED:
                own = counts.setdefault((modality, row["operator"], float(row["level"] or 0)), [0, 0])
                own[0] += row["success"]
                own[1] += 1
    return [{"modality": m, "operator": o, "level": level, "won": won, "games": games, "metrics": of_condition(m, o, level)}
            for (m, o, level), (won, games) in sorted(counts.items())]


def stored():
    """The ranking that reports use: {"command", "data", "games", "ranking": of rank()}."""
    with open(STORED, encoding="utf-8") as file:
        return json.load(file)
