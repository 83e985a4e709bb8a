#!/usr/bin/env python3
"""Tests of the wait between two profiles: messages that the previous one delays are presented before the next stimulus."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.study import stimuli


class Runner:
    """A trial runner that stores how long it was waited for."""

    def __init__(self):
        self.waited_s = []

    def apply_profile(self, _profile, _timeout_s):
        return True

    def wait_for(self, _condition, timeout_s):
        self.waited_s.append(timeout_s)
        return False


class Settling(unittest.TestCase):
    def test_a_profile_settles_after_the_longest_delay_of_the_one_before(self):
        runner = Runner()
        profile = '<profile><degrade modality="haptic" delay="{}ms"/><degrade modality="audio" delay="10ms"/></profile>'
        for delay_ms in (700, 0, 50):
            self.assertEqual("", stimuli.ready(runner, profile.format(delay_ms)))
        for expected, waited in zip((0.0, 0.7, 0.01), runner.waited_s, strict=True):
            self.assertAlmostEqual(stimuli.SETTLES_S + expected, waited)


if __name__ == "__main__":
    sys.exit(unittest.main())
