"""Prologue of scripts/tactus; scripts/prologue.sh does the same for the scripts. Removes from this process what would change a command: variables
of the user's shell, closed streams, libraries that cannot be loaded."""
import locale
import os
import pathlib
import re
import subprocess
import sys

TABLE = pathlib.Path(__file__).resolve().parents[2] / "removed_variables.txt"
# Set for the commands and scripts that a command calls: the command that the user started reports Ctrl-C, the others are silent.
CALLER = "TACTUS_CALLER"
ORIGINAL = dict(os.environ)  # for a program of the user, in tactus attach


def removed(names):
    """Those of the names that the table lists."""
    listed = [line.split()[0] for line in TABLE.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return [name for name in names if any(name.startswith(entry[:-1]) if entry.endswith("*") else name == entry for entry in listed)]


def loadable(libraries):
    """Those of the libraries of LD_PRELOAD that the dynamic linker can load."""
    def loads(library):
        return not subprocess.run(["/bin/true"], env={**os.environ, "LD_PRELOAD": library}, stderr=subprocess.PIPE, check=False).stderr
    return ":".join(library for library in re.split("[: ]+", libraries) if library and loads(library))


def open_streams():
    """Opens /dev/null in place of closed streams: the next file that a program opens would receive their output."""
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        try:
            os.fstat(number)
        except OSError:
            null = os.open(os.devnull, os.O_RDWR)  # takes the lowest free number
            if null != number:
                os.dup2(null, number)
                os.close(null)
            os.set_inheritable(number, True)
        if getattr(sys, name) is None:
            setattr(sys, name, open(number, mode, encoding="utf-8", closefd=False))


def use_installed_locale():
    """Replaces a locale that is not installed: each script that a command calls would print a warning."""
    before = locale.setlocale(locale.LC_CTYPE)
    try:
        locale.setlocale(locale.LC_ALL, "")
    except locale.Error:
        os.environ["LC_ALL"] = "C.UTF-8"
    locale.setlocale(locale.LC_ALL, "C")  # as Python starts: numbers and messages of this process depend on no locale
    locale.setlocale(locale.LC_CTYPE, before)


def clean():
    """Cleans this process and the environment of its children. Raises OSError when the current folder does not exist any more or this user
    cannot enter it."""
    open_streams()
    for name in removed(list(os.environ)):
        del os.environ[name]
    temporary = os.environ.get("TMPDIR")
    if temporary is not None and not (os.path.isdir(temporary) and os.access(temporary, os.W_OK | os.X_OK)):
        del os.environ["TMPDIR"]
    if libraries := os.environ.pop("LD_PRELOAD", ""):
        if kept := loadable(libraries):
            os.environ["LD_PRELOAD"] = kept
    if os.environ.get("TACTUS_BIN"):  # a job of a cluster starts in another folder
        os.environ["TACTUS_BIN"] = os.path.abspath(os.environ["TACTUS_BIN"])
    use_installed_locale()
    os.environ.pop(CALLER, None)
    os.stat(os.path.join(os.getcwd(), "."))


def was_called():
    """True when another command or script of Tactus called this one; that one reports Ctrl-C."""
    return CALLER in ORIGINAL


def for_called():
    """The environment for a command or script of Tactus that this one calls."""
    return {**os.environ, CALLER: "tactus"}
