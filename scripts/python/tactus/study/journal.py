"""The journal of a participant: what was asked and answered, one line of JSON each, on the disk before the next thing is asked.

  journal = Journal(folder)                 locks it; reads what is there
  journal.begin(study=..., ...)             the first line, or a check that it is the same study and participant
  journal.append({"kind": "trial", ...})    written and synced when this returns
  journal.entries                           all of them

A line holds n (its number, from 1), time_utc, the entry, and crc32 of all before it in the line, so that a line that was damaged or edited
is found. A last line that was torn by a crash is cut off: it was never acknowledged, so its trial is asked again. All other damage is refused
with its line, and nothing is changed.
"""
import contextlib
import datetime
import fcntl
import json
import math
import os
import pathlib
import zlib

from tactus.refusal import Refusal, sentence_of

NAME = "journal.jsonl"
LARGEST_BYTES = 1_000_000_000  # design: far above the longest study
# Members that entries of each kind have at least.
KINDS = {
    "session": ("study", "study_sha256", "participant", "seed", "observer"),
    "trial": ("trial", "attempt", "block", "condition", "question", "level", "response", "yes", "missed", "row"),
    "questionnaire": ("item", "answer"), "break": (), "note": (), "end": ()}
OBSERVERS = ("human", "simulated")
OWN = ("n", "time_utc", "crc32")


def utc_now():
    return datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="milliseconds")


def key_of(entry):
    """What is asked once: a question of a trial."""
    return entry["trial"], entry["question"]


def is_count(value):
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def is_level(value):
    """A number, two of them for two senses, or None where the condition has no level."""
    numbers = value if isinstance(value, list) and len(value) == 2 else [value]
    return value is None or all(isinstance(v, (int, float)) and not isinstance(v, bool) and math.isfinite(v) for v in numbers)


def wrong(entry, answered, first):
    """What is wrong with an entry, in words; None: nothing. answered: keys of trials that are answered. first: nothing stands before it."""
    kind = entry.get("kind")
    if not isinstance(kind, str) or kind not in KINDS:
        return f"the kind {str(kind)[:40]!r} is not one of {', '.join(KINDS)}"
    if first != (kind == "session"):
        return "a journal begins with its session" if first else "there is a second session; one folder holds one participant's session"
    missing = [name for name in KINDS[kind] if name not in entry]
    if missing:
        return f"a {kind} has no {missing[0]}"
    if kind == "session" and entry["observer"] not in OBSERVERS:
        return f"the observer {str(entry['observer'])[:40]!r} is not one of {', '.join(OBSERVERS)}"
    if kind != "trial":
        return None
    if not all(is_count(entry[name]) for name in ("trial", "attempt", "block")):
        return "trial, attempt and block are whole numbers"
    if not isinstance(entry["condition"], str) or not isinstance(entry["question"], str) or not isinstance(entry["missed"], str):
        return "condition, question and missed are texts"
    if not is_level(entry["level"]) or entry["yes"] not in (True, False, None) or not isinstance(entry["row"], dict):
        return "level is a number, two or null; yes is true, false or null; row is an object"
    if key_of(entry) in answered:
        return f"trial {entry['trial']} is answered already"
    return None


def line_of(entry):
    """The bytes of a line. ValueError where an entry is not JSON (NaN among others)."""
    body = json.dumps(entry, ensure_ascii=False, allow_nan=False, separators=(", ", ": "))
    return f'{body[:-1]}, "crc32": "{zlib.crc32(body.encode()):08x}"}}\n'.encode()


def entry_of(line, number):
    """The entry of a line (bytes without newline); ValueError with what is wrong."""
    head, mark, tail = line.rpartition(b', "crc32": "')
    if not mark or len(tail) != 10 or not tail.endswith(b'"}'):
        raise ValueError("it is no line of a journal, or torn")
    if tail[:8] != b"%08x" % zlib.crc32(head + b"}"):
        raise ValueError("it is not what was written: damaged, or edited")
    entry = json.loads(head + b"}")
    if entry.get("n") != number:
        raise ValueError(f"it is number {entry.get('n')}; lines are missing, or stand twice")
    return entry


def read_lines(data, path):
    """(entries, bytes to keep, what is to be repaired or ""). Raises Refusal with the line."""
    entries, answered, at = [], set(), 0
    while at < len(data):
        end = data.find(b"\n", at)
        line = data[at:] if end < 0 else data[at:end]
        number = len(entries) + 1
        try:
            entry = entry_of(line, number)
        except ValueError as error:
            if end < 0:
                return entries, at, f"{path}:{number}: the last line was torn and is cut off ({len(line)} bytes); what it said is asked again"
            raise Refusal(f"{path}:{number}: {error}; restore the file from a copy, or begin in another folder") from None
        sentence = wrong(entry, answered, number == 1)
        if sentence:
            raise Refusal(f"{path}:{number}: {sentence}; restore the file from a copy, or begin in another folder")
        if entry["kind"] == "trial" and not entry["missed"]:
            answered.add(key_of(entry))
        entries.append(entry)
        if end < 0:
            return entries, len(data), f"{path}:{number}: the last line was whole but for its end, and is kept"
        at = end + 1
    return entries, at, ""


def read_bytes(file, path):
    data = file.read(LARGEST_BYTES + 1)
    if len(data) > LARGEST_BYTES:
        raise Refusal(f"{path}: is longer than {LARGEST_BYTES} bytes; that is no journal")
    return data


def read(folder):
    """Entries of a journal that somebody else may be writing; a torn last line is passed over. Raises Refusal."""
    path = pathlib.Path(folder) / NAME
    try:
        with open(path, "rb") as file:
            return read_lines(read_bytes(file, path), path)[0]
    except OSError as error:
        raise Refusal(f"{path}: cannot be read ({error.strerror}); give the folder of a participant, as tactus study run leaves it") from None


class Journal:
    """Of one folder, held by one process at a time. Raises Refusal. entries: what it holds. repaired: what was mended, in words; "": nothing."""

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
            raise Refusal(f"{self.path}: cannot be written ({sentence_of(error)}); choose a folder that is yours, with room on its disk") from None
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
            os.fsync(folder)  # the file's name is on the disk too
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
        """The entry as written, on the disk when this returns. ValueError: it is no entry, or its trial is answered already. Refusal: the disk
        did not take it; then the journal is as before."""
        taken = [name for name in OWN if name in entry]
        if taken:
            raise ValueError(f"an entry of the journal must not have {taken[0]}; the journal adds it")
        whole = {"n": len(self.entries) + 1, "time_utc": self.now(), **entry}
        line = line_of(whole)
        whole = json.loads(line)  # as it will be read again: tuples are lists
        del whole["crc32"]
        sentence = wrong(whole, self._answered, not self.entries)
        if sentence:
            raise ValueError(f"{self.path}: {sentence}")
        try:
            self._write(line)
        except OSError as error:
            with contextlib.suppress(OSError):
                self._cut(self._size)
            raise Refusal(f"{self.path}: cannot be written ({sentence_of(error)}); make room on its disk and resume") from None
        self._size += len(line)
        self.entries.append(whole)
        if whole["kind"] == "trial" and not whole["missed"]:
            self._answered.add(key_of(whole))
        return whole

    def begin(self, **session):
        """Writes the session's line, or checks that the one that is there says the same (time aside). True: the session is resumed."""
        if not self.entries:
            self.append({"kind": "session", **session})
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
        """Entries of trials that count, in the order in which they were answered: those whose apparatus kept its tolerance."""
        return [e for e in self.entries if e["kind"] == "trial" and not e["missed"]]

    def close(self):
        if self.file is not None:
            self.file.close()  # gives the lock back
            self.file = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
