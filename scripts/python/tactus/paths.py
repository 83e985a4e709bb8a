"""Paths of the repository, and the command lines that run a command or a module of this package as a process."""
import os
import pathlib

SCRIPTS = pathlib.Path(__file__).resolve().parents[2]
REPOSITORY = SCRIPTS.parent
SCENES = REPOSITORY / "sim_node" / "scenes"
TACTUS = SCRIPTS / "tactus"
# TACTUS_BIN: the programs of another build; then nothing is installed or built.
BIN = pathlib.Path(os.environ.get("TACTUS_BIN") or REPOSITORY / "build" / "dev" / "bin").absolute()


def tactus_command(name):
    """Command words that run a command of `tactus`; its arguments follow."""
    return [str(TACTUS), name]


def tactus_module(name):
    """Command words that run main() of a module of this package, for example "sweep.job"; its arguments follow."""
    return [str(TACTUS), "--module", f"tactus.{name}"]
