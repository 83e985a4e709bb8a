"""Tests that no text of a study becomes a formula of a spreadsheet, and that tables are read back unchanged."""
import csv
import io
import pathlib
import random
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.analysis import result_tables
from tactus.study import bids, formats, trial_table
from tactus.tables import escaped, unescaped

FORMULAS = ("=HYPERLINK(\"http://evil.example\")", "+cmd|' /C calc'!A0", "-2+3", "@SUM(1)", "\t=1", "\r=1", "'=1")
PLAIN = ("", "-", "=", "-5", "+1.5", "-2.5e-3", "yes", "a=b", "'quoted'", "–5")


class Cells(unittest.TestCase):
    def test_formulas_are_escaped_and_numbers_and_other_texts_stay(self):
        for text in FORMULAS:
            self.assertEqual("'" + text, escaped(text))
        for text in PLAIN:
            self.assertEqual(text, escaped(text))

    def test_any_text_is_read_back(self):
        chance = random.Random(1)
        for _ in range(100_000):
            text = "".join(chance.choice("'=+-@\t\r\na1.e ") for _ in range(chance.randrange(7)))
            self.assertEqual(text, unescaped(escaped(text)))

    def test_answers_of_participants_are_no_formulas_in_any_table(self):
        for text in FORMULAS:
            row = {"participant_id": "P1", "task": "free", "observer": "human", "response": text, "level": -5.0}
            table = trial_table.text([row])
            self.assertEqual(text, trial_table.parsed(table.encode(), "t")[0]["response"])
            for written in (table, formats.table(("answer",), [(text,)])):
                cells = [cell for line in csv.reader(io.StringIO(written, newline="")) for cell in line]
                self.assertEqual([], [cell for cell in cells if escaped(cell) != cell and not cell.startswith("'")])
            self.assertIn("-5.0", table)
            self.assertEqual(escaped(bids.field(text)), bids.field(text) if bids.field(text).startswith(" ") else "'" + bids.field(text))
            self.assertEqual("'" + text, result_tables.plain(text))


if __name__ == "__main__":
    unittest.main()
