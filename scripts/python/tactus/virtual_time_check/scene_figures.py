"""Figures of runs of a scene, live and in virtual time, with their largest permitted differences. Reads the results of runs; no other side effects."""
import json
import math
import os

import numpy as np
from scipy.stats import t

from tactus.log import log_tables
from tactus.virtual_time_check import bounds

RATE_SHARE = 0.005   # a loop without disturbance keeps its rate to this share (tests/measure/measure_isolation)
COUNT_SHARE = 0.10   # design: the path of a scripted hand fixes its touches, but the number of bounces of a ball is chaotic
# {sense: node whose loop presents it}, in the order of log_tables.SENSES; an asynchrony is t(second) - t(first) in this order.
NODE_OF = {"haptic": "haptic_node", "haptic_push": "haptic_node", "audio": "audio_node", "visual": "visual_node", "thermal": "thermal_node"}
TOGETHER = ("audio", "visual", "thermal")  # wait for the slowest of them except warmth (sync/playout): vision, whose drawing takes no virtual time
ANSWER_ALL = ("audio", "visual")
NO_RATE = ("sync_node",)  # wakes when something arrives
SETTLES_NS = 2_000_000_000  # design: the playout approaches its longest delay, 60 ms, at 5 % of real time (sync/playout)
LEVEL = 0.95


class RunTables(log_tables.LogTables):
    """The tables of a results folder of scripts/run, with the interface of a report."""

    def __init__(self, folder):
        self.folder, self.name, self.since_ns = str(folder), "", 0
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            self.summary = json.load(file)

    def settle(self):
        """Leaves out events before sound and vision were ready and the playout had settled. Returns the number of remaining events."""
        presented = self.presented_ns()
        self.since_ns = max((min(presented[sense].values()) for sense in ANSWER_ALL if sense in presented), default=0) + SETTLES_NS
        return len(self.events())

    def events(self):
        return {event: row for event, row in super().events().items() if row["host_ns"] and int(row["host_ns"]) > self.since_ns}

    def rows(self, name, wanted=None):
        if name != "presented.csv" or not self.since_ns:
            return super().rows(name, wanted)
        counted = self.events()
        return (row for row in super().rows(name, wanted) if row["event_id"] in counted)

    def delays_ms(self):
        """{sense: scheduled time minus event time, ms}: the delay of the playout plus that of profiles."""
        at = {event: int(row["host_ns"]) for event, row in self.events().items()}
        out = {}
        for row in self.rows("presented.csv"):
            if int(row["scheduled_ns"]) >= 0 and row["part"] != "constraint" and row["event_id"] in at:
                out.setdefault(row["modality"], []).append((int(row["scheduled_ns"]) - at[row["event_id"]]) * 1e-6)
        return {sense: np.array(values) for sense, values in out.items()}


class Runs:
    """Runs of one kind: values of events pooled over all runs, counts and rates of each run."""

    def __init__(self):
        self.each, self.rates = [], {}
        self.scheduled, self.met, self.latency, self.soa = {}, {}, {}, {}

    def of(self, name):
        return [run[name] for run in self.each]

    def add(self, tables):
        contacts, nodes = tables.summary["contacts"], tables.summary["nodes"]
        for name, node in nodes.items():
            if name not in NO_RATE:
                self.rates.setdefault(name, []).append(node["rate_hz"])
        drawing = nodes.get("visual_node", {}).get("tick_us", {})
        self.each.append({"begins": contacts["begin"], "hits": contacts["hit"], "lost": sum(sense["lost"] for sense in contacts["by_modality"].values()),
                          "settled": tables.settle(), "realtime_factor": tables.summary["realtime_factor"],
                          "missed_ticks": {name: node["missed_ticks"] for name, node in nodes.items() if node["missed_ticks"]},
                          "drawing_ms": {k: v * 1e-3 for k, v in drawing.items()}})
        presented = tables.presented_ns()
        latencies = {hop.removeprefix("event to "): v for hop, v in log_tables.latencies_ms(tables.events(), {}, presented).items()}
        for into, values in ((self.scheduled, tables.delays_ms()), (self.met, tables.lateness_ms()), (self.latency, latencies),
                             (self.soa, log_tables.asynchronies_ms(presented))):
            for key, more in values.items():
                into.setdefault(key, []).extend(float(x) for x in more)


def periods_ms(rates):
    """{node: period of its tick, ms} of runs in virtual time, whose loops miss no ticks."""
    return {name: 1e3 / median(values) for name, values in rates.items() if median(values) > 0}


def median(values):
    return float(np.median(values)) if len(values) else math.nan


def welch(a, b, level=LEVEL):
    """Interval of mean(a) - mean(b) with unequal variances; NaN if one has a single value (Welch 1947, Biometrika 34:28)."""
    if min(len(a), len(b)) < 2:
        return math.nan, math.nan
    of_a, of_b = np.var(a, ddof=1) / len(a), np.var(b, ddof=1) / len(b)
    apart, both = float(np.mean(a) - np.mean(b)), of_a + of_b
    if both == 0:
        return apart, apart
    freedom = both**2 / (of_a**2 / (len(a) - 1) + of_b**2 / (len(b) - 1))
    half = t.ppf((1 + level) / 2, freedom) * math.sqrt(both)
    return apart - half, apart + half


def rows(live, virtual):
    """[bounds.BoundCheck] of two Runs; tests/measure/measure_agreement gives the reason for each bound."""
    period = periods_ms(virtual.rates)
    tick = {sense: period.get(node, math.nan) for sense, node in NODE_OF.items()}
    frame = tick["visual"] if not math.isnan(tick["visual"]) else 0.0
    waits = {sense: frame if sense in TOGETHER else 0.0 for sense in NODE_OF}
    onset = {sense: max(tick[sense], waits[sense]) if sense in ("visual", "thermal") else tick[sense] + waits[sense] for sense in NODE_OF}
    found = [bounds.of_means(f"{name} in a run", "", a, b, COUNT_SHARE * bounds.mean(a), welch(a, b))
             for name, a, b in ((name, live.of(name), virtual.of(name)) for name in ("begins", "hits"))]
    found += [bounds.single("events lost, live", "", float(sum(live.of("lost"))), 0.0, 0.0), bounds.single("events lost, virtual", "", 0.0, float(sum(virtual.of("lost"))), 0.0)]
    shared = lambda a, b: [key for key in NODE_OF if key in a or key in b]
    of = lambda runs, key: median(runs.get(key, []))
    for sense in shared(live.scheduled, virtual.scheduled):
        found.append(bounds.single(f"{sense}: scheduled after the event", "ms", of(live.scheduled, sense), of(virtual.scheduled, sense), waits[sense] or tick[sense]))
    for sense in shared(live.met, virtual.met):
        found.append(bounds.single(f"{sense}: presented after that", "ms", of(live.met, sense), of(virtual.met, sense), tick[sense]))
    for sense in shared(live.latency, virtual.latency):
        found.append(bounds.single(f"{sense}: presented after the event", "ms", of(live.latency, sense), of(virtual.latency, sense), onset[sense]))
    for pair in sorted({*live.soa, *virtual.soa}, key=lambda p: [log_tables.SENSES.index(x) for x in p]):
        a, b = pair
        # A common wait cancels in the asynchrony.
        bound = tick[a] + tick[b] if a in TOGETHER and b in TOGETHER else onset[a] + onset[b]
        found.append(bounds.single(f"asynchrony {a} to {b}", "ms", of(live.soa, pair), of(virtual.soa, pair), bound))
    for name in sorted({*live.rates, *virtual.rates}):
        expected = of(virtual.rates, name)
        found.append(bounds.single(f"rate of {name}", "Hz", of(live.rates, name), expected, RATE_SHARE * expected))
    return found


def read(folder):
    """RunTables of a run. Raises OSError or ValueError if it wrote none."""
    tables = RunTables(folder)
    if not tables.has("events.csv"):
        raise ValueError(f"{folder}: contains no events: the hand touched nothing, or the run ended early")
    return tables
