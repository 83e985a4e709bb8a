"""Frequencies and dampings from the decay of the peaks of short-time spectra: an independent check of ESPRIT.

Each peak of the mean spectrum is tracked over time; the slope of its log amplitude is the damping (Smith, "Physical Audio Signal
Processing", sinusoidal modelling and energy decay relief). Two modes nearer than the resolution give one peak.
"""
import numpy as np

SHORTEST_S, LONGEST_S = 0.02, 0.085  # of a window: design
HOP = 8  # hops in a window
PAD = 4  # zero padding, factor
PEAK_DB = 70.0  # peaks further below the highest are ignored
FIT_DB = 25.0  # range of the fitted decay; the reverberation of a room comes later (design)
ABOVE_NOISE_DB = 12.0
FEWEST_FRAMES = 4


def frames_of(samples, size):
    hop = max(1, size // HOP)
    if len(samples) < size + FEWEST_FRAMES * hop:
        return np.zeros((0, 0)), hop
    pieces = np.lib.stride_tricks.sliding_window_view(samples, size)[::hop]
    return np.abs(np.fft.rfft(pieces * np.hanning(size + 1)[:size], PAD * size, axis=1)), hop


def window_s(samples, rate):
    """Length of the window, s: a third of the time in which the energy falls by 30 dB, within bounds, for the finest possible spectrum."""
    energy = np.cumsum(samples[::-1] ** 2)[::-1]
    rings_s = np.argmax(energy < 1e-3 * energy[0]) / rate or len(samples) / rate
    return min(max(rings_s / 3, SHORTEST_S), LONGEST_S, len(samples) / rate / 3)


def peak_between_bins(log_spectrum, i):
    """Vertex of the parabola through three points, in bins."""
    a, b, c = log_spectrum[i - 1:i + 2]
    curvature = a - 2 * b + c
    return i + (0.5 * (a - c) / curvature if curvature < 0 else 0.0)


def slope(times_s, log_amplitude, noise):
    """(damping of one track, 1/s, from its maximum until it reaches the noise, or None if this part is too short; straightness 0 .. 1)."""
    top = int(np.argmax(log_amplitude[:max(FEWEST_FRAMES, len(log_amplitude) // 4)]))
    limit = max(noise + ABOVE_NOISE_DB * np.log(10) / 20, log_amplitude[top] - FIT_DB * np.log(10) / 20)
    below = np.nonzero(log_amplitude[top:] < limit)[0]
    end = top + (int(below[0]) if len(below) else len(log_amplitude) - top)
    if end - top < FEWEST_FRAMES:
        return None, 0.0
    t, y = times_s[top:end], log_amplitude[top:end]
    k, c = np.polyfit(t, y, 1)
    rest = y - (k * t + c)
    return -k, 1 - rest.var() / max(y.var(), 1e-300)


def find_peaks(samples, rate, below_Hz):
    """(n, 3): frequency Hz, damping 1/s and straightness 0 .. 1 of every decaying peak, ascending."""
    size = int(window_s(samples, rate) * rate)
    spectra, hop = frames_of(samples, size)
    if not len(spectra):
        return np.zeros((0, 3))
    early = np.sqrt((spectra[:max(FEWEST_FRAMES, len(spectra) // 4)] ** 2).mean(axis=0))
    logs = np.log(np.maximum(spectra, 1e-300))
    log_early = np.log(np.maximum(early, 1e-300))
    noise = np.median(logs[-max(1, len(logs) // 8):], axis=0)
    times = np.arange(len(spectra)) * hop / rate
    found = []
    for i in range(2, min(len(early) - 2, int(below_Hz * PAD * size / rate))):
        if early[i] < early[i - 1] or early[i] <= early[i + 1] or log_early[i] < log_early.max() - PEAK_DB * np.log(10) / 20:
            continue
        damping, straight = slope(times, logs[:, i], np.median(noise[max(0, i - 40):i + 40]))
        if damping is not None and damping > 0:
            found.append((peak_between_bins(log_early, i) * rate / (PAD * size), damping, straight))
    return np.array(found).reshape(-1, 3)
