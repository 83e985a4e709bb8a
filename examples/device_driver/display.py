#!/usr/bin/env python3
"""Driver in Python of a thermal display: it brings a plate on the skin to the commanded temperature, and publishes the measured one.

  lcm-gen -p --ppath TYPES lcmtypes/types/*/*.lcm                  once
  PYTHONPATH=TYPES display.py [TOOL [FILE [GROUP [PORT [RUN]]]]]   and beside it: thermal_node --set device=external

It receives THERMAL_STATE of the tool with index TOOL (default: 0), and publishes THERMAL_DEVICE ten times per second, within the limits of
guards.py. FILE (default: display.dose) keeps the exposure of the person across restarts. The plate here is simulated, with a time constant
of a second; for a real display replace Plate.
"""
import dataclasses
import json
import os
import pathlib
import random
import sys
import time

import guards

PERIOD_S = 0.1
FULL = guards.SkinAccount(float("inf"), float("inf"), True, True)  # of a person whose exposure is unknown


class Plate:
    """Simulated plate; replace it for a real display."""

    def __init__(self):
        self.degC = 33.0

    def step(self, wanted_degC, dt):
        """wanted_degC: None switches the current off."""
        self.degC += ((25.0 if wanted_degC is None else wanted_degC) - self.degC) * min(1.0, dt)
        return self.degC


class Exposure:
    """The exposure of the person in a file of this user. Times are time.time()."""

    def __init__(self, path):
        self.path = pathlib.Path(path)

    def load(self, now):
        """(account, seconds since then). No file: no exposure; a file that cannot be believed: a full one."""
        try:
            found = os.stat(self.path)
            stored = json.loads(self.path.read_text(encoding="utf-8"))
            if found.st_uid != os.geteuid() or found.st_mode & 0o022:
                raise ValueError
            return guards.SkinAccount(*(float(stored[name]) for name in ("dose_s", "cold_s")), bool(stored["too_warm"]), bool(stored["too_cold"])), \
                max(0.0, now - float(stored["at"]))
        except FileNotFoundError:
            return guards.SkinAccount(), 0.0
        except (OSError, ValueError, KeyError, TypeError):
            return FULL, 0.0

    def save(self, account, now):
        part = self.path.with_name(self.path.name + ".new")
        with open(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w", encoding="utf-8") as file:
            json.dump({**dataclasses.asdict(account), "at": now}, file)
        os.replace(part, self.path)


def first_reading(tool, run):
    from tactus import header_t, thermal_device_t
    reading = thermal_device_t()
    reading.header = header_t()
    reading.header.sim_time_ns = -1
    reading.header.run_id = run
    reading.header.incarnation = random.SystemRandom().randrange(1, 2**63)  # a new number at every start
    reading.tool = tool
    return reading


def main():
    if sys.argv[1:] and sys.argv[1].startswith("-"):
        print(__doc__)
        sys.exit(0 if sys.argv[1] == "--help" else 1)
    from driver import BUS, Bus
    from tactus import thermal_device_t, thermal_state_t
    usual = ["0", "display.dose", *(os.environ.get(variable, default) for variable, default in BUS)]
    tool, path, group, port, run = (sys.argv[1:] + usual[len(sys.argv) - 1:])[:5]
    bus, plate, exposure, reading = Bus(group, int(port)), Plate(), Exposure(path), first_reading(int(tool), int(run))
    guard = guards.TemperatureGuard(sender=guards.SenderLimits(run=int(run)))
    guard.resume(*exposure.load(time.time()))
    wanted_degC, tick = guard.out_degC, time.monotonic()
    while True:
        tick = max(tick + PERIOD_S, time.monotonic())  # ticks that were missed are not made up for
        time.sleep(max(0.0, tick - time.monotonic()))
        for data in bus.received("THERMAL_STATE"):
            try:
                message = thermal_state_t.decode(data)
            except ValueError:  # a message of another type
                continue
            if message.tool == reading.tool:
                guard.on_message(guards.Sent.of(message.header), message.commanded_degC, time.monotonic_ns())
        reading.plate_degC = plate.step(None if guard.off else wanted_degC, PERIOD_S)
        wanted_degC = guard.update(time.monotonic_ns(), reading.plate_degC)
        exposure.save(guard.account(), time.time())
        reading.state = thermal_device_t.FAULT if guard.off else thermal_device_t.LIMITED if guard.reason else thermal_device_t.OK
        reading.header.publish_time_ns = time.monotonic_ns()
        bus.publish("THERMAL_DEVICE", reading.encode())
        reading.header.seq += 1


if __name__ == "__main__":
    main()
