"""Compares two renderings of one modality in two folders."""
import filecmp
import itertools
import os

import numpy as np

from tactus.rerender import colour, compare, read
from tactus.tables import read_rows


def presented(folder, sense):
    return compare.times_of(read_rows(os.path.join(folder, f"presented_{sense}.csv")))


def haptic(reference, other, _):
    one, two = (read.forces(os.path.join(folder, "haptic.csv")) for folder in (reference, other))
    ticks = sorted(one.keys() & two.keys())
    return compare.force(np.array([one[t] for t in ticks]).reshape(-1, 3), np.array([two[t] for t in ticks]).reshape(-1, 3))


def thermal(reference, other, _):
    (at, skin, command), (at_two, skin_two, command_two) = (read.temperatures(os.path.join(folder, "thermal.csv"))
                                                            for folder in (reference, other))
    n = min(len(at), len(at_two))
    return {"ticks": n, **compare.warmth(skin[:n], skin_two[:n], "skin"), **compare.warmth(command[:n], command_two[:n], "command")}


def audio(reference, other, first_ns):
    """first_ns: output times of the first samples of both, ns."""
    one, two = (read.Sound(os.path.join(folder, "audio.wav"), first) for folder, first in zip((reference, other), first_ns))
    found = [sound.onsets_ns(presented(folder, "audio")) for sound, folder in ((one, reference), (two, other))]
    shift = compare.shifts_ms(*found)
    return {**compare.sound(one.samples, two.samples), "onsets_found": len(shift), **compare.percentiles(shift, "heard_shift", "ms")}


def visual(reference, other, _):
    hashes = [[row["pixels"] for row in read_rows(os.path.join(folder, "frames.csv"))] for folder in (reference, other)]
    differ = compare.frames(*hashes)
    means, seen = [], []
    both = set(n for n in differ if n < min(map(len, hashes)))
    one, two = (read.pictures(os.path.join(folder, "video.mp4"), both) for folder in (reference, other))
    for a, b in itertools.zip_longest(one, two):  # reads both to the end
        if a is None or b is None:
            continue
        (_, a), (_, b) = a, b
        apart = colour.ciede2000(colour.lab_of(a), colour.lab_of(b))
        means.append(float(apart.mean()))
        seen.append(float(np.mean(apart > compare.SEEN)))
    return {"frames": max(map(len, hashes)), "frames_differ": len(differ),
            "mean_CIEDE2000": float(np.mean(means)) if means else 0.0, "worst_CIEDE2000": max(means, default=0.0),
            "pixels_seen_to_differ": float(np.mean(seen)) if seen else 0.0}


COMPARISONS = {"haptic": haptic, "audio": audio, "visual": visual, "thermal": thermal}


def changed(sense, reference, other, first_ns=None):
    return {**compare.events(presented(reference, sense), presented(other, sense)), **COMPARISONS[sense](reference, other, first_ns)}


def same_bytes(sense, one, other):
    """Compares the files of two renderings of one modality bit by bit."""
    files = {"audio": ["audio.wav"], "haptic": ["haptic.csv"], "thermal": ["thermal.csv"], "visual": ["frames.csv", "video.mp4"]}[sense]
    files.append(f"presented_{sense}.csv")
    differ = [name for name in files if not filecmp.cmp(os.path.join(one, name), os.path.join(other, name), shallow=False)]
    return {"compared": files, "differ": differ, "bytes": sum(os.path.getsize(os.path.join(one, name)) for name in files)}
