#!/usr/bin/python3 -I
"""Checks that every constant of a table has a source that was checked or the mark `unverified`.

  check_constants.py [ROOT]           prints every offence as FILE: what; exits 1 when there is one
  check_constants.py [ROOT] --list    prints table, constant, value and source of every constant that needs an entry

Constants are the rows of the settings.csv of every folder, of TABLES, the parameters with a source in scripts/studies/*.xml, the results and
settings of scripts/studies/published/*.xml, and the C++ tables: constexpr initialisers of four or more numbers, at least two of them with decimals, with the comments above and within as source. A source that begins
with "design" and cites nothing needs no more. Every other constant has a row in docs/constants.csv: table, constant, value (of a C++
table the checksum of its numbers), status and evidence. Status: `read` (the value stands in the source, or in its abstract), `quoted` (in a
text that cites the source), `computed` (it follows from a formula), `design` (a choice of this project), `unverified`. A row whose value is no longer that
of the table is an offence, so that a changed constant is checked again. So is a new CSV file that neither TABLES nor OTHER names.
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import csv
import glob
import hashlib
import re
import xml.etree.ElementTree as xml

REGISTER = "docs/constants.csv"
COLUMNS = ["table", "constant", "value", "status", "evidence"]
STATUSES = ("read", "quoted", "computed", "design", "unverified")
# A table: the columns that name a constant, those of its value, and that of its source.
TABLES = {
    "sync/presentation/thresholds.csv": [(("earlier", "later", "what", "source"), ("threshold_ms",), "source")],
    "scripts/python/tactus/information/noise.csv": [(("property",), ("value", "unit"), "source")],
    "scripts/python/tactus/study/just_noticeable.csv": [(("property", "situation"), ("jnd", "unit", "criterion", "percent"), "source")],
    "sim_node/scenes/materials.csv": [
        (("name", "=elastic"), ("youngs_modulus_Pa", "poissons_ratio", "density_kg_m3"), "elastic_source"),
        (("name", "=damping"), ("rayleigh_alpha_1_s", "rayleigh_beta_s"), "damping_source"),
        (("name", "=surface"), ("friction_static", "friction_dynamic", "restitution"), "surface_source"),
        (("name", "=thermal"), ("conductivity_W_mK", "specific_heat_J_kgK", "temperature_degC"), "thermal_source")],
}
# CSV files of other content than constants, with that content.
OTHER = {
    "*/modality.csv": "limits of operators",
    "docs/constants.csv": "this register",
    "docs/how_far/players.csv": "verdicts of simulated players",
    **{f"docs/how_far/battery/{name}.csv": "results of the battery" for name in ("limits", "curves", "pairs")},
    "examples/*/settings.csv": "settings of an example",
    "scripts/python/tactus/cluster/traffic.csv": "measured rates of messages",
    "visual_node/rooms/*.csv": "rooms",
}
CITATION = re.compile(r"\b(?:1[89]|20)\d\d\b|\b(?:ISO|IEC|EN|DIN|NIOSH|ITU|EBU|ATSC)\b|[Hh]andbook|Incropera|Serway|Eurocode|doi ")
CPP_TABLE = re.compile(r"constexpr\b[^;={}()]*?\b(\w+)\s*(?:\[[^\]]*\]\s*)*=?\s*\{")
NUMBER = re.compile(r"(?<![\w.])-?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
CPP_FOLDERS = ("sync", "sim_node", "haptic_node", "audio_node", "visual_node", "thermal_node", "lcmtypes", "scripts", "examples")


def is_own(source):
    """Whether the source is a choice of this project that rests on nothing else."""
    return source.lower().startswith("design") and not CITATION.search(source)


def rows_of(root, path):
    with open(os.path.join(root, path), newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def csv_constants(root):
    """(table, constant, value, source) of every row."""
    for path in sorted(glob.glob("*/settings.csv", root_dir=root) + glob.glob("tests/*/settings.csv", root_dir=root)):
        for row in rows_of(root, path):
            yield path, row["name"], row["default"], row["source"] or ""
    for path, groups in TABLES.items():
        for row in rows_of(root, path) if os.path.exists(os.path.join(root, path)) else []:
            for names, values, source in groups:
                name = ", ".join(n[1:] if n[0] == "=" else row[n] for n in names)
                yield path, name, " ".join(filter(None, (row[v] for v in values))), row[source] or ""


def xml_constants(root):
    for path in sorted(glob.glob("scripts/studies/*.xml", root_dir=root)):
        for node in xml.parse(os.path.join(root, path)).iter():
            if "source" in node.attrib and "value" in node.attrib:
                yield path, node.get("name", node.tag), node.get("value"), node.get("source")
    for path in sorted(glob.glob("scripts/studies/published/*.xml", root_dir=root)):
        yield from published_constants(path, xml.parse(os.path.join(root, path)).getroot())


def published_constants(path, root):
    """Published results with a number, and settings that are numbers, of a published experiment."""
    for expected in root.iter("expect"):
        if "value" in expected.attrib:
            yield path, expected.get("quantity"), expected.get("value"), expected.get("source", "")
    for place in (root.find("trial"), *root.iter("condition")):
        for setting in place.iter("setting"):
            if re.fullmatch(NUMBER, setting.get("value", "")):
                yield path, "/".join(filter(None, (place.get("id"), setting.get("name")))), setting.get("value"), setting.get("source", "")


def initialiser(text, begin):
    depth = 0
    for at in range(begin, len(text)):
        depth += (text[at] == "{") - (text[at] == "}")
        if depth == 0:
            return text[begin:at + 1]
    return text[begin:]


def comments(text, begin, body):
    """The comments of the paragraph before a declaration, within it, and behind it."""
    paragraph = re.split(r"\n[ \t]*\n", text[:begin])[-1]
    lines = [*paragraph.split("\n"), *(body.split("\n") if "\n" in body else text[begin:].split("\n")[:1])]
    return " ".join(part.strip() for line in lines for part in re.findall(r"//(.*)", line))


def cpp_constants(root):
    for path in sorted(p for folder in CPP_FOLDERS for end in ("h", "cpp") for p in glob.glob(f"{folder}/**/*.{end}", root_dir=root, recursive=True)):
        with open(os.path.join(root, path), encoding="utf-8") as file:
            text = file.read()
        for match in CPP_TABLE.finditer(text):
            body = initialiser(text, match.end() - 1)
            numbers = NUMBER.findall(re.sub(r'//[^\n]*|"[^"\n]*"', "", body))
            if len(numbers) >= 4 and sum("." in n or "e" in n.lower() for n in numbers) >= 2:
                checksum = hashlib.sha256(" ".join(numbers).encode()).hexdigest()[:12]
                yield path, match[1], checksum, comments(text, match.start(), body)


def constants(root):
    return [*csv_constants(root), *xml_constants(root), *cpp_constants(root)]


def unlisted(root):
    """CSV files that are neither tables nor named as something else."""
    known = set(TABLES) | {p for pattern in [*OTHER, "*/settings.csv"] for p in glob.glob(pattern, root_dir=root)}
    found = (p for folder in (*CPP_FOLDERS, "docs") for p in glob.glob(f"{folder}/**/*.csv", root_dir=root, recursive=True))
    return [f"{p}: this table is not listed; add it to TABLES or OTHER of tests/scripts/check_constants.py" for p in sorted(set(found) - known)]


def register_offences(rows):
    seen = set()
    for number, row in enumerate(rows, 2):
        place, key = f"{REGISTER}:{number}", (row["table"], row["constant"])
        if key in seen:
            yield f"{place}: {row['table']}: {row['constant']} has two rows"
        seen.add(key)
        if row["status"] not in STATUSES:
            yield f"{place}: the status {row['status']!r} is none of {', '.join(STATUSES)}"
        elif row["status"] != "unverified" and not row["evidence"]:
            yield f"{place}: {row['constant']} is {row['status']} without evidence; name what was read or computed"


def offences(root):
    if not os.path.exists(os.path.join(root, REGISTER)):
        return [f"{REGISTER}: is missing"]
    rows = rows_of(root, REGISTER)
    if not rows or list(rows[0]) != COLUMNS:
        return [f"{REGISTER}:1: the columns are not {','.join(COLUMNS)}"]
    found = [*unlisted(root), *register_offences(rows)]
    checked = {(row["table"], row["constant"]): row for row in rows}
    present = set()
    for table, constant, value, source in constants(root):
        present.add((table, constant))
        row = checked.get((table, constant))
        if row is None and not source.strip():
            found.append(f"{table}: {constant} has no source; name one, or `design` for a choice of this project")
        elif row is None and not is_own(source):
            found.append(f"{table}: {constant} = {value} has an unchecked source; add it to {REGISTER} as read, quoted, computed or unverified")
        elif row and row["value"] != value:
            found.append(f"{table}: {constant} was checked as {row['value']} and is {value}; check it again and correct {REGISTER}")
    found += [f"{REGISTER}: {table}: there is no constant {constant}" for table, constant in checked if (table, constant) not in present]
    return found


def main():
    words = [w for w in sys.argv[1:] if w != "--list"]
    if words and words[0] in ("-h", "--help"):
        print(__doc__)
        return 0
    root = words[0] if words else "."
    if "--list" in sys.argv:
        writer = csv.writer(sys.stdout, lineterminator="\n")
        writer.writerows(c for c in constants(root) if not is_own(c[3]))
        return 0
    found = offences(root)
    print("\n".join(found) if found else "constants: clean")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
