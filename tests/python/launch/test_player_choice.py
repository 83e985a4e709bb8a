#!/usr/bin/env python3
"""Tests of the choice of the simulated player on the command line of a run."""
import os
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import arguments, cluster
from tactus.refusal import Refusal


def command(*words):
    plan = arguments.parse(list(words), os.getcwd())
    return plan, cluster.commands(plan, 1, "").get(arguments.PLAYER)


class PlayerChoice(unittest.TestCase):
    def test_without_a_name_the_player_of_fixed_rules_starts_with_the_command_line_from_before(self):
        plan, words = command("--player")
        self.assertNotIn("--player", words)
        for scene in (command("dark_room_game.sdf", "--player"), command("--player", "dark_room_game.sdf"), command("--player", "stage_model", "dark_room_game.sdf")):
            self.assertEqual("dark_room_game.sdf", scene[0].scene.name)
            self.assertNotIn("--player", scene[1])
        self.assertIsNone(command()[1])

    def test_a_named_observer_reaches_the_program(self):
        for name in ("observer", "observer:0", "observer:17"):
            for words in (("--player", name), (f"--player={name}",)):
                started = command(*words)[1]
                self.assertEqual(name, started[started.index("--player") + 1])

    def test_an_unknown_player_is_refused_with_the_names_of_the_known_ones(self):
        for name in ("somebody", "observer:", "observer:x", "observer:4294967296"):
            with self.assertRaisesRegex(Refusal, "stage_model, observer or observer:NUMBER"):
                command(f"--player={name}")


if __name__ == "__main__":
    sys.exit(unittest.main())
