"""Finds the modes of a struck object in a recording: frequency, damping and amplitude of each, and the law that damping follows.

  tactus analyse-modes FILE.wav [--modes N] [--max-frequency HZ] [--out FILE.csv|FILE.xml] [--material NAME] [--base MATERIAL]
                        [--picture FILE.svg] [--json FILE]
  tactus analyse-modes --compare A.wav B.wav ... --picture FILE.svg

Two ways, each held against the other: ESPRIT in bands of 1 kHz, and the decay of the peaks of short-time spectra. A mode on which
they agree is marked. Modes that grow, or lie 60 dB below the strongest, are left out.
FILE.csv is a table of the modes; FILE.xml a <tactus:material> for a scene, with the table beside it (docs/scene_format.md).
The picture shows the spectrum with the modes marked, and damping against frequency with both laws. With --compare it shows the
spectrum of each recording beside that of what its modes alone sound like. docs/resynthesis.svg is that of three recordings of the
Debian package hydrogen-drumkits (by Glen MacArthur, GPL-2: they are no part of Tactus), docs/modes.svg that of the first:
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
from tactus.refusal import Refusal
from tactus.modal_analysis.sound_file import read_sound


class Parser(argparse.ArgumentParser):
    def error(self, message):
        sys.exit(f"analyse-modes: {message}; see --help")


def arguments(words):
    parser = Parser(prog="tactus analyse-modes", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", help="WAV, FLAC, or what else ffmpeg reads")
    parser.add_argument("--compare", nargs="+", metavar="FILE", help="recordings beside their re-synthesis")
    parser.add_argument("--modes", type=int, default=64, help="at most so many, those with the most energy (default 64)")
    parser.add_argument("--max-frequency", type=float, default=16000, metavar="HZ", help="modes below this (default 16000)")
    parser.add_argument("--out", metavar="FILE", help="table (.csv) or material (.xml)")
    parser.add_argument("--material", metavar="NAME", help="name of the material in FILE.xml (default: that of the recording)")
    parser.add_argument("--base", metavar="MATERIAL", help="built-in material from which FILE.xml takes what a sound does not tell")
    parser.add_argument("--picture", metavar="FILE.svg")
    parser.add_argument("--json", metavar="FILE", help="all of it as JSON")
    options = parser.parse_args(words)
    if (options.file is None) == (options.compare is None):
        parser.error("give one recording, or several with --compare")
    if options.compare and (not options.picture or options.out or options.json):
        parser.error("--compare makes a picture only: name it with --picture")
    if not 1 <= options.modes <= 128:
        parser.error(f"--modes {options.modes}: a body has 1 to 128 modes")
    if not 20 < options.max_frequency <= 20000:  # as the scene does, docs/scene_format.md
        parser.error(f"--max-frequency {options.max_frequency:g}: give more than 20 and at most 20000 Hz, which is what a scene takes")
    if options.out and not options.out.endswith((".csv", ".xml")):
        parser.error(f"--out {options.out}: it ends in .csv or .xml")
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
          f"off by {100 * law['rayleigh_error']:.0f} %")
    print(f"damping = pi f eta: loss factor {law['loss_factor']:.4g}, off by {100 * law['loss_factor_error']:.0f} %; {law['better']} fits better")


def write_json(path, content):
    try:
        with open(path, "w", encoding="utf-8") as file:
            json.dump(content, file, indent=1)
    except OSError as e:
        raise Refusal(f"{path} cannot be written: {e.strerror}; name another file") from e


def main(words):
    options = arguments(words)
    try:
        if options.compare:
            pictures.draw_comparison(options.picture, [(os.path.basename(p), analysed(p, options)) for p in options.compare])
            return
        a = analysed(options.file, options)
        title = options.material or os.path.splitext(os.path.basename(options.file))[0]
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
