"""Tests of `tactus export --since --until`: every table holds the messages of the interval and no other."""
import csv
import os
import pathlib
import subprocess
import tempfile
import unittest

from log_files import BIN, REPOSITORY, make_run

SINCE_S, UNTIL_S = 0.8, 1.6


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


class ExportInterval(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        make_run(cls.folder / "run", "metronome.sdf", 2)
        cls.whole = cls.tables("whole")
        cls.part = cls.tables("part", "--since", str(SINCE_S), "--until", str(UNTIL_S))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def export(cls, out, *options):
        return subprocess.run([REPOSITORY / "scripts" / "tactus", "export", cls.folder / "run", "--out", cls.folder / out, *options], capture_output=True,
                              text=True, check=False, env={**os.environ, "TACTUS_BIN": str(BIN)})

    @classmethod
    def tables(cls, out, *options):
        """{name of the table: its rows}."""
        done = cls.export(out, *options)
        if done.returncode != 0:
            raise AssertionError(done.stdout + done.stderr)
        return {file.name: rows_of(file) for file in (cls.folder / out).glob("*.csv")}

    def test_tables_with_the_time_of_the_log_hold_the_interval(self):
        names = [name for name, rows in self.whole.items() if rows[0][0] == "log_s"]
        self.assertGreater(len(names), 10)
        for name in names:
            expected = [row for row in self.whole[name] if row[0] == "log_s" or SINCE_S <= float(row[0]) <= UNTIL_S]
            if len(expected) > 1 or name in self.part:  # a channel without a message in the interval has no table
                self.assertEqual(expected, self.part.get(name), name)

    def test_tables_of_events_presentations_clocks_and_traces_are_cut_likewise(self):
        # The message that first holds a row, from the table of its channel.
        def first_seen(channel, field):
            seen = {}
            for row in self.whole[f"{channel}.csv"][1:]:
                if row[4].endswith(field):
                    seen.setdefault(row[6], float(row[0]))
            return seen

        begun = first_seen("CONTACT_EVENTS", ".event_id")
        cut = [row for row in self.whole["events.csv"][1:] if SINCE_S <= begun[row[0]] <= UNTIL_S]
        self.assertLess(0, len(cut))
        self.assertLess(len(cut), len(self.whole["events.csv"]) - 1)
        self.assertEqual(cut, self.part["events.csv"][1:])
        for name in ("presented.csv", "media_clock.csv", "haptic.csv", "thermal.csv"):
            whole, part = self.whole[name], self.part[name]
            self.assertEqual(whole[0], part[0], name)
            self.assertLess(len(part), len(whole), name)
            at = whole.index(part[1])
            self.assertEqual(whole[at:at + len(part) - 1], part[1:], name)  # a run of rows, in order
        ticks = {row[3] for row in self.whole["TOOL_STATE.csv"][1:] if SINCE_S <= float(row[0]) <= UNTIL_S}
        self.assertEqual(len(ticks), len(self.part["haptic.csv"]) - 1)

    def test_two_parts_hold_every_row_once(self):
        early, late = self.tables("early", "--until", "1"), self.tables("late", "--since", "1.000000001")
        for name in ("events.csv", "presented.csv", "media_clock.csv", "haptic.csv", "thermal.csv", "tags.csv"):
            self.assertEqual(sorted(self.whole[name][1:]), sorted(early[name][1:] + late[name][1:]), name)

    def test_an_interval_that_ends_before_it_begins_is_refused_with_one_sentence(self):
        done = self.export("none", "--since", "2", "--until", "1")
        self.assertEqual(1, done.returncode)
        self.assertEqual(1, len(done.stderr.strip().splitlines()), done.stderr)
        self.assertIn("--since is after --until", done.stderr)


if __name__ == "__main__":
    unittest.main()
