"""The command line of scripts/run, checked completely before anything starts."""
import argparse
import dataclasses
import os
import pathlib
import time
import xml.etree.ElementTree

from tactus import players
from tactus.launch import hands, scene, walls
from tactus.paths import SCENES, settings_table
from tactus.refusal import Refusal
from tactus.tables import read_rows

SENSES = ("haptic_node", "audio_node", "visual_node", "thermal_node")
PLAYER = "participant"  # name of its node, also in recordings
PLAYER_PROGRAM = "simulated_player"
PLAYERS = players.NAMES
PLAYER_CHECKS = ("require", "count", "skip")  # scripts/simulated_player/observer_admission.h
REMOVABLE = ("sim_node", *SENSES, "sync_node")
MIN_FREE_BYTES = 20_000_000  # about ten seconds of log and sound
FULL_BYTES = 65536  # a disk with less space has refused the last messages: the recorder writes blocks of this size
MAX_SECONDS = 86400  # one day; a longer log fills most disks
RECORDING = ("split_mb", "split_minutes", "keep", "max_mb")  # sync/tools/recorder/recorder_node.cpp
BUS_OPTIONS = {"latency-ms": 10_000, "jitter-ms": 10_000, "loss-percent": 100}  # maximum of each: scripts/virtual_time/virtual_time_main.cpp
SCENE_FOLDERS = "TACTUS_SCENE_FOLDERS"  # sim_node/scene/scene_folders.cpp
GAZEBO_FOLDERS = "GZ_SIM_RESOURCE_PATH"
PLAYOUT = ("policy", "aligner", "base", "budget", "soa")  # sync/playout/options.cpp


@dataclasses.dataclass
class Plan:
    """Configuration of one run. All paths are absolute."""
    scene: pathlib.Path
    shaders: pathlib.Path  # folder of the shaders of the scene, or None
    seconds: float
    out: pathlib.Path
    out_is_ours: bool  # --out was not given, so another name may be chosen
    without: list
    devices: dict  # of --device, by tool; "": the first tool
    hands: dict  # {process: tool} of the tools after the first
    room: str  # of --room; "": none
    walls: dict  # {process: wall} of all walls; visual_node draws the first
    degrade: pathlib.Path  # degradation profile, or None
    playout: list  # options of sync_node: playout policy
    window: bool
    listen: bool
    realtime: str
    seed: int
    network: str
    port: int
    settings: dict  # node: list of "name=value"
    scene_folders: list = dataclasses.field(default_factory=list)  # that the scene may read besides its own
    world: str = "sim_node"  # the process that publishes the simulation state: sim_node or replay
    replay: list = dataclasses.field(default_factory=list)  # command line of replay
    recorder: list = dataclasses.field(default_factory=list)  # options of the recorder: size of its files, tags
    live: int = None  # port of the live page; 0: any free port; None: no page
    programs: dict = dataclasses.field(default_factory=dict)  # of --program: {program: path of the one that replaces it}
    json: pathlib.Path = None  # of --json: a second place for summary.json
    player: str = ""  # the simulated player that holds the device of the first tool; "": none
    checks: str = "require"  # rule for a player of a population that fails a check: PLAYER_CHECKS
    virtual: list = None  # options of virtual_time; None: a live run in real time

    def nodes(self):
        """Names of the processes of this run, in start order."""
        return [n for n in ("recorder", "sync_node", *self.senses(), *self.players(), self.world) if n not in self.without]

    def players(self):
        """Names of the simulated players."""
        return [PLAYER] if self.player else []

    def senses(self):
        """Names of the processes of all modalities, including the left-out ones."""
        each = {hands.FIRST: self.hands, walls.FIRST: self.walls}
        return [name for sense in SENSES for name in dict.fromkeys((sense, *each.get(sense, ())))]

    def program(self, name):
        """Name of the program of a process."""
        if name == PLAYER:
            return PLAYER_PROGRAM
        return hands.FIRST if name in self.hands else walls.FIRST if name in self.walls else name


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refusal(f"{message}; see tactus run --help")


def parse(words, here):
    """Plan of a command line. here: the directory of the caller. Raises Refusal."""
    parser = Parser(add_help=False, allow_abbrev=False, prog="run")
    parser.add_argument("scene", nargs="?", default=str(SCENES / "dark_room.sdf"))
    parser.add_argument("--scene-folder", action="append", default=[])
    parser.add_argument("--seconds", default="20")
    parser.add_argument("--out")
    parser.add_argument("--json")
    parser.add_argument("--program", action="append", default=[])
    parser.add_argument("--without", action="append", default=[])
    parser.add_argument("--device", action="append", default=[])
    parser.add_argument("--room")
    parser.add_argument("--degrade")
    for option in PLAYOUT:
        parser.add_argument(f"--{option}")
    for option in RECORDING:
        parser.add_argument("--" + option.replace("_", "-"))
    parser.add_argument("--tags", action="append", default=[])
    parser.add_argument("--player", default="")
    parser.add_argument("--checks", choices=PLAYER_CHECKS, default=PLAYER_CHECKS[0])
    parser.add_argument("--virtual-time", action="store_true")
    for option in BUS_OPTIONS:
        parser.add_argument(f"--{option}")
    parser.add_argument("--window", action="store_true")
    parser.add_argument("--live")
    parser.add_argument("--listen", action="store_true")
    parser.add_argument("--realtime", choices=("require", "try", "off"), default="try")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--network", choices=("auto", "private", "host"), default="auto")
    parser.add_argument("--port", default="7667")
    parser.add_argument("--set", action="append", default=[])
    for word in words:
        if any(ord(c) < 32 or ord(c) == 127 for c in word):
            raise Refusal(f"argument {word!r}: contains a control character; remove it")
    a = parser.parse_args(with_player(with_live_port(words)))
    here = pathlib.Path(here)
    scene_path = scene_file(here, a.scene)
    tools = scene.tools(scene_path)
    others = hands.processes(tools)
    room, pictures = room_walls(here, a.room)
    several = {**others, **{process: wall for process, wall in pictures.items() if process != walls.FIRST}}
    for node in a.without:
        if node == "recorder":
            raise Refusal("--without recorder: the recorder cannot be left out, because all results come from its log; remove this option")
        if node not in (*REMOVABLE, *several):
            raise Refusal(f"--without {node}: there is no such node to leave out; choose from {', '.join((*REMOVABLE, *several))}")
    if hands.FIRST in a.without:  # all processes of touch
        others = {}
    if walls.FIRST in a.without:  # all processes of vision
        pictures = {}
    others = {process: tool for process, tool in others.items() if process not in a.without}
    pictures = {process: wall for process, wall in pictures.items() if process not in a.without}
    plan = Plan(scene=scene_path, scene_folders=scene_folders(here, a.scene_folder), shaders=scene.shader_folder(scene_path),
                seconds=number("--seconds", a.seconds, 1, MAX_SECONDS, "seconds"),
                out=out_folder(here, a.out), out_is_ours=not a.out, without=a.without,
                devices=devices(a.device, a.without, tools), hands=others, room=room, walls=pictures,
                degrade=profile(here, a.degrade), playout=playout(a),
                window=a.window, recorder=recording(a), live=live_port(a.live), listen=a.listen, realtime=a.realtime,
                seed=int(number("--seed", a.seed, 0, 2**63 - 1, "", whole=True)), network=a.network,
                port=int(number("--port", a.port, 1024, 65534, "", whole=True)), settings=settings(a.set, several), virtual=virtual(a), player=a.player, checks=a.checks,
                json=(here / a.json).absolute() if a.json else None, programs=programs(here, a.program))
    if plan.player and not is_player(plan.player):
        raise Refusal(f"--player={plan.player}: there is no such player; write {', '.join(PLAYERS)} or observer:NUMBER")
    if plan.player:
        if plan.devices or hands.FIRST in plan.without:
            raise Refusal("--player holds the device of the first tool itself; remove --device and --without haptic_node")
        plan.devices = {"": f"external:{PLAYER}"}
    if plan.programs and plan.virtual is not None:
        raise Refusal("--program and --virtual-time contradict each other: virtual time holds all nodes in one program; remove one")
    if plan.window and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise Refusal("visual_node: --window needs a display and neither DISPLAY nor WAYLAND_DISPLAY is set; remove "
                      "--window and watch video.mp4")
    return plan


def programs(here, words):
    """{program: absolute path of the one that replaces it} of --program. Raises Refusal."""
    found = {}
    for word in words:
        name, equals, path = word.partition("=")
        if name not in REMOVABLE or not path:
            raise Refusal(f"--program {word}: write it as NODE=PATH with one of {', '.join(REMOVABLE)}")
        found[name] = (here / path).absolute()
        if not found[name].is_file() or not os.access(found[name], os.X_OK):
            raise Refusal(f"{name}: --program {path} is not a program; name an executable file")
    return found


def with_player(words):
    """Inserts the default player after --player without the name of one."""
    return [part for word, following in zip(words, [*words[1:], ""])
            for part in ((word, PLAYERS[0]) if word == "--player" and not is_player(following) else (word,))]


is_player = players.is_player


def with_live_port(words):
    """Inserts the port 0, any free port, after --live without a number."""
    return [part for word, following in zip(words, [*words[1:], ""])
            for part in ((word, "0") if word == "--live" and not following.isdigit() else (word,))]


def live_port(text):
    return None if text is None else int(number("--live", text, 0, 65535, "", whole=True))


def number(option, text, least, most, unit, whole=False):
    try:
        value = int(text) if whole else float(text)
    except ValueError:
        value = None
    if value is None or not least <= value <= most:
        kind = "a whole number" if whole else "a number"
        raise Refusal(f"{option} {text}: give {kind} from {least} to {most} {unit}".rstrip())
    return value


def scene_file(here, text):
    path = here / text
    if not path.is_file() and not os.path.dirname(text) and (SCENES / text).is_file():
        path = SCENES / text
    if not path.is_file():
        names = ", ".join(sorted(p.name for p in SCENES.glob("*.sdf"))) or "none yet"
        raise Refusal(f"sim_node: the scene {text} is not a file; give the path of an SDF world (in {SCENES}: {names})")
    if not os.access(path, os.R_OK):
        raise Refusal(f"sim_node: the scene {text} cannot be read; change its permissions")
    return path.absolute()


def scene_folders(here, named):
    """Absolute paths of the folders that the scene may read besides its own: of --scene-folder, then of TACTUS_SCENE_FOLDERS, then those of
    GZ_SIM_RESOURCE_PATH that exist; a colon separates them. Every program that reads the scene receives them. Raises Refusal."""
    found = []
    for option, text in (*(("--scene-folder", text) for text in named), *(("TACTUS_SCENE_FOLDERS:", text) for text in os.environ.get(SCENE_FOLDERS, "").split(":"))):
        path = pathlib.Path(os.path.normpath(here / text))
        if not text and option == "TACTUS_SCENE_FOLDERS:":
            continue
        if not path.is_dir() or not os.access(path, os.R_OK | os.X_OK):
            raise Refusal(f"sim_node: {option} {text} is not a folder that can be read; name a folder of files of the scene")
        if path not in found:
            found.append(path)
    # The paths of a Gazebo installation, which name folders that other machines have.
    for text in filter(None, os.environ.get(GAZEBO_FOLDERS, "").split(":")):
        path = pathlib.Path(os.path.normpath(here / text))
        if path not in found and path.is_dir() and os.access(path, os.R_OK | os.X_OK):
            found.append(path)
    return found


def profile(here, text):
    """Absolute path of the profile, or None. The nodes check its content. Raises Refusal."""
    if text is None:
        return None
    path = here / text
    if not path.is_file() or not os.access(path, os.R_OK):
        raise Refusal(f"--degrade {text}: is not a file that can be read; give the path of a profile (XML)")
    return path.absolute()


def unknown_modalities(plan):
    """Modalities of the profile and of --soa that no node of this run renders: a user's own node may join later, or the name is misspelt."""
    named = {part.partition("=")[0] for word in plan.playout if word.startswith("--soa=") for part in word[len("--soa="):].split(",")}
    try:
        if plan.degrade is not None:
            named |= {rule.get("modality", "") for rule in xml.etree.ElementTree.parse(plan.degrade).getroot().iter("degrade")}
    except (xml.etree.ElementTree.ParseError, OSError):
        pass  # the nodes report the error with its line
    except (LookupError, ValueError):
        raise Refusal(f"--degrade {plan.degrade}: declares an encoding in which it cannot be read; save it as UTF-8") from None
    return sorted(named - {node.removesuffix("_node") for node in SENSES})


def room_walls(here, text):
    """(room, {process: wall}) of --room. Raises Refusal."""
    if text is None:
        return "", {}
    try:
        name, names = walls.room(here, text)
    except ValueError as error:
        raise Refusal(f"visual_node: {error}") from None
    return name, walls.processes(names)


def playout(a):
    """The options for sync_node, which checks their values. Raises Refusal."""
    words = [f"--{option}={value}" for option in PLAYOUT if (value := getattr(a, option)) is not None]
    if words and "sync_node" in a.without:
        raise Refusal(f"{words[0].partition('=')[0]} and --without sync_node contradict each other: sync_node applies the "
                      "playout policy; remove one")
    return words


def virtual(a):
    """The options for virtual_time; None: a live run. Raises Refusal."""
    given = {option: value for option in BUS_OPTIONS if (value := getattr(a, option.replace("-", "_"))) is not None}
    if not a.virtual_time:
        if given:
            raise Refusal(f"--{next(iter(given))} needs --virtual-time, because only the simulated bus has it; for a live run "
                          "use --degrade")
        return None
    for option, value in (("--window", a.window), ("--listen", a.listen), ("--live", a.live is not None), ("--room", a.room),
                          ("--realtime require", a.realtime == "require"), ("--network host", a.network == "host"),
                          ("--device external", any("external:" in device for device in a.device))):
        if value:
            raise Refusal(f"--virtual-time and {option} contradict each other: no program outside the run can keep up with virtual time; remove one")
    return [word for option, value in given.items()
            for word in (f"--{option}", f"{number(f'--{option}', value, 0, BUS_OPTIONS[option], ''):g}")]


def recording(a):
    """The options for the recorder. Raises Refusal."""
    bounds = {"split_mb": (1, 1e6), "split_minutes": (0.01, 1e5), "keep": (1, 100_000), "max_mb": (1, 1e7)}  # sync/tools/recorder/recorder_node.cpp
    given = {name: number("--" + name.replace("_", "-"), value, *bounds[name], "", whole=name == "keep")
             for name in RECORDING if (value := getattr(a, name)) is not None}
    splits = "split_mb" in given or "split_minutes" in given
    if "keep" in given and not splits:
        raise Refusal("--keep needs --split-mb or --split-minutes: it is the number of recording files to keep")
    if splits and given.get("max_mb", 1e9) < 2 * given.get("split_mb", 0):
        raise Refusal("--max-mb must be at least twice --split-mb, so that one complete file remains while the next is written")
    words = [word for name, value in given.items() for word in ("--" + name.replace("_", "-"), f"{value:g}")]
    return words + [word for pattern in a.tags for word in ("--tags", pattern)]


def out_folder(here, text):
    """Absolute path of the results folder, which is not created here. Raises Refusal."""
    path = here / text if text else here / "out" / time.strftime("%Y-%m-%d_%H-%M-%S")
    while not text and path.exists():
        path = path.with_name(path.name + "+")
    if path.exists() and not path.is_dir():
        raise Refusal(f"recorder: --out {path} is a file; name a folder")
    if path.is_dir() and any(path.glob("run*.lcmlog")):
        raise Refusal(f"recorder: --out {path} already holds a run; name another folder or remove that one")
    existing = path
    while not existing.exists():
        existing = existing.parent
    if not existing.is_dir() or not os.access(existing, os.W_OK | os.X_OK):
        raise Refusal(f"recorder: the folder {path} for the results cannot be written; name another with --out")
    disk = os.statvfs(existing)
    if disk.f_bavail * disk.f_frsize < MIN_FREE_BYTES:
        raise Refusal(f"recorder: the disk of {path} is full; free space there, or name another folder with --out")
    return path.absolute()


def devices(words, without, tools):
    """{tool: spec} of --device. The nodes check the specs. Raises Refusal."""
    if words and hands.FIRST in without:
        raise Refusal("haptic_node: --device and --without haptic_node contradict each other; remove one")
    try:
        return hands.devices(words, tools)
    except ValueError as error:
        raise Refusal(f"haptic_node: {error}") from None


def settings(words, others):
    """{node: ["name=value"]} of --set. Names are checked here, values by the nodes (--check). A setting of haptic_node or
    visual_node applies to all tools or walls; a setting of one process by its own name comes last and so overrides it.
    others: the processes of further tools and walls. Raises Refusal."""
    found, own = {}, {}
    program = lambda node: next((n for n in (hands.FIRST, walls.FIRST) if node in others and node.startswith(n)), node)
    for word in words:
        left, equals, value = word.partition("=")
        node, _, name = left.rpartition(".")
        if not (equals and node and name):
            raise Refusal(f"--set {word}: write it as NODE.NAME=VALUE, for example audio_node.gain=0.5")
        if node not in ("sim_node", *SENSES, *others):
            raise Refusal(f"--set {word}: {node} has no settings; choose from sim_node, {', '.join((*SENSES, *others))}")
        names = [row["name"] for row in read_rows(settings_table(program(node)), may_end_early=True)]
        if name not in names:
            raise Refusal(f"{node}: there is no setting {name}; docs/settings.md lists them all")
        if node in others:
            own.setdefault(node, []).append(f"{name}={value}")
            continue
        for process in (node, *(other for other in others if program(other) == node)):
            found.setdefault(process, []).append(f"{name}={value}")
    return {process: found.get(process, []) + own.get(process, []) for process in {**found, **own}}
