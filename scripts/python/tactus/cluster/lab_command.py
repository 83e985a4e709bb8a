"""Runs a command in a lab: simulated hosts on this machine, to test a cluster of several machines.

  tactus lab [--hosts N | --hosts NAME,NAME,...] CMD [ARG]...
  tactus lab HOST cut | mend | stop | go-on | kill | boot | limit KBIT | lose PERCENT

Each host is a network namespace on one switch, with its own processes, home, /tmp, sshd and monotonic clock; the default names
are host1, host2, ... CMD reaches the hosts by ssh (configuration: $TACTUS_LAB/ssh_config). When CMD ends, the lab and all of its
processes end. The second form, inside CMD, causes or removes a fault of a host or its cable. For example:

  tactus lab --hosts desk,sound tactus cluster up desk_and_sound.xml
  tactus lab --hosts 3 bash
"""
import json
import os
import pathlib
import signal
import subprocess
import sys

from tactus import signals, tables, terminal
from tactus.cluster import lab
from tactus.paths import tactus_command

FAULTS = {"cut": 0, "mend": 0, "stop": 0, "go-on": 0, "kill": 0, "boot": 0, "limit": 1, "lose": 1}


def parse_host_names(words):
    """(names of the hosts, the command). Raises lab.Error."""
    names = "3"
    if words and (words[0] == "--hosts" or words[0].startswith("--hosts=")):
        if "=" in words[0]:
            names, words = words[0].partition("=")[2], words[1:]
        else:
            if len(words) < 2:
                raise lab.Error("--hosts needs a number or names; see tactus lab --help")
            names, words = words[1], words[2:]
    if words and words[0].startswith("-"):
        raise lab.Error(f"{words[0]}: there is no such option; see tactus lab --help")
    given = names
    if names.isdigit():
        names = ",".join(f"host{n}" for n in range(1, 1 + (tables.whole_number(names, 1, lab.MAX_HOSTS) or 0)))
    names = names.split(",")
    if not 1 <= len(names) <= lab.MAX_HOSTS or len(set(names)) != len(names) or not all(n[:1].isalnum() and n.replace("-", "").isalnum() and n.isascii() for n in names):
        raise lab.Error(f"--hosts {given[:60]}: give a number from 1 to {lab.MAX_HOSTS}, or different names of letters, digits and hyphens")
    if not words:
        raise lab.Error("name a command to run in the lab; see tactus lab --help")
    return names, words


def send_fault(words):
    """The second form: sends the command to the process that made the lab, because the hosts are its children."""
    folder = pathlib.Path(os.environ[lab.VARIABLE])
    name, what, *rest = words
    if len(rest) != FAULTS[what] or not all(r.replace(".", "", 1).isdigit() for r in rest):
        raise lab.Error(f"{what} needs {'a number' if FAULTS[what] else 'no argument'}; see tactus lab --help")
    (folder / "orders").mkdir(exist_ok=True)
    known = json.loads((folder / "hosts.json").read_text(encoding="utf-8"))
    if name not in known:
        raise lab.Error(f"there is no host {name} in this lab; it has {', '.join(known)}")
    order = folder / "order"
    answer = folder / f"answer{os.getpid()}"
    os.mkfifo(answer)
    try:
        with open(order, "w", encoding="utf-8") as pipe:
            pipe.write(json.dumps([str(answer), name, what, *map(float, rest)]) + "\n")
        said = answer.read_text(encoding="utf-8")
    finally:
        answer.unlink()
    if said:
        raise lab.Error(said)


def serve_faults(made, command):
    """Executes requests until the command has ended; returns its status."""
    pipe = made.folder / "order"
    os.mkfifo(pipe)
    child = subprocess.Popen(command, env=made.environment())
    # Forwarded to the command; Ctrl-C reaches it from the terminal.
    signals.handle(signals.ENDING, lambda n, _: child.poll() is None and child.send_signal(n) if n != signal.SIGINT else None)
    descriptor = os.open(pipe, os.O_RDWR | os.O_NONBLOCK)
    rest = b""
    while True:
        try:
            child.wait(0.02)
            return child.returncode
        except subprocess.TimeoutExpired:
            pass
        try:
            rest += os.read(descriptor, 65536)
        except BlockingIOError:
            continue
        *lines, rest = rest.split(b"\n")
        for line in lines:
            apply_fault(made, *json.loads(line))


def apply_fault(made, answer, name, what, *values):
    said = ""
    try:
        getattr(made.hosts[name], what.replace("-", "_"))(*values)
        made.write_hosts()
    except (lab.Error, OSError) as error:
        said = str(error)
    with open(answer, "w", encoding="utf-8") as file:
        file.write(said)


def main(words):
    if not words or words[0] in ("-h", "--help"):
        print(__doc__.strip(), file=sys.stdout if words else sys.stderr)
        return 0 if words else 1
    try:
        if lab.VARIABLE in os.environ and len(words) > 1 and words[1] in FAULTS:
            send_fault(words)
            return 0
        names, command = parse_host_names(words)
        if not lab.is_inside():
            lab.enter([*tactus_command("lab"), *words])
        del os.environ["TACTUS_LAB_INSIDE"]
        made = lab.Lab(names)
        try:
            return serve_faults(made, command)
        except FileNotFoundError:
            raise lab.Error(f"there is no command {command[0]}") from None
        finally:
            made.close()
    except lab.Error as error:
        terminal.report_refusal(f"lab: {error}")
        return 1
