#!/usr/bin/env python3
"""Tests of tactus replay: commands from keys and lines, and one sentence for each wrong argument."""
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import keys, replay
from tactus.refusal import Refusal

SAYS = {"scene": "table.sdf", "version": "1", "git": "", "seed": 7, "length_s": 3.0, "of_tactus": True, "recovered": "", "assets": 1,
        "tools": ["stylus", "lamp"]}


class Keys(unittest.TestCase):
    def setUp(self):
        self.commands = keys.KeyCommands("/nowhere/control")

    def test_every_key_of_the_help_has_its_command(self):
        read = b" .\x1b[C\x1b[D10ml"
        self.assertEqual(list(self.commands.commands_of_keys(read)),
                         ["toggle", "step", "seek +5", "seek -5", "speed 1", "seek 0", "speed max", "loop on"])
        self.assertEqual(list(self.commands.commands_of_keys(b"lq")), ["loop off", "quit"])

    def test_the_speed_doubles_and_halves_within_its_limits(self):
        received = [float(command.split()[1]) for command in self.commands.commands_of_keys(b"+" * 20)]
        self.assertEqual(received[:3], [2, 4, 8])
        self.assertEqual(received[-1], keys.MAX_SPEED)
        received = [float(command.split()[1]) for command in self.commands.commands_of_keys(b"-" * 40)]
        self.assertEqual(received[0], keys.MAX_SPEED / 2)
        self.assertEqual(received[-1], keys.MIN_SPEED)
        self.assertGreaterEqual(keys.MIN_SPEED, 0.01)  # sync/tools/replay/replay.h
        self.assertLessEqual(keys.MAX_SPEED, 100)
        list(self.commands.commands_of_keys(b"1"))
        self.assertEqual(next(self.commands.commands_of_keys(b"+")), "speed 2.0")

    def test_any_bytes_are_valid_commands_or_ignored(self):
        for seed in range(500):
            read = random.Random(seed).randbytes(200)
            for command in self.commands.commands_of_keys(read):
                self.assertRegex(command, r"^(toggle|step|quit|seek [+-]?\d+|speed (max|[0-9.]+)|loop (on|off))$")

    def test_lines_are_complete_for_any_fragmentation(self):
        text = "pause\nseek +3\n  speed max \nloop on\n".encode()
        for seed in range(50):
            cut, commands, received = random.Random(seed), keys.KeyCommands("/nowhere"), []
            at = 0
            while at < len(text):
                to = at + cut.randint(1, 9)
                received += commands.commands_of_lines(text[at:to])
                at = to
            self.assertEqual(received, ["pause", "seek +3", "speed max", "loop on"])

    def test_an_endless_line_uses_limited_memory(self):
        for _ in range(100):
            self.assertEqual(self.commands.commands_of_lines(b"x" * 4096), [])
        self.assertLessEqual(len(self.commands.rest), keys.MAX_LINE_BYTES)

    def test_a_command_without_a_reader_is_dropped(self):
        self.commands.send("pause")  # there is no pipe
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "control")
            os.mkfifo(path)
            commands = keys.KeyCommands(path)
            commands.send("pause")  # no reader has opened it
            reader = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
            commands.send("seek +5")
            self.assertEqual(os.read(reader, 100), b"seek +5\n")
            for _ in range(20000):  # more than the capacity of a pipe
                commands.send("toggle")
            os.close(reader)
            commands.send("pause")


class Words(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        (self.folder / "run.lcmlog").write_bytes(b"x")
        what = mock.patch.object(replay, "describe_log", lambda log: SAYS)
        what.start()
        self.addCleanup(what.stop)

    def parse(self, *words):
        return replay.parse(["run.lcmlog", *words], self.folder)[0]

    def refusal(self, *words):
        with self.assertRaises(Refusal) as refused:
            self.parse(*words)
        return str(refused.exception)

    def test_a_folder_replays_all_parts_of_its_recording(self):
        plan, stay, _ = replay.parse([".", "--stay"], self.folder)
        self.assertEqual(pathlib.Path(plan.replay[0]), self.folder)
        self.assertTrue(stay)

    def test_every_modality_is_live_unless_left_out(self):
        self.assertEqual(self.parse().without, [])
        self.assertEqual(set(self.parse("--only", "audio_node").without), {"haptic_node", "visual_node", "thermal_node", "haptic_node_lamp"})
        self.assertEqual(set(self.parse("--only", "haptic_node").without), {"audio_node", "visual_node", "thermal_node"})
        # The process of another tool needs haptic_node.
        self.assertEqual(set(self.parse("--without", "haptic_node").without), {"haptic_node", "haptic_node_lamp"})

    def test_options_of_the_replay_are_passed_to_it(self):
        plan = self.parse("--speed", "0.5", "--start", "1", "--channels", "WORLD_.*", "--rename", "A=B", "--rename", "C=D", "--loop")
        words = " ".join(plan.replay[1:])
        for part in ("--speed 0.5", "--start 1", "--channels WORLD_.*", "--rename A=B", "--rename C=D", "--loop"):
            self.assertIn(part, words)
        self.assertEqual(plan.seed, 7)
        self.assertEqual(self.parse("--seed", "12").seed, 12)

    def test_invalid_arguments_are_refused_with_one_sentence(self):
        self.assertIn("sim_node", self.refusal("--only", "sim_node"))
        self.assertIn("contradict", self.refusal("--degrade", "a.xml", "--as-recorded"))
        self.assertIn("holds the first tool", self.refusal("--only", "haptic_node_lamp"))
        self.assertIn("control character", self.refusal("--channels", "a\nb"))
        self.assertIn("--help", self.refusal("--speeed", "2"))
        self.assertIn("a.xml", self.refusal("--degrade", "a.xml"))
        for words in (["--port", "80"], ["--seed", "x"]):
            self.assertEqual(len(self.refusal(*words).strip().split("\n")), 1)

    def test_the_number_of_a_run_is_passed_to_the_replay_or_refused(self):
        self.assertIn("--run x", self.refusal("--run", "x"))
        self.assertIn("--run 0", self.refusal("--run", "0"))


class Descriptions(unittest.TestCase):
    def test_an_unreadable_log_is_refused_with_the_message_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(replay.cluster, "BIN", pathlib.Path(folder)):
            with self.assertRaisesRegex(Refusal, "is missing; run scripts/build"):
                replay.describe_log("run.lcmlog")
            program = pathlib.Path(folder) / "replay"
            program.write_text("#!/bin/sh\necho replay: run.lcmlog is not a log >&2\nexit 1\n")
            program.chmod(0o755)
            with self.assertRaisesRegex(Refusal, "run.lcmlog is not a log"):
                replay.describe_log("run.lcmlog")
            program.write_text("#!/bin/sh\necho '{\"tools\": []}'\n")
            self.assertEqual(replay.describe_log("run.lcmlog"), {"tools": []})


if __name__ == "__main__":
    unittest.main()
