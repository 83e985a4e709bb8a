#!/usr/bin/env python3
"""Tests of the longest intended delay of a run: the modalities are stopped after their last presentations."""
import os
import pathlib
import random
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.launch import arguments, delays

SCENE = '<sdf version="1.9"><world name="w">{}</world></sdf>'


class Delays(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def longest_s(self, *words, world="", profile=None):
        scene = self.folder / "scene.sdf"
        scene.write_text(SCENE.format(world), encoding="utf-8")
        if profile is not None:
            (self.folder / "p.xml").write_text(f"<profile>{profile}</profile>", encoding="utf-8")
            words = (*words, "--degrade", str(self.folder / "p.xml"))
        return delays.longest_s(arguments.parse([str(scene), *words], os.getcwd()))

    def test_a_run_without_delays_waits_no_longer(self):
        self.assertEqual(0, self.longest_s())

    def test_every_source_of_a_delay_is_found_in_any_unit(self):
        for text, expected in (("0.5", 0.5), ("0.25", 0.25)):
            self.assertAlmostEqual(expected, self.longest_s("--set", f"audio_node.presentation_delay={text}"))
            self.assertAlmostEqual(expected, self.longest_s(world=f'<tactus:audio_node presentation_delay="{text}"/>'))
        self.assertAlmostEqual(0.15 + 0.08, self.longest_s("--soa", "audio=80ms,visual=-20ms"))
        self.assertAlmostEqual(1.2, self.longest_s("--policy", "experiment", "--base", "1.2s"))

    def test_the_operators_of_a_modality_add_up(self):
        for seed in range(50):
            draw = random.Random(seed)
            delay, jitter = draw.randrange(0, 5000), draw.randrange(0, 500)
            profile = f'<degrade modality="haptic" delay="{delay}ms"/><degrade modality="haptic" jitter="{jitter}ms gauss"/><degrade modality="audio" delay="1us"/>'
            self.assertAlmostEqual((delay + jitter) * 1e-3, self.longest_s(profile=profile), places=5)

    def test_an_unreadable_profile_or_value_adds_nothing_and_a_large_one_is_bounded(self):
        self.assertEqual(0, self.longest_s("--set", "audio_node.presentation_delay=many"))
        self.assertEqual(0, self.longest_s(profile="<degrade"))
        self.assertEqual(delays.MAX_S, self.longest_s(profile='<degrade modality="audio" delay="60s"/><degrade modality="audio" delay="60s"/>'))


if __name__ == "__main__":
    sys.exit(unittest.main())
