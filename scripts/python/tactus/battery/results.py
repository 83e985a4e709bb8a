"""Tables of the battery: one row for each task, sense and operator, one for each player, one for each level."""
import csv
import itertools
import math

import numpy as np

from tactus import terminal
from tactus.battery import answers, conditions, deciding, limits, perceivers

QUANTILES = (0.1, 0.5, 0.9)
EXPLAINED = 0.5  # share of the variance of left-out players below which no property is named; design
KEYS = ("median", "low", "high", "q10", "q90")


def shown(limit, curve):
    """A limit with its unit; < and >: milder than the mildest and severer than the severest level."""
    if limit == limits.BELOW:
        return f"<{conditions.written(curve.operator, curve.levels[0])}"
    if limit == limits.ABOVE:
        return f">{conditions.written(curve.operator, curve.levels[-1])}"
    return conditions.written(curve.operator, float(f"{limit:.2g}"))


def distribution(found, curve):
    """{median, low, high, q10, q90} of the limits of the players."""
    low, high = limits.median_interval(found, curve.levels)
    q10, median, q90 = (limits.at_quantile(found, curve.levels, share) for share in QUANTILES)
    return {"median": median, "low": low, "high": high, "q10": q10, "q90": q90}


def decides(found, curve, properties):
    """(property with the largest total index, the index, Q2) of the limits, or None when fewer than nine tenths of the players have a number."""
    inside = [i for i, limit in enumerate(found) if limit not in (limits.BELOW, limits.ABOVE)]
    if len(inside) < 0.9 * len(found):
        return None
    names = (*perceivers.OF_SENSE[curve.sense], "lapse")
    total, q2 = deciding.total_indices({name: np.asarray(properties[name])[inside] for name in names}, [found[i] for i in inside])
    if total is None:
        return None
    best = max(total, key=total.get)
    return best, total[best], q2


def summary(curve, properties):
    """One row of limits.csv: texts and numbers by name; "" where an operator with draws has no value."""
    naive, adapted, detected = curve.limits(answers.NAIVE), curve.limits(answers.ADAPTED), curve.thresholds()
    row = {"task": curve.task, "sense": curve.sense, "operator": curve.operator, "unit": conditions.unit(curve.operator), "undegraded": float(np.mean(curve.undegraded)),
           "largest loss": float(np.max(np.mean(curve.undegraded) - np.mean(curve.success[answers.NAIVE], axis=0)))}
    for name, found in ((answers.NAIVE, naive), (answers.ADAPTED, adapted), ("detected", detected)):
        row.update({f"{name} {key}": found and shown(value, curve) or "" for key, value in (distribution(found, curve) if found else dict.fromkeys(KEYS)).items()})
        row[f"{name} unreached"] = float(np.mean([limit == limits.ABOVE for limit in found])) if found else ""
    row.update({"limit / detected": "", "limit before detection": "", "compared": ""})
    if detected:
        compared = [ratio for ratio in (limits.tolerated(limit, threshold, curve.levels) for limit, threshold in zip(naive, detected)) if not math.isnan(ratio)]
        row["compared"] = len(compared)
        if len(compared) > len(naive) / 2:
            row["limit / detected"], row["limit before detection"] = float(np.median(compared)), float(np.mean([ratio < 1 for ratio in compared]))
    deciding_property = decides(naive, curve, properties)
    row.update(dict(zip(("deciding property", "total index", "explained of left out"), deciding_property or ("", "", ""))))
    return row


def show(found, properties):
    terminal.show(f"{'task':30} {'sense':8} {'operator':10} {'naive, median [95 %]':24} {'10 %, 90 %':18} {'adapted, median [95 %]':24} {'10 %, 90 %':18} {'detected':>9} {'before':>6}  decided by")
    for curve in found:
        row = summary(curve, properties)
        cells = "".join(f" {cell(row, name)}" for name in answers.EXPECTATIONS)
        by = f"{row['deciding property']} {row['total index']:.2f}" if row["deciding property"] and row["explained of left out"] > EXPLAINED else "-"
        before = "" if row["limit before detection"] == "" else f"{100 * row['limit before detection']:.0f}%"
        terminal.show(f"{curve.task:30} {curve.sense:8} {curve.operator:10}{cells} {row['detected median'] or '-':>9} {before or '-':>6}  {by}")


def cell(row, name):
    """Median, interval and quantiles of one kind of limit as text."""
    if not row[f"{name} median"]:
        return f"{'-':24} {'-':18}"
    return f"{'{0} [{1}, {2}]'.format(*(row[f'{name} {key}'] for key in ('median', 'low', 'high'))):24} {'{0}, {1}'.format(*(row[f'{name} {key}'] for key in ('q10', 'q90'))):18}"


def text(value):
    """A cell of a table: numbers with four digits."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def write_table(path, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: text(value) for name, value in row.items()} for row in rows)


def write(folder, found, surfaces, numbers, properties):
    """Writes limits.csv, players.csv, curves.csv, and pairs.csv when two senses were degraded together."""
    folder.mkdir(parents=True, exist_ok=True)
    write_table(folder / "limits.csv", [summary(curve, properties) for curve in found])
    write_table(folder / "players.csv", [row for curve in found for row in of_players(curve, numbers)])
    write_table(folder / "curves.csv", [of_level(curve, i) for curve in found for i in range(len(curve.levels))])
    if surfaces:
        write_table(folder / "pairs.csv", [{"task": task, "first": a[0], "second": b[0], "operator": a[1], "first level": a[2][i], "second level": b[2][j], "right": float(right[i, j])}
                                           for task, a, b, right in surfaces for i, j in itertools.product(range(len(a[2])), range(len(b[2])))])


def of_players(curve, numbers):
    """One row for each player; a limit of 0 is below the mildest level, and one of inf is not reached."""
    columns = {"naive": curve.limits(answers.NAIVE), "adapted": curve.limits(answers.ADAPTED), "detected": curve.thresholds()}
    return [{"player": number, "task": curve.task, "sense": curve.sense, "operator": curve.operator, "undegraded": float(curve.undegraded[i]),
             **{name: float(values[i]) if values else "" for name, values in columns.items()}} for i, number in enumerate(numbers)]


def of_level(curve, i):
    """The mean and the 10 % and 90 % quantiles over the players at a level."""
    row = {"task": curve.task, "sense": curve.sense, "operator": curve.operator, "level": float(curve.levels[i])}
    for name, table in ((answers.NAIVE, curve.success[answers.NAIVE]), (answers.ADAPTED, curve.success.get(answers.ADAPTED)), ("detected", curve.detected)):
        if table is None:
            row.update({f"{name} mean": "", f"{name} q10": "", f"{name} q90": ""})
            continue
        row.update({f"{name} mean": float(table[:, i].mean()), f"{name} q10": float(np.quantile(table[:, i], 0.1)), f"{name} q90": float(np.quantile(table[:, i], 0.9))})
    return row
