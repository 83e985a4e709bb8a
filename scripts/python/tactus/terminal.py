"""What a person is told. A terminal or a pipe that has gone away ends the telling, never the run."""
import os
import sys


def prepare():
    """Text that the terminal cannot show is shown escaped."""
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:  # it was closed from the start
            stream.reconfigure(errors="backslashreplace")


def printable(text):
    """Control characters would be orders to the terminal."""
    return "".join(c if c == "\n" or not (ord(c) < 32 or 127 <= ord(c) < 160) else f"\\x{ord(c):02x}" for c in text)


def tell(text, stream=None):
    """Prints whole lines."""
    stream = stream or sys.stdout
    try:
        print(printable(text), file=stream, flush=True)
    except OSError:
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, stream.fileno())  # what is still in the buffer goes there too
        os.close(null)


def say(text):
    tell(f"run: {text}")


def complain(text):
    tell(text, sys.stderr)
