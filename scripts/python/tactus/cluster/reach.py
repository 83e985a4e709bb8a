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
ASK_S = 10
MOST_AT_ONCE = 32


class Unreachable(Exception):
    """The host cannot be reached; one sentence."""


class Failed(Exception):
    """The host was reached but the request failed; one sentence."""


def control_folder(ssh_config):
    """Folder of the sockets of shared ssh connections, private to the user. ssh names a socket by user, host and port, so each
    configuration and each network namespace has its own folder. Raises Unreachable."""
    parent = pathlib.Path(os.environ.get("XDG_RUNTIME_DIR") or f"/tmp/tactus-ssh-{os.getuid()}")
    way = f"{pathlib.Path(ssh_config).resolve() if ssh_config else ''} {os.readlink('/proc/self/ns/net')}"
    folder = parent / "tactus" / hashlib.sha256(way.encode()).hexdigest()[:8]
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    if folder.stat().st_uid != os.getuid() or parent.stat().st_uid not in (os.getuid(), 0):
        raise Unreachable(f"the folder {folder} belongs to another user; set XDG_RUNTIME_DIR to your own folder")
    return folder


class Reach:
    def __init__(self, host, ssh_config=None):
        self.host, self.ssh_config = host, ssh_config

    def words(self, command):
        """The command line that runs a command on the host."""
        if self.host.reach == "local":
            return list(command)
        if self.host.reach == "namespace":
            return ["ip", "netns", "exec", self.host.address, *command]
        options = ["BatchMode=yes", f"ConnectTimeout={CONNECT_S}", "ServerAliveInterval=1", "ServerAliveCountMax=3", "ControlMaster=auto",
                   f"ControlPath={control_folder(self.ssh_config)}/%C", "ControlPersist=60", "LogLevel=ERROR"]
        return ["ssh", "-T", *(["-F", str(self.ssh_config)] if self.ssh_config else []), *(w for o in options for w in ("-o", o)),
                self.host.address, "--", shlex.join(command)]

    def ask(self, what, patience_s=ASK_S, data=None, to=None, **request):
        """The answer of the agent to a request. data: bytes to send with it; to: file for the output, then the result is None.
        Raises Unreachable or Failed."""
        modules = {name: path.read_text(encoding="utf-8") for name, path in MODULES.items()}
        asked = {"what": what, "folder": self.host.folder, **request}
        line = base64.b64encode(zlib.compress(json.dumps({"modules": modules, "request": asked}).encode())) + b"\n"
        process = subprocess.Popen(self.words(["/usr/bin/python3", "-I", "-c", LOADER]), stdin=subprocess.PIPE, stdout=to or subprocess.PIPE,
                                   stderr=subprocess.PIPE, start_new_session=True)
        try:
            out, err = process.communicate(line + (data or b""), timeout=patience_s)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            self.forget()
            raise Unreachable(f"{self.host.name}: does not answer within {patience_s:g} s") from None
        said = err.decode("utf-8", "replace").strip()
        if process.returncode == 255 and self.host.reach == "ssh" or process.returncode == 127:
            raise Unreachable(f"{self.host.name}: cannot be reached ({last_line(said)}); try: {shlex.join(self.words(['true'])[:1] + [self.host.address, 'true'])}")
        if process.returncode != 0:
            raise Failed(f"{self.host.name}: {last_line(said)}")
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

    def forget(self):
        """Closes the shared connection; the next request opens a new one."""
        if self.host.reach == "ssh":
            words = self.words(["true"])
            subprocess.run([*words[:-2][:-1], "-O", "exit", self.host.address], capture_output=True, check=False, timeout=5)

    def measure_s(self):
        """Duration of a request and its answer, s."""
        begin = time.monotonic()
        self.ask("nothing")
        return time.monotonic() - begin


def last_line(text):
    return text.splitlines()[-1] if text else "no reason is given"


def of_all(reaches, question):
    """{host: answer, or Unreachable or Failed} of question(reach), called in parallel."""
    def safely(reach):
        try:
            return question(reach)
        except (Unreachable, Failed) as error:
            return error
    with concurrent.futures.ThreadPoolExecutor(MOST_AT_ONCE) as pool:
        return dict(zip(reaches, pool.map(safely, reaches.values())))
