#!/usr/bin/python3 -I
"""Turns the settings.csv of the nodes into code and documentation.

  generate_settings.py header NODE/settings.csv OUT.h     the Settings struct of one node
  generate_settings.py all OUT.h NODE/settings.csv ...    the rows of all nodes, to check a scene with
  generate_settings.py markdown OUT.md NODE/settings.csv ...  the table for people

Columns: name,unit,default,min,max,meaning,source[,safety[,live]]. A unit is SI ("s", "N/m", "1"), "count", "bool", "text", or a
choice "a|b|c", in which "p:*" stands for any word after "p:". A row without a source is an error: a constant without a source is a bug. safety: "max" or "min" marks an
upper or a lower limit that protects a person; a scene may only tighten it. live: "yes" marks what `tactus set` may change while the node
runs.
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import csv

SUFFIX = {"1": "", "count": "", "bool": "", "text": "", "%": ""}


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for number, row in enumerate(rows, start=2):
        if None in row:
            sys.exit(f"{path}:{number}: has more fields than the header; check for an unquoted comma or a missing column")
        for column in ("name", "unit", "default", "min", "max", "meaning", "source"):
            if row.get(column) is None or (not row[column] and column not in ("min", "max", "default")):
                sys.exit(f"{path}:{number}: column {column} is empty; give every setting a name, unit, meaning and source")
        check_default(f"{path}:{number}: setting {row['name']}", row)
        check_safety(f"{path}:{number}: setting {row['name']}", row)
        row["live"] = row.get("live") or ""
        if row["live"] not in ("", "yes"):
            sys.exit(f"{path}:{number}: setting {row['name']}: live {row['live']!r} is neither yes nor empty")
    names = [row["name"] for row in rows]
    for name in names:
        if names.count(name) > 1:
            sys.exit(f"{path}: setting {name} is there twice")
    return rows


def check_default(place, row):
    """Checks that the node would accept the default."""
    unit, default = row["unit"], row["default"]
    if "|" in unit:
        if default not in unit.split("|"):
            sys.exit(f"{place}: the default {default!r} is none of {unit}")
    elif unit == "bool":
        if default not in ("true", "false", "1", "0"):
            sys.exit(f"{place}: the default {default!r} is neither true nor false")
    elif unit != "text":
        try:
            low, value, high = float(row["min"]), float(default), float(row["max"])
        except ValueError:
            sys.exit(f"{place}: min, default and max must be numbers")
        if not low <= value <= high:
            sys.exit(f"{place}: the default {default} is outside {row['min']} .. {row['max']}")


def check_safety(place, row):
    row["safety"] = row.get("safety") or ""
    if row["safety"] not in ("", "min", "max"):
        sys.exit(f"{place}: safety {row['safety']!r} is neither min nor max nor empty")
    if row["safety"] and (row["unit"] in ("bool", "text") or "|" in row["unit"]):
        sys.exit(f"{place}: safety {row['safety']} is for numbers, and this is none")


def node_of(path):
    return os.path.basename(os.path.dirname(os.path.abspath(path)))


def is_text(row):
    return row["unit"] == "text" or "|" in row["unit"]


def field(row):
    unit = row["unit"]
    if is_text(row) or unit in SUFFIX:
        return row["name"]
    return row["name"] + "_" + unit.replace("/", "_").replace("*", "").replace(" ", "")


def ctype(row):
    if is_text(row):
        return "std::string"
    return {"bool": "bool", "count": "int"}.get(row["unit"], "double")


def initial(row):
    if is_text(row):
        return quoted(row["default"])
    if row["unit"] == "bool":
        return "true" if row["default"] in ("true", "1") else "false"
    return row["default"]


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def initializer(row):
    low = row["min"] or "0"
    high = row["max"] or "0"
    return ("{" + ", ".join([quoted(row["name"]), quoted(row["unit"]), quoted(row["default"]), low, high,
                              quoted(row["meaning"]), quoted(row["source"]), quoted(row["safety"]),
                              "true" if row["live"] else "false"]) + "}")


def write(path, text):
    os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def header(source, out):
    rows = read(source)
    space = node_of(source).replace("_node", "")
    lines = [f"// Generated from {node_of(source)}/settings.csv; edit that.", "#pragma once", "#include <array>",
             "#include <span>", "#include <string>", '#include "sync/text/settings.h"', f"namespace tactus::{space} {{",
             "struct Settings {"]
    for row in rows:
        lines += [f"  // {row['meaning']} [{row['unit']}] Source: {row['source']}",
                  f"  {ctype(row)} {field(row)} = {initial(row)};"]
    lines += ["};", f"inline const std::array<sync::SettingField<Settings>, {len(rows)}> kSettingFields = {{{{"]
    lines += [f"  {{{initializer(row)}, &Settings::{field(row)}}}," for row in rows]
    lines += ["}};", "inline std::span<const sync::SettingField<Settings>> setting_fields() { return kSettingFields; }",
              f"}}  // namespace tactus::{space}", ""]
    write(out, "\n".join(lines))


def all_rows(out, sources):
    lines = ["// Generated from the settings.csv of every node; edit those.", "#pragma once", "#include <array>",
             '#include "sync/text/settings.h"', "namespace tactus {",
             "struct NodeSettingRow { const char* node; sync::SettingRow row; };"]
    entries = [(node_of(s), row) for s in sources for row in read(s)]
    lines += [f"inline const std::array<NodeSettingRow, {len(entries)}> kAllSettings = {{{{"]
    lines += [f"  {{{quoted(node)}, {initializer(row)}}}," for node, row in entries]
    lines += ["}};", "}  // namespace tactus", ""]
    write(out, "\n".join(lines))


def unverified(source):
    """Names of the settings of this table whose source is marked as unverified in docs/constants.csv."""
    root = os.path.dirname(os.path.dirname(os.path.abspath(source)))
    path, table = os.path.join(root, "docs", "constants.csv"), f"{node_of(source)}/settings.csv"
    if not os.path.exists(path):
        return set()
    with open(path, newline="", encoding="utf-8") as file:
        return {row["constant"] for row in csv.DictReader(file) if row["table"] == table and row["status"] == "unverified"}


def markdown(out, sources):
    lines = ["# Settings", "",
             "Every option and constant of every node. In a scene: `<tactus:NODE name=\"value\"/>` inside `<world>`, for",
             "example `<tactus:audio_node presentation_delay=\"20ms\"/>`; for a run: `./scripts/run --set NODE.NAME=VALUE`; on the",
             "command line of a node: `--set NAME=VALUE`.",
             "A limit that protects a person has a second, narrower range for scenes, because scenes arrive over the bus from any sender:",
             "a scene may tighten it; only `--set`, of `run` or of the node, loosens it beyond its default.",
             "Settings marked *live* can be changed while the node runs: `tactus set NODE NAME=VALUE`.",
             "Sources marked *unverified* were not checked: [constants.csv](constants.csv) lists how the others were.",
             "Generated from each folder's `settings.csv` by `cmake/generate_settings.py`; a test keeps it up to date.", ""]
    for source in sources:
        unchecked = unverified(source)
        lines += [f"## {node_of(source)}", "", "| name | unit | default | range | meaning | source |",
                  "|---|---|---|---|---|---|"]
        for row in read(source):
            limits = f"{row['min']} .. {row['max']}" if row["min"] or row["max"] else ""
            if row["safety"]:
                low, high = ("min", "default") if row["safety"] == "max" else ("default", "max")
                limits += f"; in a scene {row[low]} .. {row[high]}"
            if row["live"]:
                limits = (limits + "; " if limits else "") + "live"
            cells = [f"`{row['name']}`", row["unit"].replace("|", ", "), row["default"], limits, row["meaning"],
                     row["source"] + (" *(unverified)*" if row["name"] in unchecked else "")]
            lines.append("| " + " | ".join(c.replace("|", "\\|") for c in cells) + " |")
        lines.append("")
    write(out, "\n".join(lines))


def main():
    if len(sys.argv) >= 4 and sys.argv[1] == "header":
        header(sys.argv[2], sys.argv[3])
    elif len(sys.argv) >= 3 and sys.argv[1] == "all":
        all_rows(sys.argv[2], sys.argv[3:])
    elif len(sys.argv) >= 3 and sys.argv[1] == "markdown":
        markdown(sys.argv[2], sys.argv[3:])
    else:
        print(__doc__)
        sys.exit(0 if sys.argv[1:] in (["--help"], ["-h"]) else 1)


main()
