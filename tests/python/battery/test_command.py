"""Tests of tactus study battery as a command: a task with two values and few levels, rendered and played."""
import contextlib
import csv
import io
import pathlib
import shutil
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
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        for patched in (mock.patch.object(conditions, "COMMON", LEVELS), mock.patch.object(conditions, "OF_SENSE", {"audio": {}}), mock.patch.object(conditions, "SEEDS", (1, 2))):
            cls.enterClassContext(patched)
        shipped = task_file.find("search_by_sound").read_text(encoding="utf-8")
        values = "".join("<value " + value[:value.index("</value>") + len("</value>")] for value in shipped.split("<value ")[1:3])
        cls.task = cls.folder / "mine.task.xml"
        cls.task.write_text(TASK.format(values), encoding="utf-8")
        cls.status, cls.out, cls.errors = cls.run_command(*cls.words(cls.task, cls.folder / "first"), "--out", cls.folder / "out")

    @staticmethod
    def words(task, kept):
        return [task, "--players", 20, "--draws", 60, "--keep", kept]

    def copied(self):
        """A copy of the renderings of the first command."""
        self.assertEqual(0, self.status, self.errors)
        return shutil.copytree(self.folder / "first", self.folder / self.id())

    @staticmethod
    def run_command(*words):
        """(exit status, standard output, standard error) of the command."""
        out, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
            try:
                status = main.main([str(word) for word in words])
            except SystemExit as stopped:
                status, _ = 1, errors.write(str(stopped.code))
        return status, out.getvalue(), errors.getvalue()

    def test_limits_are_printed_and_stored(self):
        self.assertEqual(0, self.status, self.errors)
        self.assertIn("2 of 2 scenes are rendered", self.errors)
        self.assertIn("mine ", self.out)
        table = {row["operator"]: row for row in rows(self.folder / "out" / "limits.csv")}
        self.assertEqual(set(LEVELS), set(table))
        for row in table.values():
            self.assertGreater(float(row["undegraded"]), 0.9, row)
        self.assertNotIn(table["delay"]["naive median"], ("<10ms", ">900ms"))
        self.assertEqual(20 * len(LEVELS), len(rows(self.folder / "out" / "players.csv")))
        deaf = [row for row in rows(self.folder / "out" / "curves.csv") if row["level"] == "900"]
        self.assertLess(float(deaf[0]["naive mean"]), 0.65)
        self.assertTrue((self.folder / "out" / "delay.svg").read_text(encoding="utf-8").startswith("<?xml"))

    def test_a_second_command_renders_nothing(self):
        with mock.patch.object(renderings.rendering, "simulate", side_effect=AssertionError("rendered again")):
            self.assertEqual((0, self.out), self.run_command(*self.words(self.task, self.copied()))[:2])

    def test_a_damaged_rendering_is_made_again(self):
        kept = self.copied()
        damaged = sorted(kept.iterdir())[0]
        damaged.write_bytes(damaged.read_bytes()[:100])
        self.assertEqual((0, self.out), self.run_command(*self.words(self.task, kept))[:2])

    def test_the_renderings_of_a_task_that_has_changed_are_not_used(self):
        kept = self.copied()
        content = lambda: {path.read_bytes() for path in kept.iterdir()}
        before, text = content(), self.task.read_text(encoding="utf-8")
        changed = self.folder / "changed" / "mine.task.xml"
        changed.parent.mkdir()
        changed.write_text(text.replace("0.4000", "0.3000"), encoding="utf-8")
        self.assertNotEqual(text, changed.read_text(encoding="utf-8"))
        self.assertEqual(0, self.run_command(*self.words(changed, kept))[0])
        self.assertEqual(1, len(before - content()))

    def test_wrong_options_are_refused_with_one_sentence(self):
        for words, reason in ((["--players", "5"], "--players 5: is out of range"), (["--draws", "1"], "--draws 1: is out of range"), (["nothing"], "nothing"),
                              (["--verdicts", "/nowhere/table.csv"], "/nowhere/table.csv"),
                              (["--keep", str(self.task)], "is not a folder"), (["--out", str(self.task)], "is not a folder"), (["--levels", "3"], "--levels")):
            status, _, errors = self.run_command(*words)
            self.assertEqual(1, status, words)
            self.assertIn(reason, errors)
            self.assertEqual(1, len(errors.strip().splitlines()), errors)


if __name__ == "__main__":
    unittest.main()
