"""Tests of rerender: differences of synthetic renderings, and refusals."""
import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.paths import tactus_command
from tactus.rerender import changed, colour, compare, main as rerender, read, render

MS = 1_000_000


def row(event, at, outcome="presented", part="whole"):
    return {"event_id": str(event), "part": part, "presented_ns": str(at), "outcome": outcome}


class Events(unittest.TestCase):
    reference = compare.times_of([row(n, n * 100 * MS) for n in range(100)])

    def test_later_events_are_reported_with_their_shift_and_missing_ones_with_their_count(self):
        other = compare.times_of([row(n, n * 100 * MS + 40 * MS) for n in range(90)]
                                 + [row(n, -1, "dropped_by_profile") for n in range(90, 100)] + [row(200, 5)])
        found = compare.events(self.reference, other)
        self.assertEqual((91, 10, 1), (found["presented"], found["dropped"], found["added"]))
        self.assertAlmostEqual(40, found["shift_p50_ms"])
        self.assertAlmostEqual(40, found["shift_p99_ms"])

    def test_a_rendering_does_not_differ_from_itself(self):
        found = compare.events(self.reference, self.reference)
        self.assertEqual({"presented": 100, "dropped": 0, "added": 0, "shift_p50_ms": 0.0, "shift_p99_ms": 0.0}, found)

    def test_each_part_of_an_event_counts_once_at_its_first_report(self):
        times = compare.times_of([row(1, 10, part="transient"), row(1, 12, part="constraint"), row(1, 99, part="transient"),
                                  row(2, 7, "inaudible")])
        self.assertEqual({("1", "transient"): 10, ("1", "constraint"): 12}, times)

    def test_without_common_events_there_is_no_shift(self):
        self.assertIsNone(compare.events(self.reference, {})["shift_p50_ms"])


class Force(unittest.TestCase):
    def test_differences_above_the_weber_fraction_are_counted(self):
        reference = np.zeros((100, 3))
        reference[:50, 2] = 2.0
        other = reference.copy()
        other[:10, 2] = 2.15  # 7.5 %
        other[10:20, 0] = 0.3  # sideways: 15 %
        found = compare.force(reference, other)
        self.assertEqual(50, found["with_force"])
        self.assertAlmostEqual(0.4, found["beyond_7_percent"])
        self.assertAlmostEqual(0.2, found["beyond_10_percent"])
        self.assertAlmostEqual(0.3, found["difference_peak_N"])
        self.assertAlmostEqual(np.sqrt((10 * 0.15**2 + 10 * 0.3**2) / 100), found["difference_rms_N"])

    def test_below_half_a_newton_the_tolerance_is_constant(self):
        reference, other = np.full((4, 3), [0, 0, 0.1]), np.full((4, 3), [0, 0, 0.13])
        self.assertEqual(0, compare.force(reference, other)["beyond_7_percent"])
        other[:, 2] = 0.1 + 0.036
        self.assertEqual(1, compare.force(reference, other)["beyond_7_percent"])

    def test_without_force_no_difference_is_counted(self):
        found = compare.force(np.zeros((5, 3)), np.full((5, 3), 1e-9))
        self.assertEqual((0, 0.0), (found["with_force"], found["beyond_7_percent"]))


class Pictures(unittest.TestCase):
    def test_colour_differences_agree_with_sharma_wu_and_dalal(self):
        # Table 1 of their paper: pairs 1, 4, 7, 10, 14, 17, 20, 25, 28, 34.
        pairs = [((50, 2.6772, -79.7751), (50, 0, -82.7485), 2.0425), ((50, -1.3802, -84.2814), (50, 0, -82.7485), 1.0000),
                 ((50, 0, 0), (50, -1, 2), 2.3669), ((50, 2.49, -0.001), (50, -2.49, 0.0010), 7.1792),
                 ((50, -0.001, 2.49), (50, 0.0011, -2.49), 4.7461), ((50, 2.5, 0), (73, 25, -18), 27.1492),
                 ((50, 2.5, 0), (58, 24, 15), 19.4535), ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
                 ((35.0831, -44.1164, 3.7933), (35.0232, -40.0716, 1.5901), 1.8645), ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082)]
        one, two, truth = (np.array([p[i] for p in pairs], dtype=float) for i in range(3))
        np.testing.assert_allclose(colour.ciede2000(one, two), truth, atol=5e-5)
        np.testing.assert_allclose(colour.ciede2000(two, one), truth, atol=5e-5)

    def test_white_black_and_red_agree_with_the_standard(self):
        lab = colour.lab_of(np.array([[255, 255, 255], [0, 0, 0], [255, 0, 0]], dtype=np.uint8))
        np.testing.assert_allclose(lab, [[100, 0, 0], [0, 0, 0], [53.24, 80.09, 67.20]], atol=0.05)

    def test_frames_of_only_one_rendering_count_as_different(self):
        self.assertEqual([1, 3, 4], compare.frames(["a", "b", "c"], ["a", "x", "c", "d", "e"]))
        self.assertEqual([], compare.frames(["a", "b"], ["a", "b"]))


class Sounds(unittest.TestCase):
    def test_half_the_amplitude_is_six_decibels_and_every_sample_differs(self):
        wave = np.sin(np.arange(1, 1000))
        found = compare.sound(wave, wave / 2)
        self.assertAlmostEqual(-6.02, found["level_dB"], places=2)
        self.assertEqual(1.0, found["samples_differ"])
        self.assertEqual({"level_dB": 0.0, "difference_peak": 0.0, "samples_differ": 0.0}, compare.sound(wave, wave))


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, *names):
        os.makedirs(os.path.join(self.folder.name, *names[:-1]), exist_ok=True)
        return os.path.join(self.folder.name, *names)

    def write_haptic(self, name, forces):
        with open(self.path(name, "haptic.csv"), "w", encoding="utf-8", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(["host_s", "tool", "force_x_N", "force_y_N", "force_z_N", "seq"])
            rows.writerows([f"55797.{n:09d}", 0, 0, 0, force, n] for n, force in forces.items())
        with open(self.path(name, "presented_haptic.csv"), "w", encoding="utf-8", newline="") as file:
            file.write("modality,event_id,part,scheduled_ns,presented_ns,uncertainty_ns,outcome\n")

    def test_ticks_of_the_same_time_are_compared(self):
        self.write_haptic("one", {n: 1.0 for n in range(10)})
        self.write_haptic("two", {n: 1.0 + 0.5 * (n == 7) for n in range(2, 12)})
        found = changed.changed("haptic", self.path("one", ""), self.path("two", ""))
        self.assertEqual(8, found["ticks"])
        self.assertAlmostEqual(0.5, found["difference_peak_N"])

    def test_files_that_differ_in_one_digit_are_different(self):
        self.write_haptic("one", {0: 1.0, 1: 2.0})
        self.write_haptic("two", {0: 1.0, 1: 2.0})
        self.assertEqual([], changed.same_bytes("haptic", self.path("one", ""), self.path("two", ""))["differ"])
        self.write_haptic("two", {0: 1.0, 1: 2.000000001})
        self.assertEqual(["haptic.csv"], changed.same_bytes("haptic", self.path("one", ""), self.path("two", ""))["differ"])

    def test_seconds_are_read_to_the_nanosecond(self):
        self.assertEqual(55797080447968123, read.nanoseconds("55797080.447968123"))
        self.assertEqual(5_100_000_000, read.nanoseconds("5.1"))

    def test_profiles_of_the_same_name_have_separate_folders(self):
        for folder in ("a", "b"):
            open(self.path(folder, "late.xml"), "w", encoding="utf-8").close()
        files = [self.path("a", "late.xml"), self.path("b", "late.xml"), "logged"]
        self.assertEqual({"late": files[0], "late_2": files[1], "logged": "logged"}, rerender.profile_names(files, self.fail))

    def refusal(self, *words):
        done = subprocess.run([*tactus_command("rerender"), *words], capture_output=True, text=True, check=False)
        self.assertEqual(1, done.returncode, done.stderr)
        self.assertEqual(1, done.stderr.count("\n"), done.stderr)
        return done.stderr

    def test_each_invalid_argument_is_refused_with_one_sentence(self):
        log = self.path("run.lcmlog")
        open(log, "w", encoding="utf-8").close()
        self.assertIn("is neither a log nor the folder of a run", self.refusal(self.path("none.lcmlog")))
        self.assertIn("not empty", self.refusal(log, "--out", self.folder.name))
        self.assertIn("is not a file", self.refusal(log, "--degrade", self.path("none.xml")))
        self.assertIn("SENSE:NAME=VALUE", self.refusal(log, "--set", "smell:rose=1"))

    def test_a_refusal_of_a_node_is_quoted_and_a_rendering_reports_its_speed(self):
        with self.assertRaisesRegex(render.Refused, "no scene"):
            render.render(["sh", "-c", "echo 'a: 5 % of the log' >&2; echo 'a: no scene' >&2; exit 1"], lambda _: None)
        shares = []
        said = render.render(["sh", "-c", "echo 'a: 5 % of the log' >&2; echo 'a: x.wav: 3 s of sound; its first sample was out at 41 ns,"
                              " in 0.5 s (6 times as fast as real time)' >&2"], shares.append)
        self.assertEqual([5], shares)
        self.assertEqual({"took_s": 0.5, "times_as_fast_as_time": 6.0, "first_sample_ns": 41}, render.facts(said))


if __name__ == "__main__":
    unittest.main()
