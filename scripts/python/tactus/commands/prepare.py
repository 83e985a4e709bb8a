"""Common steps of commands: install, build, print the usage, and replace this process by a program."""
import os
import signal
import subprocess
import sys

from tactus import environment, terminal
from tactus.paths import BIN, INSTALLED, SCRIPTS, remedy


def print_usage(usage, requested=True):
    """Prints a usage text; returns the exit status. requested: the user gave --help; otherwise arguments are missing and the text goes to stderr."""
    print(usage, file=sys.stdout if requested else sys.stderr)
    return 0 if requested else 1


def refuse(name, sentence):
    """Prints an error message to stderr; returns the exit status 1."""
    print(terminal.one_line(f"{name}: {sentence}"), file=sys.stderr)
    return 1


def run_script(*words):
    """Runs a script of scripts/; exits with its status when it fails."""
    status = subprocess.run(words, check=False, env=environment.for_called()).returncode
    if status != 0:
        sys.exit(status if status > 0 else 1)


def install(*groups):
    """Installs the missing packages of these groups of scripts/packages.txt, unless TACTUS_BIN is set, this is an installation, whose packages
    are those of its system, or a copy on a host of a cluster. Exits on failure."""
    if not os.environ.get("TACTUS_BIN") and not INSTALLED and (SCRIPTS / "setup").exists():
        run_script(SCRIPTS / "setup", "--packages", *groups)


def install_and_build(*targets):
    """Installs missing packages and builds, unless TACTUS_BIN is set or this is an installation. targets: of the build; default: all programs.
    Exits on failure."""
    if os.environ.get("TACTUS_BIN") or INSTALLED:
        return
    run_script(SCRIPTS / "setup", "--packages")
    run_script(SCRIPTS / "build", *(targets or ("--programs",)))


def program(name):
    """Path of a program of the build or of the installation. In a source tree, installs the packages and builds it when it is missing, unless
    TACTUS_BIN is set. Exits on failure."""
    path = BIN / name
    if not os.access(path, os.X_OK):
        if os.environ.get("TACTUS_BIN"):
            sys.exit(f"{name}: {path} does not exist; correct TACTUS_BIN")
        if INSTALLED:
            sys.exit(f"{name}: {path} does not exist; {remedy()}")
        install()
        run_script(SCRIPTS / "build", name)
    return str(path)


def replace_process(words, variables=None):
    """Replaces this process by a program, with default signal handlers. variables: its environment. Does not return."""
    for number in (signal.SIGPIPE, signal.SIGXFSZ):  # Python ignores them, and ignored signals are inherited
        signal.signal(number, signal.SIG_DFL)
    sys.stdout.flush()
    os.execvpe(words[0], words, os.environ if variables is None else variables)
