"""Tables of other programs are read, or refused with file and line."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus import tables
from tactus.launch import walls
from tactus.refusal import Refusal

ROOT = pathlib.Path(__file__).resolve().parents[3]
ROWS = [{"name": "a, b", "value": "1.5"}, {"name": "ä", "value": ""}]
TEXT = 'name,value\n"a, b",1.5\nä,\n'


class Tables(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.path = pathlib.Path(kept.name) / "table.csv"

    def test_marks_line_ends_and_blank_lines_do_not_change_the_rows(self):
        for end in ("\n", "\r\n", "\r"):
            for mark in ("", "\ufeff"):
                for more in ("", "\n", " \n,\n\n"):
                    self.path.write_bytes((mark + (more + TEXT + more).replace("\n", end)).encode())
                    self.assertEqual(tables.read_rows(self.path), ROWS)

    def test_a_table_of_another_form_is_refused_with_file_and_line(self):
        for data, line, reason in ((TEXT.replace(",", ";").encode(), 1, "semicolons"), (TEXT.replace(",", "\t").encode(), 1, "tabs"), (TEXT.encode("utf-16"), 1, "UTF-16"),
                                   (TEXT.encode("latin-1"), 3, "not UTF-8"), (TEXT.encode() + b"\n\nc,1,2\n", 6, "3 fields"), (TEXT.encode() + b"c\n", 4, "1 fields"),
                                   (TEXT.encode() + b'"c', 4, "unexpected end")):
            self.path.write_bytes(data)
            with self.assertRaisesRegex(Refusal, f"^{self.path}:{line}: .*{reason}"):
                tables.read_rows(self.path)

    def test_a_room_with_semicolons_is_refused_with_its_line(self):
        self.path.write_text("wall;x\na;1\n", encoding="utf-8")
        with self.assertRaisesRegex(ValueError, "table.csv:1: its fields are separated by semicolons"):
            walls.room(self.path.parent, self.path.name)

    def test_a_cell_that_is_no_finite_number_is_refused_with_file_and_line(self):
        for text in ("nan", "inf", "-inf", "1e300", "hello", "", "1,5", "0x10"):
            self.path.write_text(f'name,value\na,1\n\nb,"{text}"\n', encoding="utf-8")
            rows = list(tables.numbered_rows(self.path, ("value",)))
            self.assertEqual(1.0, tables.number(rows[0][1], "value", rows[0][0]))
            with self.subTest(text), self.assertRaisesRegex(Refusal, f"^{self.path}:4: value is "):
                tables.number(rows[1][1], "value", rows[1][0])

    def test_a_cell_that_is_no_whole_number_is_refused_with_file_and_line(self):
        for text in ("1.5", "1e3", "", "nan", "0x1", "1_000", "٣", "9" * 20):
            with self.subTest(text), self.assertRaisesRegex(Refusal, "^t.csv:7: value is .* and not a whole number"):
                tables.whole({"value": text}, "value", "t.csv:7")
        self.assertEqual(-12, tables.whole({"value": "-12"}, "value", "t.csv:7"))

    def test_a_table_without_a_needed_column_is_refused_by_its_name(self):
        for text in ("", "\n\n", "a,b\n1,2\n"):
            self.path.write_text(text, encoding="utf-8")
            with self.assertRaisesRegex(Refusal, f"^{self.path}:1: has no column value; it needs value, a"):
                list(tables.numbered_rows(self.path, ("value", "a")))

    def test_an_empty_table_has_no_rows(self):
        self.path.write_bytes(b"\n\n")
        self.assertEqual(tables.read_rows(self.path), [])

    def test_whole_numbers_of_options_have_digits_only_and_any_length_is_read_or_refused(self):
        for text, value in (("0", 0), ("7", 7), ("0" * 5000 + "12", 12), ("100", 100)):
            self.assertEqual(value, tables.whole_number(text, 0, 100))
        for text in ("", "101", "9" * 5000, "-1", "+1", "1.0", "1_0", " 1", "\u0661", "\u00b2", "1\n"):
            self.assertIsNone(tables.whole_number(text, 0, 100), text[:20])
        self.assertIsNone(tables.whole_number("0", 1, 100))

    def test_a_command_refuses_a_number_of_thousands_of_digits_with_one_sentence(self):
        for words in (("metrics", __file__, "--run", "9" * 5000), ("rerun", __file__, "--run", "9" * 5000), ("rerun", __file__, "--seed", "9" * 5000), ("lab", "--hosts", "9" * 5000, "true"),
                      ("run", "--player", "observer:" + "9" * 5000)):
            done = subprocess.run([ROOT / "scripts" / "tactus", *words], capture_output=True, text=True, check=False, timeout=60,
                                  env={**os.environ, "TACTUS_BIN": "/nowhere"})  # builds nothing
            self.assertEqual(1, done.returncode, words[:2])
            self.assertNotIn("Traceback", done.stderr)
            self.assertEqual(1, done.stderr.count("\n"), done.stderr[-300:])
            self.assertNotIn("set_int_max_str_digits", done.stderr)


if __name__ == "__main__":
    unittest.main()
