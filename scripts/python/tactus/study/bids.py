"""A participant's answers as a data set of the Brain Imaging Data Structure, version 1.8: behavioral experiments with no neural recordings.

  dataset_description.json, README, participants.tsv
  sub-P01/ses-1/beh/sub-P01_ses-1_task-STUDY_beh.tsv      the trial table
  sub-P01/ses-1/beh/sub-P01_ses-1_task-STUDY_events.tsv   when each question was asked, or each game began
  phenotype/questionnaire.tsv                             answers to the questionnaire

Each table has a .json that describes its columns. Data sets of several participants and sessions share only the files above sub-*. Copying them into
one folder merges them, except the rows of participants.tsv and questionnaire.tsv.
"""
import datetime
import json
import re

from tactus.study import bids_labels
from tactus.study.trial_table import COLUMNS, replace, text_of
from tactus.tables import escaped

VERSION = "1.8.0"
EVENTS = {
    "onset": {"LongName": "onset", "Description": "time of the question, or of the start of the game, since the start of the session; by the clock of the computer, accurate to a few "
              "hundredths of a second. The log of the run contains the presentation time of the stimulus", "Units": "s"},
    "duration": {"LongName": "duration", "Description": "time until the answer, or until the end of the game", "Units": "s"},
    "trial_type": {"LongName": "type of trial", "Description": "the condition"},
    "trial": {"LongName": "trial", "Description": "number of the trial, as in the trial table"},
    "observer": {"LongName": "observer", "Description": "source of the answers", "Levels": {"human": "a person", "simulated": "a program"}}}


def described():
    """{column: description} of the trial table for its sidecar."""
    found = {}
    for name, column in COLUMNS.items():
        entry = {"LongName": name.replace("_", " "), "Description": column.description}
        if column.unit.startswith(("of ", "as ")):
            entry["Description"] += f"; its unit: {column.unit.removeprefix('of ')}"
        elif column.unit:
            entry["Units"] = column.unit
        if column.levels:
            entry["Levels"] = {level: level for level in column.levels}
        elif column.kind == "flag":
            entry["Levels"] = {"0": "no", "1": "yes"}
        found[name] = entry
    return found


def field(value):
    """Text of a field; tabs and line ends become spaces, and formulas of spreadsheets are escaped."""
    plain = re.sub(r"[\t\r\n]", " ", text_of(value)) or "n/a"
    return escaped(plain) if isinstance(value, str) else plain


def put(path, columns, rows, meaning):
    """Writes a table and its sidecar."""
    replace(path.with_suffix(".tsv"), "".join("\t".join(map(field, row)) + "\n" for row in (columns, *rows)))
    replace(path.with_suffix(".json"), json.dumps(meaning, indent=2, ensure_ascii=False) + "\n")


def seconds_between(earlier, later):
    return (datetime.datetime.fromisoformat(later) - datetime.datetime.fromisoformat(earlier)).total_seconds()


def events(session, entries):
    """Rows of EVENTS, for answers with a response or completion time."""
    found = []
    for e in entries:
        if e["kind"] != "trial" or e["missed"]:
            continue
        took_s = e["row"].get("response_time", e["row"].get("completion_time_s"))
        if took_s is not None:
            found.append((round(seconds_between(session["time_utc"], e["time_utc"]) - took_s, 3), took_s, e["condition"], e["row"].get("trial"), session["observer"]))
    return found


def write(folder, session, entries, rows, label=None):
    """Writes the data set to `folder`. session: first entry of the journal; entries: all its entries; rows: of the trial table; label: of the
    participant (bids_labels.py); default: from the name alone."""
    label = label or bids_labels.assigned([session])[session["participant"]]
    number = next((row["session"] for row in rows if row.get("session") is not None), 1)
    subject, visit, task = f"sub-{label}", f"ses-{number}", f"task-{bids_labels.of_name(session['study']) or 'x'}"
    simulated = session["observer"] == "simulated"
    head = {"Name": session["study"] + (" (observer=simulated)" if simulated else ""), "BIDSVersion": VERSION, "DatasetType": "raw", "GeneratedBy": [{"Name": "Tactus"}]}
    replace(folder / "dataset_description.json", json.dumps(head, indent=2, ensure_ascii=False) + "\n")
    replace(folder / "README", f"Answers to the study {session['study']}.\n\n" + (
        "observer=simulated: a program answered; no person took part.\n" if simulated else "The participants are people; observer=human in every row.\n")
        + "Asynchronies are differences of presentation times, t(b) - t(a) of a pair a,b, measured (soa_achieved_ms) and requested (soa_nominal_ms).\n")
    put(folder / "participants", ("participant_id", "name", "observer"), [(subject, session["participant"], session["observer"])],
        {"name": {"LongName": "name", "Description": "name of the participant, as in participant_id of the other tables; labels have only the letters A to Z and digits"},
         "observer": EVENTS["observer"]})
    beh = folder / subject / visit / "beh"
    named = f"{subject}_{visit}_{task}"
    put(beh / f"{named}_beh", COLUMNS, [[row.get(name) for name in COLUMNS] for row in rows], {"TaskName": session["study"], **described()})
    happened = events(session, entries)
    if happened:
        put(beh / f"{named}_events", EVENTS, happened, EVENTS)
    items = {e["item"]: e["answer"] for e in entries if e["kind"] == "questionnaire"}
    if items:
        put(folder / "phenotype" / "questionnaire", ("participant_id", "session_id", "observer", *items), [(subject, visit, session["observer"], *items.values())],
            {"session_id": {"Description": "the session"}, "observer": EVENTS["observer"], **{item: {"Description": f"answer to the item {item} of the study file"} for item in items}})
