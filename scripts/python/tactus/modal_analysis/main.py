"""Finds the modes of a struck object in a recording: frequency, damping and amplitude of each, and their law of damping.

  tactus analyse-modes FILE.wav [--modes N] [--max-frequency HZ] [--out FILE.csv|FILE.xml] [--material NAME] [--base MATERIAL]
                        [--picture FILE.svg] [--json FILE]
  tactus analyse-modes --compare A.wav B.wav ... --picture FILE.svg

Uses two methods and compares them: ESPRIT in bands of 1 kHz, and the decay of the peaks of short-time spectra. A mode on which both
agree is marked. Growing modes, and modes 60 dB below the strongest, are left out.
FILE.csv is a table of the modes; FILE.xml a <tactus:material> for a scene, with the table beside it (docs/scene_format.md).
The picture shows the spectrum with the modes marked, and damping over frequency with both laws. With --compare it shows the
spectrum of each recording beside that of its re-synthesis from the modes. docs/resynthesis.svg shows three recordings of the Debian
package hydrogen-drumkits (by Glen MacArthur, GPL-2, not part of Tactus), docs/modes.svg the first of them:
  cd "/usr/share/hydrogen/data/drumkits/Gimme A Hand 1.0"
  tactus analyse-modes --compare WaterglassHi-Hard.wav WaterglassLo-Hard.wav Cowbell-Hard.wav --picture resynthesis.svg
  tactus analyse-modes WaterglassHi-Hard.wav --material "water glass" --picture modes.svg
"""
import argparse
import json
import os
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "2")

from tactus.modal_analysis import analysis as analyses, modes_file, pictures
from tactus import own_files, terminal
from tactus.refusal import Refusal
from tactus.modal_analysis.sound_file import read_sound


class Parser(argparse.ArgumentParser):
    def error(self, message):
        sys.exit(f"analyse-modes: {message}; see --help")


def arguments(words):
    parser = Parser(prog="tactus analyse-modes", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", help="WAV, FLAC, or another format of ffmpeg")
    parser.add_argument("--compare", nargs="+", metavar="FILE", help="draws recordings beside their re-synthesis")
    parser.add_argument("--modes", type=int, default=64, help="largest number of modes; keeps those with the most energy (default 64)")
    parser.add_argument("--max-frequency", type=float, default=16000, metavar="HZ", help="finds modes below this frequency (default 16000)")
    parser.add_argument("--out", metavar="FILE", help="table (.csv) or material (.xml)")
    parser.add_argument("--material", metavar="NAME", help="name of the material in FILE.xml (default: name of the recording)")
    parser.add_argument("--base", metavar="MATERIAL", help="built-in material for properties of FILE.xml that a sound does not contain")
    parser.add_argument("--picture", metavar="FILE.svg")
    parser.add_argument("--json", metavar="FILE", help="writes the analysis as JSON")
    options = parser.parse_args(words)
    if (options.file is None) == (options.compare is None):
        parser.error("give one recording, or several with --compare")
    if options.compare and (not options.picture or options.out or options.json):
        parser.error("--compare only draws a picture; give --picture, without --out and --json")
    if not 1 <= options.modes <= 128:
        parser.error(f"--modes {options.modes}: is out of range; give 1 to 128")
    if not 20 < options.max_frequency <= 20000:  # limits of a scene, docs/scene_format.md
        parser.error(f"--max-frequency {options.max_frequency:g}: give more than 20 and at most 20000 Hz, the limits of a scene")
    if options.out and not options.out.endswith((".csv", ".xml")):
        parser.error(f"--out {options.out}: is neither a .csv nor an .xml file; give one of them")
    return options


def analysed(path, options):
    samples, rate = read_sound(path)
    try:
        return analyses.analyse(samples, rate, options.modes, options.max_frequency)
    except Refusal as e:
        raise Refusal(f"{path}: {e}") from e


def report(a):
    print(f"{'frequency':>12} {'damping':>9} {'T60':>8} {'amplitude':>9}   {'by decay':>12} {'damping':>9}  agrees")
    print(f"{'Hz':>12} {'1/s':>9} {'s':>8} {'dB':>9}   {'Hz':>12} {'1/s':>9}")
    for m, row in zip(a.modes, modes_file.rows_of(a.modes)):
        print(f"{m.frequency_Hz:12.2f} {m.damping_1_s:9.3g} {6.91 / m.damping_1_s:8.3f} {20 * analyses.np.log10(m.amplitude):9.1f}   "
              f"{row[3] or '-':>12} {row[4] or '-':>9}  {'yes' if m.agrees else 'no'}")
    law = a.law
    print(f"damping = (alpha + beta w^2) / 2: alpha {law['rayleigh_alpha_1_s']:.4g} 1/s, beta {law['rayleigh_beta_s']:.4g} s, "
          f"error {100 * law['rayleigh_error']:.0f} %")
    print(f"damping = pi f eta: loss factor {law['loss_factor']:.4g}, error {100 * law['loss_factor_error']:.0f} %; {law['better']} fits better")


def write_json(path, content):
    try:
        with open(path, "w", encoding="utf-8") as file:
            json.dump(content, file, indent=1)
    except OSError as e:
        raise Refusal(f"{path} cannot be written: {e.strerror}; give another file") from e


def main(words):
    options = arguments(words)
    try:
        for option, path in (("--out", options.out), ("--picture", options.picture)):
            own_files.require_writable(option, path, options.compare or [options.file])
        if options.compare:
            pictures.draw_comparison(options.picture, [(terminal.readable(os.path.basename(p)), analysed(p, options)) for p in options.compare])
            return
        a = analysed(options.file, options)
        title = terminal.readable(options.material or os.path.splitext(os.path.basename(options.file))[0])
        if options.out and options.out.endswith(".xml"):
            modes_file.write_xml(options.out, a, title, options.base)
        elif options.out:
            modes_file.write_csv(options.out, a.modes)
        if options.picture:
            pictures.draw_analysis(options.picture, a, title)
        if options.json:
            write_json(options.json, modes_file.as_json(a))
        report(a)
    except Refusal as e:
        sys.exit(f"analyse-modes: {e}")
