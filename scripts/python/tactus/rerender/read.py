"""Reads the files of a rendering or of a run as arrays."""
import subprocess

import numpy as np

from tactus.log import sound_onsets
from tactus.tables import read_rows

STRIDE = 4  # design: only every fourth pixel of every fourth row is compared


def nanoseconds(text):
    """ns of a text of seconds with nine decimals, exact, unlike a float."""
    whole, _, rest = text.partition(".")
    return int(whole) * 1_000_000_000 + int((rest + "0" * 9)[:9])


def forces(path, tool=None):
    """{(host ns, seq): force, N} of one tool; None: the first in the file."""
    found = {}
    for row in read_rows(path):
        tool = row["tool"] if tool is None else tool
        if row["tool"] == tool and row["host_s"]:
            found[(nanoseconds(row["host_s"]), row["seq"])] = [float(row[f"force_{axis}_N"]) for axis in "xyz"]
    return found


def tool_of(path):
    """Number of the tool of a table, as text; None for an empty one."""
    return next((row["tool"] for row in read_rows(path)), None)


def temperatures(path, tool=None):
    """(host ns, skin, command) of one tool, each an array."""
    rows_of_tool = [row for row in read_rows(path) if row["host_s"] and (tool is None or row["tool"] == tool)]
    column = lambda name: np.array([float(row[name]) for row in rows_of_tool])
    return np.array([nanoseconds(row["host_s"]) for row in rows_of_tool], dtype=float), column("skin_degC"), column("commanded_degC")


def pictures(path, wanted):
    """Yields (number, sRGB bytes of the sampled pixels) of the wanted frames of a video."""
    size = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries", "stream=width,height", "-of", "csv=p=0", path],
                          capture_output=True, text=True, check=True).stdout.strip()
    width, height = (int(n) for n in size.split(",")[:2])
    words = ["ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    with subprocess.Popen(words, stdout=subprocess.PIPE) as decoder:
        number = 0
        while len(data := decoder.stdout.read(width * height * 3)) == width * height * 3:
            if number in wanted:
                yield number, np.frombuffer(data, np.uint8).reshape(height, width, 3)[::STRIDE, ::STRIDE]
            number += 1


class Sound:
    """A WAV and the output time of its samples."""

    def __init__(self, path, first_sample_ns=None, clock=None):
        """clock: (index, host ns) pairs of a run; otherwise first_sample_ns is the output time of the first sample."""
        self.samples, self.rate = sound_onsets.read_wav(path)
        self.clock = clock if clock is not None else np.array([[0, first_sample_ns]], dtype=float)

    def at(self, host_ns):
        return sound_onsets.index_at(self.clock, host_ns, self.rate)

    def host_ns(self, index):
        i = int(np.clip(np.searchsorted(self.clock[:, 0], index) - 1, 0, len(self.clock) - 1))
        return self.clock[i, 1] + (index - self.clock[i, 0]) / self.rate * 1e9

    def onset_ns(self, presented_ns):
        """Time of the onset near a reported presentation, ns; None without a clear onset."""
        found = sound_onsets.onset(self.samples, self.at(presented_ns), self.rate)
        return None if found is None else self.host_ns(found)

    def isolated(self, times):
        """Keys of {key: ns} without another event nearby."""
        before, after = sound_onsets.ALONE_BEFORE_S * 1e9, sound_onsets.ALONE_AFTER_S * 1e9
        order = sorted(times, key=times.get)
        at = [times[key] for key in order]
        return [key for i, key in enumerate(order)
                if (i == 0 or at[i] - at[i - 1] >= before) and (i + 1 == len(at) or at[i + 1] - at[i] >= after)]

    def onsets_ns(self, times):
        """{key: ns} of the lone events with a clear onset."""
        found = ((key, self.onset_ns(times[key])) for key in self.isolated(times))
        return {key: at for key, at in found if at is not None}
