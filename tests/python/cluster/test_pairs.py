"""Tests that faults between hosts are found and reported with a remedy."""
import copy
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.cluster import pairs


def host(name, others):
    other = {"received": True, "answered": True, "lost": 0.0, "of_bursts": 300, "ttl": 1, "offset_us": 5e6, "uncertainty_us": 40,
             "round_trip_us": {"least": 80, "p50": 100, "p99": 300}}
    return {"host": name, "asked": 250, "burst": 300, "refused": 0, "other_doctors": 0, "ttl": 1, "buffer_bytes": 4 << 20,
            "others": {o: copy.deepcopy(other) for o in others if o != name}}


class Pairs(unittest.TestCase):
    def setUp(self):
        names = ("a", "b", "c")
        self.said = {n: host(n, names) for n in names}

    def found(self, *words):
        for sentence in pairs.findings(self.said):
            if all(w in sentence for w in words):
                return
        self.fail(f"{words} not in {pairs.findings(self.said)}")

    def deafen(self, who, to):
        self.said[who]["others"][to].update(received=False, answered=False)

    def test_a_healthy_network_has_no_findings(self):
        self.assertEqual([], pairs.findings(self.said))
        self.assertEqual(6, len(pairs.rows(self.said)))
        self.assertIn("+5.000000", pairs.text(pairs.rows(self.said)))

    def test_a_host_that_receives_nothing_and_one_that_is_not_received_are_reported(self):
        self.deafen("b", "a")
        self.deafen("b", "c")
        self.found("b: receives nothing from the other hosts", "route")
        self.setUp()
        self.deafen("a", "b")
        self.deafen("c", "b")
        self.found("a: receives nothing from b", "a firewall on a")

    def test_a_ttl_of_zero_is_reported(self):
        for name in self.said:
            self.said[name]["ttl"] = 0
            for o in list(self.said[name]["others"]):
                self.deafen(name, o)
        self.found("ttl is 0")

    def test_losses_bursts_and_buffers_are_reported(self):
        self.said["a"]["others"]["b"]["lost"] = 0.1
        self.found("a: loses 10.0 % of the datagrams of b")
        self.said["c"]["others"]["a"]["of_bursts"] = 200
        self.found("c: 100 of 300 datagrams of bursts of a")
        self.said["b"]["buffer_bytes"] = 212992
        self.found("b: the kernel keeps 208 kB", "rmem_max=4194304")
        self.said["b"]["refused"] = 4
        self.found("b: its network refused 4")

    def test_slow_networks_and_uncertain_clocks_are_reported(self):
        self.said["a"]["others"]["c"]["round_trip_us"]["p99"] = 50_000
        self.found("a: answers of c take up to 50 ms")
        self.said["a"]["others"]["c"]["uncertainty_us"] = 9000
        self.found("a: the uncertainty of the clock of c is 9.0 ms")

    def test_lost_answers_are_reported(self):
        self.said["a"]["others"]["b"]["answered"] = False
        self.found("a: b receives its datagrams, but the answers are lost")

    def test_a_host_without_results_is_skipped(self):
        del self.said["c"]
        self.assertEqual([], pairs.findings(self.said))
        self.assertEqual(4, len(pairs.rows(self.said)))


if __name__ == "__main__":
    unittest.main()
