"""Valid meshes in several formats, and mutators of their corners and faces, or of the bytes of their files."""
import base64
import itertools
import json
import math
import struct

FORMATS = ("obj", "stl", "binary.stl", "ply", "gltf", "dae")


def cube(size=0.1):
    """(corners, triangles) of a cube around the origin; normals point outwards."""
    corners = [[size * (c - 0.5) for c in corner] for corner in itertools.product((0, 1), repeat=3)]  # index 4 x + 2 y + z
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, [triangle for a, b, c, d in faces for triangle in ((a, b, c), (a, c, d))]


def prism(sides=5, radius=0.06, height=0.08):
    """(corners, triangles) of a regular prism."""
    ring = [(radius * math.cos(2 * math.pi * i / sides), radius * math.sin(2 * math.pi * i / sides)) for i in range(sides)]
    corners = [[x, y, z] for z in (-height / 2, height / 2) for x, y in ring]
    triangles = []
    for i in range(sides):
        k = (i + 1) % sides
        triangles += [(i, k, sides + k), (i, sides + k, sides + i)]
        if 0 < i < sides - 1:
            triangles += [(0, i + 1, i), (sides, sides + i, sides + i + 1)]
    return corners, triangles


def tetrahedron(size=0.1):
    return [[0, 0, 0], [size, 0, 0], [0, size, 0], [0, 0, size]], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


SHAPES = (cube, prism, tetrahedron)


def moved(corners, offset):
    return [[c + o for c, o in zip(corner, offset)] for corner in corners]


def joined(first, second):
    """Both shells in one mesh."""
    n = len(first[0])
    return first[0] + second[0], first[1] + [tuple(i + n for i in triangle) for triangle in second[1]]


def wrong_size(corners, triangles, draw):
    axis, factor = draw.randrange(3), draw.choice((0, 1e-9, -1, 1e3))
    return [[c * (factor if i == axis else 1) for i, c in enumerate(corner)] for corner in corners], triangles


def swapped_axes(corners, triangles, draw):
    order = draw.sample(range(3), 3)
    return [[corner[i] for i in order] for corner in corners], triangles


def touching(corners, triangles, draw):
    width = max(corner[0] for corner in corners) - min(corner[0] for corner in corners)
    return joined((corners, triangles), (moved(corners, (width, 0, 0)), triangles))


def overlapping(corners, triangles, draw):
    return joined((corners, triangles), (moved(corners, [draw.uniform(-0.05, 0.05) for _ in range(3)]), triangles))


def duplicated(corners, triangles, draw):
    if draw.random() < 0.5:
        return corners, triangles + draw.sample(triangles, draw.randint(1, len(triangles)))
    return joined((corners, triangles), (corners, triangles))


def scaled(corners, triangles, factor):
    return [[c * factor for c in corner] for corner in corners], triangles


def huge(corners, triangles, draw):
    return scaled(corners, triangles, draw.choice((1e2, 1e4, 1e8, 1e15, 1e25, 1e38)))


def tiny(corners, triangles, draw):
    return scaled(corners, triangles, draw.choice((1e-2, 1e-4, 1e-6, 1e-12, 1e-30, 1e-45)))


def far(corners, triangles, draw):
    return moved(corners, [draw.choice((-1, 0, 1)) * draw.choice((1e2, 1e5, 1e8, 1e20)) for _ in range(3)]), triangles


def empty(corners, triangles, draw):
    return draw.choice((([], []), (corners, []), (corners[:2], []), (corners, triangles[:1])))


def wrong_unit(corners, triangles, draw):
    return scaled(corners, triangles, draw.choice((1e3, 25.4, 39.37, 1e-3)))


def not_a_number(corners, triangles, draw):
    changed = [list(corner) for corner in corners]
    changed[draw.randrange(len(changed))][draw.randrange(3)] = draw.choice((math.nan, math.inf, -math.inf))
    return changed, triangles


def opened(corners, triangles, draw):
    return corners, draw.sample(triangles, draw.randint(1, len(triangles) - 1))


def inside_out(corners, triangles, draw):
    turned = set(draw.sample(range(len(triangles)), draw.randint(1, len(triangles))))
    return corners, [t[::-1] if i in turned else t for i, t in enumerate(triangles)]


def wrong_index(corners, triangles, draw):
    at = draw.randrange(len(triangles))
    return corners, triangles[:at] + [(0, 1, draw.choice((len(corners), 10**6, 2**31 - 1)))] + triangles[at + 1:]


SHAPE_KINDS = {
    "wrong size": wrong_size, "swapped axes": swapped_axes, "touching": touching, "overlapping": overlapping, "duplicated": duplicated, "huge": huge,
    "tiny": tiny, "far": far, "empty": empty, "wrong unit": wrong_unit, "not a number": not_a_number, "open": opened, "inside out": inside_out,
    "wrong index": wrong_index,
}
KINDS = (*SHAPE_KINDS, "truncated", "bytes")
WITHOUT_VOLUME = ("open",)


def number(value):
    return f"{value:.9g}"


def single(value):
    """The value as a float of 32 bits; beyond its range, infinity."""
    try:
        return struct.pack("<f", value)
    except OverflowError:
        return struct.pack("<f", math.copysign(math.inf, value))


def written(corners, triangles, form):
    """The bytes of a file of this format."""
    words = [" ".join(number(c) for c in corner) for corner in corners]
    corner = lambda i: corners[i] if i < len(corners) else [0.0, 0.0, 0.0]
    if form == "obj":
        return "".join([f"v {word}\n" for word in words] + [f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles]).encode()
    if form == "stl":
        facets = ["facet normal 0 0 0\nouter loop\n" + "".join("vertex " + " ".join(number(c) for c in corner(i)) + "\n" for i in t) + "endloop\nendfacet\n"
                  for t in triangles]
        return ("solid s\n" + "".join(facets) + "endsolid s\n").encode()
    if form == "binary.stl":
        facets = [bytes(12) + b"".join(single(c) for i in t for c in corner(i)) + bytes(2) for t in triangles]
        return bytes(80) + struct.pack("<I", len(triangles)) + b"".join(facets)
    if form == "ply":
        head = f"ply\nformat ascii 1.0\nelement vertex {len(corners)}\nproperty float x\nproperty float y\nproperty float z\n" \
               f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
        return (head + "".join(word + "\n" for word in words) + "".join("3 {} {} {}\n".format(*t) for t in triangles)).encode()
    if form == "gltf":
        places = b"".join(single(c) for corner_ in corners for c in corner_)
        indices = b"".join(struct.pack("<I", i & 0xFFFFFFFF) for t in triangles for i in t)
        uri = "data:application/octet-stream;base64," + base64.b64encode(places + indices).decode()
        finite = [[c if math.isfinite(c) else 0 for c in corner_] for corner_ in corners] or [[0, 0, 0]]
        return json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(corners), "type": "VEC3", "min": [min(c) for c in zip(*finite)],
                           "max": [max(c) for c in zip(*finite)]},
                          {"bufferView": 1, "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(places)}, {"buffer": 0, "byteOffset": len(places), "byteLength": len(indices)}],
            "buffers": [{"byteLength": len(places) + len(indices), "uri": uri}]}).encode()
    values, order = " ".join(words), " ".join(str(i) for t in triangles for i in t)
    return f"""<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="1"/></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="{3 * len(corners)}">{values}</float_array><technique_common>
<accessor source="#a" count="{len(corners)}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="{len(triangles)}">
<input semantic="VERTEX" source="#v" offset="0"/><p>{order}</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>
<visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene>
<instance_visual_scene url="#s"/></scene></COLLADA>
""".encode()


def mutated(kind, form, draw):
    """The bytes of a mesh of a random shape in this format, with one change of this kind."""
    corners, triangles = draw.choice(SHAPES)()
    if kind in SHAPE_KINDS:
        return written(*SHAPE_KINDS[kind](corners, triangles, draw), form)
    data = bytearray(written(corners, triangles, form))
    if kind == "truncated":
        return bytes(data[:draw.randrange(len(data))])
    for _ in range(draw.randint(1, 4)):
        data[draw.randrange(len(data))] = draw.randrange(256)
    return bytes(data)
