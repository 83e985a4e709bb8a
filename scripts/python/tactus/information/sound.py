"""Features of the sound that a run presented: direction, loudness, timbre and times of its onsets."""
import math

import numpy as np

from tactus.information import noise
from tactus.log.sound_onsets import read_channels

AUDIBLE = 1e-4        # of full scale: inaudible_level in audio_node/settings.csv
BLOCK_S = 0.001       # of the envelope
RISE = 4.0            # of an onset over the loudest of the 30 ms before; design: 12 dB
REFRACTORY_S = 0.05   # no second onset within it; design: echo threshold
HEARD_S = 0.1         # of an onset, for level and spectrum; design
DIRECTION_S = 0.05
MAX_DECAY_S = 0.5
HEAD_M, SOUND_M_S = 0.0875, 343.0  # radius of Woodworth's head; the difference of times is r/c (a + sin a)
MAX_ITD_S = 0.9e-3


class Sound:
    """The samples of a WAV between two times."""

    def __init__(self, channels, rate):
        self.channels, self.rate = channels, rate
        block = int(round(BLOCK_S * rate))
        whole = len(channels) // block * block
        level = np.abs(channels[:whole]).max(axis=1) if whole else np.zeros(0)
        self.envelope = level.reshape(-1, block).max(axis=1)

    def onsets(self):
        """Block numbers of the onsets, in order."""
        found, last = [], -10**9
        gap = int(round(REFRACTORY_S / BLOCK_S))
        for i, level in enumerate(self.envelope):
            before = self.envelope[max(0, i - 30):max(0, i - 2)]
            if level > AUDIBLE and i - last > gap and level > RISE * max(before.max() if len(before) else 0.0, AUDIBLE / RISE):
                found.append(i)
                last = i
        return found

    def samples(self, block, seconds):
        begin = int(block * BLOCK_S * self.rate)
        return self.channels[begin:begin + int(seconds * self.rate)]

    def azimuth_deg(self, block):
        """Direction of an onset from the difference of times between the ears, positive to the left; 0 with one channel."""
        heard = self.samples(block, DIRECTION_S)
        if heard.shape[1] < 2:
            return 0.0
        left, right = heard[:, 0], heard[:, 1]
        most = int(MAX_ITD_S * self.rate)
        lags = np.arange(-most, most + 1)
        score = np.array([np.dot(left[max(0, -k):len(left) - max(0, k)], right[max(0, k):len(right) - max(0, -k)]) for k in lags])
        i = int(np.argmax(score))
        lag = float(lags[i])
        if 0 < i < len(score) - 1 and (curve := score[i - 1] - 2 * score[i] + score[i + 1]) < 0:
            lag += 0.5 * (score[i - 1] - score[i + 1]) / curve
        return azimuth_of_itd_deg(lag / self.rate)

    def level_dB(self, block):
        return 20 * math.log10(max(float(np.sqrt(np.mean(self.samples(block, HEARD_S)**2))), 1e-9))

    def centroid_Hz(self, block):
        heard = self.samples(block, HEARD_S).mean(axis=1)
        power = np.abs(np.fft.rfft(heard))**2
        return float(np.sum(np.fft.rfftfreq(len(heard), 1 / self.rate) * power) / max(power.sum(), 1e-30))

    def decay_s(self, block):
        """Time until the envelope is 20 dB below its peak, at most until the next onset."""
        later = [o for o in self.onsets() if o > block]
        end = min([block + int(MAX_DECAY_S / BLOCK_S), len(self.envelope), *later[:1]])
        heard = self.envelope[block:end]
        peak = int(np.argmax(heard))
        loud = np.flatnonzero(heard >= 0.1 * heard[peak])
        return max(BLOCK_S, (int(loud[-1]) + 1 - peak) * BLOCK_S)


def azimuth_of_itd_deg(itd_s):
    """Angle in the horizontal plane whose difference of times between the ears this is (Woodworth 1938, Experimental Psychology)."""
    wanted = float(np.clip(itd_s * SOUND_M_S / HEAD_M, -math.pi / 2 - 1, math.pi / 2 + 1))
    low, high = -math.pi / 2, math.pi / 2
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if middle + math.sin(middle) < wanted else (low, middle)
    return math.degrees((low + high) / 2)


def read(path, clock, begin_ns, end_ns):
    """The sound of audio.wav between two host times. clock: pairs (sample, host ns)."""
    channels, rate = read_channels(path)
    at = lambda ns: int(max(0, np.interp(ns, clock[:, 1], clock[:, 0]) + max(0.0, ns - clock[-1, 1]) * 1e-9 * rate))
    return Sound(channels[at(begin_ns):at(end_ns)], rate)


def features(sound):
    """[(name, values, standard deviations, share of confused percepts)] of one window."""
    n = noise.values()
    onsets = sound.onsets()
    peaks = {o: float(sound.envelope[o:o + 50].max()) for o in onsets}
    order = sorted(onsets, key=peaks.get, reverse=True)
    confused = noise.confusion(n["sound_material_right"], 3)
    time_sd = lambda t: math.hypot(n["sound_onset"] * 1e-3, n["duration"] * t)
    if not onsets:
        return [("heard", [0.0], [0.01], 0.0), ("direction", [0.0], [1.0], 0.0), ("loudness", [0.0], [1.0], 0.0), ("timbre", [0.0, 0.0], [1.0, 1.0], confused),
                ("times", [0.0, 0.0], [1.0, 1.0], 0.0)]
    loudest = order[0]
    azimuth = sound.azimuth_deg(loudest)
    azimuth_sd = n["azimuth"] * (1 + (n["azimuth_side_factor"] - 1) * abs(math.sin(math.radians(azimuth))))
    first, between = onsets[0] * BLOCK_S, abs(order[1] - order[0]) * BLOCK_S if len(order) > 1 else 0.0
    return [("heard", [1.0], [0.01], 0.0), ("direction", [azimuth], [azimuth_sd], 0.0),
            ("loudness", [sound.level_dB(loudest)], [noise.weber_sd(n["loudness"])], 0.0),
            ("timbre", [math.log(max(sound.centroid_Hz(loudest), 1.0)), math.log(sound.decay_s(loudest))],
             [noise.weber_sd(n["brightness"]), noise.weber_sd(n["decay"])], confused),
            ("times", [first, between], [time_sd(first), time_sd(between)], 0.0)]
