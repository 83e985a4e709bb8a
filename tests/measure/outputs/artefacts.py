"""An artefact as a sequence of units, its digest, and the first difference between two of them.

A unit is a line of a table or of JSON, a block of a binary file, or a message of a log. The digest is the SHA-256 of all units.
A trail of short digests after 1, 2, 4, 8, ... units gives the approximate position of the first difference, without the bytes.
"""
import fnmatch
import hashlib
import itertools
import json
import os

from . import log_file

BLOCK_BYTES = 4096
TRAIL_DIGITS = 4  # hexadecimal digits of one mark of the trail; a mark is a hint, the SHA-256 decides
TABLES = (".csv", ".jsonl", ".txt")

# Rows of tables that differ between equal runs or between versions of the sources: {file name: {(column, value): reason}}.
EXCLUDED_ROWS = {
    "LOG_INFO.csv": {("field", "version"): "the version of the sources changes with every release"},
}
# Columns of tables: {file name: {column: reason}}.
EXCLUDED_COLUMNS = {
    "LOG_INFO.csv": {"version": "as above, in the table that has one row for each message"},
}
# Keys of JSON files, at any depth: {file name: {key: reason}}.
EXCLUDED_KEYS = {
    "schema.json": {"meaning": "is the comment of the message type: documentation, not output"},
}


class Digest:
    """SHA-256, size and trail of the units that update() is given."""

    def __init__(self):
        self.sha, self.bytes, self.count, self.trail = hashlib.sha256(), 0, 0, ""

    def update(self, unit):
        self.sha.update(unit)
        self.bytes += len(unit)
        self.count += 1
        if self.count & (self.count - 1) == 0:
            self.trail += self.sha.hexdigest()[:TRAIL_DIGITS]

    def record(self, unit_name):
        return {"sha256": self.sha.hexdigest(), "bytes": self.bytes, unit_name: self.count, "trail": self.trail}


def unit_name(path):
    """Name of a unit of this file."""
    if path.endswith(".json") or path.endswith(TABLES):
        return "lines"
    return "blocks"


def units(path, changes):
    """The units of a file, without the exclusions and with announced changes undone."""
    name = os.path.basename(path)
    if name.endswith(".json"):
        with open(path, encoding="utf-8") as file:
            value = changes.old_value(name, without_keys(json.load(file), EXCLUDED_KEYS.get(name, {})))
        yield from (line.encode() for line in json.dumps(value, indent=1, sort_keys=True).splitlines(keepends=True))
    elif name.endswith(TABLES):
        with open(path, "rb") as file:
            yield from changes.old_lines(name, kept_lines(name, file))
    else:
        with open(path, "rb") as file:
            yield from iter(lambda: file.read(BLOCK_BYTES), b"")


def without_keys(value, excluded):
    if isinstance(value, dict):
        return {key: without_keys(inner, excluded) for key, inner in value.items() if key not in excluded}
    if isinstance(value, list):
        return [without_keys(inner, excluded) for inner in value]
    return value


def kept_lines(name, lines):
    """Lines of a table without the excluded rows and columns. Cells with commas are not expected in such a table."""
    rows, columns = EXCLUDED_ROWS.get(name, {}), EXCLUDED_COLUMNS.get(name, {})
    lines = iter(lines)
    if not rows and not columns:
        yield from lines
        return
    names = next(lines, b"").rstrip(b"\r\n").split(b",")
    kept = [i for i, column in enumerate(names) if column.decode() not in columns]
    at = [(names.index(column.encode()), value.encode()) for column, value in rows if column.encode() in names]
    for cells in itertools.chain([names], (line.rstrip(b"\r\n").split(b",") for line in lines)):
        if not any(i < len(cells) and cells[i] == value for i, value in at):
            yield b",".join(cells[i] for i in kept if i < len(cells)) + b"\n"


def files_below(folder):
    """Paths of all artefacts below a folder, relative to it. Without logs of programs and plans."""
    found = []
    for where, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if name != "logs")
        found += [os.path.relpath(os.path.join(where, name), folder) for name in names]
    return sorted(found)


def records(folder, changes):
    """{artefact: record} of all that a case left in its folder; a log gives one for each channel."""
    found = {}
    for path in files_below(folder):
        whole = os.path.join(folder, path)
        if path.endswith(".lcmlog"):
            for channel, messages in log_file.by_channel(whole, changes).items():
                found[f"{path}:{channel}"] = digest_of(messages).record("messages")
        else:
            found[changes.old_name(path)] = digest_of(units(whole, changes)).record(unit_name(path))
    return found


def digest_of(sequence):
    digest = Digest()
    for unit in sequence:
        digest.update(unit)
    return digest


def sequence_of(folder, artefact, changes):
    """The units of one artefact that records() named, or None when it is missing."""
    path, colon, channel = artefact.partition(".lcmlog:")
    if colon:
        log = os.path.join(folder, path + ".lcmlog")
        return log_file.by_channel(log, changes).get(channel) if os.path.exists(log) else None
    for path in files_below(folder):
        if changes.old_name(path) == artefact:
            return units(os.path.join(folder, path), changes)
    return None


def first_difference(kind, ours, theirs, channel=""):
    """Position of the first difference of two sequences of units, as text. kind: "lines", "messages" or "blocks"; channel: of messages."""
    offset = 0
    for number, (one, two) in enumerate(itertools.zip_longest(ours, theirs)):
        if one != two:
            return describe(kind, number, offset, one, two, channel)
        offset += len(one)
    return "no difference"


def describe(kind, number, offset, one, two, channel):
    if one is None or two is None:
        return f"ends after {number} {kind} ({offset} bytes), the other continues" if one is None else f"continues after {number} {kind}, where the other ends"
    byte = next((i for i, (a, b) in enumerate(zip(one, two)) if a != b), min(len(one), len(two)))
    if kind == "lines":
        return f"line {number + 1}: {shown(one)} | before: {shown(two)}"
    if kind == "messages":
        return f"message {number} at {log_file.time_of(one)} us, {log_file.place(byte, channel)}"
    return f"byte {offset + byte}"


def shown(line, max_length=100):
    text = line.decode("utf-8", "replace").strip()
    return text if len(text) <= max_length else text[:max_length] + "..."


def rough_difference(kind, record, stored):
    """The same from two trails: between which counts of units the first difference lies."""
    marks = [record["trail"][i:i + TRAIL_DIGITS] for i in range(0, len(record["trail"]), TRAIL_DIGITS)]
    others = [stored["trail"][i:i + TRAIL_DIGITS] for i in range(0, len(stored["trail"]), TRAIL_DIGITS)]
    same = sum(1 for _ in itertools.takewhile(lambda pair: pair[0] == pair[1], zip(marks, others)))
    most = min(record[kind], stored.get(kind, 0))
    first, last = (1 << same >> 1) + 1, min(1 << same, most + 1)
    if record[kind] != stored.get(kind):
        return f"{record[kind]} {kind} instead of {stored.get(kind)}; the first difference lies in {first} to {last}"
    return f"the first difference lies in {kind} {first} to {min(last, most)}"


def matches(name, patterns):
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)
