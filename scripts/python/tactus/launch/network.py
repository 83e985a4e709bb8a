"""A private network and process namespace of the cluster, or the network of the machine.

A private network has only a loopback interface with a multicast route. It is isolated from all other processes and changes no
setting of the system. The namespaces end with the process that made them, and with them all processes inside.
"""
import dataclasses
import os
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
            raise Refusal("--network private: this system does not allow network namespaces, not even for root; use --network "
                          "host, or allow user namespaces (sysctl user.max_user_namespaces)")
    check_host(port)
    for flags, description in candidates(net=False):
        if is_allowed(flags, "true"):
            return Network(False, flags, f"the machine's ({description})")
    return Network(False, [], "the machine's, without a process namespace")


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


def is_allowed(flags, command):
    if not shutil.which("unshare"):
        return False
    # Some versions return 0 after a refused mount, but always write to stderr.
    test = subprocess.run([*flags, "sh", "-c", command], env={**os.environ, "PATH": PATH}, capture_output=True, timeout=10)
    return test.returncode == 0 and not test.stderr


def check_host(port):
    """Raises Refusal unless the machine's network carries multicast and both ports are free."""
    for number in (port, port + 1):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
            try:
                s.bind(("", number))
            except OSError as error:
                raise Refusal(f"network: UDP port {number} is in use ({error.strerror}), possibly by another run; choose "
                              "another --port, or --network private") from None
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.settimeout(1)
        try:
            s.bind((GROUP, port))
            s.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + struct.pack("=I", 0))
            s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
            s.sendto(b"tactus", (GROUP, port))
            s.recv(16)
        except OSError as error:
            raise Refusal(f"network: multicast to {GROUP} does not return to this machine ({error}); use --network "
                          "private, or add a route: ip route add 224.0.0.0/4 dev lo") from None
