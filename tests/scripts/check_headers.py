#!/usr/bin/python3 -I
"""Compiles headers by themselves, and names those that need another header before them.

  check_headers.py [--build DIR] [--root DIR] [--all] [HEADER ...]

Without HEADER it compiles every header that no source file includes first: the presets without precompiled headers and groups of files
(release, asan, tsan) show the faults of the others. Needs a configured build. Exit status 1: a header does not compile.
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import argparse
import concurrent.futures
import json
import pathlib
import re
import shlex
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED_FOLDERS = {"build", "out", "node_modules", ".git"}


def sources(root):
    """Paths of all headers and source files below the root, relative to it."""
    for folder, folders, files in os.walk(root):
        folders[:] = [name for name in folders if name not in SKIPPED_FOLDERS]
        yield from (os.path.relpath(os.path.join(folder, name), root) for name in files if name.endswith((".h", ".cpp")))


def without_first_include(root):
    """The headers that no source file includes before all others."""
    paths = sorted(sources(root))
    first = set()
    for path in paths:
        if path.endswith(".cpp"):
            found = re.search(r'^#include "([^"]+)"', pathlib.Path(root, path).read_text(encoding="utf-8").split("#include <")[0], re.M)
            first.update(found.groups() if found else ())
    return [path for path in paths if path.endswith(".h") and path not in first]


def include_options(build):
    """The compiler and the folders of headers of all targets of a build."""
    try:
        entries = json.loads(pathlib.Path(build, "compile_commands.json").read_text(encoding="utf-8"))
    except OSError as error:
        sys.exit(f"check_headers: cannot read {error.filename}; configure first: scripts/build")
    compiler, folders = None, {}
    for entry in entries:
        words = shlex.split(entry["command"])
        if not entry["file"].endswith(".cpp"):
            continue
        compiler = compiler or next(word for word in words if re.search(r"(g\+\+|c\+\+|clang\+\+)[-\d.]*$", word))
        for word, following in zip(words, words[1:]):
            if word == "-isystem":
                folders[f"-isystem{following}"] = None
            elif word.startswith("-I"):
                folders[word] = None
    return [compiler, "-std=c++20", *folders]


def fault_of(header, command, root):
    """The first error of a header that is compiled alone; empty: it compiles."""
    result = subprocess.run([*command, f"-I{root}", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-x", "c++", "-"],
                            input=f'#include "{header}"\n', capture_output=True, text=True, check=False)
    return "" if result.returncode == 0 else next((line for line in result.stderr.splitlines() if "error:" in line), result.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("headers", nargs="*", metavar="HEADER", help="path of a header, relative to the root")
    parser.add_argument("--build", default=ROOT / "build" / "dev", help="a configured build; default: build/dev")
    parser.add_argument("--root", default=ROOT, help="folder of the sources; default: this clone")
    parser.add_argument("--all", action="store_true", help="every header")
    options = parser.parse_args()
    command = include_options(options.build)
    headers = options.headers or ([p for p in sorted(sources(options.root)) if p.endswith(".h")] if options.all else without_first_include(options.root))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        faults = list(pool.map(lambda header: fault_of(header, command, options.root), headers))
    for header, fault in zip(headers, faults):
        if fault:
            print(f"{header} does not compile alone; add the headers that it uses: {fault}")
    print(f"headers: {sum(map(bool, faults))} of {len(headers)} do not compile alone")
    return any(faults)


if __name__ == "__main__":
    sys.exit(main())
