"""Shows or changes when each modality of a running cluster presents an event."""
from tactus.commands import ask

USAGE = """Usage: tactus playout [POLICY] [--soa LIST] [--base TIME] [--budget TIME] [--aligner NAME] [--in OUT_DIR]

Without a policy: says which is in force in the running cluster, when each sense presents an event, and how soon it could.
With one: puts it in force, in all senses at once; delays are slewed by 5 %, never stepped.
  POLICY           local_haptic_first, aligned, asap, experiment or itouch2005
  --soa LIST       of experiment: asynchrony of senses against the common delay, e.g. audio=50ms,visual=-20ms
  --base TIME      that common delay; default: 150ms
  --budget TIME    no delay is chosen longer than this; a sense that needs more is late; default: 60ms
  --aligner NAME   how the delay is found that a sense needs: quantile (default), average, virtual-time or fixed
  --in OUT_DIR     the cluster that writes to OUT_DIR; default: the one that was started last"""


def main(words):
    return ask.main("playout", USAGE, words, may_be_none=True)
