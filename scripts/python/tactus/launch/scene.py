"""Reads tools and shaders from a scene before the run. sim_node reports the errors of a scene."""
import xml.parsers.expat


def world_elements(scene):
    """[(element, attributes)] of the children of <world>, in order; empty when the scene cannot be read."""
    found, path = [], []

    def begin(name, attributes):
        path.append(name)
        if path[1:] == ["world", name]:
            found.append((name, attributes))

    # Without namespace processing, so that undeclared prefixes are not an error.
    parser = xml.parsers.expat.ParserCreate()
    parser.StartElementHandler = begin
    parser.EndElementHandler = lambda name: path.pop()
    try:
        parser.Parse(scene.read_bytes(), True)
    except (xml.parsers.expat.ExpatError, OSError, LookupError, ValueError):
        return []
    return found


def tools(scene):
    """Names of the tools of the scene."""
    return [attributes.get("name", "") for name, attributes in world_elements(scene) if name == "tactus:tool"]


def shader_folder(scene):
    """Folder of the shaders of the scene, which are reloaded on change; None without shaders, or when the scene sets shader_folder."""
    world = world_elements(scene)
    sets_folder = any(name == "tactus:visual_node" and "shader_folder" in attributes for name, attributes in world)
    return scene.parent if not sets_folder and any(name == "tactus:shader" for name, _ in world) else None
