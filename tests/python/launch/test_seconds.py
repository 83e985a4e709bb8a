#!/usr/bin/env python3
"""Tests of the seconds of a run, which count from the beginning of its world."""
import pathlib
import sys
import types
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import main
from tactus.refusal import Refusal


class Running:
    """A fake cluster whose simulation begins at a set time of its clock, which main reads."""

    def __init__(self, begins_at, expected=True, waits=""):
        self.waits = waits
        self.now, self.begins_at, self.expected, self.table = 0.0, begins_at, expected, False
        self.plan = types.SimpleNamespace(out="out")
        self.page = None

    def monotonic(self):
        return self.now

    def sleep(self, seconds):
        self.now += seconds

    def world_has_begun(self):
        return self.now >= self.begins_at

    def expects_world(self):
        return self.expected

    def waits_for(self):
        return self.waits

    def show_table(self):
        self.table = True

    def alive(self):
        return True

    def lost(self):
        return {}


class Seconds(unittest.TestCase):
    def setUp(self):
        self.lines = []
        reports = mock.patch.object(main, "report_run", self.lines.append)
        reports.start()
        self.addCleanup(reports.stop)

    def watch(self, running, stop=False):
        with mock.patch.object(main, "time", running):
            return main.watch_over(running, 20, types.SimpleNamespace(requested=stop))

    def test_seconds_count_from_the_beginning_of_the_world(self):
        running = Running(begins_at=32)
        self.assertTrue(self.watch(running))
        self.assertAlmostEqual(52, running.now, delta=0.3)
        self.assertTrue(running.table)
        self.assertEqual(6, len(self.lines))

    def test_the_process_that_the_world_waits_for_is_named(self):
        self.watch(Running(begins_at=8, waits="waits for visual_node (prepares the pictures of the scene)"))
        self.assertEqual(["sim_node waits for visual_node (prepares the pictures of the scene) (5 s)"], self.lines)

    def test_seconds_count_immediately_without_a_world(self):
        running = Running(begins_at=1e9, expected=False)
        self.assertTrue(self.watch(running))
        self.assertAlmostEqual(20, running.now, delta=0.3)

    def test_a_world_is_awaited_for_ten_minutes_unless_stopped(self):
        self.assertFalse(self.watch(Running(begins_at=1e9), stop=True))
        running = Running(begins_at=1e9)
        self.assertRaises(Refusal, self.watch, running)
        self.assertAlmostEqual(600, running.now, delta=1)


if __name__ == "__main__":
    unittest.main()
