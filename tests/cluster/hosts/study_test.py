"""Tests of a study on a live cluster: presented stimuli match the requested ones, and a killed session resumes at its last trial."""
import json
import os
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile
import time
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[3] / "scripts"
sys.path.insert(0, str(SCRIPTS / "python"))
from tactus.refusal import Refusal
from tactus.study import journal

TIMEOUT_S = 180  # a cluster starts within seconds; beside other work it takes longer


class StudyOnALiveCluster(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)
        self.log = self.out / "session.log"

    def start(self, study, *words):
        output = open(self.log, "ab")
        self.addCleanup(output.close)
        return subprocess.Popen([str(SCRIPTS / "tactus"), "study", "run", study, "--participant", "P01", "--simulated", "--out", str(self.out), *words], stdout=output, stderr=output)

    def trials(self, study):
        try:
            return [e for e in journal.read(self.out / study / "P01") if e["kind"] == "trial"]
        except Refusal:
            return []

    def wait_for_trials(self, study, count, process):
        end = time.monotonic() + TIMEOUT_S
        while len([t for t in self.trials(study) if not t["missed"]]) < count:
            self.assertIsNone(process.poll(), self.log.read_text(errors="replace")[-2000:])
            self.assertLess(time.monotonic(), end, self.log.read_text(errors="replace")[-2000:])
            time.sleep(0.1)

    def test_requested_stimuli_are_presented_and_a_killed_session_resumes(self):
        study = "audio_haptic_synchrony"
        first = self.start(study)
        try:
            self.wait_for_trials(study, 2, first)
        finally:
            first.send_signal(signal.SIGKILL)
            first.wait()
        second = self.start(study, "--most", "3")
        self.assertEqual(second.wait(TIMEOUT_S), 0, self.log.read_text(errors="replace")[-2000:])
        counted = [t for t in self.trials(study) if not t["missed"]]
        self.assertEqual([t["trial"] for t in counted], list(range(1, len(counted) + 1)))
        self.assertGreaterEqual(len(counted), 5)
        for t in counted:
            self.assertLessEqual(abs(t["row"]["soa_achieved_ms"] - t["level"]), 5)  # the study's tolerance: otherwise the trial counts as missed
            self.assertLess(abs(t["sensed_ms"] - t["row"]["soa_achieved_ms"]), 2)   # measured in the WAV, against the reported value
            self.assertEqual((t["by"], t["row"]["observer"]), ("simulated", "simulated"))
        self.assertTrue((self.out / study / "P01" / "trials.csv").exists())

    def test_a_simulated_participant_perceives_the_video_frames(self):
        study = "audio_visual_synchrony"
        process = self.start(study, "--most", "4")
        self.assertEqual(process.wait(TIMEOUT_S), 0, self.log.read_text(errors="replace")[-2000:])
        counted = [t for t in self.trials(study) if not t["missed"]]
        self.assertGreaterEqual(len(counted), 4)
        for t in counted:
            self.assertLess(abs(t["sensed_ms"] - t["row"]["soa_achieved_ms"]), 2)  # measured in pixels and samples, against the reported value

    def test_each_of_two_presses_is_felt_and_a_touch_delay_makes_one_softer(self):
        study = "haptic_delay_stiffness"
        process = self.start(study, "--most", "6")  # each of its delays once
        self.assertEqual(process.wait(2 * TIMEOUT_S), 0, self.log.read_text(errors="replace")[-2000:])
        pressed = [t for t in self.trials(study) if not t["missed"]]
        self.assertEqual(len(pressed), 6)
        for t in pressed:
            self.assertTrue(all(k > 0 for k in t["stiffnesses_N_m"]), t)
            columns = [t["row"][name] for name in ("stiffness_first_n_m", "stiffness_second_n_m")]
            self.assertTrue(all(abs(c - k) < 0.01 for c, k in zip(columns, t["stiffnesses_N_m"])), t)
            self.assertEqual((t["by"], t["row"]["observer"]), ("simulated", "simulated"))
        felt = lambda t, degraded: t["stiffnesses_N_m"][t["row"]["degraded_interval"] - 1 if degraded else 2 - t["row"]["degraded_interval"]]
        plain = statistics.median(felt(t, False) for t in pressed)
        late = statistics.median(felt(t, True) for t in pressed if t["level"] >= 30)
        self.assertLess(late, 0.75 * plain)  # 0.41 was measured; a delay without effect gives 1

    def test_a_game_is_a_trial(self):
        study = "senses_removed"
        process = self.start(study, "--most", "2")
        self.assertEqual(process.wait(2 * TIMEOUT_S), 0, self.log.read_text(errors="replace")[-2000:])
        games = [t["row"] for t in self.trials(study) if not t["missed"]]
        self.assertEqual(len(games), 2)
        for row in games:
            self.assertIn(row["success"], (0, 1))
            self.assertLessEqual(row["completion_time_s"], 30)


if __name__ == "__main__":
    unittest.main()
