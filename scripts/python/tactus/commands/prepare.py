"""What commands do before their work: install, build, explain themselves, and give way to a program."""
import os
import signal
import subprocess
import sys

from tactus.paths import BIN, SCRIPTS


def show(usage, asked=True):
    """Prints how a command is used; its exit status. asked: by --help, and not by words that are missing."""
    print(usage, file=sys.stdout if asked else sys.stderr)
    return 0 if asked else 1


def refuse(name, sentence):
    """Prints what is wrong; the exit status."""
    print(f"{name}: {sentence}", file=sys.stderr)
    return 1


def install_and_build(*targets):
    """Unless TACTUS_BIN names programs that are built. targets: of the build; default: all programs. Ends this process where that fails."""
    if os.environ.get("TACTUS_BIN"):
        return
    for words in ([SCRIPTS / "setup", "--packages"], [SCRIPTS / "build", *(targets or ("--programs",))]):
        if subprocess.run(words, check=False).returncode != 0:
            sys.exit(1)


def program(name):
    """Path of a program of the build, which is built when it is not there. Ends this process where that fails."""
    path = BIN / name
    if not os.access(path, os.X_OK) and subprocess.run([SCRIPTS / "build", name], check=False).returncode != 0:
        sys.exit(1)
    return str(path)


def become(words, environment=None):
    """This process goes on as that program, with the signals as the shell has them. Does not return."""
    for number in (signal.SIGPIPE, signal.SIGXFSZ):  # Python ignores them, and what it ignores is inherited
        signal.signal(number, signal.SIG_DFL)
    sys.stdout.flush()
    os.execvpe(words[0], words, environment or os.environ)
