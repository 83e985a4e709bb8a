#!/usr/bin/env python3
"""Checks who includes whom, and the size and tidiness of files, over the source tree.

  check_layers.py [ROOT]      prints every offence as FILE:LINE: what; exits 1 when there is one

The rules are those of the design: a node folder includes itself, sync/ and lcmtypes/; sync/ includes lcmtypes/; external
libraries stay in few files.
"""
import os
import re
import sys

NODES = ["sim_node", "haptic_node", "audio_node", "visual_node", "thermal_node"]
MAY_INCLUDE = {"lcmtypes": {"lcmtypes"}, "sync": {"sync", "lcmtypes"}}
MAY_INCLUDE.update({node: {node, "sync", "lcmtypes"} for node in NODES})

# External headers and the places where they may appear.
QUARANTINE = [
    (r"lcm/", r"(sync/(bus|recorder|log|replay)[a-z_]*\.(h|cpp)|examples/)", "LCM is used in the bus and recorder files of sync/ only"),
    (r"(ode|ccd|fcl)/", r"sim_node/(collision|behaviour)/", "ODE, libccd and FCL are used in sim_node/collision and behaviour only"),
    (r"(EGL|GL|GLES\d|epoxy|gbm|X11)(/|\.h)", r"visual_node/(egl|gl|scene_view|frame|window)/",
     "EGL and GL are used in the drawing folders of visual_node only"),
    (r"EGL/|epoxy/egl", r"visual_node/egl/", "EGL is used in visual_node/egl only"),
    (r"(sdf|gz|ignition)/", r"sim_node/scene/", "libsdformat is used in sim_node/scene only"),
    (r"assimp/", r"sim_node/scene/", "assimp is used in sim_node/scene only"),
    (r"(portaudio|alsa)", r"audio_node/(device|vcard)/", "PortAudio and ALSA are used in audio_node/device and vcard only"),
]
MOST_LINES = 400
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


def lines_before(lines, at):
    return "\n".join(lines).count("\n", 0, at)


def offences(root):
    for inside, path in source_files(root):
        with open(path, encoding="utf-8") as file:
            lines = file.read().splitlines()
        if len(lines) > MOST_LINES:
            yield f"{inside}:{len(lines)}: longer than {MOST_LINES} lines; split it along its joints"
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


def main():
    if sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__)
        return 0
    root = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    found = list(offences(os.path.abspath(root)))
    print("\n".join(found) if found else "layers: clean")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
