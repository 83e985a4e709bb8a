"""Output for the user. When the terminal or the pipe is closed, further output is discarded and the run continues."""
import os
import sys


def prepare():
    """Escapes characters that the terminal cannot encode."""
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:  # closed at the start
            stream.reconfigure(errors="backslashreplace")


def printable(text):
    """Escapes control characters, which the terminal would execute."""
    return "".join(c if c == "\n" or not (ord(c) < 32 or 127 <= ord(c) < 160) else f"\\x{ord(c):02x}" for c in text)


def one_line(text):
    """As printable(), also for line ends: a sentence with a name of the user stays one line."""
    return printable(text).replace("\n", "\\n")


def readable(text):
    """As one_line(), also for bytes that are not UTF-8: a name of the user in a table, picture or page."""
    return one_line(text).encode("utf-8", "backslashreplace").decode("utf-8")


def show(text=""):
    """Prints a line of a result. It may hold texts of others: names in tables, logs and profiles. Raises OSError when it cannot be written."""
    print(printable(text))


def report(text, stream=None):
    """Prints complete lines and flushes."""
    stream = stream or sys.stdout
    try:
        print(printable(text), file=stream, flush=True)
    except OSError:
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, stream.fileno())  # discards the rest of the buffer too
        os.close(null)


def report_run(text):
    """Prints a line of scripts/run."""
    report(one_line(f"run: {text}"))


def report_error(text):
    report(text, sys.stderr)


def report_refusal(text):
    """Prints one sentence for the user, which may name a file, to stderr."""
    report_error(one_line(text))
