"""The temporary folder of a running cluster: its services, its lock, and its address, by which tactus attach finds the cluster.

The folder has mode 0700 and a random name. Folders, files and processes of other users are never used: a forged address would lead a
command into namespaces that another user controls.
"""
import fcntl
import os
import pathlib
import shutil
import subprocess
import tempfile

from tactus import own_files
from tactus.refusal import Refusal

PREFIX = "tactus-{user}-"  # before the random part of the name; user: the user id
DEFAULT_TMPDIR = "/tmp"
ADDRESS_BYTES = 65536      # design: the longest address file
ADDRESS_KEYS = {"holder", "namespaces", "run_id", "url", "port", "out"}
NAMESPACES = {"none", "net", "user", "pid"}


def make(out):
    """A new folder on a file system that has named pipes and executable files, which --out may lack. Raises Refusal."""
    for parent in (tempfile.gettempdir(), str(out)):
        folder = None
        try:
            folder = pathlib.Path(tempfile.mkdtemp(prefix=PREFIX.format(user=os.geteuid()), dir=parent))
            os.mkfifo(folder / "pipe")
            write_script(folder / "script", "#!/bin/sh\n")
            subprocess.run([folder / "script"], check=True)
            (folder / "services").mkdir()
        except (OSError, subprocess.SubprocessError):
            if folder:
                shutil.rmtree(folder, ignore_errors=True)
            continue
        return folder
    raise Refusal(f"supervision: neither {tempfile.gettempdir()} nor {out} can hold executable files and named pipes, or "
                  "both are full; set TMPDIR to a folder that can hold them")


def lock(folder):
    """Marks the folder as in use until the returned file is closed or this process ends. A lock, because process ids differ
    between process namespaces."""
    file = open(folder / "new", "w", encoding="ascii")
    fcntl.flock(file, fcntl.LOCK_EX)
    (folder / "new").rename(folder / "in_use")  # in_use never exists unlocked
    return file


def try_lock(folder):
    """Descriptor that holds the lock of an abandoned folder; None for a folder of another user, an incomplete one, and one in use."""
    try:
        if not own_files.is_private_folder(folder):
            return None
        descriptor = own_files.open_own(folder / "in_use")
    except OSError:
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(descriptor)
        return None
    return descriptor


def is_running(folder):
    """True while a process holds the lock of the folder. False for a folder of another user, and one that others can open."""
    if not own_files.is_private_folder(folder):
        return False
    try:
        descriptor = own_files.open_own(folder / "in_use")
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return False
    except OSError:
        return True
    finally:
        os.close(descriptor)


def own_folders():
    """Folders with the name of a cluster of this user: those of the temporary folder, where another user may have made them. Without TMPDIR also
    those that a supervisor of this user serves elsewhere, because its run had TMPDIR or wrote the folder to its results."""
    name, temporary = PREFIX.format(user=os.geteuid()), tempfile.gettempdir()
    served = [folder for folder in served_folders() if folder.name.startswith(name)] if temporary == DEFAULT_TMPDIR else []
    return list(dict.fromkeys([*pathlib.Path(temporary).glob(name + "*"), *served]))


def served_folders():
    """Folders of the supervisors of this user (launch/inside), from their command lines."""
    found = []
    for line in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = line.read_bytes().split(b"\0")
            if words[:2] == [b"runsvdir", b"-P"] and line.stat().st_uid == os.geteuid():
                found.append(pathlib.Path(os.fsdecode(words[2])).parent)
        except (OSError, IndexError):
            continue  # it has ended, or belongs to another user
    return found


def running():
    """Folders of the running clusters of this user, newest first."""
    return sorted(filter(is_running, own_folders()), key=lambda folder: folder.lstat().st_mtime, reverse=True)


def remove_leftovers():
    """Removes the folders of clusters whose run was killed."""
    for folder in own_folders():
        descriptor = try_lock(folder)
        if descriptor is not None:
            shutil.rmtree(folder, ignore_errors=True)
            os.close(descriptor)


def write_address(folder, holder, unshare, run_id, url, port, out):
    """Writes the address of a cluster. holder: the process that holds the namespaces; unshare: the command words that made them."""
    names = [name for name, flag in (("net", "--net"), ("user", "--user"), ("pid", "--pid")) if flag in unshare]
    entries = {"holder": holder, "namespaces": ",".join(names) or "none", "run_id": run_id, "url": url, "port": port, "out": out}
    text = "".join(f"{key}={value}\0" for key, value in entries.items())  # a folder name may hold line ends
    (folder / "address").write_text(text, encoding="utf-8", errors="surrogateescape")


def address(folder):
    """{key: value} of the running cluster of this folder; None without one. Folder, file and process must belong to this user."""
    if not is_running(folder):
        return None
    try:
        text = own_files.read_own(folder / "address", ADDRESS_BYTES)
    except OSError:
        return None
    found = dict(entry.split("=", 1) for entry in text.split("\0") if "=" in entry)
    valid = ADDRESS_KEYS <= found.keys() and set(found["namespaces"].split(",")) <= NAMESPACES
    return found if valid and own_files.is_own_process(found["holder"]) else None


def write_script(path, text):
    path.write_text(text, encoding="utf-8", errors="surrogateescape")  # file names are bytes
    path.chmod(0o755)
