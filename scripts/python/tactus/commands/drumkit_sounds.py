"""Makes a folder of recordings for audio_node of real ones: drums of the Debian package hydrogen-drumkits.

Usage: tactus drumkit-sounds DIR [--from FOLDER]

  DIR     a new folder; tactus check-sounds DIR says what is in it
  --from  where the kits are; default: where the package puts them

Sticks are oak, heads are rubber, cymbals and the cowbell copper, rims steel: near enough to hear what meets. Played with
  scripts/run SCENE --set audio_node.method=samples --set audio_node.sounds=DIR --set audio_node.recorded_level=0.3
since drums are recorded up to full scale. Other recordings are mapped in the same way: one line for each file below.
"""
import argparse
import os
import shutil
import sys

KITS = "/usr/share/hydrogen/data/drumkits"
# Recording, place in the folder: softest first, since the kits number their layers so.
DRUMS = [
    *((f"Millo_MultiLayered2/floortom_0{i}.flac", f"oak-rubber/impact/{v}.flac") for i, v in enumerate((0.1, 0.3, 1, 3), 1)),
    *((f"Millo_MultiLayered2/ride_0{i}.flac", f"copper-oak/impact/{v}.flac") for i, v in enumerate((0.1, 0.25, 0.6, 1.5, 4), 1)),
    *((f"Millo_MultiLayered2/rim_0{i}.flac", f"oak-steel/impact/{v}.flac") for i, v in enumerate((0.1, 0.3, 1, 3), 1)),
    ("Millo-Drums_v.1/stick_Woody.flac", "oak-oak/impact/1.flac"),
    ("Millo-Drums_v.1/misc_Cowbell.flac", "copper/impact/1.flac"),
    ("ColomboAcousticDrumkit/stick-rim-9.flac", "oak-steel/impact/1_2.flac"),
]
# Radius of a ball of the same extent, m: a stick's bead for what it strikes is what moves.
SIZES = {"oak-rubber": 0.02, "copper-oak": 0.02, "oak-steel": 0.02, "oak-oak": 0.02, "copper": 0.05}


def main(words):
    parser = argparse.ArgumentParser(prog="tactus drumkit-sounds", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--from", dest="kits", default=KITS)
    options = parser.parse_args(words)
    if not os.path.isdir(options.kits):
        sys.exit(f"drumkit_sounds: {options.kits} is not there; install hydrogen-drumkits or give --from FOLDER")
    if os.path.exists(options.folder):
        sys.exit(f"drumkit_sounds: {options.folder} is there already; give a new folder")
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
    print(f"{len(DRUMS)} recordings in {options.folder}")

