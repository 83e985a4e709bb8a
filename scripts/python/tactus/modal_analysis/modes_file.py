"""Files of measured modes: a table (CSV), which a material of a scene refers to, and the material itself (XML)."""
import csv
import math
import os
import re

from tactus import own_xml, terminal
from tactus.refusal import Refusal
from tactus.paths import SCENES
from tactus.tables import read_rows

COLUMNS = ("frequency_Hz", "damping_1_s", "amplitude", "decay_frequency_Hz", "decay_damping_1_s", "agrees")
NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_ .-]*")


def number(value):
    return f"{value:.6g}" if math.isfinite(value) else ""


def rows_of(modes):
    for m in modes:
        yield [f"{m.frequency_Hz:.4f}", number(m.damping_1_s), number(m.amplitude), number(m.decay_frequency_Hz), number(m.decay_damping_1_s),
               int(m.agrees)]


def write_csv(path, modes):
    try:
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS)
            writer.writerows(rows_of(modes))
    except OSError as e:
        raise Refusal(f"{path} cannot be written: {e.strerror}; give another file") from e


def builtin_materials():
    return [row["name"] for row in read_rows(SCENES / "materials.csv")]


def write_xml(path, analysis, name, base):
    """Writes the material as an element for the world of a scene, and its modes beside it as NAME.modes.csv; returns the path of that table."""
    known = builtin_materials()
    if not NAME.fullmatch(name):
        raise Refusal(f'"{name}" is not a valid name of a material; use letters, digits, dots, spaces, - and _')
    if base is None and name not in known:
        raise Refusal(f'"{name}" is a new material, and a sound does not contain its stiffness or friction; give a similar material with '
                      f"--base {'|'.join(known)}")
    if base is not None and base not in known:
        raise Refusal(f'there is no material "{base}"; give --base with one of {", ".join(known)}')
    table = os.path.splitext(path)[0] + ".modes.csv"
    if terminal.readable(os.path.basename(table)) != os.path.basename(table):
        raise Refusal(f"--out {path}: the material names its table, so its name must be UTF-8 without control characters; rename it")
    write_csv(table, analysis.modes)
    law = analysis.law
    words = [f"name={own_xml.quoted(name)}"] + ([f"base={own_xml.quoted(base)}"] if base else [])
    words += [f'rayleigh_alpha="{law["rayleigh_alpha_1_s"]:.6g}"', f'rayleigh_beta="{law["rayleigh_beta_s"]:.6g}"',
              f"modes={own_xml.quoted(os.path.basename(table))}"]
    try:
        with open(path, "w", encoding="utf-8") as file:
            file.write(f"<tactus:material {' '.join(words)}/>\n")
    except OSError as e:
        raise Refusal(f"{path} cannot be written: {e.strerror}; give another file") from e
    return table


def as_json(analysis):
    clean = lambda x: x if not isinstance(x, float) or math.isfinite(x) else None
    return {"rate_Hz": analysis.rate, "begins_s": analysis.begins / analysis.rate,
            "modes": [{c: clean(getattr(m, c)) for c in COLUMNS} for m in analysis.modes], "damping": analysis.law}
