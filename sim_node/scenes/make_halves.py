#!/usr/bin/env python3
"""Writes halves.png: a friction map whose left half is black and whose right half is white, 8 bits.

  make_halves.py > halves.png
"""
import struct
import sys
import zlib

SIDE_PX = 256


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def main():
    line = b"\0" + bytes(255 * (c >= SIDE_PX // 2) for c in range(SIDE_PX))
    sys.stdout.buffer.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", SIDE_PX, SIDE_PX, 8, 0, 0, 0, 0)) +
                            chunk(b"IDAT", zlib.compress(line * SIDE_PX, 9)) + chunk(b"IEND", b""))


main()
