"""tactus study: its verbs, the output of check, and the messages for invalid arguments."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

TACTUS = pathlib.Path(__file__).resolve().parents[3] / "scripts" / "tactus"


class Check(unittest.TestCase):
    def run_study(self, *words):
        done = subprocess.run([str(TACTUS), "study", *words], capture_output=True, text=True, env={**os.environ, "TACTUS_BIN": "/nowhere", "OPENBLAS_NUM_THREADS": "1"})
        return done.returncode, done.stdout, done.stderr

    def test_check_prints_the_plan_its_duration_and_its_power(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "check.json")
            status, said, _ = self.run_study("check", "audio_visual_synchrony", "--simulations", "40", "--json", file)
            figures = json.loads(pathlib.Path(file).read_text(encoding="utf-8"))
        self.assertEqual(status, 0)
        self.assertIn("240 trials", said)
        self.assertIn("first trials: audio-visual -300ms, ", said)
        self.assertIn("minutes", said)
        pss = next(f for f in figures["power"] if f["parameter"] == "pss")
        self.assertLess(abs(pss["bias"]), 5)  # 40 participants with a standard error of 7 ms each: 4.5 of the mean's
        self.assertTrue(8 < pss["half_width"] < 25, pss)

    def test_ratings_that_the_analysis_cannot_use_cause_a_warning(self):
        text = """<study name="s" version="1" scene="yielding_board.sdf" task="press">
          <conditions><factor modality="haptic" operator="delay" levels="0ms 40ms"/></conditions><procedure kind="constant" repetitions="2"/>
          <response kind="rating" lowest="0" highest="9" step="1"><question>How %s?</question></response></study>"""
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "s.xml"
            for question, warned in (("stiff was the board", True), ("high was the stiffness", False)):
                file.write_text(text % question, encoding="utf-8")
                status, said, complaint = self.run_study("check", str(file))
                self.assertEqual((status, complaint), (0, ""))
                self.assertEqual("not analysed" in said, warned, said)

    def test_games_report_the_smallest_loss_that_they_show(self):
        status, said, _ = self.run_study("check", "senses_removed", "--simulations", "200")
        self.assertEqual(status, 0)
        self.assertIn("50 games", said)
        self.assertIn("profiles not checked", said)
        self.assertIn("% power", said)

    def test_an_invalid_argument_is_refused_with_one_sentence(self):
        for words, expected in ((["dance"], "there is no verb 'dance'"), (["check", "nowhere.xml"], "give a study file, or one of"),
                                (["check"], "required"), (["check", "senses_removed", "--participants", "1,none"], "--participants needs numbers"),
                                (["check", "senses_removed", "--pilot", "nowhere.csv"], "nowhere.csv: cannot be read"), (["check", "thermal_lag", "--simulations", "1"], "from 2"), (["run", "thermal_lag", "--participant", "P01"], "no way to ask the questions"),
                                (["run", "thermal_lag", "--participant", "P 1", "--simulated"], "give a name of letters")):
            status, _, complaint = self.run_study(*words)
            self.assertEqual(status, 1, words)
            self.assertIn(expected, complaint)
            self.assertEqual(len(complaint.strip().splitlines()), 1, complaint)

    def test_every_verb_prints_help(self):
        for words in (["--help"], ["check", "--help"], ["run", "--help"]):
            status, said, _ = self.run_study(*words)
            self.assertEqual(status, 0)
            self.assertTrue(said.lower().startswith("usage"), said[:80])


if __name__ == "__main__":
    unittest.main()
