"""The asynchronies of a run that was gathered from the hosts of a lab: exports its logs and evaluates them with asynchrony.py."""
import json
import pathlib
import re
import subprocess
import tempfile

from tactus.cluster import asynchrony
from tactus.paths import BIN
from tactus.tables import read_rows

TITLES = {"nothing": "nothing spoilt", "others": "another host spoilt", "spoilt": "one of the two hosts spoilt, or the recorder's"}
SUMMARY_BIN_MS = 0.11     # a bin of SoaHistogram, and the rounding of summary.json
SUMMARY_ROUNDS_MS = 0.011


def log_parts(out):
    """Parts of the log of a run, in order; each restart of the recorder starts a new part."""
    number = lambda path: int(re.sub(r"\D", "", path.name) or 1)
    return sorted(out.glob("run*.lcmlog"), key=number)


def rows(path):
    """Rows of a table of export_log, which writes none for a channel without messages."""
    return read_rows(path) if path.exists() else []


def run_program(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError((done.stderr.strip() or f"{words[0]} failed").splitlines()[-1])


def read_run(out, host_of, ahead_s, home, walls):
    """(pairs of senses, pairs of walls by event, pairs of walls by frame) of all parts, and of each part (onsets, {event: ns}, playout delays).
    host_of: {node: host}, walls: {node: wall}."""
    senses, by_event, by_frame, parts = [], [], [], []
    for part in log_parts(out):
        with tempfile.TemporaryDirectory() as scratch:
            scratch = pathlib.Path(scratch)
            for name, words in (("long", ["--channels", "PRESENTED|PLAYOUT"]), ("wide", ["--wide", "--channels", "CLOCK_MAP|FRAME_SHOWN|NODE_HEALTH"])):
                (scratch / name).mkdir()
                run_program(BIN / "export_log", part, "--out", scratch / name, *words)
            run_program(BIN / "export_events", part, "--out", scratch)
            maps = asynchrony.ClockMapHistory(rows(scratch / "wide" / "CLOCK_MAP.csv"), host_of, home, ahead_s)
            if maps.begin_ns is None:
                continue  # the part is too short for a map
            presented = rows(scratch / "long" / "PRESENTED.csv")
            events = rows(scratch / "events.csv")
            kinds = {r["event_id"]: r["kind"] for r in events}
            found = asynchrony.event_onsets(presented, kinds, maps, host_of, ahead_s)
            delays = asynchrony.PlayoutDelays(rows(scratch / "long" / "PLAYOUT.csv"), maps)
            periods_ns = {r["node"]: asynchrony.NS_PER_S / float(r["nominal_rate_Hz"]) for r in map(asynchrony.without_units, rows(scratch / "wide" / "NODE_HEALTH.csv"))
                          if float(r["nominal_rate_Hz"]) > 0}
            at_ns = {int(r["event_id"]): int(r["host_ns"]) - ahead_s[host_of["sim_node"]] * asynchrony.NS_PER_S for r in events}
            parts.append((found, at_ns, delays))
            senses += asynchrony.modality_pairs(found, delays, periods_ns)
            by_event += asynchrony.wall_pairs(found, periods_ns, walls)
            own_ns = {w: max((o.own_ns for o in found if o.node == w), default=0) for w in walls}
            seen = asynchrony.frame_onsets(rows(scratch / "wide" / "FRAME_SHOWN.csv"), rows(scratch / "frame_shown.csv"), maps, host_of, ahead_s, own_ns)
            by_frame += asynchrony.wall_pairs(seen, periods_ns, walls)
    return senses, by_event, by_frame, parts


def measure(out, host_of, ahead_s, home, walls, windows):
    """The figures of measure_hosts. windows: as of asynchrony.split_by_window."""
    senses, by_event, by_frame, parts = read_run(out, host_of, ahead_s, home, walls)
    with tempfile.TemporaryDirectory() as scratch:
        summary = pathlib.Path(scratch) / "summary.json"
        subprocess.run([str(BIN / "summarise"), *map(str, log_parts(out)), "--out", str(summary)], capture_output=True, check=False)  # a nonzero status only reports losses
        reported = json.loads(summary.read_text(encoding="utf-8"))["asynchrony_ms"]
    tables = {}
    for name, pairs in (("senses", senses), ("walls by event", by_event), ("walls by frame", by_frame)):
        tables[name] = {when: asynchrony.summary_rows(of) for when, of in asynchrony.split_by_window(pairs, windows, home).items()}
    without_fault = [(b, e) for host, b, e in windows if host is None]
    met = []
    for found, at_ns, delays in parts:
        met += asynchrony.scheduling_rows([o for o in found if any(b <= o.true_ns < e for b, e in without_fault)], at_ns, delays)
    return {"tables": tables, "instants": met, "summary": asynchrony.compare_with_summary(senses, reported)}


def text(figures):
    parts = []
    for name, by_when in figures["tables"].items():
        for when, of in by_when.items():
            if of:
                parts.append(f"asynchrony of {name}, {TITLES[when]}, ms:\n{asynchrony.text(of)}")
    parts.append(f"scheduled and measured times of each node, in windows without faults, ms:\n{asynchrony.scheduling_text(figures['instants'])}")
    parts.append("\n".join(f"summary {r['pair']}: n {r['n_said']}, here {r['n']}; quantiles differ by {r['differs_ms'] if r['differs_ms'] is None else round(r['differs_ms'], 3)} ms; "
                           f"uncertainty {r['uncertainty_said_ms']} ms, here {r['uncertainty_ms']:.3f} ms" for r in figures["summary"]))
    return "\n".join(parts)


def violations(figures):
    """Violated requirements, one sentence each: stated uncertainties must hold in all windows, playout delays in windows without faults."""
    found = []
    for name, by_when in figures["tables"].items():
        for when, of in by_when.items():
            for r in of:
                who = f"asynchrony of {name}, {TITLES[when]}, {r['a']} {r['b']}"
                if r["outside"]:
                    found.append(f"{who}: {r['outside']} of {r['n']} differ from the clocks of the lab by more than the uncertainty of the clock maps, by at most {r['off_worst_ms']:.3f} ms")
                if r["beyond_in_time"] and when == "nothing":
                    found.append(f"{who}: {r['beyond_in_time']} of {r['aimed']} miss the scheduled asynchrony by more than the stated uncertainty and the resolution, and are not reported as late; largest error {r['aside_worst_ms']:.1f} ms")
    for r in figures["summary"]:
        if r["n"] != r["n_said"] or (r["differs_ms"] or 0) > SUMMARY_BIN_MS or abs((r["uncertainty_said_ms"] or 0) - r["uncertainty_ms"]) > SUMMARY_ROUNDS_MS:
            found.append(f"asynchrony of {r['pair']}: summarise reports {r['n_said']} values with an uncertainty of {r['uncertainty_said_ms']} ms; this evaluation finds {r['n']} with {r['uncertainty_ms']:.3f} ms, "
                         f"and their quantiles differ by {r['differs_ms']} ms")
    return found
