"""The rows of one chunk of games: an append-only file, so that a killed job loses no finished game."""
import csv
import fcntl
import io
import os

from tactus.study import trial_table


class Busy(Exception):
    """Another process plays this chunk."""


class ChunkFile:
    """Locks the file until close(). Raises Busy, OSError."""

    def __init__(self, path):
        self.times = times_file(path)
        self.file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(self.file)
            raise Busy from None
        whole = whole_lines(os.pread(self.file, os.fstat(self.file).st_size, 0))
        os.ftruncate(self.file, len(whole))  # removes an incomplete last line
        if not whole:
            os.write(self.file, line(trial_table.COLUMNS))
        self.done = {int(r["trial"]) for r in rows(whole)}

    def append(self, row, seconds=None):
        """Appends the row of a game. seconds: the measured time that the game took, for the remaining time of the sweep."""
        sentence = trial_table.wrong(row)
        if sentence:
            raise ValueError(sentence)
        whole = line(trial_table.fields_of(row))
        if os.write(self.file, whole) != len(whole):
            raise OSError(28, "No space left on device")
        self.done.add(row["trial"])
        if seconds is not None:
            with open(self.times, "a", encoding="utf-8") as times:
                times.write(f"{seconds:.4f}\n")

    def close(self):
        os.close(self.file)


def times_file(path):
    """The file of the measured times of a chunk's games."""
    return path.with_suffix(".times")


def times(path):
    """Measured times of the games of a chunk, s; games that another sweep or build played have none."""
    try:
        text = times_file(path).read_text(encoding="utf-8")
    except FileNotFoundError:
        return []
    return [float(seconds) for seconds in text[:text.rfind("\n") + 1].split()]


def line(fields):
    text = io.StringIO()
    csv.writer(text, lineterminator="\r\n").writerow(fields)
    return text.getvalue().encode()


def whole_lines(data):
    """The data up to the last line end. Fields of these tables contain no line break."""
    return data[:data.rfind(b"\r\n") + 2] if b"\r\n" in data else b""


def rows(data):
    return list(csv.DictReader(io.StringIO(data.decode(), newline="")))


def count(path):
    """Number of games in a chunk's file, also while it grows."""
    try:
        return max(0, whole_lines(path.read_bytes()).count(b"\r\n") - 1)
    except FileNotFoundError:
        return 0
