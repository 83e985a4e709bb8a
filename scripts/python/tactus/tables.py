"""Reads tables (CSV), and escapes texts in them.

Tables from other programs differ in ways that do not change their content: a byte order mark, CRLF or CR as line end, blank lines, and lines of empty
fields that spreadsheets leave at the end. They are read. Other separators and encodings, and lines with more or fewer fields than the header, are refused
with file and line.
"""
import csv
import io
import math
import re

from tactus.refusal import Refusal

# Spreadsheets run a cell that begins so as a formula (OWASP, CSV injection), except a number. The apostrophes make the escape reversible.
FORMULA = re.compile(r"'*[=+\-@\t\r](?s:.)")
NUMBER = re.compile(r"[+-][0-9]+(\.[0-9]*)?([eE][+-]?[0-9]+)?")
WHOLE = re.compile(r"-?[0-9]{1,19}")  # of 64 bits
LARGEST = 1e15  # of numbers in tables of runs: squares and their sums stay finite; design
UTF16 = (b"\xff\xfe", b"\xfe\xff")  # byte order marks; spreadsheets write them as "Unicode text"
SEPARATORS = {";": "semicolons", "\t": "tabs"}  # of spreadsheets in other languages, beside the comma


def decoded(data, path):
    """The text of a table of bytes. Raises Refusal with the line that is not UTF-8."""
    if data.startswith(UTF16):
        raise Refusal(f"{path}:1: is UTF-16 and not UTF-8; save it as UTF-8")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise Refusal(f"{path}:{data.count(bytes([10]), 0, error.start) + 1}: is not UTF-8; save it as UTF-8") from None


def records(text, path, may_end_early=False):
    """Yields (line number, fields) of the header and of each row that is not blank. Every row has as many fields as the header; with may_end_early
    it may also have fewer. Raises Refusal."""
    reader, header = csv.reader(io.StringIO(text, newline=""), strict=True), None
    try:
        for fields in reader:
            if not any(field.strip() for field in fields):
                continue
            line = reader.line_num
            if header is None:
                header = fields
                used = [name for mark, name in SEPARATORS.items() if mark in "".join(fields)] if len(fields) == 1 else []
                if used:
                    raise Refusal(f"{path}:{line}: its fields are separated by {used[0]}; save it with commas between fields and points in numbers")
            elif len(fields) > len(header) or (len(fields) < len(header) and not may_end_early):
                raise Refusal(f"{path}:{line}: has {len(fields)} fields, but the header has {len(header)}; check for an incomplete line or an unquoted comma")
            yield line, fields
    except csv.Error as error:
        raise Refusal(f"{path}:{max(1, reader.line_num)}: {error}; save it as comma-separated text") from None


def read_rows(path, may_end_early=False):
    """A dictionary for each row; values are texts. may_end_early: the last fields of a row may be left out. Raises OSError, and Refusal with file and
    line."""
    with open(path, "rb") as file:
        lines = records(decoded(file.read(), path), path, may_end_early)
    _, header = next(lines, (1, []))
    return [dict(zip(header, fields)) for _, fields in lines]


def numbered_rows(path, needs=()):
    """Yields ("FILE:LINE", dictionary) of each row; values are texts. needs: names of columns that the table must have. Raises OSError, and Refusal with file
    and line."""
    with open(path, "rb") as file:
        lines = records(decoded(file.read(), path), path)
    line, header = next(lines, (1, []))
    if missing := [name for name in needs if name not in header]:
        raise Refusal(f"{path}:{line}: has no column {missing[0]}; it needs {', '.join(needs)}")
    for line, fields in lines:
        yield f"{path}:{line}", dict(zip(header, fields))


def number(row, name, where):
    """The number of a cell, at most LARGEST in size. where: its "FILE:LINE". Raises Refusal."""
    try:
        value = float(row[name])
    except ValueError:
        raise Refusal(f"{where}: {name} is {row[name]!r} and not a number; correct it, or export the table again") from None
    if not (math.isfinite(value) and abs(value) <= LARGEST):
        raise Refusal(f"{where}: {name} is {row[name]}, which no run writes; correct it, or export the table again")
    return value


def whole(row, name, where):
    """The whole number of a cell. where: its "FILE:LINE". Raises Refusal."""
    if not WHOLE.fullmatch(row[name]):
        raise Refusal(f"{where}: {name} is {row[name]!r} and not a whole number; correct it, or export the table again")
    return int(row[name])


def whole_number(text, least, most):
    """The whole number of a text of digits, from least >= 0 to most; None for any other text, also one of thousands of digits, which int() refuses."""
    if not (text.isascii() and text.isdigit() and len(text.lstrip("0")) <= len(str(most))):
        return None
    value = int(text.lstrip("0") or "0")
    return value if least <= value <= most else None


def escaped(text):
    """The text of a cell, with an apostrophe before a formula; sync::csv_cell does the same."""
    return "'" + text if FORMULA.match(text) and not NUMBER.fullmatch(text) else text


def unescaped(text):
    """The original of an escaped text."""
    return text[1:] if text.startswith("'") and FORMULA.match(text) else text
