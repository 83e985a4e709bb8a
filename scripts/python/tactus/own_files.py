"""Files and folders in places where other users can write, such as /tmp: owner, kind and size are checked before use.

Only files of the own user are used. No function follows a link at the end of a path, and none waits for a named pipe.
"""
import contextlib
import errno
import os
import pathlib
import pwd
import shutil
import stat

from tactus.refusal import Refusal

RESULT_KINDS = (".lcmlog", ".wav", ".mp4")  # recordings in the folder of a run or of a rendering, and the tables that commands read there
RESULT_NAMES = ("summary.json", "haptic.csv", "thermal.csv", "events.csv", "frames.csv")
OPEN_FLAGS = os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOCTTY


def user_name(uid):
    """Name of a user, or the number without a name."""
    try:
        return pwd.getpwuid(uid).pw_name
    except KeyError:
        return str(uid)


def owner(path):
    """User id of the owner of a path, of a link itself; None when it does not exist."""
    try:
        return os.lstat(path).st_uid
    except OSError:
        return None


def is_private_folder(path):
    """True for a folder of the own user, not a link, that no other user can read or write."""
    try:
        found = os.lstat(path)
    except OSError:
        return False
    return stat.S_ISDIR(found.st_mode) and found.st_uid == os.geteuid() and not found.st_mode & 0o077


def make_private_folder(path):
    """Makes a folder with mode 0700, with its parents, or accepts an existing one of the own user and closes it to others. Raises Refusal
    when it belongs to another user or is not a folder; OSError when it cannot be made."""
    path = pathlib.Path(path)
    if not path.parent.exists():
        make_private_folder(path.parent)
    try:
        os.mkdir(path, 0o700)
    except FileExistsError:
        pass
    found = os.lstat(path)
    if not stat.S_ISDIR(found.st_mode):
        raise Refusal(f"{path}: is not a folder; remove it, or name another place")
    if found.st_uid != os.geteuid():
        raise Refusal(f"{path}: belongs to the user {user_name(found.st_uid)}; remove it, or name another place")
    if found.st_mode & 0o077:
        os.chmod(path, 0o700)
    return path


@contextlib.contextmanager
def results_folder(path):
    """Makes a folder with its parents, or accepts an existing one; for a block that writes into it. When Ctrl-C ends the block, removes the folders
    that it made, with their incomplete content. Raises OSError."""
    made, place = None, pathlib.Path(path).absolute()
    while not place.exists():
        made, place = place, place.parent
    try:
        os.makedirs(path, exist_ok=True)
        yield
    except KeyboardInterrupt:
        if made is not None:
            shutil.rmtree(made, ignore_errors=True)
        raise


def require_writable(option, path, inputs=()):
    """Refuses an output file before long work: in a folder that is missing or closed, a folder itself, or one of the inputs, or a result in an input folder. option: its option,
    for messages; path None: there is none. Raises Refusal."""
    if path is None:
        return
    if not path or os.path.isdir(path) or path.endswith("/"):
        raise Refusal(f"{option} {path}: is not the name of a file; name a file in a writable folder")
    folder = os.path.dirname(os.path.abspath(path))
    reason = "" if os.path.isdir(folder) else f"{folder} is not a folder"
    if not reason and not os.access(path if os.path.exists(path) else folder, os.W_OK):
        reason = "this user may not write it"
    if reason:
        raise Refusal(f"{option} {path}: cannot be written, because {reason}; name a file in a writable folder")
    for given in inputs:
        if os.path.exists(path) and os.path.exists(given) and (os.path.samefile(path, given) or is_result_in(path, given)):
            raise Refusal(f"{option} {path}: is the input itself, which it would replace; name another file")


def is_result_in(path, folder):
    """True for a recording or a table of a run in its folder."""
    name = os.path.basename(path)
    is_result = name.endswith(RESULT_KINDS) or name in RESULT_NAMES or name.startswith("presented") and name.endswith(".csv")
    return is_result and os.path.isdir(folder) and os.path.samefile(os.path.dirname(os.path.abspath(path)), folder)


def open_own(path):
    """Descriptor for reading a regular file of the own user; a link or a named pipe is refused and not waited for. Raises OSError."""
    descriptor = os.open(path, os.O_RDONLY | OPEN_FLAGS)
    try:
        found = os.fstat(descriptor)
        if not stat.S_ISREG(found.st_mode) or found.st_uid != os.geteuid():
            raise OSError(errno.EPERM, "is not a regular file of this user", str(path))
    except OSError:
        os.close(descriptor)
        raise
    return descriptor


def is_regular(path):
    """True for a regular file; False for anything else, also for a name that is too long."""
    try:
        return stat.S_ISREG(os.stat(path).st_mode)
    except (OSError, ValueError):
        return False


def open_regular(path):
    """A regular file of any user, open for reading as bytes. A named pipe or a device, which may never end, is refused. Raises OSError."""
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOCTTY)
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise OSError(errno.EINVAL, "is not a regular file", str(path))
    return open(descriptor, "rb")


def read_regular(path, largest_bytes):
    """At most largest_bytes + 1 bytes of a regular file of any user. Raises OSError."""
    with open_regular(path) as file:
        return file.read(largest_bytes + 1)


def read_own(path, largest_bytes):
    """Text of a regular file of the own user. Raises OSError, also when it is longer than largest_bytes."""
    with open(open_own(path), "rb") as file:
        data = file.read(largest_bytes + 1)
    if len(data) > largest_bytes:
        raise OSError(errno.EFBIG, f"is longer than {largest_bytes} bytes", str(path))
    return data.decode("utf-8", "surrogateescape")


def open_private(path):
    """A new text file that only this user can read, instead of an existing one. Raises OSError."""
    path = pathlib.Path(path)
    path.unlink(missing_ok=True)
    return open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | OPEN_FLAGS, 0o600), "w", encoding="utf-8")


def is_own_process(pid):
    """True when the process exists and all of its user ids are those of the own user."""
    try:
        status = pathlib.Path(f"/proc/{int(pid)}/status").read_text(encoding="utf-8", errors="replace")
    except (OSError, ValueError):
        return False
    ids = next((line.split()[1:] for line in status.splitlines() if line.startswith("Uid:")), [])
    return ids == [str(os.geteuid())] * 4
