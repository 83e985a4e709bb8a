"""Reports the contents of a folder of recordings, its defects, and the fallbacks of contacts.

Usage: tactus check-sounds [DIR] [--scene SCENE.sdf] [--json]

  DIR      folder with the layout of audio_node/samples/README.md; default: the set that the build renders
  --scene  looks up every pair of materials of the scene: recording of the pair, recording of one material, or modal
  --json   prints the report as JSON

Exit status 1: a file cannot be played, has poor quality, or is in the wrong place.
"""
import argparse
import subprocess
import sys
import xml.etree.ElementTree as ET

from tactus.commands import prepare


def materials_of(scene):
    """Names of the materials of all surfaces and tools of the scene."""
    try:
        elements = ET.parse(scene).iter()
    except OSError as e:
        sys.exit(f"check_sounds: {scene}: {e.strerror}; give an SDF scene")
    except ET.ParseError as e:
        sys.exit(f"check_sounds: {scene} is not valid XML ({e}); give an SDF scene")
    found = sorted({e.get("material") for e in elements if e.get("material")})
    if not found:
        sys.exit(f"check_sounds: {scene} names no material; give a scene with the attribute material")
    return found


def main(words):
    parser = argparse.ArgumentParser(prog="tactus check-sounds", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", default="default")
    parser.add_argument("--scene")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args(words)
    command = [prepare.program("check_sounds"), options.folder]
    if options.scene:
        command += ["--materials", ",".join(materials_of(options.scene))]
    if options.json:
        command.append("--json")
    try:
        return subprocess.run(command, check=False).returncode
    except OSError as e:
        sys.exit(f"check_sounds: {command[0]}: {e.strerror}; run scripts/build check_sounds")

