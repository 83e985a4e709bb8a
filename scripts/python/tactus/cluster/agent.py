"""The agent: runs on a host for one request, which host_connection.py sends together with this code, answers and exits. runit
supervises the nodes, as on one machine (scripts/python/tactus/launch/services.py)."""
import base64
import contextlib
import gzip
import io
import json
import os
import pathlib
import platform
import resource
import shutil
import signal
import subprocess
import sys
import tarfile
import time

from tactus import own_files
from tactus.cluster import archives, shader_cache
from tactus.cluster.agent_folders import build_folder, builds_in_use, cluster_home, entering, run_record, write_run_record
from tactus.launch import cluster_folder, network, privileges, services
from tactus.refusal import Refusal

KEPT_BUILDS = 3
LARGEST_FILES_BYTES = 4_000_000_000  # design: of a build, or of a scene with its files
CHECK_S, READ_SCENE_S = 60, 600
END_S = 5
URL = "udpm://{group}:{port}?ttl={ttl}"


def ping(_):
    return {}


def inspect_host(request):
    """Properties of this host, and the state of build and cluster on it."""
    build = build_folder(request)
    programs = [str(p) for p in sorted((build / "bin").glob("*")) if p.is_file()] if build.is_dir() else []
    run = run_record(request)
    return {"machine": platform.machine(), "python": platform.python_version(), "runit": bool(shutil.which("runsvdir")), "cores": os.cpu_count(),
            "build": build.is_dir(), "missing": missing_libraries(programs), "messages": message_types(build), "run": run,
            "realtime": resource.getrlimit(resource.RLIMIT_RTPRIO)[1], "root": os.geteuid() == 0}


def missing_libraries(programs):
    output = subprocess.run(["ldd", *programs], capture_output=True, text=True, check=False).stdout if programs else ""
    return sorted({line.split()[0] for line in output.splitlines() if "not found" in line})


def message_types(build):
    try:
        return subprocess.run([build / "bin" / "message_types"], capture_output=True, text=True, check=True, timeout=10).stdout
    except (OSError, subprocess.SubprocessError):
        return ""


def receive(request):
    """Unpacks the tar behind the request: a build, or the files of a run. All or nothing."""
    into = build_folder(request) if request["into"] == "build" else cluster_home(request) / "files"
    own_files.make_private_folder(into.parent)
    fresh = into.with_name(f"{into.name}.{os.getpid()}.new")
    try:
        archives.unpack(io.BytesIO(sys.stdin.buffer.read()), fresh, LARGEST_FILES_BYTES)
    except (OSError, archives.Unsafe) as error:
        shutil.rmtree(fresh, ignore_errors=True)
        raise Refusal(f"cannot unpack the received files in {into.parent} ({error}); free space there, or set another folder= of the host") from None
    shutil.rmtree(into, ignore_errors=True)
    fresh.rename(into)
    if request["into"] == "build":
        old = sorted((p for p in into.parent.iterdir() if p != into), key=lambda p: p.stat().st_mtime)
        in_use = builds_in_use(request)
        for path in old[:max(0, len(old) - KEPT_BUILDS + 1)]:
            if path.name not in in_use:
                shutil.rmtree(path, ignore_errors=True)
    return {}


def shaders(_):
    """The compiled shaders of this host, base64."""
    return {"tar": base64.b64encode(shader_cache.packed(shader_cache.folder())).decode()}


def store_shaders(_):
    """Stores the shaders behind the request."""
    return {"stored": shader_cache.unpack(sys.stdin.buffer.read(), shader_cache.folder())}


def with_folders(request, words):
    """The words with placeholders replaced by the folders of this host."""
    into = {"@BUILD@": str(build_folder(request)), "@FILES@": str(cluster_home(request) / "files"), "@OUT@": str(cluster_home(request) / "out")}
    done = []
    for word in words:
        for mark, folder in into.items():
            word = word.replace(mark, folder)
        done.append(word)
    return done


def check(request):
    """Runs all nodes with --check in parallel; {node: error}, and "warnings"."""
    started = {}
    for name, words in request["nodes"].items():
        words = with_folders(request, words)
        at = words.index("--out")
        started[name] = subprocess.Popen(privileges.least(words[:at] + words[at + 2:] + ["--check"]), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                         stderr=subprocess.PIPE, text=True, errors="replace")
    findings = {}
    for name, process in started.items():
        patience_s = READ_SCENE_S if name == "sim_node" else CHECK_S
        try:
            text = process.communicate(timeout=patience_s)[1].strip()
        except subprocess.TimeoutExpired:
            process.kill()
            text = f"{name}: does not finish its checks in {patience_s} s"
        if process.returncode != 0:
            findings[name] = text.split("\n")[-1] or f"{name}: fails its checks with status {process.returncode}"
        elif name == "sim_node" and text:
            findings["warnings"] = text
    return findings


def prepare(request):
    """Starts the supervisor with every node as a stopped service, so that any node can be started immediately."""
    if run_record(request):
        return {"prepared": False}
    home = cluster_home(request)
    out = home / "out"
    kept = set_earlier_results_aside(home, out)
    own_files.make_private_folder(home)
    own_files.make_private_folder(out / "logs")
    (home / "files").mkdir(exist_ok=True)
    cluster_folder.remove_leftovers()
    folder = cluster_folder.make(out)
    lock = cluster_folder.lock(folder)
    for name, words in request["nodes"].items():
        services.Service(folder, name, with_folders(request, words), out / "logs" / f"{name}.log", home)
    net = network.choose("auto", request["port"]) if request["private"] else network.Network(False, [], "the host's")
    words = [*net.unshare, str(build_folder(request) / "share" / "inside"), str(folder), "private" if net.private else "host",
             *privileges.needed([home, build_folder(request) / "bin"])]
    with open(out / "logs" / "supervisor.log", "w", encoding="utf-8") as log:
        holder = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True, pass_fds=[lock.fileno()])
    cluster_folder.write_address(folder, holder.pid, net.unshare, request["run_id"], URL.format(**request), request["port"], out)
    (out / "cluster").unlink(missing_ok=True)
    (out / "cluster").symlink_to(folder)
    run = {"run_id": request["run_id"], "build": request["build"], "services": str(folder), "holder": holder.pid, "here": [], "began": time.time(),
            "namespaces": net.unshare}
    write_run_record(request, run)
    controls = [folder / "services" / name / "supervise" / "control" for name in request["nodes"]]
    if not services.wait_until(lambda: all(p.exists() for p in controls), 15):
        raise Refusal(f"the supervisor does not start its services; see {out}/logs/supervisor.log on the host")
    return {"prepared": True, "kept": kept}


def set_earlier_results_aside(home, out):
    """Removes the results of an earlier run when they were gathered; otherwise renames them. Returns the new path, or ""."""
    marker = home / "gathered"
    gathered = marker.exists()
    marker.unlink(missing_ok=True)
    if not out.exists() or not any(out.iterdir()):
        return ""
    if gathered:
        shutil.rmtree(out)
        return ""
    aside = home / time.strftime("out.%Y-%m-%d_%H-%M-%S")
    out.rename(aside)
    return str(aside)


class RunningService(services.Service):
    """An existing service."""

    def __init__(self, folder, name, log):  # pylint: disable=super-init-not-called
        self.name, self.log, self.path = name, log, folder / "services" / name

    def is_up(self):
        return not self.is_down()

    def pid(self):
        try:
            return int((self.path / "supervise" / "pid").read_text(encoding="ascii") or 0)
        except (OSError, ValueError):
            return 0


def running_service(request, name):
    run = run_record(request)
    if not run:
        raise Refusal(f"the cluster {request['cluster']} does not run here; start it with tactus cluster up")
    service = RunningService(pathlib.Path(run["services"]), name, cluster_home(request) / "out" / "logs" / f"{name}.log")
    if not service.path.is_dir():
        raise Refusal(f"there is no node {name} in this cluster")
    return service


def start(request):
    """Starts nodes and records that they belong to this host. Returns when each has written to its log."""
    run = run_record(request)
    members = [running_service(request, name) for name in request["names"]]
    since = {**run.get("since", {}), **{n: time.time() for n in request["names"] if n not in run["here"]}}
    write_run_record(request, {**run, "here": list(dict.fromkeys([*run["here"], *request["names"]])), "since": since})
    members = [s for s in members if s.is_down()]
    before = {s.name: s.log.stat().st_size if s.log.exists() else 0 for s in members}
    for s in members:
        (s.path / "lost").unlink(missing_ok=True)
        if not s.start():
            raise Refusal(f"{s.name}: the supervisor does not start it")
    services.wait_until(lambda: all(s.log.exists() and s.log.stat().st_size > before[s.name] for s in members), request.get("patience", END_S))
    return {}


def stop(request):
    """Asks nodes to end, waits, and kills the others. With leave they no longer belong to this host."""
    run = run_record(request)
    if not run:
        return {"killed": []}
    members = [s for s in (running_service(request, name) for name in request["names"]) if s.is_up()]
    if request.get("leave"):
        write_run_record(request, {**run, "here": [n for n in run["here"] if n not in request["names"]]})
    for s in members:
        (s.path / "asked").touch()  # not counted as a death: services.FINISH
    services.request_end(members, request.get("patience", END_S))
    still_running = [s for s in members if not s.is_down()]
    for s in still_running:
        s.control("k")
    services.wait_until(lambda: all(s.is_down() for s in still_running), 2)
    return {"killed": [s.name for s in still_running]}


def restart(request):
    """stop and start in one request."""
    return stop(request) | start(request)


def send_command(request):
    """Sends a command of runsv(8) to nodes: p pause, c continue, k kill, t end (the node restarts)."""
    for name in request["names"]:
        if not running_service(request, name).control(request["letter"]):
            raise Refusal(f"{name}: its supervisor does not respond; see the log supervisor.log of the host")
    return {}


def node_states(request):
    """State of every node of this host, from its supervisor."""
    run = run_record(request)
    nodes = {}
    for name in run.get("here", []):
        s = running_service(request, name)
        nodes[name] = {"up": s.is_up(), "pid": s.pid(), "deaths": s.deaths(), "lost": s.lost(), "taken_down": s.is_stopped_by_user(), "last": s.last_output_line()[-200:],
                       "begun": name == "sim_node" and s.log_contains("sim_node: the world begins")}
    return {"run": run, "nodes": nodes, "load": os.getloadavg()[0], "cores": os.cpu_count()}


def logs(request):
    folder = cluster_home(request) / "out" / "logs"
    found = {}
    for path in sorted(folder.glob("*.log")):
        if not request["names"] or path.stem in request["names"]:
            text = path.read_text(encoding="utf-8", errors="replace")
            offset = request.get("offsets", {}).get(path.stem)
            lines = text[offset:].splitlines() if offset is not None else text.splitlines()[-request["lines"]:]
            found[path.stem] = {"lines": lines, "offset": len(text)}
    return found


def run_bus_program(request):
    """Runs a program of the bus in the network of the cluster; returns status, out and err."""
    run = run_record(request)
    words = with_folders(request, request["words"])
    for name, text in request.get("files", {}).items():  # named by the words
        (cluster_home(request) / "files").mkdir(parents=True, exist_ok=True)
        (cluster_home(request) / "files" / name).write_text(text, encoding="utf-8")
    if request["words"][0].startswith("@BUILD@/bin/"):  # programs of the bus; the doctor checks the rights of the user
        words = privileges.least(words, privileges.needed([build_folder(request) / "bin"]))
    words = [*(entering(run) if run else []), *words]
    try:
        done = subprocess.run(words, capture_output=True, text=True, errors="replace", timeout=request["patience"], check=False)
    except subprocess.TimeoutExpired:
        raise Refusal(f"{pathlib.Path(request['words'][0]).name}: does not end within {request['patience']} s") from None
    return {"status": done.returncode, "out": done.stdout, "err": done.stderr}


def end_supervisor(request):
    """Ends the supervisor; the recording stays."""
    run = run_record(request)
    if run:
        folder = pathlib.Path(run["services"])
        with contextlib.suppress(OSError):
            (folder / "stopping").touch()
        holder = run["holder"]
        children = pathlib.Path(f"/proc/{holder}/task/{holder}/children")
        pids = [int(p) for p in children.read_text(encoding="ascii").split()] if run["namespaces"] and children.exists() else [holder]
        for pid in pids:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGHUP)
        if not services.wait_until(lambda: not cluster_folder.is_running(folder), END_S):
            with contextlib.suppress(ProcessLookupError):
                os.kill(holder, signal.SIGKILL)
        shutil.rmtree(folder, ignore_errors=True)
        (cluster_home(request) / "out" / "cluster").unlink(missing_ok=True)
    (cluster_home(request) / "run.json").unlink(missing_ok=True)
    return {"was_there": bool(run)}


def collect(request):
    """Writes all results as a tar to stdout, instead of an answer."""
    with gzip.GzipFile(fileobj=sys.stdout.buffer, mode="wb", compresslevel=1) as packed, tarfile.open(fileobj=packed, mode="w|", dereference=True) as tar:
        out = cluster_home(request) / "out"
        for path in sorted(out.rglob("*")):
            if path.is_file() and not path.is_symlink():
                tar.add(path, str(path.relative_to(out)))
    (cluster_home(request) / "gathered").touch()


REQUESTS = {f.__name__: f for f in (ping, inspect_host, receive, shaders, store_shaders, check, prepare, start, stop, restart, send_command, node_states, logs,
                                    run_bus_program, end_supervisor)}


def main(request):
    if request["what"] == "collect":
        collect(request)
        return
    try:
        answer = REQUESTS[request["what"]](request)
    except Refusal as refusal:
        answer = {"refusal": str(refusal)}
    except OSError as error:
        answer = {"refusal": f"{error.filename or request['what']}: {error.strerror or error}"}
    json.dump(answer, sys.stdout)
