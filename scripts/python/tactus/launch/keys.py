"""Commands to a running replay: keys of the terminal, or lines of a pipe on stdin, written to its named pipe."""
import os
import select
import stat
import termios
import tty

MAX_LINE_BYTES = 65536  # bytes of an incomplete line
COMMAND_OF_KEY = {b" ": "toggle", b".": "step", b"\x1b[C": "seek +5", b"\x1b[D": "seek -5", b"0": "seek 0", b"1": "speed 1", b"m": "speed max",
          b"\x1b[H": "seek 0"}
MIN_SPEED, MAX_SPEED = 1 / 64, 64


class KeyCommands:
    """A context manager; inside it the terminal delivers single keys."""

    def __init__(self, control):
        self.control = control
        self.stdin = self.before = None
        self.speed, self.loop, self.rest = 1.0, False, b""

    def __enter__(self):
        try:
            kind = os.fstat(0).st_mode
            if os.isatty(0) and os.tcgetpgrp(0) == os.getpgrp():
                self.before = termios.tcgetattr(0)
                tty.setcbreak(0)
                self.stdin = 0
            elif stat.S_ISFIFO(kind):
                self.stdin = 0
        except (OSError, termios.error):
            pass  # no stdin: no commands
        return self

    def __exit__(self, *_):
        if self.before is not None:
            termios.tcsetattr(0, termios.TCSADRAIN, self.before)

    def forward_new(self):
        """Forwards new commands to the replay. True: the user quits."""
        if self.stdin is None or not select.select([self.stdin], [], [], 0)[0]:
            return False
        read = os.read(self.stdin, 4096)
        if not read:
            self.stdin = None
            return False
        commands = self.commands_of_keys(read) if self.before is not None else self.commands_of_lines(read)
        for command in commands:
            if command == "quit":
                return True
            self.send(command)
        return False

    def commands_of_keys(self, read):
        while read:
            key = read[:3] if read.startswith(b"\x1b[") else read[:1]
            read = read[len(key):]
            if key in COMMAND_OF_KEY:
                self.speed = 1.0 if key == b"1" else self.speed
                yield COMMAND_OF_KEY[key]
            elif key in b"+-":
                self.speed = min(MAX_SPEED, max(MIN_SPEED, self.speed * (2 if key == b"+" else 0.5)))
                yield f"speed {self.speed}"
            elif key == b"l":
                self.loop = not self.loop
                yield f"loop {'on' if self.loop else 'off'}"
            elif key == b"q":
                yield "quit"

    def commands_of_lines(self, read):
        *lines, self.rest = (self.rest + read).split(b"\n")
        self.rest = self.rest[:MAX_LINE_BYTES]
        return [line.decode("utf-8", "replace").strip() for line in lines]

    def send(self, command):
        try:
            pipe = os.open(self.control, os.O_WRONLY | os.O_NONBLOCK)
        except OSError:
            return  # the pipe does not exist yet, or no longer
        try:
            os.write(pipe, f"{command}\n".encode())
        except OSError:
            pass  # the replay has ended or no longer reads
        finally:
            os.close(pipe)
