"""Sound onsets and event flashes of a recorded run."""
import glob
import os

import numpy as np

from common import recorded
from tactus.log import marker
from tactus.log.sound_onsets import clock_of


def tables(out):
    """Events, presentations and media clocks of the log. Raises Refusal."""
    return recorded.tables(out, "events", "presented", "media_clock")


def host_ns(clock, index, rate, side="left"):
    """Host time of a sample: from the previous pair of the clock and the nominal rate."""
    i = int(np.clip(np.searchsorted(clock[:, 0], index, side=side) - 1, 0, len(clock) - 1))
    return clock[i, 1] + (index - clock[i, 0]) / rate * 1e9


def first_frames(out, pairs):
    """{low 32 bits of an event id: host time in ns of the first frame that names it}."""
    found = {}
    for path in sorted(glob.glob(os.path.join(out, "video*.mp4"))):
        clock = clock_of(pairs, os.path.basename(path))
        for index, frame in enumerate(marker.frames_of(path)):
            for event in marker.decode_frame(frame):
                found.setdefault(event, np.interp(index, clock[:, 0], clock[:, 1]))
    return found
