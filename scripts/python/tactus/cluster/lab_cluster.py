"""A cluster in a lab, for measurements and tests: hosts with faults on request, and an observer on the switch."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time

from tactus.cluster import cluster_file, lab
from tactus.cluster.cluster_operator import Operator
from tactus.cluster.host_connection import Failed, Unreachable  # noqa: F401  re-exported
from tactus.paths import BIN

PATIENCE_S = 60
STABLE_S = 0.3
SILENT_S = 3.0  # the observer receives nothing


class LabCluster:
    """The cluster of a file in a lab with its hosts. Only inside lab.enter()."""

    def __init__(self, file, folder, ordinary=()):
        self.folder = pathlib.Path(folder)
        os.environ["HOME"] = str(self.folder / "home")  # of this process; each host has its own home
        (self.folder / "home").mkdir(parents=True, exist_ok=True)
        self.cluster = cluster_file.read(str(file), self.folder / "plan")
        self.lab = lab.Lab([name for name, host in self.cluster.hosts.items() if host.reach == "ssh"], ordinary)
        self.operator = Operator(self.cluster, str(self.lab.folder / "ssh_config"), quiet=True)
        self.placement = {}
        self.node_states = None

    def up(self):
        """Starts the cluster; returns the seconds until the simulation began."""
        begin = time.monotonic()
        self.operator.up("rehearsal")
        self.operator.wait_for_world()
        seconds = time.monotonic() - begin
        self.placement = self.operator.placement(self.states())
        self.node_states = NodeStates(self.cluster, self.run_id())
        return seconds

    def states(self):
        """{host: state} of the hosts that can be reached; waits long, because a host of a loaded machine answers late."""
        return {host: s for host, s in self.operator.states(patience_s=PATIENCE_S).items() if not isinstance(s, Exception)}

    def run_id(self):
        return next(s["run"]["run_id"] for s in self.states().values() if s["run"])

    def nodes_on(self, host):
        return [n for n, h in self.placement.items() if h == host]

    def all_running(self):
        return self.node_states.all_running(self.placement)

    def wait_until_running(self, patience_s=PATIENCE_S):
        """Seconds until all nodes run, and run for STABLE_S; None on timeout."""
        begin, since = time.monotonic(), None
        while time.monotonic() < begin + patience_s:
            if not self.all_running():
                since = None
            elif since is None:
                since = time.monotonic()
            elif time.monotonic() - since > STABLE_S:
                return since - begin
            time.sleep(0.02)
        return None

    def record(self, name, seconds=None, until=None):
        """summary.json of the observer after `seconds`, or when the event `until` is set; the log stays in the folder."""
        out = self.folder / name
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir(parents=True)
        c = self.cluster
        words = [BIN / "recorder", "--out", out, "--name", "observer", "--run-id", self.node_states.run_id, "--group", c.bus.group, "--port", c.bus.port,
                 "--ttl", "0", "--tags", "none", "--seconds", 1]
        with open(out / "observer.log", "w", encoding="utf-8") as log:
            observer = subprocess.Popen([str(w) for w in words], stderr=log, stdout=log)
        if until is None:
            time.sleep(seconds)
        else:
            until.wait()
        observer.send_signal(signal.SIGTERM)
        observer.wait(20)
        subprocess.run([BIN / "summarise", out, "--out", out / "summary.json"], capture_output=True, check=False)
        return json.loads((out / "summary.json").read_text(encoding="utf-8"))

    def down(self, out):
        """Stops the cluster and gathers its results, with tables of events and clocks. Returns the errors, one sentence each."""
        errors = self.operator.down(out)[0]
        subprocess.run([BIN / "export_events", out, "--out", out], capture_output=True, check=False)
        return errors

    def close(self):
        if self.node_states:
            self.node_states.close()
        self.lab.close()


class NodeStates:
    """The states of all nodes, received ten times a second."""

    def __init__(self, cluster, run_id):
        self.run_id = run_id
        self.newest, self.received_s = {}, 0.0
        words = [BIN / "watch", "--json", "--period", "0.1", "--run-id", run_id, "--group", cluster.bus.group, "--port", cluster.bus.port]
        self.process = subprocess.Popen([str(w) for w in words], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        threading.Thread(target=self.receive, daemon=True).start()

    def receive(self):
        for line in self.process.stdout:
            try:
                self.newest, self.received_s = json.loads(line)["nodes"], time.monotonic()
            except (ValueError, KeyError):
                continue  # incomplete line at the end

    def state(self, node):
        return self.newest.get(node, {}).get("state", "nothing received") if time.monotonic() < self.received_s + SILENT_S else "nothing received"

    def all_running(self, nodes):
        return all(self.state(n) == "running" for n in nodes)

    def close(self):
        self.process.terminate()
        self.process.wait()


def enter(script, words):
    """Restarts the script in new namespaces, unless it runs inside; exits with 77 when the system refuses."""
    if lab.is_inside():
        del os.environ["TACTUS_LAB_INSIDE"]
        for number in (signal.SIGTERM, signal.SIGHUP):  # the first process of a namespace receives only signals with a handler
            signal.signal(number, lambda *_: sys.exit("ended from outside"))
        return
    try:
        lab.enter([sys.executable, "-I", os.path.abspath(script), *words])
    except lab.Error as error:
        print(f"skipped: {error}")
        sys.exit(77)
