"""Figures of limits: all limits of a factor, the ratio of L_break to L_detect, and felt properties."""
import numpy as np

from tactus import palette
from tactus.analysis.plot_style import BREAK, INK, PALE, colour, figures, stamp

MARK = {"detect": "o", "appear": "s", "break": "D"}
NAME = {"detect": "L_detect", "appear": "L_appear", "break": "L_break"}
TINT = palette.LIMIT


def limits_figure(factor, found, thresholds, observer):
    """Limits of one factor, one per row, with published thresholds. found: [Limit]; thresholds: [Threshold]."""
    fig, axes = figures.new(height_in=0.9 + 0.27 * (len(found) + len(thresholds)))
    names = []
    y = 0
    for t in thresholds:
        axes.plot([t.ms], [y], "|", color=PALE, markersize=11, markeredgewidth=2)
        names.append(f"{t.earlier} → {t.later}, {t.what}: {t.short()}")
        y -= 1
    for limit in found:
        ends = [v if np.isfinite(v) else limit.up_to for v in (limit.low, limit.high)]
        axes.plot(ends, [y, y], color=TINT[limit.kind], linewidth=1.6)
        if limit.reached:
            axes.plot([limit.value], [y], MARK[limit.kind], color=TINT[limit.kind], markersize=5)
        if not np.isfinite(limit.high):
            axes.plot([limit.up_to], [y], "<" if factor.lower_is_worse else ">", color=TINT[limit.kind], markerfacecolor="white", markersize=6)
        names.append(f"{NAME[limit.kind]} by {limit.by}")
        y -= 1
    axes.set_yticks(range(0, y, -1), names, fontsize=7.5)
    axes.set(xlabel=factor.axis(), title="open triangle: not reached up to this level")
    if factor.lower_is_worse:
        axes.invert_xaxis()
    else:
        axes.set_xlim(left=0)
    axes.grid(axis="y", visible=False)
    stamp(fig, observer)
    return fig


def forest_figure(rows, observer):
    """rows: [(words, published, value, low, high)]; published rows are paler. The ratio L_break / L_detect on a logarithmic axis."""
    fig, axes = figures.new(height_in=0.9 + 0.24 * len(rows))
    finite = [v for row in rows for v in row[2:] if np.isfinite(v) and v > 0]
    right = max(finite, default=1.0) * 2.0
    left = min([*finite, 1.0]) / 1.5
    y = np.arange(len(rows))[::-1]
    for at, (_, behind, value, low, high) in zip(y, rows):
        tint = PALE if behind else INK
        axes.plot([max(low, left) if np.isfinite(low) else right, high if np.isfinite(high) else right], [at, at], color=tint, linewidth=1.5)
        if np.isfinite(value):
            axes.plot([value], [at], "D", color=tint, markersize=4.5)
        if not np.isfinite(high):
            axes.plot([right], [at], ">", color=tint, markerfacecolor="white", markersize=6)
    axes.axvline(1, color=BREAK, linewidth=0.9, linestyle="--")
    axes.set_xscale("log")
    axes.set_xlim(left, right * 1.15)
    axes.xaxis.set_major_formatter(lambda v, _: f"{v:g}")
    axes.xaxis.set_minor_formatter(lambda v, _: f"{v:g}" if f"{v:e}"[0] in "25" else "")
    axes.tick_params(which="minor", labelsize=7)
    axes.set_yticks(y, [row[0] for row in rows], fontsize=7.5)
    axes.set(xlabel="L_break / L_detect", title="above 1: noticed before it harms the task", ylim=(-0.7, len(rows) - 0.3))
    axes.grid(axis="y", visible=False)
    stamp(fig, observer)
    return fig


def felt_figure(felt):
    """The shift of a felt property over the level, with the band of the JND."""
    fig, axes = figures.new(height_in=2.5)
    scale, unit = (100, "%") if felt.source.unit == "%" else (1, felt.source.unit)
    tint = colour(felt.factor.modality)
    axes.axhspan(-scale * felt.jnd, scale * felt.jnd, color="#f3e9d2", linewidth=0, zorder=0, label=f"JND {felt.source.at75:.3g} {felt.source.unit} at 75 %: {felt.source.source}")
    axes.axhline(0, color=INK, linewidth=0.7)
    y = scale * np.array(felt.shifts)
    axes.errorbar(felt.levels, y, yerr=np.abs(scale * np.array(felt.intervals).T - y), fmt="o-", color=tint, markersize=4, capsize=2, linewidth=1)
    if felt.limit.reached:
        axes.axvline(felt.limit.value, color=BREAK, linewidth=1.2)
        ends = sorted(v for v in (felt.limit.low, felt.limit.high) if np.isfinite(v))
        if len(ends) == 2:
            axes.axvspan(*ends, color=BREAK, alpha=0.1, linewidth=0)
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1.06), fontsize=7)
    axes.set(xlabel=felt.factor.axis(), ylabel=f"{'measured' if felt.measured else 'felt'} {felt.property}: shift ({unit})")
    stamp(fig, felt.observer)
    return fig
