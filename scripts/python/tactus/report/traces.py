"""The section on force, position and temperature over time, with the just noticeable difference around the reference. HTML."""
import numpy as np

from tactus.report import figures
from tactus.report.words import figure as number, safe

# Range of published Weber fractions of force. Below the floor, where no study measured, the band keeps its width, as in
# scripts/python/tactus/rerender/compare.py.
JND, FLOOR_N = (0.07, 0.10), 0.5
FORCE_SOURCES = ("Pang, Tan and Durlach 1991, Perception & Psychophysics 49(6):531-540: roughly 7 % from 2.5 to 10 N, pinch grasp, five persons",
                 "Raghu Prasad, Purswani and Manivannan 2013, Force JND for right index finger using contra lateral force matching paradigm, ICoRD'13: "
                 "approximately 10 % from 2 to 5 N, six persons")
MAX_TOOLS = 4


def share_above_jnd(reference_N, other_N, fraction):
    """Share of the ticks with force in at least one of the two, in which the difference exceeds the just noticeable one. Arrays (n,3), N."""
    size = np.linalg.norm(reference_N, axis=1)
    felt = (size > 1e-3) | (np.linalg.norm(other_N, axis=1) > 1e-3)
    apart = np.linalg.norm(other_N - reference_N, axis=1)
    return float(np.mean(apart[felt] > fraction * np.maximum(size[felt], FLOOR_N))) if felt.any() else 0.0


def resampled(hand, times_s):
    """Force at simulation times: that of the newest tick at or before each. NaN before the first tick."""
    known = ~np.isnan(hand["time_s"])
    order = np.argsort(hand["time_s"][known], kind="stable")
    at, force = hand["time_s"][known][order], hand["force_N"][known][order]
    index = np.searchsorted(at, times_s, side="right") - 1
    out = np.full((len(times_s), 3), np.nan)
    out[index >= 0] = force[index[index >= 0]]
    return out


def tool_section(report, tool, first):
    hands = [log.tool_trace(tool) for log in report.logs]
    own = hands[0]
    known = ~np.isnan(own["time_s"])
    if not known.any():
        return report.lacks(f"Tool {tool} has no force during the simulation: none of its ticks has a simulation time.")
    t, force = own["time_s"][known], own["force_N"][known]
    size = np.linalg.norm(force, axis=1)
    fig, (top, bottom) = figures.new(rows=2, height_in=3.5, sharex=True)
    at, (low, high, low10, high10) = figures.stretches(t, [size - JND[0] * np.maximum(size, FLOOR_N), size + JND[0] * np.maximum(size, FLOOR_N),
                                                           size - JND[1] * np.maximum(size, FLOOR_N), size + JND[1] * np.maximum(size, FLOOR_N)])
    top.fill_between(at, np.maximum(low10, 0), high10, color="#f3ddd3", linewidth=0, label=f"± {JND[1] * 100:.0f} %")
    top.fill_between(at, np.maximum(low, 0), high, color="#e8bfae", linewidth=0, label=f"± {JND[0] * 100:.0f} %")
    top.plot(*figures.envelope(t, size), color=figures.COLOUR["haptic"], linewidth=0.8, label="force")
    comparisons = []
    for i, (log, hand) in enumerate(list(zip(report.logs, hands))[1:], 1):
        other = resampled(hand, t)
        both = ~np.isnan(other[:, 0])
        if not both.any():
            continue
        top.plot(*figures.envelope(t[both], np.linalg.norm(other[both], axis=1)), color=figures.OF_LOG[i % len(figures.OF_LOG)], linewidth=0.7, label=log.name)
        share = [100 * share_above_jnd(force[both], other[both], k) for k in JND]
        comparisons.append(f"the force of {safe(log.name)} was outside the band of 7 % in {number(share[0])} % of the ticks with force, and outside the band of 10 % in {number(share[1])} %")
    top.set(ylabel="force, N", ylim=(0, None))
    top.legend(ncols=6, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.1)
    bottom.plot(*figures.envelope(t, own["device_m"][known] * 1e3), color="#888888", linewidth=0.9, label="device")
    bottom.plot(*figures.envelope(t, own["proxy_m"][known] * 1e3), color=figures.COLOUR["haptic"], linewidth=0.7, label="proxy")
    bottom.set(ylabel="height, mm", xlabel="simulated time, s")
    bottom.legend(ncols=2, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.1)
    cited = ", ".join(report.cite(source) for source in FORCE_SOURCES)
    more = (" Two runs with a person differ in their motion; " + "; ".join(comparisons) + ".") if comparisons else ""
    in_contact = float(np.mean(size > 1e-3)) * 100
    return report.gallery.keep(fig, f"force_{tool}", f"Tool {safe(tool)}{' (the first)' if first else ''}: force on the hand, maximum {number(size.max())} N, present in {number(in_contact)} % of the ticks. Shaded: "
                               f"unnoticeable differences, by Weber fractions of 7 and 10 % {cited}, also outside the forces of those studies, and never narrower than at {FLOOR_N} N (design). Below: height of the device and of the "
                               f"proxy, which stays on the surface.{more}")


def temperature(report):
    warm = report.log.temperatures()
    if len(warm) < 2:
        return report.lacks("No temperature was recorded.")
    fig, axes = figures.new(height_in=1.9)
    axes.plot(warm[:, 0], warm[:, 1], color=figures.COLOUR["thermal"], label="skin")
    axes.plot(warm[:, 0], warm[:, 2], color="#999999", linewidth=0.8, label="command to the display")
    for i, log in enumerate(report.logs[1:], 1):
        other = log.temperatures()
        if len(other) > 1:
            axes.plot(other[:, 0], other[:, 1], color=figures.OF_LOG[i % len(figures.OF_LOG)], linewidth=0.8, label=f"skin, {log.name}")
    axes.set(xlabel="simulated time, s", ylabel="°C")
    axes.legend(ncols=4, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.1)
    return report.gallery.keep(fig, "temperature", f"Model temperature of the skin, {number(warm[:, 1].min(), 4)} to {number(warm[:, 1].max(), 4)} °C, and the command to the display.")


def section(report):
    out = ["<h2>Force, position, temperature</h2>\n"]
    tools = report.log.tools()
    if not tools:
        out.append(report.lacks("No tool was recorded, so force and position are missing."))
    for i, tool in enumerate(tools[:MAX_TOOLS]):
        out.append(tool_section(report, tool, i == 0))
    if len(tools) > MAX_TOOLS:
        out.append(report.lacks(f"{len(tools) - MAX_TOOLS} more tools of the log are not drawn."))
    out.append(temperature(report))
    return "".join(out)
