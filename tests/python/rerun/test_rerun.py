"""Tests of tactus rerun with whole runs in virtual time: the log is reproduced, another profile gives the truth, and unusable logs give one sentence."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import types
import unittest

os.environ["OPENBLAS_NUM_THREADS"] = "1"
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
BIN = pathlib.Path(os.environ.setdefault("TACTUS_BIN", str(ROOT / "build" / "dev" / "bin")))
sys.path[:0] = [str(ROOT / "scripts" / "python"), str(ROOT / "tests" / "measure" / "hands")]
import known_hands
from tactus import refusal
from tactus.rerun import comparison, play


def make_log(folder, hand, scene_text, path, seconds, profile=None):
    """Runs a scene with a hand of known impedance on a known intention; returns (time, positions, forces)."""
    scene, motion = folder.parent / "scene.sdf", folder.parent / "true.csv"
    scene.write_text(scene_text, encoding="utf-8")
    play.write_motion(motion, np.arange(len(path)) * 1e-3 + play.PATH_BEGINS_S, path)
    record = types.SimpleNamespace(name="hand", tool=0, first_tool=True, seed=3, policy="", external=False, commands=0)
    return play.play(play.words_of(scene, record, hand, motion, profile, [], seconds, folder), record)


class Rerun(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def rerun(self, *words):
        return subprocess.run([str(ROOT / "scripts" / "tactus"), "rerun", *map(str, words)], capture_output=True, text=True, check=False, cwd=self.folder)

    def one_sentence(self, done, *parts):
        self.assertEqual(1, done.returncode, done.stdout + done.stderr)
        self.assertEqual(1, len(done.stderr.strip().split("\n")), done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)

    def test_a_profile_that_cannot_be_used_is_refused_before_anything_runs(self):
        (self.folder / "run.lcmlog").write_bytes(b"")
        for name, text, reason in (("late.xml", '<profile name="x"><degrade modality="haptic" delay="20 bananas"/></profile>', 'late.xml:1: delay="20 bananas"'), ("cut.xml", "<profile", "cut.xml:1: ")):
            (self.folder / name).write_text(text, encoding="utf-8")
            self.one_sentence(self.rerun("run.lcmlog", "--degrade", name, "--out", "again"), reason)
            self.assertFalse((self.folder / "again").exists())

    def test_the_reason_of_a_failed_run_is_that_of_the_node_that_ended(self):
        said = "haptic_node: a.xml:1: wrong\nrecorder: run.lcmlog: 38 events\nvirtual_time: 1.1 s in 0.006 s\nvirtual_time: haptic_node ended; see its message above\n"
        self.assertEqual("haptic_node: a.xml:1: wrong", refusal.reason_of(said))
        self.assertEqual("replay: no log", refusal.reason_of("a warning\nreplay: no log\n"))
        self.assertEqual("", refusal.reason_of(""))
        self.assertEqual("virtual_time: x ended; see its message above", refusal.reason_of("virtual_time: x ended; see its message above"))

    def test_the_profile_of_the_log_reproduces_it_and_another_one_gives_the_truth(self):
        hand = known_hands.hand("stylus")
        path = known_hands.intention(known_hands.TASKS["presses"], np.random.default_rng(4))[1][:5000]
        task = known_hands.TASKS["presses"].scene
        make_log(self.folder / "log", hand, task, path, 5)
        profile = self.folder / "soft.xml"
        profile.write_text(known_hands.profile('stage="force" gain="0.5"'), encoding="utf-8")
        time_s, _, truth_N = make_log(self.folder / "true", hand, task, path, 5, profile)
        done = self.rerun("log", "--scene", "scene.sdf", "--degrade", "soft.xml", "--draws", 3, "--out", "again", "--json", "f.json")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        result = json.loads((self.folder / "f.json").read_text(encoding="utf-8"))
        # The intention is that of the log exactly, up to the noise of the fit, 2e-8 m, and a coupling of at most 2000 N/m.
        same = result["figures"]["as_logged"]
        self.assertGreater(same["within_10_percent"], 0.999)
        self.assertLess(same["difference_rms_N"], 0.002)
        self.assertLess(same["position_rms_m"], 1e-6)
        table = np.genfromtxt(self.folder / "again" / "soft.csv", delimiter=",", names=True)
        median = np.column_stack([table[f"force_{axis}_median_N"] for axis in "xyz"])
        truth = play.at(table["time_s"], time_s, truth_N)
        self.assertGreater(comparison.within(truth, median), 0.95)
        recorded = np.column_stack([table[f"force_{axis}_recorded_N"] for axis in "xyz"])
        self.assertLess(comparison.within(truth, recorded), 0.6)
        for name in ("mass_kg", "damping_N_s_m"):
            self.assertAlmostEqual(1, result["hand"][name]["median"] / getattr(hand, name), delta=0.05)
        self.assertEqual([], result["notes"])
        self.assertTrue((self.folder / "again" / "runs" / "soft" / "3" / "run.lcmlog").exists())

    def test_a_log_without_contact_gives_the_sentence_and_hands_of_the_population(self):
        path = np.column_stack([0.02 * np.sin(2 * np.pi * np.arange(3000) * 1e-3), np.zeros(3000), np.full(3000, 0.2)])
        make_log(self.folder / "log", known_hands.hand("stylus"), known_hands.TASKS["taps"].scene, path, 3)
        done = self.rerun("log", "--scene", "scene.sdf", "--draws", 2, "--json", "f.json")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        self.assertIn("touches nothing in this log, so its impedance is unknown", done.stdout)
        result = json.loads((self.folder / "f.json").read_text(encoding="utf-8"))
        self.assertFalse(result["hand"]["contact"])
        self.assertGreater(result["hand"]["mass_kg"]["high"] / result["hand"]["mass_kg"]["low"], 20)
        self.assertLess(result["figures"]["as_logged"]["position_rms_m"], 1e-4)

    def test_a_fit_that_does_not_explain_the_log_is_named(self):
        from tactus.rerun import hand_model, identify, main
        record = types.SimpleNamespace(gap_s=0.001)
        stiff, soft = (identify.Posterior(hand_model.Hand(0.2, 10.0, stiffness, 1.0, 1.0), [], True) for stiffness in (4900.0, 300.0))
        figures = lambda share: {"as_logged": {"within_10_percent": share}}
        self.assertEqual([], main.notes_of(record, soft, figures(0.96)))
        self.assertIn("in 17 % of the ticks with force, so do not use the other rows", main.notes_of(record, soft, figures(0.166))[0])
        self.assertIn("hardly yields", main.notes_of(record, stiff, figures(1.0))[0])

    def test_an_unusable_log_gives_one_sentence(self):
        path = np.tile([0.0, 0.0, 0.2], (1500, 1))
        make_log(self.folder / "log", known_hands.hand("stylus"), known_hands.TASKS["taps"].scene, path, 1.5)
        whole = (self.folder / "log" / "run.lcmlog").read_bytes()
        self.one_sentence(self.rerun("log", "--scene", "scene.sdf"), "the hand does not move")
        self.one_sentence(self.rerun("log"), "scene.sdf", "--scene")
        self.one_sentence(self.rerun("log", "--scene", "scene.sdf", "--tool", "foot"), "--tool foot", "hand")
        self.one_sentence(self.rerun("log", "--run", "2"), "2")
        for name, data in (("empty", b""), ("noise", np.random.default_rng(1).bytes(5000)), ("head", whole[:2000])):
            (self.folder / f"{name}.lcmlog").write_bytes(data)
            self.one_sentence(self.rerun(f"{name}.lcmlog", "--scene", "scene.sdf", "--out", name), "rerun: ")
            self.assertFalse((self.folder / name).exists())

    def test_a_malformed_summary_names_no_scene(self):
        from tactus.refusal import Refusal
        from tactus.rerun import recording
        for text in ('{"scene": 0}', '{"scene": ["a.sdf"]}', "[]", "7", "{", "[" * 100_000, '{"scene": null}', '{"scene": "x/other.sdf"}', '{"scene": "a\\u0000"}'):
            (self.folder / "summary.json").write_text(text, encoding="utf-8")
            with self.subTest(text[:20]), self.assertRaisesRegex(Refusal, "give its SDF world with --scene"):
                recording.scene_of(str(self.folder), "world.sdf", None)
        (self.folder / "world.sdf").write_text("<sdf/>", encoding="utf-8")
        self.assertEqual(str(self.folder / "world.sdf"), recording.scene_of(str(self.folder), "world.sdf", None))

    def test_an_invalid_argument_gives_one_sentence(self):
        (self.folder / "run.lcmlog").write_bytes(b"")
        for words, part in ((["nothing"], "nothing"), ([".", "--draws", "0"], "--draws 0"), ([".", "--seed", "-1"], "--seed"), ([".", "--degrade", "no.xml"], "--degrade no.xml"),
                            ([".", "--run", "x"], "--run x"), ([".", "--out", "run.lcmlog"], "--out")):
            self.one_sentence(self.rerun(*words), part)


if __name__ == "__main__":
    unittest.main()
