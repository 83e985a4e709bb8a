"""Service folders for runit, and commands to their services.

A node runs as a service: runsv restarts it when it dies. Its `finish` script records each death. After more than MAX_DEATHS
deaths within WINDOW_S it leaves the node down and writes the reason to the file `lost`.
"""
import os
import shlex
import time

from tactus.launch.cluster_folder import write_script

MAX_DEATHS = 5
WINDOW_S = 10

FINISH = """#!/bin/sh
# The node died with exit code $1 (-1: by signal $2); runsv restarts it after this script.
[ -e ../../stopping ] && exit 0
[ -e asked ] && rm asked && exit 0
how="exit code $1"
[ "$1" = -1 ] && how="signal $2"
echo "$(date +%s) $how" >>deaths
since=$(($(date +%s) - {window}))
recent=$(awk -v since="$since" '$1 >= since' deaths | wc -l)
[ "$recent" -le {most} ] && exit 0
echo "left down after $recent deaths in {window} s, the last by $how" >lost
printf d >supervise/control
"""

RUN = """#!/bin/sh
# Appends the output of the node to its log. The node dies with its supervisor.
exec >>{log} 2>&1 </dev/null
cd {folder} || exit 1
exec setpriv --pdeathsig KILL -- {command}
"""


class Service:
    """One node under runsv."""

    def __init__(self, folder, name, command, log, working_folder):
        self.name, self.log = name, log
        self.path = folder / "services" / name
        self.path.mkdir()
        (self.path / "down").touch()  # runsv waits for a command
        write_script(self.path / "run", RUN.format(log=shlex.quote(str(log)),
                                                   folder=shlex.quote(str(working_folder)), command=shlex.join(command)))
        write_script(self.path / "finish", FINISH.format(window=WINDOW_S, most=MAX_DEATHS))

    def control(self, letter):
        """Sends a command of runsv(8): u, d, t, k, p, c. False without a running runsv."""
        try:
            pipe = os.open(self.path / "supervise" / "control", os.O_WRONLY | os.O_NONBLOCK)
        except OSError:
            return False
        with os.fdopen(pipe, "w") as control:
            control.write(letter)
        return True

    def start(self, patience_s=5.0):
        """Starts the node; True on success. Waits up to patience_s for runsv."""
        return wait_until(lambda: self.control("u"), patience_s)

    def is_down(self):
        try:
            return (self.path / "supervise" / "stat").read_text(encoding="utf-8").startswith("down")
        except OSError:
            return True

    def is_stopped_by_user(self):
        """True when the user stopped the service with sv; a node that died has "want up"."""
        try:
            stat = (self.path / "supervise" / "stat").read_text(encoding="utf-8")
        except OSError:
            return False
        return stat.startswith("down") and "want up" not in stat and not self.lost()

    def has_output(self):
        return self.log.exists() and self.log.stat().st_size > 0

    def log_contains(self, line):
        try:
            return line in self.log.read_text(encoding="utf-8", errors="replace")
        except OSError:
            return False

    def last_output_line(self):
        try:
            lines = self.log.read_text(encoding="utf-8", errors="replace").split("\n")
        except OSError:
            return ""
        return next((line.strip() for line in reversed(lines) if line.strip()), "")

    def last_line_with(self, words):
        """The last line of its output that holds one of these texts, or ""."""
        try:
            lines = self.log.read_text(encoding="utf-8", errors="replace").split("\n")
        except OSError:
            return ""
        return next((line.strip() for line in reversed(lines) if any(word in line for word in words)), "")

    def deaths(self):
        return len(self.death_reasons())

    def death_reasons(self):
        """How the node died, each time: "exit code N" or "signal N"."""
        try:
            return [line.partition(" ")[2] for line in (self.path / "deaths").read_text(encoding="utf-8").splitlines()]
        except OSError:
            return []

    def lost(self):
        """The reason why the node was left down; "" otherwise."""
        try:
            return (self.path / "lost").read_text(encoding="utf-8").strip()
        except OSError:
            return ""


def request_end(services, patience_s):
    """Asks all services to end and waits at most patience_s."""
    for s in services:
        s.control("d")
    wait_until(lambda: all(s.is_down() for s in services), patience_s)


def end_or_kill(services, patience_s, progress=lambda: None):
    """Waits for all services, at most patience_s after the last change of progress(), then kills the others. Returns their names."""
    def all_down():
        return all(s.is_down() for s in services)

    advancing = True
    while advancing and not all_down():
        before = progress()
        advancing = wait_until(lambda state=before: all_down() or progress() != state, patience_s)
    killed = [s for s in services if not s.is_down()]
    for s in killed:
        s.control("k")
    wait_until(all_down, 2.0)
    return [s.name for s in killed]


def wait_until(condition, timeout_s):
    end = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True
