"""Reads tables (CSV)."""
import csv


def read_rows(path):
    """A dictionary for each row; values are texts. Raises OSError, UnicodeDecodeError, csv.Error."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))
