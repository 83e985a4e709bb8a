"""The trial table: long format, one row for each trial (or game) and question, CSV (RFC 4180, UTF-8, decimal points, one header line).

COLUMNS is the one list of its columns: the sidecars of BIDS, docs/study_formats.md and all who write or read such tables hold to it.
Empty: not applicable, or not measured.
"""
import csv
import io
import math
import os
import pathlib
from typing import NamedTuple

from tactus.refusal import Refusal, sentence_of

LARGEST_BYTES = 1_000_000_000  # design: five million rows
LONGEST_TEXT = 100_000         # characters of one field; design: an answer in words
ALL, POSITIVE, SHARE = (-math.inf, math.inf), (0.0, math.inf), (0.0, 1.0)


class Column(NamedTuple):
    """kind: text, whole (a whole number), number or flag (0 or 1). within: of numbers (least, most). levels: of texts that are one of a few."""
    unit: str
    description: str
    kind: str = "text"
    within: tuple = ALL
    levels: tuple = ()


COLUMNS = {
    "participant_id": Column("", "who took part, as named when the session began"),
    "session": Column("", "number of the session of this participant, from 1", "whole", POSITIVE),
    "block": Column("", "number of the block within the session, from 1", "whole", POSITIVE),
    "trial": Column("", "number of the trial in the order in which trials were presented, repeated ones counted, from 1", "whole", POSITIVE),
    "task": Column("", "what was judged or done: sj synchrony judgement, toj temporal order judgement, 2ifc which of two intervals, rating, matching, "
                       "game", levels=("sj", "toj", "2ifc", "rating", "matching", "game", "free")),
    "pair": Column("", "the two senses whose asynchrony is judged, as a,b: SOA(a, b) = t_present(b) - t_present(a), positive when b is later"),
    "modality_degraded": Column("", "sense that was degraded; empty: none"),
    "operator": Column("", "what was wrong with it: delay, jitter, loss, rate, ... as sync/degradation names it"),
    "level": Column("of the column unit", "how much of it was asked for", "number"),
    "unit": Column("", "unit of level"),
    "soa_nominal_ms": Column("ms", "asynchrony that was asked for", "number"),
    "soa_achieved_ms": Column("ms", "asynchrony that was measured from when each sense presented the event; what is fitted", "number"),
    "soa_uncertainty_ms": Column("ms", "of soa_achieved_ms: how far off it may be, clock maps included", "number", POSITIVE),
    "d_base_ms": Column("ms", "common delay of all senses on which asynchronies are made", "number"),
    "loss_nominal": Column("", "share of messages that was to be lost", "number", SHARE),
    "loss_achieved": Column("", "share of messages that was lost", "number", SHARE),
    "seed": Column("", "of all that is drawn by chance in this trial", "whole", POSITIVE),
    "profile_sha256": Column("", "SHA-256 of the degradation profile that was in force, in hexadecimal digits"),
    "response": Column("", "answer: yes or no (together or not); the sense that was first; first or second interval; text of the choice"),
    "correct": Column("", "whether the answer was right; empty where none is", "flag", SHARE),
    "response_time": Column("s", "from the question to the answer", "number", POSITIVE),
    "completion_time_s": Column("s", "from the beginning of the game to its end; the time limit where it was not won", "number", POSITIVE),
    "peak_force_n": Column("N", "largest force that was felt", "number", POSITIVE),
    "force_rmse_n": Column("N", "root of the mean square of the difference to the force of the undegraded rendering", "number", POSITIVE),
    "jnd_tube_frac": Column("", "share of the time in which that difference was below what is just noticeable", "number", SHARE),
    "stiffness_first_n_m": Column("N/m", "stiffness that was felt in the first of two presses: the slope of the force over the depth of the hand", "number"),
    "stiffness_second_n_m": Column("N/m", "stiffness that was felt in the second of two presses", "number"),
    "degraded_interval": Column("", "which of two intervals was degraded, 1 or 2", "whole", POSITIVE),
    "e_gen_j": Column("J", "energy that rendering generated instead of taking up", "number"),
    "n_events": Column("", "contact events that were to be presented", "whole", POSITIVE),
    "n_dropped": Column("", "those of them that were not presented", "whole", POSITIVE),
    "log_file": Column("", "log that holds all that crossed the bus, relative to the participant's folder"),
    "log_offset": Column("s", "instant of the stimulus, or of the game's beginning, since the log began", "number"),
    "observer": Column("", "who answered: a human, or a simulated observer or player", levels=("human", "simulated")),
    "study": Column("", "name of the study"),
    "condition": Column("", "name of the condition within the study"),
    "second_modality": Column("", "second sense that was degraded at the same time; empty: none"),
    "second_operator": Column("", "what was wrong with the second sense"),
    "second_level": Column("of the column second_unit", "how much of it was asked for", "number"),
    "second_unit": Column("", "unit of second_level"),
    "missed": Column("", "1: the apparatus missed its tolerance; the trial is not analysed, and repeated", "flag", SHARE),
    "missed_reason": Column("", "what was missed, in words"),
    "repeated_as": Column("", "trial that repeated this one; empty: none", "whole", POSITIVE),
    "success": Column("", "whether the game was won", "flag", SHARE),
    "errors": Column("", "mistakes in the game: balls in wrong holes", "whole", POSITIVE),
    "path_m": Column("m", "way of the tool in the game", "number", POSITIVE),
    "question": Column("", "what was asked"),
    "answer_value": Column("as asked for", "number that was answered: rating, matched value", "number"),
    "latency_profile": Column("", "what was known of the latency of devices, and not measured in the trial"),
}
NEEDED = ("participant_id", "task", "observer")


def text_of(value):
    """A field: numbers in the shortest decimals that read back the same."""
    if value is None or value == "":
        return ""
    if isinstance(value, bool):
        return str(int(value))
    return repr(float(value)) if isinstance(value, float) else str(value)


def wrong(row):
    """What is wrong with a row {column: value}, in words; None: nothing."""
    for name, value in row.items():
        if name not in COLUMNS:
            return f"there is no column {name}; trial_table.py lists those that there are"
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
            return f"{name} is empty; every row has one"
    return None


def text(rows):
    """The table as text. Raises ValueError with the number of the row (from 1) that is wrong, and why."""
    file = io.StringIO()
    out = csv.writer(file, lineterminator="\r\n")
    out.writerow(COLUMNS)
    for number, row in enumerate(rows, start=1):
        sentence = wrong(row)
        if sentence:
            raise ValueError(f"row {number}: {sentence}")
        out.writerow([text_of(row.get(name)) for name in COLUMNS])
    return file.getvalue()


def write(path, rows):
    """Writes the table, all of it or nothing: a reader never sees half a table."""
    replace(path, text(rows))


def replace(path, content):
    """Puts a file in place of the old one in one step. content: text, or bytes."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        part.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def value_of(written, name):
    """The value of a field; ValueError with what is wrong."""
    column = COLUMNS[name]
    if column.kind == "text":
        return written
    if written == "":
        return None
    try:
        value = float("" if "_" in written else written)  # 1_0 is Python's 10 and nobody else's
        if column.kind != "number" and math.isfinite(value) and value == int(value):
            return int(written) if written.lstrip("+-").isdigit() else int(value)
        return value
    except ValueError:
        raise ValueError(f"{name} is '{written[:40]}'; write a number, or nothing where it does not apply") from None


def read(path):
    """[{column: value}] of a table: texts, whole numbers, floats; None where a number is empty. Columns that it lacks are left away.

    Raises Refusal with file, line and reason: a table is read whole or not at all."""
    try:
        with open(path, "rb") as file:
            data = file.read(LARGEST_BYTES + 1)
    except OSError as error:
        raise Refusal(f"{path}: cannot be read ({sentence_of(error)}); give a table of trials") from None
    if len(data) > LARGEST_BYTES:
        raise Refusal(f"{path}: is longer than {LARGEST_BYTES} bytes; give a table of trials")
    try:
        lines = io.StringIO(data.decode("utf-8-sig"), newline="")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise Refusal(f"{path}:{line}: is not UTF-8; save it as UTF-8") from None
    csv.field_size_limit(max(csv.field_size_limit(), LONGEST_TEXT))
    reader = csv.reader(lines, strict=True)
    try:
        return list(rows_of(reader, path))
    except csv.Error as error:
        raise Refusal(f"{path}:{max(1, reader.line_num)}: {error}; save it as comma-separated text") from None


def rows_of(reader, path):
    header = next(reader, None) or []
    for name in header:
        if name not in COLUMNS or header.count(name) > 1:
            what = "stands there twice" if name in COLUMNS else "is not one of those of trial tables"
            raise Refusal(f"{path}:1: the column '{name[:40]}' {what}; name each column once, as docs/study_formats.md lists them")
    for name in NEEDED:
        if name not in header:
            raise Refusal(f"{path}:1: there is no column {name}; every trial table has {', '.join(NEEDED)}")
    for fields in reader:
        where = f"{path}:{reader.line_num}"
        if len(fields) != len(header):
            raise Refusal(f"{where}: {len(fields)} fields where the header has {len(header)}; is the line torn, or a comma not quoted?")
        try:
            row = {name: value_of(field, name) for name, field in zip(header, fields)}
        except ValueError as error:
            raise Refusal(f"{where}: {error}") from None
        sentence = wrong(row)
        if sentence:
            raise Refusal(f"{where}: {sentence}")
        yield row
