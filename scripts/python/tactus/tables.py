"""Reads tables (CSV), and escapes texts in them."""
import csv
import re

# Spreadsheets run a cell that begins so as a formula (OWASP, CSV injection), except a number. The apostrophes make the escape reversible.
FORMULA = re.compile(r"'*[=+\-@\t\r](?s:.)")
NUMBER = re.compile(r"[+-][0-9]+(\.[0-9]*)?([eE][+-]?[0-9]+)?")


def read_rows(path):
    """A dictionary for each row; values are texts. Raises OSError, UnicodeDecodeError, csv.Error."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def escaped(text):
    """The text of a cell, with an apostrophe before a formula; sync::csv_cell does the same."""
    return "'" + text if FORMULA.match(text) and not NUMBER.fullmatch(text) else text


def unescaped(text):
    """The original of an escaped text."""
    return text[1:] if text.startswith("'") and FORMULA.match(text) else text
