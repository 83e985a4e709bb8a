"""Tests of the limits for device drivers in Python (examples/device_driver/guards.py), by the table that the test in C++ reads too.

Each row of tests/examples/guard_cases.csv continues its case to the time to_ms, by ticks of 1 ms, or of 100 ms for temperatures. `do`
names the messages of each tick; low and high bound the output at its end: the size of force (N) or torque (N m), or the temperature."""
import csv
import itertools
import math
import os
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "examples", "device_driver"))
import guards  # noqa: E402

START_NS = 10_000_000_000
MS = 1_000_000


class Case:
    """One device and its senders, with time moved by hand."""

    def __init__(self, test, name):
        self.test, self.name = test, name
        self.force, self.plate = guards.ForceGuard(), guards.TemperatureGuard()
        self.now_ms, self.seq, self.message, self.reason = 0, 0, "", "no command"
        self.size, self.before, self.given_J = 0.0, 0.0, 0.0

    def now_ns(self):
        return START_NS + int(self.now_ms * MS)

    def sent(self, row, run=1, more=0):
        self.seq += 1
        return guards.Sent(run, int(row["incarnation"]) + more, self.seq, self.now_ns() - int(float(row["age_ms"]) * MS))

    def push(self, row, sent, torque=False):
        vector, zero = tuple(float(row[axis]) for axis in "xyz"), (0.0, 0.0, 0.0)
        return self.force.on_message(sent, zero if torque else vector, vector if torque else zero,
                                     int(row["valid_ms"]) * MS, self.now_ns())

    def send(self, row):
        do = row["do"]
        if do in ("force", "torque"):
            self.message = self.push(row, self.sent(row), do == "torque")
        elif do == "repeat":
            self.seq -= 1
            self.message = self.push(row, self.sent(row))
        elif do == "leap":
            sent = self.sent(row)
            self.message = self.push(row, guards.Sent(sent.run, sent.incarnation, 2**62, sent.sent_ns))
        elif do == "other_run":
            self.message = self.push(row, self.sent(row, run=2))
        elif do == "beside_other_run":
            self.push(row, self.sent(row, run=2, more=1))
            self.message = self.push(row, self.sent(row))
        elif do == "two":
            self.push(row, self.sent(row, more=1))
            self.message = self.push(row, self.sent(row))
        elif do == "temperature":
            self.message = self.plate.on_message(self.sent(row), float(row["x"]), self.now_ns())
        elif do == "two_temperatures":
            self.plate.on_message(self.sent(row, more=1), float(row["x"]), self.now_ns())
            self.message = self.plate.on_message(self.sent(row), float(row["x"]), self.now_ns())

    def tick_force(self, row, dt_s):
        speed = float(row["speed"])
        out = self.force.update(self.now_ns(), (0.0, 0.0, speed))
        force, torque = math.hypot(*out.force), math.hypot(*out.torque)
        self.test.assertLessEqual(force, 8 + 1e-9, self.name)
        self.test.assertLessEqual(torque, 0.3 + 1e-9, self.name)
        if self.size == 0 or force > self.before:
            self.test.assertLessEqual(force - self.before, 2000 * dt_s + 1e-9, self.name)
        if math.isfinite(speed):
            self.given_J = max(0.0, self.given_J + (out.force[2] * speed - 1) * dt_s)
        self.test.assertLessEqual(self.given_J, 0.49 + 8e-3, self.name)  # one tick at 8 N and 1 m/s
        self.before, self.size, self.reason = force, torque if row["do"] == "torque" or torque else force, out.reason

    def tick_plate(self, row):
        plate = float(row["y"]) if row["y"] else self.plate.out_degC
        self.size = self.plate.update(self.now_ns(), plate)
        self.reason = self.plate.reason
        self.test.assertTrue(15 <= self.size <= 42, self.name)

    def run(self, row):
        do, to_ms = row["do"], int(row["to_ms"])
        warm = do in ("temperature", "two_temperatures", "plate")
        step = to_ms - self.now_ms if do == "stop" else 100 if warm else 1
        while self.now_ms < to_ms:
            self.now_ms += step
            self.send(row)
            if warm:
                self.tick_plate(row)
            else:
                self.tick_force(row, step * 1e-3)
        where = f"{self.name}, at {to_ms} ms: {self.size} {self.message} {self.reason}"
        self.test.assertTrue(float(row["low"]) - 1e-9 <= self.size <= float(row["high"]) + 1e-9, where)
        self.test.assertEqual(row["reason"], self.reason, where)
        if row["message"] or self.message:
            self.test.assertEqual(row["message"], self.message, where)


class Table(unittest.TestCase):
    def test_every_case_of_the_table(self):
        with open(os.path.join(HERE, "..", "examples", "guard_cases.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertGreater(len(rows), 50)
        for name, of_case in itertools.groupby(rows, key=lambda row: row["case"]):
            with self.subTest(name):
                case = Case(self, name)
                for row in of_case:
                    case.run(row)


class OtherClock(unittest.TestCase):
    def accepted(self, delays_s, drift=0.0):
        sender = guards.OneSender(guards.SenderLimits(same_clock=False))
        count = 0
        for i, delay in enumerate(delays_s):
            sent_s = i * 1e-3
            now_s = 1e6 + sent_s * (1 + drift) + delay
            count += sender.check(guards.Sent(1, 7, i, round(sent_s * 1e9)), round(now_s * 1e9)) == ""
        return count

    def test_a_sender_with_another_clock_is_followed_and_its_late_messages_are_not(self):
        self.assertEqual(1000, self.accepted([0.001] * 1000))
        self.assertEqual(500, self.accepted([0.001] * 500 + [0.2] * 500))
        self.assertEqual(20_000, self.accepted([0.001] * 20_000, drift=1e-4))


if __name__ == "__main__":
    unittest.main()
