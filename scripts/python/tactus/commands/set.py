"""The command `tactus set`: changes settings of a node of a running cluster."""
from tactus.commands import request_program

USAGE = """Usage: tactus set NODE NAME=VALUE... [--in OUT_DIR]

Changes settings of a node of the running cluster immediately, until the node loads a scene or restarts. NODE is its name in the
live table (tactus attach watch). For example:

  tactus set haptic_node force_limit=5N          at most the default: a safety limit can only be
                                                  lowered in this way
  tactus set visual_node overlay=contacts,report overlays of the picture

  --in OUT_DIR                   the cluster that writes to OUT_DIR; default: the cluster that was started last

Prints the change, or one sentence with the reason for the failure. docs/settings.md marks these settings as live."""


def main(words):
    return request_program.main("set", USAGE, words)
