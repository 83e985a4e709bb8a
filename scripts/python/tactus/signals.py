"""Handlers for the signals that end a program."""
import signal

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
REASONS = {signal.SIGINT: "Ctrl-C", signal.SIGTERM: "SIGTERM", signal.SIGHUP: "SIGHUP, because the terminal was closed"}


def handle(numbers, handler):
    """Installs a handler for these signals. A signal that the caller ignores stays ignored: with nohup(1), the end of the terminal; in a
    background job of a script, Ctrl-C."""
    for number in numbers:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, handler)


class Stop:
    """Flag set by SIGINT, SIGTERM and SIGHUP; polled by a loop."""

    def __init__(self):
        self.requested = False
        self.reason = ""  # for the user
        self.cut_short = ""  # the sentence for a run that ended early
        handle(ENDING, self.request)

    def request(self, number=None, _=None):
        self.requested = True
        self.reason = self.reason or REASONS.get(number, "a signal")
