#!/usr/bin/env python3
"""Tests that every program of a run that reads the scene receives the folders that the user allows it."""
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import arguments, cluster, main
from tactus.refusal import Refusal


def refusal_of(*words):
    try:
        arguments.parse(list(words), os.getcwd())
    except Refusal as refusal:
        return str(refusal)
    return ""


class SceneFolders(unittest.TestCase):
    def test_the_folders_of_a_scene_go_to_every_program_that_reads_it(self):
        with tempfile.TemporaryDirectory() as name, mock.patch.dict(os.environ):
            folders = [pathlib.Path(name, each) for each in ("models", "more", "other")]
            for folder in folders:
                folder.mkdir()
            os.environ.pop(arguments.GAZEBO_FOLDERS, None)
            os.environ[arguments.SCENE_FOLDERS] = f"{folders[1]}::{folders[2]}:{folders[0]}"
            plan = arguments.parse(["--scene-folder", "models", "--player"], name)
            self.assertEqual([folders[0], folders[1], folders[2]], plan.scene_folders)
            for node, words in cluster.commands(plan, 1, "").items():
                found = [b for a, b in zip(words, words[1:]) if a == "--scene-folder"]
                self.assertEqual([str(f) for f in folders] if node in ("sim_node", arguments.PLAYER) else [], found, node)
            self.assertLessEqual(set(folders), set(main.inputs(plan)))
            os.environ[arguments.SCENE_FOLDERS] = "/no/such"
            self.assertIn("TACTUS_SCENE_FOLDERS: /no/such is not a folder", refusal_of())
            os.environ[arguments.SCENE_FOLDERS] = ""
            os.environ[arguments.GAZEBO_FOLDERS] = ""
            self.assertEqual([], arguments.parse([], name).scene_folders)
            os.environ[arguments.GAZEBO_FOLDERS] = f"/no/such::{folders[1]}:{folders[0]}"
            self.assertEqual([folders[1], folders[0]], arguments.parse([], name).scene_folders)
            self.assertEqual([folders[0], folders[1]], arguments.parse(["--scene-folder", "models"], name).scene_folders)
            self.assertIn("--scene-folder nowhere is not a folder", refusal_of("--scene-folder", "nowhere"))


if __name__ == "__main__":
    unittest.main()
