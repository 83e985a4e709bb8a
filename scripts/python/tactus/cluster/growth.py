"""Model of the network load and message delay of a large cluster: queues in series, each served in order.

Sources: sizes and rates are those of the default scene's log (traffic.csv). The mean wait of a queue with constant
service time s and random arrivals is rho s / (2 (1 - rho)) (Pollaczek and Khinchine for M/D/1; Kleinrock, Queueing Systems I, 1975,
equation 5.63); the tests compare with it.
"""
import dataclasses
import math
import pathlib
import random

from tactus.tables import read_rows

WIRE_OVERHEAD_BYTES = 8 + 20 + 14 + 4 + 8 + 12 + 8 + 12  # LCM's head and a channel, IP, Ethernet with check and gap, UDP: RFC 768, RFC 791, IEEE 802.3
FEW_CLOCKS, MAX_CLOCKS, PROBES, PERIOD_S, MAPS_PER_S = 16, 64, 8, 2.0, 2  # sync/clock_sync/clock_probe.h, sync/tools/sync_node_main.cpp


@dataclasses.dataclass(frozen=True)
class Flow:
    """One channel of one kind of sender."""
    channel: str
    of: str         # world, hand, node, host or pair
    per_s: float    # of one sender
    bytes: int      # of the message
    thin_per_s: float  # messages per second that a relay forwards


def read_flows():
    rows = read_rows(pathlib.Path(__file__).with_name("traffic.csv"))
    return [Flow(r["channel"], r["of"], float(r["per_s"] or 0), int(r["bytes"]), float(r["thin_per_s"] or 0)) for r in rows]


def sender_count(of, hosts):
    """Number of senders; the default scene has two tools."""
    return {"world": 1, "hand": 2, "node": hosts, "host": hosts, "pair": hosts}[of]


def messages_per_s(flow, hosts, thin=False):
    """Messages a second of one sender in a site with `hosts` hosts. Only the relay hosts track the clocks of other sites."""
    others = min(hosts - 1, MAX_CLOCKS)
    stretch = max(1, others // FEW_CLOCKS)
    if flow.channel == "CLOCK_PROBE":
        return 0.0 if thin else PROBES / (PERIOD_S * stretch) * (1 + others)  # its probes, and its answers to those of all others
    if flow.channel == "CLOCK_MAP":
        return 0.0 if thin else MAPS_PER_S / stretch * others
    return flow.thin_per_s if thin else flow.per_s


def wire_bits(flow):
    return 8 * (flow.bytes + WIRE_OVERHEAD_BYTES)


def offered_bit_s(hosts, has_world, thin=False):
    """Load of the senders of a site on the wire, bit/s."""
    return sum(sender_count(f.of, hosts) * messages_per_s(f, hosts, thin) * wire_bits(f) for f in read_flows() if has_world or f.of not in ("world", "hand"))


def arrivals(hosts, has_world, seconds, seed, thin=False):
    """[(time in s, bits, flow)] of the senders of one site, sorted by time; each sender is periodic with a random phase."""
    rng = random.Random(seed)
    found = []
    for f in read_flows():
        if not has_world and f.of in ("world", "hand"):
            continue
        per_s = messages_per_s(f, hosts, thin)
        if per_s <= 0:
            continue
        for _ in range(sender_count(f.of, hosts)):
            t = rng.random() / per_s
            while t < seconds:
                found.append((t, wire_bits(f), f))
                t += 1 / per_s
    found.sort(key=lambda m: m[0])
    return found


class Queue:
    """A link or a processor: serves messages in order; drops those that would wait longer than `max_wait_s`."""

    def __init__(self, bit_per_s, max_wait_s=float("inf"), per_message_s=0.0):
        self.bit_per_s, self.max_wait_s, self.per_message_s = bit_per_s, max_wait_s, per_message_s
        self.free = self.busy_s = 0.0
        self.lost = 0

    def serve(self, at, size):
        """Time of completion in s; None when the message is dropped."""
        begin = max(at, self.free)
        if begin - at > self.max_wait_s:
            self.lost += 1
            return None
        service_s = size / self.bit_per_s + self.per_message_s
        self.free = begin + service_s
        self.busy_s += service_s
        return self.free


class TokenBucket(Queue):
    """A token bucket: burst in bits, rate in bit/s. Messages without tokens wait at most `max_wait_s`."""

    def __init__(self, bit_per_s, burst_bits, max_wait_s):
        super().__init__(bit_per_s, max_wait_s)
        self.tokens, self.burst, self.last = burst_bits, burst_bits, 0.0

    def serve(self, at, size):
        at_work = max(at, self.free)
        self.tokens = min(self.burst, self.tokens + (at_work - self.last) * self.bit_per_s)
        wait = max(0.0, (size - self.tokens) / self.bit_per_s)
        if at_work + wait - at > self.max_wait_s:
            self.last = at_work
            self.lost += 1
            return None
        self.tokens += wait * self.bit_per_s - size
        self.last = self.free = at_work + wait
        self.busy_s += size / self.bit_per_s
        return self.free


class PeriodicLoop:
    """A periodic loop: handles messages at the next tick."""

    def __init__(self, rate_hz, phase_s):
        self.period_s, self.phase_s = 1 / rate_hz, phase_s

    def serve(self, at, _):
        return math.ceil((at - self.phase_s) / self.period_s) * self.period_s + self.phase_s
