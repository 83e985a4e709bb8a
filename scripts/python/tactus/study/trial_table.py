"""The trial table: long format, one row for each trial (or game) and question, CSV (RFC 4180, UTF-8, decimal points, one header line).

COLUMNS is the only list of its columns: the BIDS sidecars, docs/study_formats.md and all writers and readers of trial tables use it.
Empty: not applicable, or not measured.
"""
import csv
import io
import math
import os
import pathlib
from typing import NamedTuple

from tactus import own_files
from tactus.refusal import Refusal, sentence_of
from tactus.tables import decoded, escaped, records, unescaped

LARGEST_BYTES = 1_000_000_000  # design: five million rows
LONGEST_TEXT = 100_000         # characters of one field; design: an answer in words
ALL, POSITIVE, SHARE = (-math.inf, math.inf), (0.0, math.inf), (0.0, 1.0)


class Column(NamedTuple):
    """kind: text, whole (a whole number), number or flag (0 or 1). within: range of a number (least, most). levels: permitted texts; (): any."""
    unit: str
    description: str
    kind: str = "text"
    within: tuple = ALL
    levels: tuple = ()


COLUMNS = {
    "participant_id": Column("", "name of the participant, as given at the start of the session"),
    "session": Column("", "number of the session of this participant, from 1", "whole", POSITIVE),
    "block": Column("", "number of the block within the session, from 1", "whole", POSITIVE),
    "trial": Column("", "number of the trial in order of presentation, repetitions included, from 1", "whole", POSITIVE),
    "task": Column("", "task of the participant: sj synchrony judgement, toj temporal order judgement, 2ifc which of two intervals, rating, matching, "
                       "game", levels=("sj", "toj", "2ifc", "rating", "matching", "game", "free")),
    "pair": Column("", "the two senses of the judged asynchrony, as a,b: SOA(a, b) = t_present(b) - t_present(a), positive when b is later"),
    "modality_degraded": Column("", "degraded sense, for a stage of touch with its name: haptic:action, haptic:force or haptic:percept; empty: none"),
    "operator": Column("", "operator that degraded it: delay, jitter, loss, rate, ... as sync/degradation names it"),
    "level": Column("of the column unit", "requested level of the operator", "number"),
    "unit": Column("", "unit of level"),
    "soa_nominal_ms": Column("ms", "requested asynchrony", "number"),
    "soa_achieved_ms": Column("ms", "asynchrony measured from the presentation times of both senses; fits use it", "number"),
    "soa_uncertainty_ms": Column("ms", "uncertainty of soa_achieved_ms, clock maps included", "number", POSITIVE),
    "d_base_ms": Column("ms", "common base delay of all senses, to which asynchronies are added", "number"),
    "loss_nominal": Column("", "requested share of lost messages", "number", SHARE),
    "loss_achieved": Column("", "measured share of lost messages", "number", SHARE),
    "seed": Column("", "seed of all random draws of this trial", "whole", POSITIVE),
    "profile_sha256": Column("", "SHA-256 of the degradation profile in force, in hexadecimal digits"),
    "response": Column("", "answer: yes or no (together or not); the first sense; first or second interval; text of the choice"),
    "correct": Column("", "whether the answer was right; empty: no answer is right or wrong", "flag", SHARE),
    "response_time": Column("s", "time from the question to the answer", "number", POSITIVE),
    "completion_time_s": Column("s", "time from the start of the game to its end; the time limit if it was not won", "number", POSITIVE),
    "peak_force_n": Column("N", "largest felt force", "number", POSITIVE),
    "force_rmse_n": Column("N", "root mean square of the difference to the force of the undegraded rendering", "number", POSITIVE),
    "jnd_tube_frac": Column("", "share of the time in which that difference was below the just noticeable difference", "number", SHARE),
    "stiffness_first_n_m": Column("N/m", "felt stiffness of the first of two presses: the slope of the force over the depth of the hand", "number"),
    "stiffness_second_n_m": Column("N/m", "felt stiffness of the second of two presses", "number"),
    "degraded_interval": Column("", "which of two intervals was degraded, 1 or 2", "whole", POSITIVE),
    "e_gen_j": Column("J", "energy that the rendering generated; a passive rendering dissipates energy", "number"),
    "n_events": Column("", "expected contact events", "whole", POSITIVE),
    "n_dropped": Column("", "expected contact events that were not presented", "whole", POSITIVE),
    "log_file": Column("", "log of all bus messages, relative to the participant's folder"),
    "log_offset": Column("s", "time of the stimulus, or of the start of the game, since the start of the log", "number"),
    "observer": Column("", "source of the answers: a human, or a simulated observer or player", levels=("human", "simulated")),
    "player": Column("", "simulated player of a game: stage_model, the player of fixed rules, or observer, a model of people, with its number in the population; empty: "
                         "a person, or a table from before this column"),
    "failed_checks": Column("", "numbers of the twelve checks that this player of a population fails, or none; empty: it has no checks"),
    "study": Column("", "name of the study"),
    "condition": Column("", "name of the condition within the study"),
    "second_modality": Column("", "second sense, degraded at the same time, as modality_degraded; empty: none"),
    "second_operator": Column("", "operator that degraded the second sense"),
    "second_level": Column("of the column second_unit", "requested level of the second operator", "number"),
    "second_unit": Column("", "unit of second_level"),
    "missed": Column("", "1: the apparatus missed its tolerance; the trial is repeated and not analysed", "flag", SHARE),
    "missed_reason": Column("", "reason why the trial was missed, in words"),
    "repeated_as": Column("", "number of the trial that repeated this one; empty: none", "whole", POSITIVE),
    "success": Column("", "whether the game was won", "flag", SHARE),
    "errors": Column("", "mistakes in the game: balls in wrong holes", "whole", POSITIVE),
    "path_m": Column("m", "length of the path of the tool in the game", "number", POSITIVE),
    "question": Column("", "text of the question"),
    "answer_value": Column("as asked for", "answer as a number: rating or matched value", "number"),
    "latency_profile": Column("", "source of device latencies that were not measured in the trial"),
}
NEEDED = ("participant_id", "task", "observer")


def text_of(value):
    """Text of a field: numbers in the shortest decimal form that reads back the same value."""
    if value is None or value == "":
        return ""
    if isinstance(value, bool):
        return str(int(value))
    return repr(float(value)) if isinstance(value, float) else str(value)


def wrong(row):
    """The first error of a row {column: value}, as a sentence; None: the row is valid."""
    for name, value in row.items():
        if name not in COLUMNS:
            return f"there is no column {name}; trial_table.py lists the columns"
        column = COLUMNS[name]
        if value is None or value == "":
            continue
        if column.kind == "text":
            if not isinstance(value, str):
                return f"{name} is {value!r}; it must be a text"
            if "\0" in value or len(value) > LONGEST_TEXT:
                return f"{name} has a zero byte or more than {LONGEST_TEXT} characters; shorten it"
            if column.levels and value not in column.levels:
                return f"{name} is '{value[:40]}'; it must be {' or '.join(column.levels)}"
            continue
        if not isinstance(value, (int, float)) or not math.isfinite(value):
            return f"{name} is {str(value)[:40]!r}; it must be a finite number"
        if column.kind in ("whole", "flag") and value != int(value):
            return f"{name} is {value}; it must be a whole number"
        if not column.within[0] <= value <= column.within[1]:
            return f"{name} is {value}; it must be within {column.within[0]:g} to {column.within[1]:g}"
    for name in NEEDED:
        if not row.get(name):
            return f"{name} is empty; fill it in every row"
    return None


def fields_of(row):
    """The fields of a row. A text that a spreadsheet would run as a formula is escaped; value_of() reads the text again."""
    return [escaped(text_of(row.get(name))) if column.kind == "text" else text_of(row.get(name)) for name, column in COLUMNS.items()]


def text(rows):
    """The table as text. Raises ValueError with the number of the invalid row (from 1) and the reason."""
    file = io.StringIO()
    out = csv.writer(file, lineterminator="\r\n")
    out.writerow(COLUMNS)
    for number, row in enumerate(rows, start=1):
        sentence = wrong(row)
        if sentence:
            raise ValueError(f"row {number}: {sentence}")
        out.writerow(fields_of(row))
    return file.getvalue()


def write(path, rows):
    """Writes the table atomically: a reader never sees a partial table."""
    replace(path, text(rows))


def replace(path, content):
    """Replaces a file atomically. content: text, or bytes."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        part.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def value_of(written, name):
    """The value of a field; raises ValueError with the reason."""
    column = COLUMNS[name]
    if column.kind == "text":
        return unescaped(written)
    if written == "":
        return None
    try:
        value = float("" if "_" in written else written)  # Python alone reads 1_0 as 10
        if column.kind != "number" and math.isfinite(value) and value == int(value):
            return int(written) if written.lstrip("+-").isdigit() else int(value)
        return value
    except ValueError:
        raise ValueError(f"{name} is '{written[:40]}'; write a number, or leave it empty if it does not apply") from None


def read(path):
    """[{column: value}] of a table: texts, whole numbers, floats; None for an empty number. Absent columns are left out.

    Raises Refusal with file, line and reason: one invalid row refuses the whole table."""
    return [row for _, row in numbered(path)]


def numbered(path):
    """[(line number, row)], as read()."""
    try:
        data = own_files.read_regular(path, LARGEST_BYTES)
    except OSError as error:
        raise Refusal(f"{path}: cannot be read ({sentence_of(error)}); give a table of trials") from None
    return lines_of(data, path)


def parsed(data, path):
    """As read(), from the bytes of a table. path: for messages."""
    return [row for _, row in lines_of(data, path)]


def lines_of(data, path):
    if len(data) > LARGEST_BYTES:
        raise Refusal(f"{path}: is longer than {LARGEST_BYTES} bytes; give a smaller table of trials")
    csv.field_size_limit(max(csv.field_size_limit(), LONGEST_TEXT))
    return list(rows_of(records(decoded(data, path), path), path))


def rows_of(lines, path):
    at, header = next(lines, (1, []))
    for name in header:
        if name not in COLUMNS or header.count(name) > 1:
            what = "occurs twice" if name in COLUMNS else "is not a column of trial tables"
            raise Refusal(f"{path}:{at}: the column '{name[:40]}' {what}; use each column once, named as in docs/study_formats.md")
    for name in NEEDED:
        if name not in header:
            raise Refusal(f"{path}:{at}: there is no column {name}; every trial table needs {', '.join(NEEDED)}")
    for line, fields in lines:
        where = f"{path}:{line}"
        try:
            row = {name: value_of(field, name) for name, field in zip(header, fields)}
        except ValueError as error:
            raise Refusal(f"{where}: {error}") from None
        sentence = wrong(row)
        if sentence:
            raise Refusal(f"{where}: {sentence}")
        yield line, row
