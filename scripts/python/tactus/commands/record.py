"""The command `tactus record`: records the running cluster, or a bus of this machine's network, until Ctrl-C or for some seconds."""
import os
import pathlib
import signal
import subprocess

from tactus import terminal
from tactus.commands import prepare
from tactus.launch import arguments
from tactus.option_parser import OptionParser
from tactus.paths import BIN, tactus_command
from tactus.refusal import Refusal

USAGE = """Usage: tactus record [--out DIR] [--seconds N] [--in OUT_DIR] [option]...
       tactus record --network [--group ADDRESS] [--port N] [--ttl N] [--run-id N] [--out DIR] [--seconds N]

Records all messages of the running cluster to DIR/run.lcmlog, besides the recorder of the run itself. Ctrl-C ends the recording.

  --out DIR              folder of the recording; default: out/TIME in the current directory
  --seconds N            ends after N seconds; default: at Ctrl-C, or with the cluster
  --in OUT_DIR           the cluster that writes to OUT_DIR; default: the cluster that was started last
  --network              records the network of this machine instead of a cluster: a bus that tactus run did not start
  --group, --port, --ttl, --run-id   with --network, as for the nodes
  --split-mb N, --split-minutes N, --keep N, --max-mb N, --tags PATTERN   as for tactus run
  --help                 this text"""
OF_NETWORK = ("group", "port", "ttl", "run-id")
ENDING_S = 10.0  # the recorder writes its last messages, as in launch/cluster.py


def parsed(words):
    parser = OptionParser(prog="tactus record", add_help=False, allow_abbrev=False)
    for option in ("out", "in", "seconds", *OF_NETWORK, *(name.replace("_", "-") for name in arguments.RECORDING)):
        parser.add_argument(f"--{option}", dest=option.replace("-", "_"))
    parser.add_argument("--tags", action="append", default=[])
    parser.add_argument("--network", action="store_true")
    return parser.parse_args(words)


def command(a, out):
    """The command line of the recorder. Raises Refusal."""
    given = [(option, getattr(a, option.replace("-", "_"))) for option in OF_NETWORK]
    named = [word for option, value in given if value is not None for word in (f"--{option}", value)]
    # A name of its own: the summary of a run counts two processes of one name as a restart.
    recorder = ["--name", "record", "--out", str(out), *arguments.recording(a)]
    if a.network:
        if vars(a)["in"]:
            raise Refusal("--network and --in contradict each other; remove one")
        return [str(BIN / "recorder"), *recorder, *named]
    if named:
        raise Refusal(f"{named[0]} needs --network; a cluster has its own bus")
    folder = [os.path.realpath(vars(a)["in"])] if vars(a)["in"] else []
    return [*tactus_command("attach"), *folder, "sh", "-c", 'exec recorder --port "$TACTUS_PORT" --run-id "$TACTUS_RUN_ID" "$@"', "sh", *recorder]


def main(words):
    if {"--help", "-h"} & set(words):
        return prepare.print_usage(USAGE)
    a = parsed(words)
    try:
        seconds = arguments.number("--seconds", a.seconds, 0.1, arguments.MAX_SECONDS, "seconds") if a.seconds else None
        if vars(a)["in"] and not os.path.isdir(vars(a)["in"]):
            raise Refusal(f"the folder {vars(a)['in']} does not exist; name the folder that a run writes to")
        out = arguments.out_folder(pathlib.Path.cwd(), a.out)
        started = command(a, out)
    except Refusal as refusal:
        return prepare.refuse("record", refusal)
    prepare.program("recorder")
    made = not out.exists()
    out.mkdir(parents=True, exist_ok=True)
    process = subprocess.Popen(started)
    try:
        status = process.wait(seconds)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGINT)
        status = process.wait(ENDING_S)
    except KeyboardInterrupt:  # the recorder received it, too
        status = process.wait(ENDING_S)
    if made and not any(out.iterdir()):
        out.rmdir()
    if status == 0:
        terminal.report(terminal.one_line(f"record: recording in {out}"))
    return 0 if status == 0 else 1
