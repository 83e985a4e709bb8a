#!/usr/bin/env python3
"""Tests of the options of scripts/run for the size of recording files."""
import os
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import arguments
from test_launch import refusal_of


class Recordings(unittest.TestCase):
    def plan(self, *words):
        with tempfile.TemporaryDirectory() as folder:
            return arguments.parse(["--out", f"{folder}/out", *words], os.getcwd())

    def test_recording_limits_are_passed_to_the_recorder(self):
        self.assertEqual(self.plan().recorder, [])
        self.assertEqual(self.plan("--split-mb", "100", "--keep", "3", "--tags", "sim_node.*", "--tags", "none").recorder,
                         ["--split-mb", "100", "--keep", "3", "--tags", "sim_node.*", "--tags", "none"])

    def test_contradictory_limits_are_refused_at_the_start(self):
        self.assertIn("--keep needs", refusal_of("--keep", "3"))
        self.assertIn("twice", refusal_of("--split-mb", "100", "--max-mb", "150"))
        self.assertIn("--split-mb", refusal_of("--split-mb", "0"))
        self.assertIn("--keep", refusal_of("--split-mb", "1", "--keep", "1.5"))
        self.assertEqual("", refusal_of("--split-minutes", "1", "--max-mb", "150", "--out", "/tmp/none/of/it"))

    def test_a_folder_with_a_part_of_a_recording_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "run.7.lcmlog").touch()
            self.assertIn("already holds a run", refusal_of("--out", folder))


if __name__ == "__main__":
    unittest.main()
