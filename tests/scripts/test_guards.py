"""Tests of the limits for device drivers in Python (examples/device_driver/guards.py), by the table that the test in C++ reads too.

Each row of tests/examples/guard_cases.csv continues its case to the time to_ms, by ticks of 1 ms, or of 100 ms for temperatures. `do`
names the messages of each tick; low and high bound the output at its end: the size of force (N) or torque (N m), or the temperature."""
import csv
import itertools
import math
import os
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "examples", "device_driver"))
import display  # noqa: E402
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


class Plate(unittest.TestCase):
    """A TemperatureGuard at 10 Hz, with time moved by hand."""

    def setUp(self):
        self.now_ns, self.seq = START_NS, 0

    def run_for(self, guard, seconds, wanted_degC=None, plate_degC=None):
        for _ in range(round(seconds * 10)):
            self.now_ns, self.seq = self.now_ns + 100 * MS, self.seq + 1
            if wanted_degC is not None:
                guard.on_message(guards.Sent(1, 5, self.seq, self.now_ns), wanted_degC, self.now_ns)
            guard.update(self.now_ns, guard.out_degC if plate_degC is None else plate_degC)
        return guard.out_degC

    def test_a_plate_that_does_not_obey_or_whose_sensor_has_failed_is_switched_off(self):
        guard = guards.TemperatureGuard()
        self.run_for(guard, 1, 33)
        for plate, off in ((33, False), (44, False), (44.1, True), (33, False), (13, False), (12.9, True), (12.95, False), (math.nan, True), (math.inf, True), (33, False)):
            self.run_for(guard, 0.1, 33, plate)
            self.assertEqual(off, guard.off, plate)
        cold = guards.TemperatureGuard()
        self.run_for(cold, 0.1, 33, -5)
        self.assertFalse(cold.off)  # it was cold when it was switched on

    def test_the_exposure_survives_a_restart(self):
        guard = guards.TemperatureGuard()
        self.assertEqual(39, self.run_for(guard, 250, 42))
        account = guard.account()
        again = guards.TemperatureGuard()
        again.resume(account)
        self.assertEqual(39, self.run_for(again, 5, 42))
        self.assertAlmostEqual(account.dose_s, again.account().dose_s, delta=2)
        rested = guards.TemperatureGuard()
        rested.resume(account, 3600)
        self.assertEqual(42, self.run_for(rested, 5, 42))
        for damaged in (math.nan, math.inf, -1.0, 1e9):
            full = guards.TemperatureGuard()
            full.resume(guards.SkinAccount(damaged, damaged))
            self.assertEqual((39, 20), (self.run_for(full, 5, 42), self.run_for(full, 5, 15)), damaged)

    def test_no_slew_limit_lengthens_the_way_to_neutral(self):
        for slew in (0.1, 1, 20):
            guard = guards.TemperatureGuard(guards.TemperatureLimits(slew_K_s=slew))
            self.assertAlmostEqual(42, self.run_for(guard, 9 / slew + 1, 42), 6)
            self.assertEqual(33, self.run_for(guard, 0.3 + 0.5))  # 0.3 s of validity, and 9 K at 20 K/s


class StoredExposure(unittest.TestCase):
    def test_a_file_keeps_the_exposure_and_one_that_cannot_be_believed_is_a_full_one(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "display.dose")
            stored = display.Exposure(path)
            self.assertEqual((guards.SkinAccount(), 0.0), stored.load(5))
            account = guards.SkinAccount(30.5, 2.25, True, False)
            stored.save(account, 1000.0)
            self.assertEqual(0o600, os.stat(path).st_mode & 0o777)
            self.assertEqual((account, 20.0), stored.load(1020.0))
            self.assertEqual((account, 0.0), stored.load(900.0))  # the clock was put back
            for text in ("", "{}", "[]", '{"dose_s": "x"}', "\xff" * 9, '{"dose_s": 1, "cold_s": 1, "too_warm": 0, "too_cold": 0}'):
                with open(path, "w", encoding="latin-1") as file:
                    file.write(text)
                self.assertEqual((display.FULL, 0.0), stored.load(5), text)
            stored.save(account, 1000.0)
            os.chmod(path, 0o666)
            self.assertEqual((display.FULL, 0.0), stored.load(1020.0))
            guard = guards.TemperatureGuard()
            guard.resume(*stored.load(1020.0))
            self.assertTrue(guard.too_warm and guard.too_cold)


if __name__ == "__main__":
    unittest.main()
