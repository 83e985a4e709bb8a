"""Common steps of commands: install, build, print the usage, and replace this process by a program."""
import os
import signal
import subprocess
import sys

from tactus.paths import BIN, SCRIPTS


def print_usage(usage, requested=True):
    """Prints a usage text; returns the exit status. requested: the user gave --help; otherwise arguments are missing and the text goes to stderr."""
    print(usage, file=sys.stdout if requested else sys.stderr)
    return 0 if requested else 1


def refuse(name, sentence):
    """Prints an error message to stderr; returns the exit status 1."""
    print(f"{name}: {sentence}", file=sys.stderr)
    return 1


def install_and_build(*targets):
    """Installs missing packages and builds, unless TACTUS_BIN is set. targets: of the build; default: all programs. Exits with 1 on failure."""
    if os.environ.get("TACTUS_BIN"):
        return
    for words in ([SCRIPTS / "setup", "--packages"], [SCRIPTS / "build", *(targets or ("--programs",))]):
        if subprocess.run(words, check=False).returncode != 0:
            sys.exit(1)


def program(name):
    """Path of a program of the build; builds it when missing. Exits with 1 on failure."""
    path = BIN / name
    if not os.access(path, os.X_OK) and subprocess.run([SCRIPTS / "build", name], check=False).returncode != 0:
        sys.exit(1)
    return str(path)


def replace_process(words, environment=None):
    """Replaces this process by a program, with default signal handlers. Does not return."""
    for number in (signal.SIGPIPE, signal.SIGXFSZ):  # Python ignores them, and ignored signals are inherited
        signal.signal(number, signal.SIG_DFL)
    sys.stdout.flush()
    os.execvpe(words[0], words, environment or os.environ)
