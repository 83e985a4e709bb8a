"""Tests of tactus cluster doctor with hosts that answer late or never."""
import pathlib
import sys
import types
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.cluster import checkup
from tactus.cluster.host_connection import Unreachable

LOST = Unreachable("sound: does not answer within 10 s")


def operator_of(*answers):
    """A fake operator with prepared answers of hosts, in order; `requests` records the requests."""
    left, requests = list(answers), []

    def request_all(_, hosts, **request):
        requests.append((tuple(hosts), {h: request["words"](h) for h in hosts} if "words" in request else None))
        answer = left.pop(0)
        return {h: answer[h] for h in hosts}
    return types.SimpleNamespace(request_all=request_all, requests=requests, cluster=types.SimpleNamespace(
        bus=types.SimpleNamespace(group="239.255.76.67", port=7667, ttl=1), nodes_on=lambda _: []))


class LossyConnections(unittest.TestCase):
    def setUp(self):
        original, checkup.report = checkup.report, lambda *_: None
        self.addCleanup(setattr, checkup, "report", original)

    def test_only_an_unreachable_host_is_requested_again(self):
        operator = operator_of({"world": 1, "sound": LOST}, {"sound": 2})
        self.assertEqual({"world": 1, "sound": 2}, checkup.request_with_retry(operator, "inspect_host", ["world", "sound"]))
        self.assertEqual([("world", "sound"), ("sound",)], [hosts for hosts, _ in operator.requests])

    def test_an_unreachable_host_is_requested_twice(self):
        operator = operator_of({"sound": LOST}, {"sound": LOST})
        self.assertEqual({"sound": LOST}, checkup.request_with_retry(operator, "inspect_host", ["sound"]))

    def test_probes_are_repeated_with_a_new_round_number_when_a_host_is_missing(self):
        answer = {"status": 1, "err": "no route", "out": ""}
        operator = operator_of({"world": answer, "sound": LOST}, {"world": answer, "sound": answer})
        self.assertEqual(["world: no route", "sound: no route"], checkup.check_pairs(operator, ["world", "sound"], 1, {"pairs": {}}))
        (first_hosts, first), (hosts, second) = operator.requests
        self.assertEqual(first_hosts, hosts)
        round_of = lambda words: words[words.index("--round") + 1]
        self.assertEqual(round_of(second["world"]), round_of(second["sound"]))
        self.assertNotEqual(round_of(first["world"]), round_of(second["world"]))

    def test_a_host_that_stops_answering_is_reported_and_the_check_continues(self):
        operator = operator_of()
        def silent():
            raise LOST
        operator.connections = {"sound": types.SimpleNamespace(measure_round_trip_s=silent)}
        figures = {"hosts": {}, "remarks": []}
        answer = {"out": '{"lines": [{"what": "real-time priority", "verdict": "missing", "found": "SCHED_FIFO is refused", "remedy": ""}]}'}
        errors = checkup.check_host(operator, "sound", {"machine": "x", "cores": 2}, answer, LOST, figures)
        self.assertTrue(errors[0].startswith(f"{LOST}, but was reached a moment before"), errors)
        self.assertEqual("sound: SCHED_FIFO is refused", errors[1])
        self.assertEqual((None, None), (figures["hosts"]["sound"]["reached_s"], figures["hosts"]["sound"]["load"]))


if __name__ == "__main__":
    unittest.main()
