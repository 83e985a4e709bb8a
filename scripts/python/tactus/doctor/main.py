"""Is this machine fit? Looks at everything that a cluster needs of it and says, line by line, what to do about it.

Usage: tactus doctor [--seconds N] [--port N] [--out DIR] [--json FILE]

  --seconds N   how long each of the two loops is watched for how late it wakes; default: 10
  --port N      port of a cluster that may be running, whose clocks are compared; default: 7667
  --out DIR     folder that shall take the logs; default: the one that you are in
  --json FILE   the same figures for a program

good: as it should be; weak: works, but worse than it could; missing: a part cannot be had. Exit status: 0 when a cluster can run
here, 1 when not.
"""
import argparse
import json
import os
import sys

from tactus.doctor import bus, clocks, devices, realtime
from tactus.doctor.line import GOOD, MISSING, WEAK
from tactus.launch.equipment import has_sound_card
from tactus.launch.network import ROUTE, allowed, candidates

COLOURS = {GOOD: "\x1b[32m", WEAK: "\x1b[33m", MISSING: "\x1b[31m"}
SIGN = {GOOD: "good   ", WEAK: "weak   ", MISSING: "missing"}


def say(line):
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
    """Every line, as soon as it is known."""
    private = any(allowed(flags, ROUTE) for flags, _ in candidates(net=True))
    network = [bus.route(), bus.loopback(), bus.namespaces(private)]
    bus.either(network)
    yield from network
    yield bus.room()
    yield clocks.offsets(port)
    yield realtime.priority()
    yield realtime.memory()
    yield realtime.share()
    if not realtime.may_fifo():
        yield realtime.wakeups(seconds, True, progress("waking with priority"))
    yield realtime.wakeups(seconds, False, progress("waking without priority"))
    yield devices.cores()
    yield devices.sound(has_sound_card())
    yield devices.picture()
    yield devices.disk(out)


def main(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, usage=argparse.SUPPRESS,
                                     add_help=False)
    parser.add_argument("--help", "-h", action="store_true")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--port", type=int, default=7667)
    parser.add_argument("--out", default=os.getcwd())
    parser.add_argument("--json")
    try:
        options = parser.parse_args(words)
    except SystemExit as end:
        sys.exit(1 if end.code else 0)
    if options.help:
        print(__doc__)
        return 0
    if not 0.1 <= options.seconds <= 3600 or not 0 < options.port < 65535:
        print("doctor: --seconds is from 0.1 to 3600, --port from 1 to 65534", file=sys.stderr)
        return 1
    lines = []
    for line in examine(options.seconds, options.port, options.out):
        say(line)
        lines.append(line)
    fit = not any(line.needed and line.verdict == MISSING for line in lines)
    weak = [line.what for line in lines if line.verdict != GOOD]
    print(f"\n{'fit' if fit else 'not fit'}" + (f", but for: {', '.join(weak)}" if weak else ""))
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({"fit": fit, "lines": [{"what": line.what, "verdict": line.verdict, "found": line.found, "remedy": line.remedy,
                                              "figures": line.figures} for line in lines]}, file, indent=1)
    return 0 if fit else 1

