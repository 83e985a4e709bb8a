"""The modes of a struck object from a recording, by ESPRIT, cross-checked with the decay of spectral peaks."""
from dataclasses import dataclass

import numpy as np

from tactus.modal_analysis import damping, decay, esprit
from tactus.refusal import Refusal

AFTER_BLOW_S = 0.005  # the force pulse of a hard blow has ended; design
LOWEST_HZ = 20.0  # lowest frequency that is heard as a tone
LONGEST_S = 4.0  # analysed duration
WEAKEST_DB = 60.0  # below the strongest mode
MAX_LOST_DB = 26.0  # decay before the start of the analysis; faster decays are part of the blow, with unreliable amplitudes (design)
STANDS_OUT_DB = 10.0  # above the residual without all modes; design
AMPLITUDE_SAMPLES = 12000
# Tolerances within which ESPRIT and decay agree on a mode: design, from the resolution of the shortest window and audibility.
SAME_SHARE, SAME_HZ, SAME_DAMPING = 0.002, 3.0, 0.15


@dataclass
class Mode:
    frequency_Hz: float  # undamped: sqrt(f_d^2 + (d / 2 pi)^2)
    damping_1_s: float
    amplitude: float  # at the onset, full scale 1
    phase_rad: float  # of the cosine, at the start of the analysis
    decay_frequency_Hz: float = float("nan")  # by the decay of spectral peaks; NaN: it found no such mode
    decay_damping_1_s: float = float("nan")
    agrees: bool = False

    @property
    def damped_Hz(self):
        return float(np.sqrt(max(self.frequency_Hz ** 2 - (self.damping_1_s / (2 * np.pi)) ** 2, 0)))


@dataclass
class Analysis:
    modes: list  # ascending
    samples: np.ndarray  # from the onset on
    rate: int
    begins: int  # start of the analysed part, samples after the onset
    law: dict  # damping.fit


def onset_of(samples, rate):
    """First sample of the loudest blow: the end of the last part before the peak with an envelope below a tenth of it."""
    size = max(1, int(0.001 * rate))
    envelope = np.maximum.reduceat(np.abs(samples), np.arange(0, len(samples), size))
    peak = int(np.argmax(envelope))
    quiet = np.nonzero(envelope[:peak + 1] < 0.1 * envelope[peak])[0]
    return (int(quiet[-1]) + 1) * size if len(quiet) else 0


def loudest_at(samples, rate):
    """Start of the analysis: AFTER_BLOW_S after the sample with the largest amplitude."""
    near = np.abs(samples[:int(0.05 * rate)])
    return int(np.argmax(near)) + int(AFTER_BLOW_S * rate)


def waves(poles, rate, count, start=0):
    """exp(-d t) cos(w t) and exp(-d t) sin(w t) of each pole as columns; t starts at `start` samples."""
    step = (-poles[:, 1] + 2j * np.pi * poles[:, 0]) / rate
    fine, coarse = np.arange(64)[None, :, None], np.arange(start, start + count, 64)[:, None, None]
    turning = (np.exp(step * coarse) * np.exp(step * fine)).reshape(-1, len(poles))[:count]
    return np.concatenate([turning.real, -turning.imag], axis=1)


def amplitudes(samples, rate, poles):
    """Complex amplitude of each pole by least squares: x = sum Re(c exp(-d t + i w t))."""
    count = min(len(samples), max(AMPLITUDE_SAMPLES, 8 * len(poles)))
    basis = waves(poles, rate, count)
    scale = np.linalg.norm(basis, axis=0) + 1e-300
    basis /= scale
    # Normal equations; the pseudoinverse drops directions of nearly equal poles, which would get huge amplitudes of opposite signs.
    solution = np.linalg.pinv(basis.T @ basis, rcond=1e-11, hermitian=True) @ (basis.T @ samples[:count]) / scale
    return solution[:len(poles)] + 1j * solution[len(poles):]


def standing_out(samples, rate, poles, c):
    """Mask of the poles that rise above the residual near their frequency after removal of all modes."""
    count = min(len(samples), 1 << 15)
    window = np.hanning(2 * count + 1)[count:-1]  # starts at its maximum, like a decay
    rest = samples[:count].copy()
    for at in range(0, count, 8192):  # in pieces, to limit memory
        piece = min(8192, count - at)
        rest[at:at + piece] -= waves(poles, rate, piece, at) @ np.concatenate([c.real, c.imag])
    left = np.abs(np.fft.rfft(rest * window))
    spacing = rate / count
    t = np.arange(count) / rate
    kept = []
    for (frequency, d), amplitude in zip(poles, c):
        own = abs(amplitude) / 2 * np.sum(window * np.exp(-d * t))
        middle, wide = frequency / spacing, max(20.0, 3 * d) / spacing
        beside = left[max(0, int(middle - wide)):int(middle + wide) + 2]
        kept.append(own > 10 ** (STANDS_OUT_DB / 20) * np.sqrt(np.mean(beside ** 2)))
    return np.array(kept, bool)


def cross_check(modes, peaks):
    for mode in modes:
        if not len(peaks):
            continue
        nearest = peaks[np.argmin(np.abs(peaks[:, 0] - mode.damped_Hz))]
        if abs(nearest[0] - mode.damped_Hz) > max(4 * SAME_HZ, 4 * SAME_SHARE * mode.damped_Hz):
            continue
        mode.decay_frequency_Hz = float(np.hypot(nearest[0], nearest[1] / (2 * np.pi)))
        mode.decay_damping_1_s = float(nearest[1])
        mode.agrees = bool(abs(nearest[0] - mode.damped_Hz) <= max(SAME_HZ, SAME_SHARE * mode.damped_Hz) and
                           abs(nearest[1] - mode.damping_1_s) <= SAME_DAMPING * mode.damping_1_s)


def analyse(samples, rate, max_modes=64, below_Hz=16000.0, begin_s=None):
    """begin_s: start of the analysis after the onset, s; None: after the blow. Raises Refusal if nothing rings."""
    from_onset = samples[onset_of(samples, rate):]
    begins = loudest_at(from_onset, rate) if begin_s is None else int(begin_s * rate)
    ringing = from_onset[begins:begins + int(LONGEST_S * rate)]
    ringing = ringing - ringing.mean() if len(ringing) else ringing
    if len(ringing) < 256 or not ringing.any():
        raise Refusal("no ringing was found after the loudest moment; give a recording that rings for at least 0.1 s")
    poles = esprit.find_poles(ringing, rate, min(below_Hz, 0.49 * rate))
    poles = poles[poles[:, 0] > LOWEST_HZ]
    poles = poles[poles[:, 1] * max(begins / rate, AFTER_BLOW_S) < MAX_LOST_DB / 20 * np.log(10)]
    # Two passes: after removal of weak poles the amplitudes of the others change.
    for _ in range(2):
        if not len(poles):
            break
        c = amplitudes(ringing, rate, poles)
        poles = poles[standing_out(ringing, rate, poles, c)]
    if not len(poles):
        raise Refusal("no mode stands out from the noise, or it decays too fast; give a recording of a blow on a ringing object")
    c = amplitudes(ringing, rate, poles)
    at_onset = np.abs(c) * np.exp(poles[:, 1] * begins / rate)
    strong = np.abs(c) > np.abs(c).max() * 10 ** (-WEAKEST_DB / 20)
    # Keeps the modes with the most energy.
    order = [i for i in np.argsort(-np.abs(c) ** 2 / poles[:, 1]) if strong[i]][:max_modes]
    modes = [Mode(float(np.hypot(poles[i, 0], poles[i, 1] / (2 * np.pi))), float(poles[i, 1]), float(at_onset[i]), float(np.angle(c[i])))
             for i in sorted(order)]
    cross_check(modes, decay.find_peaks(ringing, rate, min(below_Hz, 0.49 * rate)))
    law = damping.fit([m.frequency_Hz for m in modes], [m.damping_1_s for m in modes], [m.amplitude for m in modes])
    return Analysis(modes, from_onset, rate, begins, law)


def resynthesis(analysis, count):
    """Samples of the modes alone, from the start of the analysis."""
    poles = np.array([(m.damped_Hz, m.damping_1_s) for m in analysis.modes])
    faded = np.array([m.amplitude * np.exp(-m.damping_1_s * analysis.begins / analysis.rate) for m in analysis.modes])
    c = faded * np.exp(1j * np.array([m.phase_rad for m in analysis.modes]))
    return np.concatenate([waves(poles, analysis.rate, min(8192, count - at), at) @ np.concatenate([c.real, c.imag])
                           for at in range(0, count, 8192)])
