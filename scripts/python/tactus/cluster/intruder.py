"""A simulated attacker without a key, for tests/measure/measure_private_path: records all frames and sends forged ones.

  tactus --module tactus.cluster.intruder DEVICE KNOWN.json     commands on stdin: "record", "forge SECONDS", "counts"; each is answered by a line of JSON on stdout

KNOWN.json holds what the attacker knows of the hosts: {"hosts": [{"mac", "address", "inside"}], "group", "port", "listen"}.
"""
import itertools
import json
import os
import random
import re
import socket
import struct
import sys
import threading
import time

ETHERNET, IP, ALL_PROTOCOLS = 14, 0x0800, 0x0003
OUTGOING = 4               # PACKET_OUTGOING of packet(7)
BUFFER_BYTES = 64 << 20
RATE_HZ = 300              # of forged frames
MAX_REPLAYED = 500         # frames to send again
MARK = b"FORGED_"          # prefix of the channels of the intruder, followed by the number of the kind
# An LCM message at any offset: magic number, sequence number, channel name; or a fragment: magic number, sequence number, size and offset
# below 16 MB, number and count below 256. In encrypted data the magic number alone occurs once in 4 GB.
MESSAGE = re.compile(rb"LC02[\s\S]{4}[A-Z]+_[A-Z_]+\0|LC03[\s\S]{4}(?:\0[\s\S]{3}){2}(?:\0[\s\S]){2}")
CHANNELS = re.compile(rb"TOUCH_MODEL|CONTACT_EVENTS|WORLD_STATE|TOOL_STATE|PRESENTED|NODE_HEALTH|SYNC_REPORT|CLOCK_PROBE|CLOCK_MAP|THERMAL_STATE|SCENE_MANIFEST")
TEXTS = re.compile(rb"sim_node|haptic_node|audio_node|visual_node|thermal_node|steel_ball")
KINDS = ("multicast", "multicast in a host's name", "multicast in the path's name", "multicast to a host's card", "unicast", "unicast to the path's address",
         "through a host into the path", "as if of the host itself", "sent again", "the path's packets")


def marked_message(kind):
    return b"LC02" + os.urandom(4) + MARK + str(kind).encode() + b"\0" + os.urandom(64)


def frame(to, by, source, destination, port, data, source_port=40000):
    """An Ethernet frame with one UDP datagram, without UDP checksum, which IPv4 allows."""
    udp = struct.pack(">HHHH", source_port, port, 8 + len(data), 0) + data
    head = struct.pack(">BBHHHBBH4s4s", 0x45, 0, 20 + len(udp), random.randrange(65536), 0, 64, 17, 0, socket.inet_aton(source),
                       socket.inet_aton(destination))
    total = sum(struct.unpack(">10H", head))
    total = (total & 0xFFFF) + (total >> 16)
    head = head[:10] + struct.pack(">H", ~(total + (total >> 16)) & 0xFFFF) + head[12:]
    return to + by + struct.pack(">H", IP) + head + udp


def without_checksum(data):
    """The UDP frame with a zero checksum, because virtual links leave the checksum to a network card that does not exist."""
    return data[:40] + b"\0\0" + data[42:]


class Intruder:
    def __init__(self, device, known):
        self.known, self.frames, self.lock = known, [], threading.Lock()
        self.wire = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ALL_PROTOCOLS))
        self.wire.setsockopt(socket.SOL_SOCKET, 33, BUFFER_BYTES)  # SO_RCVBUFFORCE
        self.wire.bind((device, ALL_PROTOCOLS))
        self.wire.setsockopt(263, 1, struct.pack("iHH8s", socket.if_nametoindex(device), 1, 0, b""))  # SOL_PACKET, PACKET_ADD_MEMBERSHIP: promiscuous
        self.mac = self.wire.getsockname()[4]
        self.address = known["own"]
        threading.Thread(target=self.receive_frames, daemon=True).start()

    def receive_frames(self):
        while True:
            try:
                data, sender = self.wire.recvfrom(65536)
            except OSError:
                return  # the lab ended
            if sender[2] != OUTGOING:
                with self.lock:
                    self.frames.append(data)

    def record(self):
        """Starts a new recording."""
        with self.lock:
            self.frames = []
        return {}

    def counts(self):
        """Counts of the recorded frames, and of those with readable content."""
        with self.lock:
            frames, self.frames = self.frames, []
        others = [data for data in frames if MARK not in data]
        return {"frames": len(others), "bytes": sum(map(len, others)), "messages": sum(bool(MESSAGE.search(d)) for d in others),
                "channels": sum(bool(CHANNELS.search(d)) for d in others), "texts": sum(bool(TEXTS.search(d)) for d in others)}

    def forged(self, kind, port):
        """Frames of this kind, one for each host."""
        hosts, group = self.known["hosts"], self.known["group"]
        to_group = bytes([1, 0, 0x5E, socket.inet_aton(group)[1] & 0x7F, *socket.inet_aton(group)[2:]])
        for host, other in zip(hosts, reversed(hosts)):
            mac, data = bytes.fromhex(host["mac"].replace(":", "")), marked_message(kind)
            yield {"multicast": lambda: frame(to_group, self.mac, self.address, group, port, data),
                   "multicast in a host's name": lambda: frame(to_group, self.mac, host["address"], group, port, data),
                   "multicast in the path's name": lambda: frame(to_group, self.mac, host["inside"], group, port, data),
                   "multicast to a host's card": lambda: frame(mac, self.mac, self.address, group, port, data),
                   "unicast": lambda: frame(mac, self.mac, self.address, host["address"], port, data),
                   "unicast to the path's address": lambda: frame(mac, self.mac, self.address, host["inside"], port, data),
                   "through a host into the path": lambda: frame(mac, self.mac, self.address, other["inside"], port, data),
                   "as if of the host itself": lambda: frame(mac, self.mac, "127.0.0.1", group, port, data)}[KINDS[kind]]()

    def of_path(self, kind, recorded):
        """Frames to the port of OpenVPN: recorded ones with a flipped bit, noise, a new connection, an Ethernet frame without a key."""
        host = self.known["hosts"][0]
        mac = bytes.fromhex(host["mac"].replace(":", ""))
        inner = frame(b"\xff" * 6, self.mac, host["inside"], self.known["group"], self.known["port"], marked_message(kind))
        forged = [os.urandom(random.randrange(1, 1400)), b"\x38" + os.urandom(53), b"\x48\0\0\0\0\0\0\1" + inner, b"\x30" + inner]
        for data in forged:
            yield frame(mac, self.mac, self.known["hosts"][-1]["address"], host["address"], self.known["listen"], data, random.randrange(1024, 65536))
        if recorded:
            corrupted = bytearray(random.choice(recorded))
            corrupted[random.randrange(min(42, len(corrupted) - 1), len(corrupted))] ^= 1 << random.randrange(8)
            yield bytes(corrupted)

    def forge(self, seconds):
        """Sends frames of all kinds cyclically. Returns the count of each kind."""
        count = dict.fromkeys(KINDS, 0)
        with self.lock:
            recorded = [without_checksum(d) for d in self.frames[-MAX_REPLAYED:] if d[12:14] == b"\x08\0" and d[14] == 0x45 and d[23] == 17]
        begin = time.monotonic()
        for n in itertools.count():
            kind = n % len(KINDS)
            if KINDS[kind] == "sent again":
                frames = [random.choice(recorded)] if recorded else []
            elif KINDS[kind] == "the path's packets":
                frames = list(self.of_path(kind, recorded))
            else:
                frames = list(self.forged(kind, self.known["port"] + n // len(KINDS) % 2))
            for data in frames:
                try:
                    self.wire.send(data)
                    count[KINDS[kind]] += 1
                except OSError:  # longer than the MTU: the kernel had reassembled it
                    pass
            ahead_s = sum(count.values()) / RATE_HZ - (time.monotonic() - begin)
            if ahead_s > 0:
                time.sleep(ahead_s)
            if time.monotonic() - begin > seconds:
                return count


def main(words):
    device, known = words
    with open(known, encoding="utf-8") as file:
        intruder = Intruder(device, json.load(file))
    for line in sys.stdin:
        what, *rest = line.split()
        print(json.dumps(getattr(intruder, what)(*map(float, rest))), flush=True)
