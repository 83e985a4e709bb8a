"""The options that all commands share, with one meaning everywhere, and the end of every help text.

--quiet and `--json -` are carried out here, by file descriptors, so they hold for every program that a command starts.
"""
import os
import signal
import sys

from tactus import own_files, signals
from tactus.refusal import Refusal

QUIET = "--quiet"
JSON = "--json"
# As printed at the end of the help of a command that has the option; --out and --seed are described by the command itself.
MEANINGS = {
    "quiet": "  --quiet      prints nothing but errors",
    "json": "  --json FILE  also writes the results to FILE as JSON; -: prints only these, and the other lines go to stderr",
}
EXIT_STATUS = ("Exit status: 0, or 1 with the reason in one sentence on stderr. 130 after Ctrl-C.")


def is_help(words):
    return bool({"--help", "-h"} & set(words))


def verb_of(command, words):
    return words[0] if words and words[0] in command.verbs else ""


def help_end(command, words, text):
    """The text after the help of a command: common options, examples of the verb, exit status."""
    verb = verb_of(command, words)
    shown = [(example, what) for example, what in command.examples if not verb or example.split()[1:2] == [verb]]
    lines = []
    if not command.passes_words:
        lines += ["Options of every command", MEANINGS["quiet"], *([MEANINGS["json"]] if "json" in command.options and JSON in text else []), ""]
    if shown:
        lines += ["Examples", *(line for example, what in shown for line in (f"  tactus {example}", f"      {what}")), ""]
    if "Exit status" not in text:
        lines.append(EXIT_STATUS)
    return "\n".join(lines).rstrip("\n")


def carried_out(command, words):
    """The words without --quiet and with `--json -` replaced by a file; redirects stdout of this process accordingly. The words of a command
    of the user, after `attach` and `lab`, are not touched."""
    if command.passes_words:
        return words
    if "json" in command.options and (at := position_of_json(words)) is not None:
        words = [*words[:at], JSON, relayed_file(), *words[at + (1 if words[at] == f"{JSON}=-" else 2):]]
    if QUIET in words:
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 1)
        os.close(null)
        words = [word for word in words if word != QUIET]
    return words


def refuse_unwritable_json(command, words):
    """Ends with one sentence when the file of --json cannot be written, or is an input: before the work, which may take hours."""
    if command.passes_words or "json" not in command.options:
        return
    for at, word in enumerate(words):
        given = word.removeprefix(f"{JSON}=") if word.startswith(f"{JSON}=") else words[at + 1] if word == JSON and at + 1 < len(words) else "-"
        if given.startswith("-"):
            continue
        others = [other for i, other in enumerate(words) if i not in (at, at + 1) and os.path.isfile(other)]
        try:
            own_files.require_writable(JSON, given, others)
        except Refusal as refusal:
            sys.exit(f"{command.name}: {refusal}")


def position_of_json(words):
    """Index of `--json -` or `--json=-`; None without it."""
    return next((i for i, word in enumerate(words) if word == f"{JSON}=-" or word == JSON and words[i + 1:i + 2] == ["-"]), None)


def relayed_file():
    """Continues in a child process, whose stdout is stderr; returns the name of a file for its results. This process writes them to stdout, and
    ends with the status of the child. A pipe, because stdout may be a socket, or a file of another user, which has no name here."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        os.set_inheritable(writing, True)
        os.dup2(2, 1)
        return f"/dev/fd/{writing}"
    os.close(writing)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the child receives it from the terminal, too
    signals.handle([signal.SIGTERM, signal.SIGHUP], lambda number, _: os.kill(child, number))
    with open(reading, "rb") as results:
        while part := results.read1(65536):
            sys.stdout.buffer.write(part)
            sys.stdout.buffer.flush()
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    sys.exit(status if status >= 0 else 128 - status)
