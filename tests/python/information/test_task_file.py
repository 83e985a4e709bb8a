"""Tests of task files, of the changes of a scene, and of the features of sound, touch and pictures."""
import csv
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))

from tactus.information import noise, pictures, rendering, sound, task_file, touch  # noqa: E402
from tactus.refusal import Refusal  # noqa: E402

RATE = 48000
SCENE = """<sdf version="1.9" xmlns:tactus="https://tactus.dev/sdf"><world name="w">
<model name="a"><pose>0 0 0 0 0 0</pose><link name="l"><tactus:surface material="oak"/></link></model>
<model name="b"><pose>1 0 0 0 0 0</pose></model>
</world></sdf>
"""
TASK = """<task scene="scene.sdf" sense="audio" seconds="1s">
  <question>What is it?</question>
  <value name="oak"><set at="model[@name='a']/link/tactus:surface/@material" to="oak"/></value>
  <value name="steel"><set at="model[@name='a']/link/tactus:surface/@material" to="steel"/></value>
  <variant><set at="model[@name='b']/pose" to="2 0 0 0 0 0"/></variant>
  <variant><set at="model[@name='b']/pose" to="3 0 0 0 0 0"/></variant>
  <window from="0s" to="400ms"/>
</task>
"""


class TaskFiles(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "scene.sdf").write_text(SCENE, encoding="utf-8")

    def read(self, text):
        path = self.folder / "t.task.xml"
        path.write_text(text, encoding="utf-8")
        return task_file.read(str(path))

    def test_a_task_file_is_read_completely(self):
        task = self.read(TASK)
        self.assertEqual(("t", ("audio",), 1.0, "What is it?", ["oak", "steel"], 2, ((0.0, 0.4),)),
                         (task.name, task.senses, task.seconds, task.question, list(task.values), len(task.variants), task.windows))
        scene = task_file.changed_scene(task.scene, (*task.values["steel"], *task.variants[1])).decode()
        self.assertIn('material="steel"', scene)
        self.assertIn("<pose>3 0 0 0 0 0</pose>", scene)
        self.assertIn("<pose>0 0 0 0 0 0</pose>", scene)

    def test_a_wrong_task_file_is_refused_with_its_line(self):
        for old, new, line, reason in (('sense="audio"', 'sense="smell"', 1, "smell is not a sense; choose from visual, audio, haptic, thermal"),
                                       ('sense="audio"', 'sense=""', 1, "needs a sense"), ('seconds="1s"', 'seconds="1"', 1, 'seconds="1" is not a time'),
                                       ('seconds="1s"', 'seconds="601s"', 1, "0.1 s to 600 s"), ('scene="scene.sdf"', 'scene="none.sdf"', 1, "there is no scene none.sdf"),
                                       ('name="steel"', 'name="oak"', 4, "the value oak occurs twice"), (" to=\"steel\"", "", 4, "<set> needs the attribute to"),
                                       ("400ms", "5ms", 7, "shorter than 10 ms, which no sense perceives"), ("window", "look", 7, "<look> is not an element of <task>"), ("400ms", "1400ms", 7, "does not lie in the 1 s of the task"),
                                       ('<value name="steel">', '<value name="steel" size="3">', 4, "<value> has no attribute size"), ("</task>", "", 9, ""),
                                       ("<task", '<?xml version="1.0" encoding="ISO-8859-1"?><task', 1, "declares the encoding ISO-8859-1; save"), ("<task", "<!DOCTYPE task><task", 1, "DOCTYPE")):
            with self.subTest(new), self.assertRaises(Refusal) as caught:
                self.read(TASK.replace(old, new))
            self.assertIn(reason, str(caught.exception))
            self.assertRegex(str(caught.exception), rf"t\.task\.xml:{line}: ")
            self.assertNotIn("\n", str(caught.exception))

    def test_a_change_must_name_one_element(self):
        for at, reason in (("model/pose", "names 2 elements"), ("model[@name='c']/pose", "names 0 elements"), ("model[", "is not a path"), ("count(model)", "names no elements")):
            task = self.read(TASK.replace("model[@name='b']/pose\" to=\"2", f"{at}\" to=\"2"))
            with self.subTest(at), self.assertRaises(Refusal) as caught:
                task_file.changed_scene(task.scene, task.variants[0])
            self.assertIn(reason, str(caught.exception))
            self.assertIn("t.task.xml:5: ", str(caught.exception))

    def test_a_change_sets_attributes_by_their_names_only(self):
        at = lambda text: self.read(TASK.replace("model[@name='b']/pose\" to=\"2", f"{text}\" to=\"2"))
        task = at("model[@name='b']/@tactus:group")
        self.assertIn(b'tactus:group="2 0 0', task_file.changed_scene(task.scene, task.variants[0]))
        for name in ("a b", "1a", "other:x", "=x"):
            task = at(f"model[@name='b']/@{name}")
            with self.subTest(name), self.assertRaisesRegex(Refusal, "t.task.xml:5: .* is not the name of an attribute"):
                task_file.changed_scene(task.scene, task.variants[0])

    def test_a_task_for_vision_is_long_enough_for_a_look(self):
        text = TASK.replace('sense="audio"', 'sense="visual"')
        self.assertEqual(((0.0, 0.25),), self.read(text.replace("400ms", "250ms")).windows)
        with self.assertRaisesRegex(Refusal, "t.task.xml:1: all windows together are shorter than 250 ms, so no look"):
            self.read(text.replace("400ms", "249ms"))

    def test_a_scene_without_a_tool_is_refused_because_nothing_is_felt(self):
        path = self.folder / "haptic.csv"
        path.write_text("time_s,tool,host_s\n,0,1\n1,1,1\n", encoding="utf-8")
        with self.assertRaisesRegex(Refusal, "^the first tool has no row in haptic.csv"):
            touch.columns(path, "host_s")
    def test_a_scene_outside_the_folder_of_the_task_is_refused(self):
        (self.folder / "below").mkdir()
        (self.folder / "below" / "scene.sdf").write_text(SCENE, encoding="utf-8")
        self.assertEqual("scene.sdf", self.read(TASK.replace("scene.sdf", "below/scene.sdf")).scene.name)
        for name in ("/etc/passwd", "../scene.sdf", "below/../../scene.sdf"):
            with self.subTest(name), self.assertRaisesRegex(Refusal, "t.task.xml:1: the scene .* is outside the folder"):
                self.read(TASK.replace("scene.sdf", name))
        with self.assertRaisesRegex(Refusal, "there is no scene"):
            self.read(TASK.replace("scene.sdf", "x" * 5000))

    def test_a_hostile_scene_is_refused_with_one_sentence(self):
        task = self.read(TASK)
        for text, reason in ((b"<sdf/>", "has no <world>"), (b"<sdf", "scene.sdf:1: "), (b'<!DOCTYPE s [<!ENTITY a "' + b"a" * 1000 + b'">]><sdf>&a;</sdf>', "DOCTYPE"),
                             (b"<a>" * 1000, "depth"), (b"\xff\xfe<", "UTF-16"), (b"<sdf>" + b" " * task_file.LARGEST_SCENE_BYTES, "is longer than")):
            (self.folder / "scene.sdf").write_bytes(text)
            with self.subTest(text[:20]), self.assertRaises(Refusal) as caught:
                task_file.changed_scene(task.scene, ())
            self.assertIn(reason, str(caught.exception))
            self.assertNotIn("\n", str(caught.exception))

    def test_a_vibration_has_its_frequency_at_any_rate_of_touch(self):
        for rate in (500, 1000, 4000):
            wave = np.sin(2 * np.pi * 120 * np.arange(rate // 4) / rate)
            self.assertAlmostEqual(120, math.exp(touch.vibration_log(wave, 0.1, 1 / rate)), delta=3)

    def test_warnings_of_the_scene_are_found_in_the_output_of_a_run(self):
        self.assertTrue(rendering.WARNING.match('sim_node: /tmp/x/scene.sdf:6: /sdf/world[@name="w"]/wind is not supported and has no effect'))
        self.assertFalse(rendering.WARNING.match("sim_node: 1000 Hz, virtual time, a bus of this process"))

    def test_every_shipped_task_names_its_senses_and_changes_its_scene(self):
        self.assertGreaterEqual(len(task_file.shipped()), 6)
        needed = set()
        for name in task_file.shipped():
            task = task_file.read(name)
            needed |= set(task.senses)
            scenes = {task_file.changed_scene(task.scene, (*value, *variant)) for value in task.values.values() for variant in task.variants}
            self.assertEqual(len(task.values) * len(task.variants), len(scenes), name)
            self.assertTrue(task.question, name)
        self.assertEqual(set(task_file.SENSES), needed)


class Features(unittest.TestCase):
    def click(self, delay_samples, decay_s=0.02, frequency=1500.0, seconds=0.6, at=0.1):
        """Two channels: a decaying tone; the right ear hears it delay_samples later."""
        t = np.arange(int(seconds * RATE)) / RATE
        tone = lambda begin: np.where(t >= begin, np.exp(-(t - begin) / decay_s) * np.sin(2 * np.pi * frequency * (t - begin)), 0.0)
        return sound.Sound(0.5 * np.stack([tone(at), tone(at + delay_samples / RATE)], axis=1), RATE)

    def test_the_direction_of_a_sound_follows_from_the_times_at_both_ears(self):
        for azimuth in (-60, -20, 0, 10, 45, 80):
            a = math.radians(azimuth)
            heard = self.click(sound.HEAD_M / sound.SOUND_M_S * (a + math.sin(a)) * RATE, frequency=500.0)
            self.assertAlmostEqual(heard.azimuth_deg(heard.onsets()[0]), azimuth, delta=1.0, msg=azimuth)
            self.assertAlmostEqual(sound.azimuth_of_itd_deg(sound.HEAD_M / sound.SOUND_M_S * (a + math.sin(a))), azimuth, places=6)

    def test_the_decay_and_the_spectrum_of_a_sound_are_measured(self):
        for decay in (0.005, 0.02, 0.06):
            heard = self.click(0, decay)
            self.assertAlmostEqual(heard.decay_s(heard.onsets()[0]), decay * math.log(10), delta=0.15 * decay * math.log(10) + 0.002)  # 20 dB
        heard = self.click(0, frequency=3000.0)
        self.assertAlmostEqual(heard.centroid_Hz(heard.onsets()[0]), 3000, delta=150)
        self.assertAlmostEqual(self.click(0).level_dB(100) - 20 * math.log10(0.5 / 4), -3 + 10 * math.log10(0.01 / 0.1) + 20 * math.log10(4), delta=1.0)

    def test_onsets_are_found_and_silence_has_none(self):
        two = np.concatenate([self.click(0, seconds=0.3).channels, self.click(0, seconds=0.3).channels])
        self.assertEqual([100, 400], sound.Sound(two, RATE).onsets())
        self.assertEqual([], sound.Sound(np.zeros((RATE, 2)), RATE).onsets())
        shape = lambda features: [(name, len(values), wrong) for name, values, _, wrong in features]
        self.assertEqual(shape(sound.features(self.click(0))), shape(sound.features(sound.Sound(np.zeros((RATE, 2)), RATE))))

    def test_a_stiffness_is_the_slope_of_force_over_motion(self):
        along = -np.linspace(0, 0.01, 50)  # against the force
        self.assertAlmostEqual(touch.stiffness_log(-60 * along + 0.3, along), math.log(60), places=9)
        self.assertEqual(0.0, touch.stiffness_log(np.ones(5), np.linspace(0, 1e-4, 5)))

    def warmth(self, commanded_degC, late_s=0.0):
        """Warmth of a display with this temperature at each time of the world, s, which is sent late_s later. The host is 1000 s ahead of the world."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "thermal.csv"
            rows = [f"{i * 0.01:.2f},{1000 + i * 0.01 + late_s:.6f},0,0,33,{commanded_degC(i * 0.01):.9f}" for i in range(400)]
            path.write_text("\n".join(["time_s,host_s,tool,material,skin_degC,commanded_degC", *rows]) + "\n", encoding="utf-8")
            return touch.Warmth(path, 1000e9)

    def test_warmth_is_the_temperature_that_the_display_presents_and_not_that_of_the_model(self):
        floor = noise.values()["heat_floor"]
        ramp = lambda slope: lambda t: 33 + slope * max(0.0, t - 1)
        for slope in (-2.0, 0.5):
            found = {name: values for name, values, _, _ in self.warmth(ramp(slope)).features(0, 3)}
            self.assertEqual(([1.0], [math.copysign(1.0, slope)]), (found["felt"], found["sign"]))
            self.assertAlmostEqual(math.log(abs(slope)), found["flow"][0], delta=0.12)  # the change before its detection counts, too
        self.assertEqual([0.0], self.warmth(ramp(0.4 * floor)).features(0, 3)[0][1])

    def test_warmth_that_is_sent_late_is_felt_late(self):
        step = lambda t: 33 - (2.0 if t >= 1 else 0.0)
        felt = lambda late_s, *window: self.warmth(step, late_s).features(*window)[0][1][0]
        self.assertEqual((1, 0), (felt(0, 0.5, 1.5), felt(0, 1.5, 2.5)))
        self.assertEqual((0, 1), (felt(0.8, 0.5, 1.5), felt(0.8, 1.5, 2.5)))

    def test_the_noise_of_pictures_makes_four_bright_pixels_just_noticeable(self):
        dark, bright = np.zeros((1, 48, 64, 3), np.uint8), np.zeros((1, 48, 64, 3), np.uint8)
        bright[0, 10:12, 10:12] = 255
        for width, d in ((640, 1.0), (320, 2.0)):  # a pixel of half as many covers four times the area
            at = pictures.coordinates([dark, bright, bright], width)
            self.assertAlmostEqual(float(np.linalg.norm(at[0] - at[1])), d, places=9)
            self.assertAlmostEqual(float(np.linalg.norm(at[1] - at[2])), 0.0, places=6)
        self.assertEqual([[0.0], [0.0]], pictures.coordinates([dark, dark], 640).tolist())

    def test_a_weber_fraction_gives_75_percent_right_answers_between_two_intervals(self):
        d = noise.values()["heat_flow"] / noise.weber_sd(noise.values()["heat_flow"])
        self.assertAlmostEqual(0.5 * (1 + math.erf(d / 2)), 0.75, places=9)
        self.assertAlmostEqual(noise.weber_sd(0.43), 0.451, places=3)
        self.assertAlmostEqual(1 - noise.confusion(0.9, 3) * 2 / 3, 0.9, places=12)


class Noise(unittest.TestCase):
    def test_the_noise_is_that_of_the_median_simulated_player(self):
        program = pathlib.Path(os.environ.get("TACTUS_BIN") or pathlib.Path(__file__).resolve().parents[3] / "build" / "dev" / "bin") / "observer_players"
        if not program.exists():
            self.skipTest("observer_players is not built")
        rows = csv.reader(subprocess.run([program, "properties"], capture_output=True, text=True, check=True).stdout.splitlines())
        median = {row[1]: float(row[-4]) for row in list(rows)[1:]}
        for name, of in (("azimuth", "azimuth noise"), ("force", "force Weber"), ("force_floor", "force floor"), ("force_direction", "force direction noise"),
                         ("stiffness", "stiffness Weber"), ("heat_flow", "thermal Weber"), ("place", "proprioceptive noise"), ("lapse", "lapse")):
            self.assertEqual(median[of], noise.values()[name], name)


if __name__ == "__main__":
    unittest.main()
