#!/usr/bin/python3 -I
"""Checks comments, documentation, help texts and messages for constructions that the glossary refuses, and code for old names.

  check_prose.py [OPTIONS] [PATH...]

Prints each offence as FILE:LINE: rule: "text": fault; replacement. Exits 1 when there is one. PATH limits the check
to files or folders; default: the whole tree.

  --summary      prints counts per folder and per rule instead of each offence
  --rules        prints the rules
  --root FOLDER  the source tree; default: the one that holds this script
  --help         this text

Checked text: comments and string literals of three words or more in C++, Python, shell, CMake, TypeScript and GLSL; comments of
.lcm files; Markdown and HTML without code; the columns meaning and source of settings.csv. Old names are searched in C++, Python, TypeScript and
.lcm code. docs/glossary.md describes the language; prose_exceptions.txt lists files that a rule does not apply to.
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])
sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))

import argparse
import collections
import functools
import re

from prose_rules import FILES, FOLDERS, NAME_PATTERNS, NAMES, NEEDS, RULES
from prose_texts import C_LIKE, code, line_counter, texts

SKIPPED = {"build", "out", ".git", "__pycache__", "shared", "node_modules", "dist", "seeds"}
SENTENCE_END = re.compile(r"[.;:!?](?=\s)")


def compiled(pattern):
    """A space in a pattern stands for white space of any length, except inside a character class."""
    out, depth = [], 0
    for i, c in enumerate(pattern):
        if c == "[" and (i == 0 or pattern[i - 1] != "\\"):
            depth += 1
        elif c == "]" and (i == 0 or pattern[i - 1] != "\\"):
            depth -= 1
        out.append(r"\s+" if c == " " and not depth else c)
    return re.compile("".join(out), re.I)


Rule = collections.namedtuple("Rule", "name pattern wrong write unless_before needs")
Offence = collections.namedtuple("Offence", "path line rule text wrong write")


def make_rules():
    for name, pattern, wrong, write, *options in RULES:
        option = options[0] if options else {}
        before = option.get("unless_before")
        yield Rule(name, compiled(pattern), wrong, write, re.compile(before, re.I) if before else None, NEEDS.get(name, "").split())


COMPILED = list(make_rules())


def sentence_before(content, at):
    before = content[max(0, at - 90):at]
    ends = [m.end() for m in SENTENCE_END.finditer(before)]
    return before[ends[-1] if ends else 0:].rstrip()


def prose_offences(path, source):
    for text in texts(path, source):
        content = text.text()
        lowered = content.lower()
        for rule in COMPILED:
            if rule.needs and not any(need in lowered for need in rule.needs):
                continue
            for match in rule.pattern.finditer(content):
                if rule.unless_before and rule.unless_before.search(sentence_before(content, match.start())):
                    continue
                at = match.start() + len(match.group()) - len(match.group().lstrip())
                yield Offence(path, text.line(at), rule.name, " ".join(match.group().split()), rule.wrong, rule.write)


IDENTIFIER = re.compile(r"[A-Za-z_]\w*")
NAME_FORMS = [(re.compile(pattern), new) for pattern, new in NAME_PATTERNS]


@functools.lru_cache(maxsize=None)
def new_names(name):
    """[(new name, prefix of the paths where the old one is refused)]"""
    found = [(new, where) for old, new, where in NAMES if old == name]
    return found or [(new, "") for form, new in NAME_FORMS if form.fullmatch(name)][:1]


def name_offences(path, source):
    stripped = code(path, source)
    refused = {n: new for n in set(IDENTIFIER.findall(stripped)) for new, where in new_names(n) if path.startswith((where, "tests/" + where))}
    if not refused:
        return
    line_at = line_counter(stripped)
    for match in re.finditer(r"\b(?:" + "|".join(refused) + r")\b", stripped):
        if match.group() == "tell" and re.match(r"\(\s*\)", stripped[match.end():]) and path.endswith(".py"):
            continue  # the position of a file object
        yield Offence(path, line_at(match.start()), "name", match.group(), "an old name", refused[match.group()])


def path_offences(paths):
    seen = set()
    for path in paths:
        for folder, new in FOLDERS.items():
            if path.startswith(folder + "/") and folder not in seen:
                seen.add(folder)
                yield Offence(folder, 1, "path", os.path.basename(folder), "an old name of a folder", new)
        if path in FILES:
            yield Offence(path, 1, "path", os.path.basename(path), "an old name of a file", FILES[path])


def source_files(root):
    for folder, folders, files in os.walk(root):
        folders[:] = sorted(f for f in folders if f not in SKIPPED and not f.startswith("."))
        for name in sorted(files):
            path = os.path.join(folder, name)
            if "." in name and not name.endswith(C_LIKE + (".md", ".html", ".py", ".sh", ".cmake")) and name not in ("CMakeLists.txt", "settings.csv"):
                continue
            if "." not in name and not os.access(path, os.X_OK):
                continue
            yield os.path.relpath(path, root)


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except UnicodeDecodeError:
        return ""


def exceptions(file):
    """{path: rules or {"*"}} from lines "path | rules | reason"."""
    found = {}
    for number, line in enumerate(read(file).splitlines() if os.path.exists(file) else (), start=1):
        if not line.strip() or line.startswith("#"):
            continue
        fields = [f.strip() for f in line.split("|")]
        if len(fields) != 3 or not all(fields):
            sys.exit(f"{file}:{number}: needs three fields, path | rules or * | reason")
        found.setdefault(fields[0], set()).update(fields[1].split())
    return found


def offences(root, limits=(), excepted=None):
    """All offences below root; of the paths that begin with one of `limits`, relative to root, where there are any."""
    paths = [p for p in source_files(root) if not limits or any(p == l or p.startswith(l.rstrip("/") + "/") or l == "." for l in limits)]

    def stands(offence):
        rules = (excepted or {}).get(offence.path, ())
        return "*" not in rules and offence.rule not in rules
    for path in paths:
        source = read(os.path.join(root, path))
        yield from filter(stands, sorted({*prose_offences(path, source), *name_offences(path, source)}, key=lambda o: (o.line, o.rule, o.text)))
    yield from filter(stands, path_offences(paths))


def folder_of(path):
    parts = path.split("/")
    return "/".join(parts[:-1][:2]) if len(parts) > 1 else "."


def print_summary(found):
    for title, key in (("folder", lambda o: folder_of(o.path)), ("top folder", lambda o: o.path.split("/")[0] if "/" in o.path else "."),
                       ("rule", lambda o: o.rule)):
        counts = collections.Counter(map(key, found))
        print(f"\n{title}")
        for name, count in sorted(counts.items(), key=lambda i: (-i[1], i[0])):
            print(f"  {count:6}  {name}")
    print(f"\n{len(found)} offences in {len({o.path for o in found})} files")


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    parser = argparse.ArgumentParser(add_help=False, usage=__doc__)
    parser.add_argument("paths", nargs="*")
    parser.add_argument("--summary", action="store_true")
    parser.add_argument("--rules", action="store_true")
    parser.add_argument("--root", default=os.path.join(here, "..", ".."))
    parser.add_argument("--help", "-h", action="store_true")
    arguments = parser.parse_args()
    if arguments.help:
        print(__doc__)
        return 0
    if arguments.rules:
        for rule in COMPILED:
            print(f"{rule.name}: {rule.wrong}; write {rule.write}")
        print("name, path: an old name; write the new one (prose_rules.py lists them)")
        return 0
    root = os.path.abspath(arguments.root)
    limits = []
    for path in arguments.paths:
        full = os.path.abspath(path) if os.path.exists(path) else os.path.join(root, path)
        if not os.path.exists(full):
            print(f"check_prose: there is no {path}; name files or folders of {root}", file=sys.stderr)
            return 2
        limits.append(os.path.relpath(full, root))
    found = list(offences(root, limits, exceptions(os.path.join(here, "prose_exceptions.txt"))))
    if arguments.summary:
        print_summary(found)
    else:
        for o in found:
            text = o.text if len(o.text) <= 60 else o.text[:57] + "..."
            print(f'{o.path}:{o.line}: {o.rule}: "{text}": {o.wrong}; write {o.write}')
    if not found:
        print("prose: clean")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
