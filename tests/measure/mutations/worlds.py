"""Mutators of scenes. Each gets the root element of a valid scene and a generator, and changes the element."""
import copy
import xml.etree.ElementTree as ET

NAMESPACE = "https://tactus.dev/sdf"
ET.register_namespace("tactus", NAMESPACE)
SIZES = ("size", "radius", "length")
NOT_NUMBERS = ("nan", "inf", "-inf", "1e999", "-1e999", "0x10", "--1", "1,5", "", "five", "1.2.3")
UNITS = ("mm", " m", "kg", "%", "m/s", " inch")
# Elements of SDF whose numbers have an effect: a text in them that is no number must be refused or reported.
MEASURES = ("size", "radius", "length", "mass", "pose", "gravity", "xyz", "lower", "upper", "ixx", "iyy", "izz", "damping")


def numbers_of(element):
    """The text of an element as floats; empty when it has other text."""
    try:
        return [float(word) for word in (element.text or "").split()]
    except ValueError:
        return []


def write_numbers(element, values):
    element.text = " ".join(f"{value:.9g}" for value in values)


def all_of(root, *names):
    return [e for e in root.iter() if e.tag in names and numbers_of(e)]


def models_of(root):
    """[(parent, model)] of all models that are not static and have a collision."""
    return [(parent, model) for parent in root.iter() for model in parent.findall("model")
            if model.findtext("static", "false").strip() not in ("true", "1") and model.find(".//collision") is not None]


def pose_of(element):
    """The pose element of a model, made when it is missing."""
    pose = element.find("pose")
    if pose is None:
        pose = ET.Element("pose")
        pose.text = "0 0 0 0 0 0"
        element.insert(0, pose)
    return pose


def extent_of(model):
    """Size of the first shape along x, y, z, m."""
    for shape in model.iter("geometry"):
        box, radius, length = shape.find("box/size"), shape.find(".//radius"), shape.find(".//length")
        if box is not None and len(numbers_of(box)) == 3:
            return numbers_of(box)
        if radius is not None and numbers_of(radius):
            width = 2 * numbers_of(radius)[0]
            return [width, width, numbers_of(length)[0] if length is not None and numbers_of(length) else width]
    return [0.1, 0.1, 0.1]


def wrong_size(root, draw):
    element = draw.choice(all_of(root, *SIZES))
    values = numbers_of(element)
    values[draw.randrange(len(values))] *= draw.choice((0, -1, -1e-3, 1e-2, 100))
    write_numbers(element, values if draw.random() < 0.8 else values[:-1] + values)


def swapped_axes(root, draw):
    element = draw.choice([e for e in all_of(root, "size", "pose", "gravity", "xyz", "normal") if len(numbers_of(e)) >= 3])
    values = numbers_of(element)
    first = values[:3]
    draw.shuffle(first)
    write_numbers(element, first + values[3:])


def with_copy(root, draw, gap, name=None):
    """Puts a copy of a random model beside it: gap is the distance of their boxes in parts of the size; negative: overlap."""
    parent, model = draw.choice(models_of(root))
    other = copy.deepcopy(model)
    other.set("name", f"{model.get('name')}_copy" if name is None else name(model))
    values = (numbers_of(pose_of(other)) + [0.0] * 6)[:6]
    axis = draw.randrange(3)
    values[axis] += draw.choice((-1, 1)) * extent_of(model)[axis] * (1 + gap)
    write_numbers(pose_of(other), values)
    parent.insert(list(parent).index(model) + 1, other)


def touching(root, draw):
    with_copy(root, draw, 0)


def overlapping(root, draw):
    with_copy(root, draw, -draw.choice((1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.5, 0.9)))


def duplicated(root, draw):
    same_name = draw.random() < 0.3
    with_copy(root, draw, -1, (lambda model: model.get("name")) if same_name else None)


def scaled(root, draw, factors):
    factor = draw.choice(factors)
    elements = all_of(root, *SIZES)
    for element in elements if draw.random() < 0.5 else [draw.choice(elements)]:
        write_numbers(element, [value * factor for value in numbers_of(element)])
    for element in all_of(root, "mass") if draw.random() < 0.3 else []:
        write_numbers(element, [value * factor for value in numbers_of(element)])


def huge(root, draw):
    scaled(root, draw, (1e2, 1e4, 1e6, 1e9, 1e20, 1e300))


def tiny(root, draw):
    scaled(root, draw, (1e-2, 1e-4, 1e-6, 1e-9, 1e-30, 1e-300))


def far(root, draw):
    offset = [draw.choice((0, 1, -1)) * draw.choice((1e3, 3e5, 1e7, 1e12, 1e100)) for _ in range(3)]
    models = [model for parent in root.iter() for model in parent.findall("model")]
    for model in models if draw.random() < 0.5 else [draw.choice(models)]:
        values = (numbers_of(pose_of(model)) + [0.0] * 6)[:6]
        write_numbers(pose_of(model), [a + b for a, b in zip(values, offset + [0, 0, 0])])


def emptied(root, draw):
    element = draw.choice([e for e in root.iter() if len(e) or e.text])
    for child in list(element):
        element.remove(child)
    element.text = ""


def wrong_unit(root, draw):
    element = draw.choice(all_of(root, *MEASURES))
    element.text += draw.choice(UNITS)


def not_a_number(root, draw):
    element = draw.choice(all_of(root, *MEASURES))
    words = element.text.split()
    words[draw.randrange(len(words))] = draw.choice(NOT_NUMBERS)
    element.text = " ".join(words)


def wrong_attribute(root, draw):
    element = draw.choice([e for e in root.iter() if e.attrib])
    name = draw.choice(sorted(element.attrib))
    element.set(name, draw.choice((*NOT_NUMBERS, "-1", "1e30", "5kg", element.get(name) + "mm", element.get(name) * 2, "\u2603")))


def rearranged(root, draw):
    parent = draw.choice([e for e in root.iter() if len(e) >= 2])
    child = draw.choice(list(parent))
    how = draw.choice(("remove", "twice", "elsewhere"))
    if how != "twice":
        parent.remove(child)
    if how != "remove":
        target = parent if how == "twice" else draw.choice([e for e in root.iter() if e is not child and e not in child.iter()])
        target.append(copy.deepcopy(child))


TREE_KINDS = {
    "wrong size": wrong_size, "swapped axes": swapped_axes, "touching": touching, "overlapping": overlapping, "duplicated": duplicated, "huge": huge,
    "tiny": tiny, "far": far, "empty": emptied, "wrong unit": wrong_unit, "not a number": not_a_number, "wrong attribute": wrong_attribute,
    "rearranged": rearranged,
}
KINDS = (*TREE_KINDS, "truncated", "bytes")
NEVER_SILENT = ("wrong unit", "not a number")  # no scene holds such a text rightly


def mutated(text, kind, draw):
    """The bytes of a scene with one change of this kind. text: bytes of a valid scene."""
    if kind == "truncated":
        return text[:draw.randrange(len(text))]
    if kind == "bytes":
        data = bytearray(text)
        for _ in range(draw.randint(1, 4)):
            data[draw.randrange(len(data))] = draw.randrange(256)
        return bytes(data)
    root = ET.fromstring(text)
    TREE_KINDS[kind](root, draw)
    return ET.tostring(root, encoding="utf-8", xml_declaration=True)
