"""Outputs of a cluster during and after the stops of one process, against the promises of docs/safety.md.

All bounds hold on a machine of any speed: a driver updates its force after its last message and before its next one, so these two times
enclose the time of the update."""
import bisect
import dataclasses
import struct

from tactus.refusal import Refusal

from . import bus_log

FORCE_LIMIT_N, SLEW_N_S, FADE_S = 8.0, 2000.0, 0.02
MIN_DEGC, MAX_DEGC, NEUTRAL_DEGC, RETURN_K_S = 15.0, 42.0, 33.0, 20.0
PLATE_OVERSHOOT_K = 0.2  # a real plate passes its command while it approaches it
ZERO_N = 1e-3  # single precision of the velocity: 1e-7 m/s of 0.1 kg in 1 ms is 1e-5 N
FELT_N = 0.3
ROUNDING_N = 1e-2
RATE_TOLERANCE = 0.02  # of the outputs of the others while a process is stopped
UNDERFLOW, FADE_IN_S = 2, 0.005  # MEDIA_CLOCK: after an interruption sound fades in
MIN_STOPPED_S = 0.2  # shorter stops have too few messages for a rate
# Times after which an effect must be over, s: (DEVICE_FORCE is zero, the driver exerts nothing, the command returns to neutral).
# Stale input 50 ms and fade 20 ms; a command is valid for 20 ms and fades within 20 ms; contacts are stale after 50 ms, displays after 0.3 s.
# 20 to 30 ms are added for the ticks of a loaded machine.
PROMISES = {
    "sim_node": (0.1, 0.1, 0.12),
    "haptic_node": (None, 0.1, None),
    "arm_driver": (0.1, None, None),
    "thermal_device": (None, None, 0.4),
    "relay": (None, None, 0.15),
    "relay_far": (None, None, 0.15),
}


@dataclasses.dataclass
class Result:
    """Worst figures over all stops of one process; None: it has none."""
    freezes: int = 0
    remaining_N: float = None  # largest force after the promised time
    rise_N: float = 0.0  # largest rise in a tick beyond the slew limit
    beyond_fade_N: float = None  # of a return
    return_s: float = None  # until a force was felt again
    behind_K: float = None  # of the command on its way to neutral
    gap_ms: float = 0.0  # between two messages of another process
    gap_of: str = "-"
    violations: list = dataclasses.field(default_factory=list)

    def worst(self, name, value):
        before = getattr(self, name)
        setattr(self, name, value if before is None else max(before, value))


class Judge:
    """Judges the stops of one process. freezes: (begin, end) in ns."""

    def __init__(self, process, log, freezes, sound=None):
        self.process, self.log, self.freezes, self.sound = process, log, freezes, sound
        self.forces = bus_log.exerted(log.states)
        self.sent_ns = [f.sent_ns for f in self.forces]
        self.result = Result(freezes=len(freezes))
        if not any(f.force_N > FELT_N for f in self.forces):
            raise Refusal("the driver exerted no force before the first stop; see the logs of haptic_node and sim_node with --keep DIR")

    def violation(self, freeze, text):
        where = f"stop of {(freeze[1] - freeze[0]) * 1e-6:.0f} ms: " if freeze else ""
        self.result.violations.append(f"{self.process}: {where}{text}")

    def between(self, series, begin_ns, end_ns):
        """Entries of a list of (ns, value)."""
        first = bisect.bisect_right(series, (begin_ns, float("inf")))
        return series[first:bisect.bisect_right(series, (end_ns, float("inf")))]

    def forces_between(self, begin_ns, end_ns):
        """Forces whose update lies surely within this time."""
        first = bisect.bisect_right(self.sent_ns, begin_ns)
        last = bisect.bisect_right(self.sent_ns, end_ns)
        return [f for f in self.forces[first:last] if f.after_ns > begin_ns]

    def judge(self):
        self.judge_limits()
        for freeze in self.freezes:
            self.judge_zero(freeze)
            self.judge_return(freeze)
            self.judge_heat(freeze)
        self.judge_others()
        if self.sound:
            self.judge_sound()
        return self.result

    def judge_limits(self):
        """Force and rise in all ticks, temperature in all messages."""
        for older, old, new in zip(self.forces, self.forces[1:], self.forces[2:]):
            if abs(new.force_N) > FORCE_LIMIT_N + ROUNDING_N:
                self.violation(None, f"force of {new.force_N:.2f} N")
            if older.sent_ns == old.after_ns and old.sent_ns == new.after_ns:
                rise = abs(new.force_N) - abs(old.force_N) - SLEW_N_S * (new.sent_ns - older.sent_ns) * 1e-9
                self.result.worst("rise_N", rise)
                if rise > ROUNDING_N:
                    self.violation(None, f"the force rises by {rise:.2f} N more than its limit")
        for what, series, overshoot_K in (("command", self.log.command_degC, 1e-3), ("plate", self.log.plate_degC, PLATE_OVERSHOOT_K)):
            for _, degC in series:
                if not MIN_DEGC - overshoot_K <= degC <= MAX_DEGC + overshoot_K:
                    self.violation(None, f"{what} of {degC:.2f} degC")
        for _, force_N in self.log.commanded_N:
            if force_N > FORCE_LIMIT_N + ROUNDING_N:
                self.violation(None, f"DEVICE_FORCE of {force_N:.2f} N")

    def judge_zero(self, freeze):
        begin_ns, end_ns = freeze
        commanded_s, exerted_s, _ = PROMISES.get(self.process, (None, None, None))
        remaining = []
        if commanded_s is not None:
            remaining += [force_N for _, force_N in self.between(self.log.commanded_N, begin_ns + int(commanded_s * 1e9), end_ns)]
        if exerted_s is not None:
            remaining += [abs(f.force_N) for f in self.forces_between(begin_ns + int(exerted_s * 1e9), end_ns)]
        if remaining:
            self.result.worst("remaining_N", max(remaining))
            if max(remaining) > ZERO_N:
                self.violation(freeze, f"{max(remaining):.3f} N remain")

    def judge_return(self, freeze):
        """After the stop the force begins at zero, if it was zero, and rises through a fade."""
        end_ns = freeze[1]
        index = bisect.bisect_right(self.sent_ns, end_ns)
        after = self.forces[index:bisect.bisect_right(self.sent_ns, end_ns + 400_000_000)]
        was_zero = index > 0 and abs(self.forces[index - 1].force_N) <= ZERO_N
        if self.process == "arm_driver":
            was_zero = freeze[1] - freeze[0] > FADE_S * 1e9
        if was_zero:
            first = next((i for i, f in enumerate(after) if abs(f.force_N) > ZERO_N), None)
            if first is None:
                self.violation(freeze, "the force does not return")
                return
            zero = after[first - 1] if first else self.forces[index - 1]
            start_ns = end_ns if self.process == "arm_driver" and not first else zero.after_ns
            for f in after[first:]:
                allowed_N = FORCE_LIMIT_N * min(1.0, (f.sent_ns - start_ns) * 1e-9 / FADE_S)
                self.result.worst("beyond_fade_N", abs(f.force_N) - allowed_N)
                if abs(f.force_N) > allowed_N + ROUNDING_N:
                    self.violation(freeze, f"the force returns faster than its fade, by {abs(f.force_N) - allowed_N:.2f} N")
                    break
        felt = next((f for f in after if abs(f.force_N) > FELT_N), None)
        if felt is None:
            self.violation(freeze, "the force is not felt again")
        else:
            self.result.worst("return_s", (felt.sent_ns - end_ns) * 1e-9)

    def judge_heat(self, freeze):
        promised_s = PROMISES.get(self.process, (None, None, None))[2]
        if promised_s is None:
            return
        commands = self.between(self.log.command_degC, freeze[0] + int(promised_s * 1e9), freeze[1])
        behind_K = 0.0
        for sent_ns, degC in commands:
            start_ns, start_degC = commands[0]
            allowed_K = max(0.05, abs(start_degC - NEUTRAL_DEGC) - RETURN_K_S * ((sent_ns - start_ns) * 1e-9 - 0.02))
            behind_K = max(behind_K, abs(degC - NEUTRAL_DEGC) - allowed_K)
        self.result.worst("behind_K", behind_K)
        if behind_K > 0.01:
            self.violation(freeze, f"the command is {behind_K:.2f} K behind its return to neutral")

    def judge_others(self):
        """Rates and gaps of the outputs of all other processes, while this one is stopped against while it runs."""
        stopped = [f for f in self.freezes if f[1] - f[0] >= MIN_STOPPED_S * 1e9]
        if not stopped:
            return
        for output, times in self.log.sent_ns.items():
            owner = bus_log.OUTPUTS.get(output, output)
            if owner == self.process:
                continue
            times = sorted(times)
            found, expected = self.messages(times, stopped)
            if found < expected * (1 - RATE_TOLERANCE) - len(stopped):  # a stop begins and ends between two messages
                self.violation(None, f"{output} has {found} messages during the stops, and by its rate otherwise {expected:.0f}")
            gap_ms = max(longest_gap_ms(times, freeze) for freeze in stopped)
            if output in bus_log.OUTPUTS and gap_ms > self.result.gap_ms:
                self.result.gap_ms, self.result.gap_of = gap_ms, output

    def messages(self, times, stopped):
        """(messages during the stops, number expected by the rate at other times)."""
        whole = (self.freezes[0][0], self.freezes[-1][1])
        stopped_s = sum(end - begin for begin, end in stopped) * 1e-9
        other_s = (whole[1] - whole[0]) * 1e-9 - stopped_s
        found = sum(count(times, freeze) for freeze in stopped)
        return found, (count(times, whole) - found) / other_s * stopped_s if other_s > 0 else 0.0

    def judge_sound(self):
        """Sound that continues after a stop of its process fades in within 5 ms."""
        rate_Hz, channels, samples = self.sound
        fade = FADE_IN_S * rate_Hz
        for index, _, reason in self.log.sound_clock:
            if reason != UNDERFLOW:
                continue
            for i in range(int(fade)):
                frame = samples[channels * (index + i):channels * (index + i + 1)]
                if any(abs(x) > (i + 2) / fade + 1e-3 for x in frame):
                    self.violation(None, f"sound returns with a step at sample {index + i}")
                    break


def count(times, span):
    return bisect.bisect_right(times, span[1]) - bisect.bisect_right(times, span[0])


def longest_gap_ms(times, span):
    inner = times[bisect.bisect_right(times, span[0]):bisect.bisect_right(times, span[1])]
    return max((b - a for a, b in zip(inner, inner[1:])), default=0) * 1e-6


def read_sound(path):
    """(rate, channels, samples) of a WAV of 32-bit floats. Raises Refusal."""
    data = path.read_bytes() if path.exists() else b""
    at, rate, channels, samples = 12, 0, 0, b""
    while at + 8 <= len(data):
        name, size = struct.unpack_from("<4sI", data, at)
        size = min(size, len(data) - at - 8)
        if name == b"fmt ":
            channels, rate = struct.unpack_from("<HI", data, at + 10)
        elif name == b"data":
            samples = data[at + 8:at + 8 + size]
        at += 8 + size + size % 2
    if not rate:
        raise Refusal(f"{path} is no WAV; see the log of audio_node")
    return rate, channels, memoryview(samples[:len(samples) // 4 * 4]).cast("f")
