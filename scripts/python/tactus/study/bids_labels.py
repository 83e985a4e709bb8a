"""Labels of participants in the Brain Imaging Data Structure, which permits only the letters A to Z and digits.

A name of ASCII letters, digits, - and _ is its own label without - and _. Any other name gets a number: n001, n002, ... Two participants of one study never share a
label, also without regard to case. A session stores its label in its journal, so that it stays the same. Sessions that store none are labelled in the order of
their beginnings.
"""
import contextlib
import fcntl
import os
import pathlib
import re

from tactus import own_files
from tactus.study import journal

LABEL = re.compile("[A-Za-z0-9]{1,64}")
MAX_LINE_BYTES = 1_000_000  # of the first line of a journal; design


def of_name(name):
    """The label of a name; "": it needs a number."""
    return re.sub("[^A-Za-z0-9]", "", name) if name.isascii() else ""


def assigned(sessions):
    """{name: label} of the first entries of journals of one study."""
    labels, taken = {}, set()
    in_time = sorted(sessions, key=lambda s: (str(s.get("time_utc")), s["participant"]))
    for session in in_time:
        name, label = session["participant"], session.get("label")
        # Folders of two computers may hold the same label for two names: the earlier session keeps it.
        if isinstance(label, str) and LABEL.fullmatch(label) and name not in labels and label.casefold() not in taken:
            labels[name] = label
            taken.add(label.casefold())
    for session in in_time:
        name = session["participant"]
        if name in labels:
            continue
        label, number = of_name(name), 0
        while not label or label.casefold() in taken:
            number += 1
            label = f"n{number:03d}"
        labels[name] = label
        taken.add(label.casefold())
    return labels


def first_entry(path):
    """The first entry of a journal; None: it has no valid one, or cannot be read."""
    try:
        with own_files.open_regular(path) as file:
            entry = journal.entry_of(file.readline(MAX_LINE_BYTES).rstrip(b"\n"), 1)
    except (OSError, ValueError):
        return None
    return entry if journal.wrong(entry, set(), True) is None and isinstance(entry["participant"], str) else None


def sessions_beside(folder, study):
    """First entries of the journals of this study in the folder of all participants, OUT/STUDY; none in a folder of another name."""
    if pathlib.Path(folder).name != study:
        return []
    found = (first_entry(path) for path in sorted(pathlib.Path(folder).glob(f"*/{journal.NAME}")))
    return [entry for entry in found if entry is not None and entry["study"] == study]


def of_session(folder, session):
    """The label of a session, whose participant has this folder. session: the first entry of its journal."""
    others = [entry for entry in sessions_beside(pathlib.Path(folder).absolute().parent, session["study"]) if entry["participant"] != session["participant"]]
    return assigned([*others, session])[session["participant"]]


def begin(opened, **session):
    """Begins or resumes a session in this journal, as Journal.begin(). A new session stores its label; sessions that begin at the same time get different ones."""
    everyone = os.open(opened.folder.parent, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        with contextlib.suppress(OSError):  # a file system without locks
            fcntl.flock(everyone, fcntl.LOCK_EX)
        known = sessions_beside(opened.folder.parent, session["study"])
        label = assigned([*known, {**session, "time_utc": "~"}])[session["participant"]]  # "~": after all others
        return opened.begin(more={"label": label}, **session)
    finally:
        os.close(everyone)
