"""Tables of trials and games as columns. study/trial_table.py reads and validates the rows.

An invalid row refuses the whole table, with file, line and reason, because an analysis of a part would look complete.
"""
import math
import pathlib
import re

import numpy as np

from tactus.analysis import operators
from tactus.refusal import Refusal
from tactus.study import quantities, trial_table

FILES = ("trials.csv", "games.csv")
MAX_NAMED = 3  # players in a title; design
DEEPEST = 4  # design: OUT/study/participant/session/trials.csv
TEXTS = {name for name, column in trial_table.COLUMNS.items() if column.kind == "text"} | {"seed"}  # a seed may need more than 53 bits
# Columns that identify a row; a repeated row is refused.
IDENTITY = ("study", "participant_id", "session", "condition", "block", "trial", "seed", "question")


def by_number(text):
    """Sorts names with numbers in them by their numbers: observer:9 before observer:10."""
    return [(word.isdigit(), len(word) if word.isdigit() else 0, word) for word in re.split(r"(\d+)", text)]


class Trials:
    """Rows by column: float arrays (NaN for an empty field) and text arrays. Absent columns read as empty."""

    def __init__(self, columns, rows):
        self.columns, self.rows = columns, rows

    def __len__(self):
        return self.rows

    def __getitem__(self, name):
        if name in self.columns:
            return self.columns[name]
        return np.full(self.rows, "", dtype=object) if name in TEXTS else np.full(self.rows, np.nan)

    def where(self, rows):
        """The rows of a mask or of a list of numbers."""
        rows = np.flatnonzero(rows) if np.asarray(rows).dtype == bool else np.asarray(rows, dtype=int)
        return Trials({name: values[rows] for name, values in self.columns.items()}, len(rows))

    def groups(self, *names):
        """[(values, Trials)] of the rows that agree in these columns, in the order of their values."""
        found = {}
        for i, key in enumerate(zip(*(self[name] for name in names))):
            found.setdefault(tuple("" if k != k else k for k in key), []).append(i)
        return [(key, self.where(found[key])) for key in sorted(found, key=lambda k: [(isinstance(v, str), v) for v in k])]

    def participants(self):
        return sorted(set(self["participant_id"]))

    def observer(self):
        """human, simulated, or both; the simulated players of games by name, and how many of them fail a check."""
        kinds = sorted(set(self["observer"]))
        named = sorted(set(self["player"]) - {""}, key=by_number)
        if "simulated" not in kinds or not named:
            return " and ".join(kinds)
        failed = len({player for player, checks in zip(self["player"], self["failed_checks"]) if checks not in ("", "none")})
        who = ", ".join(named) if len(named) <= MAX_NAMED else f"{len(named)} players, {named[0]} to {named[-1]}"
        return " and ".join(kinds) + f" ({who}{f'; {failed} of them fail a check' if failed else ''})"


def of_rows(rows):
    """Trials of [{column: value}]."""
    names = dict.fromkeys(name for row in rows for name in row)
    def text(value):
        return "" if value is None else str(value)
    def number(value):
        return math.nan if value is None or value == "" else float(value)
    return Trials({name: np.array([text(row.get(name)) for row in rows], dtype=object) if name in TEXTS else np.array([number(row.get(name)) for row in rows])
                   for name in names}, len(rows))


def files_of(places):
    """The tables under folders or files, sorted, each once. Raises Refusal if a place holds none."""
    found = []
    for place in map(pathlib.Path, places):
        if place.is_file():
            mine = [place]
        elif place.is_dir():
            mine = sorted(p for depth in range(DEEPEST + 1) for name in FILES for p in place.glob("*/" * depth + name))
        else:
            raise Refusal(f"{place} does not exist; give a results folder of `study run` or `study sweep`, or a table of trials")
        if not mine:
            raise Refusal(f"{place} holds no {' or '.join(FILES)}; give a results folder of `study run` or `study sweep`")
        found += [p for p in mine if p.resolve() not in {f.resolve() for f in found}]
    return found


def to_unit_of_operator(row):
    """Converts the levels of a row to the unit of their operator (study/quantities.py). Returns the reason why that cannot be done, or None."""
    for prefix in ("", "second_"):
        unit, factors, *_ = quantities.OPERATORS.get(operators.kind(row.get(prefix + "operator") or ""), (None, {}))
        given = row.get(prefix + "unit") or ""
        if unit is None or row.get(prefix + "level") is None or given in ("", unit):
            continue
        if given not in factors:
            return f"{prefix}unit is {given}; write levels of {row[prefix + 'operator']} in {' or '.join(factors) or 'no unit'}"
        row[prefix + "level"] = round(row[prefix + "level"] * factors[given], 9)
        row[prefix + "unit"] = unit
    return None


def no_severity(row):
    """Reason why the level of a row gives no severity, as a sentence; None: it does, or nothing is degraded."""
    for prefix, modality in (("", "modality_degraded"), ("second_", "second_modality")):
        operator, level = row.get(prefix + "operator"), row.get(prefix + "level")
        kind = operators.kind(operator or "")
        if not row.get("pair") and bool(row.get(modality)) != bool(operator) and level != 0:
            empty, full = (modality, prefix + "operator") if operator else (prefix + "operator", modality)
            return f"{empty} is empty, but {full} is {operator or row.get(modality)}; write both, or neither if nothing is degraded"
        if not row.get(modality) or not operator or kind in operators.REMOVALS:
            continue
        if level is None and not row.get("pair"):
            return f"a {'game' if row['task'] == 'game' else 'trial'} under {operator} has no {prefix}level; write its level"
        falls = kind in operators.LOWER_IS_WORSE and kind != "gain"
        if level is not None and (level < 0 or falls and level == 0):
            return f"{prefix}level is {level:g}; a level of {operator} must be {'above 0; use the operator off for nothing at all' if falls else '0 or more'}"
    return None


def read(files):
    """All rows of the tables as Trials. Raises Refusal with file, line and reason."""
    kept, seen = [], {}
    for path in files:
        for line, row in trial_table.numbered(path):
            where = f"{path}:{line}"
            identity = tuple(row.get(name) for name in IDENTITY)
            if identity in seen:
                raise Refusal(f"{where}: the same trial of {row['participant_id']} is already in {seen[identity]}; give each table once")
            seen[identity] = where
            if sentence := to_unit_of_operator(row) or no_severity(row):
                raise Refusal(f"{where}: {sentence}")
            kept.append(row)
    if not kept:
        raise Refusal(f"{files[0]}: holds no trials; run the study first")
    return of_rows(kept)


def usable(trials):
    """(Trials to analyse, number of missed ones)."""
    missed = trials["missed"] == 1
    return trials.where(~missed), int(np.count_nonzero(missed))
