"""Paths of the repository or of the installation, and the command lines that run a command or a module of this package as a process."""
import json
import os
import pathlib

SCRIPTS = pathlib.Path(__file__).resolve().parents[2]
REPOSITORY = SCRIPTS.parent
# Written by `cmake --install` (cmake/Install.cmake): the version, and the other folders of the installation, relative to SCRIPTS. An
# installation can be moved as a whole.
_FILE = SCRIPTS / "installed.json"
INSTALLED = json.loads(_FILE.read_text(encoding="utf-8")) if _FILE.is_file() else None
# Tables, scenes and rooms, in the folders of their nodes: DATA/sim_node/scenes.
DATA = pathlib.Path(os.path.normpath(SCRIPTS / INSTALLED["data"])) if INSTALLED else REPOSITORY
SCENES = DATA / "sim_node" / "scenes"
ROOMS = DATA / "visual_node" / "rooms"
THRESHOLDS = DATA / "sync" / "presentation" / "thresholds.csv"
TACTUS = SCRIPTS / "tactus"
# TACTUS_BIN: the programs of another build; then nothing is installed or built.
BIN = pathlib.Path(os.environ.get("TACTUS_BIN") or (os.path.normpath(SCRIPTS / INSTALLED["programs"]) if INSTALLED else REPOSITORY / "build" / "dev" / "bin")).absolute()


def settings_table(node):
    """The settings.csv of a node folder."""
    return DATA / node / "settings.csv"


def tactus_command(name):
    """Command words that run a command of `tactus`; its arguments follow."""
    return [str(TACTUS), name]


def tactus_module(name):
    """Command words that run main() of a module of this package, for example "sweep.job"; its arguments follow."""
    return [str(TACTUS), "--module", f"tactus.{name}"]


def remedy(target=""):
    """The remedy for a missing program. target: of the build; default: all programs."""
    return "install the package tactus again" if INSTALLED else f"run scripts/build {target}".rstrip()


def packages_remedy(group):
    """The remedy for missing packages of a group of scripts/packages.txt."""
    return f"run {'tactus setup' if INSTALLED else 'scripts/setup'} {group}"
