"""What changed from one rendering of a log to another, per sense. Arrays and rows in, one dictionary out; no file, no clock."""
import numpy as np

# Weber fractions of force: 7 % (Pang, Tan and Durlach 1991, 2.5 to 10 N) to 10 % (Raghu Prasad, Purswani and Manivannan
# 2013, 2 to 5 N). Small forces are told apart worse; nobody measured below: there the tube keeps the width that it has at 0.5 N
# (design).
FORCE_JND, FORCE_FLOOR_N = (0.07, 0.10), 0.5
# Less is no force: what rounding leaves.
NO_FORCE_N = 1e-3
# What CIEDE2000 is scaled to, for surfaces side by side.
SEEN = 1.0


def percentiles(values, name, unit):
    if len(values) == 0:
        return {f"{name}_p50_{unit}": None, f"{name}_p99_{unit}": None}
    return {f"{name}_p50_{unit}": float(np.percentile(values, 50)), f"{name}_p99_{unit}": float(np.percentile(values, 99))}


def times_of(rows):
    """{(event, part): ns at which it was presented} of the rows of a presented.csv; what was not presented is not in it."""
    times = {}
    for row in rows:
        if int(row["presented_ns"]) >= 0 and row["outcome"] in ("presented", "late"):
            times.setdefault((row["event_id"], row["part"]), int(row["presented_ns"]))
    return times


def shifts_ms(reference, other):
    """Of each event that both present, how much later the other does."""
    return np.array([(other[key] - at) * 1e-6 for key, at in reference.items() if key in other])


def events(reference, other):
    """reference, other: times_of. By how much later what both present is, and what only one does."""
    shift = shifts_ms(reference, other)
    return {"presented": len(other), "dropped": len(reference.keys() - other.keys()),
            "added": len(other.keys() - reference.keys()), **percentiles(shift, "shift", "ms")}


def force(reference, other):
    """(n, 3) N of the same ticks. Beside RMS and peak of the difference the share of those ticks with force in either in which
    it is beyond the just noticeable difference, by the least and by the largest fraction."""
    apart = np.linalg.norm(other - reference, axis=1)
    size = np.linalg.norm(reference, axis=1)
    felt = (size > NO_FORCE_N) | (np.linalg.norm(other, axis=1) > NO_FORCE_N)
    beyond = {f"beyond_{round(100 * k)}_percent":
              float(np.mean(apart[felt] > k * np.maximum(size[felt], FORCE_FLOOR_N))) if felt.any() else 0.0 for k in FORCE_JND}
    return {"ticks": len(size), "with_force": int(felt.sum()), "rms_N": rms(size), "difference_rms_N": rms(apart),
            "difference_peak_N": peak(apart), **percentiles(apart, "difference", "N"), **beyond}


def warmth(reference_K, other_K, name):
    """Temperatures at the same instants."""
    apart = other_K - reference_K
    return {f"{name}_rms_K": rms(apart), f"{name}_peak_K": peak(apart)}


def sound(reference, other):
    """Samples of one rate from the same instant on."""
    n = max(len(reference), len(other))
    apart = np.pad(other, (0, n - len(other))) - np.pad(reference, (0, n - len(reference)))
    quiet = 1e-12
    return {"level_dB": float(20 * np.log10((rms(other) + quiet) / (rms(reference) + quiet))),
            "difference_peak": peak(apart), "samples_differ": float(np.mean(apart != 0)) if n else 0.0}


def frames(reference, other):
    """Hashes of the pixels of each frame, in order: numbers of those that differ. Where one has more, these do."""
    n = max(len(reference), len(other))
    return [i for i in range(n) if i >= len(reference) or i >= len(other) or reference[i] != other[i]]


def rms(values):
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else 0.0


def peak(values):
    return float(np.max(np.abs(values))) if len(values) else 0.0
