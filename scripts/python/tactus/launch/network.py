"""A private network and process namespace of the cluster, or the network of the machine.

A private network has only a loopback interface with a multicast route. It is isolated from all other processes and changes no
setting of the system. The namespaces end with the process that made them, and with them all processes inside.
"""
import contextlib
import dataclasses
import os
import select
import shutil
import socket
import struct
import subprocess

from tactus.refusal import Refusal

GROUP = "239.255.76.67"  # as in lcmtypes/channels.h
PATH = os.environ.get("PATH", "/usr/bin:/bin") + ":/usr/sbin:/sbin"  # the PATH of an ordinary user may lack ip
ROUTE = "ip link set lo up && ip route add 224.0.0.0/4 dev lo"


@dataclasses.dataclass
class Network:
    private: bool
    unshare: list  # command words before the program inside; empty: no namespaces
    description: str  # description for the user


def choose(choice, port):
    """The best network that this system allows. Raises Refusal."""
    if choice != "host":
        for flags, description in candidates(net=True):
            if is_allowed(flags, ROUTE):
                return Network(True, flags, f"private ({description})")
        if choice == "private":
            raise Refusal(f"--network private: {no_namespaces()}; use --network host, or allow user namespaces "
                          "(sysctl user.max_user_namespaces; in a container, its options of security)")
    check_host(port, private_is_allowed=choice == "host" and any(is_allowed(flags, ROUTE) for flags, _ in candidates(net=True)))
    for flags, description in candidates(net=False):
        if is_allowed(flags, "true"):
            return Network(False, flags, f"the machine's ({description})")
    return Network(False, [], "the machine's, without a process namespace")


def no_namespaces():
    """Why no private network is possible here."""
    for program, package in (("unshare", "util-linux"), ("ip", "iproute2")):
        if not shutil.which(program, path=PATH):
            return f"{program} is missing (package {package})"
    return "this system does not allow network namespaces" + (", not even for root" if os.geteuid() == 0 else " to this user")


def candidates(net):
    """Yields the ways to make the namespaces, best first: (command words, name)."""
    # --map-current-user keeps the identity of the user for files and sound servers, --keep-caps the right to configure
    # the private network; an older unshare can only map the user to root.
    users = [([], "root")] if os.geteuid() == 0 else [(["--user", "--map-current-user", "--keep-caps"], "user namespace")]
    users.append((["--user", "--map-root-user"], "user namespace"))
    for user, description in users:
        # With a separate /proc, programs such as pkill see only the cluster.
        for proc in (["--mount-proc"], ["--mount"]):
            yield ["unshare", *user, *(["--net"] if net else []), "--pid", "--fork", "--kill-child", *proc], description


# With --mount-proc, /proc/self exists only when the new /proc was mounted. Some versions of unshare return 0 after a refused mount.
PROBE = "{mounted}{command} && echo inside"


def is_allowed(flags, command):
    """True when a shell command succeeds in these namespaces. Judged by its effect: a library of LD_PRELOAD may write to stderr."""
    probe = PROBE.format(mounted="[ -e /proc/self/stat ] && " if "--mount-proc" in flags else "", command=command)
    try:
        done = subprocess.run([*flags, "sh", "-c", probe], env={**os.environ, "PATH": PATH}, capture_output=True, timeout=10, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0 and done.stdout.endswith(b"inside\n")


LISTENING_S = 0.3  # three reports of the health of a node, which publishes at 10 Hz


def check_host(port, private_is_allowed=True):
    """Raises Refusal unless the machine's network carries multicast and no other program sends on both ports. A program that only listens, such as
    lcm-logger, shares the ports and is no obstacle. private_is_allowed: the advice may name a private network."""
    advice = "choose another --port" + (", or --network private" if private_is_allowed else "")
    with contextlib.ExitStack() as open_until_end:
        sockets = [open_until_end.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) for _ in range(2)]
        for s, number in zip(sockets, (port, port + 1)):
            s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                s.bind((GROUP, number))
            except OSError as error:
                raise Refusal(f"network: UDP port {number} is in use by a program that does not share it ({error.strerror}); {advice}") from None
        try:
            for s in sockets:
                s.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + struct.pack("=I", 0))
                s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
            if select.select(sockets, [], [], LISTENING_S)[0]:
                raise Refusal(f"network: another run or program sends on UDP port {port} or {port + 1}; {advice}")
            probe = os.urandom(16)  # no magic number of LCM: listeners ignore it
            sockets[0].settimeout(1)
            sockets[0].sendto(probe, (GROUP, port))
            while sockets[0].recv(64) != probe:
                pass
        except OSError as error:
            raise Refusal(f"network: multicast to {GROUP} does not return to this machine ({error}); "
                          + ("use --network private, or " if private_is_allowed else "") + "add a route: ip route add 224.0.0.0/4 dev lo") from None
