"""Does multicast work here, and is there room for what arrives?"""
import select
import socket
import struct
import subprocess
import time

from tactus.doctor.line import GOOD, MISSING, WEAK, Line

GROUP = "239.255.76.67"  # as in lcmtypes/channels.h
# Design: a flood of 20,000 messages of 100 bytes takes 16 MB of the kernel's memory: its blocks of 256 bytes have a head of 512.
ROOM = 4 << 20
SENT = 200
SIZE = 1400


def route():
    found = subprocess.run(["ip", "route", "get", GROUP], capture_output=True, text=True, check=False)
    if found.returncode == 0 and " dev " in found.stdout:
        device = found.stdout.split(" dev ")[1].split()[0]
        return Line("multicast route", GOOD, f"messages to {GROUP} leave by {device}", figures={"device": device})
    return Line("multicast route", WEAK, f"there is no route to {GROUP}: only runs in a network of their own (--network private) "
                "can be had", "ip route add 224.0.0.0/4 dev lo, or dev of the network that the hosts share")


def namespaces(allowed):
    """allowed: whether a network of one's own can be made."""
    if allowed:
        return Line("private network", GOOD, "a run may have a network of its own, which nobody else hears")
    return Line("private network", WEAK, "no network namespace can be made: runs use the machine's network",
                "sysctl user.max_user_namespaces=10000, or run as root")


def room():
    """What the kernel keeps for a process that is late."""
    with open("/proc/sys/net/core/rmem_max", encoding="ascii") as file:
        most = int(file.read())
    forced = False
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        try:
            s.setsockopt(socket.SOL_SOCKET, 33, ROOM)  # SO_RCVBUFFORCE
            forced = True
        except OSError:
            s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, ROOM)
        given = s.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF) // 2  # the kernel doubles what is asked
    figures = {"given_bytes": given, "rmem_max_bytes": most, "forced": forced}
    if given >= ROOM:
        return Line("receive buffers", GOOD, f"{given / 2**20:.1f} MB for a process" + (", as root" if forced else ""), figures=figures)
    return Line("receive buffers", WEAK, f"{given / 2**20:.2f} MB for a process: a burst of more than {given // 2300} messages loses some",
                f"sysctl net.core.rmem_max={ROOM}", figures)


def loopback():
    """Sends a burst to itself and counts what comes back."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, ROOM)
        try:
            s.bind((GROUP, 0))
            port = s.getsockname()[1]
            s.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + struct.pack("=I", 0))
            s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
            begun = time.monotonic()
            for number in range(SENT):
                s.sendto(struct.pack("!I", number).ljust(SIZE, b"\0"), (GROUP, port))
        except OSError as error:
            return Line("multicast loopback", WEAK, f"nothing can be sent to {GROUP} here ({error.strerror})",
                        "ip route add 224.0.0.0/4 dev lo")
        heard, last = 0, begun
        while heard < SENT and time.monotonic() - begun < 1:
            if select.select([s], [], [], 0.1)[0]:
                s.recv(SIZE)
                heard, last = heard + 1, time.monotonic()
    figures = {"sent": SENT, "heard": heard, "seconds": round(last - begun, 4)}
    if heard == 0:
        return Line("multicast loopback", WEAK, "nothing of what is sent comes back",
                    f"let the firewall pass UDP to {GROUP} from this machine to itself", figures)
    if heard < SENT:
        return Line("multicast loopback", WEAK, f"{heard} of a burst of {SENT} messages came back",
                    f"sysctl net.core.rmem_max={ROOM}", figures)
    return Line("multicast loopback", GOOD, f"all of a burst of {SENT} messages of {SIZE} bytes came back in "
                f"{1000 * (last - begun):.1f} ms", figures=figures)


def either(lines):
    """A run needs one of the two networks."""
    by_name = {line.what: line for line in lines}
    private, loop = by_name["private network"], by_name["multicast loopback"]
    if private.verdict != GOOD and loop.verdict != GOOD:
        private.verdict, private.needed = MISSING, True
        private.found += ", where multicast does not work either: no cluster can run"
