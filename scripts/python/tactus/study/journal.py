"""The journal of a participant: questions and answers, one line of JSON each, written to disk before the next question.

  journal = Journal(folder)                 locks the journal and reads its entries
  journal.begin(study=..., ...)             writes the first line, or checks that study and participant are the same
  journal.append({"kind": "trial", ...})    written and synced when this returns
  journal.entries                           all entries

A line holds n (its number, from 1), time_utc, the entry, and crc32 of all preceding bytes of the line, which detects damage and edits. A last
line that a crash left incomplete is removed: it was never acknowledged, so its trial is repeated. Any other damage is refused with its line,
and the file stays unchanged.
"""
import contextlib
import datetime
import fcntl
import json
import math
import os
import pathlib
import zlib

from tactus import own_files
from tactus.refusal import Refusal, sentence_of

NAME = "journal.jsonl"
LARGEST_BYTES = 1_000_000_000  # design: far above the longest study
# Required members of the entries of each kind.
KINDS = {
    "session": ("study", "study_sha256", "participant", "seed", "observer"),
    "trial": ("trial", "attempt", "block", "condition", "question", "level", "response", "yes", "missed", "row"),
    "questionnaire": ("item", "answer"), "break": (), "note": (), "end": ()}
OBSERVERS = ("human", "simulated")
OWN = ("n", "time_utc", "crc32")


def utc_now():
    return datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="milliseconds")


def key_of(entry):
    """Key of a question that is answered once: (trial, question)."""
    return entry["trial"], entry["question"]


def is_count(value):
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def is_level(value):
    """A number, two numbers for two senses, or None for a condition without a level."""
    numbers = value if isinstance(value, list) and len(value) == 2 else [value]
    return value is None or all(isinstance(v, (int, float)) and not isinstance(v, bool) and math.isfinite(v) for v in numbers)


def wrong(entry, answered, first):
    """The first error of an entry, as a sentence; None: the entry is valid. answered: keys of answered trials. first: the entry is the first one."""
    kind = entry.get("kind")
    if not isinstance(kind, str) or kind not in KINDS:
        return f"the kind {str(kind)[:40]!r} is not one of {', '.join(KINDS)}"
    if first != (kind == "session"):
        return "a journal begins with its session" if first else "there is a second session; one folder holds one session of one participant"
    missing = [name for name in KINDS[kind] if name not in entry]
    if missing:
        return f"a {kind} has no {missing[0]}"
    if kind == "session" and entry["observer"] not in OBSERVERS:
        return f"the observer {str(entry['observer'])[:40]!r} is not one of {', '.join(OBSERVERS)}"
    if kind != "trial":
        return None
    if not all(is_count(entry[name]) for name in ("trial", "attempt", "block")):
        return "trial, attempt and block must be whole numbers"
    if not isinstance(entry["condition"], str) or not isinstance(entry["question"], str) or not isinstance(entry["missed"], str):
        return "condition, question and missed must be texts"
    if not is_level(entry["level"]) or entry["yes"] not in (True, False, None) or not isinstance(entry["row"], dict):
        return "level must be a number, two numbers or null; yes true, false or null; row an object"
    if key_of(entry) in answered:
        return f"trial {entry['trial']} is answered already"
    return None


def line_of(entry):
    """The bytes of a line. Raises ValueError if an entry is not JSON (for example NaN)."""
    body = json.dumps(entry, ensure_ascii=False, allow_nan=False, separators=(", ", ": "))
    return f'{body[:-1]}, "crc32": "{zlib.crc32(body.encode()):08x}"}}\n'.encode()


def entry_of(line, number):
    """The entry of a line (bytes without newline); raises ValueError with the reason."""
    head, mark, tail = line.rpartition(b', "crc32": "')
    if not mark or len(tail) != 10 or not tail.endswith(b'"}'):
        raise ValueError("the line is not of a journal, or incomplete")
    if tail[:8] != b"%08x" % zlib.crc32(head + b"}"):
        raise ValueError("the line does not match its checksum: it was damaged or edited")
    try:
        entry = json.loads(head + b"}")
    except RecursionError:
        raise ValueError("its lists are nested too deeply") from None
    if entry.get("n") != number:
        raise ValueError(f"the line has number {entry.get('n')}; lines are missing or repeated")
    return entry


def read_lines(data, path):
    """(entries, number of bytes to keep, description of a repair or ""). Raises Refusal with the line."""
    entries, answered, at = [], set(), 0
    while at < len(data):
        end = data.find(b"\n", at)
        line = data[at:] if end < 0 else data[at:end]
        number = len(entries) + 1
        try:
            entry = entry_of(line, number)
        except ValueError as error:
            if end < 0:
                return entries, at, f"{path}:{number}: the last line was incomplete and is removed ({len(line)} bytes); its question is asked again"
            raise Refusal(f"{path}:{number}: {error}; restore the file from a copy, or begin in another folder") from None
        sentence = wrong(entry, answered, number == 1)
        if sentence:
            raise Refusal(f"{path}:{number}: {sentence}; restore the file from a copy, or begin in another folder")
        if entry["kind"] == "trial" and not entry["missed"]:
            answered.add(key_of(entry))
        entries.append(entry)
        if end < 0:
            return entries, len(data), f"{path}:{number}: the last line lacked only its line end, and is kept"
        at = end + 1
    return entries, at, ""


def read_bytes(file, path):
    data = file.read(LARGEST_BYTES + 1)
    if len(data) > LARGEST_BYTES:
        raise Refusal(f"{path}: is longer than {LARGEST_BYTES} bytes; give the journal of a participant")
    return data


def read(folder):
    """Entries of a journal, which another process may be writing; an incomplete last line is skipped. Raises Refusal."""
    path = pathlib.Path(folder) / NAME
    try:
        with own_files.open_regular(path) as file:
            return read_lines(read_bytes(file, path), path)[0]
    except OSError as error:
        raise Refusal(f"{path}: cannot be read ({error.strerror}); give the folder of a participant that tactus study run wrote") from None


class Journal:
    """The journal of one folder; one process at a time holds its lock. Raises Refusal. entries: its entries. repaired: description of a repair;
    "": none."""

    def __init__(self, folder, now=utc_now):
        self.folder, self.now = pathlib.Path(folder), now
        self.path = self.folder / NAME
        self.file = None
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self.file = open(self.path, "a+b", buffering=0)  # pylint: disable=consider-using-with
            fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            self._read()
        except BlockingIOError:
            self.close()
            raise Refusal(f"{self.folder}: another process holds its journal; end that session first, or choose another participant or folder") from None
        except OSError as error:
            self.close()
            raise Refusal(f"{self.path}: cannot be written ({sentence_of(error)}); choose a writable folder with free space") from None
        except BaseException:
            self.close()
            raise

    def _read(self):
        self.file.seek(0)
        data = read_bytes(self.file, self.path)
        self.entries, size, self.repaired = read_lines(data, self.path)
        self._answered = {key_of(e) for e in self.entries if e["kind"] == "trial" and not e["missed"]}
        if self.repaired:
            self._cut(size)
            if size and not data[:size].endswith(b"\n"):
                self._write(b"\n")
        self._size = os.fstat(self.file.fileno()).st_size
        folder = os.open(self.folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(folder)  # writes the file's name to disk
        finally:
            os.close(folder)

    def _cut(self, size):
        self.file.truncate(size)
        os.fsync(self.file.fileno())

    def _write(self, line):
        while line:
            line = line[self.file.write(line):]
        os.fsync(self.file.fileno())

    def append(self, entry):
        """Writes and syncs an entry; returns it as written. Raises ValueError if it is invalid or its trial is already answered, and Refusal if it
        cannot be written; then the journal is unchanged."""
        taken = [name for name in OWN if name in entry]
        if taken:
            raise ValueError(f"an entry must not contain {taken[0]}; the journal adds it")
        whole = {"n": len(self.entries) + 1, "time_utc": self.now(), **entry}
        line = line_of(whole)
        whole = json.loads(line)  # as it is read later: tuples become lists
        del whole["crc32"]
        sentence = wrong(whole, self._answered, not self.entries)
        if sentence:
            raise ValueError(f"{self.path}: {sentence}")
        try:
            self._write(line)
        except OSError as error:
            with contextlib.suppress(OSError):
                self._cut(self._size)
            raise Refusal(f"{self.path}: cannot be written ({sentence_of(error)}); free space on its disk and resume") from None
        self._size += len(line)
        self.entries.append(whole)
        if whole["kind"] == "trial" and not whole["missed"]:
            self._answered.add(key_of(whole))
        return whole

    def begin(self, more=None, **session):
        """Writes the session's line, or checks it against the existing one (except the time). more: further members of a new line. True: the session is
        resumed."""
        if not self.entries:
            self.append({"kind": "session", **session, **(more or {})})
            return False
        for name, value in session.items():
            if self.entries[0].get(name) != value:
                raise Refusal(f"{self.path}:1: {name} was {str(self.entries[0].get(name))[:80]!r} when this session began and is {str(value)[:80]!r} now; "
                              "resume with the same study file, seed and participant, or choose another folder")
        return True

    @property
    def ended(self):
        return any(entry["kind"] == "end" for entry in self.entries)

    def answered(self):
        """Entries of the trials that count, in order of their answers; missed trials do not count."""
        return [e for e in self.entries if e["kind"] == "trial" and not e["missed"]]

    def close(self):
        if self.file is not None:
            self.file.close()  # releases the lock
            self.file = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
