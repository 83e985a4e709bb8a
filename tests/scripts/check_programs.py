#!/usr/bin/python3 -I
"""Checks how the programs of the cluster meet wrong options and an unusable network.

  check_programs.py help SOURCE_ROOT PROGRAM...      every program prints help
  check_programs.py options SOURCE_ROOT PROGRAM...   an invalid option exits with 1 and one sentence on stderr
  check_programs.py network SOURCE_ROOT PROGRAM...   so do a missing multicast route and a port that is taken

Programs run in a network namespace of their own; where that is not allowed, `network` is skipped (exit 77).
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import atexit
import csv
import shutil
import socket
import struct
import subprocess
import tempfile

SKIPPED = 77
DEADLINE_S = 60  # for a start that must fail: far more than it takes


def run(program, *arguments):
    try:
        done = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=DEADLINE_S,
                              cwd=tempfile.gettempdir(), stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return None, "", "still runs"
    return done.returncode, done.stdout, done.stderr


def name_of(program):
    return os.path.basename(program)


def help_of(program):
    return run(program, "--help")[1]


def one_sentence(program, arguments, must_name="", may_say_before=False):
    """Complaints, [] when the program ended with 1 and one line that names itself and the thing.

    may_say_before: lines of its own about what it has found so far may precede that line."""
    code, _, err = run(program, *arguments)
    lines = [line for line in err.splitlines() if line.strip()]
    said = f"{name_of(program)} {' '.join(arguments)}: exit {code}, stderr: {err.strip()[:400]!r}"
    if code != 1:
        return [said + "; wanted exit 1"]
    named = lines and all(line.startswith(name_of(program)) for line in lines)
    if not named or (len(lines) > 1 and not may_say_before):
        return [said + f"; wanted one line that begins with {name_of(program)}"]
    if must_name and must_name not in lines[-1]:
        return [said + f"; wanted it to name {must_name!r}"]
    return []


def check_help(root, program):
    code, out, err = run(program, "--help")
    if code != 0 or "--help" not in out or len(out.split()) < 12:
        return [f"{name_of(program)} --help: exit {code}, {len(out.split())} words, stderr {err.strip()!r}"]
    return []


def first_quantity(root, program):
    """Name of a setting with a range, or nothing."""
    table = os.path.join(root, name_of(program), "settings.csv")
    if not os.path.exists(table):
        return None
    with open(table, newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["max"]]
    rates = [row["name"] for row in rows if row["unit"] == "Hz" and row["name"].endswith("rate")]
    return (rates or [row["name"] for row in rows] or [None])[0]


def small_log():
    """A log of one event, in a folder that only this user can write."""
    folder = tempfile.mkdtemp(prefix="tactus-check-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    path = os.path.join(folder, "one_event.lcmlog")
    with open(path, "wb") as file:
        file.write(struct.pack(">IqqII", 0xEDA1DA01, 0, 1, 1, 8) + b"X" + bytes(8))
    return path


def scene_arguments(root, program):
    """Required arguments of a program."""
    if name_of(program) == "replay":
        return [small_log()]  # it is read before the bus is joined
    if " LOG" in help_of(program):
        return [os.path.join(root, "LICENSE")]  # any existing file; the options are read first
    if name_of(program) == "degrade":
        return ["off"]
    if name_of(program) == "simulation":
        return ["pause"]
    if name_of(program) == "set":
        return ["haptic_node", "force_limit=5"]
    if name_of(program) == "convert_geometry":
        return [os.path.join(root, "sim_node", "scenes", "peg.obj"), os.path.join(tempfile.gettempdir(), "never_written.glb")]
    if name_of(program) == "save_pictures":
        return [os.path.join(tempfile.gettempdir(), "tactus_pictures")]
    if name_of(program) == "sim_node":
        return [os.path.join(root, "sim_node", "scenes", "dark_room.sdf")]
    return []


def check_options(root, program):
    usage = help_of(program)
    needed = scene_arguments(root, program)
    cases = [(needed + ["--no-such-option"], "no-such-option")]
    if "--port" in usage:
        cases += [(needed + ["--port", wrong], "port") for wrong in ("0", "70000", "-1", "seven")]
        cases += [(needed + [option, wrong], thing) for option, wrong, thing in
                  [("--ttl", "900", "ttl"), ("--run-id", "none", "run-id"), ("--realtime", "maybe", "realtime"),
                   ("--out", "/no/such/folder", "/no/such/folder")] if option in usage]
        cases += [(needed + ["--port"], "port")]
    setting = first_quantity(root, program)
    if setting:
        cases += [(needed + ["--set", setting + "=1e30"], setting), (needed + ["--set", setting + "=fast"], setting),
                  (needed + ["--set", "no_such_setting=1"], "no_such_setting"), (needed + ["--set", setting], setting)]
    if name_of(program) == "sim_node":
        cases += [(["/no/such/scene.sdf"], "/no/such/scene.sdf"), ([], "")]
    if " LOG" in usage:
        cases += [(["/no/such.lcmlog"], "/no/such.lcmlog")]
    return [c for arguments, thing in cases for c in one_sentence(program, arguments, thing)]


def check_no_route(root, program):
    return one_sentence(program, scene_arguments(root, program), "multicast", may_say_before=True)


def check_busy_port(root, program):
    port = 7667
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as holder:  # without SO_REUSEADDR
        holder.bind(("", port))
        return one_sentence(program, scene_arguments(root, program) + ["--port", str(port)], str(port),
                            may_say_before=True)


def bus_programs(programs):
    return [p for p in programs if "--port" in help_of(p)]


def namespace():
    """The command prefix that gives a network of one's own, or nothing where it is not allowed."""
    for prefix in (["unshare", "-n"], ["unshare", "-rn"]):
        if shutil.which("unshare") and subprocess.run([*prefix, "true"], capture_output=True).returncode == 0:
            return prefix
    return None


def check_network(root, programs):
    users = bus_programs(programs)
    complaints = [c for p in users for c in check_no_route(root, p)]
    for command in (["ip", "link", "set", "lo", "up"], ["ip", "route", "add", "224.0.0.0/4", "dev", "lo"]):
        subprocess.run(command, check=True)
    return complaints + [c for p in users for c in check_busy_port(root, p)]


def main():
    if len(sys.argv) < 4 or sys.argv[1] not in ("help", "options", "network"):
        print(__doc__)
        return 0 if sys.argv[1:] in (["-h"], ["--help"]) else 1
    what, root, programs = sys.argv[1], os.path.abspath(sys.argv[2]), [os.path.abspath(p) for p in sys.argv[3:]]
    if what != "help" and os.environ.get("TACTUS_OWN_NETWORK") != "1":
        prefix = namespace()
        if prefix:
            return subprocess.run([*prefix, sys.executable, *sys.argv],
                                  env={**os.environ, "TACTUS_OWN_NETWORK": "1"}).returncode
        if what == "network":
            print("skipped: no network namespace is allowed here")
            return SKIPPED
    if what == "network":
        complaints = check_network(root, programs)
    else:
        check = check_help if what == "help" else check_options
        complaints = [c for p in programs for c in check(root, p)]
    print("\n".join(complaints))
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
