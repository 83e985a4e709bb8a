#!/usr/bin/env python3
"""Checks docs/safety.md and docs/security.md: every test that they name exists, and every limit has the value of its setting.

  check_safety_docs.py [ROOT]   prints every offence as FILE:LINE: what; exits 1 when there is one

Named tests: titles in double quotes and names in backticks (test_x, or the path of a file or folder below tests/) in an item that
begins with "Tests:", or in a table in a column with "test" in its title; paths below tests/ in backticks anywhere. Limits:
`NODE.SETTING` (VALUE UNIT), the default in NODE/settings.csv. Each section of docs/safety.md with a "Limit:" that is not "none" names
a test. A missing docs/security.md has nothing to check.
"""
import csv
import os
import re
import sys

DOCS = ("docs/safety.md", "docs/security.md")
TITLE = re.compile(r'"([^"\n]+)"')
CODE = re.compile(r"`([^`\n]+)`")
LIMIT = re.compile(r"`(\w+_node)\.(\w+)` \(([-+.\deE]+)(?: ([^)]*))?\)")
CPP_TEST = re.compile(r'\bTEST_CASE(?:_METHOD)?\(\s*(?:\w+,\s*)?((?:"(?:[^"\\]|\\.)*"\s*)+)')
CMAKE_TEST = re.compile(r'\badd_test\(NAME\s+(?:"([^"]+)"|(\w+))')
PYTHON_IN_CMAKE = re.compile(r'\btactus_python_test\(\w+\s+\w+\s+"([^"]+)"')
PYTHON_TEST = re.compile(r"^\s*(?:def|class)\s+(\w+)", re.M)


def joined(literals):
    return "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', literals)).replace('\\"', '"')


def tests_of(root):
    """(titles, names): titles of C++ and CMake tests; functions, classes and files of Python tests."""
    titles, names = set(), set()
    for folder, folders, files in os.walk(os.path.join(root, "tests")):
        folders[:] = [f for f in folders if not f.startswith((".", "__"))]
        for name in files:
            if not name.endswith((".cpp", ".h", ".txt", ".py")):
                continue
            with open(os.path.join(folder, name), encoding="utf-8") as file:
                text = file.read()
            titles.update(joined(m) for m in CPP_TEST.findall(text))
            titles.update(a or b for a, b in CMAKE_TEST.findall(text))
            titles.update(PYTHON_IN_CMAKE.findall(text))
            if name.endswith(".py"):
                names.update(PYTHON_TEST.findall(text))
            names.update((name, os.path.splitext(name)[0]))
    return titles, names


def settings_of(root, node):
    path = os.path.join(root, node, "settings.csv")
    if not os.path.exists(path):
        return {}
    with open(path, encoding="utf-8") as file:
        return {row["name"]: row for row in csv.DictReader(file)}


def naming(lines):
    """(number, text) of every part of the text that names tests; the items of "Tests:" with their continued lines are one part."""
    columns, item = None, None
    for number, line in enumerate(lines, 1):
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")] if line.lstrip().startswith("|") else None
        if cells is None:
            columns = None
        elif columns is None:
            columns = [i for i, cell in enumerate(cells) if "test" in cell.lower()]
        elif not set(line) <= set("|-: "):
            yield number, "  ".join(cells[i] for i in columns if i < len(cells))
        if re.match(r"\s*[-*] ", line) or not line.strip():
            item = None
        if re.match(r"\s*[-*] (\w+ and tests|tests):", line, re.I):
            item = number
        if item and cells is None:
            yield number, line


def offences_of(root, doc, tests):
    titles, names = tests
    with open(os.path.join(root, doc), encoding="utf-8") as file:
        lines = file.read().split("\n")
    found = []
    for number, text in naming(lines):
        found += [(number, f'there is no test "{t}"') for t in TITLE.findall(text) if t not in titles]
        found += [(number, f"there is no test {c}") for c in CODE.findall(text)
                  if re.match(r"test_\w+(\.py)?$|\w+_(test|check)(\.cpp)?$", c) and c not in names]
    for number, line in enumerate(lines, 1):
        found += [(number, f"there is no {c}") for c in CODE.findall(line)
                  if c.startswith("tests/") and not os.path.exists(os.path.join(root, c))]
        for node, name, value, unit in LIMIT.findall(line):
            row = settings_of(root, node).get(name)
            if row is None:
                found.append((number, f"there is no setting {node}.{name}"))
            elif float(row["default"]) != float(value) or unit and row["unit"] not in ("1", unit):
                found.append((number, f"{node}.{name} is {row['default']} {row['unit']} by default, not {value} {unit}".strip()))
    if doc == DOCS[0]:
        found += sections_without_a_test(lines)
    return [f"{doc}:{number}: {what}" for number, what in found]


def sections_without_a_test(lines):
    heads = [i for i, line in enumerate(lines) if line.startswith("## ")] + [len(lines)]
    for begin, end in zip(heads, heads[1:]):
        text = "\n".join(lines[begin:end])
        if "Limit: none" not in text and not (re.search(r"[Tt]ests:", text) and TITLE.search(text)):
            yield begin + 1, f"{lines[begin][3:]} names no test"


def offences(root):
    tests = tests_of(root)
    if not os.path.exists(os.path.join(root, DOCS[0])):
        return [f"{DOCS[0]}:1: is missing"]
    return [o for doc in DOCS if os.path.exists(os.path.join(root, doc)) for o in offences_of(root, doc, tests)]


def main():
    found = offences(sys.argv[1] if len(sys.argv) > 1 else ".")
    print("\n".join(found) if found else "safety documents: clean")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
