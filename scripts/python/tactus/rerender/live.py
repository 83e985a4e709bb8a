"""Compares a rendering of a log with the results of the run."""
import os

import numpy as np

from tactus.log import sound_onsets
from tactus.rerender import compare, read
from tactus.tables import read_rows


def row(sense, what, values, unit, note=""):
    values = np.abs(np.asarray(values, dtype=float))
    q = lambda p: float(np.percentile(values, p)) if len(values) else None
    return {"sense": sense, "what": what, "n": len(values), "p50": q(50), "p99": q(99), "max": q(100), "unit": unit, "note": note}


def of_run(run, sense):
    rows = [r for r in read_rows(os.path.join(run, "presented.csv")) if r["modality"] == sense]
    return compare.times_of(rows)


def presented(run, folder, sense):
    """Difference of the presentation times that the nodes report."""
    live, again = of_run(run, sense), compare.times_of(read_rows(os.path.join(folder, f"presented_{sense}.csv")))
    shift = compare.shifts_ms(live, again)
    return row(sense, "presented, as the node reports", shift, "ms", f"{len(live.keys() - again.keys())} only live, {len(again.keys() - live.keys())} only again")


def haptic(run, folder, _):
    again = read.forces(os.path.join(folder, "haptic.csv"))
    live = read.forces(os.path.join(run, "haptic.csv"), read.tool_of(os.path.join(folder, "haptic.csv")))
    ticks = sorted(live.keys() & again.keys())
    one, two = (np.array([f[t] for t in ticks]).reshape(-1, 3) for f in (live, again))
    apart = np.linalg.norm(two - one, axis=1)
    felt = np.linalg.norm(one, axis=1) > compare.NO_FORCE_N
    return [row("haptic", "force, every tick", apart, "N", f"{len(live) - len(ticks)} ticks only live"),
            row("haptic", "force, while there is one", apart[felt], "N", f"largest {compare.peak(one):.2f} N")]


def audio(run, folder, first_ns):
    """Onsets in the samples of both WAVs: the live one by the clock of its sound card, the other from its first sample."""
    clock = sound_onsets.clock_of(read_rows(os.path.join(run, "media_clock.csv")), "audio.wav")
    live, again = read.Sound(os.path.join(run, "audio.wav"), clock=clock), read.Sound(os.path.join(folder, "audio.wav"), first_ns)
    heard_live = live.onsets_ns(of_run(run, "audio"))
    heard_again = again.onsets_ns(compare.times_of(read_rows(os.path.join(folder, "presented_audio.csv"))))
    return [row("audio", "onsets in the samples", compare.shifts_ms(heard_live, heard_again), "ms")]


def thermal(run, folder, _):
    at, skin, _ = read.temperatures(os.path.join(folder, "thermal.csv"))
    at_live, skin_live, _ = read.temperatures(os.path.join(run, "thermal.csv"), read.tool_of(os.path.join(folder, "thermal.csv")))
    inside = (at_live >= at[0]) & (at_live <= at[-1])
    return [row("thermal", "skin, at the same instant", skin_live[inside] - np.interp(at_live[inside], at, skin), "K")]


SIGNAL_COMPARISONS = {"haptic": haptic, "audio": audio, "thermal": thermal}
REQUIRED_FILES = {"haptic": ["haptic.csv"], "audio": ["audio.wav", "media_clock.csv"], "thermal": ["thermal.csv"], "visual": []}


def against_live(sense, run, folder, first_ns):
    """Rows of the comparison; none when the run has no results of this modality."""
    if any(not os.path.isfile(os.path.join(run, name)) for name in ["presented.csv", *REQUIRED_FILES[sense]]):
        return []
    more = SIGNAL_COMPARISONS[sense](run, folder, first_ns) if sense in SIGNAL_COMPARISONS else []
    return [*more, presented(run, folder, sense)]
