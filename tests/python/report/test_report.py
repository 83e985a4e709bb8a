#!/usr/bin/env python3
"""Tests of tactus report: figures of logs with known values, missing data is named, hostile texts are escaped."""
import csv
import json
import pathlib
import re
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))
from tactus.log import log_tables
from tactus.report import figures, report, traces, words
from tactus.tables import read_rows

LIVE_FROM = 5_000_000_000
HOSTILE = 'dark<script>alert(1)"&.sdf'


def summary(**more):
    node = {"rate_hz": 1000.0, "ticks": 1000, "missed_ticks": 0, "stale_ticks": 0, "tick_us": {"p50": 10.0, "p99": 20.0, "p999": 30.0, "max": 40.0},
            "wake_us": {"p50": 1.0, "p99": 2.0, "p999": 3.0, "max": 4.0}, "input_age_ms": {}, "quality": [], "restarts": 0, "scheduling": ""}
    counts = {"expected": 3, "presented": 3, "late": 0, "lost": 0, "stalled": 0, "dead": 0, "dropped_by_profile": 0, "dropped_late": 0}
    return {"scene": HOSTILE, "seconds": 1.0, "recorded_seconds": 1.0, "log_holes_seconds": 0, "seed": 1, "git": "", "realtime_factor": 1.0, "warnings": [], "absent": [],
            "nodes": {"sim_node": node}, "contacts": {"begin": 3, "hit": 3, "end": 3, "late": 0, "lost": 0, "dropped_by_profile": 0, "by_modality": {"audio": counts}},
            "asynchrony_ms": {}, "bus": {}, **more}


class Logs(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.root = pathlib.Path(kept.name)
        self.count = 0

    def log(self, tables=None, name="run", **more):
        """tables: {file: [header, row, ...]}."""
        self.count += 1
        folder = self.root / str(self.count)
        folder.mkdir()
        (folder / "summary.json").write_text(json.dumps(summary(**more)))
        (folder / "schema.json").write_text(json.dumps({"damaged_regions": 0}))
        for file, rows in (tables or {}).items():
            with open(folder / file, "w", newline="", encoding="utf-8") as out:
                csv.writer(out).writerows(rows)
        return log_tables.LogTables(str(folder), name)

    @staticmethod
    def long(*rows):
        return [["log_s", "world_s", "sender", "seq", "field", "unit", "value"], *rows]

    def of_events(self, received_after_ms, audio_ms, visual_ms, push_ms=()):
        """A log with events every 100 ms, received and presented after the given times in ms."""
        at = [LIVE_FROM + i * 100_000_000 for i in range(len(audio_ms))]
        presented = [["modality", "event_id", "part", "scheduled_ns", "presented_ns", "uncertainty_ns", "outcome"]]
        for sense, part, list_ms in (("audio", "whole", audio_ms), ("visual", "whole", visual_ms), ("haptic", "constraint", push_ms)):
            presented += [[sense, i, part, at[i] + 10_000_000, -1 if ms is None else at[i] + round(ms * 1e6), 0, "dropped_by_profile" if ms is None else "presented"]
                          for i, ms in enumerate(list_ms)]
        return self.log({
            "LOG_INFO.csv": self.long(["-1", "", "recorder", 0, "live_from_ns", "ns", LIVE_FROM], ["-1", "", "recorder", 0, "scene", "", HOSTILE]),
            "events.csv": [["event_id", "kind", "host_ns"], *([i, "hit", ns] for i, ns in enumerate(at))],
            "CONTACT_EVENTS.csv": self.long(*([(ns - LIVE_FROM) * 1e-9 + received_after_ms * 1e-3, "", "sim_node", i, "events[0].event_id", "", i] for i, ns in enumerate(at))),
            "presented.csv": presented})


class Figures(Logs):
    def test_latencies_are_those_of_the_events(self):
        log = self.of_events(2.5, [20, 21, 25], [33, None, 40], [1, 1.5, 2])
        hops = log_tables.latencies_ms(log.events(), log.first_received_ns(), log.presented_ns())
        np.testing.assert_allclose(hops["simulation to bus"], [2.5] * 3, atol=1e-6)
        np.testing.assert_allclose(hops["event to audio"], [20, 21, 25], atol=1e-6)
        np.testing.assert_allclose(hops["event to visual"], [33, 40], atol=1e-6)
        np.testing.assert_allclose(hops["event to haptic_push"], [1, 1.5, 2], atol=1e-6)
        np.testing.assert_allclose(log.lateness_ms()["audio"], [10, 11, 15], atol=1e-6)
        self.assertNotIn("haptic", log.lateness_ms())  # a push is scheduled immediately

    def test_asynchronies_are_signed_and_of_events_that_both_modalities_presented(self):
        log = self.of_events(1, [20, 21, 25], [33, None, 15], [1, 1, 1])
        found = log_tables.asynchronies_ms(log.presented_ns())
        np.testing.assert_allclose(found["audio", "visual"], [13, -10], atol=1e-6)
        np.testing.assert_allclose(found["haptic_push", "audio"], [19, 20, 24], atol=1e-6)
        self.assertNotIn(("visual", "audio"), found)

    def test_an_event_is_received_with_its_first_message(self):
        log = self.log({"LOG_INFO.csv": self.long(["-1", "", "recorder", 0, "live_from_ns", "ns", LIVE_FROM]),
                        "CONTACT_EVENTS.csv": self.long(["0.5", "", "sim_node", 0, "events[1].event_id", "", "9"], ["0.6", "", "sim_node", 1, "events[0].event_id", "", "9"],
                                                        ["0.1", "", "sim_node", 1, "events[0].contact_id", "", "9"])})
        self.assertEqual(log.first_received_ns(), {"9": LIVE_FROM + 500_000_000})

    def test_published_thresholds_have_the_sign_of_the_later_modality(self):
        rows = read_rows(ROOT / "sync" / "presentation" / "thresholds.csv")
        both = {at: row["source"] for at, row in log_tables.bands(rows, "audio", "visual")}
        self.assertIn("ITU-R BT.1359-1, 1998", both[45.0])
        self.assertIn("ITU-R BT.1359-1, 1998", both[-125.0])
        self.assertEqual([at for at, _ in log_tables.bands(rows, "haptic", "audio")], [at for at, _ in log_tables.bands(rows, "haptic_push", "audio")])
        self.assertEqual(log_tables.bands(rows, "audio", "thermal"), [])

    def test_the_distribution_steps_by_one_in_n_at_each_value(self):
        fig, axes = figures.new()
        figures.cdf(axes, np.array([3.0, 1.0, 2.0, 2.0]))
        x, y = axes.lines[0].get_data()
        self.assertEqual(list(x), [1, 1, 2, 2, 3])
        self.assertEqual(list(y), [0, 0.25, 0.5, 0.75, 1])
        figures.plt.close(fig)

    def test_a_decimated_curve_keeps_its_peaks(self):
        x = np.arange(100_000.0)
        y = np.sin(x)
        y[54_321], y[77_777] = 50, -60
        thin_x, thin_y = figures.envelope(x, y, 1500)
        self.assertLessEqual(len(thin_x), 1500)
        self.assertTrue(np.all(np.diff(thin_x) > 0))
        self.assertEqual((thin_y.max(), thin_y.min()), (50, -60))

    def test_a_force_change_within_the_weber_fraction_is_not_counted(self):
        reference = np.array([[0, 0, 2.0]] * 100)
        for percent, share in ((6.9, 0), (7.1, 1)):
            self.assertEqual(traces.share_above_jnd(reference, reference * (1 + percent / 100), 0.07), share)
        weak = np.array([[0, 0, 0.1]] * 10)
        self.assertEqual(traces.share_above_jnd(weak, weak + [0, 0, 0.034], 0.07), 0)  # 7 % of the floor of 0.5 N
        self.assertEqual(traces.share_above_jnd(weak, weak + [0, 0, 0.036], 0.07), 1)
        self.assertEqual(traces.share_above_jnd(np.zeros((5, 3)), np.zeros((5, 3)), 0.07), 0)

    def test_the_force_at_a_time_is_that_of_the_newest_tick(self):
        hand = {"time_s": np.array([np.nan, 0.2, 0.1, 0.3]), "force_N": np.array([[9, 9, 9], [2, 0, 0], [1, 0, 0], [3, 0, 0]], dtype=float)}
        at = traces.resampled(hand, np.array([0.05, 0.1, 0.19, 0.2, 5]))
        self.assertTrue(np.isnan(at[0]).all())
        self.assertEqual(list(at[1:, 0]), [1, 1, 2, 3])

    def test_a_profile_is_joined_from_its_pages_and_the_newest_is_used(self):
        def page(seq, generation, number, text):
            return [[str(seq), "", "sync_node", seq, field, "", value] for field, value in (("generation", generation), ("page", number), ("pages", 2), ("text", text))]
        log = self.log({"DEGRADATION.csv": self.long(*page(0, 5, 1, "old"), *page(1, 9, 1, ' rate="5Hz"/>\n</profile>'), *page(2, 9, 0, '<profile>\n<degrade modality="audio"'))})
        self.assertEqual(log.profile(), ('<profile>\n<degrade modality="audio" rate="5Hz"/>\n</profile>', 1.0))

    def test_degradation_decisions_are_counted_by_reason(self):
        fields = [("modality", "audio"), ("count", 3)]
        for i, (event, why, held, twice) in enumerate(((1, 0, 40_000_000, 0), (1, 3, 0, 0), (0, 0, 5_000_000, 1))):
            fields += [(f"decisions[{i}].is_event", event), (f"decisions[{i}].drop_reason", why), (f"decisions[{i}].held_ns", held), (f"decisions[{i}].twice", twice)]
        log = self.log({"DEGRADED.csv": self.long(*(["1", "", "audio_node", 0, f, "", v] for f, v in fields))})
        found = log.decisions()
        self.assertEqual(found["audio", "events"]["why"], {"let through": 1, "loss": 1})
        self.assertEqual(list(found["audio", "events"]["held_ms"]), [40])
        self.assertEqual(found["audio", "snapshots"]["twice"], 1)

    def test_an_overtaken_snapshot_is_not_counted_as_passed(self):
        fields = [("modality", "haptic"), ("count", 3)]
        for i, (key, why, held) in enumerate(((7, 0, 12_000_000), (8, 0, 6_000_000), (7, 6, 0))):
            fields += [(f"decisions[{i}].key", key), (f"decisions[{i}].is_event", 0), (f"decisions[{i}].drop_reason", why), (f"decisions[{i}].held_ns", held), (f"decisions[{i}].twice", 0)]
        log = self.log({"DEGRADED.csv": self.long(*(["1", "", "haptic_node", 0, f, "", v] for f, v in fields))})
        found = log.decisions()["haptic", "snapshots"]
        self.assertEqual(found["why"], {"let through": 1, "overtaking": 1})
        self.assertEqual(list(found["held_ms"]), [6])


class Words(unittest.TestCase):
    def test_numbers_are_printed_with_significant_digits(self):
        for value, text in ((0, "0"), (None, "–"), (float("nan"), "–"), (1234567, "1\u2009234\u2009567"), (999.8, "1\u2009000"), (12.345, "12.3"), (-0.00123, "−0.00123"),
                            (0.9991, "0.999"), (1.5e-5, "0.000015"), (-1000.4, "−1\u2009000")):
            self.assertEqual(words.figure(value), text)
        self.assertEqual(words.figure(0.9991, 4), "0.9991")

    def test_a_table_escapes_any_text(self):
        self.assertIn('<th>a</th><th class="n">n</th>', words.table("c", ["a", "n"], [["x", 3]], 1))  # heads are aligned with their columns
        made = words.table("c", ["<b>"], [["<script>"], [3.0]], 1)
        self.assertIn("&lt;script&gt;", made)
        self.assertNotIn("<script>", made)


class Whole(Logs):
    def made(self, *logs):
        gallery = figures.Gallery(str(self.root / "figures"))
        return report.Report(list(logs), gallery).html()

    def test_the_page_is_self_contained_and_escapes_names(self):
        page = self.made(self.of_events(2, [20, 21, 25], [33, 30, 40], [1, 1, 1]))
        self.assertFalse("<script" in page)
        for link in re.findall(r'(?:src|href)="([^"]*)"', page):
            self.assertTrue(link.startswith(("#", "data:image/svg+xml;base64,")), link[:60])
        self.assertFalse("url(" in page)
        self.assertTrue("&lt;script&gt;" in page)

    def test_the_same_logs_give_the_same_bytes(self):
        log = self.of_events(2, [20, 21, 25], [33, 30, 40], [1, 1, 1])
        other = self.of_events(2, [60, 61, 65], [33, 30, 40], [1, 1, 1])
        self.assertTrue(self.made(log, other) == self.made(log, other))

    def test_every_figure_is_written_as_png_and_svg(self):
        self.made(self.of_events(2, [20, 21, 25], [33, 30, 40], [1, 1, 1]))
        files = sorted(p.name for p in (self.root / "figures").iterdir())
        self.assertEqual(files, ["asynchrony.png", "asynchrony.svg", "latency.png", "latency.svg", "raster.png", "raster.svg"])

    def test_the_report_of_an_empty_log_lists_missing_data(self):
        page = self.made(self.log(nodes={}, contacts={"begin": 0, "hit": 0, "end": 0, "late": 0, "lost": 0, "dropped_by_profile": 0, "by_modality": {}}, realtime_factor=0,
                                  absent=["audio"]))
        for sentence in ("The log has no simulation", "No modality reported", "No process published its health", "latency is unknown", "no asynchrony", "No tool was recorded",
                         "No temperature", "No degradation profile"):
            self.assertTrue(sentence in page, sentence)

    def test_lost_events_are_in_the_first_paragraph(self):
        contacts = {**summary()["contacts"], "lost": 2}
        self.assertIn("<b>2 expected events were lost.</b>", self.made(self.log(contacts=contacts)))

    def test_several_logs_are_shown_side_by_side(self):
        page = self.made(self.of_events(2, [20, 21, 25], [33, 30, 40]), self.of_events(2, [60, 61, 65], [33, 30, 40]))
        self.assertIn("<h2>Comparison</h2>", page)
        row = re.search(r"<h2>Comparison</h2>.*?</table>", page, re.S).group(0)
        self.assertIn('<td class="n">21</td>', row)
        self.assertIn('<td class="n">61</td>', row)


if __name__ == "__main__":
    unittest.main()
