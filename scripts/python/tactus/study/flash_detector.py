"""Visual perception of a simulated participant: time of the first frame that shows a hit, from the pictures that visual_node streams and their pixel marker."""
import base64
import bisect
import io

import numpy as np
from PIL import Image

from tactus.log import marker

PICTURES_TIMEOUT_S = 1.5  # as for sound
NEAR_NS = 100_000_000   # around the expected frame: six periods of 60 Hz, longer than the lateness of any frame that is not dropped (design)
FRAMES = 1 << 24        # frame numbers of the marker repeat after this number (visual_node/frame/marker.h)
SETTINGS = ("stream=60", "stream_width=4096", "width=320", "height=240")  # every frame, marker unscaled, at most 1 MB/s (visual_node/video/picture_stream.h)


def luma(jpeg):
    """The picture as rows from the top, one byte a pixel; None: not a picture."""
    try:
        return np.asarray(Image.open(io.BytesIO(base64.b64decode(jpeg))).convert("L"))
    except OSError:
        return None


def first_that_shows(pictures, event):
    """Time in ns of the first of the (at_ns, luma), in order, whose marker shows the event. None: none does, or the preceding frame is absent, so that
    the event may have appeared earlier."""
    before = None
    for at_ns, picture in pictures:
        number = None if picture is None else marker.frame_number(picture)
        if number is None:
            continue
        if event & 0xFFFFFFFF in marker.decode_frame(picture):
            return at_ns if before == (number - 1) % FRAMES else None
        before = number
    return None


class FlashDetector:
    """Searches the pictures that a TrialRunnerClient stores."""

    def __init__(self, runner):
        self.runner = runner

    def onset_ns(self, event, expected_ns):
        """Presentation time of the first frame that shows the event, host time in ns; None: unknown."""
        pictures = self.runner.pictures
        if not self.runner.wait_for(lambda: pictures and pictures[-1][0] > expected_ns + NEAR_NS / 2, PICTURES_TIMEOUT_S):
            return None
        kept = sorted(pictures)
        begin = bisect.bisect_left(kept, expected_ns - NEAR_NS, key=lambda p: p[0])
        return first_that_shows(((at_ns, luma(jpeg)) for at_ns, jpeg in kept[begin:]), event)
