"""The metrics of one run, or of one rendering of a log, from its tables. A metric whose data the tables lack is left out."""
import os

import numpy as np

from tactus import tables as files
from tactus.log import log_tables
from tactus.metrics import age, compare
from tactus.refusal import Refusal

FORCE_RATE_HZ = 200.0  # of the forces that are compared: 5 ms are finer than any published limit of a delayed force (design)
MAX_LAG_S = 0.4        # the largest delay of force that is looked for (design)
LONGEST_S = 14400.0    # of forces that are compared: 230 MiB of paths of etvo_like (design)
MIN_FORCE_N = 1e-3     # smaller forces are no contact
# {metric: (unit, meaning, True if more is worse)}; the order of tables.
MEANING = {
    "onset_soa_ms": ("ms", "largest median asynchrony between the onsets of two modalities", True),
    "age_ms": ("ms", "largest mean age of information of a degraded modality", True),
    "force_jnd_share": ("1", "share of the time in contact in which the force is outside the tube of 10 % around the reference", True),
    "force_time_ms": ("ms", "mean delay of the force against the reference (ETVO-like)", True),
    "force_time_variation": ("s/s", "changes of that delay per second", True),
    "force_value_N": ("N", "RMS difference of the forces without their delay (ETVO-like)", True),
    "force_rmse_N": ("N", "RMS difference of the forces at the same time", True),
    "force_hssim_like": ("1", "similarity of the sensation of force, 1: equal (HSSIM-like)", False),
    "picture_ssim": ("1", "mean similarity of the pictures, 1: equal (SSIM)", False),
    "injected_J": ("J", "largest energy that a late force has injected in an episode of contact", True),
    "generated_J": ("J", "largest energy that the channel of touch has generated in an episode of contact", True),
    "sent_per_s": ("1/s", "packets of touch per second that a deadband sends", False),
}


def tool_rows(folder, tool=None):
    """{column: array} of one tool of haptic.csv; tool None: the first with a simulated time; energies: only the values that the table has. {} without such a table, or
    without rows. Raises Refusal with file and line, and for a tool that the table does not have."""
    path = os.path.join(folder, "haptic.csv")
    if not os.path.isfile(path):
        return {}
    needed, energies = ("time_s", "force_x_N", "force_y_N", "force_z_N"), ("injected_J", "generated_J")
    columns, wanted, tools = {name: [] for name in (*needed, *energies)}, tool, set()
    for where, row in files.numbered_rows(path, ("tool", *needed)):
        tools.add(row["tool"])
        wanted = row["tool"] if wanted is None and row["time_s"] else wanted
        if row["tool"] == wanted and row["time_s"]:
            for name in needed:
                columns[name].append(files.number(row, name, where))
            for name in energies:
                if row.get(name):
                    columns[name].append(files.number(row, name, where))
    if tool is not None and tools and tool not in tools:
        raise Refusal(f"--tool {tool}: haptic.csv has no such tool; it has {', '.join(sorted(tools))}")
    return {name: np.array(values) for name, values in columns.items()} if columns["time_s"] else {}


def presented_ns(folder):
    """{modality: {event: ns}}, of presented.csv of a run or presented_MODALITY.csv of a rendering; only the hits of touch. Raises Refusal with file and line."""
    found = {}
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        if not name.startswith("presented") or not name.endswith(".csv") or not os.path.isfile(path):
            continue
        for where, row in files.numbered_rows(path, ("event_id", "modality", "part", "outcome", "presented_ns")):
            at_ns = files.whole(row, "presented_ns", where)
            if at_ns >= 0 and row["outcome"] in log_tables.PRESENTED and (row["modality"], row["part"]) != ("haptic", "constraint"):
                found.setdefault(row["modality"], {}).setdefault(row["event_id"], at_ns)
    return found


def largest_soa_ms(presented):
    """(largest median |asynchrony|, "A to B") over all pairs of modalities; None without a common event."""
    found = {f"{a} to {b}": float(np.median(np.abs(ms))) for (a, b), ms in log_tables.asynchronies_ms(presented).items()}
    return max(((ms, pair) for pair, ms in found.items()), default=None)


def ages_ms(tables):
    """{modality: mean age of its snapshots, ms} of the degraded modalities, from the logged decisions; all streams of a modality together."""
    made, delivered, end = {}, {}, {}
    for message in tables.messages("DEGRADED.csv"):
        name = message["modality"]
        for i in range(int(message["count"])):
            if int(message[f"decisions[{i}].is_event"]):
                continue
            at = int(message[f"decisions[{i}].time_ns"]) * 1e-9
            end[name] = max(end.get(name, at), at)
            if int(message[f"decisions[{i}].drop_reason"]) == 0:
                made.setdefault(name, []).append(at)
                delivered.setdefault(name, []).append(at + int(message[f"decisions[{i}].held_ns"]) * 1e-9)
    found = {name: age.measured_s(made[name], delivered[name], max(end[name], max(delivered[name]))) for name in made}
    return {name: 1e3 * value for name, value in found.items() if value is not None}


def resampled(times_s, values, at_s):
    """The newest value at or before each instant."""
    order = np.argsort(times_s, kind="stable")
    return values[order][np.clip(np.searchsorted(times_s[order], at_s, side="right") - 1, 0, len(order) - 1)]


def common_time_s(reference, other):
    """(begin, end) of the time that both have."""
    return max(reference["time_s"].min(), other["time_s"].min()), min(reference["time_s"].max(), other["time_s"].max())


def why_no_force(reference, other):
    """The reason why the forces of two tables are not compared; "": they are. Arrays of tool_rows()."""
    if not other or not reference:
        return f"the {'run' if not other else 'reference'} has no force of this tool"
    begin, end = common_time_s(reference, other)
    if end - begin < 2 / FORCE_RATE_HZ:
        return "their simulated times do not overlap"
    return "" if of_force(reference, other) else "neither has a contact"


def of_force(reference, other):
    """Metrics of the force of one tool against a reference, over their common time. Arrays of tool_rows(). Raises Refusal when that time is too long."""
    force = lambda rows: np.stack([rows[f"force_{axis}_N"] for axis in "xyz"], axis=1)
    begin, end = common_time_s(reference, other)
    if end - begin > LONGEST_S:
        raise Refusal(f"the forces span {end - begin:.6g} s, and at most {LONGEST_S:g} s are compared; give shorter runs")
    at_s = np.arange(begin, end, 1 / FORCE_RATE_HZ)
    if len(at_s) < 2:
        return {}
    x, y = resampled(reference["time_s"], force(reference), at_s), resampled(other["time_s"], force(other), at_s)
    felt = (np.linalg.norm(x, axis=1) > MIN_FORCE_N) | (np.linalg.norm(y, axis=1) > MIN_FORCE_N)
    if not felt.any():
        return {}
    scale = float(np.sqrt(np.mean(np.sum(x[felt] ** 2, axis=1)))) or 1.0
    etvo = compare.etvo_like(x / scale, y / scale, FORCE_RATE_HZ, MAX_LAG_S)
    return {"force_jnd_share": compare.jnd_tube(x[felt], y[felt], floor=compare.JND_FLOOR_N), "force_time_ms": etvo["time_ms"],
            "force_time_variation": etvo["time_variation"], "force_value_N": scale * etvo["value"], "force_rmse_N": compare.rmse(x, y),
            "force_hssim_like": compare.hssim_like(x, y)}


def energies_J(rows):
    return {name: float(rows[name].max()) for name in ("injected_J", "generated_J") if len(rows.get(name, ()))}


def of_pictures(reference, other, pictures, every=15):
    """Mean SSIM of each `every`-th picture of two videos. pictures: function (path, numbers) that yields (number, rows of pixels)."""
    paths = [os.path.join(folder, "video.mp4") for folder in (reference, other)]
    if not all(os.path.exists(path) for path in paths):
        return {}
    wanted = set(range(0, 100_000, every))
    grey = lambda p: np.asarray(p, dtype=float).mean(axis=-1)
    both = zip(pictures(paths[0], wanted), pictures(paths[1], wanted))
    found = [compare.ssim_picture(grey(a), grey(b)) for (_, a), (_, b) in both if a.shape == b.shape]
    return {"picture_ssim": float(np.mean(found))} if found else {}


def sent_per_s(tables):
    """Packets per second that the deadband of a stage of touch sends; None without one."""
    streams = {}  # {(process, modality and stage): [sent, suppressed, times]}; another stage may have many more updates
    for message in tables.messages("DEGRADED.csv"):
        if not message["modality"].startswith("haptic"):
            continue
        for i in range(int(message["count"])):
            if int(message[f"decisions[{i}].is_event"]):
                continue
            why = int(message[f"decisions[{i}].drop_reason"])
            own = streams.setdefault((message["sender"], message["modality"]), [0, 0, []])
            own[0] += why in (0, log_tables.DROP_REASONS.index("loss"))
            own[1] += why == log_tables.DROP_REASONS.index("deadband")
            own[2].append(int(message[f"decisions[{i}].time_ns"]) * 1e-9)
    rates = [sent / (max(times) - min(times)) for sent, suppressed, times in streams.values() if suppressed and max(times) > min(times)]
    return sum(rates) if rates else None


def metrics(folder, reference=None, tables=None, tool=None, pictures=None, explain=lambda sentence: None):
    """{metric: value} of a folder of tables, in the order of MEANING. reference: another such folder, with the same motion of the hand; tables: LogTables of its log,
    for what only the log has; pictures: as of of_pictures(); explain: called with the reason of each comparison that is left out. Raises Refusal."""
    rows, found = tool_rows(folder, tool), {}
    if soa := largest_soa_ms(presented_ns(folder)):
        found["onset_soa_ms"] = soa[0]
    if tables:
        found["age_ms"] = max(ages_ms(tables).values(), default=None)
        found["sent_per_s"] = sent_per_s(tables)
    found.update(energies_J(rows))
    if reference:
        other = tool_rows(reference, tool)
        forces = of_force(other, rows) if rows and other else {}
        seen = of_pictures(reference, folder, pictures) if pictures else {}
        found.update({**forces, **seen})
        if not forces:
            explain(f"forces are not compared: {why_no_force(other, rows)}")
        if pictures and not seen:
            explain("pictures are not compared: both folders need a video.mp4 of the same size")
    for name, value in found.items():
        if value is not None and not np.isfinite(value):
            raise Refusal(f"{folder}: {name} is not finite; the forces in its haptic.csv are not those of a run")
    return {name: found[name] for name in MEANING if found.get(name) is not None}
