#!/usr/bin/env python3
"""Mouse, gamepad or 3D mouse as a device without force: a wand for the spot light, a head for the view, or a hand without force
feedback. Beside it: haptic_node --tool TOOL --device external:NAME

  lcm-gen -p --ppath TYPES lcmtypes/types/*/*.lcm             once
  PYTHONPATH=TYPES inputs.py mouse /dev/input/event5 --name wand
  PYTHONPATH=TYPES inputs.py gamepad /dev/input/event7
  PYTHONPATH=TYPES inputs.py spacenav                 a 3D mouse, by spacenavd

Mouse: to the right is -y, away is +x, the wheel is z. Gamepad: the left stick moves in x and y, the right one up and down. 3D
mouse: pushing it moves the tool, twisting it rotates the tool. A missing source is tried again every second; meanwhile the state of
the device is LOST.
"""
import argparse
import fcntl
import math
import os
import select
import socket
import struct
import sys
import time

PERIOD_S = 0.004
TRY_AGAIN_S = 1.0
# design: a mouse with 1000 counts per inch moves the wand five times as far as the hand; a notch of the wheel 1 cm.
MOUSE_M, WHEEL_M = 5 * 0.0254 / 1000, 0.01
FASTEST_M_S = 10  # design: half of the speed that haptic_node accepts; a mouse may be flicked
STICK_M_S = 0.3  # design: an unhurried hand
DEAD = 0.1  # design: noise of a stick at rest
# design: spacenavd reports about 350 at full push by default: 0.3 m/s and a quarter turn per second.
PUSH_M_S, TURN_RAD_S = 0.3 / 350, 1.57 / 350
# spacenavd reports motion about 60 times per second and once when it ends. An older report has expired (design: three periods).
MOTION_S = 0.05


class Pose:
    """Position in m within a box about the origin, orientation as a unit quaternion (w, x, y, z), velocity in m/s."""

    def __init__(self, half_m):
        self.half_m, self.position, self.turn = half_m, [0.0] * 3, (1.0, 0.0, 0.0, 0.0)
        self.velocity, self.buttons = [0.0] * 3, 0

    def move(self, by, dt):
        far = math.sqrt(sum(b * b for b in by)) / (FASTEST_M_S * dt)
        by = [b / max(1, far) for b in by]
        for i in range(3):
            to = min(self.half_m, max(-self.half_m, self.position[i] + by[i]))
            self.velocity[i] = (to - self.position[i]) / dt
            self.position[i] = to

    def rotate(self, by):
        angle = math.sqrt(sum(a * a for a in by))
        if angle == 0:
            return
        s = math.sin(angle / 2) / angle
        a, b = (math.cos(angle / 2), by[0] * s, by[1] * s, by[2] * s), self.turn
        product = (a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                   a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0])
        norm = math.sqrt(sum(q * q for q in product))
        self.turn = tuple(q / norm for q in product)

    def press(self, button, down):
        if 0 <= button < 31:
            self.buttons = self.buttons | 1 << button if down else self.buttons & ~(1 << button)


class Evdev:
    """Events of a mouse or a gamepad from Linux: struct input_event of linux/input.h."""
    EVENT = struct.Struct("@llHHi")
    KEY, REL, ABS = 1, 2, 3
    FIRST_BUTTONS = (0x110, 0x130)  # BTN_LEFT, BTN_SOUTH
    WHEEL = 8

    def __init__(self, path):
        self.file = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
        self.left, self.sticks, self.ranges = b"", {}, {}

    def range_of(self, axis):
        """(minimum, maximum) of an axis by EVIOCGABS; the values of a common gamepad if the source is no device."""
        if axis not in self.ranges:
            try:
                info = fcntl.ioctl(self.file, 2 << 30 | 24 << 16 | 0x45 << 8 | 0x40 + axis, bytes(24))
                self.ranges[axis] = struct.unpack("6i", info)[1:3]
            except OSError:
                self.ranges[axis] = (-32768, 32767)
        return self.ranges[axis]

    def stick(self, axis):
        least, most = self.range_of(axis)
        if axis not in self.sticks or most <= least:
            return 0.0
        value = 2 * (self.sticks[axis] - least) / (most - least) - 1
        return 0.0 if abs(value) < DEAD else max(-1.0, min(1.0, value))

    def step(self, pose, dt):
        """False when the source has ended."""
        by = [0.0] * 3
        while select.select([self.file], [], [], 0)[0]:
            data = os.read(self.file, 64 * self.EVENT.size)
            if not data:
                return False
            data = self.left + data
            whole = len(data) - len(data) % self.EVENT.size
            self.left = data[whole:]
            for _, _, kind, code, value in self.EVENT.iter_unpack(data[:whole]):
                if kind == self.REL and code in (0, 1, self.WHEEL):
                    by[{0: 1, 1: 0, self.WHEEL: 2}[code]] += value * (WHEEL_M if code == self.WHEEL else -MOUSE_M)
                elif kind == self.ABS:
                    self.sticks[code] = value
                elif kind == self.KEY and value < 2:  # value 2: held down (repeated)
                    for first in self.FIRST_BUTTONS:
                        if first <= code < first + 0x10:
                            pose.press(code - first, value)
        for axis, stick in ((0, 1), (1, 0), (2, 4)):  # forward, to the right, up: sticks read positive down and right
            by[axis] -= STICK_M_S * dt * self.stick(stick)
        pose.move(by, dt)
        return True

    def close(self):
        os.close(self.file)


class Spacenav:
    """Events of a 3D mouse from its daemon: eight numbers per event on a socket, as libspnav 1.0 reads them (protocol 0). Its axes
    x, y, z (right, up, to the back) become -y, z, -x; reversed axes are corrected in /etc/spnavrc."""
    EVENT = struct.Struct("@8i")
    MOTION, PRESS, RELEASE = 0, 1, 2

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            self.socket.connect(path)
        except OSError:
            self.socket.close()
            raise
        self.left, self.push, self.good_s = b"", (0,) * 6, 0.0

    def step(self, pose, dt):
        """False when the daemon has ended."""
        while select.select([self.socket], [], [], 0)[0]:
            data = self.socket.recv(64 * self.EVENT.size)
            if not data:
                return False
            data = self.left + data
            whole = len(data) - len(data) % self.EVENT.size
            self.left = data[whole:]
            for kind, *rest in self.EVENT.iter_unpack(data[:whole]):
                if kind == self.MOTION:
                    self.push, self.good_s = rest[:6], MOTION_S
                elif kind in (self.PRESS, self.RELEASE):
                    pose.press(rest[0], kind == self.PRESS)
        x, y, z, rx, ry, rz = self.push if self.good_s > 0 else (0,) * 6
        self.good_s -= dt
        pose.move([a * PUSH_M_S * dt for a in (-z, -x, y)], dt)
        pose.rotate([a * TURN_RAD_S * dt for a in (-rz, -rx, ry)])
        return True

    def close(self):
        self.socket.close()


def opened(kind, path):
    """The open source; None when it is missing."""
    try:
        return Spacenav(path) if kind == "spacenav" else Evdev(path)
    except OSError:
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=["mouse", "gamepad", "spacenav"])
    parser.add_argument("source", nargs="?", help="for mouse and gamepad: /dev/input/eventN; for spacenav: the socket of its daemon")
    parser.add_argument("--name", default="wand")
    parser.add_argument("--half", type=float, default=0.5, help="range to each side of its origin, m")
    parser.add_argument("--group", default=os.environ.get("TACTUS_GROUP", "239.255.76.67"))
    parser.add_argument("--port", type=int, default=int(os.environ.get("TACTUS_PORT", "7667")))
    parser.add_argument("--run-id", type=int, default=int(os.environ.get("TACTUS_RUN_ID", "1")))
    options = parser.parse_args()
    path = options.source or ("/var/run/spnav.sock" if options.kind == "spacenav" else None)
    if path is None:
        sys.exit(f"inputs.py: name the {options.kind}'s source, e.g. /dev/input/event5; /proc/bus/input/devices lists them")
    from driver import Bus, first_state  # needs the generated types
    bus, state, pose = Bus(options.group, options.port), first_state(options.name, options.run_id), Pose(options.half)
    source, tried = None, -math.inf
    tick = time.monotonic()
    while True:
        tick = max(tick + PERIOD_S, time.monotonic())  # ticks that were missed are not made up for
        time.sleep(max(0.0, tick - time.monotonic()))
        if source is None and tick - tried > TRY_AGAIN_S:
            source, tried = opened(options.kind, path), tick
        try:
            is_connected = source is not None and source.step(pose, PERIOD_S)
        except OSError:  # unplugged
            is_connected = False
        if source is not None and not is_connected:
            source.close()
            source = None
        state.state = state.ANSWERS if is_connected else state.LOST
        for axis, i in (("x", 0), ("y", 1), ("z", 2)):
            setattr(state.pose.position_m, axis, pose.position[i])
            setattr(state.velocity_m_s, axis, pose.velocity[i] if is_connected else 0.0)
            setattr(state.pose.orientation, axis, pose.turn[i + 1])
        state.pose.orientation.w = pose.turn[0]
        state.buttons = pose.buttons
        state.header.publish_time_ns = time.monotonic_ns()
        bus.publish("DEVICE_STATE", state.encode())
        state.header.seq += 1


if __name__ == "__main__":
    main()
