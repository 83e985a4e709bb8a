"""The cases: scenes in virtual time, renderings of their logs, and tables from the logs."""
import dataclasses
import json
import os

HERE = os.path.dirname(os.path.abspath(__file__))
SCENES = os.path.join("sim_node", "scenes")
SEED = 7
RUN_ID = 2
SMALL = ("width=320", "height=240")  # a quarter of the pixels of a default picture, for the time that a software renderer takes
INSTRUCTIONS = ("sse2", "avx2", "avx512")


@dataclasses.dataclass(frozen=True)
class Case:
    name: str
    seconds: float
    covers: str
    scene: str = ""              # file in sim_node/scenes; empty: that of the name
    tools: tuple = ()            # names of the tools after the first
    player: bool = False         # a simulated player holds the device
    bus: tuple = ()              # options of virtual_time: faults of the bus
    playout: tuple = ()          # options of sync_node
    profile: str = ""            # in force while the run is recorded
    pictures: tuple = SMALL      # settings of the visual node when it renders the log
    audio: tuple = ()            # settings of the audio node, in the run and when it renders the log
    each_instructions: bool = False  # the log is made sound of by every instruction set that the processor has
    log: str = ""                # an existing log is rendered; nothing is run

    def scene_file(self):
        return (self.scene or self.name) + ".sdf"


CASES = (
    Case("dark_room", 4, "the default scene: articulated bodies, two tools, three materials", tools=("lamp",), pictures=(), each_instructions=True),
    Case("dark_room_game", 8, "the game with a simulated player, over a bus that delays and loses messages", player=True,
         bus=("--latency-ms", "4", "--jitter-ms", "2", "--loss-percent", "3")),
    Case("many_bodies", 2, "many contacts at a time"),
    Case("stack", 6, "resting contacts, towers that a hand pushes over"),
    Case("friction_boundary", 3, "sliding over a friction map"),
    Case("bump_plane", 3, "sliding over surface relief"),
    Case("materials_bench", 5, "all materials, struck and stroked", audio=("method=both", "spatial=stereo")),
    Case("box_tool", 7, "a tool with torque, a mesh"),
    Case("newtons_cradle", 10, "articulated bodies, hits in a row", playout=("--policy", "experiment", "--soa", "audio=50ms,visual=-20ms")),
    Case("peg_in_hole", 5, "mesh against mesh"),
    Case("looks_bench", 2, "every way to draw a surface"),
    Case("steel_then_oak", 5, "warmth of two materials"),
    Case("metronome", 4, "a degradation profile in the run, playout in lock-step", playout=("--policy", "itouch2005"), profile="late_sound"),
)
QUICK = ("dark_room",)


def of_log(path):
    """The case of an existing log."""
    return Case("log", 0, f"a recorded log, {os.path.basename(path)}", log=os.path.abspath(path))


def chosen(only, quick, log):
    """The cases of --only, --quick and --log. Raises KeyError with an unknown name."""
    names = only or ([] if log and not quick else list(QUICK)) if (only or quick or log) else [case.name for case in CASES]
    by_name = {case.name: case for case in CASES}
    return [by_name[name] for name in names] + ([of_log(log)] if log else [])


def profile_file(root, name):
    """A profile of the checkout; otherwise that of this folder."""
    path = os.path.join(root, "tests", "measure", "outputs", "profiles", name + ".xml")
    return path if os.path.exists(path) else os.path.join(HERE, "profiles", name + ".xml")


def plan(case, root, forced):
    """{name: words} for virtual_time: the nodes of the run. forced: {program: settings} of the instruction set."""
    scene = os.path.join(root, SCENES, case.scene_file())
    nodes = {
        "recorder": ["recorder", "--scene", scene, "--seconds", f"{case.seconds:g}", "--git", "unknown"],
        "sync_node": ["sync_node", *case.playout],
        "haptic_node": ["haptic_node", *(["--device", "external:participant"] if case.player else [])],
        **{f"haptic_node_{tool}": ["haptic_node", "--name", f"haptic_node_{tool}", "--tool", tool] for tool in case.tools},
        "audio_node": ["audio_node", "--audio-device", "virtual", *settings(case.audio)],
        "visual_node": ["visual_node", "--no-pictures"],
        "thermal_node": ["thermal_node"],
        "sim_node": ["sim_node", scene],
    }
    if case.player:
        nodes["simulated_player"] = ["simulated_player", scene, "--device", "participant", "--scatter-along", "0.08", "--scatter-aside", "0.08"]
    if case.profile:
        for name in nodes:
            if name not in ("recorder", "sim_node"):
                nodes[name] += ["--degrade", profile_file(root, case.profile)]
    for words in nodes.values():
        words += ["--run-id", str(RUN_ID), "--seed", str(SEED), "--realtime", "off", "--out", "run", *settings(forced.get(words[0], ()))]
    return nodes


def settings(values):
    return [word for value in values for word in ("--set", value)]


def steps(case, root, forced, instructions):
    """(name of a step, words) of everything that a case calls in its folder, in order. Paths are relative to it, so that no output
    names a folder. instructions: those that the processor has."""
    out, log = os.path.join, os.path.join("run", "run.lcmlog")
    if not case.log:
        yield "run", ["virtual_time", out("logs", "plan.json"), "--seconds", f"{case.seconds:g}", "--seed", str(SEED), *case.bus]
    scene = [] if case.log else ["--seconds", f"{case.seconds:g}", "--scene", case.scene_file(), "--seed", str(SEED)]
    yield "summarise", ["summarise", log, "--out", out("run", "summary.json"), *scene, "--git", "unknown"]
    yield "export_csv", ["export_csv", log, "--out", "run"]
    yield "export_events", ["export_events", log, "--out", "run"]
    yield "tables", ["export_log", log, "--out", "tables"]
    yield "wide", ["export_log", log, "--out", "wide", "--wide"]
    kinds = [("clean", None), ("degraded", profile_file(root, "several_operators"))]
    for kind, profile in kinds + ([("logged", "logged")] if case.profile else []):
        for name, words in renderings(case, log, kind, forced):
            yield f"{kind}_{name}", words + (["--degrade", profile] if profile else [])
    for choice in instructions if case.each_instructions else ():
        yield f"audio_{choice}", ["audio_node", "--log", log, "--wav", out("instructions", f"audio_{choice}.wav"), "--set", f"instructions={choice}"]
    if case.player:
        yield "games", ["play_games", os.path.join(root, SCENES, case.scene_file()), "--out", "games", "--latency-ms", "2"]


def renderings(case, log, folder, forced):
    """(name, words) of each modality that is rendered from the log."""
    words = lambda program, *more: [program, "--log", log, *more, *settings(forced.get(program, ()))]
    at = lambda name: os.path.join(folder, name)
    yield "audio", words("audio_node", "--wav", at("audio.wav"), "--presented", at("presented_audio.csv"), *settings(case.audio))
    for tool in ("", *case.tools):
        end = f"_{tool}" if tool else ""
        yield f"haptic{end}", words("haptic_node", "--trace", at(f"haptic{end}.csv"), "--presented", at(f"presented_haptic{end}.csv"),
                                    *(["--tool", tool] if tool else []))
    yield "thermal", words("thermal_node", "--trace", at("thermal.csv"), "--presented", at("presented_thermal.csv"))
    yield "visual", words("visual_node", "--video", at("video.mp4"), "--frames", at("frames.csv"), "--presented", at("presented_visual.csv"),
                          *settings(case.pictures))


def games():
    """Input of play_games: three games, one of them with a degraded modality."""
    late = '<profile><degrade modality="haptic" delay="20ms"/></profile>'
    wanted = [{"game": "1", "seed": 11, "limit_s": 20}, {"game": "2", "seed": 12, "limit_s": 20}, {"game": "3", "seed": 13, "limit_s": 20, "profile": late}]
    return "".join(json.dumps(game) + "\n" for game in wanted)
