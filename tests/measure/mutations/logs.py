"""Mutators of recorded logs: of the events, their stamps, channels and contents, or of the bytes of the file."""
import math
import struct

SYNC = struct.pack(">I", 0xEDA1DA01)
HEAD = struct.Struct(">IqqII")
HOUR_US = 3600 * 1_000_000


def events_of(data):
    """[(stamp us, channel, contents)] of an intact log."""
    events, at = [], 0
    while at + HEAD.size <= len(data):
        _, _, stamp, name, size = HEAD.unpack_from(data, at)
        at += HEAD.size
        events.append((stamp, data[at:at + name], data[at + name:at + name + size]))
        at += name + size
    return events


def written(events):
    return b"".join(HEAD.pack(0xEDA1DA01, number, stamp, len(channel), len(data)) + channel + data for number, (stamp, channel, data) in enumerate(events))


def wrong_size(events, draw):
    at = draw.randrange(len(events))
    stamp, channel, data = events[at]
    size = draw.choice((0, 1, len(data) // 2, len(data) - 1))
    return written(events[:at] + [(stamp, channel, data[:size])] + events[at + 1:])


def lying_size(events, draw):
    """The head of an event names another size than its contents have."""
    data = bytearray(written(events))
    at = data.find(SYNC, draw.randrange(len(data) // 2))
    struct.pack_into(">I", data, at + draw.choice((20, 24)), draw.choice((0, 1, 2**31, 2**32 - 1, 64, 70_000)))
    return bytes(data)


def swapped(events, draw):
    """Neighbours exchanged, as a logger under load writes them."""
    events = list(events)
    for at in range(draw.randrange(50), len(events) - 1, draw.randint(2, 30)):
        events[at], events[at + 1] = events[at + 1], events[at]
    return written(events)


def touching(events, draw):
    """A second copy of the run begins where the first ends."""
    shift = events[-1][0] - events[0][0]
    return written(events + [(stamp + shift, channel, data) for stamp, channel, data in events])


def overlapping(events, draw):
    shift = round((events[-1][0] - events[0][0]) * draw.random())
    return written(sorted(events + [(stamp + shift, channel, data) for stamp, channel, data in events], key=lambda e: e[0]))


def duplicated(events, draw):
    return written([event for event in events for _ in range(draw.choice((1, 1, 2, 3)))])


def huge(events, draw):
    at, name = draw.randrange(len(events)), draw.choice((b"BIG", b"TOOL_STATE", b"L" * 63))
    return written(events[:at] + [(events[at][0], name, bytes(draw.choice((1 << 16, 1 << 20, 1 << 22))))] + events[at:])


def tiny(events, draw):
    return written(draw.sample(events, draw.randint(1, 5)))


def far(events, draw):
    """Stamps of another time, of all events, of one, or from one on."""
    by = draw.choice((HOUR_US, -HOUR_US, 3 * HOUR_US, 10**15, -10**15, 2**62))
    begin = draw.randrange(len(events))
    end = draw.choice((begin + 1, len(events)))
    return written([(stamp + by if begin <= i < end else stamp, c, d) for i, (stamp, c, d) in enumerate(events)])


def emptied(events, draw):
    chosen = draw.choice(events)[1]
    return draw.choice((b"", written([e for e in events if e[1] != chosen]), written([(t, c, b"" if c == chosen else d) for t, c, d in events])))


def not_a_number(events, draw):
    """A NaN or infinity anywhere in a message; it may meet a field that is no double."""
    at = draw.choice([i for i, e in enumerate(events) if len(e[2]) > 64])
    stamp, channel, data = events[at]
    place = draw.randrange(48, len(data) - 8)
    return written(events[:at] + [(stamp, channel, data[:place] + struct.pack(">d", draw.choice((math.nan, math.inf, 1e300))) + data[place + 8:])] + events[at + 1:])


def renamed(events, draw):
    chosen, name = draw.choice(events)[1], draw.choice((b"a b", b"../../x", b"=1+1", b"L" * 63, b"line\nbreak", bytes(range(1, 64)), b"CONTACTS"))
    return written([(t, name if c == chosen else c, d) for t, c, d in events])


def dropped(events, draw):
    share = draw.random()
    return written([e for e in events if draw.random() > share] or events[:1])


EVENT_KINDS = {
    "wrong size": wrong_size, "lying size": lying_size, "swapped": swapped, "touching": touching, "overlapping": overlapping, "duplicated": duplicated,
    "huge": huge, "tiny": tiny, "far": far, "empty": emptied, "not a number": not_a_number, "renamed": renamed, "dropped": dropped,
}
KINDS = (*EVENT_KINDS, "truncated", "bytes")


def mutated(data, kind, draw):
    """The bytes of a log with one change of this kind."""
    if kind == "truncated":
        return data[:draw.randrange(len(data))]
    if kind == "bytes":
        changed = bytearray(data)
        for _ in range(draw.choice((1, 10, 1000))):
            changed[draw.randrange(len(changed))] = draw.randrange(256)
        return bytes(changed)
    return EVENT_KINDS[kind](events_of(data), draw)
