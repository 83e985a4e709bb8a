"""The task file: the scene, the hidden variable, its values and variants, and the windows of perception."""
import dataclasses
import pathlib
import re

from tactus import own_files, own_xml
from tactus.paths import SCENES
from tactus.refusal import Refusal

SHIPPED = SCENES / "tasks"
SUFFIX = ".task.xml"
MAX_RENDERINGS = 10_000
SHORTEST_WINDOW_S = 0.01  # ten ticks of touch; design
LOOK_S = 0.25             # between two looks: pictures.LOOKS_HZ
LARGEST_SCENE_BYTES = 20_000_000  # design
SENSES = ("visual", "audio", "haptic", "thermal")
NAMESPACES = {"tactus": "https://tactus.dev/sdf"}
SECONDS = {"ms": 1e-3, "s": 1.0}
CHILDREN = {"task": ("question", "value", "variant", "window"), "value": ("set",), "variant": ("set",), "question": (), "window": (), "set": ()}
NEEDED = {"task": ("scene", "sense", "seconds"), "value": ("name",), "variant": (), "question": (), "window": ("from", "to"), "set": ("at", "to")}


@dataclasses.dataclass(frozen=True)
class Change:
    """Sets the text of an element of the scene's world, or with a path that ends in /@NAME an attribute. where: file and line, for messages."""
    at: str
    to: str
    where: str


@dataclasses.dataclass(frozen=True)
class Task:
    name: str
    scene: pathlib.Path
    senses: tuple       # the senses that the task is for
    seconds: float      # of the world
    question: str
    values: dict        # {name of a value: changes of the scene}
    variants: tuple     # changes of each variant, the same for all values
    windows: tuple      # (from, to) s of the world; each is perceived for itself


def find(text):
    """Path of a task file; `text` is a path, or the name of a shipped task."""
    path = pathlib.Path(text)
    shipped = SHIPPED / (text + SUFFIX)
    return shipped if path.name == text and not path.is_file() and shipped.is_file() else path


def shipped():
    """Names of the shipped tasks."""
    return sorted(p.name.removesuffix(SUFFIX) for p in SHIPPED.glob("*" + SUFFIX))


def read(text):
    """Task of a file, or of the shipped task of that name. Raises Refusal with the line."""
    path = find(text)
    root, _ = own_xml.root_of(path, text, "a task file", shipped())
    return Reading(text, path, root).task()


class Reading:
    def __init__(self, text, path, root):
        self.text, self.path, self.root = text, path, root

    def refuse(self, element, reason):
        raise Refusal(f"{self.text}:{element.sourceline}: {reason}")

    def check(self, element, kind):
        """Refuses unknown and missing elements and attributes, here and below."""
        if element.tag != kind:
            self.refuse(element, f"<{element.tag}> is not an element of a task file here; write <{kind}>")
        for name in NEEDED[kind]:
            if name not in element.attrib:
                self.refuse(element, f"<{kind}> needs the attribute {name}")
        for name in element.attrib:
            if name not in NEEDED[kind]:
                self.refuse(element, f"<{kind}> has no attribute {name}" + (f"; it has {', '.join(NEEDED[kind])}" if NEEDED[kind] else ""))
        for child in element:
            if child.tag not in CHILDREN[kind]:
                self.refuse(child, f"<{child.tag}> is not an element of <{kind}>" + (f"; write {', '.join(CHILDREN[kind])}" if CHILDREN[kind] else ""))
            self.check(child, child.tag)

    def seconds(self, element, name):
        written = re.fullmatch(r"([0-9]+(?:\.[0-9]*)?)(ms|s)", element.get(name).strip())
        if not written:
            self.refuse(element, f"{name}=\"{element.get(name)}\" is not a time; write for example 1500ms")
        return float(written[1]) * SECONDS[written[2]]

    def changes(self, element):
        return tuple(Change(c.get("at"), c.get("to"), f"{self.text}:{c.sourceline}") for c in element)

    def windows(self, seconds):
        found = []
        for element in self.root.iter("window"):
            begin, end = self.seconds(element, "from"), self.seconds(element, "to")
            if not begin < end <= seconds:
                self.refuse(element, f"the window from {begin:g} s to {end:g} s does not lie in the {seconds:g} s of the task; correct from and to")
            found.append((begin, end))
            if end - begin < SHORTEST_WINDOW_S:
                self.refuse(element, f"the window from {begin:g} s to {end:g} s is shorter than {1e3 * SHORTEST_WINDOW_S:g} ms, which no sense perceives; extend it")
        found = tuple(found) or ((0.0, seconds),)
        if "visual" in self.root.get("sense").split() and max(w[1] for w in found) - min(w[0] for w in found) < LOOK_S:
            self.refuse(self.root, f"all windows together are shorter than {1e3 * LOOK_S:g} ms, so no look falls into them; extend one")
        return found

    def task(self):
        self.check(self.root, "task")
        root = self.root
        senses = tuple(root.get("sense").split())
        for sense in senses:
            if sense not in SENSES:
                self.refuse(root, f"{sense} is not a sense; choose from {', '.join(SENSES)}")
        seconds = self.seconds(root, "seconds")
        if not 0.1 <= seconds <= 600 or not senses:
            self.refuse(root, "a task needs a sense and 0.1 s to 600 s; correct sense and seconds")
        values = {}
        for element in root.iter("value"):
            if element.get("name") in values:
                self.refuse(element, f"the value {element.get('name')} occurs twice; rename one")
            values[element.get("name")] = self.changes(element)
        variants = tuple(self.changes(element) for element in root.iter("variant")) or ((),)
        if len(values) < 2 or len(values) * len(variants) > MAX_RENDERINGS:
            self.refuse(root, f"{len(values)} values and {len(variants)} variants: give 2 values or more, and at most {MAX_RENDERINGS} combinations")
        question = root.find("question")
        return Task(self.path.name.removesuffix(SUFFIX).removesuffix(".xml"), self.scene(), senses, seconds,
                    " ".join((question.text or "").split()) if question is not None else "", values, variants, self.windows(seconds))

    def scene(self):
        """The scene, beside the task file or below its folder first, then among those of Tactus."""
        name = self.root.get("scene")
        if pathlib.PurePath(name).is_absolute() or ".." in pathlib.PurePath(name).parts:
            self.refuse(self.root, f"the scene {name} is outside the folder of the task file; copy it beside the task file")
        for folder in (self.path.parent, SHIPPED, SCENES):
            if own_files.is_regular(folder / name):
                return (folder / name).absolute()
        self.refuse(self.root, f"there is no scene {name} beside the task file; correct scene")


def qualified(attribute):
    """The name of an attribute as lxml writes it: with the prefix tactus in its namespace."""
    prefix, colon, name = attribute.partition(":")
    return f"{{{NAMESPACES[prefix]}}}{name}" if colon and prefix in NAMESPACES else attribute


def changed_scene(scene, changes):
    """XML of the scene with these changes, in order. Raises Refusal."""
    from lxml import etree
    root, _ = own_xml.root_of(scene, str(scene), "an SDF file with a world", largest_bytes=LARGEST_SCENE_BYTES, keeps_comments=True)
    world = root.find("world")
    if world is None:
        raise Refusal(f"{scene}: has no <world>; give an SDF file with a world")
    for change in changes:
        path, _, attribute = change.at.partition("/@")
        try:
            found = world.xpath(path, namespaces=NAMESPACES)
        except etree.XPathError as error:
            raise Refusal(f"{change.where}: at=\"{change.at}\" is not a path ({error}); write for example model[@name='ball']/pose") from None
        if not isinstance(found, list) or len(found) != 1 or not isinstance(found[0], etree._Element):
            raise Refusal(f"{change.where}: at=\"{change.at}\" names {len(found) if isinstance(found, list) else 'no'} elements of the world of {scene.name}; "
                          "it must name one")
        if attribute:
            try:
                found[0].set(qualified(attribute), change.to)
            except ValueError:
                raise Refusal(f"{change.where}: at=\"{change.at}\": {attribute} is not the name of an attribute; write for example tactus:tool/@radius") from None
        else:
            found[0].text = change.to
    return etree.tostring(root.getroottree(), xml_declaration=True, encoding="UTF-8")
