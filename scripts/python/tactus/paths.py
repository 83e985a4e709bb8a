"""Where things are, and how a command or a module of this package is run as a process of its own."""
import os
import pathlib

SCRIPTS = pathlib.Path(__file__).resolve().parents[2]
REPOSITORY = SCRIPTS.parent
SCENES = REPOSITORY / "sim_node" / "scenes"
TACTUS = SCRIPTS / "tactus"
# TACTUS_BIN: programs of another build; then nothing is installed or built.
BIN = pathlib.Path(os.environ.get("TACTUS_BIN") or REPOSITORY / "build" / "dev" / "bin").absolute()


def tactus_command(name):
    """Words that run a command of `tactus`; its own words follow."""
    return [str(TACTUS), name]


def tactus_module(name):
    """Words that run main() of a module of this package, for example "sweep.job"; its own words follow."""
    return [str(TACTUS), "--module", f"tactus.{name}"]
