"""The messages of an LCM event log, by channel.

Layout of an event, all numbers big-endian (lcm/eventlog.c): sync word, number, time stamp in us, size of the channel's name,
size of the payload, name, payload. A payload begins with the fingerprint of its type (8 bytes) and header_t (48 bytes).
"""
import struct

SYNC_WORD = 0xEDA1DA01
EVENT = struct.Struct(">IQQII")
TIME = struct.Struct(">Q")
FINGERPRINT_BYTES = 8
HEADER_BYTES = 48  # header_t.lcm: sim_time_ns, publish_time_ns, clock, run_id, source, incarnation, seq
FIELDS = (("sim_time_ns", 0), ("publish_time_ns", 8), ("clock", 16), ("run_id", 20), ("source", 28), ("incarnation", 32), ("seq", 40))
PLAIN = ("LOG_TYPES", "LCM_SELF_TEST")  # text without fingerprint and header: sync/recorder_types.h, and LCM's own test of a bus
FINGERPRINTS = "(fingerprints)"
ORDER = "(order)"
TEXTS_OF_LOG_INFO = 2  # version and git, the first two fields of log_info_t behind its header


class Damaged(Exception):
    """One sentence on a log that cannot be read."""


def events(path):
    """(time stamp in us, channel, payload) of every event."""
    with open(path, "rb") as file:
        while head := file.read(EVENT.size):
            if len(head) < EVENT.size:
                raise Damaged(f"{path} ends within an event at byte {file.tell() - len(head)}; record the run again")
            word, _, time_us, name_bytes, size = EVENT.unpack(head)
            if word != SYNC_WORD:
                raise Damaged(f"{path} holds no event at byte {file.tell() - EVENT.size}; give an intact log")
            channel = file.read(name_bytes).decode("utf-8", "replace")
            payload = file.read(size)
            if len(payload) < size:
                raise Damaged(f"{path} ends within a message of {channel}; record the run again")
            yield time_us, channel, payload


def by_channel(path, changes):
    """{channel: messages}; a message is its time stamp and its payload without fingerprint.

    The fingerprints of all channels are an entry of their own: they change with the name of any field, while the values do not.
    So is the order of the channels, which no channel alone shows.
    """
    found, fingerprints, order = {}, {}, []
    for time_us, channel, payload in events(path):
        channel, body = changes.old_channel(channel), payload
        order.append(f"{time_us} {channel}\n".encode())
        if channel not in PLAIN:
            fingerprints.setdefault(channel, set()).add(payload[:FINGERPRINT_BYTES].hex())
            body = payload[FINGERPRINT_BYTES:]
        found.setdefault(channel, []).append(TIME.pack(time_us) + (without_version(body) if channel == "LOG_INFO" else body))
    found = dict(sorted(found.items()))
    found[FINGERPRINTS] = [TIME.pack(0) + f"{channel} {' '.join(sorted(prints))}\n".encode() for channel, prints in sorted(fingerprints.items())]
    found[ORDER] = [TIME.pack(0) + line for line in order]
    return found


def without_version(body):
    """LOG_INFO without the version and the commit of the sources, which change while the output does not."""
    at = HEADER_BYTES
    for _ in range(TEXTS_OF_LOG_INFO):
        at += 4 + struct.unpack_from(">i", body, at)[0]
    return body[:HEADER_BYTES] + body[at:]


def time_of(message):
    return TIME.unpack_from(message)[0]


def place(byte, channel=""):
    """The field of header_t, or the offset behind it, that a byte of a message of by_channel() belongs to."""
    if byte < TIME.size:
        return "its time stamp"
    byte -= TIME.size
    if channel in (*PLAIN, FINGERPRINTS, ORDER):
        return f"byte {byte}"
    if byte < HEADER_BYTES:
        return "header." + [name for name, begin in FIELDS if begin <= byte][-1]
    return f"byte {byte - HEADER_BYTES} behind its header"
