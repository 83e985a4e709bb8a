"""Tests of the mouse, gamepad and 3D mouse of the example driver: their events become a pose and buttons. A pipe and a socket
replace the device files of the kernel and the socket of the daemon."""
import math
import os
import socket
import struct
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "device_driver"))
import inputs  # noqa: E402

DT = 0.004
KEY, REL, ABS = 1, 2, 3


def event(kind, code, value):
    return struct.pack("@llHHi", 0, 0, kind, code, value)


class Piped(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        path = os.path.join(self.folder.name, "event0")
        os.mkfifo(path)
        self.source = inputs.Evdev(path)
        self.addCleanup(self.source.close)
        self.device = os.open(path, os.O_WRONLY)
        self.pose = inputs.Pose(0.5)

    def send(self, *events):
        os.write(self.device, b"".join(events))
        self.assertTrue(self.source.step(self.pose, DT))

    def tearDown(self):
        if self.device is not None:
            os.close(self.device)


class Mouse(Piped):
    def test_moves_to_the_right_away_and_up(self):
        self.send(event(REL, 0, 100))
        self.assertAlmostEqual(self.pose.position[1], -100 * inputs.MOUSE_M)
        self.assertAlmostEqual(self.pose.velocity[1], -100 * inputs.MOUSE_M / DT)
        self.send(event(REL, 1, -200), event(REL, 8, 1))  # away from the person counts down
        self.assertAlmostEqual(self.pose.position[0], 200 * inputs.MOUSE_M)
        self.assertAlmostEqual(self.pose.position[2], inputs.WHEEL_M)
        self.send()
        self.assertEqual(self.pose.velocity, [0, 0, 0])

    def test_stays_within_its_box(self):
        for _ in range(100):
            self.send(event(REL, 0, 10000))
        self.assertEqual(self.pose.position[1], -0.5)
        self.assertEqual(self.pose.velocity[1], 0)

    def test_the_speed_is_limited_when_flicked(self):
        self.send(event(REL, 0, -3000), event(REL, 1, -3000))
        self.assertAlmostEqual(math.hypot(*self.pose.velocity), inputs.FASTEST_M_S)

    def test_buttons_are_held(self):
        self.send(event(KEY, 0x110, 1), event(KEY, 0x112, 1))
        self.assertEqual(self.pose.buttons, 0b101)
        self.send(event(KEY, 0x110, 2), event(KEY, 0x112, 0))
        self.assertEqual(self.pose.buttons, 0b001)

    def test_reading_resumes_in_the_middle_of_an_event(self):
        both = event(REL, 0, 10) + event(REL, 0, 20)
        self.send(both[:30])
        self.assertAlmostEqual(self.pose.position[1], -10 * inputs.MOUSE_M)
        self.send(both[30:])
        self.assertAlmostEqual(self.pose.position[1], -30 * inputs.MOUSE_M)

    def test_an_unplugged_device_is_reported(self):
        os.close(self.device)
        self.device = None
        self.assertFalse(self.source.step(self.pose, DT))


class Gamepad(Piped):
    def test_moves_as_long_as_a_stick_is_held(self):
        self.send(event(ABS, 1, -32768))  # forward
        for _ in range(249):
            self.send()
        self.assertAlmostEqual(self.pose.position[0], inputs.STICK_M_S, delta=1e-6)
        self.send(event(ABS, 1, 0), event(ABS, 4, -32768))
        self.assertAlmostEqual(self.pose.velocity[0], 0, delta=1e-9)
        self.assertAlmostEqual(self.pose.velocity[2], inputs.STICK_M_S, delta=1e-9)

    def test_ignores_the_offset_of_a_stick_at_rest(self):
        self.send(event(ABS, 0, 2000), event(ABS, 1, -2000))
        self.assertEqual(self.pose.position, [0, 0, 0])

    def test_has_buttons(self):
        self.send(event(KEY, 0x131, 1))
        self.assertEqual(self.pose.buttons, 0b10)


class SpaceMouse(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = os.path.join(folder.name, "spnav.sock")
        server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.addCleanup(server.close)
        self.assertIsNone(inputs.opened("spacenav", path))  # no daemon
        server.bind(path)
        server.listen()
        self.source = inputs.opened("spacenav", path)
        self.addCleanup(self.source.close)
        self.daemon = server.accept()[0]
        self.addCleanup(self.daemon.close)
        self.pose = inputs.Pose(0.5)

    def send(self, *numbers):
        self.daemon.sendall(struct.pack("@8i", *numbers))
        self.assertTrue(self.source.step(self.pose, DT))

    def test_moves_while_it_is_pushed_and_no_longer(self):
        self.send(0, 0, 350, 0, 0, 0, 0, 16)  # up
        self.assertAlmostEqual(self.pose.velocity[2], 0.3)
        for _ in range(100):  # the daemon says no more
            self.source.step(self.pose, DT)
        self.assertEqual(self.pose.velocity, [0, 0, 0])
        self.assertLess(self.pose.position[2], 0.3 * (inputs.MOTION_S + 2 * DT))

    def test_turns_by_its_twist_and_stays_a_rotation(self):
        for _ in range(250):
            self.send(0, 0, 0, 0, 0, 350, 0, 16)  # about up
        angle = 2 * math.acos(self.pose.turn[0])
        self.assertAlmostEqual(angle, 1.57, delta=1e-6)
        self.assertGreater(self.pose.turn[3], 0.7)
        self.assertAlmostEqual(sum(q * q for q in self.pose.turn), 1)

    def test_has_buttons(self):
        self.send(1, 1, 0, 0, 0, 0, 0, 0)
        self.assertEqual(self.pose.buttons, 0b10)
        self.send(2, 1, 0, 0, 0, 0, 0, 0)
        self.assertEqual(self.pose.buttons, 0)

    def test_an_ended_daemon_is_reported(self):
        self.daemon.close()
        self.assertFalse(self.source.step(self.pose, DT))


if __name__ == "__main__":
    unittest.main()
