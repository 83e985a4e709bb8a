"""Tests of the model of a large cluster against closed forms."""
import pathlib
import random
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.cluster import growth


class Growth(unittest.TestCase):
    def test_the_relay_traffic_agrees_with_the_relay_rules(self):
        from lxml import etree
        rules = {e.get("channel"): e for e in etree.parse(str(pathlib.Path(growth.__file__).with_name("relays") / "wide.xml")).getroot().iter("pass")}
        for flow in growth.read_flows():
            if flow.channel in ("CLOCK_PROBE", "CLOCK_MAP"):
                self.assertNotIn(flow.channel, rules)
                continue
            self.assertEqual(flow.thin_per_s > 0, flow.channel in rules, flow.channel)
            if flow.channel in rules:
                rate = rules[flow.channel].get("rate")
                snapshots = [flow.per_s] if rate is None else [flow.per_s, *(pages * float(rate.removesuffix("Hz")) for pages in range(1, 5))]
                self.assertIn(flow.thin_per_s, snapshots, flow.channel)
                self.assertLessEqual(flow.thin_per_s, flow.per_s, flow.channel)

    def test_the_mean_wait_agrees_with_pollaczek_and_khinchine(self):
        """M/D/1: the mean wait is rho s / (2 (1 - rho)); Kleinrock 1975, equation 5.63."""
        service_s = 1e-3
        for rho in (0.3, 0.6, 0.8):
            dice, at, waited, count = random.Random(4), 0.0, 0.0, 200_000
            queue = growth.Queue(1 / service_s)
            for _ in range(count):
                at += dice.expovariate(rho / service_s)
                waited += queue.serve(at, 1) - at - service_s
            expected = rho * service_s / (2 * (1 - rho))
            self.assertAlmostEqual(1, waited / count / expected, delta=0.04, msg=f"rho {rho}")
            self.assertAlmostEqual(rho, queue.busy_s / at, delta=0.01)

    def test_a_periodic_loop_adds_half_a_period_on_average_and_one_at_most(self):
        dice, ticks = random.Random(3), growth.PeriodicLoop(500, 0.0007)
        waited = [ticks.serve(at, 1) - at for at in (dice.uniform(0, 100) for _ in range(20_000))]
        self.assertAlmostEqual(1e-3, sum(waited) / len(waited), delta=2e-5)
        self.assertLessEqual(-1e-9, min(waited))
        self.assertLessEqual(max(waited), 2e-3 + 1e-9)

    def test_a_token_bucket_passes_at_most_its_rate_and_burst(self):
        """The bound of a token bucket: in any t at most burst + rate t (Cruz 1991, equation 1)."""
        dice = random.Random(7)
        rate, burst, size = 1e5, 5e4, 1e4
        bucket = growth.TokenBucket(rate, burst, 0.5)
        passed, at = [], 0.0
        for _ in range(5000):
            at += dice.expovariate(20 if dice.random() < 0.5 else 5)
            done = bucket.serve(at, size)
            if done is not None:
                self.assertLessEqual(done - at, 0.5 + 1e-9)
                passed.append(done)
        self.assertGreater(bucket.lost, 0)
        self.assertEqual(passed, sorted(passed))
        for i in range(0, len(passed), 7):
            for j in range(i, min(i + 300, len(passed)), 11):
                self.assertLessEqual((j - i + 1) * size, burst + rate * (passed[j] - passed[i]) + size + 1e-6)

    def test_a_full_queue_drops_messages_and_keeps_the_maximum_wait(self):
        queue = growth.Queue(1000, max_wait_s=0.01)
        for i in range(1000):
            done = queue.serve(i * 1e-4, 1)
            self.assertTrue(done is None or done - i * 1e-4 <= 0.011 + 1e-9)
        self.assertGreater(queue.lost, 800)

    def test_arrivals_agree_with_the_offered_load(self):
        for hosts in (1, 16, 60):
            found = growth.arrivals(hosts, True, 2.0, 3)
            offered = growth.offered_bit_s(hosts, True)
            self.assertAlmostEqual(1, sum(m[1] for m in found) / 2.0 / offered, delta=0.02)
            self.assertEqual(found, growth.arrivals(hosts, True, 2.0, 3))

    def test_clock_traffic_grows_at_most_linearly_with_the_hosts(self):
        probes = next(f for f in growth.read_flows() if f.channel == "CLOCK_PROBE")
        all_probes = lambda hosts: hosts * growth.messages_per_s(probes, hosts)
        self.assertAlmostEqual(4 * 6 * 6, all_probes(6))       # 8 probes in 2 s, 5 answers to each
        self.assertLess(all_probes(250) / all_probes(64), 1.3 * 250 / 64)
        self.assertLess(all_probes(64) / all_probes(16), 1.3 * 64 / 16 * 16 / 15)


if __name__ == "__main__":
    unittest.main()
