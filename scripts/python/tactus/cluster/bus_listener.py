"""Receives the bus like the programs of LCM, bound to any address, and counts forged messages; for tests/measure/measure_private_path.

  tactus --module tactus.cluster.bus_listener GROUP PORT [DEVICE_ADDRESS]     until stdin is closed; prints {kind: count} as JSON

With DEVICE_ADDRESS it also joins the group on that device, like a program that uses the open network.
"""
import json
import select
import socket
import sys

from tactus.cluster import intruder


def main(words):
    group, port = words[0], int(words[1])
    sockets = []
    for number in (port, port + 1):
        sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
        sock.bind(("", number))
        for device in ["0.0.0.0", *words[2:3]]:
            try:
                sock.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + socket.inet_aton(device))
            except OSError:
                if device == "0.0.0.0":
                    raise  # the route already leads to the other device
        sockets.append(sock)
    print("{}", flush=True)
    counts = dict.fromkeys(intruder.KINDS, 0)
    while True:
        ready = select.select([*sockets, sys.stdin], [], [])[0]
        if sys.stdin in ready:
            break
        for sock in ready:
            at = (data := sock.recv(65536)).find(intruder.MARK)
            if at >= 0:
                counts[intruder.KINDS[int(data[at + len(intruder.MARK):].split(b"\0")[0])]] += 1
    print(json.dumps(counts))
