"""Reads the tables of one log (docs/export.md) into numbers and arrays. No drawing, no clock."""
import csv
import json
import os

import numpy as np

from tactus.tables import unescaped

# Channels of a report; large channels are not exported.
CHANNELS = "LOG_INFO|NODE_HEALTH|CONTACT_EVENTS|PLAYOUT|DEGRADATION|DEGRADED|TAG_LIST|TAG_VALUES"
PHASES = ("collision", "solve", "integrate", "decode", "render", "other")  # sync/time/phases.h
DROP_REASONS = ("let through", "rate", "deadband", "loss", "off", "freeze", "overtaking")  # sync::DropReason, sync/degradation/operator_chain.h
PRESENTED = ("presented", "late", "inaudible")                               # outcomes of presented.csv that count as presented (docs/results.md)
POLICIES = ("asap", "aligned", "experiment", "local_haptic_first", "itouch2005")  # lcmtypes/types/control/playout_t.lcm
SENSES = ("haptic", "haptic_push", "audio", "visual", "thermal")             # an asynchrony is later minus earlier in this list


class LogTables:
    """The folder that tactus export and summarise wrote for one log. Missing files count as empty."""

    def __init__(self, folder, name):
        self.folder, self.name = folder, name
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            self.summary = json.load(file)
        with open(os.path.join(folder, "schema.json"), encoding="utf-8") as file:
            self.schema = json.load(file)
        self.info = {row["field"]: unescaped(row["value"]) for row in self.rows("LOG_INFO.csv")}
        # CLOCK_MONOTONIC of the recorder at log_s 0, ns.
        self.live_from_ns = int(self.info.get("live_from_ns", 0))

    def rows(self, name, wanted=None):
        """Dictionaries of a table; wanted: only lines that contain this text are parsed."""
        path = os.path.join(self.folder, name)
        if not os.path.exists(path):
            return
        with open(path, encoding="utf-8", newline="") as file:
            names = next(csv.reader([file.readline()]), None)
            lines = (line for line in file if wanted is None or wanted in line)
            for cells in csv.reader(lines):
                if len(cells) == len(names):
                    yield dict(zip(names, cells))

    def has(self, name):
        return next(iter(self.rows(name)), None) is not None

    def nominal_rates(self):
        """{process: nominal rate in Hz}, from NODE_HEALTH."""
        return {row["sender"]: float(row["value"]) for row in self.rows("NODE_HEALTH.csv", "nominal_rate_Hz") if row["field"] == "nominal_rate_Hz"}

    def phase_times_us(self):
        """{process: {phase: us of each tick}} of the tagged variables work and work.PHASE."""
        found = {}
        for row in self.rows("tags.csv", ",work"):
            if row["tag"] == "work" or row["tag"].startswith("work."):
                found.setdefault(row["node"], {}).setdefault(row["tag"].removeprefix("work").lstrip(".") or "all", []).append(float(row["value"]))
        return {node: {phase: np.array(values) for phase, values in phases.items()} for node, phases in found.items()}

    def events(self):
        """Rows of events.csv, by event_id."""
        return {row["event_id"]: row for row in self.rows("events.csv")}

    def first_received_ns(self):
        """{event_id: host ns at which the recorder first received it}."""
        received = {}
        for row in self.rows("CONTACT_EVENTS.csv", ".event_id,"):
            received.setdefault(row["value"], self.live_from_ns + round(float(row["log_s"]) * 1e9))
        return received

    def presented_ns(self):
        """{modality: {event_id: host ns}}; the immediate force of touch is haptic_push."""
        out = {}
        for row in self.rows("presented.csv"):
            at = int(row["presented_ns"])
            if at < 0 or row["outcome"] not in PRESENTED:
                continue
            sense = "haptic_push" if (row["modality"], row["part"]) == ("haptic", "constraint") else row["modality"]
            out.setdefault(sense, {}).setdefault(row["event_id"], at)
        return out

    def lateness_ms(self):
        """{modality: presented minus scheduled, ms}."""
        out = {}
        for row in self.rows("presented.csv"):
            if int(row["presented_ns"]) >= 0 and int(row["scheduled_ns"]) >= 0 and row["part"] != "constraint":
                out.setdefault(row["modality"], []).append((int(row["presented_ns"]) - int(row["scheduled_ns"])) * 1e-6)
        return {sense: np.array(values) for sense, values in out.items()}

    def budget_ms(self):
        """The last budget that sync_node published, ms; None without one."""
        last = None
        for row in self.rows("PLAYOUT.csv", "budget_ns"):
            if row["field"] == "budget_ns":
                last = float(row["value"]) * 1e-6
        return last

    def policy(self):
        """Name of the last published policy; None without one."""
        last = None
        for row in self.rows("PLAYOUT.csv", ",policy,"):
            if row["field"] == "policy":
                last = int(row["value"])
        return last if last is None else POLICIES[last] if 0 <= last < len(POLICIES) else f"number {last}"

    def profile(self):
        """(XML of the newest degradation profile, log_s of its first message); None without one."""
        pages, newest, first = {}, -1, 0.0
        for message in self.messages("DEGRADATION.csv"):
            generation = int(message["generation"])
            if generation > newest:
                pages, newest, first = {}, generation, float(message["log_s"])
            if generation == newest:
                pages[int(message["page"])] = message.get("text", "")
        text = "".join(pages[i] for i in sorted(pages))
        return (text, first) if text else None

    def decisions(self):
        """{(modality, "events" or "snapshots"): {"why": {reason: count}, "held_ms": delays of passed messages, "twice": repetitions}}."""
        out, passed = {}, {}
        for message in self.messages("DEGRADED.csv"):
            for i in range(int(message["count"])):
                what = "events" if int(message[f"decisions[{i}].is_event"]) else "snapshots"
                own = out.setdefault((message["modality"], what), {"why": {}, "held_ms": [], "twice": 0})
                why = int(message[f"decisions[{i}].drop_reason"])
                name = DROP_REASONS[why] if 0 <= why < len(DROP_REASONS) else f"reason {why}"
                own["why"][name] = own["why"].get(name, 0) + 1
                own["twice"] += int(message[f"decisions[{i}].twice"])
                key = message.get(f"decisions[{i}].key", "")
                if why == 0:
                    own["held_ms"].append(float(message[f"decisions[{i}].held_ns"]) * 1e-6)
                    passed.setdefault((message["modality"], what), {})[key] = len(own["held_ms"]) - 1
                elif name == "overtaking" and own["why"].get("let through", 0) > 0:  # follows its own "let through": a newer snapshot was released first
                    own["why"]["let through"] -= 1
                    index = passed.get((message["modality"], what), {}).pop(key, None)
                    if index is not None:
                        own["held_ms"][index] = np.nan
        for own in out.values():
            held_ms = np.array(own["held_ms"])
            own["held_ms"] = held_ms[~np.isnan(held_ms)]
        return out

    def messages(self, name):
        """Yields a dictionary for each message of a long table: its fields, log_s and sender."""
        key, message = None, {}
        for row in self.rows(name):
            if (row["sender"], row["seq"], row["log_s"]) != key:
                if message:
                    yield message
                key, message = (row["sender"], row["seq"], row["log_s"]), {"log_s": row["log_s"], "sender": row["sender"]}
            message[row["field"]] = unescaped(row["value"])
        if message:
            yield message

    def tool_trace(self, tool):
        """Arrays of haptic.csv of one tool: seq, simulation time s (NaN: before its start), force (n,3) N, device and proxy height m."""
        seq, time, force, device, proxy = [], [], [], [], []
        for row in self.rows("haptic.csv"):
            if row["tool"] != tool:
                continue
            seq.append(int(row["seq"]))
            time.append(float(row["time_s"]) if row["time_s"] else np.nan)
            force.append([float(row[f"force_{axis}_N"]) for axis in "xyz"])
            device.append(float(row["device_z_m"]))
            proxy.append(float(row["proxy_z_m"]))
        return {"seq": np.array(seq), "time_s": np.array(time), "force_N": np.array(force).reshape(-1, 3), "device_m": np.array(device),
                "proxy_m": np.array(proxy)}

    def tools(self):
        return sorted({row["tool"] for row in self.rows("haptic.csv")}, key=int)

    def temperatures(self):
        """Array (n,3) of thermal.csv: simulation time s, skin and commanded temperature, degC."""
        rows = [(float(row["time_s"]), float(row["skin_degC"]), float(row["commanded_degC"])) for row in self.rows("thermal.csv") if row["time_s"]]
        return np.array(rows).reshape(-1, 3)


def asynchronies_ms(presented):
    """{(a, b): presentation in b minus that in a, ms, of every event presented in both}, as in summary.json."""
    out = {}
    for i, a in enumerate(SENSES):
        for b in SENSES[i + 1:]:
            if (a, b) == ("haptic", "haptic_push"):
                continue
            both = [(presented[b][e] - at) * 1e-6 for e, at in presented.get(a, {}).items() if e in presented.get(b, {})]
            if both:
                out[a, b] = np.array(both)
    return out


def latencies_ms(events, received, presented):
    """{hop: ms} of each event, from its instant to the bus and to the presentation of each modality."""
    at = {event: int(row["host_ns"]) for event, row in events.items() if row["host_ns"] and int(row["host_ns"]) > 0}
    out = {"simulation to bus": np.array([(received[e] - ns) * 1e-6 for e, ns in at.items() if e in received])}
    for sense in SENSES:
        onsets = presented.get(sense, {})
        out[f"event to {sense}"] = np.array([(onsets[e] - ns) * 1e-6 for e, ns in at.items() if e in onsets])
    return {hop: values for hop, values in out.items() if len(values)}


def bands(rows, a, b):
    """[(ms, row)] of a pair, in the sign of asynchronies_ms: positive when b is later."""
    plain = lambda sense: "haptic" if sense == "haptic_push" else sense
    return sorted(((float(r["threshold_ms"]) if r["earlier"] == plain(a) else -float(r["threshold_ms"]), r) for r in rows
                   if {r["earlier"], r["later"]} == {plain(a), plain(b)}), key=lambda band: band[0])
