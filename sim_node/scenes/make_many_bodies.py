#!/usr/bin/python3 -I
"""Writes many_bodies.sdf: N boxes, balls and cylinders that fall into a tray, all of one size, so that worlds of every N are
similar; a hand stirs them. The same N gives the same file.

  make_many_bodies.py [N] > many_bodies.sdf       N: 1 .. 3000, default 100
"""
import os
import sys

if __name__ == "__main__" and not sys.flags.isolated:  # started as `python3 FILE`: never imports from PYTHONPATH
    os.execv(sys.executable, [sys.executable, "-I", *sys.argv])

import math
import random

SIZE_M = 0.04
MATERIALS = (("oak", "0.66 0.43 0.20 1"), ("steel", "0.62 0.65 0.70 1"), ("rubber", "0.70 0.10 0.08 1"), ("abs", "0.12 0.30 0.75 1"),
             ("glass", "0.45 0.75 0.72 1"))
SHAPES = (f"<box><size>{SIZE_M} {SIZE_M} {SIZE_M}</size></box>", f"<sphere><radius>{SIZE_M / 2}</radius></sphere>",
          f"<cylinder><radius>{SIZE_M / 2}</radius><length>{SIZE_M}</length></cylinder>")


def model(name, pose, geometry, material, colour, static=False):
    return f"""    <model name="{name}">
{'      <static>true</static>' + chr(10) if static else ''}      <pose>{pose}</pose>
      <link name="link">
        <tactus:surface material="{material}"/>
        <collision name="shape"><geometry>{geometry}</geometry></collision>
        <visual name="shape"><geometry>{geometry}</geometry><material><diffuse>{colour}</diffuse></material></visual>
      </link>
    </model>
"""


def box(x, y, z):
    return f"<box><size>{x:.4g} {y:.4g} {z:.4g}</size></box>"


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    if not 1 <= count <= 3000:
        sys.exit("make_many_bodies.py: N must be between 1 and 3000")
    numbers = random.Random(count)
    side = max(3, math.ceil(math.sqrt(count / 3)))  # three layers when all lie at rest
    pitch, half = 1.6 * SIZE_M, 0.8 * SIZE_M * side + 0.02
    far, up = 2.6 * half, 2.2 * half
    print(f"""<?xml version="1.0"?>
<!-- Written by make_many_bodies.py {count}: a tray of {count} bodies, and a hand that stirs them. -->
<sdf version="1.9" xmlns:tactus="https://tactus.dev/sdf">
  <world name="many_bodies">
    <gravity>0 0 -9.81</gravity>
    <scene><ambient>0.12 0.12 0.14 1</ambient><background>0.02 0.02 0.03 1</background></scene>
    <light name="lamp" type="directional">
      <pose>0 0 5 0 0 0</pose>
      <diffuse>0.9 0.86 0.78 1</diffuse>
      <specular>0.3 0.3 0.3 1</specular>
      <direction>0.4 0.25 -1</direction>
      <cast_shadows>true</cast_shadows>
    </light>
    <tactus:sim_node groups="dual"/>
    <tactus:camera position="{-far:.3f} {-0.5 * far:.3f} {up:.3f}" look_at="0 0 0" fov="50deg"/>""")
    wall, high = 0.02, 0.16
    colour = "0.45 0.40 0.34 1"
    parts = [("floor", f"0 0 {-wall / 2} 0 0 0", box(2 * half, 2 * half, wall))]
    for name, x, y in (("near", -1, 0), ("far", 1, 0), ("right", 0, -1), ("left", 0, 1)):
        size = box(wall, 2 * half + 2 * wall, high) if x else box(2 * half, wall, high)
        parts.append((name, f"{x * (half + wall / 2):.4f} {y * (half + wall / 2):.4f} {high / 2 - wall:.4f} 0 0 0", size))
    for name, pose, geometry in parts:
        sys.stdout.write(model(name, pose, geometry, "oak", colour, True))
    for i in range(count):
        layer, place = divmod(i, side * side)
        row, column = divmod(place, side)
        x, y = ((k - (side - 1) / 2) * pitch + numbers.uniform(-0.004, 0.004) for k in (row, column))
        z = 0.05 + 1.6 * SIZE_M * layer
        material, colour = MATERIALS[numbers.randrange(len(MATERIALS))]
        turned = " ".join(f"{numbers.uniform(-0.6, 0.6):.3f}" for _ in range(3))
        sys.stdout.write(model(f"body_{i}", f"{x:.4f} {y:.4f} {z:.4f} {turned}", SHAPES[i % 3], material, colour))
    reach = 0.6 * half
    print(f"""    <tactus:tool name="hand" radius="12mm" mass="0.2kg" material="skin" device="virtual_hand" loop="true">
      <tactus:waypoint time="0s" position="{-reach:.3f} 0 0.3"/>
      <tactus:waypoint time="1s" position="{-reach:.3f} 0 0.05"/>
      <tactus:waypoint time="3s" position="{reach:.3f} 0 0.05"/>
      <tactus:waypoint time="4s" position="{reach:.3f} 0 0.3"/>
      <tactus:waypoint time="6s" position="{-reach:.3f} 0 0.3"/>
    </tactus:tool>
  </world>
</sdf>""")


main()
