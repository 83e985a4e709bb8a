"""How a host is reached: as this machine, over ssh, or as a network namespace of this machine. Everything that is asked of a host
is asked of agent.py, which goes there with each question: a host needs nothing of ours before.

No question waits longer than it is given: a host that does not answer is one that is not there."""
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
# What the agent needs, packages before what is in them; in an order in which each imports only those before it.
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
    """One sentence."""


class Failed(Exception):
    """The host was reached and cannot do it; one sentence."""


def control_folder(ssh_config):
    """For the connections that ssh shares between questions; only ours. ssh names them by user, host and port: a host of that name which another
    configuration or another network leads to is another host, and has a folder of its own."""
    parent = pathlib.Path(os.environ.get("XDG_RUNTIME_DIR") or f"/tmp/tactus-ssh-{os.getuid()}")
    way = f"{pathlib.Path(ssh_config).resolve() if ssh_config else ''} {os.readlink('/proc/self/ns/net')}"
    folder = parent / "tactus" / hashlib.sha256(way.encode()).hexdigest()[:8]
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    if folder.stat().st_uid != os.getuid() or parent.stat().st_uid not in (os.getuid(), 0):
        raise Unreachable(f"the folder {folder} belongs to somebody else; set XDG_RUNTIME_DIR to one of your own")
    return folder


class Reach:
    def __init__(self, host, ssh_config=None):
        self.host, self.ssh_config = host, ssh_config

    def words(self, command):
        """The command line that runs the words there."""
        if self.host.reach == "local":
            return list(command)
        if self.host.reach == "namespace":
            return ["ip", "netns", "exec", self.host.address, *command]
        options = ["BatchMode=yes", f"ConnectTimeout={CONNECT_S}", "ServerAliveInterval=1", "ServerAliveCountMax=3", "ControlMaster=auto",
                   f"ControlPath={control_folder(self.ssh_config)}/%C", "ControlPersist=60", "LogLevel=ERROR"]
        return ["ssh", "-T", *(["-F", str(self.ssh_config)] if self.ssh_config else []), *(w for o in options for w in ("-o", o)),
                self.host.address, "--", shlex.join(command)]

    def ask(self, what, patience_s=ASK_S, data=None, to=None, **request):
        """What the agent answers to the request. data: a file that goes there; to: one that what comes is written to, and then
        there is no answer. Raises Unreachable or Failed."""
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
            raise Failed(f"{self.host.name}: its shell says something before or after what it is asked ({out[:60]!r}); make it silent "
                         "for commands") from None
        if "refusal" in answer:
            raise Failed(f"{self.host.name}: {answer['refusal']}")
        return answer

    def forget(self):
        """Ends the shared connection: the next question makes a new one."""
        if self.host.reach == "ssh":
            words = self.words(["true"])
            subprocess.run([*words[:-2][:-1], "-O", "exit", self.host.address], capture_output=True, check=False, timeout=5)

    def measure_s(self):
        """How long a question and its answer take."""
        begin = time.monotonic()
        self.ask("nothing")
        return time.monotonic() - begin


def last_line(text):
    return text.splitlines()[-1] if text else "no reason is given"


def of_all(reaches, question):
    """{host: answer, or the Unreachable or Failed} of question(reach) to each at once."""
    def safely(reach):
        try:
            return question(reach)
        except (Unreachable, Failed) as error:
            return error
    with concurrent.futures.ThreadPoolExecutor(MOST_AT_ONCE) as pool:
        return dict(zip(reaches, pool.map(safely, reaches.values())))
