"""The rights of the processes of a run. A node keeps real-time priority and locked memory and no other capability of root, and neither
it nor a program that it starts can gain one (no_new_privs, prctl(2)).

An ordinary user has no capabilities, so that a run as an ordinary user is the normal case. In the user namespace of its private
network the processes would hold all capabilities of that namespace; they are dropped, too.
"""
import functools
import os
import pathlib
import subprocess

KEPT = ("sys_nice", "ipc_lock")  # SCHED_FIFO and mlockall: sync/node/realtime.cpp
# Reads files that the permissions close to root without capabilities, such as a scene in a home folder of another user.
READ_ALL = "dac_read_search"
# SO_RCVBUFFORCE: sync/bus/receive_buffer.cpp, which needs it only below this limit of the kernel. A node gives it up when its sockets are
# open, before it reads a message.
RECEIVE_BUFFER = "net_admin"
RECEIVE_BUFFER_BYTES = 4 << 20
NUMBERS = {"dac_read_search": 2, "net_admin": 12, "ipc_lock": 14, "sys_nice": 23}  # capability.h of Linux
LIMIT = pathlib.Path("/proc/sys/net/core/rmem_max")
WITHOUT = ("setpriv", "--no-new-privs", "--inh-caps=-all", "--ambient-caps=-all")


def words(kept=KEPT, bounding=True):
    """Command words that drop all capabilities but these; a command follows. bounding: also limits what programs of root gain."""
    return [*WITHOUT, *(["--bounding-set=" + ",".join(("-all", *(f"+{name}" for name in kept)))] if bounding else []), "--"]


@functools.cache
def is_allowed(kept=KEPT):
    """True when this process can limit its children to these capabilities: for root, except in some containers; for an ordinary user by setpriv of
    util-linux 2.38, not by 2.41."""
    done = subprocess.run([*words(kept), "grep", "^CapEff:", "/proc/self/status"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return False
    return not int(done.stdout.split()[1], 16) & ~sum(1 << NUMBERS[name] for name in kept)


def least(command, kept=KEPT):
    """The command with the least rights that this process can give it."""
    return [*words(kept, is_allowed(kept)), *map(str, command)]


def readable(paths, kept=KEPT):
    """True when root without further capabilities can read all of these paths. Ordinary users have none in any case."""
    test = 'for path do [ -r "$path" ] && { [ ! -d "$path" ] || [ -x "$path" ]; } || exit 1; done'
    return subprocess.run([*least(["sh", "-c", test, "sh"], kept), *map(str, paths)], capture_output=True, check=False).returncode == 0


def needed(paths):
    """The capabilities that the nodes of a run keep, for root. paths: files and folders that they read; missing ones are left out."""
    if os.geteuid() != 0:
        return KEPT
    paths = [path for path in paths if os.path.exists(path)]
    return (*KEPT, *(() if has_receive_buffer() else (RECEIVE_BUFFER,)), *(() if readable(paths) else (READ_ALL,)))


def has_receive_buffer():
    """True when every process may have the receive buffer of the bus."""
    try:
        return int(LIMIT.read_text(encoding="ascii")) >= RECEIVE_BUFFER_BYTES
    except (OSError, ValueError):
        return False


def description(kept):
    """One sentence for the user about a run of root; "" for an ordinary user."""
    if os.geteuid() != 0:
        return ""
    if not is_allowed(kept):
        return "runs as root, and this system refuses to limit the rights of the nodes; run it as an ordinary user"
    also = {READ_ALL: "; they also read all files, because root alone may not open the scene or its folder", RECEIVE_BUFFER: "; they open their "
            f"sockets with CAP_NET_ADMIN and then give it up, because net.core.rmem_max is below {RECEIVE_BUFFER_BYTES}"}
    return ("runs as root: the nodes keep only real-time priority and locked memory" + "".join(also.get(name, "") for name in kept) +
            "; an ordinary user suffices (tactus setup --realtime)")
