"""The table of the commands of `tactus`: name, summary, target, common options and examples of each."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Command:
    """target: a module with main(words) that returns the exit status; or, without a dot, a script of scripts/. packages: the group of
    scripts/packages.txt that the command needs besides build and run. verbs: its subcommands. options: those of common_options.py that it
    has besides --help and --quiet; "json" may stand for some verbs only. examples: (words after `tactus`, what they do).
    passes_words: a command of the user follows, whose options are its own. from_source: only in a source tree, not in an installation."""
    name: str
    summary: str
    target: str
    packages: str = ""
    verbs: tuple = ()
    options: tuple = ()
    examples: tuple = ()
    passes_words: bool = False
    from_source: bool = False


GROUPS = {
    "Run": (
        Command("run", "runs a scene with each node in its own process, and summarises the results", "tactus.commands.run",
                options=("out", "json", "seed"),
                examples=(("run --seconds 10 --out out/first", "the default scene; results in out/first"),
                          ("run my_world.sdf --without audio_node", "a scene of your own, without sound"),
                          ("run --quiet --json -", "prints only the summary, as JSON"))),
        Command("replay", "plays the log of a run to live nodes", "tactus.commands.replay", options=("out", "json", "seed"),
                examples=(("replay out/first --only audio_node", "the sound of a recorded run"),
                          ("replay out/first --speed 0.5 --out out/slow", "at half the speed"))),
        Command("record", "records the running cluster, or a network, besides the recorder of a run", "tactus.commands.record", options=("out",),
                examples=(("record --seconds 5 --out recording", "5 s of the running cluster"),
                          ("record --network --port 7667 --ttl 1 --out recording", "a bus without tactus run, until Ctrl-C"))),
        Command("live", "live page: `live open LOG`, `live follow URL`", "tactus.commands.live", "live", verbs=("open", "follow"), options=("json",),
                examples=(("live open out/first/run.lcmlog", "shows a log, with a seek bar"),
                          ("live follow URL --seconds 5 --json counts.json", "counts the frames of a page for 5 s"))),
        Command("doctor", "checks whether this machine is fit for a run", "tactus.doctor.main", options=("out", "json"),
                examples=(("doctor", "all checks, about 20 s"), ("doctor --seconds 2 --json -", "short measurements, printed as JSON"))),
    ),
    "While a cluster runs": (
        Command("attach", "runs a command in the network of the running cluster", "tactus.commands.attach", passes_words=True,
                examples=(("attach watch", "the live table"), ("attach sv pause visual_node", "freezes a node"))),
        Command("spy", "shows every channel of the bus in a terminal", "tactus.commands.spy", options=("json",),
                examples=(("spy", "the newest cluster; q quits"), ("spy --once 3 --json -", "3 s of traffic as JSON"))),
        Command("degrade", "applies or removes a degradation profile", "tactus.commands.degrade",
                examples=(("degrade late.xml", "applies a profile to the newest cluster"), ("degrade off out/first", "removes it from the cluster that writes to out/first"))),
        Command("playout", "shows or changes when each modality presents an event", "tactus.commands.playout",
                examples=(("playout", "prints the policy and the delays"), ("playout experiment --soa audio=50ms", "sound 50 ms after the common delay"))),
        Command("simulate", "pauses, steps, resets and changes the simulation", "tactus.commands.simulate",
                verbs=("pause", "resume", "step", "reset", "set", "push", "snapshot", "restore"),
                examples=(("simulate pause", "simulation time stands still"), ("simulate set steel_ball.mass 0.3", "changes a mass to 0.3 kg"))),
        Command("set", "changes settings of a node", "tactus.commands.set",
                examples=(("set haptic_node force_limit=5N", "lowers a safety limit"), ("set audio_node gain=0.5 --in out/first", "in the cluster that writes to out/first"))),
        Command("disturb", "sends malformed or useless messages on purpose", "tactus.commands.disturb", verbs=("malformed", "bulk"), options=("seed",),
                examples=(("attach tactus disturb malformed --seconds 5", "10,000 malformed messages a second"),)),
    ),
    "Results of a run": (
        Command("export", "makes tables of a log", "tactus.commands.export", options=("out", "json"),
                examples=(("export out/first", "tables in out/first/tables"), ("export out/first --wide --out tables", "one row for each message, for PlotJuggler"))),
        Command("report", "makes one HTML page about one or several runs", "tactus.report.main", "report", options=("out", "json"),
                examples=(("report out/first", "out/first/report.html"), ("report out/clean out/late --out both.html", "the second overlaid"))),
        Command("metrics", "prints how late, how coarse and how old the rendering of a run was", "tactus.metrics.main", "report", options=("json",),
                examples=(("metrics out/late --reference out/clean", "also its force against the same motion without degradation"),
                          ("metrics out/clean/rerendered/late --csv metrics.csv", "a rendering of `tactus rerender`"))),
        Command("log", "`log upgrade OLD NEW`: converts a log to the message types of this release", "tactus.commands.log", verbs=("upgrade",),
                examples=(("log upgrade old/run.lcmlog new.lcmlog", "writes new.lcmlog"),)),
        Command("rerender", "renders a log again under other degradation profiles, and compares", "tactus.rerender.main", "report", options=("out", "json"),
                examples=(("rerender out/first --degrade late.xml", "all modalities, without and with the profile"),
                          ("rerender out/first --only audio --twice", "compares two renderings byte by byte"))),
        Command("rerun", "runs the scene of a log again, with its hand in closed loop, under other profiles", "tactus.rerun.main", "report",
                options=("out", "json", "seed"),
                examples=(("rerun out/first --degrade late.xml", "fits the hand of out/first; results in out/first/rerun"),
                          ("rerun out/first --draws 20 --tool hand --json fit.json", "only under the profile of the log, with 20 hands"))),
    ),
    "Studies": (
        Command("study", "`study check`, `run`, `sweep`, `analyse`, `replicate`, `information`, `battery`", "tactus.commands.study", "study",
                verbs=("check", "run", "sweep", "analyse", "replicate", "information", "battery"), options=("out", "json", "seed"),
                examples=(("study check audio_visual_synchrony", "plan, duration and power of a shipped study"),
                          ("study run audio_visual_synchrony --participant P01 --simulated", "a session with a simulated participant"),
                          ("study sweep game_limits --games 10 --out sweep", "10 games of each condition in virtual time"),
                          ("study analyse sweep", "fits, limits and a report"),
                          ("study replicate", "all shipped experiments: published value, own value, verdict"),
                          ("study information", "all shipped tasks: bits and right answers by each sense"),
                          ("study replicate vogels_2004 rank_2010 --participants 4 --out replicated", "two of them, with all answers"))),
        Command("sweep", "plays the games of a study in virtual time; the same as `study sweep`", "tactus.commands.sweep", "study", options=("out",),
                examples=(("sweep game_limits --games 10 --out sweep", "10 games of each condition"), ("sweep --resume --out sweep", "continues after a stop"))),
    ),
    "Several hosts": (
        Command("cluster", "runs a scene on several hosts described by a cluster file", "tactus.commands.cluster", "cluster",
                verbs=("up", "down", "status", "logs", "restart", "move", "degrade", "playout", "set", "doctor", "check"), options=("out", "json"),
                examples=(("cluster check cave4", "validates a shipped cluster file"), ("cluster up cave4", "starts its nodes"), ("cluster status --once", "one table of all hosts"),
                          ("cluster down --out out/cave", "stops them and gathers the results"))),
        Command("lab", "runs a command together with simulated hosts on this machine", "tactus.cluster.lab_command", "lab", passes_words=True,
                examples=(("lab --hosts desk,sound tactus cluster up desk_and_sound", "tries a cluster of two hosts"),)),
        Command("private-path", "makes keys and configurations for a private path of the bus", "tactus.cluster.private_path", "private-path",
                verbs=("make", "macsec"), options=("out",),
                examples=(("private-path make --hosts desk,sound --server 192.0.2.7 --out keys", "one folder for each host"),)),
        Command("units", "installs systemd units of the nodes", "tactus.cluster.units", "cluster", verbs=("install",), options=("out",),
                examples=(("units install --root image --only sim,recorder", "into the file tree image"),)),
    ),
    "Scenes and sounds": (
        Command("convert", "converts a geometry file to glTF with material, relief and modes", "tactus.commands.convert",
                examples=(("convert bowl.obj bowl.glb --material ceramic", "one binary file"),)),
        Command("analyse-modes", "finds the modes of a struck object in a recording", "tactus.modal_analysis.main", "report", options=("out", "json"),
                examples=(("analyse-modes bell.wav --out bell.xml --base copper", "a material for a scene"),)),
        Command("check-sounds", "checks a folder of recordings", "tactus.commands.check_sounds", options=("json",),
                examples=(("check-sounds", "the default set"), ("check-sounds drums --scene world.sdf", "the recording of each pair of materials"))),
        Command("drumkit-sounds", "makes a folder of recordings from a Debian package of drums", "tactus.commands.drumkit_sounds",
                examples=(("drumkit-sounds drums", "a new folder drums"),)),
    ),
    "Installation": (
        Command("setup", "installs the packages that Tactus needs", "setup",
                examples=(("setup --check", "the state of this machine; changes nothing"), ("setup report", "the packages of tactus report"))),
        Command("build", "configures and builds", "build", from_source=True, examples=(("build --programs", "the programs of all commands, without tests"),)),
        Command("package", "builds Debian packages and an apt repository", "package", options=("out",), from_source=True,
                examples=(("package --out debs", "packages and repository in debs"),)),
        Command("test", "builds and runs the tests", "test", from_source=True, examples=(("test --label unit", "the unit tests"),)),
    ),
}
BY_NAME = {command.name: command for commands in GROUPS.values() for command in commands}
# Names of earlier releases.
ALIASES = {"simulation": "simulate", "convert-geometry": "convert"}
