"""Says what a folder of recordings holds, what of it is broken, and what contacts fall back to.

Usage: tactus check-sounds [DIR] [--scene SCENE.sdf] [--json]

  DIR      laid out as audio_node/samples/README.md says; default: the set that the build renders
  --scene  looks up every pair of the scene's materials: the pair's own recording, that of a material alone, or modal
  --json   the same as JSON

Ends with 1 when a file cannot be played or sounds worse than it should, or is not where it belongs.
"""
import argparse
import subprocess
import sys
import xml.etree.ElementTree as ET

from tactus.paths import BIN

PROGRAM = str(BIN / "check_sounds")


def materials_of(scene):
    """All that a surface or a tool of the scene is made of."""
    try:
        elements = ET.parse(scene).iter()
    except OSError as e:
        sys.exit(f"check_sounds: {scene}: {e.strerror}; give an SDF scene")
    except ET.ParseError as e:
        sys.exit(f"check_sounds: {scene} is no XML ({e}); give an SDF scene")
    found = sorted({e.get("material") for e in elements if e.get("material")})
    if not found:
        sys.exit(f"check_sounds: {scene} names no material; give another scene")
    return found


def main(words):
    parser = argparse.ArgumentParser(prog="tactus check-sounds", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", default="default")
    parser.add_argument("--scene")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args(words)
    command = [PROGRAM, options.folder]
    if options.scene:
        command += ["--materials", ",".join(materials_of(options.scene))]
    if options.json:
        command.append("--json")
    try:
        return subprocess.run(command, check=False).returncode
    except OSError as e:
        sys.exit(f"check_sounds: {PROGRAM}: {e.strerror}; run scripts/build first")

