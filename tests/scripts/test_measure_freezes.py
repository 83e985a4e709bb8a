"""tests/measure/measure_freezes finds each kind of violation, and none in outputs that keep all promises: against logs of which it is known."""
import pathlib
import struct
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "measure"))
sys.dont_write_bytecode = True

from freezes import bus_log, judge  # noqa: E402

MS = 1_000_000
FREEZE = (2000 * MS, 2500 * MS)
RESTING_N = 1.4


def promised_force(ms):
    """Force of a driver in a stop of the simulation that keeps all promises."""
    if 2070 <= ms < 2505:
        return 0.0
    if 2050 <= ms < 2070:
        return RESTING_N * (2070 - ms) / 20
    return RESTING_N * min(1.0, (ms - 2505) / 20) if ms >= 2505 else RESTING_N


def log_of(force, command=lambda ms: 33.0, touch_gap=range(2000, 2500)):
    """The outputs of 4 s in which the driver exerts force(ms) and the command is command(ms)."""
    log = bus_log.BusLog()
    z, velocity = 0.0, 0.0
    for ms in range(4000):
        log.states.append(bus_log.DriverState(ms * MS, ms, z, velocity))
        log.commanded_N.append((ms * MS, abs(force(ms))))
        held = bus_log.DAMPING_NS_M * velocity + bus_log.STIFFNESS_N_M * (z - bus_log.REST_M)
        velocity += bus_log.STEP_S / bus_log.MASS_KG * (force(ms) - held)
        z += bus_log.STEP_S * velocity
        log.sent_ns["DEVICE_STATE"].append(ms * MS)
        if ms not in touch_gap:
            log.sent_ns["TOUCH_MODEL"].append(ms * MS)
        if ms % 20 == 0:
            log.command_degC.append((ms * MS, command(ms)))
    return log


def violations(process, log, sound=None):
    return judge.Judge(process, log, [(500 * MS, 505 * MS), FREEZE, (3500 * MS, 3505 * MS)], sound).judge().violations


class Freezes(unittest.TestCase):
    def test_the_force_is_computed_from_the_motion(self):
        forces = bus_log.exerted(log_of(promised_force).states)
        for f in forces:
            self.assertAlmostEqual(f.force_N, promised_force(f.sent_ns // MS), places=6)

    def test_outputs_that_keep_all_promises_have_no_violation(self):
        self.assertEqual(violations("sim_node", log_of(promised_force)), [])

    def test_a_force_that_remains_is_found(self):
        found = violations("sim_node", log_of(lambda ms: RESTING_N if 2200 < ms < 2210 else promised_force(ms)))
        self.assertTrue(any("remain" in v for v in found), found)

    def test_a_return_without_a_fade_is_found(self):
        found = violations("sim_node", log_of(lambda ms: min(7.9, 1.9 * (ms - 2504)) if 2505 <= ms < 2600 else promised_force(ms)))
        self.assertTrue(any("faster than its fade" in v for v in found), found)

    def test_a_step_and_a_force_beyond_its_limit_are_found(self):
        found = violations("sync_node", log_of(lambda ms: 9.0 if 3000 <= ms < 3100 else RESTING_N, touch_gap=()))
        self.assertTrue(any("rises by" in v for v in found), found)
        self.assertTrue(any("force of 9.00 N" in v for v in found), found)

    def test_a_force_that_does_not_return_is_found(self):
        found = violations("sim_node", log_of(lambda ms: promised_force(ms) if ms < 2505 else 0.0))
        self.assertTrue(any("not return" in v for v in found), found)

    def test_a_command_that_stays_cold_is_found(self):
        promised = lambda ms: 20.0 if ms < 2060 or ms > 2500 else min(33.0, 20 + 20 * (ms - 2060) * 1e-3)
        self.assertEqual(violations("sim_node", log_of(promised_force, promised)), [])
        found = violations("sim_node", log_of(promised_force, lambda ms: 20.0))
        self.assertTrue(any("behind its return" in v for v in found), found)

    def test_a_pause_of_another_process_is_found(self):
        found = violations("audio_node", log_of(lambda ms: RESTING_N))
        self.assertTrue(any(v.startswith("audio_node: TOUCH_MODEL has 1 messages during the stops") for v in found), found)

    def test_a_step_of_sound_after_an_interruption_is_found(self):
        for first, wrong in ((0.0, False), (0.5, True)):
            samples = memoryview(struct.pack("<2000f", *[first + min(max(0, i - 100) / 2000, 0.4) for i in range(2000)])).cast("f")
            log = log_of(lambda ms: RESTING_N, touch_gap=())
            log.sound_clock.append((100, 0, judge.UNDERFLOW))
            self.assertEqual(any("with a step" in v for v in violations("audio_node", log, (48000, 1, samples))), wrong)

    def test_messages_are_read_from_a_log(self):
        header = struct.pack(">qqqiqiqq", 1, -1, 7 * MS, 4711, 7, 5, 9, 3)
        name = struct.pack(">i", 4) + b"arm\0"
        state = header + name + struct.pack(">7d6fib", 0, 0, 0.25, 1, 0, 0, 0, 0, 0, -0.5, 0, 0, 0, 0, 0)
        thermal = header + struct.pack(">ii5fb", 0, 1, 0, 0, 0, 30, 21.5, 0)
        with tempfile.TemporaryDirectory() as folder:
            with open(pathlib.Path(folder) / "run.lcmlog", "wb") as file:
                for channel, data in (("DEVICE_STATE", state), ("THERMAL_STATE", thermal), ("SCENE", b"x")):
                    file.write(struct.pack(">IqqII", bus_log.EVENT_SYNC, 0, 0, len(channel), len(data)) + channel.encode() + data)
            log = bus_log.read(folder)
        self.assertEqual(log.states, [bus_log.DriverState(7 * MS, 3, 0.25, -0.5)])
        self.assertEqual(log.command_degC, [(7 * MS, 21.5)])


if __name__ == "__main__":
    unittest.main()
