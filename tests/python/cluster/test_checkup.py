"""Tests of tactus cluster doctor with hosts that answer late or never."""
import pathlib
import sys
import types
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.cluster import checkup
from tactus.cluster.reach import Unreachable

LOST = Unreachable("sound: does not answer within 10 s")


def operator_of(*answers):
    """A fake operator with prepared answers of hosts, in order; `asked` records the requests."""
    left, asked = list(answers), []

    def ask_all(_, hosts, **request):
        asked.append((tuple(hosts), {h: request["words"](h) for h in hosts} if "words" in request else None))
        answer = left.pop(0)
        return {h: answer[h] for h in hosts}
    return types.SimpleNamespace(ask_all=ask_all, asked=asked, cluster=types.SimpleNamespace(
        bus=types.SimpleNamespace(group="239.255.76.67", port=7667, ttl=1), of_host=lambda _: []))


class Lossy(unittest.TestCase):
    def setUp(self):
        said, checkup.tell = checkup.tell, lambda *_: None
        self.addCleanup(setattr, checkup, "tell", said)

    def test_who_could_not_be_reached_is_asked_once_more_and_nobody_else(self):
        operator = operator_of({"world": 1, "sound": LOST}, {"sound": 2})
        self.assertEqual({"world": 1, "sound": 2}, checkup.ask_again(operator, "look", ["world", "sound"]))
        self.assertEqual([("world", "sound"), ("sound",)], [hosts for hosts, _ in operator.asked])

    def test_who_is_away_for_good_is_asked_twice_and_no_oftener(self):
        operator = operator_of({"sound": LOST}, {"sound": LOST})
        self.assertEqual({"sound": LOST}, checkup.ask_again(operator, "look", ["sound"]))

    def test_probes_between_hosts_begin_anew_in_a_round_of_their_own_when_one_is_missing(self):
        heard = {"status": 1, "err": "no route", "out": ""}
        operator = operator_of({"world": heard, "sound": LOST}, {"world": heard, "sound": heard})
        self.assertEqual(["world: no route", "sound: no route"], checkup.of_pairs(operator, ["world", "sound"], 1, {"pairs": {}}))
        (first_hosts, first), (hosts, second) = operator.asked
        self.assertEqual(first_hosts, hosts)
        round_of = lambda words: words[words.index("--round") + 1]
        self.assertEqual(round_of(second["world"]), round_of(second["sound"]))
        self.assertNotEqual(round_of(first["world"]), round_of(second["world"]))

    def test_a_host_that_falls_silent_while_it_is_examined_is_a_finding_and_the_examination_goes_on(self):
        operator = operator_of()
        def silent():
            raise LOST
        operator.reaches = {"sound": types.SimpleNamespace(measure_s=silent)}
        figures = {"hosts": {}, "remarks": []}
        answer = {"out": '{"lines": [{"what": "real-time priority", "verdict": "missing", "found": "SCHED_FIFO is refused", "remedy": ""}]}'}
        wrong = checkup.of_host(operator, "sound", {"machine": "x", "cores": 2}, answer, LOST, figures)
        self.assertTrue(wrong[0].startswith(f"{LOST}, but was reached a moment before"), wrong)
        self.assertEqual("sound: SCHED_FIFO is refused", wrong[1])
        self.assertEqual((None, None), (figures["hosts"]["sound"]["reached_s"], figures["hosts"]["sound"]["load"]))


if __name__ == "__main__":
    unittest.main()
