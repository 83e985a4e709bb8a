"""Hosts on one machine: each is a network namespace on one switch, with its own monotonic clock, processes, home, /tmp and sshd.

The hosts share the processors and the programs of the machine; this repository is hidden from them. The lab and all of its
processes end with the process that made it.
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time

from tactus.cluster import host_connection
from tactus.paths import REPOSITORY, packages_remedy

VARIABLE = "TACTUS_LAB"  # environment variable with the folder of the lab
SUBNET = "10.77.0"
OPERATOR = f"{SUBNET}.254"
MAX_HOSTS = 100
CLOCK_SPACING_S = 1000   # clock offset between successive hosts
PATIENCE_S = 20
SSHD = """Port 22
HostKey /root/.lab/host_key
AuthorizedKeysFile %h/.ssh/authorized_keys
PermitRootLogin prohibit-password
PasswordAuthentication no
KbdInteractiveAuthentication no
UsePAM no
PidFile none
MaxStartups 50
MaxSessions 50
"""
USER = "person"  # login name on hosts without root login
USER_ID = 1000
SSH = """Host *
  User root
  IdentityFile {folder}/key
  UserKnownHostsFile {folder}/known_hosts
  IdentitiesOnly yes
"""


class Error(Exception):
    """An error of the lab; one sentence."""


def sh(*words, check=True):
    """Output of a command. Raises Error with the last line of its stderr."""
    done = subprocess.run(words, capture_output=True, text=True, errors="replace", check=False)
    if check and done.returncode != 0:
        raise Error(f"{' '.join(words)}: {(done.stderr.strip() or 'failed').splitlines()[-1]}")
    return done.stdout


class Host:
    """A host of the lab; number from 1."""

    def __init__(self, lab, name, number, ordinary=False):
        """ordinary: the login user is not root and has the default resource limits."""
        self.lab, self.name, self.number, self.ordinary = lab, name, number, ordinary
        self.port = f"port{number}"  # its port of the switch
        self.address = f"{SUBNET}.{number}"
        self.ahead_s = CLOCK_SPACING_S * number
        self.disk = lab.folder / name
        self.home = self.disk / USER if ordinary else self.disk  # of the login user
        self.process = self.pid = None

    def prepare(self):
        """Creates its disk, which survives kill()."""
        (self.disk / ".lab").mkdir(parents=True)
        (self.home / ".ssh").mkdir(mode=0o700, parents=True)
        shutil.copy(self.lab.folder / "key.pub", self.home / ".ssh" / "authorized_keys")
        if self.ordinary:
            for path in (self.home, *self.home.rglob("*")):
                os.chown(path, USER_ID, USER_ID)
            known = pathlib.Path("/etc/passwd").read_text(encoding="utf-8")
            (self.disk / ".lab" / "passwd").write_text(f"{known.rstrip()}\n{USER}:*:{USER_ID}:{USER_ID}::/home/{USER}:/bin/sh\n", encoding="utf-8")
        (self.disk / ".lab" / "sshd_config").write_text(SSHD, encoding="ascii")
        sh("ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", str(self.disk / ".lab" / "host_key"))
        public = (self.disk / ".lab" / "host_key.pub").read_text(encoding="ascii").split()[:2]
        with open(self.lab.folder / "known_hosts", "a", encoding="ascii") as file:
            file.write(f"{self.name},{self.address} {' '.join(public)}\n")
        with open(self.lab.folder / "ssh_config", "a", encoding="utf-8") as file:
            file.write(f"Host {self.name}\n  HostName {self.address}\n" + (f"  User {USER}\n" if self.ordinary else ""))

    def boot(self):
        # $1 to $4: names of folders and of the host are no part of the shell's text.
        person = (f"mount --bind /root/.lab/passwd /etc/passwd && mount -t tmpfs tmpfs /home && mkdir /home/{USER} && mount --bind \"$1\" /home/{USER} && "
                  if self.ordinary else "")
        limits = "" if self.ordinary else "ulimit -l unlimited 2>/dev/null; "
        # The repository is hidden first, because its mount point may be inside a folder that is hidden next.
        inside = (f"mount -t tmpfs tmpfs \"$3\" && mount --bind \"$2\" /root && {person} mount -t tmpfs tmpfs /tmp && mount -t tmpfs tmpfs /run && "
                  f"mkdir -m 755 /run/sshd && hostname \"$4\" && cd /root && export HOME=/root && "
                  "ip link set lo up && echo up && read linked && { ulimit -l unlimited 2>/dev/null; exec /usr/sbin/sshd -D -f /root/.lab/sshd_config -E /root/.lab/sshd.log; }")
        environment = {"PATH": os.environ.get("PATH", "/usr/bin:/bin") + ":/usr/sbin:/sbin"}
        self.process = subprocess.Popen(
            ["unshare", "--net", "--uts", "--mount", "--time", "--monotonic", str(self.ahead_s), "--pid", "--fork", "--kill-child",
             "--mount-proc", "sh", "-c", inside, "sh", str(self.home), str(self.disk), str(REPOSITORY), self.name],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, start_new_session=True, env=environment)
        if self.process.stdout.readline() != "up\n":
            raise Error(f"cannot create the host {self.name}; run as root on Linux 5.6 or later")
        self.pid = int(pathlib.Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text(encoding="ascii").split()[0])
        sh("ip", "link", "add", self.port, "type", "veth", "peer", "name", "eth0", "address", f"02:00:00:00:00:{self.number:02x}",
           "netns", str(self.pid))  # unchanged by a restart, because other hosts cache it
        sh("ip", "link", "set", self.port, "master", "switch", "up")
        for words in (f"addr add {self.address}/24 dev eth0", "link set eth0 up", "route add 224.0.0.0/4 dev eth0"):
            sh(*self.inside(), "ip", *words.split())
        self.process.stdin.write("linked\n")
        self.process.stdin.flush()
        end = time.monotonic() + PATIENCE_S
        while not sshd_answers(self.address):
            if self.process.poll() is not None or time.monotonic() > end:
                raise Error(f"sshd of the host {self.name} does not answer; see {self.disk}/.lab/sshd.log")
            time.sleep(0.02)

    def inside(self):
        """Command words that enter the network of the host."""
        return ["nsenter", f"--net=/proc/{self.pid}/ns/net"]

    def processes(self):
        """Process ids of the host, in the namespace of the caller."""
        mine = os.readlink(f"/proc/{self.pid}/ns/pid")
        found = []
        for folder in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if os.readlink(folder / "ns" / "pid") == mine:
                    found.append(int(folder.name))
            except OSError:
                continue  # the process has just ended
        return found

    def cut(self):
        sh("ip", "link", "set", self.port, "down")

    def mend(self):
        """Removes all faults of its cable."""
        sh("ip", "link", "set", self.port, "up")
        sh("tc", "qdisc", "del", "dev", self.port, "root", check=False)
        sh(*self.inside(), "tc", "qdisc", "del", "dev", "eth0", "root", check=False)
        sh(*self.inside(), "nft", "delete", "table", "inet", "lab", check=False)

    def limit(self, kbit):
        """Limits the rate in both directions."""
        bucket = ["root", "tbf", "rate", f"{kbit}kbit", "burst", "16kb", "latency", "50ms"]
        sh("tc", "qdisc", "replace", "dev", self.port, *bucket)
        sh(*self.inside(), "tc", "qdisc", "replace", "dev", "eth0", *bucket)

    def lose(self, percent):
        """Drops received and sent packets at random."""
        rules = "; ".join(f"add chain inet lab {hook} {{ type filter hook {hook} priority 0; }}; "
                          f"add rule inet lab {hook} {device} eth0 numgen random mod 1000 < {round(10 * percent)} counter drop"
                          for hook, device in (("input", "iifname"), ("output", "oifname")))
        sh(*self.inside(), "nft", f"add table inet lab; {rules}")

    def stop(self):
        for pid in self.processes():
            signal_to(pid, signal.SIGSTOP)

    def go_on(self):
        for pid in self.processes():
            signal_to(pid, signal.SIGCONT)

    def kill(self):
        """Simulates a power failure; boot() restarts the host."""
        if self.process is None:
            return
        signal_to(self.pid or self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.process.stdin.close()
        self.process.stdout.close()
        sh("ip", "link", "del", self.port, check=False)  # the kernel also removes it, but later
        self.process = self.pid = None


class Lab:
    """All hosts, in the network namespace of the caller, which must be private: see enter()."""

    def __init__(self, names, ordinary=()):
        """ordinary: names of the hosts without root login."""
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="tactus-lab-"))
        self.hosts = {}
        try:
            sh("ip", "link", "set", "lo", "up")
            sh("ip", "link", "add", "switch", "type", "bridge")
            sh("ip", "addr", "add", f"{OPERATOR}/24", "dev", "switch")
            sh("ip", "link", "set", "switch", "up")
            sh("ip", "route", "add", "224.0.0.0/4", "dev", "switch")
            sh("ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", str(self.folder / "key"))
            (self.folder / "ssh_config").write_text("", encoding="utf-8")
            for number, name in enumerate(names, 1):
                self.hosts[name] = Host(self, name, number, name in ordinary)
                self.hosts[name].prepare()
            with open(self.folder / "ssh_config", "a", encoding="utf-8") as file:
                file.write(SSH.format(folder=self.folder))
            for host in self.hosts.values():
                host.boot()
            self.write_hosts()
        except BaseException:
            self.close()
            raise

    def write_hosts(self):
        """Writes process ids and numbers of the hosts for other processes, such as `tactus lab HOST cut`."""
        known = {name: {"pid": host.pid, "number": host.number} for name, host in self.hosts.items()}
        (self.folder / "hosts.json").write_text(json.dumps(known), encoding="utf-8")

    def environment(self):
        return dict(os.environ, **{VARIABLE: str(self.folder)})

    def split(self, names):
        """Moves these hosts to a separate switch."""
        sh("ip", "link", "add", "switch2", "type", "bridge")
        sh("ip", "link", "set", "switch2", "up")
        for name in names:
            sh("ip", "link", "set", self.hosts[name].port, "master", "switch2")

    def rejoin(self):
        for host in self.hosts.values():
            sh("ip", "link", "set", host.port, "master", "switch")
        sh("ip", "link", "del", "switch2")

    def sites(self, sites, line_port=None):
        """Blocks multicast between these groups of hosts; unicast still passes, as between sites. line_port: UDP port of
        the lines between relays, which slow() limits."""
        ports = lambda names: "{ " + ", ".join(self.hosts[n].port for n in names) + " }"
        sh("nft", "add table bridge sites; add chain bridge sites forward { type filter hook forward priority 0; }; "
           "add chain bridge sites lines; " + (f"add rule bridge sites forward udp dport {line_port} jump lines; " if line_port else "") + "; ".join(
               f"add rule bridge sites forward iifname {ports(a)} oifname {ports(b)} ip daddr 224.0.0.0/4 drop" for a in sites for b in sites if a != b))

    def slow(self, name, kbit):
        """Limits the lines to and from this host to kbit/s and drops the excess. 0: no limit."""
        sh("nft", "flush chain bridge sites lines")
        if kbit:
            for direction in ("iifname", "oifname"):
                sh("nft", f"add rule bridge sites lines {direction} {self.hosts[name].port} limit rate over {1000 * kbit // 8} bytes/second burst 16000 bytes drop")

    def close(self):
        for host in self.hosts.values():
            host.kill()
        sh("nft", "delete", "table", "bridge", "sites", check=False)
        sh("ip", "link", "del", "switch2", check=False)
        sh("ip", "link", "del", "switch", check=False)
        shutil.rmtree(host_connection.control_folder(self.folder / "ssh_config"), ignore_errors=True)
        shutil.rmtree(self.folder, ignore_errors=True)


def enter(words):
    """Restarts the program with these words in new namespaces. Raises Error when the system refuses."""
    if os.geteuid() != 0:
        raise Error("a lab needs root, because it makes network, mount and time namespaces; run it as root")
    for program in ("unshare", "nsenter", "ip", "tc", "nft", "/usr/sbin/sshd", "ssh", "ssh-keygen"):
        if not shutil.which(program, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin"):
            raise Error(f"{program} is not installed; {packages_remedy('lab')}")
    environment = dict(os.environ, TACTUS_LAB_INSIDE="1", PATH=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")
    space = ["unshare", "--net", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc"]
    probe = subprocess.run([*space, "unshare", "--time", "--monotonic", "1", "--fork", "true"], capture_output=True, check=False)
    if probe.returncode != 0:
        raise Error("this system refuses network or time namespaces; use Linux 5.6 or later, outside a restricted container")
    os.execvpe(space[0], [*space, *words], environment)


def is_inside():
    return os.environ.get("TACTUS_LAB_INSIDE") == "1"


def sshd_answers(address):
    import socket
    try:
        with socket.create_connection((address, 22), timeout=1) as s:
            return s.recv(4) == b"SSH-"
    except OSError:
        return False


def signal_to(pid, number):
    try:
        os.kill(pid, number)
    except ProcessLookupError:
        pass
