"""Decodes the marker cells at the lower left edge of a frame of visual_node; frame/marker.h defines their layout.

  tactus --module tactus.log.marker video.mp4     one line per frame: index in the file, frame number, events that flash
"""
import subprocess
import sys

import numpy as np

CELL, CELLS, ROWS = 4, 68, 12
MOTION_ROWS = 4
EVENT, MOTION = [1, 0, 1, 0], [0, 1, 1, 0]  # first four cells of a row


def _crc8(data):
    crc = 0
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1) ^ 0x07 if crc & 0x80 else crc << 1
            crc &= 0xFF
    return crc


def decode_row(frame, row, beginning=None):
    """(frame number, payload) of one row of a luma picture (rows from the top), or None. Payload: low 32 bits of the event id, or as
    the kind of row defines."""
    height, width = frame.shape
    y = height - CELL * (row + 1)
    if y < 0 or width < CELL * CELLS:
        return None
    # The inner 2 x 2 pixels of each cell, which compression changes least.
    inner = frame[y + 1:y + 3, :CELL * CELLS].reshape(2, CELLS, CELL)[:, :, 1:3].astype(float)
    bits = (inner.mean(axis=(0, 2)) > 127).astype(np.uint8)
    if list(bits[:4]) != (beginning or EVENT):
        return None
    data = np.packbits(bits[4:]).tobytes()
    if _crc8(data[:7]) != data[7]:
        return None
    return int.from_bytes(data[0:3], "big"), int.from_bytes(data[3:7], "big")


def frame_number(frame):
    """Number of the frame modulo 2^24, or None."""
    row = decode_row(frame, 0)
    return None if row is None else row[0]


def decode_frame(frame):
    """Low 32 bits of the ids of the events that flash in this frame, newest first, at most 12."""
    rows = (decode_row(frame, row) for row in range(ROWS))
    first = next(rows)
    if first is None:
        return []
    number, event = first
    events = [event] if event else []
    for row in rows:
        if row is None or row[0] != number:
            break
        events.append(row[1])
    return events


def decode_motion(frame):
    """{index of a tool: low 28 bits of the sequence number of its newest TOOL_STATE} of one frame; frame/motion_marker.h defines the layout."""
    samples = {}
    for row in range(ROWS, ROWS + MOTION_ROWS):
        found = decode_row(frame, row, MOTION)
        if found is None:
            break
        samples[found[1] >> 28] = found[1] & 0xFFFFFFF
    return samples


def frames_of(path):
    """Yields the frames of a video as luma (rows from the top), decoded by ffmpeg."""
    size = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v", "-show_entries", "stream=width,height",
                           "-of", "csv=p=0", path], check=True, capture_output=True, text=True).stdout
    width, height = (int(x) for x in size.strip().split(",")[:2])
    stream = subprocess.Popen(["ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "gray", "-"],
                              stdout=subprocess.PIPE)
    while len(raw := stream.stdout.read(width * height)) == width * height:
        yield np.frombuffer(raw, np.uint8).reshape(height, width)


def main(words):
    if len(words) != 1 or words[0] in ("-h", "--help"):
        sys.exit(__doc__)
    for index, frame in enumerate(frames_of(words[0])):
        print(index, frame_number(frame), *(f"{event:08x}" for event in decode_frame(frame)))
