"""Reads recordings: WAV directly, because Python's wave module reads integer samples only; other formats through ffmpeg."""
import shutil
import subprocess

import numpy as np

from tactus import own_files
from tactus.refusal import Refusal

FEWEST_SAMPLES = 256
LONGEST_S = 60  # longer than the ringing of any struck object; design
LARGEST, SMALLEST = 1e100, 1e-100  # of samples: their squares stay numbers
WAYS = {(1, 8): "u1", (1, 16): "<i2", (1, 24): "24", (1, 32): "<i4", (3, 32): "<f4", (3, 64): "<f8"}


def chunks_of(data):
    position = 12
    while position + 8 <= len(data):
        size = int.from_bytes(data[position + 4:position + 8], "little")
        # The size is 0 or all ones if the writer was killed: the samples extend to the end of the file.
        if data[position:position + 4] == b"data" and (size == 0 or position + 8 + size > len(data)):
            size = len(data) - position - 8
        yield data[position:position + 4], data[position + 8:position + 8 + size]
        position += 8 + size + size % 2


def decoded(body, kind, bits):
    way = WAYS[(kind, bits)]
    if way == "24":
        bytes_of = np.frombuffer(body[:len(body) - len(body) % 3], np.uint8).reshape(-1, 3).astype(np.int32)
        value = bytes_of[:, 0] | bytes_of[:, 1] << 8 | bytes_of[:, 2] << 16
        return (value - ((value & 0x800000) << 1)) / 2.0 ** 23
    samples = np.frombuffer(body[:len(body) - len(body) % (bits // 8)], way).astype(float)
    if way == "u1":
        return (samples - 128) / 128
    return samples if kind == 3 else samples / 2.0 ** (bits - 1)


def read_wav(path, data):
    kind = channels = rate = bits = None
    for name, body in chunks_of(data):
        if name == b"fmt " and len(body) >= 16:
            kind, channels = int.from_bytes(body[0:2], "little"), int.from_bytes(body[2:4], "little")
            rate, bits = int.from_bytes(body[4:8], "little"), int.from_bytes(body[14:16], "little")
            if kind == 0xFFFE and len(body) >= 26:  # WAVE_FORMAT_EXTENSIBLE stores the kind later
                kind = int.from_bytes(body[24:26], "little")
        if name == b"data" and kind is not None:
            if (kind, bits) not in WAYS or not 1 <= channels <= 64 or not 1000 <= rate <= 400000:
                raise Refusal(f"{path} is a WAV of kind {kind} with {bits} bits, {channels} channels and {rate} Hz, which cannot be read; "
                              "save it as PCM or float")
            samples = decoded(body, kind, bits)
            return samples[:len(samples) - len(samples) % channels].reshape(-1, channels), rate
    raise Refusal(f"{path} is a WAV without samples; record it again")


def read_by_ffmpeg(path):
    if not shutil.which("ffmpeg"):
        raise Refusal(f"{path} is not a WAV file, and ffmpeg, which reads other formats, is not installed; run apt-get install ffmpeg")
    probe = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "a:0", "-show_entries", "stream=sample_rate,channels", "-of",
                            "csv=p=0", f"file:{path}"], capture_output=True, text=True, errors="replace")
    numbers = probe.stdout.strip().split(",")[:2]
    if probe.returncode or len(numbers) != 2 or not all(n.isdigit() for n in numbers):
        raise Refusal(f"{path} holds no readable sound; give a WAV or FLAC file")
    rate, channels = int(numbers[0]), int(numbers[1])
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", f"file:{path}", "-map", "0:a:0", "-t", str(LONGEST_S), "-f", "f32le", "-"],
                         capture_output=True).stdout
    samples = np.frombuffer(raw[:len(raw) - len(raw) % (4 * channels)], "<f4").astype(float)
    return samples.reshape(-1, channels), rate


def read_channels(path):
    """Samples, full scale 1, as frames x channels, and the rate in Hz. Raises Refusal."""
    try:
        with own_files.open_regular(path) as file:
            data = file.read()
    except OSError as e:
        raise Refusal(f"{path}: {e.strerror}; give a WAV or FLAC file") from e
    if not data:
        raise Refusal(f"{path} is empty; record it again")
    is_wav = data[:4] == b"RIFF" and data[8:12] == b"WAVE"
    samples, rate = read_wav(path, data) if is_wav else read_by_ffmpeg(path)
    samples = samples[:LONGEST_S * rate]
    if len(samples) < FEWEST_SAMPLES:
        raise Refusal(f"{path} has {len(samples)} samples, too few to analyse; give a recording of at least {FEWEST_SAMPLES} samples")
    if not np.isfinite(samples).all():
        raise Refusal(f"{path} contains samples that are not numbers; record it again")
    if np.abs(samples).max() > LARGEST:
        raise Refusal(f"{path} contains samples of {np.abs(samples).max():.3g}, and full scale is 1; save it with a smaller gain")
    if not np.abs(samples).max() > SMALLEST:
        raise Refusal(f"{path} is silent; record a blow")
    return samples, rate


def read_sound(path):
    """Mean of the channels, and the rate in Hz. If the channels cancel each other, the loudest one is used."""
    channels, rate = read_channels(path)
    mono = channels.mean(axis=1)
    loudest = channels[:, np.argmax((channels ** 2).sum(axis=0))]
    return (mono if (mono ** 2).sum() > 0.05 * (loudest ** 2).sum() else loudest), rate
