"""Median and interval of several reruns, and their difference from the log. Pure."""
import numpy as np

from tactus.rerender import compare

SHARE = 0.95
BELOW, ABOVE = (1 - SHARE) / 2, (1 + SHARE) / 2
FRACTION, FLOOR_N = compare.FORCE_JND[1], compare.FORCE_FLOOR_N


def band(values):
    """(median, lower, upper), each (n, 3), of values (draws, n, 3)."""
    return tuple(np.quantile(values, q, axis=0) for q in (0.5, BELOW, ABOVE))


def within(reference_N, other_N):
    """Share of the ticks with force in either in which the forces (n, 3) differ by at most 10 % of the reference, below 0.5 N by that of 0.5 N; 1 without
    any force."""
    return 1 - compare.force(reference_N, other_N)[f"beyond_{round(100 * FRACTION)}_percent"]


def figures(reference_N, reference_m, forces_N, positions_m):
    """Figures of reruns (draws, n, 3) against a reference (n, 3)."""
    force, low, high = band(forces_N)
    place = band(positions_m)[0]
    felt = np.linalg.norm(reference_N, axis=1) > compare.NO_FORCE_N
    felt |= np.linalg.norm(force, axis=1) > compare.NO_FORCE_N
    size = np.maximum(np.linalg.norm(force, axis=1), FLOOR_N)
    spread = np.linalg.norm(high - low, axis=1) / 2
    return {"within_10_percent": within(reference_N, force), "within_10_percent_each": [within(reference_N, f) for f in forces_N],
            "difference_rms_N": compare.rms(np.linalg.norm(force - reference_N, axis=1)), "difference_peak_N": compare.peak(np.linalg.norm(force - reference_N, axis=1)),
            "position_rms_m": compare.rms(np.linalg.norm(place - reference_m, axis=1)), "peak_force_N": compare.peak(np.linalg.norm(force, axis=1)),
            "with_force_s_share": float(np.mean(felt)),
            "spread_beyond_10_percent": float(np.mean(spread[felt] > FRACTION * size[felt])) if felt.any() else 0.0}
