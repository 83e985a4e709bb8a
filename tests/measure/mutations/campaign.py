"""A seeded sequence of changed worlds, meshes and logs, and its results."""
import dataclasses
import json
import pathlib
import random
import shutil
import tempfile

from tactus.paths import BIN, REPOSITORY

from . import logs, meshes, oracle, worlds

SCENES = REPOSITORY / "sim_node" / "scenes"
# Shipped scenes that take at most a second of computing; peg_in_hole and friction_boundary have meshes.
WORLDS = ("metronome.sdf", "single_taps.sdf", "steel_then_oak.sdf", "box_tool.sdf", "yielding_board.sdf", "newtons_cradle.sdf", "bump_plane.sdf",
          "friction_boundary.sdf", "stack.sdf")
FAMILIES = {"world": worlds.KINDS, "mesh": meshes.KINDS, "log": logs.KINDS}
RENDERERS = ("audio_node", "haptic_node", "thermal_node")
LOG_OF = "metronome.sdf"
MESH_WORLD = """<?xml version="1.0"?>
<sdf version="1.9" xmlns:tactus="https://tactus.dev/sdf"><world name="w"><gravity>0 0 -9.81</gravity>
<model name="floor"><static>true</static><link name="l"><tactus:surface material="oak"/><collision name="c"><pose>0 0 -0.5 0 0 0</pose>
<geometry><box><size>4 4 1</size></box></geometry></collision></link></model>
<model name="body"><static>{static}</static><pose>0 0 0.15 0 0 0</pose><link name="l"><tactus:surface material="steel"/><collision name="c"><geometry><mesh>
<uri>{name}</uri></mesh></geometry></collision></link></model>
</world></sdf>
"""


@dataclasses.dataclass
class Case:
    """number: in the sequence; answer: refused, stops, runs or read; faults: violations, empty when all properties hold."""
    number: int
    family: str
    kind: str
    source: str
    answer: str = ""
    faults: tuple = ()


def plan(count, families=tuple(FAMILIES)):
    """The cases of a campaign: every kind of each family in turn."""
    kinds = [(family, kind) for i in range(max(len(FAMILIES[f]) for f in families)) for family in families for kind in FAMILIES[family][i:i + 1]]
    return [Case(number, *kinds[number % len(kinds)], "") for number in range(count)]


class Campaign:
    """Plays the cases of one seed. The folder holds the inputs that violate a property, as keep/NUMBER."""

    def __init__(self, seed, keep=None, bin_folder=BIN):
        self.seed, self.bin = seed, pathlib.Path(bin_folder)
        self.keep = pathlib.Path(keep) if keep else None
        self.recorded = None

    def play(self, case):
        """Fills answer and faults of the case. The same seed and number give the same input."""
        draw = random.Random(f"{self.seed} {case.number}")
        folder = pathlib.Path(tempfile.mkdtemp(prefix="tactus_mutation_"))
        try:
            case.answer, case.faults = {"world": self.play_world, "mesh": self.play_mesh, "log": self.play_log}[case.family](case, folder, draw)
            if case.faults and self.keep:
                self.keep_input(case, folder)
        finally:
            oracle.remove(folder)
        return case

    def play_world(self, case, folder, draw):
        case.source = draw.choice(WORLDS)
        # Beside the files that the scene names.
        for path in SCENES.iterdir():
            if path.suffix in (".obj", ".png", ".csv", ".mtl", ".frag"):
                shutil.copyfile(path, folder / path.name)
        scene = folder / "changed.sdf"
        scene.write_bytes(self.changed(worlds.mutated, (SCENES / case.source).read_bytes(), case.kind, draw))
        return oracle.world_faults(self.bin, scene, folder, [path.name for path in folder.iterdir() if path.is_file()], case.kind in worlds.NEVER_SILENT)

    @staticmethod
    def changed(mutated, text, kind, draw):
        """Draws again when a scene has nothing that this kind could change."""
        for _ in range(20):
            try:
                return mutated(text, kind, draw)
            except IndexError:
                continue
        return text

    def play_mesh(self, case, folder, draw):
        case.source = draw.choice(meshes.FORMATS)
        name = f"changed.{case.source}"
        (folder / name).write_bytes(meshes.mutated(case.kind, case.source, draw))
        scene = folder / "scene.sdf"
        static = draw.choice(("true", "false"))
        scene.write_text(MESH_WORLD.format(name=name, static=static), encoding="utf-8")
        # The mass of a body that moves is computed from the volume, which an open mesh does not have.
        return oracle.world_faults(self.bin, scene, folder, [name], case.kind in meshes.WITHOUT_VOLUME and static == "false")

    def play_log(self, case, folder, draw):
        if self.recorded is None:
            self.recorded = record(self.bin)
        case.source = LOG_OF
        log = folder / "changed.lcmlog"
        log.write_bytes(logs.mutated(self.recorded, case.kind, draw))
        return oracle.log_faults(self.bin, log, folder, [draw.choice(RENDERERS)])

    def keep_input(self, case, folder):
        kept = self.keep / f"{case.number}_{case.family}_{case.kind.replace(' ', '_')}"
        oracle.remove(kept)
        kept.mkdir(parents=True)
        for path in folder.glob("*"):
            if path.is_file() and (path.name.startswith(("changed", "scene"))):
                shutil.copyfile(path, kept / path.name)
        (kept / "faults.txt").write_text("\n".join((case.source, *case.faults)) + "\n", encoding="utf-8")


def record(bin_folder):
    """The bytes of a short log of a shipped scene, recorded in virtual time."""
    with tempfile.TemporaryDirectory() as place:
        out = pathlib.Path(place)
        plan_file = out / "plan.json"
        plan_file.write_text(json.dumps(oracle.plan_of(pathlib.Path(bin_folder), SCENES / LOG_OF, out)), encoding="utf-8")
        made = oracle.Answer([pathlib.Path(bin_folder) / "virtual_time", plan_file, "--seconds", "0.5", "--seed", "1"])
        if made.status != 0:
            raise AssertionError(f"no log of {LOG_OF}: {made.last()}")
        return (out / "run.lcmlog").read_bytes()
