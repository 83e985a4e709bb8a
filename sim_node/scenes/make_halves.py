#!/usr/bin/python3 -I
"""Writes halves.png: a friction map whose left half is black and whose right half is white, 8 bits.

  make_halves.py > halves.png
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import struct
import zlib

COLUMNS, ROWS = 2048, 2  # a fine boundary: one pixel of 0.6 m is 0.3 mm


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def main():
    line = b"\0" + bytes(255 * (c >= COLUMNS // 2) for c in range(COLUMNS))
    sys.stdout.buffer.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", COLUMNS, ROWS, 8, 0, 0, 0, 0)) +
                            chunk(b"IDAT", zlib.compress(line * ROWS, 9)) + chunk(b"IEND", b""))


main()
