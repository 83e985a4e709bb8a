"""Exceptions of the commands, and the sentences of errors."""
import re

ENDED = re.compile(r"virtual_time: (\S+) ended; see its message above")


class Refusal(Exception):
    """An error of the user or the system; one sentence: the fault, the value, and the remedy."""


class Interrupted(Exception):
    """SIGINT, SIGTERM or SIGHUP arrived before anything was started."""


def reason_of(said):
    """The line of an output that names why its program ended: the last one; of virtual_time, the last one of the node that it names."""
    lines = said.strip().split("\n")
    named = ENDED.fullmatch(lines[-1])
    return next((line for line in reversed(lines) if named and line.startswith(f"{named[1]}: ")), lines[-1])


def sentence_of(error):
    """The message of an OSError: file and reason."""
    where = f"{error.filename}: " if error.filename else ""
    return f"{where}{error.strerror or error}"
