#!/usr/bin/python3 -I
"""Writes bumpy_sphere.obj: a ball of 60 mm radius with bumps of 3 mm, z up, 2784 triangles.

  make_bumpy_sphere.py > bumpy_sphere.obj
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import math

RADIUS_M, BUMP_M = 0.060, 0.003
AROUND, DOWN = 48, 30  # vertices per ring; rings of faces between the poles
WAVES_AROUND, WAVES_DOWN = 6, 10


def point(theta, phi):
    """theta from the north pole, phi around z. The bumps fade towards the poles, where all phi meet."""
    r = RADIUS_M + BUMP_M * math.sin(theta) * math.sin(WAVES_DOWN * theta) * math.cos(WAVES_AROUND * phi)
    return (r * math.sin(theta) * math.cos(phi), r * math.sin(theta) * math.sin(phi), r * math.cos(theta))


def main():
    print("# Written by make_bumpy_sphere.py\no bumpy_sphere")
    vertices = [point(0, 0)]
    for ring in range(1, DOWN):
        vertices += [point(math.pi * ring / DOWN, 2 * math.pi * i / AROUND) for i in range(AROUND)]
    vertices.append(point(math.pi, 0))
    for v in vertices:
        print("v %.6f %.6f %.6f" % v)

    def at(ring, i):
        return 2 + (ring - 1) * AROUND + i % AROUND

    for i in range(AROUND):
        print("f", 1, at(1, i), at(1, i + 1))
        for ring in range(1, DOWN - 1):
            print("f", at(ring, i), at(ring + 1, i), at(ring + 1, i + 1))
            print("f", at(ring, i), at(ring + 1, i + 1), at(ring, i + 1))
        print("f", at(DOWN - 1, i), len(vertices), at(DOWN - 1, i + 1))


main()
