"""Runs a command inside the network of a running cluster."""
import os
import pathlib
import shutil
import subprocess
import tempfile

from tactus import environment, own_files
from tactus.commands import prepare
from tactus.launch import cluster_folder
from tactus.paths import BIN, TACTUS
from tactus.refusal import Refusal

USAGE = """Usage: tactus attach [OUT_DIR] CMD [ARG]...

Runs CMD inside the network of the running cluster that writes to OUT_DIR; default: the cluster that you started last. CMD sees
only the processes of the cluster. Its environment holds the bus (LCM_DEFAULT_URL, for LCM's own tools; TACTUS_GROUP, TACTUS_PORT, TACTUS_TTL), the run
(TACTUS_RUN_ID) and the services (SVDIR, for sv), and its PATH begins with the programs of Tactus. For example:

  tactus attach watch                            the live table
  tactus attach lcm-logger bus.lcmlog            record with LCM's own logger
  tactus attach sv down sim_node                 stop the simulation, and then
  tactus attach lcm-logplayer old/run.lcmlog     replay a log to the modalities; if the simulation still ran, they would
                                                  receive both states alternately
  tactus attach sv pause visual_node             freeze a node; sv cont visual_node resumes it
  tactus attach pkill -x audio_node              kill a node; the supervisor restarts it

Only the user who started a cluster can enter it, not root on behalf of that user. CMD keeps your rights."""


def cluster_of(out):
    """(folder, address) of the cluster that writes to `out`. Raises Refusal."""
    folder = pathlib.Path(os.path.realpath(os.path.join(out, "cluster")))
    found = cluster_folder.address(folder)
    if found is None:
        refuse_foreign(folder)
        raise Refusal(f"no cluster is running that writes to {out}; start one with tactus run --out {out}")
    return folder, found


def newest():
    """(folder, address) of the newest running cluster of this user. Raises Refusal."""
    for folder in cluster_folder.running():
        found = cluster_folder.address(folder)
        if found is not None:
            return folder, found
    for folder in sorted(pathlib.Path(tempfile.gettempdir()).glob(cluster_folder.PREFIX.format(user="[0-9]*") + "*")):
        refuse_foreign(folder)
    raise Refusal("no cluster is running; start one with tactus run, or name its output folder")


def refuse_foreign(folder):
    """Raises Refusal when the folder belongs to another user. Root does not enter it either: the processes inside could then act as root."""
    uid = own_files.owner(folder)
    if uid not in (None, os.geteuid()):
        raise Refusal(f"{folder} belongs to the user {own_files.user_name(uid)}, and only the user who started a cluster can enter it; run tactus attach as "
                      "that user")


def bus_variables(folder, found, variables):
    """The variables of a command inside the cluster: those of the caller, and those that name the bus and the run."""
    bus = found["url"].removeprefix("udpm://")
    return {**variables, "TACTUS_GROUP": bus.partition(":")[0], "TACTUS_TTL": bus.rpartition("ttl=")[2], "LCM_DEFAULT_URL": found["url"],
            "TACTUS_PORT": found["port"], "TACTUS_RUN_ID": found["run_id"], "SVDIR": str(folder / "services"),
            "PATH": f"{BIN}:{variables.get('PATH', '')}"}


def entering(found):
    """Command words that enter the namespaces of the cluster; the command follows."""
    if found["namespaces"] == "none":
        return []
    ns = f"/proc/{found['holder']}/ns"
    words = ["nsenter", f"--pid={ns}/pid_for_children", f"--mount={ns}/mnt", f"--wdns={os.getcwd()}"]
    if "net" in found["namespaces"]:
        words.append(f"--net={ns}/net")
    if "user" in found["namespaces"]:
        words += [f"--user={ns}/user", "--preserve-credentials"]
    return words


def check_entry(found):
    """Raises Refusal when the namespaces of the cluster cannot be entered: a cluster that ends loses its processes before its folder and its lock."""
    words = entering(found)
    if not words:
        return
    if not shutil.which(words[0]):
        raise Refusal(f"{words[0]} is not installed, which enters the network of a cluster; install the package util-linux")
    trial = subprocess.run([*words, "true"], stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", check=False)
    if trial.returncode == 0:
        return
    if not own_files.is_own_process(found["holder"]) or not processes_of(found["holder"]):
        raise Refusal(f"the cluster that writes to {found['out']} has ended; start one with tactus run --out {found['out']}")
    raise Refusal(f"the network of the cluster that writes to {found['out']} cannot be entered ({trial.stderr.strip().removeprefix('nsenter: ')}); end the cluster "
                  "with Ctrl-C in its terminal, and start another one")


def processes_of(holder):
    """The processes that the supervisor of a cluster has started, as text; "": it has ended, or they have."""
    try:
        return pathlib.Path(f"/proc/{holder}/task/{holder}/children").read_text(encoding="ascii")
    except OSError:
        return ""


def main(words):
    if not words or words[0] in ("--help", "-h"):
        return prepare.print_usage(USAGE, requested=bool(words))
    try:
        if os.path.isdir(words[0]) and "/" in words[0] or os.path.islink(os.path.join(words[0], "cluster")):
            out, *words = words
            if not words:
                raise Refusal("name a command to run; see tactus attach --help")
            folder, found = cluster_of(out)
        else:
            folder, found = newest()
        there = bus_variables(folder, found, {name: value for name, value in environment.ORIGINAL.items() if name != environment.CALLER})
        if words[0] == "tactus":  # this installation
            words = [str(TACTUS), *words[1:]]
        if not shutil.which(words[0], path=there["PATH"]):
            raise Refusal(f"there is no command {words[0]}; see tactus attach --help for examples")
        check_entry(found)
    except Refusal as refusal:
        return prepare.refuse("attach", refusal)
    prepare.replace_process([*entering(found), *words], there)
