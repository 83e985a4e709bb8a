"""Makes a glTF file of a geometry file, with what touch, sound and sight know of the object in it."""
from tactus.commands import prepare

USAGE = """Usage: tactus convert-geometry IN OUT.glb|OUT.gltf [--material NAME] [--bump FILE.png --bump-size "U V" --bump-height H]
         [--friction-map FILE.png --friction-size "U V" --friction-factors "BLACK WHITE"] [--modes FILE.csv]
         [--shader NAME] [--colour-map FILE] [--normal-map FILE.png] [--reflectance R] [--uniforms "NAME N...; ..."] [--force]

Reads OBJ, STL, PLY, 3DS, DAE, glTF and whatever else assimp reads, and writes glTF 2.0 with normals, tangents, texture
coordinates and links to pictures; and in its "extras" what the options say: what it is made of, its relief and friction, the
modes it was measured to have, how it is drawn. A scene that loads it takes from it what it does not say itself
(docs/scene_format.md). Read back, the file is the same to the bit; that is checked before it is put in place.
  --force   writes over OUT when it is there"""


def main(words):
    if {"--help", "-h"} & set(words):
        return prepare.show(USAGE)
    prepare.become([prepare.program("convert_geometry"), *words])
