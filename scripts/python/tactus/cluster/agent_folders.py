"""Folders of the agent on its host, and the record of the running cluster.

FOLDER (~/.local/share/tactus) holds builds/IDENTITY and clusters/NAME with run.json, files/ and out/. It must belong to the user, because
programs in it are run and processes named in it are entered.
"""
import json
import os
import pathlib
import stat

from tactus import own_files
from tactus.launch import cluster_folder
from tactus.refusal import Refusal

RECORD_BYTES = 1 << 20
RECORD_KEYS = {"run_id", "build", "services", "holder", "here", "began", "namespaces"}


def tactus_folder(request):
    """FOLDER. Raises Refusal when it belongs to another user, or other users can write in it."""
    folder = pathlib.Path(request["folder"] or "~/.local/share/tactus").expanduser()
    try:
        found = os.stat(folder)
    except OSError:
        return folder  # not yet made
    if found.st_uid != os.geteuid():
        raise Refusal(f"the folder {folder} belongs to the user {own_files.user_name(found.st_uid)}; set another folder= of the host")
    if found.st_mode & stat.S_IWOTH:
        raise Refusal(f"every user can write in the folder {folder}; run chmod o-w on it, or set another folder= of the host")
    return folder


def cluster_home(request):
    """Folder of the cluster in FOLDER."""
    return tactus_folder(request) / "clusters" / request["cluster"]


def build_folder(request):
    """Folder of the build: that of the host, or an installed one."""
    return pathlib.Path(request["own_build"]).expanduser() if request.get("own_build") else tactus_folder(request) / "builds" / request["build"]


def run_record(request):
    """The record of the running cluster on this host; {} when it does not run, and when it is not of this user."""
    try:
        run = json.loads(own_files.read_own(cluster_home(request) / "run.json", RECORD_BYTES))
    except (OSError, ValueError):
        return {}
    if not isinstance(run, dict) or not RECORD_KEYS <= run.keys() or not cluster_folder.is_running(pathlib.Path(run["services"])):
        return {}
    return run


def builds_in_use(request):
    """Names of the builds that the records of clusters on this host name."""
    found = set()
    for path in tactus_folder(request).glob("clusters/*/run.json"):
        try:
            found.add(json.loads(own_files.read_own(path, RECORD_BYTES))["build"])
        except (OSError, ValueError, KeyError, TypeError):
            continue  # a damaged record
    return found


def write_run_record(request, run):
    path = cluster_home(request) / "run.json"
    path.with_suffix(".new").write_text(json.dumps(run), encoding="utf-8")
    path.with_suffix(".new").rename(path)


def entering(run):
    """Command words that enter the network of a running cluster; the command follows. Raises Refusal."""
    if "--net" not in run["namespaces"]:
        return []
    ns = f"/proc/{run['holder']}/ns"
    if not own_files.is_own_process(run["holder"]) or not os.path.exists(f"{ns}/net"):  # a process that has ended keeps its user id until its parent reads its status
        raise Refusal("the supervisor of the cluster has ended; run tactus cluster down, and then up")
    return ["nsenter", f"--net={ns}/net", *([f"--user={ns}/user", "--preserve-credentials"] if "--user" in run["namespaces"] else [])]
