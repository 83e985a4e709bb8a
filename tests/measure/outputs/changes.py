"""Announced changes: renamed things that a refactoring changes on purpose, undone before outputs are compared.

announced_changes.csv has a row for each: kind, where, old, new, reason. Lines that begin with # are comments.

| kind | where | old, new |
| program | | name of a program and the words that replace it, e.g. export_csv, "tactus export" |
| option | program, its old name | an option of the command line; the new one is used where the program's --help lists it |
| file | | name of a file that a program chooses itself |
| channel | | name of a channel |
| column | name of a table, with * | a column in the first line |
| key | name of a JSON file, with * | a key at any depth |
| text | name of a table or JSON file, with * | text within cells or values |
| accept | artefact, with * | empty; a difference is reported as announced and is no failure |
"""
import csv
import fnmatch
import os
import re

KINDS = ("program", "option", "file", "channel", "column", "key", "text", "accept")
FILE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "announced_changes.csv")
COLUMNS = ["kind", "where", "old", "new", "reason"]


class Refused(Exception):
    """One sentence on a table that cannot be used."""


def read(path=FILE):
    with open(path, encoding="utf-8", newline="") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        found = list(rows)
        if rows.fieldnames != COLUMNS:
            raise Refused(f"{path}: the first line must be {','.join(COLUMNS)}")
    for row in found:
        if row["kind"] not in KINDS or not row["reason"] or None in row or None in row.values():
            raise Refused(f"{path}: \"{','.join(str(cell) for cell in row.values())}\" needs five cells, a kind out of {', '.join(KINDS)} and a reason")
        if row["kind"] != "accept" and not (row["old"] and row["new"]):
            raise Refused(f"{path}: {row['kind']} \"{row['old']}\" needs an old and a new name")
    return Changes(found)


class Changes:
    """The rows, each applied to a name or to the content of an artefact: new names become old ones."""

    def __init__(self, rows=()):
        self.rows = list(rows)

    def of(self, kind, name=None):
        return [row for row in self.rows if row["kind"] == kind and (name is None or fnmatch.fnmatchcase(name, row["where"] or "*"))]

    def old_channel(self, channel):
        return next((row["old"] for row in self.of("channel") if row["new"] == channel), channel)

    def old_name(self, path):
        """The path that an artefact had, which is its name in the stored results."""
        folder, name = os.path.split(path)
        name = next((row["old"] for row in self.of("file") if row["new"] == name), name)
        stem, dot, extension = name.partition(".")
        if extension == "csv":
            name = self.old_channel(stem) + dot + extension
        return os.path.join(folder, name)

    def old_lines(self, name, lines):
        """Lines of a table, as bytes, with their old columns and texts."""
        columns, texts = self.of("column", name), [(row["new"].encode(), row["old"].encode()) for row in self.of("text", name)]
        for number, line in enumerate(lines):
            if number == 0 and columns:
                line = old_header(line, columns)
            for new, old in texts:
                line = line.replace(new, old)
            yield line

    def old_value(self, name, value):
        """A value of JSON with its old keys and texts."""
        keys = {row["new"]: row["old"] for row in self.of("key", name)}
        return old_json(value, keys, [(row["new"], row["old"]) for row in self.of("text", name)])

    def accepted(self, artefact):
        """The reason for which this artefact may differ, or None."""
        return next((row["reason"] for row in self.of("accept", artefact)), None)

    def words(self, folder, command, help_of):
        """The command line in the names that the programs of a folder have. help_of: a program's words give its --help."""
        program, *rest = command
        new = next((row["new"].split() for row in self.of("program") if row["old"] == program), None)
        if new and os.access(os.path.join(folder, new[0]), os.X_OK) and not os.access(os.path.join(folder, program), os.X_OK):
            front = new
        else:
            front = [program]
        front = [os.path.join(folder, front[0]), *front[1:]]
        for row in self.of("option", program):
            if row["old"] in rest and re.search(re.escape(row["new"]) + r"(?![\w-])", help_of(front)):
                rest = [row["new"] if word == row["old"] else word for word in rest]
        return [*front, *rest]


def old_header(line, columns):
    names = {row["new"].encode(): row["old"].encode() for row in columns}
    end = line[len(line.rstrip(b"\r\n")):]
    return b",".join(names.get(cell, cell) for cell in line.rstrip(b"\r\n").split(b",")) + end


def old_json(value, keys, texts):
    if isinstance(value, dict):
        return {keys.get(key, key): old_json(inner, keys, texts) for key, inner in value.items()}
    if isinstance(value, list):
        return [old_json(inner, keys, texts) for inner in value]
    if isinstance(value, str):
        for new, old in texts:
            value = value.replace(new, old)
    return value
