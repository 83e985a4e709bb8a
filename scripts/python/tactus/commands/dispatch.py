"""The command line of `tactus`: finds the command and runs it."""
import contextlib
import difflib
import importlib
import io
import os
import pathlib
import subprocess
import sys

from tactus.commands import common_options
from tactus.commands.table import ALIASES, BY_NAME, GROUPS
from tactus.paths import INSTALLED

SCRIPTS = pathlib.Path(__file__).resolve().parents[3]
MODULE = "--module"  # internal: runs main() of a module of this package; the module and its arguments follow


def is_available(command):
    return not (INSTALLED and command.from_source)


def usage():
    width = max(map(len, BY_NAME))
    lines = ["Usage: tactus COMMAND [ARGUMENT]...", ""]
    for group, commands in GROUPS.items():
        lines += [group, *(f"  {c.name:{width}}  {c.summary}" for c in commands if is_available(c)), ""]
    return "\n".join([*lines, "tactus COMMAND --help describes a command; tactus --version prints the release."])


def unknown(name):
    """Message for an unknown command, with the nearest name."""
    near = difflib.get_close_matches(name.replace("_", "-"), [*filter(lambda n: is_available(BY_NAME[n]), BY_NAME)], 1, 0.5)
    return f"tactus: there is no command '{name}'; " + (f"did you mean '{near[0]}'?" if near else "tactus --help lists them")


def version():
    """Release and commit of an installation; of a source tree, its state in git."""
    if INSTALLED:
        return f"tactus {INSTALLED['version']} ({INSTALLED['commit'][:12]})"
    from tactus.launch.results import git_commit
    return f"tactus, source tree ({git_commit()[:12]})"


def print_help(command, words):
    """Prints the help of a command with examples and exit status. Returns the exit status."""
    if "." not in command.target:
        done = subprocess.run([str(SCRIPTS / command.target), *words], stdout=subprocess.PIPE, text=True, check=False)
        status, text = done.returncode, done.stdout
    else:
        taken = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")  # with the methods of stdout, which commands use
        with contextlib.redirect_stdout(taken):
            try:
                status = importlib.import_module(command.target).main(words)
            except SystemExit as end:
                if isinstance(end.code, str):
                    raise
                status = end.code or 0
        taken.flush()
        text = taken.buffer.getvalue().decode()
    if status == 0 and text:
        text = text.rstrip("\n") + "\n\n" + common_options.help_end(command, words, text) + "\n"
    sys.stdout.write(text)
    return status


def run(command, words):
    common_options.refuse_unwritable_json(command, words)
    words = common_options.carried_out(command, words)
    if "." not in command.target:
        script = str(SCRIPTS / command.target)
        os.execv(script, [script, *words])
    if command.packages and words:
        from tactus.commands import prepare
        prepare.install(command.packages)
    return importlib.import_module(command.target).main(words)


def main(words):
    if not words or words[0] in ("--help", "-h"):
        print(usage(), file=sys.stdout if words else sys.stderr)
        return 0 if words else 1
    name, *words = words
    if name == "--version":
        print(version())
        return 0
    if name == MODULE:
        if not words or not words[0].startswith("tactus."):
            print(f"tactus: {MODULE} needs a module of the package tactus; tactus --help lists the commands", file=sys.stderr)
            return 1
        return importlib.import_module(words[0]).main(words[1:])
    command = BY_NAME.get(ALIASES.get(name, name))
    if command is None:
        print(unknown(name), file=sys.stderr)
        return 1
    if not is_available(command):
        print(f"tactus: '{name}' needs the sources of Tactus, and this is an installation; clone the repository", file=sys.stderr)
        return 1
    # A command of the user, after `attach` and `lab`, has its own help.
    if common_options.is_help(words[:1] if command.passes_words else words):
        return print_help(command, words)
    return run(command, words)
