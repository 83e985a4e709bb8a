"""Asynchronies of modalities and walls on different hosts: the true ones, those that the system reports, and their stated uncertainty.

The clock offsets of the hosts of a lab are known exactly, so the times at which two hosts present one event can be mapped to one clock:
the true asynchrony. The system has only its CLOCK_MAPs. The reported asynchrony is computed here for each event as in
sync/presentation/presentation_matcher.cpp, from the maps that had reached the recorder before the report.

  off        reported minus true asynchrony. Only the maps cause it, so it is within the sum of their uncertainties
  stated     that sum plus the uncertainties of the two presentations
  aside      true asynchrony minus that of the playout delays. It is within the stated uncertainty plus the grain of both modalities:
             the nearest frame, half a period away; the next tick; sound has the grain of a sample. A modality with the delay 0, touch by
             default, presents when it has received the event; its report gives that time (ready)

Pure functions: rows of tables in, rows out. Times are ns of the clock of the lab unless stated otherwise.
"""
import bisect
import dataclasses
import itertools
import re

MODALITY_ORDER = ("haptic_push", "haptic", "audio", "visual", "thermal")  # the order of sync/presentation/presentation_matcher.cpp
CONSTRAINT, TRANSIENT = 1, 2                                     # presentation_t: part
PRESENTED, LATE, INAUDIBLE = 0, 1, 4                             # presentation_t: outcome
GRAIN = {"haptic": 1.0, "thermal": 1.0, "visual": 0.5}           # share of the period by which a presentation may miss its time
MAX_SLEW = 0.05                                                      # sync/playout/follower.h
MAX_UNCERTAINTY_NS = 16_000_000                                   # sync/clocks/clock_maps.h
NS_PER_S = 1_000_000_000
SETTLING_NS = NS_PER_S // 2                                           # after a change, the delay counts as changing for this time: messages on their way, frames begun


@dataclasses.dataclass(frozen=True)
class Onset:
    """The presentation of one event or frame by one node."""
    event: int
    sense: str     # haptic_push: the immediate force at a begin, independent of the policy
    node: str
    host: str
    true_ns: int
    reported_ns: int   # on the clock of the recorder, by the maps
    clock_ns: int  # half width that the map states
    own_ns: int    # half width that the node states
    late: bool = False
    scheduled_ns: int | None = None  # scheduled time
    ready_ns: int | None = None  # earliest possible time


@dataclasses.dataclass(frozen=True)
class Pair:
    """Two onsets of one thing: b minus a."""
    a: str
    b: str
    hosts: tuple
    at_ns: int            # time of the first onset
    true_ns: int
    reported_ns: int
    clocks_ns: int
    stated_ns: int        # clocks_ns plus the uncertainties of both nodes
    planned_ns: int | None    # of the playout delays; None: changing or without an aim
    grain_ns: int
    late: bool

    @property
    def reporting_error_ns(self):
        return self.reported_ns - self.true_ns

    @property
    def exceeds_clock_uncertainty(self):
        return abs(self.reporting_error_ns) > self.clocks_ns

    @property
    def scheduling_error_ns(self):
        return None if self.planned_ns is None else self.true_ns - self.planned_ns

    @property
    def exceeds_stated_uncertainty(self):
        return self.scheduling_error_ns is not None and abs(self.scheduling_error_ns) > self.stated_ns + self.grain_ns


# reports

def without_units(row):
    """A row of a wide table of export_log with units removed from the column names."""
    return {name.partition(" (")[0]: value for name, value in row.items()}


def group_messages(rows):
    """(log_s, sender, {field: value}, {place: {field: value}}) of each message of a long table of export_log; its type must have at most one list."""
    for (log_s, sender, _), fields in itertools.groupby(rows, lambda r: (r["log_s"], r["sender"], r["seq"])):
        once, lists = {}, {}
        for r in fields:
            place = re.match(r"\w+\[(\d+)\]\.(.*)", r["field"])
            if place:
                lists.setdefault(int(place[1]), {})[place[2]] = r["value"]
            else:
                once[r["field"]] = r["value"]
        yield float(log_s), sender, once, lists


class ClockMapHistory:
    """The clock maps of a log between other hosts and the host of the recorder, as known at each time."""

    def __init__(self, rows, host_of, home, ahead_s):
        """rows: CLOCK_MAP, wide. host_of: {node: host}. home: the recorder's host."""
        rows = [without_units(r) for r in rows]
        self.home, self.lines = home, {}
        host_of_clock = {r["to_clock"]: host_of[r["sender"]] for r in rows if r["sender"] in host_of}
        shifts = []
        for r in rows:
            of, to = host_of_clock.get(r["of_clock"]), host_of_clock.get(r["to_clock"])
            if to == home:
                shifts.append(int(r["at_ns"]) - ahead_s[home] * NS_PER_S - round(float(r["log_s"]) * NS_PER_S))
            if home in (of, to) and of and to:
                self.lines.setdefault((of, to), []).append((float(r["log_s"]), r))
        shifts.sort()
        # A map refers to its sending time, so it relates log time to the clock of its host, within the ms of transmission.
        self.begin_ns = shifts[len(shifts) // 2] if shifts else None

    def at_ns(self, log_s):
        """Log time in s to the clock of the lab, ns."""
        return self.begin_ns + round(log_s * NS_PER_S)

    def to_recorder_clock(self, of_ns, host, log_s):
        """(ns, half width) on the clock of the recorder of a time of a host, by the map known at log_s; None without a map that is certain enough."""
        if host == self.home:
            return of_ns, 0
        for key, read in (((host, self.home), invert_clock_map), ((self.home, host), apply_clock_map)):
            lines = self.lines.get(key, ())
            newest = bisect.bisect_right(lines, log_s, key=lambda line: line[0])
            if newest:
                ns, half_ns = read(lines[newest - 1][1], of_ns)
                return (ns, half_ns) if half_ns <= MAX_UNCERTAINTY_NS else None
        return None


def map_uncertainty_ns(row, since_ns):
    return int(row["uncertainty_ns"]) + round(abs(since_ns) * float(row["uncertainty_drift"])) + 2  # sync/clocks/clock_maps.cpp: two roundings


def invert_clock_map(row, ns):
    since = round((ns - int(row["at_ns"]) - int(row["offset_ns"])) / (1 + float(row["drift"])))
    return int(row["at_ns"]) + since, map_uncertainty_ns(row, since)


def apply_clock_map(row, ns):
    since = ns - int(row["at_ns"])
    return ns + int(row["offset_ns"]) + round(since * float(row["drift"])), map_uncertainty_ns(row, since)


def event_onsets(rows, kinds, maps, host_of, ahead_s):
    """Onsets of each event by each node, from the long table of PRESENTED. kinds: {event_id: kind}, as events.csv has them."""
    found = {}
    for log_s, node, once, reports in group_messages(rows):
        host = host_of.get(node)
        for r in reports.values():
            event, part, sense = int(r["event_id"]), int(r["part"]), once["modality"]
            if host is None or (node, event, part) in found or int(r["presented_ns"]) < 0 or int(r["outcome"]) not in (PRESENTED, LATE, INAUDIBLE):
                continue
            if part and part != (TRANSIENT if kinds.get(str(event)) == "hit" else CONSTRAINT):
                continue
            read = maps.to_recorder_clock(int(r["presented_ns"]), host, log_s)
            if read is not None:
                found[node, event, part] = Onset(event, sense + ("_push" if part == CONSTRAINT else ""), node, host, int(r["presented_ns"]) - ahead_s[host] * NS_PER_S,
                                                 read[0], read[1], int(r["uncertainty_ns"]), int(r["outcome"]) == LATE,
                                                 *(int(r[name]) - ahead_s[host] * NS_PER_S if int(r[name]) >= 0 else None for name in ("scheduled_ns", "ready_ns")))
    return list(found.values())


def frame_onsets(reported, shown, maps, host_of, ahead_s, own_ns):
    """Onsets of frames, by wall. reported: rows of FRAME_SHOWN, wide, with the arrival; shown: rows of frame_shown.csv of the same log, in the same order,
    with the presentation time. own_ns: {wall: half width that the wall states for its presentations}."""
    found = []
    reported = [r for r in map(without_units, reported) if r["sender"]]  # rows without a readable header are only in the first table
    if [r["frame"] for r in reported] != [r["frame"] for r in shown]:
        raise ValueError("FRAME_SHOWN.csv and frame_shown.csv are from different logs; export both from one log")
    for arrived, row in zip(reported, shown):
        node = arrived["sender"]
        host = host_of.get(node)
        read = maps.to_recorder_clock(int(row["publish_ns"]), host, float(arrived["log_s"])) if host and row["stage"] == "shown" and node in own_ns else None
        if read is not None:
            found.append(Onset(int(row["frame"]), "visual", node, host, int(row["publish_ns"]) - ahead_s[host] * NS_PER_S, *read, own_ns[node]))
    return found


class PlayoutDelays:
    """The playout delay of each modality, which follows the requests of PLAYOUT."""

    def __init__(self, rows, maps):
        self.requests = {}  # by modality: (ns, delay from then on, requested delay)
        for log_s, _, _, entries in group_messages(rows):
            at = maps.at_ns(log_s)
            for e in entries.values():
                requested, of_sense = int(e["delay_ns"]), self.requests.setdefault(e["modality"], [])
                of_sense.append((at, limit_slew(of_sense[-1], at) if of_sense else requested, requested))

    def at(self, sense, ns):
        """The delay if it was constant from the event to the presentation; else None."""
        requests = self.requests.get(sense, ())
        end = bisect.bisect_right(requests, ns, key=lambda t: t[0])
        if not end:
            return None
        delay = requests[end - 1][2]
        begin = bisect.bisect_left(requests, ns - delay - SETTLING_NS, hi=end - 1, key=lambda t: t[0])
        return delay if all(t[1] == t[2] == delay for t in requests[begin:end]) else None


def limit_slew(before, at):
    begin, delay, requested = before
    limit = round(MAX_SLEW * (at - begin))
    return delay + max(-limit, min(requested - delay, limit))


# pairs

def make_pair(a, b, name, delays, periods_ns):
    aims = [0, 0]
    if a.sense != b.sense:
        aims = [delays.at(o.sense, o.true_ns) if delays else None for o in (a, b)]
    grain = sum(round(GRAIN.get(o.sense, 0) * periods_ns.get(o.node, 0)) for o in (a, b))
    grain += sum(max(0, o.ready_ns - o.scheduled_ns) for o, aim in zip((a, b), aims) if aim == 0 and a.sense != b.sense and o.ready_ns and o.scheduled_ns)
    clocks = a.clock_ns + b.clock_ns
    return Pair(name(a), name(b), (a.host, b.host), min(a.true_ns, b.true_ns), b.true_ns - a.true_ns, b.reported_ns - a.reported_ns, clocks,
                clocks + a.own_ns + b.own_ns, None if None in aims else aims[1] - aims[0], grain, a.late or b.late)


def group_by_event(found):
    events = {}
    for o in found:
        events.setdefault(o.event, []).append(o)
    return events.values()


def modality_pairs(found, delays, periods_ns):
    """Yields a Pair for each event and pair of modalities; of several walls the first one by reported times."""
    place = lambda sense: (MODALITY_ORDER.index(sense) if sense in MODALITY_ORDER else len(MODALITY_ORDER), sense)
    for event in group_by_event(found):
        first = {}
        for o in event:
            if o.sense not in first or o.reported_ns < first[o.sense].reported_ns:
                first[o.sense] = o
        for a, b in itertools.combinations(sorted(first, key=place), 2):
            yield make_pair(first[a], first[b], lambda o: o.sense, delays, periods_ns)


def wall_pairs(found, periods_ns, names):
    """Yields a Pair for each event or frame and pair of walls. names: {node: wall}."""
    for event in group_by_event(o for o in found if o.node in names):
        for a, b in itertools.combinations(sorted(event, key=lambda o: list(names).index(o.node)), 2):
            yield make_pair(a, b, lambda o: names[o.node], None, periods_ns)


def split_by_window(pairs, windows, home):
    """{"nothing": pairs without a fault, "others": with a fault of another host, "spoilt": with a fault of one of their hosts or of the
    recorder host, which has the maps}. windows: (faulty host or None, begin, end) in ns; pairs outside all windows are left out."""
    found = {"nothing": [], "others": [], "spoilt": []}
    for p in pairs:
        for host, begin, end in windows:
            if begin <= p.at_ns < end:
                found["nothing" if host is None else "spoilt" if host in (*p.hosts, home) else "others"].append(p)
                break
    return found


# tables

def quantile(values, q):
    """As SoaHistogram::quantile, without bins."""
    values = sorted(values)
    return values[max(0, -int(-q * len(values) // 1) - 1)]


def summary_rows(pairs):
    """A row for each pair of names, in ms."""
    groups = {}
    for p in pairs:
        groups.setdefault((p.a, p.b), []).append(p)
    rows = []
    for (a, b), of in groups.items():
        aside = [abs(p.scheduling_error_ns) for p in of if p.scheduling_error_ns is not None]
        rows.append({"a": a, "b": b, "n": len(of), "other_host": sum(p.hosts[0] != p.hosts[1] for p in of),
                     "true_p50_ms": quantile([p.true_ns for p in of], 0.5) / 1e6, "true_worst_ms": max((p.true_ns for p in of), key=abs) / 1e6,
                     "off_worst_ms": max(abs(p.reporting_error_ns) for p in of) / 1e6, "clocks_worst_ms": max(p.clocks_ns for p in of) / 1e6,
                     "outside": sum(p.exceeds_clock_uncertainty for p in of), "stated_worst_ms": max(p.stated_ns for p in of) / 1e6, "late": sum(p.late for p in of),
                     "aimed": len(aside), "aside_p50_ms": quantile(aside, 0.5) / 1e6 if aside else None, "aside_worst_ms": max(aside) / 1e6 if aside else None,
                     "grain_ms": max(p.grain_ns for p in of) / 1e6, "beyond": sum(p.exceeds_stated_uncertainty for p in of), "beyond_in_time": sum(p.exceeds_stated_uncertainty and not p.late for p in of)})
    return rows


def scheduling_rows(found, events_ns, delays):
    """A row for each node, in ms: meant, the scheduled time minus event and playout delay; met, the presentation minus the scheduled time. The first
    crosses hosts and should be within the uncertainty of their maps, the second is of the node alone. events_ns: {event: ns}."""
    nodes = {}
    for o in found:
        delay = delays.at(o.sense, o.true_ns)
        if delay is not None and o.event in events_ns and o.scheduled_ns is not None:
            nodes.setdefault((o.sense, o.node), []).append((o.scheduled_ns - events_ns[o.event] - delay, o.true_ns - o.scheduled_ns))
    return [{"sense": sense, "node": node, "n": len(of), "meant_p50_ms": quantile([m for m, _ in of], 0.5) / 1e6, "meant_worst_ms": max((m for m, _ in of), key=abs) / 1e6,
             "met_p50_ms": quantile([t for _, t in of], 0.5) / 1e6, "met_worst_ms": max((t for _, t in of), key=abs) / 1e6} for (sense, node), of in sorted(nodes.items())]


def scheduling_text(rows):
    lines = [f"{'':24} {'n':>6} {'meant p50':>10} {'worst':>8} {'met p50':>8} {'worst':>8}"]
    lines += [f"{r['node']:24} {r['n']:6d} {r['meant_p50_ms']:10.2f} {r['meant_worst_ms']:8.2f} {r['met_p50_ms']:8.2f} {r['met_worst_ms']:8.2f}" for r in rows]
    return "\n".join(lines)


def text(rows):
    lines = [f"{'':24} {'n':>6} {'true p50':>9} {'worst':>9} {'off worst':>10} {'clocks':>7} {'outside':>8} {'stated':>7} "
             f"{'late':>5} {'aimed':>6} {'aside p50':>10} {'worst':>8} {'grain':>6} {'beyond':>7}"]
    show = lambda v: "-" if v is None else f"{v:.2f}"
    for r in rows:
        lines.append(f"{r['a'] + ' ' + r['b']:24} {r['n']:6d} {r['true_p50_ms']:9.2f} {r['true_worst_ms']:9.2f} {r['off_worst_ms']:10.4f} "
                     f"{r['clocks_worst_ms']:7.4f} {r['outside']:8d} {r['stated_worst_ms']:7.2f} {r['late']:5d} {r['aimed']:6d} {show(r['aside_p50_ms']):>10} "
                     f"{show(r['aside_worst_ms']):>8} {r['grain_ms']:6.1f} {r['beyond']:7d}")
    return "\n".join(lines)


def compare_with_summary(pairs, summary):
    """Rows that compare asynchrony_ms of summarise with the values computed here: equal counts, quantiles within a bin."""
    rows = []
    for name, s in summary.items():
        of = [p for p in pairs if f"{p.a}_{p.b}" == name]
        if not s["n"] and not of:
            continue
        differs = [abs(s[f"p{q:02d}"] - quantile([p.reported_ns for p in of], q / 100) / 1e6) for q in (5, 50, 95)] if s["n"] and of else []
        rows.append({"pair": name, "n_said": s["n"], "n": len(of), "differs_ms": max(differs, default=None),
                     "uncertainty_said_ms": s["uncertainty"], "uncertainty_ms": max((p.stated_ns for p in of), default=0) / 1e6})
    return rows
