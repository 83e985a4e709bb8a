"""The table of the commands of `tactus`: name, summary and target of each."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Command:
    """target: a module with main(words) that returns the exit status; or, without a dot, a script of scripts/. packages: the group of
    scripts/packages.txt that the command needs besides build and run."""
    name: str
    summary: str
    target: str
    packages: str = ""


GROUPS = {
    "Run": (
        Command("run", "runs a scene with each node in its own process, and summarises the results", "run"),
        Command("replay", "plays the log of a run to live nodes", "tactus.commands.replay"),
        Command("live", "live page: `live open LOG`, `live follow URL`", "tactus.commands.live", "live"),
        Command("doctor", "checks whether this machine is fit for a run", "tactus.doctor.main"),
    ),
    "While a cluster runs": (
        Command("attach", "runs a command in the network of the running cluster", "tactus.commands.attach"),
        Command("spy", "shows every channel of the bus in a terminal", "tactus.commands.spy"),
        Command("degrade", "applies or removes a degradation profile", "tactus.commands.degrade"),
        Command("playout", "shows or changes when each modality presents an event", "tactus.commands.playout"),
        Command("simulation", "pauses, steps, resets and changes the simulation", "tactus.commands.simulation"),
        Command("set", "changes settings of a node", "tactus.commands.set"),
        Command("disturb", "sends malformed or useless messages on purpose", "tactus.commands.disturb"),
    ),
    "Results of a run": (
        Command("export", "makes tables of a log", "tactus.commands.export"),
        Command("report", "makes one HTML page about one or several runs", "tactus.report.main", "report"),
        Command("log", "`log upgrade OLD NEW`: converts a log to the message types of this release", "tactus.commands.log"),
        Command("rerender", "renders a log again under other degradation profiles, and compares", "tactus.rerender.main", "report"),
    ),
    "Studies": (
        Command("study", "`study check`, `run`, `sweep`, `analyse`: how far can a modality degrade?", "tactus.commands.study", "study"),
    ),
    "Several hosts": (
        Command("cluster", "runs a scene on several hosts described by a cluster file", "tactus.commands.cluster", "cluster"),
        Command("lab", "runs a command together with simulated hosts on this machine", "tactus.cluster.lab_command", "lab"),
        Command("private-path", "makes keys and configurations for a private path of the bus", "tactus.cluster.private_path", "private-path"),
        Command("units", "installs systemd units of the nodes", "tactus.cluster.units", "cluster"),
    ),
    "Scenes and sounds": (
        Command("convert-geometry", "converts a geometry file to glTF with material, relief and modes", "tactus.commands.convert_geometry"),
        Command("analyse-modes", "finds the modes of a struck object in a recording", "tactus.modal_analysis.main", "report"),
        Command("check-sounds", "checks a folder of recordings", "tactus.commands.check_sounds"),
        Command("drumkit-sounds", "makes a folder of recordings from a Debian package of drums", "tactus.commands.drumkit_sounds"),
    ),
    "Installation": (
        Command("setup", "installs the packages that Tactus needs", "setup"),
        Command("build", "configures and builds", "build"),
        Command("test", "builds and runs the tests", "test"),
    ),
}
BY_NAME = {command.name: command for commands in GROUPS.values() for command in commands}
