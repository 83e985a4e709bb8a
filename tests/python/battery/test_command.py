"""Tests of tactus study battery as a command: a task with two values and few levels, rendered and played."""
import contextlib
import csv
import io
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.battery import conditions, main, renderings
from tactus.information import task_file

LEVELS = {"delay": (10, 900), "jitter": (20,)}
# The fall of the ball is heard after half a second of one second, so a sound that is 900 ms late is not heard.
TASK = '<task scene="search_by_sound.sdf" sense="audio" seconds="1s">{}</task>'


def rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


class Command(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        shipped = task_file.find("search_by_sound").read_text(encoding="utf-8")
        values = shipped.split("<value ")[1:3]
        values = "".join("<value " + value[:value.index("</value>") + len("</value>")] for value in values)
        self.task = self.folder / "mine.task.xml"
        self.task.write_text(TASK.format(values), encoding="utf-8")
        for patched in (mock.patch.object(conditions, "COMMON", LEVELS), mock.patch.object(conditions, "SEEDS", (1, 2))):
            patched.start()
            self.addCleanup(patched.stop)

    def run_command(self, *words):
        """(exit status, standard output, standard error) of the command."""
        out, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
            try:
                status = main.main([str(word) for word in words])
            except SystemExit as stopped:
                status, _ = 1, errors.write(str(stopped.code))
        return status, out.getvalue(), errors.getvalue()

    def test_limits_are_printed_and_stored_and_a_second_command_renders_nothing(self):
        words = [self.task, "--players", 20, "--draws", 60, "--keep", self.folder / "kept", "--out", self.folder / "out"]
        status, out, errors = self.run_command(*words)
        self.assertEqual(0, status, errors)
        self.assertIn("2 of 2 scenes are rendered", errors)
        table = {row["operator"]: row for row in rows(self.folder / "out" / "limits.csv")}
        self.assertEqual(set(LEVELS), set(table))
        for row in table.values():
            self.assertGreater(float(row["undegraded"]), 0.9, row)
        self.assertNotIn(table["delay"]["naive median"], ("<10ms", ">900ms"))
        self.assertEqual(20 * len(LEVELS), len(rows(self.folder / "out" / "players.csv")))
        deaf = [row for row in rows(self.folder / "out" / "curves.csv") if row["level"] == "900"]
        self.assertLess(float(deaf[0]["naive mean"]), 0.65)
        self.assertIn("mine ", out)
        before = {path: path.stat().st_mtime_ns for path in (self.folder / "kept").iterdir()}
        with mock.patch.object(renderings.rendering, "simulate", side_effect=AssertionError("rendered again")):
            again = self.run_command(*words)
        self.assertEqual((0, out), again[:2])
        self.assertEqual(before, {path: path.stat().st_mtime_ns for path in (self.folder / "kept").iterdir()})

    def test_a_damaged_or_older_rendering_is_made_again(self):
        words = [self.task, "--players", 20, "--draws", 60, "--keep", self.folder / "kept"]
        out = self.run_command(*words)[1]
        first, second = sorted((self.folder / "kept").iterdir())
        first.write_bytes(first.read_bytes()[:100])
        os.remove(second)
        self.assertEqual((0, out), self.run_command(*words)[:2])

    def test_wrong_options_are_refused_with_one_sentence(self):
        for words, reason in ((["--players", "5"], "--players 5: is out of range"), (["--draws", "1"], "--draws 1: is out of range"), (["nothing"], "nothing"),
                              (["--verdicts", "/nowhere/table.csv"], "/nowhere/table.csv"), (["--levels", "3"], "--levels")):
            status, _, errors = self.run_command(*words)
            self.assertEqual(1, status, words)
            self.assertIn(reason, errors)
            self.assertEqual(1, len(errors.strip().splitlines()), errors)


if __name__ == "__main__":
    unittest.main()
