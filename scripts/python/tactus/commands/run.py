"""The command `tactus run`: in a source tree scripts/run, which installs missing packages and builds first."""
import os
import pathlib

from tactus.commands import prepare
from tactus.launch import main as launch
from tactus.paths import INSTALLED, SCRIPTS


def main(words):
    if {"--help", "-h"} & set(words):
        return prepare.print_usage(pathlib.Path(launch.__file__).with_name("usage.txt").read_text(encoding="utf-8").rstrip("\n"))
    if not INSTALLED:
        script = str(SCRIPTS / "run")
        os.execv(script, [script, *words])
    return launch.main(words)
