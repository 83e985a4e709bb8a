"""The files that a scene needs on another host: the scene, and the files that it names, directly or by other files, below its folder and below
the folders that the user allows it besides (scene_folders of launch/arguments.py).

Only files of known kinds are found, so that a scene in a home folder never sends other files of the user: every text of the scene that is
the path of such a file counts as a name. Hidden files, links out of the folders and special files are never sent.
"""
import json
import os
import pathlib
import re
import stat
import struct
import xml.parsers.expat

from tactus.refusal import Refusal

NAMING = {".sdf", ".world", ".xml", ".config", ".dae", ".gltf", ".glb", ".obj", ".mtl"}  # kinds that name further files
KINDS = NAMING | {".stl", ".ply", ".3ds", ".off", ".bin", ".png", ".jpg", ".jpeg", ".bmp", ".tga", ".csv", ".json", ".frag", ".vert", ".glsl", ".wav", ".flac",
                  ".sofa"}
FOLDER_NAMES = ("model.config", "model.sdf")  # of a folder that <include> names
MAX_FILES = 10_000
LARGEST_TEXT_BYTES = 128 << 20  # as of a geometry file: docs/scene_format.md
GLB_MAGIC, JSON_CHUNK = 0x46546C67, 0x4E4F534A  # glTF 2.0, binary file format
WORDS = re.compile(r"[^\s,;|]+")


def base_of(folders):
    """The folder to which the sent paths are relative, so that the folders keep their places relative to each other."""
    return pathlib.Path(os.path.commonpath(folders)) if folders else pathlib.Path("/")


def files_of(scene, folders=None, elsewhere=False):
    """{path relative to base_of(folders): path} of the scene and all files that it names. folders: those that the scene may read; default: its
    own. elsewhere: the scene itself, and the files of its folder, are on the hosts already. Raises Refusal when there are too many."""
    folders = [scene.parent] if folders is None else folders
    base = base_of(folders)
    readable = [scene.parent, *folders] if elsewhere else folders
    found, seen, waiting = {}, set(), [scene]
    while waiting:
        path = waiting.pop()
        if path in seen:
            continue
        seen.add(path)
        if any(folder in path.parents for folder in folders):
            found[str(path.relative_to(base))] = path
        if len(seen) > MAX_FILES:
            raise Refusal(f"sim_node: the scene {scene} names more than {MAX_FILES} files, which is too much to copy to every host; name fewer")
        if path == scene or path.suffix.lower() in NAMING:
            waiting += [file for text in texts_of(path) for file in named_by(text, path, readable)]
    return found


def named_by(text, path, folders):
    """Files below the folders that a text within the file `path` names; nothing when it names none."""
    for word in dict.fromkeys((text.strip(), *WORDS.findall(text))):
        plain = word.removeprefix("file://").removeprefix("model://")
        plain = plain.rpartition(":")[2]  # playback:FILE
        is_file, is_folder = pathlib.PurePosixPath(plain).suffix.lower() in KINDS, word.startswith(("file://", "model://"))
        if not (is_file or is_folder) or len(plain) > 1000 or "\0" in plain:
            continue
        for base in dict.fromkeys((path.parent, path.parent / "models", *(base for folder in folders for base in (folder, folder / "models")))):
            for name in ([plain] if is_file else [f"{plain}/{name}" for name in FOLDER_NAMES]):
                if (file := next(filter(None, (allowed(base / name, folder) for folder in folders)), None)) is not None:
                    yield file


def allowed(path, folder):
    """The path without .., when it is a visible regular file of a known kind below the folder; None otherwise."""
    path = pathlib.Path(os.path.normpath(path))
    try:
        parts = path.relative_to(folder).parts
        inside = os.path.realpath(path).startswith(os.path.realpath(folder) + os.sep)
        regular = stat.S_ISREG(os.stat(path).st_mode)
    except (OSError, ValueError):
        return None
    visible = not any(part.startswith(".") for part in parts)
    return path if inside and regular and visible and path.suffix.lower() in KINDS else None


def texts_of(path):
    """Texts in a file that may name other files; [] when it cannot be read. sim_node reports the faults of a scene."""
    try:
        if path.stat().st_size > LARGEST_TEXT_BYTES:
            return []
        data = path.read_bytes()
    except OSError:
        return []
    kind = path.suffix.lower()
    if kind in (".obj", ".mtl"):
        return [line.partition(" ")[2] for line in data.decode("utf-8", "replace").splitlines() if line.startswith(("mtllib", "map_", "bump", "disp", "norm", "refl"))]
    if kind in (".gltf", ".glb"):
        return list(texts_of_json(json_of(data, kind)))
    return texts_of_xml(data)


def json_of(data, kind):
    """The JSON of a glTF file; None when it is not valid."""
    try:
        if kind == ".glb":
            magic, _, _, size, chunk = struct.unpack_from("<5I", data)
            data = data[20:20 + size] if (magic, chunk) == (GLB_MAGIC, JSON_CHUNK) else b""
        return json.loads(data)
    except (ValueError, struct.error, RecursionError):
        return None


def texts_of_json(value):
    waiting = [value]
    while waiting:
        value = waiting.pop()
        if isinstance(value, str) and len(value) < 1000:
            yield value
        elif isinstance(value, (dict, list)):
            waiting += value.values() if isinstance(value, dict) else value


def texts_of_xml(data):
    """Attributes and short texts of an XML file, up to its first fault."""
    found, parser = [], xml.parsers.expat.ParserCreate()
    parser.buffer_text = True
    parser.StartElementHandler = lambda _, attributes: found.extend(attributes.values())
    parser.CharacterDataHandler = lambda text: found.append(text) if len(text) < 1000 else None
    try:
        parser.Parse(data, True)
    except (xml.parsers.expat.ExpatError, LookupError, ValueError):
        pass
    return found
