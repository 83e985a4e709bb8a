#!/usr/bin/python3 -I
"""Writes peg.obj and hole_plate.obj beside itself: a round peg with a chamfer, and a square plate with a round hole through
it, 0.5 mm wider than the peg all around; z up, metres.
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import math

PEG_RADIUS_M, PEG_LENGTH_M, CHAMFER_M = 0.0145, 0.080, 0.002
HOLE_RADIUS_M, PLATE_M, THICK_M = 0.015, 0.120, 0.030
AROUND = 48  # a multiple of 8, so that plate corners are vertices


def ring(radius, z):
    return [(radius * math.cos(2 * math.pi * i / AROUND), radius * math.sin(2 * math.pi * i / AROUND), z) for i in range(AROUND)]


def square(z):
    """The rim of the plate, seen from its middle in the same directions as a ring."""
    out = []
    for x, y, _ in ring(1, z):
        scale = PLATE_M / 2 / max(abs(x), abs(y))
        out.append((x * scale, y * scale, z))
    return out


def band(lower, upper, faces):
    """Faces between two rings of indices; outside is on the right of lower, seen towards upper from outside."""
    for i in range(AROUND):
        j = (i + 1) % AROUND
        faces += [(lower[i], lower[j], upper[j]), (lower[i], upper[j], upper[i])]


def write(name, rings, order, caps):
    """rings: lists of points; order: pairs of rings that a band joins; caps: (ring, point, upwards)."""
    here = os.path.dirname(os.path.abspath(__file__))
    vertices, faces, at = [], [], []
    for points in rings:
        at.append(list(range(len(vertices) + 1, len(vertices) + 1 + len(points))))
        vertices += points
    for lower, upper in order:
        band(at[lower], at[upper], faces)
    for which, point, upwards in caps:
        vertices.append(point)
        centre = len(vertices)
        for i in range(AROUND):
            a, b = at[which][i], at[which][(i + 1) % AROUND]
            faces.append((a, b, centre) if upwards else (b, a, centre))
    with open(os.path.join(here, name), "w", encoding="utf-8") as file:
        file.write(f"# Written by make_peg_in_hole.py\no {name[:-4]}\n")
        file.writelines("v %.6f %.6f %.6f\n" % v for v in vertices)
        file.writelines("f %d %d %d\n" % f for f in faces)


def main():
    half = PEG_LENGTH_M / 2
    peg = [ring(PEG_RADIUS_M - CHAMFER_M, -half), ring(PEG_RADIUS_M, -half + CHAMFER_M), ring(PEG_RADIUS_M, half)]
    write("peg.obj", peg, [(0, 1), (1, 2)], [(0, (0, 0, -half), False), (2, (0, 0, half), True)])
    low, high = -THICK_M, 0.0
    # outside below, outside above, hole above (widened as a funnel), hole, hole below
    plate = [square(low), square(high), ring(HOLE_RADIUS_M + CHAMFER_M, high), ring(HOLE_RADIUS_M, high - CHAMFER_M),
             ring(HOLE_RADIUS_M, low)]
    write("hole_plate.obj", plate, [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0)], [])


main()
