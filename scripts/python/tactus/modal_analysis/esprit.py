"""Frequencies and dampings of decaying sines by ESPRIT in sub-bands (Roy and Kailath 1989; in sub-bands: Sirdey et al., "Modal
analysis of impact sounds with ESPRIT in Gabor transforms", DAFx 2011).

A band of the signal is shifted to 0 Hz, low-passed and decimated. Once the filter is filled with signal, it passes a damped sine as the
same damped sine, so the poles of the decimated band are exactly those of the signal.
"""
import numpy as np

BAND_HZ = 1000.0  # holds about ten modes of a plate; design
OVERLAP_HZ = 10.0  # a mode at an edge is found in both bands and kept once
SAME_HZ = 1.0  # closer modes of two bands at their common edge are one mode
MAX_DECIMATED = 720  # samples of a band; the cost of more grows with the cube, without a benefit
MAX_ROWS = 240
STOP_DB = 90.0
FASTEST_1_S = 2000.0  # a decay within 3 ms is part of the blow
# A dominant mode of a band has a much smaller error than its weaker neighbours; ESTER_GOOD limits its influence (design).
ESTER_KEEP, ESTER_GOOD = 0.05, 100.0
NOISE_FACTOR = 4.0  # design


def kaiser_lowpass(pass_Hz, stop_Hz, rate_Hz):
    """Odd-length linear-phase filter (Kaiser; Oppenheim and Schafer, eq. 7.62 to 7.64)."""
    width = 2 * np.pi * (stop_Hz - pass_Hz) / rate_Hz
    taps = int(np.ceil((STOP_DB - 8) / (2.285 * width))) | 1
    n = np.arange(taps) - taps // 2
    cut = (pass_Hz + stop_Hz) / rate_Hz
    return cut * np.sinc(cut * n) * np.kaiser(taps, 0.1102 * (STOP_DB - 8.7))


def band_signal(samples, rate, centre_Hz, width_Hz):
    """(complex samples of the band around a centre at a lower rate, from the first sample with a filled filter; rate in Hz)."""
    step = max(1, int(rate / (2 * width_Hz)))
    shifted = samples * np.exp(-2j * np.pi * centre_Hz / rate * np.arange(len(samples)))
    if step == 1:
        return shifted, rate
    taps = kaiser_lowpass(width_Hz / 2 + OVERLAP_HZ, rate / step - width_Hz / 2 - OVERLAP_HZ, rate)
    if len(taps) >= len(samples) // 2:
        return shifted[:0], rate / step
    size = 1 << int(np.ceil(np.log2(len(samples) + len(taps))))
    low = np.fft.ifft(np.fft.fft(shifted, size) * np.fft.fft(taps, size))
    return low[len(taps) - 1:len(samples):step], rate / step


def hankel(x, rows):
    return np.lib.stride_tricks.sliding_window_view(x, len(x) - rows + 1)[:rows]


def signal_space(x):
    """Eigenvectors of the covariance of the Hankel matrix and its singular values, both descending."""
    rows = min(MAX_ROWS, len(x) // 2)
    h = hankel(x, rows)
    values, vectors = np.linalg.eigh(h @ h.conj().T)
    return vectors[:, ::-1], np.sqrt(np.maximum(values[::-1], 0))


def rotation(vectors, order):
    """Least-squares solution of the shift invariance U_down Phi = U_up, and its error (that of ESTER)."""
    down, up = vectors[:-1, :order], vectors[1:, :order]
    # (U_down^H U_down)^-1 by the matrix inversion lemma: the columns of U are orthonormal.
    last = vectors[-1, :order]
    product = down.conj().T @ up
    left = 1 - np.vdot(last, last).real
    phi = product + np.outer(last.conj(), last @ product) / max(left, 1e-12)
    return phi, np.linalg.norm(up - down @ phi, 2)


def order_of(vectors, singular, most):
    """Number of modes (Badeau, David, Richard, "A new perturbation analysis for signal enumeration", IEEE Trans. Signal Process. 54
    (2006)): the largest one whose shift invariance is nearly as exact as the best. Only singular values above the noise, which is
    estimated from their lower half, are tried."""
    floor = max(NOISE_FACTOR * np.median(singular[len(singular) // 2:]), 1e-7 * singular[0])
    tried = min(most, int(np.sum(singular > floor)), len(singular) - 2)
    if tried < 1:
        return 0
    inverse = np.array([1 / max(rotation(vectors, p)[1], 1e-12) for p in range(1, tried + 1)])
    return 1 + int(np.nonzero(inverse >= ESTER_KEEP * min(inverse.max(), ESTER_GOOD))[0][-1])


def poles_of_band(x, most):
    if len(x) < 12:
        return np.zeros(0, complex)
    x = x[:MAX_DECIMATED]
    vectors, singular = signal_space(x)
    order = order_of(vectors, singular, most) if singular[0] > 0 else 0
    return np.linalg.eigvals(rotation(vectors, order)[0]) if order else np.zeros(0, complex)


def find_poles(samples, rate, below_Hz, max_in_band=40):
    """(n, 2): damped frequency, Hz, and damping, 1/s, of all decaying modes, ascending. `samples` starts after the blow."""
    found = []
    for band in range(int(np.ceil(below_Hz / BAND_HZ))):
        centre = (band + 0.5) * BAND_HZ
        x, band_rate = band_signal(samples, rate, centre, BAND_HZ)
        for z in poles_of_band(x, max_in_band):
            frequency = centre + np.angle(z) * band_rate / (2 * np.pi)
            damping = -np.log(max(abs(z), 1e-12)) * band_rate
            inside = abs(frequency - centre) <= BAND_HZ / 2 + OVERLAP_HZ and 0 < frequency < below_Hz
            if inside and 0 < damping < FASTEST_1_S:
                found.append((frequency, damping, band))
    found.sort()
    return np.array([(f, d) for f, d in merged(found)]).reshape(-1, 2)


def merged(found):
    """[(frequency, damping)]; of a mode found in two neighbouring bands, keeps the one nearer to the middle of its band."""
    kept = []
    for frequency, damping, band in found:
        if kept and kept[-1][2] != band and frequency - kept[-1][0] < max(SAME_HZ, (damping + kept[-1][1]) / 20):
            centre = lambda entry: abs(entry[0] - (entry[2] + 0.5) * BAND_HZ)
            if centre((frequency, damping, band)) < centre(kept[-1]):
                kept[-1] = (frequency, damping, band)
            continue
        kept.append((frequency, damping, band))
    return [(f, d) for f, d, _ in kept]
