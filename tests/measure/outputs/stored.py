"""The file of stored results: a list of entries, one for each instruction set and versions of libraries.

An entry after the first holds only the records that differ from those of the first, and null where it lacks an artefact.
"""
import json
import os

FORMAT = 1


class Refused(Exception):
    """One sentence on a file that cannot be used."""


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            content = json.load(file)
    except (OSError, ValueError) as error:
        raise Refused(f"{path}: cannot be read ({error}); make one with --store") from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise Refused(f"{path}: is not a file of format {FORMAT}; make one with --store")
    entries = content["entries"]
    for entry in entries[1:]:
        entry["cases"] = {case: completed(found, entries[0]["cases"].get(case, {})) for case, found in entry["cases"].items()}
    return entries


def completed(found, first):
    return {name: record for name, record in {**first, **found}.items() if record is not None}


def reduced(found, first):
    """The short form that completed() expands."""
    return {name: found.get(name) for name in found.keys() | first.keys() if found.get(name) != first.get(name)}


def entry_for(entries, key):
    """The entry of this instruction set: that of the same libraries if there is one. None without any."""
    same = [entry for entry in entries if all(entry["key"][name] == key[name] for name in ("instructions", "forced"))]
    return next((entry for entry in same if entry["key"]["libraries"] == key["libraries"]), same[0] if same else None)


def write(path, key, cases):
    """Puts the results of these cases into the file; other cases of the same key and other keys stay. cases: {name: {artefact: record}}."""
    entries = read(path) if os.path.exists(path) else []
    entry = next((entry for entry in entries if entry["key"] == key), None)
    if entry is None:
        entry = {"key": key, "cases": {}}
        entries.append(entry)
    entry["cases"] = dict(sorted({**entry["cases"], **cases}.items()))
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write(text_of(entries))
    os.replace(path + ".part", path)


def text_of(entries):
    """JSON with one line for each artefact, so that a change of the file shows what changed."""
    lines = ['{"format": %d, "entries": [' % FORMAT]
    for number, entry in enumerate(entries):
        first = entries[0]["cases"] if number else {}
        lines.append(' {"key": ' + json.dumps(entry["key"], sort_keys=True) + ',\n  "cases": {')
        for index, (case, found) in enumerate(entry["cases"].items()):
            rows = ",\n".join(f"    {json.dumps(name)}: {json.dumps(record)}" for name, record in sorted(reduced(found, first.get(case, {})).items()))
            lines.append(f"   {json.dumps(case)}: {{\n{rows}}}" + ("," if index + 1 < len(entry["cases"]) else ""))
        lines.append("  }}" + ("," if number + 1 < len(entries) else ""))
    return "\n".join([*lines, "]}"]) + "\n"
