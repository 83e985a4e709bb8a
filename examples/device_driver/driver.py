#!/usr/bin/env python3
"""Driver in Python of a device without code in haptic_node: it publishes the pose of the device and exerts the force.

  lcm-gen -p --ppath TYPES lcmtypes/types/*/*.lcm             once
  PYTHONPATH=TYPES driver.py [NAME [GROUP [PORT [RUN]]]]     and beside it: haptic_node --device external:NAME

It publishes DEVICE_STATE 250 times per second and receives DEVICE_FORCE, within the limits of guards.py; the force is 0 when no new
message arrives in time. The hardware here is a weight of 0.1 kg that a spring and a damper hold 5 mm below the level of a floor; for a real device replace Hardware.
"""
import os
import random
import select
import socket
import struct
import sys
import time

import guards
from tactus import device_force_t, device_state_t, header_t, pose_t, quat_t, vec3_t, vec3f_t

PERIOD_S = 0.004
# Group, port and number of the run: the variables that tactus attach sets, and the defaults.
BUS = (("TACTUS_GROUP", "239.255.76.67"), ("TACTUS_PORT", "7667"), ("TACTUS_RUN_ID", "1"))


class Bus:
    """The part of LCM that a driver needs, so that LCM's Python module is not required. With the module: lcm.LCM(url) and its
    publish and subscribe. A small message is one datagram: "LC02", a sequence number, the channel, 0, the message."""

    SMALL = 0x4C433032
    MOST = 100  # datagrams read at a time, so that a flood does not hold the loop

    def __init__(self, group, port):
        self.to = (group, port)
        self.sequence = 0
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)  # messages stay on this machine
        self.socket.bind(("", port))
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                               socket.inet_aton(group) + socket.inet_aton("0.0.0.0"))

    def publish(self, channel, data):
        self.socket.sendto(struct.pack(">II", self.SMALL, self.sequence) + channel.encode() + b"\0" + data, self.to)
        self.sequence = (self.sequence + 1) & 0xFFFFFFFF

    def received(self, channel):
        """The messages of a channel that have arrived, from at most MOST datagrams; does not wait."""
        for _ in range(self.MOST):
            if not select.select([self.socket], [], [], 0)[0]:
                return
            datagram = self.socket.recv(65536)
            name, found, data = datagram[8:].partition(b"\0")
            if datagram[:4] == struct.pack(">I", self.SMALL) and found and name == channel.encode():
                yield data


class Hardware:
    """Simulated hardware; replace it for a real device. Along z only, in m, m/s, N."""
    MASS_KG, DAMPING_NS_M, STIFFNESS_N_M, REST_M = 0.1, 10, 300, -0.005

    def __init__(self):
        self.z, self.velocity = 0.05, 0.0

    def step(self, force_n, dt):
        for _ in range(4):  # a stiff spring needs small steps
            pull = self.DAMPING_NS_M * self.velocity + self.STIFFNESS_N_M * (self.z - self.REST_M)
            self.velocity += dt / 4 / self.MASS_KG * (force_n - pull)
            self.z += dt / 4 * self.velocity


def first_state(name, run):
    state = device_state_t()
    state.device = name
    state.header = header_t()
    state.header.sim_time_ns = -1
    state.header.run_id = run
    state.header.incarnation = random.SystemRandom().randrange(1, 2**63)  # a new number at every start
    state.pose = pose_t()
    state.pose.position_m, state.pose.orientation = vec3_t(), quat_t()
    state.pose.orientation.w = 1.0
    state.velocity_m_s = vec3f_t()
    state.state = device_state_t.ANSWERS
    return state


def vector(v):
    return v.x, v.y, v.z


def main():
    if sys.argv[1:] and sys.argv[1].startswith("-"):
        print(__doc__)
        sys.exit(0 if sys.argv[1] == "--help" else 1)
    usual = ["arm", *(os.environ.get(variable, default) for variable, default in BUS)]
    name, group, port, run = (sys.argv[1:] + usual[len(sys.argv) - 1:])[:4]
    bus, hardware, state = Bus(group, int(port)), Hardware(), first_state(name, int(run))
    guard, reported = guards.ForceGuard(sender=guards.SenderLimits(run=int(run))), ""
    tick = time.monotonic()
    while True:
        tick = max(tick + PERIOD_S, time.monotonic())  # ticks that were missed are not made up for
        time.sleep(max(0.0, tick - time.monotonic()))
        for data in bus.received("DEVICE_FORCE"):
            try:
                message = device_force_t.decode(data)
            except ValueError:  # a message of another type
                continue
            if message.device == name:
                guard.on_message(guards.Sent.of(message.header), vector(message.force_N), vector(message.torque_N_m),
                                 message.valid_for_ns, time.monotonic_ns())
        out = guard.update(time.monotonic_ns(), (0.0, 0.0, hardware.velocity))
        if out.reason != reported and out.reason == "second sender":
            print(f"driver.py: two programs send DEVICE_FORCE for {name}, so its force is zero; end one of them", file=sys.stderr)
        reported = out.reason
        hardware.step(out.force[2], PERIOD_S)
        state.pose.position_m.z, state.velocity_m_s.z = hardware.z, hardware.velocity
        state.header.publish_time_ns = time.monotonic_ns()
        bus.publish("DEVICE_STATE", state.encode())
        state.header.seq += 1


if __name__ == "__main__":
    main()
