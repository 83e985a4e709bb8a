#!/usr/bin/python3 -I
"""Checks the includes between folders, and the size and tidiness of folders and files, over the source tree.

  check_layers.py [ROOT]          prints every offence as FILE:LINE: what; exits 1 when there is one
  check_layers.py [ROOT] --graph  prints the includes between folders as they are, in the form of folder_graph.txt

A node folder includes itself, sync/ and lcmtypes/; sync/ includes lcmtypes/; external libraries stay in few files. The
allowed includes between folders are listed in folder_graph.txt beside this file. They form no cycle.
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import collections
import re

NODES = ["sim_node", "haptic_node", "audio_node", "visual_node", "thermal_node"]
MAY_INCLUDE = {"lcmtypes": {"lcmtypes"}, "sync": {"sync", "lcmtypes"}}
MAY_INCLUDE.update({node: {node, "sync", "lcmtypes"} for node in NODES})

# External headers and the places where they may appear.
QUARANTINE = [
    (r"lcm/", r"(sync/(bus|log|tools)/|examples/)", "LCM is used in sync/bus, sync/log and sync/tools only"),
    (r"CLI/", r"sync/text/", "CLI11 is used in sync/text only"),
    (r"(ode|ccd|fcl)/", r"sim_node/(collision|contacts|behaviour)/", "ODE, libccd and FCL are used in sim_node/collision, contacts and behaviour only"),
    (r"(EGL|GL|GLES\d|epoxy|gbm|X11)(/|\.h)", r"visual_node/(devices|gl|scene_view|frame)/",
     "EGL and GL are used in the drawing folders of visual_node only"),
    (r"EGL/|epoxy/egl", r"visual_node/devices/", "EGL is used in visual_node/devices only"),
    (r"(sdf|gz|ignition)/", r"tests/", "libsdformat is used in tests only"),
    (r"assimp/", r"sim_node/scene/", "assimp is used in sim_node/scene only"),
    (r"(pango|harfbuzz|fontconfig|ft2build)", r"visual_node/text/typeset/", "Pango and its fonts are used in visual_node/text/typeset only"),
    (r"(portaudio|alsa)", r"audio_node/devices/", "PortAudio and ALSA are used in audio_node/devices only"),
]
MAX_LINES = 400
MAX_FILES = 40  # directly inside a folder
GRAPH_FILE = "tests/scripts/folder_graph.txt"
GRAPH_OF = ("lcmtypes", "sync", *NODES)  # folders below these follow GRAPH_FILE; below others, any graph without a cycle does
SOURCES = (".h", ".cpp", ".c", ".lcm", ".py", ".cmake", ".glsl", ".vert", ".frag", ".sh")
SKIPPED = {"build", "out", ".git", "__pycache__", "shared", "node_modules", "dist"}
INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]')
# The name of a test, over the lines that it takes. CMake's lists split it at a semicolon, and its halves name no test.
TEST_NAME = re.compile(r'\bTEST_CASE\(\s*((?:"(?:[^"\\]|\\.)*"\s*)+)')
UNFINISHED = re.compile(r"\b(TO" r"DO|FIX" r"ME|X" r"XX|HA" r"CK)\b")


def source_files(root):
    for folder, folders, files in os.walk(root):
        folders[:] = sorted(f for f in folders if f not in SKIPPED and not f.startswith("."))
        for name in sorted(files):
            path = os.path.join(folder, name)
            inside = os.path.relpath(path, root)
            if name.endswith(SOURCES) or name == "CMakeLists.txt" or is_script(path, name):
                yield inside, path


def is_script(path, name):
    if "." in name or not os.access(path, os.X_OK):
        return False
    with open(path, "rb") as file:
        return file.read(2) == b"#!"


def offences_of_include(inside, kind, header):
    top = inside.split(os.sep)[0]
    if kind == '"' and top in MAY_INCLUDE:
        if header.split("/")[0] not in MAY_INCLUDE[top] or "/" not in header:
            yield f'{top}/ must not include "{header}"; it may include {", ".join(sorted(MAY_INCLUDE[top]))} by path from the root'
    if top == "tests":
        return
    for pattern, place, sentence in QUARANTINE:
        if re.match(pattern, header) and not re.match(place, inside):
            yield f"<{header}>: {sentence}"


def included_folder(root, kind, header):
    """The folder of a header of this tree, or None."""
    return os.path.dirname(header) if kind == '"' and "/" in header and os.path.isfile(os.path.join(root, header)) else None


def read_graph(root):
    """{folder: folders that it may include} of GRAPH_FILE."""
    graph = {}
    with open(os.path.join(root, GRAPH_FILE), encoding="utf-8") as file:
        for line in file:
            folder, _, allowed = line.split("#")[0].partition(":")
            if folder.strip():
                graph[folder.strip()] = set(allowed.split())
    return graph


def includes_between_folders(root):
    """{folder: {folder that it includes: first place}} of the C++ files."""
    edges = collections.defaultdict(dict)
    for inside, path in source_files(root):
        if not inside.endswith((".h", ".cpp", ".c")):
            continue
        here = os.path.dirname(inside)
        with open(path, encoding="utf-8") as file:
            for number, line in enumerate(file, start=1):
                match = INCLUDE.match(line)
                there = match and included_folder(root, *match.groups())
                if there and there != here:
                    edges[here].setdefault(there, f"{inside}:{number}")
    return edges


def a_cycle(edges):
    """Folders that include each other in a circle, the first also last; empty when there is none."""
    done, path = set(), []

    def visit(folder):
        if folder in path:
            return path[path.index(folder):] + [folder]
        if folder in done:
            return []
        path.append(folder)
        for there in sorted(edges.get(folder, ())):
            found = visit(there)
            if found:
                return found
        done.add(path.pop())
        return []

    for folder in sorted(edges):
        found = visit(folder)
        if found:
            return found
    return []


def offences_of_folders(root):
    edges = includes_between_folders(root)
    cycle = a_cycle(edges)
    if cycle:
        yield f"{edges[cycle[0]][cycle[1]]}: folders include each other: {' -> '.join(cycle)}"
    if os.path.isfile(os.path.join(root, GRAPH_FILE)):
        allowed = read_graph(root)
        for here in sorted(edges):
            if here.split("/")[0] not in GRAPH_OF:
                continue
            for there, place in sorted(edges[here].items()):
                if there not in allowed.get(here, ()):
                    yield f"{place}: {here} must not include {there}; move the code, or allow it in {GRAPH_FILE}"
    count = collections.Counter(os.path.dirname(inside) for inside, _ in tracked_files(root))
    for folder, files in sorted(count.items()):
        if files > MAX_FILES:
            yield f"{folder}:{files}: more than {MAX_FILES} files directly inside; make folders of them"


def tracked_files(root):
    for folder, folders, files in os.walk(root):
        folders[:] = sorted(f for f in folders if f not in SKIPPED and not f.startswith("."))
        for name in sorted(files):
            path = os.path.join(folder, name)
            inside = os.path.relpath(path, root)
            if not inside.startswith("tests/fuzz/seeds"):
                yield inside, path


def lines_before(lines, at):
    return "\n".join(lines).count("\n", 0, at)


def offences(root):
    for inside, path in source_files(root):
        with open(path, encoding="utf-8") as file:
            lines = file.read().splitlines()
        if len(lines) > MAX_LINES:
            yield f"{inside}:{len(lines)}: longer than {MAX_LINES} lines; split it along its joints"
        for name in TEST_NAME.finditer("\n".join(lines)):
            if ";" in name.group(1) and inside.endswith(".cpp"):
                yield f"{inside}:{lines_before(lines, name.start()) + 1}: a semicolon in the name of a test, which would never run; say it otherwise"
        for number, line in enumerate(lines, start=1):
            if UNFINISHED.search(line):
                yield f"{inside}:{number}: unfinished work marked in the source"
            match = INCLUDE.match(line)
            if match:
                for sentence in offences_of_include(inside, *match.groups()):
                    yield f"{inside}:{number}: {sentence}"


def print_graph(root):
    for folder, there in sorted(includes_between_folders(root).items()):
        if folder.split("/")[0] in GRAPH_OF:
            print(f"{folder}: {' '.join(sorted(there))}")


def main():
    if "-h" in sys.argv or "--help" in sys.argv:
        print(__doc__)
        return 0
    arguments = [a for a in sys.argv[1:] if a != "--graph"]
    root = arguments[0] if arguments else os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    if "--graph" in sys.argv:
        print_graph(os.path.abspath(root))
        return 0
    found = list(offences(os.path.abspath(root))) + list(offences_of_folders(os.path.abspath(root)))
    print("\n".join(found) if found else "layers: clean")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
