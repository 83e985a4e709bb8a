"""Shows every channel of the bus of a running cluster, in a terminal."""
import os

from tactus.commands import prepare
from tactus.paths import tactus_command

USAGE = """Usage: tactus spy [OUT_DIR] [option]...

Shows every channel of the running cluster that writes to OUT_DIR (default: the one that was started last): messages a second,
bandwidth, gaps in their numbering, jitter, age between sending and arrival. It only listens.

  up, down      marks a line; enter shows the fields of the newest message, with the course of the marked one
  t             tagged variables of all nodes, with unit and course; they are asked for only while they are shown
  p, q          pauses; ends
  --once N      listens for N seconds and prints the table
  --json FILE   with --once: the same figures for a program
  --help        this text

On a network without a cluster of scripts/run, call the program itself: build/dev/bin/spy --port N --ttl 1."""


def main(words):
    if words[:1] in (["--help"], ["-h"]):
        return prepare.show(USAGE)
    folder = []
    if words and os.path.isdir(words[0]):
        folder, words = [words[0] if "/" in words[0] else f"./{words[0]}"], words[1:]
    prepare.become([*tactus_command("attach"), *folder, "spy", *words])
