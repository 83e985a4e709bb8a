"""Sends requests to a host: this machine, over ssh, or a network namespace of this machine. Each request carries agent.py, which
answers it, so that a host needs no installation.

Each request has a timeout; a host that does not answer in time counts as unreachable."""
import base64
import concurrent.futures
import contextlib
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import time
import zlib

from tactus import own_files
from tactus.cluster import answers, exchange
from tactus.refusal import Refusal

PACKAGE = pathlib.Path(__file__).resolve().parents[1]
# Modules of the agent, in import order: packages before their modules.
PACKAGES = ("tactus", "tactus.launch", "tactus.cluster")
NAMES = ("tactus", "tactus.refusal", "tactus.own_files", "tactus.launch", "tactus.launch.cluster_folder", "tactus.launch.services", "tactus.launch.network",
         "tactus.launch.privileges", "tactus.cluster", "tactus.cluster.archives", "tactus.cluster.shader_cache", "tactus.cluster.agent_folders",
         "tactus.cluster.agent")
MODULES = {name: PACKAGE.parent / (name.replace(".", "/") + ("/__init__.py" if name in PACKAGES else ".py")) for name in NAMES}
LOADER = ("import sys,json,types,base64,zlib\n"
          "p=json.loads(zlib.decompress(base64.b64decode(sys.stdin.buffer.readline())))\n"
          "for n,s in p['modules'].items():\n"
          " m=types.ModuleType(n);sys.modules[n]=m;exec(compile(s,n+'.py','exec'),m.__dict__)\n"
          "sys.modules['tactus.cluster.agent'].main(p['request'])")
CONNECT_S = 3
CLOSE_S = 5
# Requests that change nothing more when they are repeated. A host that is too busy to answer ssh for 3 s loses its connection, so they are sent again.
REPEATABLE = ("inspect_host", "node_states", "logs", "stop", "end_supervisor")
NOT_CONNECTED = "connect to host"  # of the message of ssh when there was no connection
REQUEST_S = 10
MAX_PARALLEL = 32
LONGEST_SENTENCE = 1000           # characters of a message of a host
LARGEST_ANSWER_BYTES = 128 << 20  # design: compiled shaders as base64 are the largest answer
LONGEST_SOCKET_FOLDER = 40        # bytes: control_folder adds 9, ssh 58 to the path of a socket, which holds 107 (unix(7))


class Unreachable(Exception):
    """The host cannot be reached; one sentence."""


class ConnectionLost(Unreachable):
    """The connection broke before the answer; one sentence."""


class Failed(Exception):
    """The host was reached but the request failed; one sentence."""


def control_folder(ssh_config):
    """Folder of the sockets of shared ssh connections, private to the user. ssh names a socket by user, host and port, so each
    configuration and each network namespace has its own folder. Raises Unreachable when it belongs to another user."""
    scope = f"{pathlib.Path(ssh_config).resolve() if ssh_config else ''} {os.readlink('/proc/self/ns/net')}"
    try:
        return own_files.make_private_folder(socket_folder() / hashlib.sha256(scope.encode()).hexdigest()[:8])
    except (OSError, Refusal) as error:
        raise Unreachable(f"no folder for the connections of ssh: {error}; set XDG_RUNTIME_DIR to your own folder") from None


def fits(folder):
    """Whether the path of a socket of ssh below this folder is short enough."""
    return len(os.fsencode(folder)) <= LONGEST_SOCKET_FOLDER


def socket_folder():
    """The first of these places that is private to the user, and short: the runtime folder of the login, the home, /tmp."""
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    if runtime and fits(in_runtime := pathlib.Path(runtime) / "tactus") and own_files.is_private_folder(runtime):
        return own_files.make_private_folder(in_runtime)
    in_home = pathlib.Path("~/.cache/tactus/ssh").expanduser()
    if in_home.is_absolute() and fits(in_home) and own_files.owner(in_home.parents[2]) == os.geteuid():
        return own_files.make_private_folder(in_home)
    return own_files.make_private_folder(f"/tmp/tactus-ssh-{os.geteuid()}")


class HostConnection:
    """Sends requests to one host; each starts an agent there."""

    def __init__(self, host, ssh_config=None):
        self.host, self.ssh_config = host, ssh_config

    def command_line(self, command):
        """The command line that runs a command on the host. Raises Unreachable."""
        if self.host.address.startswith("-"):
            raise Unreachable(f"{self.host.name}: the address {self.host.address} begins with -, so that ssh would read it as an option; name another")
        if self.host.reach == "local":
            return list(command)
        if self.host.reach == "namespace":
            return ["ip", "netns", "exec", self.host.address, *command]
        return [*self.ssh_words(self.ssh_options()), "--", self.host.address, shlex.join(command)]

    def ssh_words(self, options):
        return ["ssh", "-T", *(["-F", str(self.ssh_config)] if self.ssh_config else []), *(w for o in options for w in ("-o", o))]

    def ssh_options(self):
        return ["BatchMode=yes", f"ConnectTimeout={CONNECT_S}", "ServerAliveInterval=1", "ServerAliveCountMax=3", "ControlMaster=auto",
                f"ControlPath={control_folder(self.ssh_config)}/%C", "ControlPersist=60", "LogLevel=ERROR", "ForwardAgent=no", "ForwardX11=no"]

    def request(self, what, patience_s=REQUEST_S, data=None, to=None, largest_bytes=LARGEST_ANSWER_BYTES, **fields):
        """The checked answer of the agent to a request. data: bytes to send with it; to: file for the output, at most largest_bytes, then the
        result is None. Raises Unreachable or Failed."""
        end_s = time.monotonic() + patience_s
        try:
            return self.request_once(what, patience_s, data, to, largest_bytes, fields)
        except ConnectionLost:
            if what not in REPEATABLE:
                raise
        return self.request_once(what, max(CONNECT_S, end_s - time.monotonic()), data, to, largest_bytes, fields)

    def request_once(self, what, patience_s, data, to, largest_bytes, fields):
        modules = {name: path.read_text(encoding="utf-8") for name, path in MODULES.items()}
        request_fields = {"what": what, "folder": self.host.folder, **fields}
        line = base64.b64encode(zlib.compress(json.dumps({"modules": modules, "request": request_fields}).encode())) + b"\n"
        process = subprocess.Popen(self.command_line(["/usr/bin/python3", "-I", "-c", LOADER]), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, start_new_session=True, bufsize=0)
        try:
            out, err = exchange.exchange(process, line + (data or b""), patience_s, largest_bytes, to)
        except exchange.TooSlow:
            self.close_shared_connection()
            raise Unreachable(f"{self.host.name}: does not answer within {patience_s:g} s") from None
        except exchange.TooLong:
            self.close_shared_connection()
            raise Failed(f"{self.host.name}: its answer is longer than {largest_bytes // 1_000_000} MB; check this host") from None
        error_text = err.strip()
        if process.returncode == 255 and self.host.reach == "ssh" or process.returncode == 127:
            kind = ConnectionLost if self.host.reach == "ssh" and NOT_CONNECTED not in error_text else Unreachable
            raise kind(f"{self.host.name}: cannot be reached ({last_line(error_text)}); try: {shlex.join(self.command_line(['true'])[:1] + [self.host.address, 'true'])}")
        if process.returncode != 0:
            raise Failed(f"{self.host.name}: {last_line(error_text)}")
        return None if to is not None else self.checked(what, out)

    def checked(self, what, out):
        """The answer of a host, which is not trusted. Raises Failed."""
        try:
            answer = json.loads(out)
        except (ValueError, RecursionError):
            raise Failed(f"{self.host.name}: its shell prints text besides the answer ({out[:60]!r}); remove the output from "
                         "its start-up files") from None
        if isinstance(answer, dict) and "refusal" in answer:
            raise Failed(f"{self.host.name}: {' '.join(str(answer['refusal'])[:LONGEST_SENTENCE].split())}")
        fault = answers.wrong(what, answer)
        if fault:
            raise Failed(f"{self.host.name}: its answer to {what} is not valid: {fault}; check this host")
        return answer

    def close_shared_connection(self):
        """Closes the shared connection; the next request opens a new one. A connection that does not close in time stays: the caller already
        reports that this host does not answer."""
        if self.host.reach == "ssh":
            with contextlib.suppress(subprocess.TimeoutExpired):
                subprocess.run([*self.ssh_words(self.ssh_options()), "-O", "exit", "--", self.host.address], capture_output=True, check=False, timeout=CLOSE_S)

    def measure_round_trip_s(self):
        """Duration of a request and its answer, s."""
        begin = time.monotonic()
        self.request("ping")
        return time.monotonic() - begin


def last_line(text):
    return text.splitlines()[-1][:LONGEST_SENTENCE] if text else "no reason is given"


def request_all_hosts(connections, make_request):
    """{host: answer, or Unreachable or Failed} of make_request(connection), called in parallel."""
    def safely(connection):
        try:
            return make_request(connection)
        except (Unreachable, Failed) as error:
            return error
    with concurrent.futures.ThreadPoolExecutor(MAX_PARALLEL) as pool:
        return dict(zip(connections, pool.map(safely, connections.values())))
