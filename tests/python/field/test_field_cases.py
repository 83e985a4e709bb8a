"""A table of inputs from the field: each is given to the program that reads it, and its answer is compared with the right one (tests/data/field/README.md)."""
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "python" / "log"))
from log_files import BIN, read_log, write_log

CASES = ROOT / "tests" / "data" / "field"
GRAVITY_M_S2, SPRING_N_M = 10, 1000
# Elements without effect here: the line of the warning, and a word of it.
IGNORED = {"ball.sdf": None, "local.sdf": None, "moon.sdf": (1, "spherical_coordinates"), "remote.sdf": (2, "fuel.gazebosim.org"), "sensor.sdf": (2, "sensor")}
# Touching bodies: their overlap at the start, m, and the number of bodies that part: one on a floor, or two.
TOUCHING = {"on_box.sdf": (0, 1), "depth_1e-4.sdf": (1e-4, 1), "two.sdf": (0, 2), "dyn_box_under.sdf": (1e-4, 2)}
# With two groups, surfaces meet at the contact tolerance (sim_node/dual/README.md): bodies that begin nearer part by it, slowly.
REST_M, CONTACT_TOLERANCE_M = 1e-5, 5e-4
HOUR_US = 3600 * 1_000_000


class FieldCases(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def program(self, *words, status=0):
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, cwd=self.folder, env={**os.environ, "TACTUS_BIN": str(BIN)})
        self.assertEqual(status, done.returncode, f"{words}\n{done.stdout}{done.stderr}")
        return done

    def run_world(self, scene, seconds, *words):
        """Runs a scene of the table in virtual time; returns its summary."""
        self.out = self.folder / f"out{len(os.listdir(self.folder))}"
        self.program(ROOT / "scripts" / "run", CASES / scene, "--virtual-time", "--seconds", seconds, "--out", self.out, *words)
        return json.loads((self.out / "summary.json").read_text(encoding="utf-8"))

    def states(self):
        """{body: [{field: value}]} of all snapshots of the run, in order."""
        tables = self.folder / "tables"
        shutil.rmtree(tables, ignore_errors=True)
        tables.mkdir()
        self.program(BIN / "export_log", self.out, "--out", tables, "--channels", "WORLD_STATE")
        snapshots = {}
        with open(tables / "WORLD_STATE.csv", encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                if match := re.fullmatch(r"bodies\[(\d+)\]\.(.*)", row["field"]):
                    snapshots.setdefault((row["seq"], match[1]), {})[match[2]] = float(row["value"])
        bodies = {}
        for fields in snapshots.values():
            bodies.setdefault(int(fields["body"]), []).append(fields)
        return bodies

    def test_bodies_whose_faces_touch_at_the_start_rest(self):
        for name, (overlap_m, parting) in TOUCHING.items():
            for groups, apart_m in (("single", 0), ("dual", CONTACT_TOLERANCE_M)):
                with self.subTest(f"{name}, {groups}"):
                    self.run_world(f"mesh_touching/{name}", 1, "--set", f"sim_node.groups={groups}")
                    bodies = [states for states in self.states().values() if states[0]["position_m.z"] > 0]  # without the floor
                    self.assertEqual(parting, len(bodies))
                    bodies.sort(key=lambda states: states[0]["position_m.z"])
                    for nth, states in enumerate(bodies):
                        up = 1 if nth == parting - 1 else -1
                        # Bodies that touch stay, those that overlap may part by their overlap.
                        begin = 0.05 + 0.1 * nth - (overlap_m if up > 0 else 0)
                        furthest = begin + up * (apart_m + overlap_m) / parting
                        low, high = sorted((begin, furthest))
                        for fields in states:
                            for axis in "xy":
                                self.assertAlmostEqual(0, fields[f"position_m.{axis}"], delta=REST_M)
                            self.assertTrue(low - REST_M <= fields["position_m.z"] <= high + REST_M, fields)
                        if groups == "dual":
                            self.assertAlmostEqual(furthest, states[-1]["position_m.z"], delta=REST_M)

    def test_elements_without_effect_load_with_a_warning_that_names_their_line(self):
        for name, warning in IGNORED.items():
            with self.subTest(name):
                said = self.program(BIN / "sim_node", "--check", CASES / "ignored_elements" / name).stderr
                if warning is None:
                    self.assertEqual("", said)
                else:
                    for line in said.strip().splitlines():
                        self.assertRegex(line, rf"^sim_node: \S*{name}:\d+: ")
                    self.assertIn(f"{name}:{warning[0]}: ", said)
                    self.assertIn(warning[1], said)

    def test_a_closed_mesh_has_the_mass_of_its_volume_whichever_way_its_faces_point(self):
        self.run_world("inside_out/weigh.sdf", 2)
        bodies = self.states()
        self.assertEqual(5, len(bodies))
        for body, states in bodies.items():
            with self.subTest(body):
                sunk_m = 5 - states[-1]["position_m.z"]
                self.assertAlmostEqual(2.25, SPRING_N_M * sunk_m / GRAVITY_M_S2, delta=0.001)

    def test_the_hits_of_the_first_instants_are_heard_with_every_seed(self):
        for seed in range(1, 7):
            with self.subTest(seed):
                facts = self.run_world("senses/early.sdf", 1, "--seed", str(seed))
                audio = facts["contacts"]["by_modality"]["audio"]
                self.assertEqual((5, 5), (audio["expected"], audio["presented"]))

    def test_a_kicked_body_has_the_impulse_of_the_hand(self):
        for name, mass_kg, seconds in (("kickbox_ceramic", 0.1, 4), ("kick35", 0.127056437, 6)):
            with self.subTest(name):
                self.run_world(f"senses/{name}.sdf", seconds)
                with open(self.out / "haptic.csv", encoding="utf-8", newline="") as file:
                    rows = list(csv.DictReader(file))
                times = [float(row["host_s"]) for row in rows]
                for axis in "xyz":
                    hand_Ns = sum(float(row[f"force_{axis}_N"]) * (after - at) for row, at, after in zip(rows, times, times[1:]))
                    states = next(iter(self.states().values()))
                    body_Ns = mass_kg * (states[-1][f"velocity_m_s.{axis}"] - states[0][f"velocity_m_s.{axis}"])
                    self.assertAlmostEqual(-hand_Ns, body_Ns, delta=0.01 * max(abs(hand_Ns), 0.005), msg=axis)

    def test_late_touch_is_presented(self):
        facts = self.run_world("senses/press.sdf", 4, "--degrade", CASES / "senses" / "lh_300ms.xml")
        for name, sense in facts["contacts"]["by_modality"].items():
            self.assertEqual(sense["expected"], sense["presented"], name)
        self.assertGreater(facts["contacts"]["by_modality"]["haptic"]["expected"], 0)

    def test_trials_are_read_or_refused_with_file_and_line(self):
        analyse = lambda name, status=0: self.program(ROOT / "scripts" / "tactus", "study", "analyse", CASES / "separable_trials" / f"{name}.csv", "--out",
                                                      self.folder / name, "--json", self.folder / f"{name}.json", status=status)
        rows = {}
        for name in ("good", "blank_end", "step"):
            analyse(name)
            rows[name] = json.loads((self.folder / f"{name}.json").read_text(encoding="utf-8"))["psychometric"]
        self.assertEqual(rows["good"], rows["blank_end"])
        for row in rows["step"]:
            inside = row["low"] is None or row["low"] <= row["value"] <= row["high"]  # a share of chance has no interval
            self.assertTrue(inside or "too far apart" in row["why"], row)
        said = analyse("semicolon", 1).stderr
        self.assertEqual(1, len(said.strip().splitlines()), said)
        self.assertIn("semicolon.csv:1: ", said)


class LogOrder(unittest.TestCase):
    """Logs whose stamps jump, two runs in one file, and channels whose names are no identifiers."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.runs = []
        for seed in (1, 2):
            out = cls.folder / f"run{seed}"
            subprocess.run([ROOT / "scripts" / "run", CASES / "senses" / "early.sdf", "--virtual-time", "--seconds", "1", "--seed", str(seed), "--out", out],
                           capture_output=True, check=True, env={**os.environ, "TACTUS_BIN": str(BIN)})
            cls.runs.append(list(read_log(out / "run.lcmlog")))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def answers(self, name, events):
        """(description, summary) of a log."""
        log = self.folder / f"{name}.lcmlog"
        write_log(log, events)
        described = subprocess.run([BIN / "replay", log, "--describe"], capture_output=True, check=True).stdout
        subprocess.run([BIN / "summarise", log, "--out", self.folder / f"{name}.json"], capture_output=True, check=False)
        return json.loads(described), json.loads((self.folder / f"{name}.json").read_text(encoding="utf-8"))

    def test_each_log_is_described_and_summarised_as_the_original(self):
        a, b = self.runs
        middle, stamp = len(a) // 2, a[len(a) // 2][0]
        odd = [(stamp + i, name, bytes(range(8))) for i, name in enumerate((b"/robot/joint states", b'a,b"c', b"../../evil", "Übung".encode(), b"line\nbreak"))]
        swapped = list(a)
        for i in range(200, len(a) - 1, 7):
            swapped[i], swapped[i + 1] = swapped[i + 1], swapped[i]
        jumped = lambda by_us: [(t + (by_us if i >= middle else 0), c, d) for i, (t, c, d) in enumerate(a)]
        described, summary = self.answers("original", a)
        for name, events, runs, jumps in (("swapped", swapped, 1, 0), ("hole", jumped(3 * HOUR_US), 1, 1), ("back", jumped(-HOUR_US), 1, 1),
                                          ("odd_channels", a[:middle] + odd + a[middle:], 1, 0), ("two_runs", a + b, 2, 0)):
            with self.subTest(name):
                found, facts = self.answers(name, events)
                self.assertEqual(runs, len(found["runs"]))
                self.assertEqual(0, found["damaged_regions"])
                self.assertEqual(jumps, len(found["runs"][0]["clock_jumps_s"]))
                self.assertAlmostEqual(described["length_s"], found["length_s"], delta=0.002)
                if runs == 1:
                    self.assertEqual(summary["contacts"], facts["contacts"])


if __name__ == "__main__":
    unittest.main()
