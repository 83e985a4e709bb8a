"""Audio perception of a simulated participant: onset time of the sound of a hit, from the samples of audio.wav while it is written. After a restart of
audio_node it is audio.2.wav."""
import pathlib

import numpy as np

SAMPLES_TIMEOUT_S = 1.5  # until the samples are on the disk; the writer runs a few times a second
QUIET_S, NEAR_S = 0.030, (0.018, 0.025)  # before the expected onset, and around it; as tests/measure/measure_onsets
RISE = 1e-4  # share of the peak at which an onset counts; finds the first sample of a tap in a silent scene (tests/measure/measure_soa)


class SoundDetector:
    """Reads the recording of audio_node in the folder; a TrialRunnerClient provides the presentation times of its samples."""

    def __init__(self, out, runner):
        self.out, self.runner = pathlib.Path(out), runner
        self.path = self.layout = None

    def open_file(self, name):
        if self.path is None or self.path.name != name:
            self.path, self.layout = self.out / name, None

    def _layout(self):
        """(first byte of the samples, dtype, channels, rate) from the header; None: not written yet. Reads only the formats of audio_node."""
        if self.layout is None and self.path.exists():
            with open(self.path, "rb") as file:
                head = file.read(4096)
            at, form = 12, None
            while at + 8 <= len(head):
                name, size = head[at:at + 4], int.from_bytes(head[at + 4:at + 8], "little")
                body = head[at + 8:at + 8 + size]
                if name == b"fmt ":
                    kind = int.from_bytes(body[0:2], "little")
                    kind = int.from_bytes(body[24:26], "little") if kind == 0xFFFE else kind
                    form = {(3, 32): "<f4", (1, 16): "<i2", (1, 32): "<i4"}[kind, int.from_bytes(body[14:16], "little")], \
                        int.from_bytes(body[2:4], "little"), int.from_bytes(body[4:8], "little")
                if name == b"data" and form:
                    self.layout = (at + 8, *form)
                    break
                at += 8 + size + size % 2
        return self.layout

    def _samples(self, begin, end):
        """Mean over the channels of samples begin .. end; None: not all are on the disk yet."""
        first, dtype, channels, _ = self.layout
        width = np.dtype(dtype).itemsize * channels
        if begin < 0 or self.path.stat().st_size < first + end * width:
            return None
        with open(self.path, "rb") as file:
            file.seek(first + begin * width)
            data = np.frombuffer(file.read((end - begin) * width), dtype)
        return data.astype(float).reshape(-1, channels).mean(axis=1)

    def onset_ns(self, expected_ns):
        """Presentation time of the first sample of a sound near the expected time, host time in ns; None: no onset there."""
        candidates = [(abs(at_ns - expected_ns), name, index, at_ns) for name, pairs in self.runner.media.items() for index, at_ns in pairs]
        if not candidates:
            return None
        _, name, index, at_ns = min(candidates)
        self.open_file(name)
        if self._layout() is None:
            return None
        rate = self.layout[3]
        expected = index + (expected_ns - at_ns) * 1e-9 * rate
        begin, end = int(expected - QUIET_S * rate), int(expected + NEAR_S[1] * rate)
        if not self.runner.wait_for(lambda: self._samples(begin, end) is not None, SAMPLES_TIMEOUT_S):
            return None
        samples = np.abs(self._samples(begin, end))
        quiet = int((QUIET_S - NEAR_S[0]) * rate)
        level, near = samples[:quiet].max() + 1e-5, samples[quiet:]
        if near.max() < 4 * level:
            return None
        found = begin + quiet + int(np.argmax(near > 1.5 * level + RISE * near.max()))
        return at_ns + (found - index) / rate * 1e9
