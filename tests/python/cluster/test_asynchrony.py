"""Tests of asynchronies between hosts: by exact clocks and by clock maps, and the stated uncertainty of the maps against the difference."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.cluster import asynchrony as a

AHEAD_S = {"world": 1000, "sound": 2000, "left": 3000, "right": 3000}  # ahead of the clock of the lab; most events are at 500 s of it
HOSTS = {"recorder": "world", "sync_node": "world", "sync_node_sound": "sound", "sync_node_left": "left", "sync_node_right": "right",
         "haptic_node": "world", "audio_node": "sound", "visual_node": "left", "visual_node_right": "right"}
CLOCKS = {"world": 1, "sound": 2, "left": 3, "right": 4}
BEGIN_S = 490  # log time 0 on the clock of the lab
PERIODS_NS = {"visual_node": 50_000_000, "visual_node_right": 50_000_000, "haptic_node": 1_000_000}


def s(seconds):
    return round(seconds * a.NS_PER_S)


def map_row(of, to, at_s, error_ns=0, half_ns=30_000, drift=0.0, growth=0.0):
    """A CLOCK_MAP as sync_node of `to` publishes it at a time of the lab."""
    sender = next(n for n, h in HOSTS.items() if h == to and n.startswith("sync_node"))
    return {"log_s": f"{at_s - BEGIN_S:.9f}", "sender": sender, "of_clock": str(CLOCKS[of]), "to_clock": str(CLOCKS[to]), "at_ns (ns)": str(s(at_s + AHEAD_S[to])),
            "offset_ns (ns)": str(s(AHEAD_S[of] - AHEAD_S[to]) + error_ns), "drift": str(drift), "uncertainty_ns (ns)": str(half_ns), "uncertainty_drift": str(growth)}


def all_maps(**errors_ns):
    own = [map_row("world", to, 491) for to in ("sound", "left", "right")]  # maps of the other hosts; they identify the clocks
    return own + [map_row(of, "world", 495, errors_ns.get(of, 0)) for of in ("sound", "left", "right")]


def message(sender, arrives_s, once, **lists):
    """Rows of a long table."""
    of = [(name, value) for name, value in once.items()]
    for name, entries in lists.items():
        of += [(f"{name}[{i}].{field}", value) for i, entry in enumerate(entries) for field, value in entry.items()]
    message.seq += 1
    return [{"log_s": f"{arrives_s - BEGIN_S:.9f}", "sender": sender, "seq": str(message.seq), "field": f, "unit": "", "value": str(v)} for f, v in of]


message.seq = 0


def report(node, at_s, event=1, part=0, outcome=0, own_ns=1_000_000, arrives_s=None, meant_s=None, ready_s=None):
    sense = node.split("_")[0]
    entry = {"event_id": event, "part": part, "scheduled_ns": s((meant_s or at_s or 0) + AHEAD_S[HOSTS[node]]),
             "ready_ns": s((ready_s or at_s or 0) + AHEAD_S[HOSTS[node]]),
             "presented_ns": -1 if at_s is None else s(at_s + AHEAD_S[HOSTS[node]]), "uncertainty_ns": own_ns, "outcome": outcome}
    return message(node, arrives_s or (at_s or 500) + 0.005, {"modality": sense, "count": 1}, reports=[entry])


def delays_row(at_s, **delay_s):
    return message("sync_node", at_s, {"policy": 3}, entries=[{"modality": m, "delay_ns": s(d)} for m, d in delay_s.items()])


class Asynchrony(unittest.TestCase):
    def setUp(self):
        self.maps = a.ClockMapHistory(all_maps(), HOSTS, "world", AHEAD_S)

    def onsets(self, *reports, kinds=None, maps=None):
        return a.event_onsets([row for r in reports for row in r], kinds or {"1": "hit"}, maps or self.maps, HOSTS, AHEAD_S)

    def pairs(self, *reports, delays=None, **more):
        return {(p.a, p.b): p for p in a.modality_pairs(self.onsets(*reports, **more), delays, PERIODS_NS)}

    def test_exact_maps_state_the_true_asynchrony(self):
        p = self.pairs(report("audio_node", 500.0), report("visual_node", 500.020))["audio", "visual"]
        self.assertEqual(20_000_000, p.true_ns)
        self.assertEqual(0, p.reporting_error_ns)
        self.assertEqual(2 * 30_002, p.clocks_ns)
        self.assertEqual(2 * 30_002 + 2_000_000, p.stated_ns)
        self.assertEqual(("sound", "left"), p.hosts)

    def test_a_map_error_counts_only_above_its_stated_uncertainty(self):
        for error_ns, outside in ((55_000, False), (65_000, True)):
            maps = a.ClockMapHistory(all_maps(sound=error_ns), HOSTS, "world", AHEAD_S)
            p = self.pairs(report("audio_node", 500.0), report("visual_node", 500.020), maps=maps)["audio", "visual"]
            self.assertEqual(error_ns, p.reporting_error_ns)  # read by a map that is too far ahead, sound seems earlier
            self.assertEqual(outside, p.exceeds_clock_uncertainty)

    def test_presentation_uncertainty_does_not_widen_that_of_the_maps(self):
        maps = a.ClockMapHistory(all_maps(left=1_000_000), HOSTS, "world", AHEAD_S)
        p = self.pairs(report("audio_node", 500.0), report("visual_node", 500.020), maps=maps)["audio", "visual"]
        self.assertLess(abs(p.reporting_error_ns), p.stated_ns)
        self.assertTrue(p.exceeds_clock_uncertainty)

    def test_the_newest_map_before_the_report_is_used(self):
        rows = [*all_maps(), map_row("sound", "world", 500.5, error_ns=7_000), map_row("sound", "world", 501.5, error_ns=9_000)]
        maps = a.ClockMapHistory(rows, HOSTS, "world", AHEAD_S)
        at = lambda arrives_s: self.pairs(report("audio_node", 500.0, arrives_s=arrives_s), report("visual_node", 500.0), maps=maps)["audio", "visual"].reporting_error_ns
        self.assertEqual([0, 7_000, 9_000], [at(t) for t in (500.1, 501.0, 502.0)])

    def test_a_map_is_extrapolated_with_its_drift_and_growing_uncertainty(self):
        rows = [map_row("world", "sound", 491), map_row("sound", "world", 400, drift=1e-5, growth=1e-6)]
        maps = a.ClockMapHistory(rows, HOSTS, "world", AHEAD_S)
        reported_ns, half_ns = maps.to_recorder_clock(s(2500), "sound", 10)
        self.assertAlmostEqual(s(1500) - 1_000_000, reported_ns, delta=20)  # 100 s at 1e-5
        self.assertAlmostEqual(30_000 + 100_000, half_ns, delta=10)

    def test_the_map_of_the_opposite_direction_is_inverted(self):
        maps = a.ClockMapHistory([map_row("sound", "world", 480), map_row("world", "left", 495, drift=1e-5)], HOSTS, "world", AHEAD_S)
        reported_ns, half_ns = maps.to_recorder_clock(s(3500), "left", 10)
        self.assertEqual((s(1500) + 50_000, 30_002), (reported_ns, half_ns))  # 5 s at 1e-5

    def test_uncertain_or_missing_maps_give_no_asynchrony(self):
        maps = a.ClockMapHistory([map_row("world", "sound", 491), map_row("sound", "world", 495, half_ns=17_000_000)], HOSTS, "world", AHEAD_S)
        self.assertEqual({}, self.pairs(report("audio_node", 500.0), report("visual_node", 500.0), maps=maps))

    def test_a_hit_is_matched_with_vibration_and_a_begin_with_push(self):
        both = [report("haptic_node", 500.0, event=e, part=part) for e in (1, 2) for part in (a.CONSTRAINT, a.TRANSIENT)]
        senses = {(o.event, o.sense) for o in self.onsets(*both, kinds={"1": "hit", "2": "begin"})}
        self.assertEqual({(1, "haptic"), (2, "haptic_push")}, senses)

    def test_repeated_reports_count_once_and_dropped_presentations_never(self):
        self.assertEqual(1, len(self.onsets(report("audio_node", 500.0), report("audio_node", 500.0, arrives_s=500.03))))
        self.assertEqual([], self.onsets(report("audio_node", None, outcome=2), report("visual_node", 500.0, outcome=3)))
        late, = self.onsets(report("visual_node", 500.0, outcome=a.LATE))
        self.assertTrue(late.late)

    def test_the_first_wall_stands_for_vision_and_all_walls_are_compared(self):
        shown = [report("audio_node", 500.0), report("visual_node", 500.060), report("visual_node_right", 500.010)]
        p = self.pairs(*shown)["audio", "visual"]
        self.assertEqual((10_000_000, ("sound", "right")), (p.true_ns, p.hosts))
        wall, = a.wall_pairs(self.onsets(*shown), PERIODS_NS, {"visual_node": "front", "visual_node_right": "right"})
        self.assertEqual(("front", "right", -50_000_000, 0, 50_000_000), (wall.a, wall.b, wall.true_ns, wall.planned_ns, wall.grain_ns))
        self.assertFalse(wall.exceeds_stated_uncertainty)

    def test_sound_and_picture_are_compared_with_the_playout_delays(self):
        rows = [r for i in range(60) for r in delays_row(495 + i / 10, haptic=0, audio=0.15, visual=0.15)]
        delays = a.PlayoutDelays(rows, self.maps)
        near = self.pairs(report("haptic_node", 500.0, part=a.TRANSIENT), report("audio_node", 500.150), report("visual_node", 500.170), delays=delays)
        self.assertEqual((0, 20_000_000), (near["audio", "visual"].planned_ns, near["audio", "visual"].scheduling_error_ns))
        self.assertEqual((s(0.15), s(0.02)), (near["haptic", "visual"].planned_ns, near["haptic", "visual"].scheduling_error_ns))
        self.assertEqual([False] * 3, [p.exceeds_stated_uncertainty for p in near.values()])  # half a period of 50 ms is the grain of pictures
        far = self.pairs(report("audio_node", 500.150), report("visual_node", 500.180), delays=delays)
        self.assertTrue(far["audio", "visual"].exceeds_stated_uncertainty)
        self.assertFalse(far["audio", "visual"].exceeds_clock_uncertainty)

    def test_touch_without_delay_is_expected_when_the_event_is_received(self):
        delays = a.PlayoutDelays([r for i in range(60) for r in delays_row(495 + i / 10, haptic=0, audio=0.15)], self.maps)
        felt = lambda after_s: self.pairs(report("haptic_node", 500 + after_s, part=a.TRANSIENT, meant_s=500.0, ready_s=500.003), report("audio_node", 500.150, ready_s=500.2),
                                          delays=delays)["haptic", "audio"]
        self.assertEqual([4_000_000] * 2, [felt(t).grain_ns for t in (0.003, 0.008)])  # a tick and the transmission; the latency of sound is in its delay
        self.assertEqual([False, True], [felt(t).exceeds_stated_uncertainty for t in (0.003, 0.008)])

    def test_a_changing_delay_and_the_push_have_no_planned_asynchrony(self):
        rows = [r for i in range(160) for r in delays_row(490 + i / 10, haptic=0, audio=0.05 if i < 100 else 0.15)]
        delays = a.PlayoutDelays(rows, self.maps)
        self.assertEqual([s(0.05), None, None, s(0.15)], [delays.at("audio", s(t)) for t in (499.9, 500.05, 502.4, 503.5)])  # 0.1 s at 5 % take 2 s
        self.assertIsNone(delays.at("haptic_push", s(499)))
        self.assertIsNone(delays.at("audio", s(480)))

    def test_scheduling_errors_and_presentation_errors_are_separate(self):
        delays = a.PlayoutDelays([r for i in range(60) for r in delays_row(495 + i / 10, audio=0.15, visual=0.15)], self.maps)
        found = self.onsets(report("audio_node", 500.150), report("visual_node", 500.140, meant_s=500.120))
        sound, picture = a.scheduling_rows(found, {1: s(500.0)}, delays)
        self.assertEqual(("audio_node", 0.0, 0.0), (sound["node"], sound["meant_worst_ms"], sound["met_worst_ms"]))
        self.assertEqual(("visual_node", -30.0, 20.0), (picture["node"], picture["meant_worst_ms"], picture["met_worst_ms"]))

    def test_frame_times_and_arrivals_come_from_two_tables(self):
        arrived = [{"log_s": "10.0", "sender": n, "frame": "7"} for n in ("visual_node", "", "visual_node_right", "visual_node")]
        shown = [{"frame": "7", "stage": stage, "publish_ns": str(s(t + 3000))} for stage, t in (("shown", 500.0), ("shown", 500.004), ("ready", 500.01))]
        found = a.frame_onsets(arrived, shown, self.maps, HOSTS, AHEAD_S, {"visual_node": 3_000_000, "visual_node_right": 3_000_000})
        pair, = a.wall_pairs(found, {}, {"visual_node": "front", "visual_node_right": "right"})
        self.assertEqual((4_000_000, 0, 2 * 30_002 + 6_000_000), (pair.true_ns, pair.reporting_error_ns, pair.stated_ns))
        self.assertFalse(pair.exceeds_stated_uncertainty)
        with self.assertRaisesRegex(ValueError, "different logs"):
            a.frame_onsets(arrived[:1], shown, self.maps, HOSTS, AHEAD_S, {})

    def test_pairs_are_grouped_by_the_fault_of_their_window(self):
        windows = [(None, s(499), s(501)), ("left", s(510), s(511)), ("right", s(520), s(521)), ("world", s(530), s(531))]
        pairs = [p for i, t in enumerate((500, 505, 510.5, 520.5, 530.5))
                 for p in self.pairs(report("audio_node", t, event=i), report("visual_node", t + 0.01, event=i)).values()]
        self.assertEqual({"nothing": 1, "others": 1, "spoilt": 2}, {k: len(v) for k, v in a.split_by_window(pairs, windows, "world").items()})

    def test_a_summary_has_the_worst_error_and_the_number_of_violations(self):
        maps = a.ClockMapHistory(all_maps(sound=65_000), HOSTS, "world", AHEAD_S)
        pairs = [p for i, t in enumerate((500.0, 500.1, 500.2))
                 for p in self.pairs(report("audio_node", t, event=i), report("visual_node", t + 0.01 * i, event=i, outcome=i % 2), maps=maps).values()]
        row, = a.summary_rows(pairs)
        self.assertEqual((3, 3, 10.0, 20.0, 3, 1, 0), tuple(row[k] for k in ("n", "other_host", "true_p50_ms", "true_worst_ms", "outside", "late", "aimed")))
        self.assertAlmostEqual(0.065, row["off_worst_ms"])
        self.assertIsNone(row["aside_p50_ms"])
        self.assertIn("audio visual", a.text([row]))

    def test_the_summary_of_the_same_log_agrees_within_a_bin(self):
        pairs = [p for i in range(20) for p in self.pairs(report("audio_node", 500.0 + i, event=i), report("visual_node", 500.0 + i + 0.001 * i, event=i)).values()]
        summary = {"audio_visual": {"n": 20, "p05": 0.05, "p50": 9.1, "p95": 18.0, "uncertainty": 2.07}, "haptic_audio": {"n": 0}}
        row, = a.compare_with_summary(pairs, summary)
        self.assertEqual((20, 20), (row["n_said"], row["n"]))
        self.assertAlmostEqual(0.1, row["differs_ms"])


if __name__ == "__main__":
    unittest.main()
