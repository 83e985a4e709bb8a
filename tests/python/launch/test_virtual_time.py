"""Tests of a complete run in virtual time: bit-identical results, presentation of all expected events, effects of faults of bus and modalities."""
import csv
import filecmp
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

BIN = pathlib.Path(os.environ.get("TACTUS_BIN") or pathlib.Path(__file__).resolve().parents[3] / "build" / "dev" / "bin")
RUN = pathlib.Path(__file__).resolve().parents[3] / "scripts" / "run"
# A steel ball falls 2 cm onto oak: its first hit comes 64 ms after the world begins.
EARLY = """<?xml version="1.0"?>
<sdf version="1.9" xmlns:tactus="https://tactus.dev/sdf"><world name="w"><gravity>0 0 -9.81</gravity>
<model name="floor"><static>true</static><pose>0 0 -0.1 0 0 0</pose><link name="l"><tactus:surface material="oak"/><collision name="c">
<geometry><box><size>3 3 0.2</size></box></geometry></collision></link></model>
<model name="b"><pose>0.5 0 0.04 0 0 0</pose><link name="l"><tactus:surface material="steel"/><collision name="c">
<geometry><sphere><radius>0.02</radius></sphere></geometry></collision></link></model>
</world></sdf>
"""
PROFILE = """<profile name="late">
  <degrade modality="audio" delay="100ms"/>
</profile>
"""


def run(out, *words, seconds=4, status=0):
    done = subprocess.run([str(RUN), "--virtual-time", "--seconds", str(seconds), "--out", str(out), *words], capture_output=True, text=True,
                          check=False)
    if done.returncode != status:
        raise AssertionError(f"status {done.returncode}: {done.stdout}{done.stderr}")
    return done


def summary(out):
    return json.loads((out / "summary.json").read_text(encoding="utf-8"))


class VirtualTime(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_a_seed_determines_log_and_sound_exactly(self):
        for name, seed in (("a", "5"), ("b", "5"), ("c", "6")):
            run(self.folder / name, "--seed", seed)
        same = lambda one, other, what: filecmp.cmp(self.folder / one / what, self.folder / other / what, shallow=False)
        for what in ("run.lcmlog", "audio.wav", "presented.csv", "haptic.csv"):
            self.assertTrue(same("a", "b", what), what)
        self.assertFalse(same("a", "c", "run.lcmlog"))

    def test_every_modality_presents_its_expected_events_without_missed_ticks(self):
        out = self.folder / "run"
        said = run(out, seconds=12)
        facts = summary(out)
        self.assertGreater(facts["contacts"]["by_modality"]["audio"]["expected"], 5, facts)
        for name, sense in facts["contacts"]["by_modality"].items():
            self.assertEqual(sense["lost"], 0, name)
            self.assertEqual(sense["presented"], sense["expected"], name)
        for name, node in facts["nodes"].items():
            self.assertEqual(node["missed_ticks"], 0, name)
        self.assertIn("times as fast as real time", said.stderr)

    def test_the_events_of_the_first_instants_are_presented_with_every_seed(self):
        scene = self.folder / "early.sdf"
        scene.write_text(EARLY, encoding="utf-8")
        heard = set()
        for seed in range(1, 8):
            out = self.folder / f"early{seed}"
            run(out, str(scene), "--seed", str(seed), seconds=1)
            facts = summary(out)
            self.assertEqual([], [w for w in facts["warnings"] if "ready" in w or "presented none" in w], seed)
            for name in ("audio", "visual"):
                sense = facts["contacts"]["by_modality"][name]
                self.assertEqual(facts["contacts"]["hit"] + (facts["contacts"]["begin"] if name == "visual" else 0), sense["presented"], (seed, name))
            heard.add(facts["contacts"]["hit"])
        self.assertEqual({5}, heard)

    def test_an_own_delay_that_is_longer_than_the_rest_of_the_run_loses_no_event(self):
        out = self.folder / "late"
        run(out, "--set", "audio_node.presentation_delay=0.5", "--without", "sync_node", seconds=6)
        audio = summary(out)["contacts"]["by_modality"]["audio"]
        self.assertEqual((0, audio["expected"]), (audio["lost"], audio["presented"]))

    def test_a_log_renders_the_forces_of_the_run_also_after_the_world_has_ended(self):
        out = self.folder / "press"
        scene = RUN.parent.parent / "sim_node" / "scenes" / "yielding_board.sdf"
        run(out, str(scene), "--seed", "3", seconds=5)
        done = subprocess.run([BIN / "haptic_node", "--log", out / "run.lcmlog", "--trace", out / "again.csv"], capture_output=True, text=True, check=False)
        self.assertEqual(0, done.returncode, done.stderr)
        read = lambda name: {row["host_s"]: row for row in csv.DictReader((out / name).read_text(encoding="utf-8").splitlines())}
        live, again = read("haptic.csv"), read("again.csv")
        ticks = sorted(live.keys() & again.keys(), key=float)
        self.assertGreater(len(ticks), 4000)
        self.assertGreater(max(abs(float(row["force_z_N"])) for row in live.values()), 0.3)
        for name in ("force_x_N", "force_y_N", "force_z_N", "fade"):  # in single precision
            self.assertLess(max(abs(float(live[t][name]) - float(again[t][name])) for t in ticks), 1e-5, name)

    def test_a_log_with_any_bytes_in_its_name_is_exported(self):
        run(self.folder / "run", seconds=1)
        log = os.fsencode(self.folder) + b"/caf\xe9 \xff.lcmlog"
        os.rename(self.folder / "run" / "run.lcmlog", log)
        tables = self.folder / "tables"
        tables.mkdir()
        done = subprocess.run([BIN / "export_log", log, "--out", tables], capture_output=True, check=False)
        self.assertEqual((0, b""), (done.returncode, done.stderr))
        self.assertIn("caf\ufffd", json.loads((tables / "schema.json").read_text(encoding="utf-8"))["logs"][0])

    def test_a_profile_delays_only_its_modality(self):
        profile = self.folder / "late.xml"
        profile.write_text(PROFILE, encoding="utf-8")
        run(self.folder / "healthy", seconds=8)
        run(self.folder / "late", "--degrade", str(profile), seconds=8)
        healthy, late = (summary(self.folder / name)["asynchrony_ms"] for name in ("healthy", "late"))
        self.assertAlmostEqual(late["audio_visual"]["p50"] - healthy["audio_visual"]["p50"], -100, delta=1)
        self.assertEqual(late["haptic_visual"], healthy["haptic_visual"])

    def test_bus_losses_lose_no_event_and_bus_latency_delays_modalities(self):
        run(self.folder / "lossy", "--loss-percent", "20", "--latency-ms", "15", seconds=8)
        for name, sense in summary(self.folder / "lossy")["contacts"]["by_modality"].items():
            self.assertEqual(sense["lost"], 0, name)

    def test_a_player_wins_only_with_sight_and_touch(self):
        blind, numb = self.folder / "blind.xml", self.folder / "numb.xml"
        blind.write_text('<profile><degrade modality="visual" off="true"/></profile>', encoding="utf-8")
        numb.write_text('<profile><degrade modality="haptic" off="true"/></profile>', encoding="utf-8")
        for seed in ("1", "2", "3"):
            game = {}
            for name, words in (("whole", []), ("blind", ["--degrade", str(blind)]), ("numb", ["--degrade", str(numb)])):
                out = self.folder / f"{name}{seed}"
                run(out, "--player", "--seed", seed, *words, seconds=20)
                game[name] = summary(out)["game"]
            self.assertEqual(game["whole"]["filled"], 3, game)
            self.assertLess(game["blind"]["filled"], 3, game)
            self.assertEqual(game["numb"]["filled"], 0, game)  # a hand without force pushes nothing

    def test_an_interrupted_run_ends_early_with_all_results(self):
        out = self.folder / "long"
        process = subprocess.Popen([str(RUN), "--virtual-time", "--seconds", "80000", "--out", str(out)], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        until = time.monotonic() + 60
        while not (out / "run.lcmlog").exists() and time.monotonic() < until:
            time.sleep(0.1)
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=60)
        self.assertTrue((out / "summary.json").exists(), said)

    def test_options_that_need_real_time_are_refused_with_one_sentence(self):
        for words in (["--listen"], ["--window"], ["--live"], ["--device", "external:arm"], ["--loss-percent", "101"]):
            done = run(self.folder / "refused", *words, status=1)
            self.assertEqual(len(done.stderr.strip().split("\n")), 1, done.stderr)
            self.assertFalse((self.folder / "refused").exists())
        done = subprocess.run([str(RUN), "--latency-ms", "3"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("--virtual-time", done.stderr)

    def test_an_invalid_plan_is_refused_with_one_sentence(self):
        program = pathlib.Path(os.environ["TACTUS_BIN"]) / "virtual_time"
        plan = self.folder / "plan.json"
        for text in ("", "[]", "{}", '{"a": []}', '{"a": ["sim_node", 3]}', '{"a": ["rm"]}'):
            plan.write_text(text, encoding="utf-8")
            done = subprocess.run([str(program), str(plan)], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 1, text)
            self.assertTrue(done.stderr.startswith("virtual_time: ") and done.stderr.count("\n") == 1, done.stderr)


if __name__ == "__main__":
    sys.exit(unittest.main())
