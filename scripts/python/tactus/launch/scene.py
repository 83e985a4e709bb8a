"""What a run knows of its scene before it begins. sim_node says what is wrong with one."""
import xml.parsers.expat


def in_world(scene):
    """[(element, attributes)] that lie right in the world, in their order; none where the scene cannot be read."""
    found, path = [], []

    def begin(name, attributes):
        path.append(name)
        if path[1:] == ["world", name]:
            found.append((name, attributes))

    # Prefixes as they are written: a prefix that nobody declared is none of our business.
    parser = xml.parsers.expat.ParserCreate()
    parser.StartElementHandler = begin
    parser.EndElementHandler = lambda name: path.pop()
    try:
        parser.Parse(scene.read_bytes(), True)
    except (xml.parsers.expat.ExpatError, OSError, LookupError, ValueError):
        return []
    return found


def tools(scene):
    """Names of its tools."""
    return [attributes.get("name", "") for name, attributes in in_world(scene) if name == "tactus:tool"]


def shader_folder(scene):
    """Where shaders of its own lie, to be read again when they change; None: it has none, or says itself where they are."""
    world = in_world(scene)
    says = any(name == "tactus:visual_node" and "shader_folder" in attributes for name, attributes in world)
    return scene.parent if not says and any(name == "tactus:shader" for name, _ in world) else None
