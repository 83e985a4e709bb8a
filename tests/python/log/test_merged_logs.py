"""Tests of every reader of logs with logs that were merged, swapped, cut together or stamped by a clock that was set."""
import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

from log_files import BIN, REPOSITORY, make_run, write_log

HOUR_US = 3600 * 1_000_000
LATENCY_S = 0.002  # a jump is known to one latency
ODD_NAMES = [b"/robot/joint states", b'a,b"c', b"../../evil", "Übung".encode(), b"L" * 63, b"=1+1", b"line\nbreak", b"CAM;LEFT", b".hidden", b"WORLD_STATE2",
             b"imu data", b"events", b"TOOL STATE", bytes(range(1, 64))]


class MergedLogs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        # Both have the same identities, as all runs of one seed in virtual time.
        cls.a = make_run(cls.folder / "a", "metronome.sdf", 2)
        cls.b = make_run(cls.folder / "b", "single_taps.sdf", 1)
        cls.original = cls.tables("original", cls.a)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def tables(cls, name, events, *options):
        """{file: rows} of all exports, "stderr": warnings, "describe": description of the log."""
        log, out = cls.folder / f"{name}.lcmlog", cls.folder / f"{name}{len(options)}"
        if events is not None:
            write_log(log, events)
        out.mkdir()
        found = {"stderr": []}
        for program in ("export_log", "export_events", "export_csv"):
            done = subprocess.run([BIN / program, log, "--out", out, *options, *(["--quiet"] if program != "export_log" else [])], capture_output=True, text=True, check=True)
            found["stderr"] += done.stderr.splitlines()
            found[program] = done.stdout
        done = subprocess.run([BIN / "summarise", log, "--out", out / "summary.json", *options], capture_output=True, text=True, check=False)
        found["summary"] = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        for file in sorted(out.glob("*.csv")):
            with open(file, encoding="utf-8", newline="", errors="surrogateescape") as rows:
                found[file.name] = list(csv.reader(rows))
        found["describe"] = json.loads(subprocess.run([BIN / "replay", log, "--describe"], capture_output=True, check=True).stdout)
        return found

    def assert_same_rows(self, found, stderr, but_times=False):
        self.assertEqual(stderr, len(found["stderr"]), found["stderr"])
        files = [name for name in self.original if name.endswith(".csv")]
        self.assertEqual(files, [name for name in found if name.endswith(".csv")])
        for name in files:
            expected, rows = self.original[name], found[name]
            if but_times and expected[0][0] == "log_s":
                self.assertEqual([row[1:] for row in expected], [row[1:] for row in rows], name)
                for one, other in zip(expected[1:], rows[1:]):
                    self.assertAlmostEqual(float(one[0]), float(other[0]), delta=LATENCY_S)
            else:
                self.assertEqual(expected, rows, name)
        self.assertAlmostEqual(self.original["describe"]["length_s"], found["describe"]["length_s"], delta=LATENCY_S)
        self.assertAlmostEqual(self.original["summary"]["recorded_seconds"], found["summary"]["recorded_seconds"], delta=LATENCY_S)
        self.assertEqual(self.original["summary"]["contacts"], found["summary"]["contacts"])

    def test_events_that_a_logger_exchanged_are_exported_as_without_it(self):
        swapped = list(self.a)
        for i in range(200, len(swapped) - 1, 7):
            if swapped[i][0] != swapped[i + 1][0]:  # events with one stamp have no order
                swapped[i], swapped[i + 1] = swapped[i + 1], swapped[i]
        self.assert_same_rows(self.tables("swapped", swapped), 0)

    def test_a_clock_that_was_set_while_recording_changes_nothing_but_gives_one_warning(self):
        middle = len(self.a) // 2
        for name, by_us in (("hole", 3 * HOUR_US), ("back", -HOUR_US), ("second", -1_000_000)):
            with self.subTest(name):
                found = self.tables(name, [(t + (by_us if i >= middle else 0), c, d) for i, (t, c, d) in enumerate(self.a)])
                self.assert_same_rows(found, 1, but_times=True)
                self.assertIn("jumped 1 time", found["stderr"][0])

    def test_messages_that_two_loggers_wrote_have_one_row(self):
        for name, events in (("pairs", [e for e in self.a for _ in (0, 1)]), ("appended", self.a + self.a)):
            with self.subTest(name):
                found = self.tables(name, events)
                self.assert_same_rows(found, 1)
                self.assertIn("copies", found["stderr"][0])

    def test_two_runs_in_one_file_are_listed_and_have_their_number_in_every_table(self):
        found = self.tables("two", self.a + self.b)
        self.assertEqual(1, len(found["stderr"]), found["stderr"])
        self.assertEqual(["metronome.sdf", "single_taps.sdf"], [run["scene"] for run in found["describe"]["runs"]])
        for name, expected in self.original.items():
            if name.endswith(".csv"):
                self.assertEqual(expected, [row for row in found[name] if row[-1] in ("1", "run")], name)
        second = self.tables("b_alone", self.b)
        chosen = self.tables("two", None, "--run", "2")
        for name, expected in second.items():
            if name.endswith(".csv"):
                self.assertEqual([row[:-1] for row in expected], [row[:-1] for row in chosen[name]], name)
                self.assertEqual({"2", "run"} if len(expected) > 1 else {"run"}, {row[-1] for row in chosen[name]}, name)
        self.assertEqual(second["summary"]["contacts"], chosen["summary"]["contacts"])

    def test_messages_that_cannot_be_decoded_are_named_by_summary_report_and_metrics(self):
        damaged = [(stamp, channel, bytes(8) + data[8:] if channel == b"CONTACT_EVENTS" else data) for stamp, channel, data in self.a]
        count = sum(channel == b"CONTACT_EVENTS" for _, channel, _ in self.a)
        sentence = f"{count} of {count} messages of CONTACT_EVENTS are incomplete or damaged and are left out"
        found = self.tables("undecodable", damaged)
        self.assertEqual([sentence], found["summary"]["damage"])
        self.assertIn(sentence, found["summary"]["warnings"])
        log = self.folder / "undecodable.lcmlog"
        for words in (("report", log, "--out", self.folder / "undecodable.html"), ("metrics", log)):
            done = subprocess.run([REPOSITORY / "scripts" / "tactus", *words], capture_output=True, text=True, check=False, env={**os.environ, "TACTUS_BIN": str(BIN)})
            self.assertEqual(f"{log}: {sentence}", done.stderr.strip(), words)

    def test_any_channel_name_is_exported_with_all_bytes_and_is_no_damage(self):
        middle = len(self.a) // 2
        payload = bytes(range(8)) + b"hello" * 3
        odd = [(self.a[middle][0], name, payload) for name in ODD_NAMES]
        found = self.tables("odd", self.a[:middle] + odd + self.a[middle:])
        self.assertNotIn("damaged", found["export_log"])
        self.assertEqual(0, found["describe"]["damaged_regions"])
        tables = [name for name, rows in found.items() if name.endswith(".csv") and rows[0] == ["log_s", "bytes", "data_hex", "run"]]
        self.assertEqual(len(ODD_NAMES), len(tables), tables)
        for name in tables:
            self.assertEqual([str(len(payload)), payload.hex(), "1"], found[name][1][1:])
        for name, expected in self.original.items():
            if name.endswith(".csv"):
                self.assertEqual(expected, found[name], name)


if __name__ == "__main__":
    unittest.main()
