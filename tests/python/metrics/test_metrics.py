"""Tests of the metrics: values that were computed with another program, bounds for random signals, and runs whose metrics are known."""
import csv
import lzma
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus import tables
from tactus.metrics import age, codec, compare, curves, of_run, rank, ranking
from tactus.refusal import Refusal

T = np.arange(1000) * 1e-3
SWELL = 1 + 0.5 * np.sin(2 * np.pi * T)


class Codec(unittest.TestCase):
    def test_the_samples_that_leave_the_band_are_sent(self):
        x = [1, 1.05, 1.09, 1.101, 1.15, 1.2, 1.22, 1.0, .95, .89]
        _, sent = codec.transmit(x, np.arange(10), 0.1)
        self.assertEqual(np.flatnonzero(sent).tolist(), [0, 3, 6, 7, 9])

    def test_a_ramp_from_1_to_2_needs_one_packet_for_each_step_of_k(self):
        ramp = np.linspace(1, 2, 200_001)
        for k, packets in ((0.05, 15), (0.1, 8), (0.2, 4)):
            self.assertEqual(codec.transmit(ramp, np.arange(len(ramp)) * 1e-3, k)[1].sum(), packets)

    def test_packets_and_errors_of_a_swelling_force(self):
        for k, hold, hold_rmse, relative, linear, linear_rmse in ((.02, 101, .011350, .019994, 26, .010308), (.05, 42, .028054, .049989, 17, .026299),
                                                                  (.10, 22, .054168, .099931, 12, .053448), (.20, 9, .103599, .199712, 9, .114995)):
            with self.subTest(k=k):
                shown, sent = codec.transmit(SWELL, T, k)
                self.assertEqual(sent.sum(), hold)
                self.assertAlmostEqual(compare.rmse(SWELL, shown), hold_rmse, delta=1e-6)
                self.assertAlmostEqual(np.max(np.abs(shown - SWELL) / np.abs(shown)), relative, delta=1e-6)
                shown, sent = codec.transmit(SWELL, T, k, "linear")
                self.assertEqual(sent.sum(), linear)
                self.assertAlmostEqual(compare.rmse(SWELL, shown), linear_rmse, delta=1e-6)

    def test_the_error_of_random_forces_is_at_most_k_of_the_received_one(self):
        random = np.random.default_rng(3)
        for _ in range(30):
            x = np.cumsum(random.normal(0, 0.03, (800, 3)), axis=0) + random.normal(0, 1, 3)
            k, floor = random.uniform(0, 0.4), random.choice([0.0, 0.02])
            for predictor in codec.PREDICTORS:
                shown, sent = codec.transmit(x, np.arange(800) * 1e-3, k, predictor, floor)
                apart, size = np.linalg.norm(shown - x, axis=1), np.linalg.norm(shown, axis=1)
                self.assertTrue(np.all(apart <= np.maximum(k * size, floor) + 1e-9))
                self.assertTrue(sent[0])

    def test_a_band_of_0_sends_all_that_changes(self):
        shown, sent = codec.transmit(SWELL, T, 0)
        self.assertTrue(np.array_equal(shown, SWELL) and sent.sum() >= 998)

    def test_an_unknown_predictor_is_refused(self):
        with self.assertRaisesRegex(ValueError, "choose from hold, linear"):
            codec.transmit(SWELL, T, 0.1, "cubic")


class Etvo(unittest.TestCase):
    def test_errors_of_time_and_value_apart(self):
        t = np.arange(400) / 200
        x = np.sin(2 * np.pi * t) + 0.3 * np.sin(2 * np.pi * 2.3 * t)
        for samples, gain, time_ms, median_ms, value, plain in ((0, 1, 0, 0, 0, 0), (10, 1, 50, 50, 0, .25912), (10, 1.1, 49.612, 50, .03080, .28121),
                                                                (20, 1, 100, 100, 0, .49886)):
            with self.subTest(samples=samples, gain=gain):
                y = gain * np.concatenate([np.full(samples, x[0]), x[:400 - samples]])
                found = compare.etvo_like(x, y, 200)
                self.assertAlmostEqual(found["time_ms"], time_ms, delta=5e-4)
                self.assertAlmostEqual(found["time_median_ms"], median_ms, delta=1e-9)
                self.assertAlmostEqual(found["value"], value, delta=5e-6)
                self.assertAlmostEqual(compare.rmse(x, y), plain, delta=5e-6)

    def test_a_delay_that_changes_is_a_variation_of_time(self):
        t = np.arange(1200) / 200
        x = np.sin(2 * np.pi * t) + 0.5 * np.sin(2 * np.pi * 3.1 * t)
        late = np.interp(t - 0.05 - 0.04 * np.sin(2 * np.pi * 0.3 * t), t, x)
        found = compare.etvo_like(x, late, 200)
        self.assertAlmostEqual(found["time_ms"], 50, delta=10)
        self.assertGreater(found["time_variation"], 0.03)
        self.assertLess(found["value"], 0.3 * compare.rmse(x, late))

    def test_short_signals(self):
        self.assertEqual(compare.etvo_like([], [], 200)["value"], 0)
        self.assertEqual(compare.etvo_like([1.0], [1.5], 200)["value"], 0.5)


class Similarity(unittest.TestCase):
    def test_hssim_of_a_deadband(self):
        for k, log, power in ((.02, .98603, .98470), (.05, .93889, .93154), (.1, .82655, .81449), (.2, .63398, .62313)):
            shown, _ = codec.transmit(SWELL, T, k)
            self.assertAlmostEqual(compare.hssim_like(SWELL, shown), log, delta=5.1e-6)
            self.assertAlmostEqual(compare.hssim_like(SWELL, shown, "power"), power, delta=5.1e-6)
        self.assertAlmostEqual(compare.hssim_like(SWELL, SWELL), 1, delta=1e-9)
        self.assertAlmostEqual(compare.hssim_like(SWELL, np.roll(SWELL, 20)), .98249, delta=5.1e-6)

    def test_the_tube_of_a_deadband_of_20_percent(self):
        shown, _ = codec.transmit(SWELL, T, 0.2)
        for fraction, share in ((.05, .637), (.10, .436), (.15, .210)):
            self.assertAlmostEqual(compare.jnd_tube(SWELL, shown, fraction), share, delta=5e-4)
        self.assertEqual(compare.jnd_tube([0.0, 1.0], [0.04, 1.0], 0.1, floor=0.5), 0)

    def test_pictures(self):
        random = np.random.default_rng(1)
        picture = random.integers(0, 255, (40, 60))
        self.assertAlmostEqual(compare.ssim_picture(picture, picture), 1, delta=1e-9)
        noise = [compare.ssim_picture(picture, np.clip(picture + random.normal(0, sd, picture.shape), 0, 255)) for sd in (5, 20, 60)]
        self.assertTrue(1 > noise[0] > noise[1] > noise[2] > 0)
        self.assertLess(compare.ssim_picture(picture, 255 - picture), 0)


class Age(unittest.TestCase):
    def test_the_age_of_periodic_updates_with_losses(self):
        self.assertAlmostEqual(age.expected_s(0.02, 10, 0.5), 0.170)
        self.assertAlmostEqual(age.expected_s(0.02, 60, 0.6), 0.0333 + 0.02, delta=5e-5)
        self.assertEqual(age.expected_s(0.04), 0.04)
        with self.assertRaises(ValueError):
            age.expected_s(0, 60, 1)

    def test_the_measured_age_is_the_expected_one(self):
        random = np.random.default_rng(5)
        for rate, loss, delay in ((60, 0.3, 0.02), (10, 0.5, 0.1), (1000, 0, 0.005)):
            made = np.arange(20_000) / rate
            kept = made[random.random(len(made)) >= loss]
            self.assertAlmostEqual(age.measured_s(kept, kept + delay), age.expected_s(delay, rate, loss), delta=0.03 * age.expected_s(delay, rate, loss))

    def test_an_older_update_that_arrives_later_does_not_count(self):
        self.assertAlmostEqual(age.measured_s([0, 1, 0.5], [1, 2, 2.5], 3), age.measured_s([0, 1], [1, 2], 3))
        self.assertIsNone(age.measured_s([0], [1]))


class Runs(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def run_folder(self, name, delay_s=0.0, gain=1.0, injected_J=0.0):
        folder = self.folder / name
        folder.mkdir()
        with open(folder / "haptic.csv", "w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(["time_s", "tool", "force_x_N", "force_y_N", "force_z_N", "injected_J", "generated_J"])
            for i in range(4000):
                t = max(0.0, i * 1e-3 - delay_s)
                table.writerow([f"{i * 1e-3:.4f}", 0, 0, 0, gain * (1 + 0.5 * np.sin(2 * np.pi * t) + 0.3 * np.sin(2 * np.pi * 2.3 * t)), injected_J, 0.001])
        with open(folder / "presented.csv", "w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(["event_id", "modality", "part", "outcome", "presented_ns"])
            for event in range(5):
                at = event * 1_000_000_000
                table.writerows([[event, "audio", "onset", "presented", at], [event, "visual", "onset", "late", at + 30_000_000],
                                 [event, "haptic", "transient", "presented", at + 1_000_000], [event, "haptic", "constraint", "presented", at - 900_000_000],
                                 [event, "thermal", "onset", "dropped", -1]])
        return str(folder)

    def test_a_late_force_has_an_error_of_time_and_none_of_value(self):
        reference = self.run_folder("reference")
        found = of_run.metrics(self.run_folder("late", 0.1, injected_J=0.0004), reference)
        self.assertAlmostEqual(found["force_time_ms"], 100, delta=3)
        self.assertLess(found["force_value_N"], 0.05 * found["force_rmse_N"])
        self.assertAlmostEqual(found["onset_soa_ms"], 30)
        self.assertEqual((found["injected_J"], found["generated_J"]), (0.0004, 0.001))
        self.assertGreater(found["force_jnd_share"], 0.5)
        weak = of_run.metrics(self.run_folder("weak", gain=0.8), reference)
        self.assertGreater(weak["force_value_N"], 0.1)
        self.assertLess(weak["force_hssim_like"], 1)

    def test_a_run_equals_itself(self):
        reference = self.run_folder("reference")
        found = of_run.metrics(reference, reference)
        self.assertEqual((found["force_jnd_share"], found["force_time_ms"], found["force_rmse_N"]), (0, 0, 0))

    def test_without_a_reference_only_its_own_metrics_are_given_in_order(self):
        found = of_run.metrics(self.run_folder("one"))
        self.assertEqual(list(found), ["onset_soa_ms", "injected_J", "generated_J"])

    def test_the_packets_of_a_deadband_are_those_of_its_own_stage(self):
        class Decisions:
            def messages(self, _):
                decision = lambda i, ms, why: {f"decisions[{i}].is_event": "0", f"decisions[{i}].drop_reason": str(why), f"decisions[{i}].time_ns": str(ms * 1_000_000)}
                for ms in range(0, 1001):  # the stage model sends all updates, the stage force one in ten
                    yield {"sender": "haptic_node", "modality": "haptic", "count": "1", **decision(0, ms, 0)}
                    yield {"sender": "haptic_node", "modality": "haptic:force", "count": "1", **decision(0, ms, 0 if ms % 10 == 0 else 2)}
        self.assertAlmostEqual(101.0, of_run.sent_per_s(Decisions()))

    def test_every_metric_has_unit_and_meaning(self):
        for unit, meaning, _ in of_run.MEANING.values():
            self.assertTrue(unit and meaning)


class OtherTables(unittest.TestCase):
    """Tables of other programs, damaged ones, and runs that cannot be compared."""
    HEAD = "tool,time_s,force_x_N,force_y_N,force_z_N"
    ROWS = [f"0,{i * 1e-3:.3f},0,0,{1 + 0.5 * np.sin(i / 50):.6f}" for i in range(500)]

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.good = self.written("good")

    def written(self, name, rows=None, head=None, encoding="utf-8", end="\n", presented=None):
        folder = self.folder / name
        folder.mkdir()
        (folder / "haptic.csv").write_bytes(end.join([self.HEAD if head is None else head, *(self.ROWS if rows is None else rows), ""]).encode(encoding))
        if presented is not None:
            (folder / "presented.csv").write_text(presented, encoding="utf-8")
        return str(folder)

    def test_marks_and_line_ends_do_not_change_the_metrics(self):
        for name, how in (("mark", {"encoding": "utf-8-sig"}), ("crlf", {"end": "\r\n"})):
            found = of_run.metrics(self.written(name, **how), self.good)
            self.assertEqual(0, found["force_rmse_N"])
            self.assertAlmostEqual(1, found["force_hssim_like"])

    def test_a_table_that_cannot_be_used_is_refused_with_file_and_line(self):
        damaged = lambda row: [*self.ROWS[:100], row, *self.ROWS[101:]]
        head = "event_id,modality,part,outcome,presented_ns\n"
        for name, how, said in (("utf16", {"encoding": "utf-16"}, "haptic.csv:1: is UTF-16"), ("empty", {"rows": [], "head": ""}, "haptic.csv:1: has no column tool"),
                                ("other", {"head": "tool,t,x,y,z"}, "haptic.csv:1: has no column time_s"), ("nan", {"rows": damaged("0,0.1,nan,0,0")}, "haptic.csv:102: force_x_N is nan"),
                                ("inf", {"rows": damaged("0,0.1,0,inf,0")}, "haptic.csv:102: force_y_N is inf"), ("huge", {"rows": damaged("0,0.1,0,0,1e300")}, "haptic.csv:102: force_z_N is 1e300"),
                                ("word", {"rows": damaged("0,soon,0,0,0")}, "haptic.csv:102: time_s is 'soon'"), ("cut", {"rows": damaged("0,0.1")}, "haptic.csv:102: has 2 fields"),
                                ("semicolons", {"rows": [row.replace(",", ";") for row in self.ROWS], "head": self.HEAD.replace(",", ";")}, "haptic.csv:1: .*semicolons"),
                                ("late", {"presented": head + "1,audio,onset,presented,soon\n"}, "presented.csv:2: presented_ns is 'soon'"),
                                ("no_ns", {"presented": "a,b\n1,2\n"}, "presented.csv:1: has no column event_id"), ("long", {"rows": ["0,0,0,0,1", "0,1e9,0,0,1"]}, None)):
            with self.subTest(name):
                folder = self.written(name, **how)
                with self.assertRaisesRegex(Refusal, f"^{folder}/{said}" if said else "span 1e\\+09 s"):
                    of_run.metrics(folder, folder)

    def test_an_energy_that_the_table_does_not_have_is_left_out_and_is_not_zero(self):
        self.assertFalse({"injected_J", "generated_J"} & set(of_run.metrics(self.good)))
        of_first_tick = self.written("energy", [row + (",0.25," if i == 0 else ",,") for i, row in enumerate(self.ROWS)], self.HEAD + ",injected_J,generated_J")
        found = of_run.metrics(of_first_tick)
        self.assertEqual(0.25, found["injected_J"])
        self.assertNotIn("generated_J", found)

    def test_an_unknown_tool_is_refused(self):
        with self.assertRaisesRegex(Refusal, "--tool 7: haptic.csv has no such tool; it has 0"):
            of_run.metrics(self.good, tool="7")

    def test_a_comparison_that_is_left_out_is_explained(self):
        still = [f"0,{i * 1e-3:.3f},0,0,0" for i in range(500)]
        for name, rows, why in (("none", [], "the run has no force of this tool"), ("later", [f"0,{1000 + i * 1e-3:.3f},0,0,1" for i in range(500)], "do not overlap")):
            reasons = []
            found = of_run.metrics(self.written(name, rows), self.good, explain=reasons.append)
            self.assertNotIn("force_rmse_N", found)
            self.assertRegex(reasons[0], why)
        reasons = []
        of_run.metrics(self.written("still", still), self.written("still_too", still), explain=reasons.append)
        self.assertEqual(["forces are not compared: neither has a contact"], reasons)

    def test_any_name_of_a_run_is_printed_and_written(self):
        folder = self.written(os.fsdecode(b"a\nb\xff"))
        done = subprocess.run([str(ROOT / "scripts" / "tactus"), "metrics", folder, "--csv", str(self.folder / "a.csv"), "--json", str(self.folder / "a.json")], capture_output=True, check=False)
        self.assertEqual((0, b""), (done.returncode, done.stderr))
        self.assertEqual(2, len(tables.read_rows(self.folder / "a.csv")) + 1)
        for words in (("/dev/null",), (self.good, "--csv", self.good), (self.good, "--csv", "/proc/none/a")):
            done = subprocess.run([str(ROOT / "scripts" / "tactus"), "metrics", *words], capture_output=True, text=True, check=False)
            self.assertEqual((1, "", 1), (done.returncode, done.stdout, done.stderr.count("\n")))


class Ranking(unittest.TestCase):
    def test_the_streams_of_operators_have_their_age(self):
        # The mean age under a loss of p is that of 1200 (1 - p) gaps, each with about the standard deviation of its mean: 3 deviations are 0.2 for p = 0.8.
        for modality, operator, level, expected, share in (("haptic", "delay", 40, 0.0405, 0.02), ("visual", "rate", 5, 0.1, 0.02),
                                                           ("visual", "loss", 80, age.expected_s(0, 60, 0.8), 0.2)):
            made, at = ranking.delivered(modality, operator, level)
            self.assertAlmostEqual(age.measured_s(made, at), expected, delta=share * expected)
        self.assertAlmostEqual(age.measured_s(*ranking.delivered("haptic", "", 0)), 0.0005, delta=1e-4)

    def test_a_late_condition_has_an_error_of_time_and_an_undegraded_one_has_none(self):
        late, plain = ranking.of_condition("haptic", "delay", 100), ranking.of_condition("haptic", "", 0)
        self.assertAlmostEqual(late["force_time_ms"], 100, delta=6)
        # The undegraded stream of 1 kHz is up to a millisecond old, which leaves the tube where the signal is near zero.
        self.assertEqual(plain["force_time_ms"], 0)
        self.assertLess(plain["force_jnd_share"], 0.01)
        self.assertEqual(set(late), set(ranking.METRICS))

    def test_a_falling_curve_is_the_weighted_mean_where_the_data_rise(self):
        x, y = ranking.falling(np.array([3.0, 1, 2, 4]), np.array([0.9, 1.0, 0.5, 0.1]), np.array([1.0, 1, 3, 1]))
        self.assertEqual(x.tolist(), [1, 2, 3, 4])
        np.testing.assert_allclose(y, [1, 0.6, 0.6, 0.1])

    def test_the_loss_of_a_fair_coin_is_one_bit(self):
        self.assertAlmostEqual(ranking.log_loss_bits(np.array([5]), np.array([10]), np.array([0.5])), 1)
        self.assertLess(ranking.log_loss_bits(np.array([10]), np.array([10]), np.array([1.0])), 0.02)

    def test_the_metric_that_decides_success_is_ranked_first_on_operators_that_were_left_out(self):
        levels = {"delay": (10, 30, 60, 120), "rate": (2, 5, 10, 30), "loss": (50, 80, 95), "jitter": (10, 30, 60)}
        for decides in ("age_ms", "force_jnd_share"):
            conditions = []
            for operator, level in [("", 0)] + [(o, l) for o in levels for l in levels[o]]:
                metrics = ranking.of_condition("visual", operator, level)
                limit = {"age_ms": 90, "force_jnd_share": 0.5}[decides]
                won = round(1000 / (1 + np.exp(8 * (metrics[decides] / limit - 1))))
                conditions.append({"modality": "visual", "operator": operator, "level": level, "won": won, "games": 1000, "metrics": metrics})
            self.assertEqual(ranking.rank(conditions)[0]["metric"], decides)

    def test_conditions_are_read_from_a_table_of_games(self):
        row = lambda modality, operator, level, success, second="": {"modality_degraded": modality, "operator": operator, "level": level, "success": success, "second_modality": second}
        rows = [row("haptic", "delay", 40.0, 1), row("haptic", "delay", 40.0, 0), row("", "", None, 1), row("haptic", "off", None, 0), row("audio", "delay", 40.0, 1),
                row("visual", "rate", 5.0, 1, "haptic"), row("visual", "rate", 5.0, None)]
        found = {(c["modality"], c["operator"], c["level"]): (c["won"], c["games"]) for c in ranking.conditions_of(rows)}
        self.assertEqual(found, {("haptic", "", 0): (1, 1), ("visual", "", 0): (1, 1), ("haptic", "delay", 40): (1, 2)})

    def test_the_stored_ranking_names_its_data_and_metrics_that_a_report_can_show(self):
        stored = ranking.stored()
        self.assertTrue((ROOT / stored["data"]).exists())
        self.assertGreaterEqual(sum(row["metric"] in of_run.MEANING for row in stored["ranking"]), 3)
        losses = [row["loss_bits"] for row in stored["ranking"]]
        self.assertEqual(losses, sorted(losses))


class Commands(unittest.TestCase):
    def test_wrong_tables_and_options_give_one_sentence(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for file, data in (("a.csv", b"a,b\n1,2\n"), ("b.csv", b"\xff\xfe"), ("c.csv.xz", b"no xz"), ("d.csv.xz", lzma.compress(b"a")[:-9])):
                (folder / file).write_bytes(data)
            log = folder / "run.lcmlog"
            log.write_bytes(b"")
            for program, words in ((rank, [folder / "a.csv"]), (rank, [folder / "b.csv"]), (rank, [folder / "c.csv.xz"]), (rank, [folder / "d.csv.xz"]), (rank, [folder]),
                                   (rank, [folder / "none.csv"]), (curves, [folder / "none"]), (curves, [log, "--bands", "0,x"]), (curves, [log, "--bands", "nan"]),
                                   (curves, [log, "--bands", "1.5"]), (curves, [log, "--floor", "inf"]), (curves, [log, "--delay=-1"]), (curves, [log, folder / "x.gif"])):
                with self.subTest(words=words), self.assertRaises(SystemExit) as ended:
                    program.main([str(word) for word in words])
                self.assertIsInstance(ended.exception.code, str)
                self.assertNotIn("\n", ended.exception.code)


if __name__ == "__main__":
    unittest.main()
