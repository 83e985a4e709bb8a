#!/usr/bin/python3 -I
"""Writes bowl.obj: half a hollow sphere, 60 mm in radius and 3 mm thick, standing on a small flat foot; z up, metres.

  make_bowl.py > bowl.obj
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import math

OUTER_M, WALL_M = 0.060, 0.003
AROUND, DOWN = 40, 10
FOOT = 0.30  # of the way from the bottom to the rim the sphere is cut off flat, as an angle in rad


def rings(radius, angles):
    """From the foot up: the bowl opens upwards, its foot at z = 0."""
    bottom = OUTER_M * math.cos(FOOT)
    return [[(radius * math.sin(a) * math.cos(2 * math.pi * i / AROUND), radius * math.sin(a) * math.sin(2 * math.pi * i / AROUND),
              bottom - radius * math.cos(a)) for i in range(AROUND)] for a in angles]


def main():
    angles = [FOOT + (math.pi / 2 - FOOT) * k / DOWN for k in range(DOWN + 1)]
    outside, inside = rings(OUTER_M, angles), rings(OUTER_M - WALL_M, reversed(angles))
    bottom, floor = (0.0, 0.0, 0.0), (0.0, 0.0, inside[-1][0][2])
    order = outside + inside  # up the outside, over the rim, down the inside
    vertices = [v for ring in order for v in ring] + [bottom, floor]
    print("# Written by make_bowl.py\no bowl")
    for v in vertices:
        print("v %.6f %.6f %.6f" % v)

    def at(ring, i):
        return 1 + ring * AROUND + i % AROUND

    last = len(order) - 1
    for i in range(AROUND):
        for ring in range(last):
            print("f", at(ring, i), at(ring, i + 1), at(ring + 1, i + 1))
            print("f", at(ring, i), at(ring + 1, i + 1), at(ring + 1, i))
        print("f", at(0, i + 1), at(0, i), len(vertices) - 1)
        print("f", at(last, i), at(last, i + 1), len(vertices))


main()
