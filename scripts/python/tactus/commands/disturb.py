"""Sends malformed or useless messages to a cluster, to test its robustness. Run it inside the network of a cluster: tactus attach tactus disturb ...

  tactus disturb malformed [--channel NAME] [--rate N] [--seconds S]   malformed messages on the real-time port
  tactus disturb bulk [--rate BYTES_PER_S] [--seconds S]               useless data on the bulk port

Uses the port of TACTUS_PORT with ttl 0, so the messages stay on this machine.
"""
import argparse
import os
import random
import socket
import struct
import time

from tactus.option_parser import OptionParser

GROUP = "239.255.76.67"
MAGIC = 0x4C433032  # a short LCM message (LCM 1.3.1, lcm_udpm.h)
BULK_BYTES = 60_000
STEP_S = 0.001


def arguments(words):
    parser = OptionParser(prog="tactus disturb", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("malformed", "bulk"))
    parser.add_argument("--channel", default="CONTACT_EVENTS", help="channel of the malformed messages (default: %(default)s)")
    parser.add_argument("--rate", type=float, help="messages per second, or bytes per second (default: 10,000 and 60,000,000)")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--seed", type=int, default=1, help="seed of the malformed messages (default: 1)")
    parser.add_argument("--port", type=int, default=int(os.environ.get("TACTUS_PORT", "7667")))
    return parser.parse_args(words)


def packet(number, channel, payload):
    return struct.pack(">II", MAGIC, number & 0xFFFFFFFF) + channel.encode() + b"\0" + payload


def payloads(what, seed):
    """Prepared payloads, sent cyclically, because generating one takes longer than sending it."""
    if what == "bulk":
        return [bytes(BULK_BYTES)]
    chance = random.Random(seed)
    return [chance.randbytes(chance.randint(0, 400)) for _ in range(64)]


def main(words):
    options = arguments(words)
    bulk = options.what == "bulk"
    per_second = (options.rate or 60e6) / BULK_BYTES if bulk else options.rate or 10e3
    port = options.port + 1 if bulk else options.port
    channel = "BULK_NOISE" if bulk else options.channel
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
    kinds = payloads(options.what, options.seed)
    begin, sent = time.monotonic(), 0
    while (now := time.monotonic() - begin) < options.seconds:
        while sent < now * per_second:
            out.sendto(packet(sent, channel, kinds[sent % len(kinds)]), (GROUP, port))
            sent += 1
        time.sleep(STEP_S)
    print(f"disturb: {sent} messages in {options.seconds:g} s")

