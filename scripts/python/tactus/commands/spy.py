"""The command `tactus spy`: shows every channel of the bus of a running cluster in a terminal."""
import os

from tactus.commands import prepare
from tactus.paths import tactus_command

USAGE = """Usage: tactus spy [OUT_DIR] [option]...

Shows every channel of the running cluster that writes to OUT_DIR (default: the cluster that was started last): messages a
second, bandwidth, gaps in the sequence numbers, jitter, and age from sending to arrival. It publishes nothing except requests for tags.

  up, down      selects a line; enter shows the fields of the newest message, with a plot of the selected field
  t             tagged variables of all nodes, with unit and plot; they are requested only while shown
  p, q          pause; quit
  --once N      receives for N seconds and prints the table
  --json FILE   with --once: also writes the figures to FILE
  --help        this text

On a network without a cluster of scripts/run, run the program directly: build/dev/bin/spy --port N --ttl 1."""


def main(words):
    if words[:1] in (["--help"], ["-h"]):
        return prepare.print_usage(USAGE)
    folder = []
    if words and os.path.isdir(words[0]):
        folder, words = [words[0] if "/" in words[0] else f"./{words[0]}"], words[1:]
    prepare.replace_process([*tactus_command("attach"), *folder, "spy", *words])
