"""The operations of tactus cluster: up, down, restart, move, and requests to the hosts."""
import base64
import os
import shutil
import subprocess
import sys
import tempfile
import time

from tactus.cluster import archives, commands, deployment
from tactus.cluster.cluster_file import RECORDER, SYNC, WORLD
from tactus.cluster.host_connection import Failed, HostConnection, Unreachable, request_all_hosts
from tactus.launch import results
from tactus.launch.arguments import SENSES
from tactus.refusal import Refusal, sentence_of
from tactus.terminal import report

ANSWER_S = 30         # starts an agent, which may read a build; a busy host takes several seconds
SEND_S = 600          # for a build over a slow line
CHECK_S = 620         # agent.READ_SCENE_S and the transfer
START_S, STOP_S = 60, 45
LOADING_S = 600
SHADERS_S = 20
LARGEST_RESULTS_BYTES = 500_000_000_000  # design: of one host, a day of all channels and videos
RESERVE_BYTES = 1_000_000_000            # design: of the disk, left free
PICTURE = "visual_node"
LAST_PRESENTATION_S = 0.2  # sound comes 20 ms after its event, and each report is repeated 20 ms later


class Operator:
    """Sends requests to the hosts of a cluster file. Only the hosts store the state of running nodes."""

    def __init__(self, cluster, ssh_config=None, quiet=False):
        self.cluster, self.quiet = cluster, quiet
        self.connections = {name: HostConnection(host, ssh_config) for name, host in cluster.hosts.items()}
        self.files = self.identity = None
        self.stop_time_s = 0.0  # when a node was last asked to end, for a restart or a move

    def report(self, text):
        if not self.quiet:
            report(f"cluster: {text}")

    def common(self, host):
        """Fields of every request to an agent."""
        return {"cluster": self.cluster.name, "build": self.identity or "", "own_build": self.cluster.hosts[host].build}

    def request(self, host, what, patience_s=ANSWER_S, **fields):
        return self.connections[host].request(what, patience_s=patience_s, **self.common(host), **fields)

    def request_all(self, what, hosts=None, patience_s=ANSWER_S, **fields):
        """{host: answer or error}; callable values of the request are called with the name of the host."""
        hosts = self.connections if hosts is None else {h: self.connections[h] for h in hosts}
        made = {h: {k: v(h) if callable(v) else v for k, v in fields.items()} for h in hosts}
        return request_all_hosts(hosts, lambda connection: connection.request(
            what, patience_s=patience_s, **self.common(connection.host.name), **made[connection.host.name]))

    def require_answers(self, answers):
        """Returns the answers; raises Refusal with the first error among them."""
        for answer in answers.values():
            if isinstance(answer, Exception):
                raise Refusal(str(answer))
        return answers

    def states(self, patience_s=ANSWER_S):
        return self.request_all("node_states", patience_s=patience_s)

    # up

    def up(self, git, forced=()):
        """Starts all nodes that do not run. Skips and reports unreachable hosts; raises Refusal when one of them has sim_node or the recorder."""
        self.files = deployment.parts()
        self.identity = deployment.identity(self.files)
        host_info = self.request_all("inspect_host")
        unreachable = {h: a for h, a in host_info.items() if isinstance(a, Exception)}
        for host, error in unreachable.items():
            needed = [n for n in (WORLD, RECORDER) if self.cluster.nodes[n].host == host]
            if needed:
                raise Refusal(f"{error}; {needed[0]} must run there; make the host reachable or place the node elsewhere in the file")
            self.report(f"{error}; skipped; run tactus cluster up again to add it")
        hosts = [h for h in host_info if h not in unreachable]
        runs = {h: host_info[h]["run"] for h in hosts if host_info[h]["run"]}
        self.reject_mixed_builds(host_info, hosts, runs)
        run_ids = {kept["run_id"] for kept in runs.values()}
        if len(run_ids) > 1:
            raise Refusal(f"two runs of {self.cluster.name} exist ({', '.join(f'{r} on {h}' for h, r in ((h, k['run_id']) for h, k in runs.items()))}); "
                          "end both with tactus cluster down")
        run_id = run_ids.pop() if run_ids else time.time_ns()
        self.install(host_info, hosts)
        own, there = deployment.run_files(self.cluster)
        words = commands.node_commands(self.cluster, run_id, git, there)
        new = [h for h in hosts if h not in runs]
        if has_run_files(there):
            self.require_answers(self.send(new, "files", own))
        placed = self.placement(self.request_all("node_states", hosts)) if runs else {}
        self.stop_duplicate_nodes(runs)
        wanted = {h: [n for n in self.cluster.nodes_on(h) if placed.get(n, h) == h] for h in hosts}
        self.check(new, words, wanted)
        if not runs:
            self.reject_port_conflict(hosts, run_id)
        url = {"group": self.cluster.bus.group, "port": self.cluster.bus.port, "ttl": self.cluster.bus.ttl}
        answers = self.require_answers(self.request_all("prepare", new, patience_s=START_S, nodes=words, run_id=run_id, private=self.cluster.is_private(), **url))
        for host, answer in answers.items():
            if answer.get("kept"):
                self.report(f"{host}: results of an earlier run, which were not gathered, are on this host in {answer['kept']}")
        self.start_all(hosts, wanted)
        return unreachable

    def stop_duplicate_nodes(self, runs):
        """Stops nodes that run twice, after a move from an unreachable host; the later place is kept."""
        holders = {}
        for host, kept in runs.items():
            for name in kept["here"]:
                holders.setdefault(name, []).append((kept.get("since", {}).get(name, 0.0), host))
        for name, places in holders.items():
            for _, host in sorted(places)[:-1]:
                self.request(host, "stop", patience_s=STOP_S, names=[name], leave=True, patience=3)
                self.report(f"{name} still ran on {host} after it had been moved to another host; it was stopped on {host}")

    def reject_mixed_builds(self, host_info, hosts, runs):
        ours = deployment.messages()
        for host in hosts:
            a = host_info[host]
            if not a["runit"]:
                raise Refusal(f"{host}: runit is not installed; run on this host: apt install runit")
            own = self.cluster.hosts[host].build
            if own and not a["messages"]:
                raise Refusal(f"{host}: its build=\"{own}\" does not exist or does not run; build it, or remove build= to install this build")
            if own and a["messages"] != ours:
                raise Refusal(f"{host}: the messages of its build differ: {first_difference(ours, a['messages'])}; build the same version there, or remove build= "
                              "to install this build")
            if host in runs and runs[host]["build"] != self.identity and not own:
                raise Refusal(f"{host}: runs the build {runs[host]['build']}, and this machine has {self.identity}; all hosts of a cluster run one build: run tactus cluster "
                              "down first")
            if not own and a["machine"] != os.uname().machine:
                raise Refusal(f"{host}: is a {a['machine']}, but this build is for {os.uname().machine}; build there, and name its folder with build=")

    def install(self, host_info, hosts):
        lacking = [h for h in hosts if not host_info[h]["build"]]
        if lacking:
            packed = deployment.packed(self.files)
            self.report(f"installing this build ({len(packed) / 1e6:.0f} MB) on {', '.join(lacking)}")
            self.require_answers(self.send(lacking, "build", packed))
            host_info |= self.require_answers(self.request_all("inspect_host", lacking))
        for host, answer in ((h, host_info[h]) for h in hosts):
            if answer["missing"]:
                raise Refusal(f"{host}: lacks {', '.join(answer['missing'])}; run on this host: apt install {' '.join(debian_packages(answer['missing']))}")
            if not answer["messages"]:
                raise Refusal(f"{host}: the programs installed there do not run; its processor or its C library may be older than that of this machine: build there, "
                              "and name the folder with build=")

    def send(self, hosts, into, data):
        connections = {h: self.connections[h] for h in hosts}
        return request_all_hosts(connections, lambda connection: connection.request(
            "receive", patience_s=SEND_S, data=data, into=into, **self.common(connection.host.name)))

    def check(self, hosts, words, wanted):
        """Runs each node with --check on its host. Raises Refusal."""
        answers = self.require_answers(self.request_all("check", hosts, patience_s=CHECK_S, nodes=lambda h: {n: words[n] for n in wanted[h]}))
        for host, findings in answers.items():
            warnings = findings.pop("warnings", "")
            for name, sentence in findings.items():
                raise Refusal(f"{host}: {sentence}")
            if warnings:
                report(warnings, sys.stderr)

    def reject_port_conflict(self, hosts, run_id):
        """Raises Refusal when another cluster uses the same group and port, because both would receive the messages of the other."""
        if self.cluster.is_private():
            return
        words = ["@BUILD@/bin/watch", "--once", "--run-id", "0", "--group", self.cluster.bus.group, "--port", str(self.cluster.bus.port)]
        answers = self.request_all("run_bus_program", hosts, patience_s=15, patience=10, words=words)
        for host, a in answers.items():
            if isinstance(a, Exception):
                raise Refusal(f"{a}")
            if a["status"] == 0:
                raise Refusal(f"{host}: another cluster already uses {self.cluster.bus.group}, port {self.cluster.bus.port}; choose another port= of "
                              "<bus>, or end the other cluster")
            if "route" in a["err"] or "join" in a["err"]:
                raise Refusal(f"{host}: {a['err'].strip().splitlines()[-1]}")

    def start_all(self, hosts, wanted):
        for group in self.start_groups():
            names = {h: [n for n in wanted[h] if n in group] for h in hosts}
            at = [h for h in hosts if names[h]]
            if at:
                self.require_answers(self.request_all("start", at, patience_s=START_S, names=lambda h, names=names: names[h], patience=5))

    def start_groups(self):
        """Names of the nodes, in groups, in start order."""
        syncs = [n for n in self.cluster.nodes if n == SYNC or n.startswith(SYNC + "_")]
        senses = [n for n in self.cluster.nodes if n.startswith(SENSES)]
        return ([RECORDER, *syncs, *self.relays()], senses, [WORLD])

    def relays(self):
        return list(self.cluster.relays.by_name) if self.cluster.relays else []

    def wait_for_world(self):
        """True when the simulation began; False after LOADING_S. Raises Refusal when sim_node was left down."""
        host, begin = self.cluster.nodes[WORLD].host, time.monotonic()
        last_report = begin
        while time.monotonic() < begin + LOADING_S:
            answer = self.request_all("node_states", [host], patience_s=5)[host]
            node = {} if isinstance(answer, Exception) else answer["nodes"].get(WORLD, {})
            if node.get("begun"):
                return True
            if node.get("lost"):
                raise Refusal(f"{WORLD}: {node['lost']} ({node['last']})")
            if time.monotonic() > last_report + 5:
                last_report = time.monotonic()
                self.report(f"{WORLD} is still reading the scene ({last_report - begin:.0f} s)")
            time.sleep(0.1)
        return False

    # placement of nodes

    def placement(self, states):
        """{node: host} as reported by the hosts; after a move it differs from the file."""
        found = {}
        for host, s in states.items():
            if not isinstance(s, Exception):
                for name in s["nodes"]:
                    found.setdefault(name, host)
        return found

    def host_of(self, node):
        """The host that runs the node. Raises Refusal."""
        if node not in self.cluster.nodes:
            raise Refusal(f"{node}: there is no such node in {self.cluster.name}; there are {', '.join(self.cluster.nodes)}")
        states = self.states()
        if all(isinstance(s, Exception) for s in states.values()):
            raise Refusal(str(next(iter(states.values()))))
        host = self.placement(states).get(node)
        if host is None:
            unreachable = [h for h, s in states.items() if isinstance(s, Exception)]
            raise Refusal(f"{node}: runs on no reachable host" + (f" (not reachable: {', '.join(unreachable)}); --lost moves it anyway, and a later tactus cluster up stops it there" if unreachable else "; start it with tactus cluster up"))
        return host

    def restart(self, node):
        host = self.host_of(node)
        self.stop_time_s = time.monotonic()
        self.request(host, "restart", patience_s=STOP_S + START_S, names=[node], patience=3)
        self.report(f"{node} was restarted on {host}, {time.monotonic() - self.stop_time_s:.1f} s after it was asked to end")

    def move(self, node, to, restart_world=False, lost=False, shaders=False):
        """shaders: copies compiled shaders, which the new host runs; only between hosts that are trusted alike."""
        if to not in self.cluster.hosts:
            raise Refusal(f"{to}: there is no such host in {self.cluster.name}; there are {', '.join(self.cluster.hosts)}")
        if node.startswith(SYNC):
            raise Refusal(f"{node}: each host has its own sync_node, which cannot be moved")
        if node in self.relays():
            raise Refusal(f"{node}: the relays of other sites expect it on this host; place it elsewhere in the file and start a new run")
        if node == RECORDER:
            raise Refusal(f"{node}: its recording is on its host; end the run, place it elsewhere in the file and start a new run")
        if node == WORLD and not restart_world:
            raise Refusal(f"{node}: after a move its simulation restarts from the beginning; confirm with --restart")
        origin = None if lost else self.host_of(node)
        if lost and any(node in s["nodes"] for s in self.states().values() if not isinstance(s, Exception)):
            raise Refusal(f"{node}: its host can be reached; remove --lost")
        if origin == to:
            raise Refusal(f"{node}: already runs on {to}; name another host")
        state = self.request(to, "node_states")
        if not state["run"]:
            raise Refusal(f"{to}: the cluster does not run there yet; run tactus cluster up first")
        self.identity = state["run"]["build"]
        if shaders and not lost and node.startswith(PICTURE):
            self.copy_shaders(origin, to)
        self.stop_time_s = time.monotonic()
        killed = [] if lost else self.request(origin, "stop", patience_s=STOP_S, names=[node], leave=True, patience=3)["killed"]
        try:
            self.request(to, "start", patience_s=START_S, names=[node])
        except (Unreachable, Failed) as error:
            self.request(to, "stop", patience_s=STOP_S, names=[node], leave=True)
            if not lost:
                self.request(origin, "start", patience_s=START_S, names=[node])
            raise Refusal(f"{node}: does not start on {to} ({error})" + ("" if lost else f"; it runs on {origin} again")) from None
        self.report(f"{node} moved from {origin or 'an unreachable host'} to {to} in {time.monotonic() - self.stop_time_s:.1f} s" + (f"; it did not end on request and was killed" if killed else ""))

    def copy_shaders(self, origin, to):
        """Copies compiled shaders before visual_node stops; without them the new host compiles for seconds."""
        try:
            data = base64.b64decode(self.request(origin, "shaders", patience_s=SHADERS_S)["tar"], validate=True)
            self.request(to, "store_shaders", patience_s=SHADERS_S, data=data)
        except (Unreachable, Failed, ValueError) as error:
            self.report(f"shaders were not copied ({error}); the picture may need seconds to start")

    def run_bus_program(self, words, files):
        """Runs a program of the bus on the host of the recorder, with these files in its folder. Returns status, out and err."""
        host = self.cluster.nodes[RECORDER].host
        state = self.request(host, "node_states")
        if not state["run"]:
            raise Refusal(f"no node of {self.cluster.name} runs; start it with tactus cluster up")
        self.identity = state["run"]["build"]
        bus = self.cluster.bus
        words = ["@BUILD@/bin/" + words[0], *words[1:], "--group", bus.group, "--port", str(bus.port), "--ttl", str(bus.ttl), "--run-id", str(state["run"]["run_id"])]
        return self.request(host, "run_bus_program", patience_s=40, patience=30, words=words, files=files)

    # down

    def down(self, out):
        """Stops everything in order and gathers the results in the folder. Returns the errors, one sentence each, and the
        arguments of summarise(): duration, nodes not expected at the end, restarts; None when nothing ran."""
        states = self.states()
        runs = {h: s["run"] for h, s in states.items() if not isinstance(s, Exception) and s["run"]}
        errors = [str(s) + "; its nodes continue to run; repeat tactus cluster down when it is reachable" for s in states.values() if isinstance(s, Exception)]
        if not runs:
            return errors or [f"no node of {self.cluster.name} runs"], None
        nodes = {name: (h, node) for h, s in states.items() if h in runs for name, node in s["nodes"].items()}
        seconds = time.time() - min(kept["began"] for kept in runs.values())
        lost = [n for n, (_, node) in nodes.items() if node["lost"] or node["taken_down"]]
        for group in ([WORLD], [n for n in nodes if n.startswith(SENSES)], [n for n in nodes if n.startswith(SYNC)], self.relays(), [RECORDER]):
            at = {h: [n for n in group if n in nodes and nodes[n][0] == h] for h in runs}
            answers = self.request_all("stop", [h for h in at if at[h]], patience_s=STOP_S, names=lambda h, at=at: at[h], patience=15)
            for host, a in answers.items():
                errors += [str(a)] if isinstance(a, Exception) else [f"{n}: did not end on request and was killed; see {out}/{host}/logs" for n in a["killed"]]
            if group == [WORLD]:
                time.sleep(LAST_PRESENTATION_S)
        for host, a in self.request_all("end_supervisor", list(runs), patience_s=STOP_S).items():
            errors += [str(a)] if isinstance(a, Exception) else []
        errors += self.collect_results(out, list(runs))
        restarts = {n: node["deaths"] for n, (_, node) in nodes.items() if node["deaths"]}
        missing = [n for n in self.cluster.plan.nodes() if n not in nodes]
        return errors, {"seconds": seconds, "lost": {*lost, *missing}, "restarts": restarts}

    def summarise(self, out, git, seconds, lost, restarts):
        """Summary and tables, as scripts/run makes them. Returns the errors, one sentence each."""
        for name, count in restarts.items():
            self.report(f"{name} died and was restarted {count} times" if count > 1 else f"{name} died once and was restarted")
        self.cluster.plan.out, self.cluster.plan.seconds = out, seconds
        return results.summarise(self.cluster.plan, git, lost, restarts, [])

    def collect_results(self, out, hosts):
        """Copies the results of the recorder host into the folder itself, of each other host into a subfolder of its name. Only regular files are
        written, as files of this user, and at most the free space of the disk. Returns the errors."""
        first = self.cluster.nodes[RECORDER].host
        others = [host for host in self.cluster.hosts if host != first]
        errors = []
        for host in hosts:
            into = out if host == first else out / host
            into.mkdir(parents=True, exist_ok=True)
            largest = min(LARGEST_RESULTS_BYTES, shutil.disk_usage(into).free - RESERVE_BYTES)
            try:
                with tempfile.TemporaryFile(dir=into) as file:
                    self.connections[host].request("collect", patience_s=SEND_S, to=file, largest_bytes=max(1, largest // 2), **self.common(host))
                    file.seek(0)
                    archives.unpack(file, into, largest - os.fstat(file.fileno()).st_size, others if host == first else ())
            except archives.Unsafe as error:
                errors.append(f"{host}: the archive of its results {error}; the rest was not unpacked, and the originals are in its folder on the host")
            except OSError as error:
                errors.append(f"{host}: its results cannot be written ({sentence_of(error)}); the originals are in its folder on the host")
            except (Unreachable, Failed) as error:
                errors.append(f"{error}; its results remain on the host")
        return errors


def has_run_files(there):
    return any(path.startswith("@FILES@") for path in there.values())


def first_difference(ours, theirs):
    """Text of the first line in which the messages of two builds differ."""
    for mine, other in zip(ours.splitlines(), theirs.splitlines()):
        if mine != other:
            return f"\"{other.strip()}\" where this build has \"{mine.strip()}\""
    return "it has other messages"


def debian_packages(libraries):
    """Debian packages of shared libraries, looked up on this machine."""
    found = []
    for name in libraries:
        owners = subprocess.run(["dpkg", "-S", name], capture_output=True, text=True, check=False).stdout
        found.append(owners.partition(":")[0] if owners else name)
    return sorted(set(found))
