#!/usr/bin/env python3
"""Tests of how a run ends its nodes."""

import pathlib
import sys
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import services


class Stopping(unittest.TestCase):
    """Ends services in a time that the test moves."""

    class Clock:
        def __init__(self):
            self.now_s = 0.0

        def monotonic(self):
            return self.now_s

        def sleep(self, seconds):
            self.now_s += seconds

    class Node:
        def __init__(self, clock, ends_s):
            self.name, self.clock, self.ends_s, self.controls = "visual_node", clock, ends_s, ""

        def is_down(self):
            return self.clock.now_s >= self.ends_s or "k" in self.controls

        def control(self, letter):
            self.controls += letter

    def stop(self, ends_s, progress=lambda clock: None):
        clock = self.Clock()
        node = self.Node(clock, ends_s)
        with mock.patch.object(services, "time", clock):
            killed = services.end_or_kill([node], 15, lambda: progress(clock))
        return killed, node.controls, clock.now_s

    def test_a_node_that_ends_in_time_is_not_killed(self):
        self.assertEqual(self.stop(14)[:2], ([], ""))

    def test_a_node_without_progress_is_killed_when_the_patience_ends(self):
        killed, controls, now_s = self.stop(100)
        self.assertEqual((killed, controls), (["visual_node"], "k"))
        self.assertAlmostEqual(now_s, 15, delta=0.1)

    def test_a_node_whose_video_grows_is_awaited(self):
        self.assertEqual(self.stop(100, progress=lambda clock: clock.now_s // 10)[:2], ([], ""))

    def test_a_node_is_killed_when_its_video_stops_growing(self):
        killed, _, now_s = self.stop(100, progress=lambda clock: min(clock.now_s, 30) // 10)
        self.assertEqual(killed, ["visual_node"])
        self.assertAlmostEqual(now_s, 45, delta=0.2)


if __name__ == "__main__":
    unittest.main()
