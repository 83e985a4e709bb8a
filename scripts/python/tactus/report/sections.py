"""The sections of a report except the traces. Each takes the Report and returns HTML."""
import numpy as np

from tactus.log import log_tables
from tactus.report import figures
from tactus.report.words import figure as number, listed, safe

QUANTILES = (5, 50, 95, 99)


def percentile(values, q):
    return float(np.percentile(values, q)) if len(values) else None


def scene_of(log):
    return (log.info.get("scene") or log.summary.get("scene") or "an unnamed scene").rsplit("/", 1)[-1].removesuffix(".sdf")


def degraded(log):
    """True when a profile with at least one operator was applied."""
    return bool(log.profile() and "<degrade" in log.profile()[0])


def head(report):
    log, s = report.log, report.log.summary
    c = s["contacts"]
    lost = c["lost"]
    slow = [name for name, n in s["nodes"].items() if n["missed_ticks"] > 0.01 * max(1, n["ticks"])]
    sentences = [f"{number(c['begin'])} contacts began and {number(c['hit'])} hits occurred in {number(s['seconds'])} s of {safe(scene_of(log))}.",
                 "No expected event was lost." if lost == 0 else f"<b>{number(lost)} expected events were lost.</b>",
                 f"The simulation ran at {number(s['realtime_factor'], 4)} of real time." if s["realtime_factor"] else "The log has no simulation.",
                 f"{safe(listed(slow))} missed more than 1 % of the ticks." if slow else "No process missed more than 1 % of its ticks."]
    if degraded(log):
        sentences.append("A degradation profile was applied.")
    several = f", compared with {len(report.logs) - 1} other log{'s' if len(report.logs) > 2 else ''}" if len(report.logs) > 1 else ""
    return (f"<h1>{safe(scene_of(log))}: content, timing and quality of the rendering</h1>\n"
            f'<p class="sub">Report on {safe(log.name)}{several}</p>\n<p class="sum">{" ".join(sentences)}</p>\n')


def methods(report):
    log, s = report.log, report.log.summary
    damage = log.schema.get("damaged_regions", 0)
    rates = log.nominal_rates()
    nominal = listed(f"{name} at {number(rate)} Hz" for name, rate in sorted(rates.items()) if name.endswith("_node")) if rates else ""
    facts = [["Scene", scene_of(log)], ["Requested", f"{number(s['seconds'])} s"], ["Recorded", f"{number(s['recorded_seconds'], 4)} s"],
             ["Seed", str(log.info.get("seed", "–"))], ["Version", log.info.get("version", "–")], ["Commit", log.info.get("git") or "unknown"],
             ["Playout policy", log.policy() or "none published"], ["Damaged regions of the log", str(damage)],
             ["Messages", number(sum(b["messages"] for b in s["bus"].values()))],
             ["Missing sequence numbers", number(sum(b["gaps"] for b in s["bus"].values()))]]
    text = [f"<p>The scene was simulated and rendered by separate processes that exchange messages{': ' + safe(nominal) if nominal else ''}. All messages were "
            "recorded with the arrival time on the monotonic clock of the recorder. The simulation gives the times of "
            "events; each node reports the times of its presentations: the sample that leaves the sound card, the fence of "
            "the frame, the tick that commands the force or the plate. Differences between two processes on one machine need no "
            "clock correction; between machines they carry the uncertainty of the clock maps in the log.</p>\n"]
    if s["warnings"]:
        text.append("<p>Machine: " + safe(" ".join(w.rstrip(".") + "." for w in s["warnings"])) + "</p>\n")
    return "<h2>The run</h2>\n" + "".join(text) + report.table("Description of the log.", ["", "", ], facts)


def contacts(report):
    out = ["<h2>Contacts and outcomes</h2>\n"]
    c = report.log.summary["contacts"]
    rows = []
    for sense, m in c["by_modality"].items():
        rows.append([figures.NAME.get(sense, sense).replace(" (hit)", ""), *(m[k] for k in ("expected", "presented", "late", "dropped_late", "dropped_by_profile", "stalled", "dead", "lost"))])
    out.append(f"<p>{number(c['begin'])} contacts began, {number(c['end'])} ended, and {number(c['hit'])} hits occurred. Sound must present each hit; vision each "
               "begin and hit; touch and warmth those of their own tool.</p>\n")
    if not rows:
        return "".join(out) + report.lacks("No modality reported its presentations.")
    out.append(report.table("Expected events of each modality and their outcomes.", ["modality", "expected", "presented", "of them late", "dropped, late", "dropped, profile", "stalled", "dead", "lost"], rows))
    for absent in report.log.summary["absent"]:
        out.append(report.lacks(f"The modality {absent} was absent: no process reported for it."))
    game = report.log.summary.get("game")
    if game:
        won = f", all at {number(game['won_at_s'])} s" if game.get("won_at_s") is not None else ""
        out.append(f"<p>Of the game’s {number(game['holes'])} holes {number(game['filled'])} were filled{won}.</p>\n")
    return "".join(out)


def processes(report):
    log = report.log
    rates, rows = log.nominal_rates(), []
    for name, n in sorted(log.summary["nodes"].items()):
        rows.append([name, rates.get(name), n["rate_hz"], n["missed_ticks"], n["tick_us"]["p50"], n["tick_us"]["p99"], n["tick_us"]["max"], n["wake_us"]["p50"],
                     n["wake_us"]["p99"], n["restarts"]])
    out = ["<h2>Rates, ticks and computing time</h2>\n"]
    if not rows:
        return "".join(out) + report.lacks("No process published its health.")
    out.append(report.table("Processes: nominal and achieved rate, missed ticks, duration and start latency of a tick. sync_node also wakes when a message arrives.",
                            ["process", "nominal, Hz", "achieved, Hz", "missed", "tick p50, µs", "p99", "max", "late p50, µs", "p99", "restarts"], rows))
    work = log.phase_times_us()
    if not work:
        return "".join(out) + report.lacks("No time per phase of any process was recorded (tagged variables work.*), so physics and rendering are shown only by their ticks.")
    names = sorted(work)
    fig, axes = figures.new(height_in=0.9 + 0.28 * len(names))
    for row, name in enumerate(names):
        left = 0.0
        for phase in log_tables.PHASES:
            if phase in work[name] and work[name][phase].mean() > 0:
                axes.barh(row, work[name][phase].mean(), left=left, color=figures.PHASE_COLOUR[phase], height=0.66)
                left += work[name][phase].mean()
        if "all" in work[name]:
            axes.plot(percentile(work[name]["all"], 99), row, marker="|", color="#222222", markersize=9, markeredgewidth=1.4)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.set_xscale("symlog", linthresh=100)
    axes.set_xlim(0, None)
    axes.set_xlabel("time of a tick, µs (linear to 100 µs, then logarithmic)")
    axes.legend([figures.plt.Rectangle((0, 0), 1, 1, color=figures.PHASE_COLOUR[p]) for p in log_tables.PHASES], log_tables.PHASES, ncols=6, loc="lower center",
                bbox_to_anchor=(0.45, 1.0), handlelength=1, columnspacing=1.2)
    physics = work.get("sim_node", {})
    means = [f"{phase} {number(physics[phase].mean())} µs" for phase in ("collision", "solve", "integrate") if phase in physics]
    caption = ("Mean time of a tick by phase; the mark is the 99th percentile of the whole tick. "
               + (f"Physics took {listed(means)} of a step on average, {number(percentile(physics['all'], 99))} µs at the 99th percentile." if means and "all" in physics else ""))
    out.append(report.gallery.keep(fig, "work", caption))
    render = [[name, *(float(work[name][p].mean()) if p in work[name] else None for p in log_tables.PHASES),
               percentile(work[name]["all"], 99) if "all" in work[name] else None] for name in names]
    out.append(report.table("Mean time of a tick by phase, and its 99th percentile, µs.", ["process", *log_tables.PHASES, "p99 of all"], render))
    return "".join(out)


def budget_lines(axes, report):
    budget = report.log.budget_ms()
    if budget:
        axes.axvline(budget, color="#999999", linestyle="--", linewidth=0.9)
        axes.text(budget, 0.02, f" budget {number(budget)} ms", color="#666666", fontsize=7.5, rotation=90, va="bottom", ha="right")
    return budget


def latency(report):
    out = ["<h2>Latency</h2>\n"]
    hops = [log_tables.latencies_ms(log.events(), log.first_received_ns(), log.presented_ns()) for log in report.logs]
    own, late = hops[0], report.log.lateness_ms()
    if not own:
        return "".join(out) + report.lacks("No event has a time on the host clock; the latency is unknown.")
    fig, (left, right) = figures.new(columns=2, height_in=2.7)
    for hop, values in own.items():
        sense = hop.removeprefix("event to ")
        colour = figures.COLOUR.get(sense, figures.COLOUR["simulation"])
        for i, log_hops in enumerate(hops):
            if hop in log_hops:
                label = (figures.NAME.get(sense, "on the bus") if i == 0 else None)
                figures.cdf(left, log_hops[hop], color=colour, label=label, linestyle=figures.DASHES[i % len(figures.DASHES)])
    budget = budget_lines(left, report)
    figures.name_logs(fig, [log.name for log in report.logs], line=True)
    left.set(xlabel="after the event, ms", ylabel="share of events", ylim=(0, 1.02))
    left.set_xlim(0, max(10.0, 1.1 * max(percentile(v, 99) for v in own.values()), 1.1 * (budget or 0)))
    left.set_title("a  from the event")
    left.legend(loc="lower right")
    for sense, values in late.items():
        figures.cdf(right, values, color=figures.COLOUR.get(sense, "#555555"), label=figures.NAME.get(sense, sense))
    right.set(xlabel="after the scheduled time, ms", ylim=(0, 1.02))
    right.set_title("b  from the scheduled time")
    if late:
        low, high = min(percentile(v, 1) for v in late.values()), max(percentile(v, 99) for v in late.values())
        right.set_xlim(min(-1.0, low * 1.2), max(2.0, high * 1.2))
        right.legend(loc="lower right")
    medians = listed(f"{figures.NAME[h.removeprefix('event to ')]} {number(percentile(v, 50))} ms" for h, v in own.items() if h != "simulation to bus")
    asked = f" The dashed line is the budget of {number(budget)} ms, the maximum of chosen delays." if budget else ""
    dotted = " Dotted and dashed curves are the other logs." if len(report.logs) > 1 else ""
    out.append(report.gallery.keep(fig, "latency", f"Distribution of latency per hop. <b>a</b> From the simulated event to its first message on the bus, and to the "
                                   f"presentation by each modality: in the median {medians}.{asked} <b>b</b> From the time that the policy scheduled to the presentation.{dotted}"))
    rows = [[f"event → {figures.NAME.get(hop.removeprefix('event to '), 'bus')}", len(v), *(percentile(v, q) for q in QUANTILES), float(v.max())] for hop, v in own.items()]
    rows += [[f"due → {figures.NAME.get(sense, sense)}", len(v), *(percentile(v, q) for q in QUANTILES), float(v.max())] for sense, v in late.items()]
    out.append(report.table("Latency per hop, ms.", ["hop", "events", "p5", "p50", "p95", "p99", "max"], rows))
    return "".join(out)


def asynchrony(report):
    out = ["<h2>Asynchrony of onsets</h2>\n"]
    pairs = [log_tables.asynchronies_ms(log.presented_ns()) for log in report.logs]
    own = pairs[0]
    if not own:
        return "".join(out) + report.lacks("No event was presented by two modalities, so there is no asynchrony.")
    columns = 2 if len(own) > 1 else 1
    rows_n = (len(own) + columns - 1) // columns
    fig, axes = figures.new(rows_n, columns, height_in=0.4 + 1.55 * rows_n, squeeze=False)
    used, table = [], []
    for spot, ((a, b), values) in zip(axes.flat, own.items()):
        bands = log_tables.bands(report.thresholds, a, b)
        shown = [at for at, _ in bands if abs(at) <= 130]
        every = np.concatenate([found[a, b] for found in pairs if (a, b) in found])
        low, high = min([every.min(), *shown, -10]) * 1.1 - 2, max([every.max(), *shown, 10]) * 1.1 + 2
        inside = [max((at for at, _ in bands if at < 0), default=None), min((at for at, _ in bands if at > 0), default=None)]
        if bands:
            spot.axvspan(inside[0] if inside[0] is not None else low, inside[1] if inside[1] is not None else high, color="#eaf3ea", zorder=0)
        edges = np.linspace(low, high, 61)
        spot.hist(values, bins=edges, color=figures.COLOUR[b], alpha=0.85)
        for i, other in enumerate(pairs[1:], 1):
            if (a, b) in other:
                spot.hist(other[a, b], bins=edges, histtype="step", color=figures.OF_LOG[i % len(figures.OF_LOG)], linewidth=1)
        for at, band in bands:
            if low < at < high:
                spot.axvline(at, color="#884444", linewidth=0.8, linestyle=(0, (4, 2)))
                used.append((at, a, b, band))
        spot.axvline(0, color="#333333", linewidth=0.8)
        spot.set_xlim(low, high)
        spot.set_title(f"{figures.NAME[a]} to {figures.NAME[b]}", fontsize=8.5)
        spot.yaxis.get_major_locator().set_params(integer=True, nbins=4)
        outside = lambda limit: int(((values < limit[0]) if limit[0] is not None else np.zeros(len(values), bool)).sum()
                                    + ((values > limit[1]) if limit[1] is not None else np.zeros(len(values), bool)).sum())
        table.append([f"{figures.NAME[a]} to {figures.NAME[b]}", len(values), *(percentile(values, q) for q in QUANTILES[:3]),
                      outside(inside) / len(values) * 100 if bands else None])
    figures.name_logs(fig, [log.name for log in report.logs])
    for spot in axes.flat[len(own):]:
        spot.set_visible(False)
    for spot in axes[-1]:
        spot.set_xlabel("later by, ms")
    cited = sorted({(safe(band["what"]), safe(band["situation"]), band["source"]) for _, _, _, band in used}, key=lambda c: c[::-1])
    lines = listed(f"{what} ({situation}) {report.cite(source)}" for what, situation, source in cited)
    steps = " Outlines: the other logs." if len(report.logs) > 1 else ""
    out.append(report.gallery.keep(fig, "asynchrony", "Onset of the second modality after that of the first, for every event that both presented; negative: before it. Dashed: published thresholds, each for its own "
                                   f"order and task: {lines or 'none for these pairs'}. The background is green within the narrowest threshold on each side.{steps}"))
    out.append(report.table("Asynchrony, ms; the last column is the share beyond the narrowest published threshold of each side, if there is one.",
                            ["pair", "events", "p5", "p50", "p95", "beyond, %"], table))
    return "".join(out)


def raster(report):
    log = report.log
    events, presented = log.events(), log.presented_ns()
    instants = {e: int(r["host_ns"]) for e, r in events.items() if r["host_ns"] and int(r["host_ns"]) > 0}
    if not instants:
        return ""
    begin = min(instants.values())
    lanes = [s for s in log_tables.SENSES if s in presented]
    fig, axes = figures.new(height_in=1.0 + 0.26 * (len(lanes) + 3))
    rows = [[(ns - begin) * 1e-9 for e, ns in instants.items() if events[e]["kind"] == kind] for kind in ("begin", "hit", "end")]
    rows += [[(ns - begin) * 1e-9 for ns in presented[sense].values()] for sense in lanes]
    colours = [figures.COLOUR["simulation"]] * 3 + [figures.COLOUR[s] for s in lanes]
    axes.eventplot(rows, lineoffsets=range(len(rows)), linelengths=0.72, linewidths=0.8, colors=colours)
    axes.set_yticks(range(len(rows)), ["contacts begin", "hits", "contacts end", *(figures.NAME[s] for s in lanes)])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("s after the first event")
    return "<h2>Events</h2>\n" + report.gallery.keep(
        fig, "raster", f"Every simulated event and its presentation by each modality: {number(len(instants))} events, {number(sum(len(presented[s]) for s in lanes))} presentations.")


def degradation(report):
    several = len(report.logs) > 1
    return "<h2>Degradation</h2>\n" + "".join((f"<h3>{safe(log.name)}</h3>\n" if several else "") + profile_effect(report, log, i) for i, log in enumerate(report.logs))


def profile_effect(report, log, which):
    out = []
    profile, decisions = log.profile(), log.decisions()
    if not profile or "<degrade" not in profile[0]:
        out.append("<p>No modality was degraded: the profile was empty.</p>\n" if profile else "<p>No degradation profile was published.</p>\n")
    else:
        out.append(f"<p>The profile as published on the bus (first message at {number(profile[1])} s):</p>\n<pre>{safe(profile[0])}</pre>\n")
    if not decisions:
        if profile and "<degrade" in profile[0]:
            out.append(report.lacks("No modality reported the effect of the profile."))
        return "".join(out)
    rows = []
    named = lambda sense, what: f"{figures.NAME.get(sense, sense).replace(' (hit)', '')}, {what}"
    for (sense, what), d in sorted(decisions.items()):
        dropped = ", ".join(f"{number(n)} by {why}" for why, n in sorted(d["why"].items()) if why != "let through") or "none"
        total = sum(d["why"].values())
        held_ms = d["held_ms"]
        mean_sd = [held_ms.mean(), held_ms.std()] if len(held_ms) else [None, None]
        rows.append([named(sense, what), total, d["why"].get("let through", 0), dropped, d["twice"], *mean_sd, percentile(held_ms, 5), percentile(held_ms, 50), percentile(held_ms, 95)])
    out.append(report.table("Measured effect of the profile: events and snapshots received, passed, dropped and repeated, and the delay of the passed ones, ms.",
                            ["modality", "received", "passed", "dropped", "repeated", "delay mean", "sd", "p5", "p50", "p95"], rows))
    held = {s: d["held_ms"] for s, d in decisions.items() if len(d["held_ms"]) and d["held_ms"].max() > 0}
    if held:
        fig, axes = figures.new(height_in=2.1)
        for (sense, what), values in sorted(held.items()):
            figures.cdf(axes, values, color=figures.COLOUR.get(sense, "#555555"), linestyle="-" if what == "events" else ":", label=named(sense, what))
        axes.set(xlabel="delay, ms", ylabel="share", ylim=(0, 1.02))
        axes.legend(loc="lower right")
        out.append(report.gallery.keep(fig, f"held_back_{which + 1}", "Distribution of the delay that the profile added to passed messages."))
    return "".join(out)


def comparison(report):
    rows = []
    for log in report.logs:
        s, pairs = log.summary, log_tables.asynchronies_ms(log.presented_ns())
        hops = log_tables.latencies_ms(log.events(), {}, log.presented_ns())
        of = lambda found, key: percentile(found[key], 50) if key in found else None
        rows.append([log.name, scene_of(log), s["contacts"]["hit"], s["contacts"]["lost"], s["contacts"]["dropped_by_profile"],
                     *(of(hops, f"event to {sense}") for sense in ("haptic", "audio", "visual", "thermal")), of(pairs, ("haptic", "audio")), of(pairs, ("haptic", "visual")),
                     of(pairs, ("audio", "visual"))])
    return "<h2>Comparison</h2>\n" + report.table(
        f"Comparison of the logs; the other sections describe the first, {safe(report.log.name)}, with the others overlaid. Latency and asynchrony are medians, ms.",
        ["log", "scene", "hits", "lost", "dropped by profile", "touch after", "sound after", "vision after", "warmth after", "touch to sound", "touch to vision", "sound to vision"], rows)


def always_missing(report):
    return ["The physical output of loudspeaker, display and device: the times are those that the nodes report. A microphone, a photodiode "
            "and an accelerometer would measure it.", "The machine, except for the priorities that its processes report.",
            *([] if report.log.summary["nodes"] else ["The health of any process."])]
