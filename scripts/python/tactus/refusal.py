"""Exceptions of the commands."""


class Refusal(Exception):
    """An error of the user or the system; one sentence: the fault, the value, and the remedy."""


class Interrupted(Exception):
    """SIGINT, SIGTERM or SIGHUP arrived before anything was started."""


def sentence_of(error):
    """The message of an OSError: file and reason."""
    where = f"{error.filename}: " if error.filename else ""
    return f"{where}{error.strerror or error}"
