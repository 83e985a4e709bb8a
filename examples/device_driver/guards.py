"""Limits of the last program before a device: copy this file into your driver. It needs only the standard library. Times are
CLOCK_MONOTONIC of this machine in ns (time.monotonic_ns()), as arguments. guards.h holds the same classes in C++.

  OneSender         which messages are commands: one sender at a time, new, not late, not ahead of the clock
  ForceGuard        force and torque for the motors, for any message and after any gap
  TemperatureGuard  temperature for a plate on the skin, likewise

Call update() on every tick of the driver and command only its result. A reason is "" for a command, otherwise one of: other run, old,
ahead, repeated, second sender, not finite, no command, stopped, no motion, energy.
"""
import dataclasses
import math

ZERO = (0.0, 0.0, 0.0)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def times(factor, vector):
    return tuple(factor * x for x in vector)


def finite(vector):
    return all(math.isfinite(x) for x in vector)


def clamp(x, low, high):
    return min(max(x, low), high)


@dataclasses.dataclass(frozen=True)
class Sent:
    """From the header of a message (header_t)."""
    run: int
    incarnation: int
    seq: int
    sent_ns: int

    @classmethod
    def of(cls, header):
        return cls(header.run_id, header.incarnation, header.seq, header.publish_time_ns)


@dataclasses.dataclass(frozen=True)
class SenderLimits:
    run: int = 1  # number of the cluster run; messages of other runs are ignored
    # False: the sender has another clock. Then the age is measured against the fastest message, with 200 ppm of drift.
    same_clock: bool = True
    max_age_s: float = 0.05  # design: as old as a lost device may be (device_stale_after)
    max_ahead_s: float = 0.002  # design: a clock read twice never differs by more
    silence_s: float = 0.3  # a sender that is silent for this time has ended; then the next one is followed


class OneSender:
    """Follows one incarnation of one run. While a second one sends, no message is a command."""
    DRIFT = 2e-4  # between quartz clocks, twice the 100 ppm of a poor one (design)

    def __init__(self, limits):
        self.limits = limits
        self.followed, self.heard_ns = None, 0
        self.second_ns = None  # newest message of a second sender
        self.fastest_s = None  # smallest delay, of another clock

    def check(self, sent, now_ns):
        """Returns "" when the message is a command, otherwise the reason."""
        if sent.run != self.limits.run:
            return "other run"
        same = self.followed is not None and sent.incarnation == self.followed.incarnation
        if self.followed is not None and not same and now_ns - self.heard_ns < self.limits.silence_s * 1e9:
            self.second_ns = now_ns
            return "second sender"
        if same and sent.seq <= self.followed.seq:
            return "repeated"
        # A forged number far ahead would make every later message a repeated one. Design: 1000, and 10 kHz of lost messages.
        if same and sent.seq - self.followed.seq > 1000 + 1e-5 * (now_ns - self.heard_ns):
            return "ahead"
        if not same:
            self.fastest_s = None
        late = self.check_age(sent.sent_ns, now_ns)
        if late:
            return late
        if not same:
            self.second_ns = None
        self.followed, self.heard_ns = sent, now_ns
        return "second sender" if self.conflict(now_ns) else ""

    def conflict(self, now_ns):
        """True while two senders speak, and for silence_s after."""
        return self.second_ns is not None and now_ns - self.second_ns < self.limits.silence_s * 1e9

    def check_age(self, sent_ns, now_ns):
        delay_s = (now_ns - sent_ns) * 1e-9
        if self.limits.same_clock:
            fastest_s = 0.0
        else:
            fastest_s = delay_s if self.fastest_s is None else self.fastest_s
        if delay_s - fastest_s > self.limits.max_age_s:
            return "old"
        if fastest_s - delay_s > self.limits.max_ahead_s:
            return "ahead"
        if self.fastest_s is not None:
            fastest_s += self.DRIFT * (now_ns - self.heard_ns) * 1e-9
        self.fastest_s = min(fastest_s, delay_s)
        return ""


@dataclasses.dataclass(frozen=True)
class ForceLimits:
    """Defaults as in haptic_node/settings.csv, which names their sources. Lower them to the ratings of your device."""
    force_N: float = 8.0
    slew_N_s: float = 2000.0
    torque_N_m: float = 0.3
    torque_slew_N_m_s: float = 75.0
    energy_J: float = 0.49  # given to the hand at once
    power_W: float = 1.0  # given to the hand without end
    valid_s: float = 0.1  # longest validity of a command, for any message
    fade_s: float = 0.02  # from any force to zero, and back


@dataclasses.dataclass
class Exerted:
    """Force in N and torque in N m on the hand, axes of the world; reason: why they are limited, or ""."""
    force: tuple = ZERO
    torque: tuple = ZERO
    reason: str = ""


class ForceGuard:
    def __init__(self, limits=ForceLimits(), sender=SenderLimits()):
        self.limits, self.sender = limits, OneSender(sender)
        self.tank_J, self.gate = limits.energy_J, 0.0
        self.force, self.torque, self.until_ns, self.last_ns = ZERO, ZERO, None, None
        self.out = Exerted()

    def on_message(self, sent, force, torque, valid_ns, now_ns):
        """A message for this device arrived. Returns "", or why it is no command; the command before remains until its time is over."""
        reason = self.sender.check(sent, now_ns)
        if reason:
            return reason
        if not finite(force) or not finite(torque):
            return "not finite"
        if valid_ns <= 0:
            return "no command"
        # By one factor, so that the felt contact point stays.
        beyond = max(1.0, math.hypot(*force) / self.limits.force_N, math.hypot(*torque) / self.limits.torque_N_m)
        self.force, self.torque = times(1 / beyond, force), times(1 / beyond, torque)
        self.until_ns = now_ns + min(valid_ns, int(self.limits.valid_s * 1e9))
        return ""

    def update(self, now_ns, velocity, spin=ZERO):
        """One tick: the force and torque to exert now. velocity, spin: of the device since the last tick, m/s and rad/s; one that is not
        finite counts as a lost device."""
        limits = self.limits
        dt = 0.0 if self.last_ns is None else (now_ns - self.last_ns) * 1e-9
        self.last_ns = now_ns
        moves, stopped = finite(velocity) and finite(spin), not 0 <= dt <= limits.fade_s
        if stopped:
            self.gate, self.out = 0.0, Exerted()
        elif moves:
            self.spend(dot(self.out.force, velocity) + dot(self.out.torque, spin), dt)
        gap = self.gap(now_ns, moves)
        if gap:
            before = self.gate
            self.gate = max(0.0, before - max(dt, 0.0) / limits.fade_s)
            left = self.gate / before if before > 0 else 0.0
            self.out = Exerted(times(left, self.out.force), times(left, self.out.torque), gap)
            return self.out
        self.gate = 0.0 if stopped else min(1.0, self.gate + dt / limits.fade_s)
        left = clamp(2 * self.tank_J / limits.energy_J, 0.0, 1.0)
        factor = self.gate * left
        self.out = Exerted(self.approach(self.out.force, times(factor, self.force), limits.slew_N_s * dt),
                           self.approach(self.out.torque, times(factor, self.torque), limits.torque_slew_N_m_s * dt),
                           "stopped" if stopped else "energy" if left < 1 else "")
        return self.out

    def gap(self, now_ns, moves):
        if self.sender.conflict(now_ns):
            return "second sender"
        if self.until_ns is None or now_ns >= self.until_ns:
            return "no command"
        return "" if moves else "no motion"

    @staticmethod
    def approach(old, new, step):
        """Falls at once and rises by at most step, so that a slow slew never adds energy."""
        length = math.hypot(*new)
        if not length > 0:
            return ZERO
        kept = clamp(dot(old, new) / length, 0.0, length)
        return times(min(length, kept + step) / length, new)

    def spend(self, power_W, dt):
        """A tank that power to the hand drains and power from the hand fills (Hannaford and Ryu 2002). It recovers within a second."""
        self.tank_J = clamp(self.tank_J + (self.limits.power_W - power_W) * dt, -self.limits.power_W, self.limits.energy_J)


@dataclasses.dataclass(frozen=True)
class TemperatureLimits:
    """Defaults as in thermal_node/settings.csv and thermal_node/skin/dwell.h, which name their sources."""
    min_degC: float = 15.0
    max_degC: float = 42.0
    neutral_degC: float = 33.0
    slew_K_s: float = 20.0
    valid_s: float = 0.3  # of a command after its arrival
    warm_degC: float = 39.0
    dose_s: float = 60.0  # seconds at 43 degC or the equivalent, above warm_degC
    dose_decay_s: float = 300.0
    cold_degC: float = 20.0
    cold_s: float = 60.0  # time below cold_degC
    return_K_s: float = 20.0  # at least, on the way to neutral: a slower slew would lengthen an exposure
    runaway_K: float = 2.0  # beyond the range: the plate does not obey (design: an overshoot is smaller)


@dataclasses.dataclass(frozen=True)
class SkinAccount:
    """The exposure of the person, to store and to continue with after a restart."""
    dose_s: float = 0.0
    cold_s: float = 0.0
    too_warm: bool = False
    too_cold: bool = False


class TemperatureGuard:
    def __init__(self, limits=TemperatureLimits(), sender=SenderLimits()):
        self.limits, self.sender = limits, OneSender(sender)
        self.out_degC, self.wanted_degC = limits.neutral_degC, limits.neutral_degC
        self.dose_s, self.cold_s, self.too_warm, self.too_cold = 0.0, 0.0, False, False
        self.until_ns, self.last_ns, self.reason = None, None, "no command"
        self.before_degC = -1e9  # plate at the last tick
        self.off = False  # no current may flow: the sensor has failed, or the plate is out of its range

    def account(self):
        return SkinAccount(self.dose_s, self.cold_s, self.too_warm, self.too_cold)

    def resume(self, before, away_s=0.0):
        """before: the SkinAccount of an earlier process, or of this one; away_s: time at neutral since then, 0 if it is not known. Sums that
        are not finite or negative count as full."""
        limits = self.limits
        away_s = away_s if away_s > 0 else 0.0

        def total(stored_s, max_s):
            return stored_s if 0 <= stored_s <= max_s else max_s
        self.dose_s = total(before.dose_s, 2 * limits.dose_s) * math.exp(-away_s / limits.dose_decay_s)
        self.cold_s = max(0.0, total(before.cold_s, 2 * limits.cold_s) - away_s)
        self.too_warm, self.too_cold = before.too_warm, before.too_cold
        self.update_limits()

    def on_message(self, sent, wanted_degC, now_ns):
        """A message for this plate arrived. Returns "", or why it is no command."""
        reason = self.sender.check(sent, now_ns)
        if reason:
            return reason
        if not math.isfinite(wanted_degC):
            return "not finite"
        self.wanted_degC, self.until_ns = wanted_degC, now_ns + int(self.limits.valid_s * 1e9)
        return ""

    def update(self, now_ns, plate_degC):
        """One tick: the temperature to command now, degC. plate_degC: as measured; one that is not finite counts as the warmest and the
        coldest in range."""
        limits = self.limits
        dt = 0.0 if self.last_ns is None else max(0.0, (now_ns - self.last_ns) * 1e-9)
        self.last_ns = now_ns
        known = math.isfinite(plate_degC)
        self.expose(max(self.out_degC, plate_degC if known else limits.max_degC),
                    min(self.out_degC, plate_degC if known else limits.min_degC), dt)
        conflict = self.sender.conflict(now_ns)
        live = self.until_ns is not None and now_ns < self.until_ns and not conflict
        self.reason = "" if live else "second sender" if conflict else "no command"
        wanted_degC = self.wanted_degC if live else limits.neutral_degC
        returns = abs(wanted_degC - limits.neutral_degC) < abs(self.out_degC - limits.neutral_degC)
        step = (max(limits.slew_K_s, limits.return_K_s) if returns else limits.slew_K_s) * min(dt, 0.1)
        self.out_degC += clamp(wanted_degC - self.out_degC, -step, step)
        # A plate that was cold when the display was switched on must be heated.
        self.off = (not known or plate_degC > limits.max_degC + limits.runaway_K
                    or (plate_degC < limits.min_degC - limits.runaway_K and plate_degC < self.before_degC))
        self.before_degC = plate_degC if known else self.before_degC
        # A limit is entered at once.
        self.out_degC = clamp(self.out_degC, limits.cold_degC if self.too_cold else limits.min_degC,
                              limits.warm_degC if self.too_warm else limits.max_degC)
        return self.out_degC

    def expose(self, warmest, coldest, dt):
        """Of the command and the plate, the warmer counts for warmth and the colder for cold. Dose of Sapareto and Dewey 1984."""
        limits = self.limits
        if warmest > limits.warm_degC:
            self.dose_s += dt * (2.0 if warmest > 43 else 4.0) ** (min(warmest, 100.0) - 43)
        else:
            self.dose_s *= math.exp(-dt / limits.dose_decay_s)
        self.cold_s = max(0.0, self.cold_s + (dt if coldest < limits.cold_degC else -dt))
        self.dose_s, self.cold_s = min(self.dose_s, 2 * limits.dose_s), min(self.cold_s, 2 * limits.cold_s)
        self.update_limits()

    def update_limits(self):
        limits = self.limits
        self.too_warm = self.dose_s >= limits.dose_s or (self.too_warm and self.dose_s > limits.dose_s / 2)
        self.too_cold = self.cold_s >= limits.cold_s or (self.too_cold and self.cold_s > limits.cold_s / 2)
