"""Shared parts of the commands of tests/measure. Importing it makes the package `tactus` of scripts/python importable, and names a missing
module in one sentence."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "python"))


def name_missing_module(kind, error, trace):
    """For sys.excepthook."""
    if kind is ModuleNotFoundError and (error.name or "tactus").split(".")[0] not in ("tactus", __name__):
        print(f"{pathlib.Path(sys.argv[0]).name}: {sys.executable} has no module {error.name}; run scripts/setup", file=sys.stderr)
        return
    sys.__excepthook__(kind, error, trace)


sys.excepthook = name_missing_module
