"""Makes a folder of recordings for audio_node from the drums of the Debian package hydrogen-drumkits.

Usage: tactus drumkit-sounds DIR [--from FOLDER]

  DIR     a new folder; tactus check-sounds DIR lists its contents
  --from  folder of the kits; default: that of the package

Materials: sticks oak, heads rubber, cymbals and cowbell copper, rims steel. This is close enough to recognise the objects. Play them with
  tactus run SCENE --set audio_node.method=samples --set audio_node.sounds=DIR --set audio_node.recorded_level=0.3
because drums are recorded up to full scale. To map other recordings, add one line to DRUMS for each file.
"""
import argparse
import os
import shutil
import sys

from tactus import own_files
from tactus.option_parser import OptionParser

KITS = "/usr/share/hydrogen/data/drumkits"
# (recording, path in the folder), softest first: the kits number their layers in this order.
DRUMS = [
    *((f"Millo_MultiLayered2/floortom_0{i}.flac", f"oak-rubber/impact/{v}.flac") for i, v in enumerate((0.1, 0.3, 1, 3), 1)),
    *((f"Millo_MultiLayered2/ride_0{i}.flac", f"copper-oak/impact/{v}.flac") for i, v in enumerate((0.1, 0.25, 0.6, 1.5, 4), 1)),
    *((f"Millo_MultiLayered2/rim_0{i}.flac", f"oak-steel/impact/{v}.flac") for i, v in enumerate((0.1, 0.3, 1, 3), 1)),
    ("Millo-Drums_v.1/stick_Woody.flac", "oak-oak/impact/1.flac"),
    ("Millo-Drums_v.1/misc_Cowbell.flac", "copper/impact/1.flac"),
    ("ColomboAcousticDrumkit/stick-rim-9.flac", "oak-steel/impact/1_2.flac"),
]
# Radius of a ball of the same size, m. For a struck object: the tip of the stick, because it is the moving body.
SIZES = {"oak-rubber": 0.02, "copper-oak": 0.02, "oak-steel": 0.02, "oak-oak": 0.02, "copper": 0.05}


def main(words):
    parser = OptionParser(prog="tactus drumkit-sounds", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--from", dest="kits", default=KITS)
    options = parser.parse_args(words)
    if not os.path.isdir(options.kits):
        sys.exit(f"drumkit_sounds: {options.kits} does not exist; install hydrogen-drumkits or give --from FOLDER")
    if os.path.exists(options.folder):
        sys.exit(f"drumkit_sounds: {options.folder} already exists; give a new folder")
    with own_files.results_folder(options.folder):
        copy(options)
    print(f"{len(DRUMS)} recordings in {options.folder}")
    return 0


def copy(options):
    for source, place in DRUMS:
        place = os.path.join(options.folder, place)
        os.makedirs(os.path.dirname(place), exist_ok=True)
        try:
            shutil.copyfile(os.path.join(options.kits, source), place)
        except OSError as e:
            sys.exit(f"drumkit_sounds: {e.filename}: {e.strerror}; give another --from")
    for folder, size_m in SIZES.items():
        with open(os.path.join(options.folder, folder, "size.txt"), "w", encoding="utf-8") as file:
            file.write(f"{size_m}\n")
