"""Sees: when the frame that first shows a hit was really out, by the pictures that visual_node streams and the marker in their pixels."""
import base64
import bisect
import io

import numpy as np
from PIL import Image

from tactus.log import marker

SEEN_WITHIN_S = 1.5     # as the ear
NEAR_NS = 100_000_000   # about the expected frame: six periods of 60 Hz, more than any lateness that is not dropped (design)
FRAMES = 1 << 24        # the marker's numbers come again (visual_node/frame/marker.h)
SETTINGS = ("stream=60", "stream_width=4096", "width=320", "height=240")  # every picture, its marker unscaled, 1 MB/s at the most (visual_node/video/picture_stream.h)


def luma(jpeg):
    """The picture as rows from the top, one byte a pixel; None: it is none."""
    try:
        return np.asarray(Image.open(io.BytesIO(base64.b64decode(jpeg))).convert("L"))
    except OSError:
        return None


def first_that_shows(pictures, event):
    """Instant of the first of (at_ns, luma), in order, in which the event flashes, ns; None: in none, or the frame before it is not among them, so
    that it may have flashed there already."""
    before = None
    for at_ns, picture in pictures:
        number = None if picture is None else marker.frame_number(picture)
        if number is None:
            continue
        if event & 0xFFFFFFFF in marker.decode_frame(picture):
            return at_ns if before == (number - 1) % FRAMES else None
        before = number
    return None


class Eye:
    """Looks at the pictures that a Lead keeps."""

    def __init__(self, lead):
        self.lead = lead

    def onset_ns(self, event, expected_ns):
        """When the first frame was out that shows the event, host time; None: it cannot be told."""
        pictures = self.lead.pictures
        if not self.lead.wait_for(lambda: pictures and pictures[-1][0] > expected_ns + NEAR_NS / 2, SEEN_WITHIN_S):
            return None
        kept = sorted(pictures)
        begin = bisect.bisect_left(kept, expected_ns - NEAR_NS, key=lambda p: p[0])
        return first_that_shows(((at_ns, luma(jpeg)) for at_ns, jpeg in kept[begin:]), event)
