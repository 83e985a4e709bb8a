"""Checks multicast, network namespaces and receive buffers."""
import select
import socket
import struct
import subprocess
import time

from tactus.doctor.line import GOOD, MISSING, WEAK, Line

GROUP = "239.255.76.67"  # as in lcmtypes/channels.h
# Design: 20,000 messages of 100 bytes take 16 MB of kernel memory, because each block of 256 bytes has an overhead of 512 bytes.
ROOM = 4 << 20
SENT = 200
SIZE = 1400


def route():
    found = subprocess.run(["ip", "route", "get", GROUP], capture_output=True, text=True, check=False)
    if found.returncode == 0 and " dev " in found.stdout:
        device = found.stdout.split(" dev ")[1].split()[0]
        return Line("multicast route", GOOD, f"messages to {GROUP} are sent through {device}", figures={"device": device})
    return Line("multicast route", WEAK, f"there is no route to {GROUP}: only runs in a private network (--network private) "
                "are possible", "ip route add 224.0.0.0/4 dev lo, or dev of the network that the hosts share")


def namespaces(allowed):
    """allowed: whether this system allows a private network."""
    if allowed:
        return Line("private network", GOOD, "runs can use a private network, isolated from other processes")
    return Line("private network", WEAK, "network namespaces are refused: runs use the machine's network",
                "sysctl user.max_user_namespaces=10000, or run as root")


def receive_buffer():
    """Size of the receive buffer that the kernel allows a process."""
    with open("/proc/sys/net/core/rmem_max", encoding="ascii") as file:
        most = int(file.read())
    forced = False
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        try:
            s.setsockopt(socket.SOL_SOCKET, 33, ROOM)  # SO_RCVBUFFORCE
            forced = True
        except OSError:
            s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, ROOM)
        given = s.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF) // 2  # the kernel doubles the requested size
    figures = {"given_bytes": given, "rmem_max_bytes": most, "forced": forced}
    if given >= ROOM:
        return Line("receive buffers", GOOD, f"{given / 2**20:.1f} MB for a process" + (", as root" if forced else ""), figures=figures)
    return Line("receive buffers", WEAK, f"{given / 2**20:.2f} MB for a process: it loses messages of a burst of more than {given // 2300} ",
                f"sysctl net.core.rmem_max={ROOM}", figures)


def loopback():
    """Sends a burst to itself and counts the received messages."""
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
            return Line("multicast loopback", WEAK, f"cannot send to {GROUP} ({error.strerror})",
                        "ip route add 224.0.0.0/4 dev lo")
        received, last = 0, begun
        while received < SENT and time.monotonic() - begun < 1:
            if select.select([s], [], [], 0.1)[0]:
                s.recv(SIZE)
                received, last = received + 1, time.monotonic()
    figures = {"sent": SENT, "received": received, "seconds": round(last - begun, 4)}
    if received == 0:
        return Line("multicast loopback", WEAK, "no sent message is received",
                    f"allow UDP to {GROUP} from this machine to itself in the firewall", figures)
    if received < SENT:
        return Line("multicast loopback", WEAK, f"{received} of a burst of {SENT} messages were received",
                    f"sysctl net.core.rmem_max={ROOM}", figures)
    return Line("multicast loopback", GOOD, f"all of a burst of {SENT} messages of {SIZE} bytes were received in "
                f"{1000 * (last - begun):.1f} ms", figures=figures)


def mark_required_network(lines):
    """Marks the private network as missing when neither network works, because a run needs one of them."""
    by_name = {line.what: line for line in lines}
    private, loop = by_name["private network"], by_name["multicast loopback"]
    if private.verdict != GOOD and loop.verdict != GOOD:
        private.verdict, private.needed = MISSING, True
        private.found += ", and multicast does not work either: no cluster can run"
