"""Joins small groups of source files into larger ones, each of which is compiled as one file (cmake/Unity.cmake).

Reads "group;file" lines from standard input and prints them with joined groups. A group has at most LARGEST files. No file declares a name that another
one declares, or that headers of another one declare: the compiler would confuse them. Groups are joined in order, so a new file of a
folder changes few others.
"""
import functools
import pathlib
import re
import sys

from check_local_names import local_names

ROOT = pathlib.Path(__file__).resolve().parents[2]
LARGEST = 12  # files; a larger group saves little more, and one edit then compiles more
ENUM = re.compile(r"\benum\s+(?!class\b|struct\b)[^{;]*\{([^}]*)\}")
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)


def enumerators(source):
    """Names of the values of unscoped enumerations."""
    return {name for inside in ENUM.findall(source) for name in re.findall(r"(\w+)\s*(?:=[^,]*)?(?:,|$)", inside)}


@functools.cache
def header(path):
    """(names declared outside of functions and classes, included headers) of a header of the project."""
    file = ROOT / path
    source = file.read_text(encoding="utf-8") if file.is_file() else ""
    return {name for _, name, _, _ in local_names(source)} | enumerators(source), INCLUDE.findall(source)


def names_of_headers(source):
    """Names that the headers declare which a source includes, directly or not."""
    found, seen, left = set(), set(), INCLUDE.findall(source)
    while left:
        path = left.pop()
        if path not in seen:
            seen.add(path)
            names, included = header(path)
            found |= names
            left += included
    return found


class Names:
    """Names that files, and headers that they include, declare outside of functions and classes."""

    def __init__(self, source=""):
        self.headers = names_of_headers(source)
        # `using a::b` names the same thing in every file, an equal alias may stand in several, and a function that a header declares is defined once.
        self.declared = {(name, kind if kind.startswith("alias") else "") for _, name, kind, local in local_names(source)
                         if not (kind.startswith("using") or name in self.headers and (kind.startswith("function") or not local))}
        self.declared |= {(name, "") for name in enumerators(source)}

    def add(self, other):
        self.declared |= other.declared
        self.headers |= other.headers

    def fits(self, other):
        mine, theirs = ({name for name, _ in names.declared} for names in (self, other))
        unequal = {name for name, kind in self.declared ^ other.declared} | {name for name, kind in self.declared if not kind}
        return not (mine & theirs & unequal or mine & other.headers or theirs & self.headers)


def without_clashes(groups, names):
    """The groups {name: files}; a file that does not fit its neighbours is a group of its own."""
    found = {}
    for group, files in groups.items():
        together = Names()
        for file in files:
            alone = not together.fits(names[file])
            found.setdefault(f"{group}_{len(found)}" if alone else group, []).append(file)
            if not alone:
                together.add(names[file])
    return found


def joined(groups, names):
    """{name: files} of {name: files}; names: the Names of each file."""
    found, of_group = {}, {}
    for group, files in without_clashes(groups, names).items():
        mine = Names()
        for file in files:
            mine.add(names[file])
        first = next((g for g in found if len(found[g]) + len(files) <= LARGEST and of_group[g].fits(mine)), group)
        found.setdefault(first, []).extend(files)
        of_group.setdefault(first, Names()).add(mine)
    return found


def main():
    groups, names = {}, {}
    for line in sys.stdin.read().splitlines():
        group, file = line.split(";", 1)
        groups.setdefault(group, []).append(file)
        names[file] = Names(pathlib.Path(file).read_text(encoding="utf-8"))
    for group, files in joined(groups, names).items():
        for file in files:
            print(f"{group};{file}")


if __name__ == "__main__":
    main()
