"""Tests of touch with the whole chain of simulation and haptic node in virtual time: reaction of a kicked body, and walls under delay."""
import csv
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
BIN = pathlib.Path(os.environ.get("TACTUS_BIN") or ROOT / "build" / "dev" / "bin")
MASS_KG = 0.1
TOOL = """<tactus:tool name="hand" {tool} mass="0.1kg" material="{material}" device="virtual_hand" loop="false">{path}</tactus:tool>"""
WORLD = """<?xml version="1.0"?><sdf version="1.9" xmlns:tactus="https://tactus.dev/sdf"><world name="w"><gravity>0 0 0</gravity>
<model name="b">{static}<link name="l">{pose}<inertial><mass>0.1</mass></inertial><tactus:surface material="{surface}"/>
<collision name="c"><geometry><box><size>{size}</size></box></geometry></collision></link></model>{tool}</world></sdf>"""


def waypoints(points):
    return "".join(f'<tactus:waypoint time="{time}s" position="{place}"/>' for time, place in points)


# A box in the hand kicks a free box of ceramic, whose hit transient is hard.
KICK = WORLD.format(static="", pose="", surface="ceramic", size=".06 .06 .06", tool=TOOL.format(
    tool='shape="box" size="40mm 30mm 20mm"', material="skin",
    path=waypoints([(0, "-0.08 0 0"), (1.3, "-0.08 0 0"), (1.9, "-0.045 0 0"), (3, "-0.08 0 0"), (60, "-0.08 0 0")])))
# A ball presses 13 mm into a board for a second, twice.
PRESS = WORLD.format(static="<static>true</static>", pose="<pose>0 0 -0.05 0 0 0</pose>", surface="oak", size=".3 .3 .1", tool=TOOL.format(
    tool='radius="8mm"', material="rubber",
    path=waypoints([(0, "0 0 0.04"), (0.5, "0 0 0.04"), (0.75, "0 0 -0.005"), (1.75, "0 0 -0.005"), (2, "0 0 0.04"), (2.25, "0 0 -0.005"),
                    (3.25, "0 0 -0.005"), (3.5, "0 0 0.04"), (60, "0 0 0.04")])))


class VirtualTouch(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def run_scene(self, scene, *words, seconds=4):
        """Runs a scene of this text; returns the columns of haptic.csv as lists of numbers."""
        path, self.out = self.folder / "scene.sdf", self.folder / f"out{len(os.listdir(self.folder))}"
        path.write_text(scene, encoding="utf-8")
        without = [word for node in ("audio_node", "visual_node", "thermal_node") for word in ("--without", node)]
        done = subprocess.run([str(ROOT / "scripts" / "run"), str(path), "--virtual-time", "--seconds", str(seconds), "--out", str(self.out), *without,
                               *words], capture_output=True, text=True, check=False)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        with open(self.out / "haptic.csv", encoding="utf-8", newline="") as file:
            rows = [row for row in csv.DictReader(file)]
        return {name: [float(row[name] or "nan") for row in rows] for name in rows[0] if name != "touch_status"}

    def body_speed(self):
        """Velocity of the only body at the end of the run, along x, m/s."""
        tables = self.folder / "tables"
        tables.mkdir(exist_ok=True)
        subprocess.run([BIN / "export_log", self.out, "--out", tables, "--channels", "WORLD_STATE"], check=True, capture_output=True)
        with open(tables / "WORLD_STATE.csv", encoding="utf-8", newline="") as file:
            return [float(row["value"]) for row in csv.DictReader(file) if row["field"] == "bodies[0].velocity_m_s.x"][-1]

    def test_a_kicked_body_receives_the_impulse_of_the_hand_with_and_without_transients_at_any_slew_limit(self):
        for setting in ("transient_gain=1", "transient_gain=0", "transient_gain=10", "slew_limit=500", "slew_limit=100", "slew_limit=30"):
            touch = self.run_scene(KICK, "--set", "haptic_node." + setting)
            time, force = touch["host_s"], touch["force_x_N"]
            hand = sum(f * (time[i + 1] - time[i]) for i, f in enumerate(force[:-1]))
            body = MASS_KG * self.body_speed()
            self.assertGreater(body, 0.005, setting)
            self.assertLess(abs(body + hand), 0.01 * body, setting)

    def profile(self, rule):
        path = self.folder / "stage.xml"
        path.write_text(f'<profile name="stage"><degrade modality="haptic" {rule}/></profile>', encoding="utf-8")
        return path

    def degraded(self, scene, rule, seconds=4):
        """haptic.csv of a scene under one rule for touch, and the velocity of its body."""
        return self.run_scene(scene, "--degrade", str(self.profile(rule)), seconds=seconds), self.body_speed()

    def test_percept_operators_and_neutral_operators_of_all_stages_change_nothing_to_the_bit(self):
        self.run_scene(KICK)
        clear = (self.out / "haptic.csv").read_bytes(), self.body_speed()
        for rule in ('stage="percept" off="true"', 'stage="percept" delay="0.5s" gain="-3"', 'stage="force" delay="0"', 'stage="action" delay="0"',
                     'stage="force" gain="1"'):
            self.degraded(KICK, rule)
            self.assertEqual(clear, ((self.out / "haptic.csv").read_bytes(), self.body_speed()), rule)

    def test_a_push_without_felt_force_moves_the_body_and_a_late_hand_moves_it_later(self):
        clear = self.run_scene(KICK), self.body_speed()
        off = self.degraded(KICK, 'stage="force" off="true"')
        self.assertGreater(off[1], 0.8 * clear[1])
        self.assertEqual({0.0}, set(off[0]["force_x_N"]))
        self.assertGreater(max(abs(f) for f in clear[0]["force_x_N"]), 0.1)
        late = self.degraded(KICK, 'stage="action" delay="80ms"')
        self.assertGreater(late[1], 0.005)
        gone = self.degraded(KICK, 'stage="action" off="true"')
        self.assertEqual(0, gone[1])

    def test_the_energy_of_a_late_force_on_a_board_is_reported_and_bounded(self):
        free = 10 / 2 - 2000 * 0.0005 / 0.8  # damping of the device that the coupling does not need, N s/m: haptic_node/safety/injected_energy.cpp
        for delay_ms in (15, 36, 72, 150):
            touch = self.run_scene(PRESS, "--degrade", str(self.profile(f'stage="force" delay="{delay_ms}ms"')))
            z, time = touch["device_z_m"], touch["host_s"]
            moved = sum((z[i + 1] - z[i]) ** 2 / (time[i + 1] - time[i]) for i in range(len(z) - 1))
            self.assertLess(max(touch["injected_J"]), 0.0005 + free * moved, delay_ms)
            self.assertLess(max(abs(f) for f in touch["force_z_N"]), 8.0001, delay_ms)
            self.assertLess(max(touch["generated_J"]), 0.001, delay_ms)

    def test_a_board_is_as_stiff_with_a_late_touch_model_as_with_a_fresh_one(self):
        fresh = None
        for how in ("fresh", 'delay="10ms"', 'delay="50ms"', 'delay="100ms"', 'delay="200ms"', 'delay="200ms network"', 'rate="5Hz"', "latency"):
            words = ["--set", "haptic_node.transient_gain=0"]
            if "=" in how:
                profile = self.folder / "late.xml"
                profile.write_text(f'<profile name="late"><degrade modality="haptic" {how}/></profile>', encoding="utf-8")
                words += ["--degrade", str(profile)]
            touch = self.run_scene(PRESS, *words, *(["--latency-ms", "100"] if how == "latency" else []), seconds=5)
            held = []
            start = next(time for time, z in zip(touch["host_s"], touch["device_z_m"]) if z < 0.0399)  # 0.5 s after the path began
            for begin, end in ((0.9, 1.1), (2.4, 2.6)):
                at = [i for i, time in enumerate(touch["host_s"]) if begin < time - start < end]
                held.append((sum(touch["force_z_N"][i] for i in at) / len(at), sum(0.008 - touch["device_z_m"][i] for i in at) / len(at)))
            fresh = fresh or held
            for one, same in zip(held, fresh):
                self.assertAlmostEqual(one[0], same[0], delta=0.02 * same[0], msg=how)  # force, N
                self.assertAlmostEqual(one[1], same[1], delta=0.02 * same[1], msg=how)  # depth, m
            self.assertLess(max(touch["generated_J"]), 0.001, how)
            self.assertLess(touch["energy_J"][-1], 0, how)


if __name__ == "__main__":
    unittest.main()
