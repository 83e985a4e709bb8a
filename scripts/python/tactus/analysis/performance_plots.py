"""Figures of games: success and time over the level of a degradation, two degraded senses, and each sense removed."""
import numpy as np

from scipy.stats import t as student

from tactus.analysis import limits
from tactus.analysis.plot_style import BREAK, INK, PALE, colour, figures, stamp
from tactus.plotting import matplotlib

SHADE = "RdYlBu"


def limit_mark(axes, limit):
    if limit.reached:
        ends = sorted(v for v in (limit.low, limit.high) if np.isfinite(v))
        if len(ends) == 2:
            axes.axvspan(*ends, color=BREAK, alpha=0.10, linewidth=0, zorder=0)
        axes.axvline(limit.value, color=BREAK, linewidth=1.2)


def factor_figure(cells, factor, found, margins, observer, clustered=False):
    """Success and time to win over the level, with the margin and its crossing. found: [Limit] of break_limits()."""
    baseline, mine = cells[()], limits.series(cells, factor)
    fig, (left, right) = figures.new(1, 2, height_in=2.6)
    tint = colour(factor.modality)
    falling = factor.lower_is_worse
    x = np.array([cell.achieved for cell in mine])
    zero = None if falling else 0.0
    shares = np.array([100 * cell.share for cell in mine])
    ends = np.array([[100 * v for v in cell.share_interval(clustered)] for cell in mine])
    times = np.exp([cell.times.mu if cell.times.identified else np.nan for cell in mine])
    time_ends = np.array([time_interval(cell) for cell in mine])
    base_time = time_interval(baseline)
    base_share = [100 * v for v in baseline.share_interval(clustered)]
    for axes, y, low_high, base, base_ends, bound in (
            (left, shares, ends, 100 * baseline.share, base_share, 100 * (baseline.share - margins[0])),
            (right, times, time_ends, np.exp(baseline.times.mu), base_time, np.exp(baseline.times.mu) * margins[1])):
        axes.axhspan(*base_ends, color="#e6ece6", linewidth=0, zorder=0)
        axes.axhline(base, color="#5c7a5c", linewidth=0.9)
        axes.axhline(bound, color=BREAK, linewidth=0.9, linestyle="--")
        xs, ys = (x, y) if zero is None else (np.concatenate([[zero], x]), np.concatenate([[base], y]))
        axes.plot(xs, ys, color=tint, linewidth=1)
        axes.errorbar(x, y, yerr=np.abs(low_high.T - y), fmt="o", color=tint, markersize=4, capsize=2, linewidth=1)
        if falling:
            axes.set_xscale("log")
            axes.set_xticks(x, [f"{v:g}" for v in x])
            axes.set_xticks([], minor=True)
            axes.invert_xaxis()
        axes.set_xlabel(factor.axis())
    left.set(ylabel="games won (%)", ylim=(-3, 103))
    right.set_ylabel("time to win, median (s)")
    right.set_ylim(bottom=0)
    for axes, limit in ((left, found[0]), (right, found[1])):
        limit_mark(axes, limit)
        axes.set_title(limit_text(limit), fontsize=8)
    counts = sorted({min(c.n for c in mine), max(c.n for c in mine)})
    fig.suptitle(f"{factor.words()}; baseline n = {baseline.n}, each level n = {'–'.join(map(str, counts))}", fontsize=9, x=0.01, ha="left")
    stamp(fig, observer)
    return fig


def time_interval(cell):
    """95 % interval of the median time to win, s."""
    half = student.ppf(0.975, max(1, cell.times.won - 1)) * np.sqrt(cell.times.variance) if cell.times.identified else np.nan
    return float(np.exp(cell.times.mu - half)), float(np.exp(cell.times.mu + half))


def margin_figure(factor, rows, margins, observer):
    """The limit over the margin (left: success; middle: time given success), and over the time limit at the study's margins (right). rows: of
    break_limits.curves()."""
    fig, panels = figures.new(1, 3, height_in=2.5)
    tints = {"success": colour(factor.modality), "time": INK}
    full = max(r["limit_s"] for r in rows)
    by_limit = lambda outcome: sorted((r for r in rows if r["outcome"] == outcome and np.isclose(r["margin"], margins[0] if outcome == "success" else margins[1] - 1)),
                                      key=lambda r: r["limit_s"])
    of_margin = lambda outcome: [r for r in rows if r["outcome"] == outcome and r["limit_s"] == full]
    for axes, outcome, mine, name, x in ((panels[0], "success", of_margin("success"), "margin of success (points)", lambda r: 100 * r["margin"]),
                                         (panels[1], "time", of_margin("time"), "margin of time (%)", lambda r: 100 * r["margin"]),
                                         *((panels[2], outcome, by_limit(outcome), "time limit (s)", lambda r: r["limit_s"]) for outcome in ("success", "time"))):
        xs = np.array([x(r) for r in mine])
        finite = lambda name: np.array([r[name] if np.isfinite(r[name]) else (np.nan if name == "value" else r["up_to"]) for r in mine])
        axes.fill_between(xs, finite("low"), finite("high"), color=tints[outcome], alpha=0.13, linewidth=0)
        axes.plot(xs, finite("value"), color=tints[outcome], linewidth=1.3, label=outcome)
        axes.set(xlabel=name)
        if factor.lower_is_worse and not axes.yaxis_inverted():
            axes.invert_yaxis()
    panels[0].set_ylabel(f"L_break: {factor.axis()}")
    panels[2].legend(fontsize=7)
    stamp(fig, observer)
    return fig


def limit_text(limit):
    """L_break and its interval as text."""
    unit = f" {limit.factor.unit}" if limit.factor.unit else ""
    number = lambda v: f"{v:.3g}"
    if np.isnan(limit.value):
        return f"L_break by {limit.by}: not identified"
    if not limit.reached:
        return f"L_break by {limit.by}: not reached up to {number(limit.up_to)}{unit}"
    ends = [number(v) if np.isfinite(v) else f"not by {number(limit.up_to)}" for v in (limit.low, limit.high)]
    return f"L_break by {limit.by}: {number(limit.value)}{unit} [{ends[0]}, {ends[1]}]"


def frontier_figure(made, cells, margins, observer):
    """Two maps: games won and time to win, with contours at the margin; and the frontier with its interval."""
    baseline = cells[()]
    fig, maps = figures.new(1, 2, height_in=3.2)
    x, y = np.arange(len(made.second_levels)), np.arange(len(made.first_levels))
    for axes, grid, base, bound, title, form in (
            (maps[0], made.grid(lambda c: 100 * c.share), 100 * baseline.share, 100 * (baseline.share - margins[0]), "games won (%)", "{:.0f}"),
            (maps[1], made.grid(lambda c: c.mean_time_s), baseline.mean_time_s, baseline.mean_time_s * margins[1], "time to win (s)", "{:.1f}")):
        time = axes is maps[1]
        known = grid[~np.isnan(grid)]
        low, high = float(min(known.min(), bound)), float(max(known.max(), bound))
        pad = 1e-6 + 0.02 * (high - low)
        image = axes.imshow(grid, origin="lower", aspect="auto", cmap=SHADE + "_r" if time else SHADE, alpha=0.75, norm=matplotlib.colors.TwoSlopeNorm(bound, low - pad, high + pad))
        for i in range(len(y)):
            for j in range(len(x)):
                if not np.isnan(grid[i, j]):
                    axes.text(j, i, form.format(grid[i, j]), ha="center", va="center", fontsize=7)
        if len(x) > 1 and len(y) > 1 and not np.isnan(grid).any() and grid.min() < bound < grid.max():
            axes.contour(x, y, grid, levels=[bound], colors=[BREAK], linewidths=1.8)
            if not time and grid.min() < 75 < grid.max():
                axes.contour(x, y, grid, levels=[75], colors=[INK], linewidths=1, linestyles="--")
        axes.set_xticks(x, [mark(v) for v in made.second_levels])
        axes.set_yticks(y, [mark(v) for v in made.first_levels])
        axes.set(xlabel=made.second.axis(), title=f"{title}; red: margin at {form.format(bound)}")
        axes.grid(False)
        fig.colorbar(image, ax=axes, shrink=0.8, pad=0.02).ax.tick_params(labelsize=6.5)
    maps[0].set_ylabel(made.first.axis())
    stamp(fig, observer)
    return fig


def mark(level):
    return "none" if level == 0 else f"{level:g}"


def edge_figure(made, observer):
    """The frontier: L_break of the second sense, by success or time, at each level of the first."""
    fig, axes = figures.new(height_in=2.5)
    tops = [limit.up_to for _, limit in made.edge]
    for i, (_, limit) in enumerate(made.edge):
        low, high = (v if np.isfinite(v) else top for v, top in ((limit.low, tops[i]), (limit.high, tops[i])))
        axes.plot([i, i], sorted((low, high)), color=colour(made.second.modality), linewidth=2, alpha=0.5)
        if limit.reached:
            axes.plot([i], [limit.value], "o", color=colour(made.second.modality), markersize=5)
        else:
            axes.plot([i], [tops[i]], "^", color=colour(made.second.modality), markersize=6, markerfacecolor="white")
    joined = [(i, limit.value) for i, (_, limit) in enumerate(made.edge) if limit.reached]
    axes.plot(*zip(*joined) if joined else ([], []), color=colour(made.second.modality), linewidth=0.8)
    axes.set_xticks(range(len(made.edge)), [mark(level) for level, _ in made.edge])
    axes.set(xlabel=made.first.axis(), ylabel=f"L_break: {made.second.axis()}", title="frontier; open triangle: not reached up to this level; 0: the first factor alone reaches the margin")
    axes.set_xlim(-0.5, len(made.edge) - 0.5)
    stamp(fig, observer)
    return fig


def removal_figure(removed, baseline, margins, observer):
    """removed: [(words, Difference)]. Difference of success and ratio of time, with intervals and margins."""
    fig, (left, right) = figures.new(1, 2, height_in=0.9 + 0.34 * len(removed), sharey=True)
    y = np.arange(len(removed))[::-1]
    for axes, values, ends, nothing, bound in (
            (left, [100 * d.success for _, d in removed], [[100 * v for v in d.success_interval] for _, d in removed], 0, -100 * margins[0]),
            (right, [d.time for _, d in removed], [d.time_interval for _, d in removed], 1, margins[1])):
        tints = [colour(d.cell.degraded[0][0].modality) if len(d.cell.degraded) == 1 else PALE for _, d in removed]
        axes.barh(y, np.array(values) - nothing, left=nothing, color=tints, alpha=0.75, height=0.6)
        for at, (low, high) in zip(y, ends):
            axes.plot([low, high], [at, at], color=INK, linewidth=1.4)
        axes.axvline(nothing, color=INK, linewidth=0.8)
        axes.axvline(bound, color=BREAK, linewidth=0.9, linestyle="--")
    left.set_yticks(y, [name for name, _ in removed])
    left.set(xlabel="games won: difference (points)")
    right.set(xlabel="time to win: ratio")
    fig.suptitle(f"each sense removed; all senses: {100 * baseline.share:.0f} % won, {baseline.mean_time_s:.1f} s (n = {baseline.n})", fontsize=9, x=0.01, ha="left")
    stamp(fig, observer)
    return fig
