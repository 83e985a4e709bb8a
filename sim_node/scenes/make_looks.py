#!/usr/bin/python3 -I
"""Writes the files of looks_bench.sdf: a ball with texture coordinates whose material names its pictures (tiled_ball.obj, .mtl),
the same ball without pictures (plain_ball.obj), tiles in colour (tiles.png), their normals (tiles_normal.png) and a room with
windows as the environment (room.png).

  make_looks.py FOLDER
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import math
import struct
import zlib

SIDE = 128  # of the tiles, pixels; four tiles a side
AROUND, UP = 32, 16  # of the ball
RADIUS_M = 0.05


def png(rows):
    """rows: of (r, g, b), the top one first."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    lines = b"".join(b"\0" + bytes(v for pixel in row for v in pixel) for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))


def in_tile(i):
    """-1 .. 1 across the tile of pixel i."""
    size = SIDE // 4
    return (i % size + 0.5) / size * 2 - 1


def tiles():
    def colour(x, y):
        if max(abs(in_tile(x)), abs(in_tile(y))) > 0.88:
            return (90, 84, 78)  # grout
        return (176, 92, 58) if (x * 4 // SIDE + y * 4 // SIDE) % 2 else (222, 196, 150)
    return [[colour(x, y) for x in range(SIDE)] for y in range(SIDE)]


def slope(t):
    """Slope of a pillow: flat in the middle, steep towards its edge."""
    return -2.4 * t ** 5


def normals():
    def direction(x, y):
        # Green points up in the picture (glTF 2.0, 3.9.3); rows count from its top.
        n = (-slope(in_tile(x)), slope(in_tile(y)), 1.0)
        length = math.sqrt(sum(c * c for c in n))
        return tuple(round((c / length + 1) * 127.5) for c in n)
    return [[direction(x, y) for x in range(SIDE)] for y in range(SIDE)]


def room():
    """Twice as wide as high, as scene_t.lcm requires: dark walls, a floor, a bright ceiling lamp and windows."""
    wide, high = 256, 128
    def colour(x, y):
        elevation = 90 - (y + 0.5) / high * 180  # degrees
        azimuth = (x + 0.5) / wide * 360
        if elevation > 75:
            return (255, 250, 235)
        if elevation < -25:
            return (70, 58, 46) if (int(azimuth) // 15 + int(elevation) // 13) % 2 else (58, 48, 38)
        if 5 < elevation < 40 and azimuth % 90 > 60 and abs(azimuth % 15 - 7.5) < 6.5 and abs(elevation - 22.5) > 1:
            return (190, 215, 245)
        shade = 40 + int(elevation * 0.3)
        return (shade, shade, shade + 6)
    return [[colour(x, y) for x in range(wide)] for y in range(high)]


def ball(head):
    """A sphere of rings and columns; the picture is repeated around it, upright."""
    lines = head
    for r in range(UP + 1):
        polar = math.pi * r / UP
        for c in range(AROUND + 1):
            a = 2 * math.pi * c / AROUND
            n = (math.sin(polar) * math.cos(a), math.sin(polar) * math.sin(a), math.cos(polar))
            lines.append("v " + " ".join(f"{RADIUS_M * v:.6f}" for v in n))
            lines.append("vt " + f"{2 * c / AROUND:.5f} {1 - r / UP:.5f}")
            lines.append("vn " + " ".join(f"{v:.5f}" for v in n))
    for r in range(UP):
        for c in range(AROUND):
            a = r * (AROUND + 1) + c + 1
            b = a + AROUND + 1
            corners = [[a, b, b + 1], [a, b + 1, a + 1]]
            if r == 0:
                corners = corners[:1]
            if r == UP - 1:
                corners = corners[1:]
            lines += ["f " + " ".join(f"{v}/{v}/{v}" for v in t) for t in corners]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 2 or not os.path.isdir(sys.argv[1]):
        sys.exit(__doc__)
    def write(name, data):
        with open(os.path.join(sys.argv[1], name), "wb") as file:
            file.write(data)
    write("tiles.png", png(tiles()))
    write("tiles_normal.png", png(normals()))
    write("room.png", png(room()))
    write("tiled_ball.obj", ball(["mtllib tiled_ball.mtl", "usemtl tiles"]).encode())
    write("plain_ball.obj", ball([]).encode())
    write("tiled_ball.mtl", b"newmtl tiles\nKd 1 1 1\nKs 0.3 0.3 0.3\nNs 40\nmap_Kd tiles.png\nnorm tiles_normal.png\n")


main()
