"""Sends requests to a host: this machine, over ssh, or a network namespace of this machine. Each request carries agent.py, which
answers it, so that a host needs no installation.

Each request has a timeout; a host that does not answer in time counts as unreachable."""
import base64
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import time
import zlib

PACKAGE = pathlib.Path(__file__).resolve().parents[1]
# Modules of the agent, in import order: packages before their modules.
MODULES = {"tactus": PACKAGE / "__init__.py", "tactus.refusal": PACKAGE / "refusal.py",
           "tactus.launch": PACKAGE / "launch" / "__init__.py", "tactus.launch.services": PACKAGE / "launch" / "services.py",
           "tactus.launch.network": PACKAGE / "launch" / "network.py",
           "tactus.cluster": PACKAGE / "cluster" / "__init__.py", "tactus.cluster.shader_cache": PACKAGE / "cluster" / "shader_cache.py",
           "tactus.cluster.agent": PACKAGE / "cluster" / "agent.py"}
LOADER = ("import sys,json,types,base64,zlib\n"
          "p=json.loads(zlib.decompress(base64.b64decode(sys.stdin.buffer.readline())))\n"
          "for n,s in p['modules'].items():\n"
          " m=types.ModuleType(n);sys.modules[n]=m;exec(compile(s,n+'.py','exec'),m.__dict__)\n"
          "sys.modules['tactus.cluster.agent'].main(p['request'])")
CONNECT_S = 3
REQUEST_S = 10
MAX_PARALLEL = 32


class Unreachable(Exception):
    """The host cannot be reached; one sentence."""


class Failed(Exception):
    """The host was reached but the request failed; one sentence."""


def control_folder(ssh_config):
    """Folder of the sockets of shared ssh connections, private to the user. ssh names a socket by user, host and port, so each
    configuration and each network namespace has its own folder. Raises Unreachable."""
    parent = pathlib.Path(os.environ.get("XDG_RUNTIME_DIR") or f"/tmp/tactus-ssh-{os.getuid()}")
    scope = f"{pathlib.Path(ssh_config).resolve() if ssh_config else ''} {os.readlink('/proc/self/ns/net')}"
    folder = parent / "tactus" / hashlib.sha256(scope.encode()).hexdigest()[:8]
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    if folder.stat().st_uid != os.getuid() or parent.stat().st_uid not in (os.getuid(), 0):
        raise Unreachable(f"the folder {folder} belongs to another user; set XDG_RUNTIME_DIR to your own folder")
    return folder


class HostConnection:
    """Sends requests to one host; each starts an agent there."""

    def __init__(self, host, ssh_config=None):
        self.host, self.ssh_config = host, ssh_config

    def command_line(self, command):
        """The command line that runs a command on the host."""
        if self.host.reach == "local":
            return list(command)
        if self.host.reach == "namespace":
            return ["ip", "netns", "exec", self.host.address, *command]
        options = ["BatchMode=yes", f"ConnectTimeout={CONNECT_S}", "ServerAliveInterval=1", "ServerAliveCountMax=3", "ControlMaster=auto",
                   f"ControlPath={control_folder(self.ssh_config)}/%C", "ControlPersist=60", "LogLevel=ERROR"]
        return ["ssh", "-T", *(["-F", str(self.ssh_config)] if self.ssh_config else []), *(w for o in options for w in ("-o", o)),
                self.host.address, "--", shlex.join(command)]

    def request(self, what, patience_s=REQUEST_S, data=None, to=None, **fields):
        """The answer of the agent to a request. data: bytes to send with it; to: file for the output, then the result is None.
        Raises Unreachable or Failed."""
        modules = {name: path.read_text(encoding="utf-8") for name, path in MODULES.items()}
        request_fields = {"what": what, "folder": self.host.folder, **fields}
        line = base64.b64encode(zlib.compress(json.dumps({"modules": modules, "request": request_fields}).encode())) + b"\n"
        process = subprocess.Popen(self.command_line(["/usr/bin/python3", "-I", "-c", LOADER]), stdin=subprocess.PIPE, stdout=to or subprocess.PIPE,
                                   stderr=subprocess.PIPE, start_new_session=True)
        try:
            out, err = process.communicate(line + (data or b""), timeout=patience_s)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            self.close_shared_connection()
            raise Unreachable(f"{self.host.name}: does not answer within {patience_s:g} s") from None
        error_text = err.decode("utf-8", "replace").strip()
        if process.returncode == 255 and self.host.reach == "ssh" or process.returncode == 127:
            raise Unreachable(f"{self.host.name}: cannot be reached ({last_line(error_text)}); try: {shlex.join(self.command_line(['true'])[:1] + [self.host.address, 'true'])}")
        if process.returncode != 0:
            raise Failed(f"{self.host.name}: {last_line(error_text)}")
        if to is not None:
            return None
        try:
            answer = json.loads(out)
        except ValueError:
            raise Failed(f"{self.host.name}: its shell prints text besides the answer ({out[:60]!r}); remove the output from "
                         "its start-up files") from None
        if "refusal" in answer:
            raise Failed(f"{self.host.name}: {answer['refusal']}")
        return answer

    def close_shared_connection(self):
        """Closes the shared connection; the next request opens a new one."""
        if self.host.reach == "ssh":
            words = self.command_line(["true"])
            subprocess.run([*words[:-2][:-1], "-O", "exit", self.host.address], capture_output=True, check=False, timeout=5)

    def measure_round_trip_s(self):
        """Duration of a request and its answer, s."""
        begin = time.monotonic()
        self.request("ping")
        return time.monotonic() - begin


def last_line(text):
    return text.splitlines()[-1] if text else "no reason is given"


def request_all_hosts(connections, make_request):
    """{host: answer, or Unreachable or Failed} of make_request(connection), called in parallel."""
    def safely(connection):
        try:
            return make_request(connection)
        except (Unreachable, Failed) as error:
            return error
    with concurrent.futures.ThreadPoolExecutor(MAX_PARALLEL) as pool:
        return dict(zip(connections, pool.map(safely, connections.values())))
