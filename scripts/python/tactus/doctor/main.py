"""Checks whether this machine is fit for a cluster; prints one line for each check, with the remedy for each fault.

Usage: tactus doctor [--seconds N] [--port N] [--out DIR] [--json FILE]

  --seconds N   duration of each of the two measurements of wake-up latency; default: 10
  --port N      port of a running cluster whose clocks are compared; default: 7667
  --out DIR     folder for the logs; default: the current directory
  --json FILE   also writes the figures to FILE

good: as required; weak: works with restrictions; missing: a part is impossible. Exit status: 0 when a cluster can run on this
machine, else 1.
"""
import argparse
import json
import os
import sys

from tactus.doctor import bus, clocks, devices, realtime, sandbox
from tactus.doctor.line import GOOD, MISSING, WEAK
from tactus.launch.equipment import has_sound_card
from tactus.launch.network import ROUTE, candidates, is_allowed
from tactus.option_parser import OptionParser

COLOURS = {GOOD: "\x1b[32m", WEAK: "\x1b[33m", MISSING: "\x1b[31m"}
SIGN = {GOOD: "good   ", WEAK: "weak   ", MISSING: "missing"}


def print_line(line):
    colour, plain = (COLOURS[line.verdict], "\x1b[0m") if sys.stdout.isatty() else ("", "")
    print(f"{colour}{SIGN[line.verdict]}{plain}  {line.what + ':':26}{line.found}")
    if line.remedy and line.verdict != GOOD:
        print(f"{'':35}-> {line.remedy}")
    sys.stdout.flush()


def progress(what):
    if not sys.stderr.isatty():
        return lambda share: None
    return lambda share: print(f"\r{what}: {100 * share:3.0f} %" + ("\r\x1b[K" if share >= 1 else ""), end="", file=sys.stderr, flush=True)


def examine(seconds, port, out):
    """Yields the result of each check."""
    private = any(is_allowed(flags, ROUTE) for flags, _ in candidates(net=True))
    network = [bus.route(), bus.loopback(), bus.namespaces(private)]
    bus.mark_required_network(network)
    yield from network
    yield bus.receive_buffer()
    yield clocks.offsets(port)
    yield realtime.priority()
    yield realtime.memory()
    yield realtime.share()
    if not realtime.fifo_refusal():
        yield realtime.wakeups(seconds, True, progress("waking with priority"))
    yield realtime.wakeups(seconds, False, progress("waking without priority"))
    yield devices.cores()
    yield devices.sound(has_sound_card())
    yield devices.picture()
    yield devices.disk(out)
    yield sandbox.confinement()


def main(words):
    parser = OptionParser(prog="tactus doctor", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, usage=argparse.SUPPRESS,
                          add_help=False)
    parser.add_argument("--help", "-h", action="store_true")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--port", type=int, default=7667)
    parser.add_argument("--out", default=os.getcwd())
    parser.add_argument("--json")
    options = parser.parse_args(words)
    if options.help:
        print(__doc__)
        return 0
    if not 0.1 <= options.seconds <= 3600 or not 0 < options.port < 65535:
        print("doctor: give --seconds from 0.1 to 3600 and --port from 1 to 65534", file=sys.stderr)
        return 1
    lines = []
    for line in examine(options.seconds, options.port, options.out):
        print_line(line)
        lines.append(line)
    fit = not any(line.needed and line.verdict == MISSING for line in lines)
    weak = [line.what for line in lines if line.verdict != GOOD]
    print(f"\n{'fit' if fit else 'not fit'}" + (f"; not good: {', '.join(weak)}" if weak else ""))
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({"fit": fit, "lines": [{"what": line.what, "verdict": line.verdict, "found": line.found, "remedy": line.remedy,
                                              "figures": line.figures} for line in lines]}, file, indent=1)
    return 0 if fit else 1

