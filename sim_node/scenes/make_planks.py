#!/usr/bin/python3 -I
"""Writes planks.png: the height map of four boards, drawn as 0.4 m by 0.4 m, white 2 mm over black, 16 bits; a scene may scale it.

  make_planks.py > planks.png

Four boards run along u. Their edges are rounded and reflect the light; the grain consists of slightly irregular waves along the boards.
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import math
import struct
import zlib

SIDE_PX, SIDE_MM = 256, 400
BOARD_MM, BOARDS = 100, 4
EDGE_MM = 14  # width of the rounding at an edge of a board
GRAIN = 0.12  # fraction of the height used by the grain
JOINTS_MM = (60, 260, 160, 340)  # position of the end of each board


def rounded(distance_mm):
    """0 at an edge, 1 from EDGE_MM on, with a slope that begins steep and ends flat."""
    t = min(1.0, distance_mm / EDGE_MM)
    return 1 - (1 - t) ** 2


def grain(board, u_mm, across_mm):
    """-1 .. 1. Whole numbers of waves along u, so that the picture repeats without a seam."""
    turn = 2 * math.pi * u_mm / SIDE_MM
    wander = 2.2 * math.sin(turn + 1.7 * board) + 1.1 * math.sin(2 * turn + 2.9 * board)
    across = 2 * math.pi * (across_mm + wander)
    return 0.6 * math.sin(across / 14 + board) + 0.4 * math.sin(across / 9 + 2.3 * board)


def height(u_mm, v_mm):
    """0 .. 1."""
    board, across_mm = int(v_mm // BOARD_MM) % BOARDS, v_mm % BOARD_MM
    to_side = min(across_mm, BOARD_MM - across_mm)
    to_end = abs((u_mm - JOINTS_MM[board] + SIDE_MM / 2) % SIDE_MM - SIDE_MM / 2)
    return rounded(min(to_side, to_end)) * (1 - GRAIN / 2 + GRAIN / 2 * grain(board, u_mm, across_mm))


def level(u_mm, v_mm):
    """In steps of 1/4095: 0.5 um are below the resolution of a finger, and the file is half as large."""
    return 65535 * round(4095 * height(u_mm, v_mm)) // 4095


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def main():
    rows = bytearray()
    before = bytes(2 * SIDE_PX)
    for row in range(SIDE_PX):  # from the top, where v is largest
        v_mm = (SIDE_PX - row - 0.5) * SIDE_MM / SIDE_PX
        line = b"".join(struct.pack(">H", level((c + 0.5) * SIDE_MM / SIDE_PX, v_mm)) for c in range(SIDE_PX))
        rows += b"\2" + bytes((a - b) & 255 for a, b in zip(line, before))  # filter "up"
        before = line
    sys.stdout.buffer.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", SIDE_PX, SIDE_PX, 16, 0, 0, 0, 0)) +
                            chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


main()
