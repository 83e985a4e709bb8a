"""The errors of this folder."""


class Refusal(Exception):
    """One sentence: what is wrong, with which value, and what to do."""


class Interrupted(Exception):
    """Ctrl-C or its like before anything was started."""


def sentence_of(error):
    """One sentence from an OSError."""
    where = f"{error.filename}: " if error.filename else ""
    return f"{where}{error.strerror or error}"
