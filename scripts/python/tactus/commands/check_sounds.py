"""Reports the contents of a folder of recordings, its defects, and the fallbacks of contacts.

Usage: tactus check-sounds [DIR] [--scene SCENE.sdf] [--json FILE]

  DIR      folder with the layout of audio_node/samples/README.md; default: the set that the build renders
  --scene  looks up every pair of materials of the scene: recording of the pair, recording of one material, or modal
  --json   writes the report to FILE as JSON instead; without FILE: to stdout

Exit status 1: a file cannot be played, has poor quality, or is in the wrong place.
"""
import argparse
import subprocess
import sys
import xml.etree.ElementTree as ET

from tactus.commands import prepare
from tactus.option_parser import OptionParser
from tactus.paths import remedy


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
    parser = OptionParser(prog="tactus check-sounds", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", default="default")
    parser.add_argument("--scene")
    parser.add_argument("--json", metavar="FILE", nargs="?", const="/dev/stdout")
    options = parser.parse_args(words)
    command = [prepare.program("check_sounds"), options.folder]
    if options.scene:
        command += ["--materials", ",".join(materials_of(options.scene))]
    if options.json:
        command.append("--json")
    try:
        if not options.json:
            return subprocess.run(command, check=False).returncode
        done = subprocess.run(command, check=False, stdout=subprocess.PIPE)
        with open(options.json, "wb") as file:
            file.write(done.stdout)
        return done.returncode
    except OSError as e:
        sys.exit(f"check_sounds: {command[0]}: {e.strerror}; {remedy('check_sounds')}")

