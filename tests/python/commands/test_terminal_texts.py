"""Tests that texts of others, such as names in tables, reach the terminal without control characters, which it would execute."""
import ast
import contextlib
import io
import math
import pathlib
import sys
import tempfile
import types
import unittest
import warnings

ROOT = pathlib.Path(__file__).resolve().parents[3]
PYTHON = ROOT / "scripts" / "python"
sys.path.insert(0, str(PYTHON))
from tactus import terminal
from tactus.analysis import main, trials
from tactus.report import figures

# Modules that print values directly: numbers, names of this package, JSON, and control sequences for the progress on a terminal.
DIRECT = {"terminal.py", "metrics/curves.py", "metrics/main.py", "metrics/rank.py", "metrics/tasks.py", "rerender/main.py", "rerun/main.py", "modal_analysis/main.py", "information/main.py",
          "commands/dispatch.py", "commands/prepare.py", "commands/disturb.py", "commands/drumkit_sounds.py", "doctor/main.py", "log/marker.py", "cluster/main.py",
          "cluster/bus_listener.py", "cluster/intruder.py", "cluster/lab_cluster.py", "cluster/lab_command.py"}
HOSTILE = ("\x1b]0;title\x07", "\x9b2J", "\x1b[31m", "\rover", "\x7f", "\x08")


def prints_a_value(path):
    """True when a call of print() has an argument that is not a constant."""
    calls = [n for n in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name) and n.func.id == "print"]
    return any(not isinstance(argument, (ast.Constant, ast.Name)) or isinstance(argument, ast.Name) and not argument.id.isupper() and argument.id != "__doc__"
               for call in calls for argument in call.args)


def controls(text):
    return [c for c in text if c != "\n" and (ord(c) < 32 or 127 <= ord(c) < 160)]


class TerminalTexts(unittest.TestCase):
    def test_modules_print_texts_through_the_terminal_module(self):
        found = {str(p.relative_to(PYTHON / "tactus")) for p in (PYTHON / "tactus").rglob("*.py") if prints_a_value(p)}
        self.assertEqual(set(), found - DIRECT, "use terminal.show(), or list the module when it prints only numbers and own names")

    def test_a_result_is_printed_without_control_characters_and_keeps_its_lines(self):
        for text in HOSTILE:
            said = io.StringIO()
            with contextlib.redirect_stdout(said):
                terminal.show(f"a\n{text} é 音")
            self.assertEqual([], controls(said.getvalue()))
            self.assertTrue(said.getvalue().startswith("a\n") and said.getvalue().endswith(" é 音\n"))

    def test_the_names_in_a_table_of_a_stranger_do_not_reach_the_terminal_of_an_analysis(self):
        analysis = types.SimpleNamespace(trials=trials.Trials({}, 0), left_out=0, observer=f"simulated ({HOSTILE[0]})")
        row = {"limit": "L_break", "modality": f"v{HOSTILE[1]}", "operator": HOSTILE[2], "by": HOSTILE[3], "unit": HOSTILE[4], "note": HOSTILE[5], "value": 1.0, "low": 0.5, "high": math.nan, "up_to": 4.0}
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            main.print_summary(analysis, {"limits": [row]}, __file__, types.SimpleNamespace(gallery=types.SimpleNamespace(count=0)))
        self.assertIn("v\\x9b2J", said.getvalue())
        self.assertEqual([], controls(said.getvalue()))

    def test_the_names_in_a_table_of_a_stranger_are_escaped_in_figures(self):
        figure, axes = figures.plt.subplots()
        axes.set_title("a" + "".join(HOSTILE))
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("error")
            figures.Gallery(folder).keep(figure, "f", "")
            self.assertEqual([], controls((pathlib.Path(folder) / "f.svg").read_text(encoding="utf-8")))


if __name__ == "__main__":
    unittest.main()
