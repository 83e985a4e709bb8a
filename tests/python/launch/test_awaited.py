#!/usr/bin/env python3
"""Tests of the processes that a world waits for."""
import os
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.cluster.commands import without_absent
from tactus.launch import arguments, cluster


class Awaited(unittest.TestCase):
    def test_the_world_waits_for_every_other_process_of_the_run(self):
        for words in ([], ["--without", "audio_node"], ["--player"]):
            plan = arguments.parse(words, os.getcwd())
            command = cluster.commands(plan, 1, "")["sim_node"]
            awaited = [value for before, value in zip(command, command[1:]) if before == cluster.AWAIT]
            self.assertEqual([name for name in plan.nodes() if name != "sim_node"], awaited)

    def test_a_world_of_a_cluster_does_not_wait_for_a_process_that_no_host_runs(self):
        words = ["sim_node", "scene.sdf", "--await", "audio_node", "--await", "visual_node", "--seed", "1"]
        self.assertEqual(["sim_node", "scene.sdf", "--await", "visual_node", "--seed", "1"],
                         without_absent(words, {"visual_node": None, "sim_node": None}))


if __name__ == "__main__":
    sys.exit(unittest.main())
