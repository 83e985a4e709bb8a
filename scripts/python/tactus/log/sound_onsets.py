"""Onsets of sound in the WAV of a run, and the output time of each sample."""
import numpy as np

from tactus.refusal import Refusal

ALONE_BEFORE_S, ALONE_AFTER_S = 0.060, 0.025  # minimum time to the hits before and after an evaluated one


def read_wav(path):
    """(samples as floats, mean of the channels; rate in Hz). Raises Refusal."""
    samples, rate = read_channels(path)
    return samples.sum(axis=1) / samples.shape[1], rate


def read_channels(path):
    """(samples as floats [sample, channel]; rate in Hz). Parses the file itself, because the module wave reads only integers. Raises Refusal."""
    with open(path, "rb") as file:
        data = file.read()
    position, kind, channels, rate, bits = 12, 1, 2, 48000, 16
    while position + 8 <= len(data):
        name, size = data[position:position + 4], int.from_bytes(data[position + 4:position + 8], "little")
        body = data[position + 8:position + 8 + size]
        if name == b"fmt ":
            kind, channels = int.from_bytes(body[0:2], "little"), int.from_bytes(body[2:4], "little")
            rate, bits = int.from_bytes(body[4:8], "little"), int.from_bytes(body[14:16], "little")
            if kind == 0xFFFE:
                kind = int.from_bytes(body[24:26], "little")
        if name == b"data":
            size = size or len(data) - position - 8
            body = data[position + 8:position + 8 + size]
            dtype = {(3, 32): "<f4", (1, 16): "<i2", (1, 32): "<i4"}[(kind, bits)]
            body = body[:len(body) - len(body) % (channels * bits // 8)]
            samples = np.frombuffer(body, dtype).astype(float) / (1.0 if kind == 3 else 2.0 ** (bits - 1))
            return samples.reshape(-1, channels), rate
        position += 8 + size + size % 2
    raise Refusal(f"{path} has no samples; give the audio.wav of a complete run")


def clock_of(pairs, medium):
    """(index, host ns) of one file, in order. Raises Refusal."""
    rows = sorted({(int(p["index"]), int(p["host_ns"])) for p in pairs if p["medium"] == medium})
    if len(rows) < 2:
        raise Refusal(f"the log has no clock of {medium}; use a run of more than a second")
    return np.array(rows, dtype=float)


def index_at(clock, host_ns, rate):
    """Sample index at a host time: from the previous pair of the clock and the nominal rate."""
    host = clock[:, 1]
    i = int(np.clip(np.searchsorted(host, host_ns) - 1, 0, len(host) - 1))
    return clock[i, 0] + (host_ns - host[i]) * 1e-9 * rate


def onset(samples, expected, rate, rise=0.02):
    """First sample near the index `expected` that exceeds the level before it by `rise` of the peak; None without a clear onset."""
    begin, end = int(expected - 0.018 * rate), int(expected + 0.025 * rate)
    quiet = int(expected - 0.030 * rate)
    if quiet < 0 or end >= len(samples):
        return None
    level = np.abs(samples[quiet:begin]).max() + 1e-5
    near = np.abs(samples[begin:end])
    if near.max() < 4 * level:
        return None
    return begin + int(np.argmax(near > 1.5 * level + rise * near.max()))
