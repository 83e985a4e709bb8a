"""The command line of `tactus`: finds the command and runs it."""
import difflib
import importlib
import os
import pathlib
import sys

from tactus.commands.table import BY_NAME, GROUPS

SCRIPTS = pathlib.Path(__file__).resolve().parents[3]
MODULE = "--module"  # internal: runs main() of a module of this package; the module and its arguments follow


def usage():
    width = max(map(len, BY_NAME))
    lines = ["Usage: tactus COMMAND [ARGUMENT]...", ""]
    for group, commands in GROUPS.items():
        lines += [group, *(f"  {c.name:{width}}  {c.summary}" for c in commands), ""]
    return "\n".join([*lines, "tactus COMMAND --help describes a command."])


def unknown(name):
    """Message for an unknown command, with the nearest name."""
    near = difflib.get_close_matches(name.replace("_", "-"), BY_NAME, 1, 0.5)
    return f"tactus: there is no command '{name}'; " + (f"did you mean '{near[0]}'?" if near else "tactus --help lists them")


def main(words):
    if not words or words[0] in ("--help", "-h"):
        print(usage(), file=sys.stdout if words else sys.stderr)
        return 0 if words else 1
    name, *words = words
    if name == MODULE:
        if not words or not words[0].startswith("tactus."):
            print(f"tactus: {MODULE} needs a module of the package tactus; tactus --help lists the commands", file=sys.stderr)
            return 1
        return importlib.import_module(words[0]).main(words[1:])
    if name not in BY_NAME:
        print(unknown(name), file=sys.stderr)
        return 1
    target = BY_NAME[name].target
    if "." not in target:
        script = str(SCRIPTS / target)
        os.execv(script, [script, *words])
    if BY_NAME[name].packages and words and not {"--help", "-h"} & set(words):
        from tactus.commands import prepare
        prepare.install(BY_NAME[name].packages)
    return importlib.import_module(target).main(words)
