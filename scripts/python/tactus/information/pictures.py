"""Pictures that a run presented: every pixel of every look, so that a thing is seen where the picture shows it and not where the scene has it."""
import math
import subprocess

import numpy as np

from tactus.information import noise
from tactus.refusal import Refusal
from tactus.tables import read_rows

LOOKS_HZ = 4  # pictures a second, each a look: a fixation takes about 250 ms (unverified)
VGA_WIDTH = 640  # of the picture to which the noise of a pixel applies


def read(video, frames, width, height, begin_ns, end_ns):
    """The pictures between two host times: bytes [look, row, column, colour]. Raises Refusal."""
    words = ["ffmpeg", "-v", "error", "-i", str(video), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    try:
        data = subprocess.run(words, capture_output=True, check=True, stdin=subprocess.DEVNULL).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        raise Refusal(f"cannot read the pictures of {video} ({error}); install the packages of the group run") from error
    every = np.frombuffer(data, np.uint8).reshape(-1, height, width, 3)
    at = [int(row["host_ns"]) for row in read_rows(frames)]
    return every[[i for i, ns in enumerate(at[:len(every)]) if begin_ns <= ns < end_ns]]


def channel_sd(width):
    """Standard deviation of a channel of a pixel, as a share of full contrast. The d' of a change is the root of the sum of its squares over pixels and
    channels, over this; a grey change changes three channels."""
    return math.sqrt(3 * noise.values()["visual_area"]) * width / VGA_WIDTH


def coordinates(pictures, width):
    """Coordinates [picture, k] whose distances are the d' between the pictures (a list of byte arrays of one shape). Exact: independent noise of the pixels
    is independent noise of standard deviation 1 of the coordinates."""
    flat = [p.reshape(-1) for p in pictures]
    differs = np.zeros(flat[0].shape, bool)
    for p in flat[1:]:
        differs |= p != flat[0]
    if not differs.any():
        return np.zeros((len(flat), 1))
    x = np.stack([p[differs].astype(np.float64) for p in flat]) / (255 * channel_sd(width))
    x -= x.mean(axis=0)
    size, vectors = np.linalg.eigh(x @ x.T)
    return vectors * np.sqrt(np.maximum(size, 0.0))
