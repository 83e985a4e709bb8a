"""Converts a geometry file to glTF with material, relief, friction, modes and appearance of the object."""
from tactus.commands import prepare

USAGE = """Usage: tactus convert IN OUT.glb|OUT.gltf [--material NAME] [--bump FILE.png --bump-size "U V" --bump-height H]
         [--friction-map FILE.png --friction-size "U V" --friction-factors "BLACK WHITE"] [--modes FILE.csv]
         [--shader NAME] [--colour-map FILE] [--normal-map FILE.png] [--reflectance R] [--uniforms "NAME N...; ..."] [--force]

Reads OBJ, STL, PLY, 3DS, DAE, glTF and the other formats of assimp, and writes glTF 2.0 with normals, tangents, texture
coordinates and links to pictures. Its "extras" hold the values of the options: material, surface relief, friction map,
measured modes, shader and appearance. A scene uses them as defaults for attributes that it does not set
(docs/scene_format.md). The file is read back and compared bit by bit before it is put in place.
  --force   overwrites an existing OUT"""


def main(words):
    if {"--help", "-h"} & set(words):
        return prepare.print_usage(USAGE)
    prepare.replace_process([prepare.program("convert_geometry"), *words])
