"""The files that a host needs to run any node: programs, sounds, scenes, rooms of one build, identified by a hash."""
import hashlib
import io
import os
import pathlib
import subprocess
import tarfile
import tempfile

from tactus.cluster import scene_files, sites
from tactus.paths import BIN, ROOMS, SCENES, SCRIPTS, remedy
from tactus.refusal import Refusal

PROGRAMS = ("sim_node", "haptic_node", "audio_node", "visual_node", "thermal_node", "sync_node", "recorder", "replay", "watch", "spy", "degrade",
            "playout", "set", "message_types", "probe_pairs", "relay",
            "read_geometry", "read_pictures", "read_sounds")
FOLDERS = {"share/scenes": SCENES, "share/rooms": ROOMS, "share/relays": sites.SHIPPED}
LEFT_OUT = {".py", ".md"}
# Files that `tactus doctor` imports besides its own package.
DOCTOR = ("__init__.py", "option_parser.py", "own_files.py", "paths.py", "refusal.py", "signals.py", "environment.py", "terminal.py", "commands/__init__.py", "commands/dispatch.py", "commands/common_options.py", "commands/table.py", "launch/__init__.py", "launch/equipment.py", "launch/sound_server.py", "launch/network.py")
LARGEST_SCENE_BYTES = 500_000_000


def parts():
    """{path on the host: local path} of all files. Raises Refusal."""
    found = {f"bin/{name}": BIN / name for name in PROGRAMS}
    found |= {f"bin/{path.name}": path for path in (*BIN.glob("lib*.so"), *BIN.glob("read_*"))}  # read_*: confined readers of foreign formats
    found |= {f"bin/sounds/{path.relative_to(BIN / 'sounds')}": path for path in sorted((BIN / "sounds").rglob("*")) if path.is_file()}
    for there, here in FOLDERS.items():
        found |= {f"{there}/{path.relative_to(here)}": path for path in sorted(here.rglob("*")) if path.is_file() and path.suffix not in LEFT_OUT}
    package = SCRIPTS / "python" / "tactus"
    for path in (SCRIPTS / "tactus", SCRIPTS / "removed_variables.txt", *(package / name for name in DOCTOR), *(package / "doctor").glob("*.py")):
        found[f"share/scripts/{path.relative_to(SCRIPTS)}"] = path
    found["share/inside"] = package / "launch" / "inside"
    for name, path in found.items():
        if not path.is_file():
            raise Refusal(f"{path.name}: {path} is missing; {remedy('--programs')}")
    return found


def identity(files):
    """Identity of a build: a hash of its files."""
    total = hashlib.sha256()
    for there, here in sorted(files.items()):
        total.update(there.encode() + b"\0" + hashlib.sha256(here.read_bytes()).digest())
    return total.hexdigest()[:16]


def messages():
    """The message types of this build, as printed by message_types."""
    return subprocess.run([BIN / "message_types"], capture_output=True, text=True, check=True).stdout


def packed(files):
    """The files as one compressed tar, programs without debug information."""
    into = io.BytesIO()
    with tarfile.open(fileobj=into, mode="w:gz", compresslevel=1) as tar:
        for there, here in sorted(files.items()):
            data, mode = stripped(here), 0o755 if os.access(here, os.X_OK) else 0o644
            entry = tarfile.TarInfo(there)
            entry.size, entry.mode = len(data), mode
            tar.addfile(entry, io.BytesIO(data))
    return into.getvalue()


def stripped(path):
    whole = path.read_bytes()
    if whole[:4] != b"\x7fELF":
        return whole
    with tempfile.NamedTemporaryFile() as small:
        done = subprocess.run(["strip", "--strip-all", "-o", small.name, str(path)], capture_output=True, check=False)
        return pathlib.Path(small.name).read_bytes() if done.returncode == 0 else whole


def run_files(cluster):
    """(tar of the files of this run, {local path: path on the host}): a scene with the files that it names, the profile, a room, relay rules. Raises Refusal."""
    into, there = io.BytesIO(), {}
    with tarfile.open(fileobj=into, mode="w:gz", compresslevel=1, dereference=True) as tar:
        scene = cluster.plan.scene
        for folder, here in FOLDERS.items():
            there[str(here)] = f"@BUILD@/{folder}"
        shipped = FOLDERS["share/scenes"] in scene.parents  # it is part of the build
        if not shipped or cluster.plan.scene_folders:
            folders = [folder for folder in (*([] if shipped else [scene.parent]), *cluster.plan.scene_folders)
                       if FOLDERS["share/scenes"] not in (folder, *folder.parents)]
            found = scene_files.files_of(scene, folders, shipped)
            size = sum(path.stat().st_size for path in found.values())
            if size > LARGEST_SCENE_BYTES:
                raise Refusal(f"sim_node: the files of the scene {scene} hold {size // 1_000_000} MB, which is too much to copy to every host; use smaller ones")
            for name, path in sorted(found.items()):
                tar.add(path, f"scene/{name}", recursive=False)
            base = scene_files.base_of(folders)
            for folder in folders:
                if any(folder in path.parents for path in found.values()):
                    there[str(folder)] = str(pathlib.PurePosixPath("@FILES@/scene", folder.relative_to(base)))
        rules = cluster.relays.rules if cluster.relays and sites.SHIPPED not in cluster.relays.rules.parents else None
        for name, path in (("profile.xml", cluster.plan.degrade), ("room.csv", cluster.plan.room if os.sep in cluster.plan.room else None), ("relay.xml", rules)):
            if path:
                tar.add(path, name, recursive=False)
                there[str(path)] = f"@FILES@/{name}"
    return into.getvalue(), there
