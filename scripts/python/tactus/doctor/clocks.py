"""Clock offsets between the hosts of a running cluster, received as CLOCK_MAP."""
import select
import socket
import struct
import time

from tactus.doctor.bus import GROUP
from tactus.doctor.line import GOOD, WEAK, Line

SMALL = 0x4C433032  # magic number of a message in one datagram: lcm/udp_multicast.md
HEADER = ">qqiqiqq"  # header_t
MAP = ">iiqqdqdiqi"  # the other fields of clock_map_t
FEW_MS = 1.0        # design: a tenth of the smallest asynchrony that a person can distinguish


def map_of(packet):
    """(of_clock, to_clock, offset in ns, uncertainty in ns) of a datagram that holds a CLOCK_MAP, else None."""
    if len(packet) < 8 or struct.unpack(">I", packet[:4])[0] != SMALL:
        return None
    channel, found, data = packet[8:].partition(b"\0")
    size = 8 + struct.calcsize(HEADER) + struct.calcsize(MAP)
    if not found or channel != b"CLOCK_MAP" or len(data) != size:
        return None
    of, to, _, offset, _, uncertainty, *_ = struct.unpack(MAP, data[8 + struct.calcsize(HEADER):])
    return of, to, offset, uncertainty


def listen(port, seconds):
    maps, received = {}, 0
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        try:
            s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
            s.bind((GROUP, port))
            s.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + struct.pack("=I", 0))
        except OSError:
            return None, 0
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            if select.select([s], [], [], left)[0]:
                received += 1
                if found := map_of(s.recv(65536)):
                    maps[found[:2]] = found[2:]
    return maps, received


def offsets(port, seconds=1.5):
    maps, received = listen(port, seconds)
    if not received:
        return Line("other clocks", GOOD, f"no cluster on port {port}: nothing to compare", figures={"hosts": 0})
    if not maps:
        return Line("other clocks", GOOD, "a cluster runs on one clock", figures={"hosts": 1})
    figures = {"hosts": 1 + len({of for of, _ in maps}),
               "maps": [{"of": of, "to": to, "offset_ms": offset / 1e6, "uncertainty_ms": u / 1e6}
                        for (of, to), (offset, u) in sorted(maps.items())]}
    worst = max(m["uncertainty_ms"] for m in figures["maps"])
    text = f"{len(maps)} maps between clocks, uncertainty at most {worst:.3f} ms"
    if worst <= FEW_MS:
        return Line("other clocks", GOOD, text, figures=figures)
    return Line("other clocks", WEAK, text + ": the uncertainty of every asynchrony between hosts is at least as large",
                "connect the hosts by a wired network that only the cluster uses", figures)
