"""Differences between two renderings of a log, per modality. Arrays and rows in, a dictionary out; no file, no clock."""
import numpy as np

# Weber fractions of force: 7 % (Pang, Tan and Durlach 1991, 2.5 to 10 N) to 10 % (Raghu Prasad, Purswani and Manivannan
# 2013, 2 to 5 N). Smaller forces are discriminated less well, but no study measured below: there the band keeps the width at
# 0.5 N (design).
FORCE_JND, FORCE_FLOOR_N = (0.07, 0.10), 0.5
# Smaller values are rounding errors.
NO_FORCE_N = 1e-3
# Unit of CIEDE2000, for adjacent surfaces: about just noticeable.
SEEN = 1.0


def percentiles(values, name, unit):
    if len(values) == 0:
        return {f"{name}_p50_{unit}": None, f"{name}_p99_{unit}": None}
    return {f"{name}_p50_{unit}": float(np.percentile(values, 50)), f"{name}_p99_{unit}": float(np.percentile(values, 99))}


def times_of(rows):
    """{(event, part): ns at which it was presented} of the rows of presented.csv; only presented events."""
    times = {}
    for row in rows:
        if int(row["presented_ns"]) >= 0 and row["outcome"] in ("presented", "late"):
            times.setdefault((row["event_id"], row["part"]), int(row["presented_ns"]))
    return times


def shifts_ms(reference, other):
    """Delay of the other rendering for each common event, ms."""
    return np.array([(other[key] - at) * 1e-6 for key, at in reference.items() if key in other])


def events(reference, other):
    """Delays of common events, and counts of events in one only. reference, other: from times_of()."""
    shift = shifts_ms(reference, other)
    return {"presented": len(other), "dropped": len(reference.keys() - other.keys()),
            "added": len(other.keys() - reference.keys()), **percentiles(shift, "shift", "ms")}


def force(reference, other):
    """Differences of forces (n, 3) in N of the same ticks: RMS, peak, percentiles, and the share of ticks with force in either in
    which the difference exceeds the just noticeable one, by the smallest and by the largest fraction."""
    apart = np.linalg.norm(other - reference, axis=1)
    size = np.linalg.norm(reference, axis=1)
    felt = (size > NO_FORCE_N) | (np.linalg.norm(other, axis=1) > NO_FORCE_N)
    beyond = {f"beyond_{round(100 * k)}_percent":
              float(np.mean(apart[felt] > k * np.maximum(size[felt], FORCE_FLOOR_N))) if felt.any() else 0.0 for k in FORCE_JND}
    return {"ticks": len(size), "with_force": int(felt.sum()), "rms_N": rms(size), "difference_rms_N": rms(apart),
            "difference_peak_N": peak(apart), **percentiles(apart, "difference", "N"), **beyond}


def warmth(reference_K, other_K, name):
    """RMS and peak of the difference of temperatures at the same times, K."""
    apart = other_K - reference_K
    return {f"{name}_rms_K": rms(apart), f"{name}_peak_K": peak(apart)}


def sound(reference, other):
    """Differences of samples with the same rate and start."""
    n = max(len(reference), len(other))
    apart = np.pad(other, (0, n - len(other))) - np.pad(reference, (0, n - len(reference)))
    quiet = 1e-12
    return {"level_dB": float(20 * np.log10((rms(other) + quiet) / (rms(reference) + quiet))),
            "difference_peak": peak(apart), "samples_differ": float(np.mean(apart != 0)) if n else 0.0}


def frames(reference, other):
    """Numbers of different frames, by the pixel hashes in order; surplus frames count as different."""
    n = max(len(reference), len(other))
    return [i for i in range(n) if i >= len(reference) or i >= len(other) or reference[i] != other[i]]


def rms(values):
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else 0.0


def peak(values):
    return float(np.max(np.abs(values))) if len(values) else 0.0
