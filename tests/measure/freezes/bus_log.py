"""The outputs of a cluster in its log: the force that the driver of a device exerts, temperatures, sound clock, gaps."""
import collections
import dataclasses
import pathlib
import struct

from tactus.refusal import Refusal

EVENT_SYNC = 0xEDA1DA01
HEADER = struct.Struct(">qqiqiqq")  # header_t: sim time, publish time, clock, run, source, incarnation, seq
BODY = 8 + HEADER.size  # after the fingerprint
# Simulated hardware of examples/device_driver/driver.cpp, which is the truth here.
MASS_KG, DAMPING_NS_M, STIFFNESS_N_M, REST_M, STEP_S = 0.1, 10.0, 300.0, -0.005, 1e-3
# Outputs with a constant rate: channel, its process.
OUTPUTS = {"TOUCH_MODEL": "sim_node", "DEVICE_FORCE": "haptic_node", "DEVICE_STATE": "arm_driver", "THERMAL_STATE": "thermal_node",
           "THERMAL_DEVICE": "thermal_device"}


@dataclasses.dataclass
class DriverState:
    """One DEVICE_STATE."""
    sent_ns: int
    seq: int
    z_m: float
    velocity_m_s: float


@dataclasses.dataclass
class Exerted:
    """The force that a driver commanded in one tick: after the message at `after_ns`, and before its own at `sent_ns`."""
    after_ns: int
    sent_ns: int
    force_N: float


@dataclasses.dataclass
class BusLog:
    states: list = dataclasses.field(default_factory=list)
    commanded_N: list = dataclasses.field(default_factory=list)  # (sent_ns, N) of DEVICE_FORCE
    command_degC: list = dataclasses.field(default_factory=list)  # (sent_ns, degC) of THERMAL_STATE
    plate_degC: list = dataclasses.field(default_factory=list)  # (sent_ns, degC) of THERMAL_DEVICE
    sound_clock: list = dataclasses.field(default_factory=list)  # (index, host_ns, reason) of MEDIA_CLOCK of audio.wav
    sent_ns: dict = dataclasses.field(default_factory=lambda: collections.defaultdict(list))  # {output or health of a process: times}


def events(path):
    """(channel, data) of each complete event of an LCM log."""
    data = pathlib.Path(path).read_bytes()
    at = 0
    while at + 28 <= len(data):
        sync, _, _, channel, size = struct.unpack_from(">IqqII", data, at)
        if sync != EVENT_SYNC or at + 28 + channel + size > len(data):
            return
        yield data[at + 28:at + 28 + channel].decode("ascii", "replace"), data[at + 28 + channel:at + 28 + channel + size]
        at += 28 + channel + size


def text_at(data, at):
    """(string, offset after it)."""
    size = struct.unpack_from(">i", data, at)[0]
    return data[at + 4:at + 3 + size].decode("ascii", "replace"), at + 4 + size


def add(log, channel, data):
    _, sent_ns, _, _, _, _, seq = HEADER.unpack_from(data, 8)
    if channel == "TOUCH_MODEL":
        tool = struct.unpack_from(">i", data, BODY + 24)[0]  # after sim_clock_t
        if tool != 0:
            return
    if channel == "DEVICE_STATE":
        _, at = text_at(data, BODY)
        z = struct.unpack_from(">3d", data, at)[2]
        velocity = struct.unpack_from(">3f", data, at + 56)[2]
        log.states.append(DriverState(sent_ns, seq, z, velocity))
    elif channel == "DEVICE_FORCE":
        _, at = text_at(data, BODY)
        x, y, z = struct.unpack_from(">3f", data, at)
        log.commanded_N.append((sent_ns, (x * x + y * y + z * z) ** 0.5))
    elif channel == "THERMAL_STATE":
        log.command_degC.append((sent_ns, struct.unpack_from(">f", data, BODY + 24)[0]))
    elif channel == "THERMAL_DEVICE":
        log.plate_degC.append((sent_ns, struct.unpack_from(">f", data, BODY + 4)[0]))
    elif channel == "MEDIA_CLOCK":
        medium, at = text_at(data, BODY)
        if medium == "audio.wav":
            log.sound_clock.append(struct.unpack_from(">qqb", data, at))
    if channel in OUTPUTS:
        log.sent_ns[channel].append(sent_ns)
    elif channel == "NODE_HEALTH":
        log.sent_ns[text_at(data, BODY)[0]].append(sent_ns)


def read(folder, *more):
    """The outputs in the logs of these folders. Raises Refusal."""
    log = BusLog()
    for place in (folder, *more):
        paths = sorted(pathlib.Path(place).glob("run*.lcmlog"))
        if not paths:
            raise Refusal(f"{place} holds no log; see the log of its recorder")
        wanted = {*OUTPUTS, "MEDIA_CLOCK", "NODE_HEALTH"}
        if place != folder:  # messages that a relay carried are in both
            wanted = {"THERMAL_DEVICE", "MEDIA_CLOCK"}
        for path in paths:
            for channel, data in events(path):
                if channel in wanted and len(data) >= BODY:
                    add(log, channel, data)
    return log


def exerted(states):
    """The force of each tick, from the motion of the weight between two states of adjacent numbers."""
    forces = []
    for before, state, following in zip(states, states[1:], states[2:]):
        if not before.seq + 2 == state.seq + 1 == following.seq:
            continue
        held = DAMPING_NS_M * state.velocity_m_s + STIFFNESS_N_M * (state.z_m - REST_M)
        forces.append(Exerted(before.sent_ns, state.sent_ns, MASS_KG / STEP_S * (following.velocity_m_s - state.velocity_m_s) + held))
    return forces
