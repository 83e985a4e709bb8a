"""Hosts of a measurement: network namespaces of this machine, some with a clock of their own."""
import os
import signal
import subprocess
import sys

from common import runs
from common.command import Skipped

INSIDE = "TACTUS_MEASURE_INSIDE"
WORDS = ["unshare", *([] if os.geteuid() == 0 else ["--user", "--map-root-user"]), "--net", "--pid", "--fork", "--kill-child", "--mount-proc"]


def is_inside():
    return INSIDE in os.environ


def environment():
    return {**os.environ, INSIDE: "1", "PATH": os.environ.get("PATH", "") + ":/usr/sbin:/sbin"}


def enter():
    """Restarts the command in new network and process namespaces, which end with it. Raises Skipped."""
    if not is_inside():
        probe = subprocess.run([*WORDS, "unshare", "--net", "--time", "--monotonic", "1", "--fork", "true"], capture_output=True, check=False)
        if probe.returncode != 0:
            raise Skipped("this system permits no private network and time namespaces")
        os.execvpe(WORDS[0], [*WORDS, *sys.orig_argv], environment())
    ip("link", "set", "lo", "up")


def ip(*words, inside=()):
    subprocess.run([*inside, "ip", *words], check=True)


def own_offset_ns():
    """Offset of the monotonic clock of this process from that of the machine."""
    with open("/proc/self/timens_offsets", encoding="ascii") as file:
        for line in file:
            name, seconds, ns = line.split()
            if name == "monotonic":
                return int(seconds) * 10**9 + int(ns)
    return 0


class Host:
    """A network namespace and the programs in it."""

    def __init__(self, ahead_s=0):
        """ahead_s: how far its clock is ahead of the clock of the machine; 0: the clock of this process."""
        self.programs, self.holders, self.clock = [], [], []
        self.network_pid = self.hold("--net")
        self.inside = ["nsenter", f"--net=/proc/{self.network_pid}/ns/net"]
        if ahead_s:
            self.set_clock(ahead_s)

    def hold(self, *kinds):
        """Process id of a process in new namespaces of these kinds, which exist as long as it."""
        self.holders.append(subprocess.Popen(["unshare", *kinds, "sh", "-c", "echo $$; exec sleep 100000"], stdout=subprocess.PIPE, text=True))
        return int(self.holders[-1].stdout.readline())

    def set_clock(self, ahead_s):
        """Sets the clock of the programs that start from now on."""
        self.clock = [f"--time=/proc/{self.hold('--time', '--monotonic', str(ahead_s), '--fork', '--kill-child')}/ns/time"]

    def plug(self, device, address):
        ip("link", "set", device, "netns", str(self.network_pid))
        for words in ("link set lo up", f"addr add {address}/24 dev {device}", f"link set {device} up", f"route add 224.0.0.0/4 dev {device}"):
            ip(*words.split(), inside=self.inside)

    def start(self, log, program, *options, **variables):
        """Starts a program of the build. nsenter becomes the program, so it receives the signals."""
        with open(log, "w", encoding="utf-8") as file:
            self.programs.append(subprocess.Popen([*self.inside, *self.clock, runs.program(program), "--ttl", "1", *options], stderr=file,
                                                  env={**os.environ, **variables}))
        return self.programs[-1]

    def stop_programs(self, number=signal.SIGTERM):
        for program in reversed(self.programs):
            program.send_signal(signal.SIGCONT)
            program.send_signal(number)
        for program in reversed(self.programs):
            try:
                program.wait(timeout=15)
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()
        self.programs.clear()

    def stop(self):
        self.stop_programs()
        for holder in self.holders:
            holder.kill()
            holder.wait()
            holder.stdout.close()
