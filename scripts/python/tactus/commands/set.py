"""Changes settings of a node of a running cluster."""
from tactus.commands import ask

USAGE = """Usage: tactus set NODE NAME=VALUE... [--in OUT_DIR]

Changes settings of a node of the running cluster, at once and until the node's next scene or start. NODE is what the live
table (tactus attach watch) calls it. For example:

  tactus set haptic_node force_limit=5N          never more than the default: a limit that protects a person may only be
                                                  tightened so
  tactus set visual_node overlay=contacts,report what is laid over the picture

  --in OUT_DIR                   the cluster that writes to OUT_DIR; default: the one that was started last

Says what was done, or in one sentence why it was not. docs/settings.md says which settings can be changed so: live."""


def main(words):
    return ask.main("set", USAGE, words)
