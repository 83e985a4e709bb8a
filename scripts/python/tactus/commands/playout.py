"""The command `tactus playout`: shows or changes the playout policy of a running cluster."""
from tactus.commands import request_program

USAGE = """Usage: tactus playout [POLICY] [--soa LIST] [--base TIME] [--budget TIME] [--aligner NAME] [--in OUT_DIR]

Without a policy: prints the current policy of the running cluster, the delay of each modality, and its shortest possible delay.
With a policy: applies it to all modalities at the same time; delays are slewed by 5 %, never stepped.
  POLICY           local_haptic_first, aligned, asap, experiment or itouch2005
  --soa LIST       policy experiment: asynchrony of each modality relative to the common delay, e.g. audio=50ms,visual=-20ms
  --base TIME      the common delay; default: 150ms
  --budget TIME    maximum delay; a modality that needs more is late; default: 60ms
  --aligner NAME   method that estimates the delay of a modality: quantile (default) or fixed
  --in OUT_DIR     the cluster that writes to OUT_DIR; default: the cluster that was started last"""


def main(words):
    return request_program.main("playout", USAGE, words, may_be_none=True)
