"""Tests that the generated reference holds everything that the code holds."""
import csv
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "docs" / "site"))
import reference_commands
import reference_messages
import reference_tables
from page_text import PageError


class Messages(unittest.TestCase):
    def test_every_field_and_constant_of_every_type_is_listed(self):
        page = reference_messages.messages(ROOT)
        for path in (ROOT / "lcmtypes" / "types").glob("*/*.lcm"):
            section = page.split(f"### {path.stem}\n")[1].split("\n### ")[0]
            for name in re.findall(r"^\s*(?:const \w+ )?[\w.]+ (\w+)(?:\[\w+\])*(?: = [^;]+)?;", path.read_text(encoding="utf-8").partition("struct")[2], re.M):
                with self.subTest(f"{path.stem}.{name}"):
                    self.assertIn(f"`{name}`", section)

    def test_a_line_that_is_not_understood_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "x_t.lcm")
            path.write_text("package tactus;\n// X.\nstruct x_t {\n  union y;;\n}\n", encoding="utf-8")
            with self.assertRaises(PageError):
                reference_messages.read(path)

    def test_every_channel_is_listed_with_its_message(self):
        page = reference_messages.channels(ROOT)
        for name in re.findall(r'k\w+ = "([A-Z_]+)"', (ROOT / "lcmtypes" / "channels.h").read_text(encoding="utf-8")):
            self.assertIn(f"| `{name}` | [`", page)


class Operators(unittest.TestCase):
    def test_every_operator_of_every_modality_is_listed_with_its_range(self):
        page = reference_tables.operators(ROOT)
        for path in ROOT.glob("*/modality.csv"):
            with open(path, newline="", encoding="utf-8") as file:
                for row in csv.DictReader(file):
                    if row["what"] == "operator":
                        self.assertRegex(page, rf"\| `{row['name']}` \| .*{re.escape(row['min'])} to {re.escape(row['max'])}")
        for name in ("delay", "jitter", "loss", "rate", "deadband", "freeze", "off", "quantise", "reorder", "from"):
            self.assertIn(f"| `{name}` |", page)


class Studies(unittest.TestCase):
    def test_every_element_and_value_of_the_schema_is_listed(self):
        page = reference_tables.study_elements(ROOT)
        schema = (ROOT / "scripts" / "python" / "tactus" / "study" / "study.xsd").read_text(encoding="utf-8")
        for name in re.findall(r'<xs:element name="(\w+)"', schema):
            self.assertRegex(page, rf"## (?:[\w /]+ / )?{name}\n")
        for value in re.findall(r'<xs:(?:attribute name|enumeration value)="(\w+)"', schema):
            self.assertIn(f"`{value}`", page)


class Commands(unittest.TestCase):
    def test_every_command_of_the_table_is_listed_with_its_help(self):
        page = reference_commands.pages(ROOT, pathlib.Path("/nonexistent"))["command_line.md"]
        from tactus.commands.table import BY_NAME
        for name in BY_NAME:
            self.assertIn(f"### tactus {name}\n\n```text\n", page)
        self.assertIn("### tactus study check\n", page)
        self.assertNotRegex(page, rf"(?<![\w/.]){re.escape(str(ROOT))}(?![\w-])")


if __name__ == "__main__":
    unittest.main()
