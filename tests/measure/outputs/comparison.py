"""Records of artefacts compared with stored ones, and how the result is printed."""
import dataclasses

from . import artefacts

IDENTICAL, DIFFERS, MISSING, NEW, ANNOUNCED, FAILED = "identical", "DIFFERS", "MISSING", "NEW", "announced", "FAILED"
FAILURES = (DIFFERS, MISSING, NEW, FAILED)


@dataclasses.dataclass
class Row:
    artefact: str  # case and artefact
    result: str
    detail: str = ""
    record: dict = dataclasses.field(default_factory=dict)


def kind_of(record):
    """Name of the units of an artefact."""
    return next(name for name in ("lines", "messages", "blocks") if name in record)


def compare(case, ours, theirs, changes, locate):
    """A row for each artefact of one case. ours, theirs: {artefact: record}; locate(artefact, record, stored) gives the first
    difference as text."""
    if not theirs:
        return [Row(case, NEW, f"the case is not stored; --store adds its {len(ours)} artefacts")]
    rows = []
    for name in sorted(ours.keys() | theirs.keys()):
        record, stored = ours.get(name), theirs.get(name)
        row = Row(f"{case}/{name}", IDENTICAL, record=record or {})
        if record is None:
            row.result, row.detail = MISSING, f"stored with {stored['bytes']} bytes"
        elif stored is None:
            row.result, row.detail = NEW, f"{record['bytes']} bytes, not stored"
        elif record["sha256"] != stored["sha256"]:
            row.result, row.detail = DIFFERS, locate(name, record, stored)
        reason = changes.accepted(row.artefact)
        if row.result != IDENTICAL and reason:
            row.result, row.detail = ANNOUNCED, f"{row.result}, {reason}: {row.detail}"
        rows.append(row)
    return rows


def locate_in(folder, other, changes):
    """locate() of compare() for two folders with artefacts; some may be missing in other."""
    def locate(name, record, stored):
        ours, theirs = (artefacts.sequence_of(where, name, changes) for where in (folder, other))
        if ours is None or theirs is None:
            return locate_by_trail(name, record, stored)
        return artefacts.first_difference(kind_of(record), ours, theirs, name.rpartition(":")[2])
    return locate


def locate_by_trail(_, record, stored):
    return artefacts.rough_difference(kind_of(record), record, stored)


def print_rows(rows, everything, file):
    """One line for each artefact; identical ones only with everything, else as a count for each case."""
    width = max((len(row.artefact) for row in rows), default=0)
    for row in rows:
        if everything or row.result != IDENTICAL:
            size = f"{row.record.get('bytes', 0)} bytes" if row.result == IDENTICAL else row.detail
            print(f"{row.artefact.ljust(width)}  {row.result.ljust(9)}  {size}", file=file, flush=True)


def counts(rows):
    """{result: number of rows}."""
    found = {}
    for row in rows:
        found[row.result] = found.get(row.result, 0) + 1
    return found


def total(rows):
    """One line on all rows."""
    return ", ".join(f"{number} {result}" for result, number in sorted(counts(rows).items(), key=lambda pair: -pair[1])) or "no artefacts"
