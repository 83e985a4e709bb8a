"""Figures of psychometric functions: curves, participants side by side, measured asynchronies, and levels in order of presentation."""
import numpy as np

from tactus.analysis import answers, psychometric, published
from tactus.analysis.plot_style import BREAK, INK, PALE, colour, figures, label_of, stamp, thresholds_behind
from tactus.psychophysics import fits, functions

BAND_DRAWS = 300  # draws of the band around a curve; design
SIDE_BY_SIDE = 4  # columns of small multiples
RUNNING_FROM, RUNNING_POINTS = 10, 24  # running estimate: first number of answers, number of points; design
ADAPTIVE = 0.2  # share of the range: median step of levels below which the procedure counts as adaptive; design
NEARBY, WIDEST = 0.02, 0.06  # shares of the range: levels closer than the first are drawn as one point, up to the second in width; design
MAX_SMALL = 24  # participants on one figure; design
ASKED = {"sj": "share judged synchronous", "toj": "share “{a} first”", "2ifc": "share correct"}


def asked(condition):
    return ASKED[condition.kind].format(a=condition.pair[0] if condition.pair else "")


def span(curve, margin=0.08):
    """Range of the drawn curve: the levels plus a margin."""
    low, high = float(curve.levels.min()), float(curve.levels.max())
    room = margin * ((high - low) or 1)
    return (low - room if curve.condition.pair else max(0.0, low - room)), high + room


def together(levels, yes, total):
    """(levels, yes, total) with nearby levels joined at their mean, because measured levels all differ slightly."""
    order = np.argsort(levels)
    levels, yes, total = levels[order], yes[order], total[order]
    group, first, whole = np.zeros(len(levels), int), 0, np.ptp(levels) or 1
    for i in range(1, len(levels)):
        apart = levels[i] - levels[i - 1] > NEARBY * whole or levels[i] - levels[first] > WIDEST * whole
        first = i if apart else first
        group[i] = group[i - 1] + apart
    sums = np.bincount(group, weights=total)
    return np.bincount(group, weights=levels * total) / sums, np.bincount(group, weights=yes), sums


def points(axes, curve, scale=1.0, **style):
    """A point for each level, its area proportional to the number of answers."""
    levels, yes, total = together(curve.levels, curve.yes, curve.total)
    axes.scatter(levels, yes / total, s=scale * (6 + 60 * total / total.max()), facecolor="white", edgecolor=style.get("color", INK), linewidth=0.9, zorder=3)


def finite(levels):
    """(low, high) ends for infinite intervals: the levels plus their range on either side."""
    return levels.min() - np.ptp(levels), levels.max() + np.ptp(levels)


def redrawn(curve, rng):
    """Fits of answers drawn from the fitted function at the same levels."""
    name = answers.FUNCTION[curve.condition.kind]
    p = functions.FUNCTIONS[name].p(curve.levels, **curve.fit.params)
    yes = rng.binomial(curve.total.astype(int), np.clip(p, 0, 1), size=(BAND_DRAWS, len(p)))
    return fits.fit_many(curve.levels, yes, np.tile(curve.total, (BAND_DRAWS, 1)), name, curve.fit.fixed)


def line(axes, curve, rng=None, **style):
    """The fitted function, and the 95 % band of functions refitted to answers drawn from it (parametric bootstrap)."""
    function = functions.FUNCTIONS[answers.FUNCTION[curve.condition.kind]]
    x = np.linspace(*span(curve), 240)
    if rng is not None:
        drawn = function.outer(*(v[:, None] for v in redrawn(curve, rng).inner()))
        many = function.p(x, **{name: drawn[name] for name in function.parameters})
        axes.fill_between(x, *np.nanpercentile(many, [2.5, 97.5], axis=0), color=style.get("color", INK), alpha=0.13, linewidth=0)
    axes.plot(x, function.p(x, **curve.fit.params), **style)


def curve_figure(curve, seed):
    """(figure, number of thresholds outside it): one condition, all participants together, with published thresholds."""
    condition = curve.condition
    fig, axes = figures.new(height_in=2.9)
    tint = colour(condition.pair[1] if condition.pair else condition.factor.modality)
    axes.set_xlim(*span(curve))
    beyond = thresholds_behind(axes, published.of_pair(*condition.pair)) if condition.pair else 0
    line(axes, curve, np.random.default_rng(seed), color=tint, linewidth=1.6)
    points(axes, curve, color=tint)
    centre = "pss" if condition.pair else "threshold75"
    value, (low, high) = curve.value(centre), curve.intervals[centre]
    axes.plot(np.clip([low, high], *axes.get_xlim()), [-0.035] * 2, color=INK, linewidth=2, solid_capstyle="butt", zorder=4)
    axes.plot([value], [-0.035], marker="v", color=INK, markersize=5, zorder=4)
    if condition.kind == "sj":
        for edge in ("low75", "high75"):
            axes.axvline(curve.value(edge), color=tint, linewidth=0.8, linestyle=":")
    lapse = curve.fit.params.get("lapse")
    label = f"{'PSS' if condition.pair else 'threshold'} {value:.4g} [{low:.4g}, {high:.4g}]"
    if condition.pair:
        name = "window75" if condition.kind == "sj" else "jnd"
        label += f"\n{name} {curve.value(name):.1f} [{curve.intervals[name][0]:.1f}, {curve.intervals[name][1]:.1f}]"
    label += (f"\nlapse {lapse:.3f}" if lapse is not None else "") + f"\nn = {int(curve.total.sum())}"
    axes.text(1.02, 0.02, label, transform=axes.transAxes, fontsize=7.5, va="bottom")
    axes.set(ylim=(-0.07, 1.03), xlabel=condition.axis(), ylabel=asked(condition), title=condition.words())
    stamp(fig, curve.observer)
    return fig, beyond


def small_multiples(curves):
    """Answers and function of each participant, with the function of all participants behind."""
    people = [c for c in curves if c.participant != psychometric.ALL_PARTICIPANTS][:MAX_SMALL]
    all_participants = next(c for c in curves if c.participant == psychometric.ALL_PARTICIPANTS)
    rows = -(-len(people) // SIDE_BY_SIDE)
    fig, grid = figures.new(rows, SIDE_BY_SIDE, height_in=0.5 + 1.35 * rows, sharex=True, sharey=True, squeeze=False)
    tint = colour(all_participants.condition.pair[1] if all_participants.condition.pair else all_participants.condition.factor.modality)
    for axes, curve in zip(grid.flat, people):
        if all_participants.fit is not None:
            line(axes, all_participants, color=PALE, linewidth=1)
        if len(curve.levels):
            points(axes, curve, 0.4, color=tint)
        if curve.fit is not None:
            line(axes, curve, color=tint)
        else:
            axes.text(0.5, 0.5, "no fit", transform=axes.transAxes, ha="center", color=BREAK)
        axes.set_title(label_of(curve.participant, curves), fontsize=7.5)
        axes.tick_params(labelsize=7)
        axes.set_ylim(-0.03, 1.03)
    for axes in grid.flat[len(people):]:
        axes.set_visible(False)
    fig.supxlabel(all_participants.condition.axis(), fontsize=8)
    fig.supylabel(asked(all_participants.condition), fontsize=8)
    stamp(fig, all_participants.observer)
    return fig


def achieved_figure(curve):
    """Histograms of the measured asynchrony and of its difference to the requested one."""
    achieved, nominal = curve.trials["soa_achieved_ms"], curve.trials["soa_nominal_ms"]
    fig, (whole, off) = figures.new(1, 2, height_in=2.2, width_ratios=(2, 1))
    bins = max(20, min(120, int(np.ptp(achieved) / 2) + 1))
    whole.hist(achieved, bins=bins, color=colour(curve.condition.pair[1]), alpha=0.85)
    marks = np.unique(nominal[~np.isnan(nominal)])
    for x in marks if len(marks) <= MAX_SMALL else []:
        whole.axvline(x, color=INK, linewidth=0.6, linestyle=":")
    whole.set(xlabel=curve.condition.axis(), ylabel="trials", title="achieved" + ("; dotted: requested" if 0 < len(marks) <= MAX_SMALL else ""))
    error = (achieved - nominal)[~np.isnan(nominal)]
    if len(error):
        off.hist(error, bins=40, color=PALE)
        off.axvline(float(np.median(error)), color=INK, linewidth=1)
        off.set(xlabel="achieved − requested (ms)", title=f"median {np.median(error):.2f} ms, 95 % within {np.percentile(np.abs(error - np.median(error)), 95):.2f}")
        off.title.set_fontsize(7.5)
    else:
        off.set_visible(False)
    stamp(fig, curve.observer)
    return fig


def running(curve, levels, yes, name):
    """(numbers of answers, fitted centre after each)."""
    ends = np.unique(np.linspace(min(RUNNING_FROM, len(levels)), len(levels), RUNNING_POINTS).astype(int))
    same, at = np.unique(levels, return_inverse=True)
    if len(same) > psychometric.MAX_LEVELS:
        cuts = np.quantile(levels, np.linspace(0, 1, psychometric.MAX_LEVELS + 1)[1:-1])
        at = np.searchsorted(cuts, levels)
        same = np.array([levels[at == i].mean() if (at == i).any() else 0.0 for i in range(psychometric.MAX_LEVELS)])
    total = np.stack([np.bincount(at[:end], minlength=len(same)) for end in ends])
    said = np.stack([np.bincount(at[:end], weights=yes[:end], minlength=len(same)) for end in ends])
    found = fits.fit_many(same, said, total, answers.FUNCTION[curve.condition.kind], curve.fit.fixed)
    # There is no estimate before both answers have occurred.
    values = np.where((said.sum(axis=1) > 0) & (said.sum(axis=1) < total.sum(axis=1)) & found.placed(), found.estimates(name), np.nan)
    low, high = finite(levels)
    return ends, np.where((values > low) & (values < high), values, np.nan)


def trace_figure(curves):
    """Levels in order of presentation, filled for the answer yes; the running estimate; and the final interval."""
    people = [c for c in curves if c.participant != psychometric.ALL_PARTICIPANTS] or curves
    people = [c for c in people if len(c.trials)][:MAX_SMALL]
    rows = -(-len(people) // SIDE_BY_SIDE)
    columns = min(SIDE_BY_SIDE, len(people))
    fig, grid = figures.new(rows, columns, height_in=0.6 + 1.4 * rows, sharey=True, squeeze=False)
    for axes, curve in zip(grid.flat, people):
        condition = curve.condition
        levels, _ = psychometric.achieved(curve.trials, (None, condition.pair, condition.factor))
        _, yes = answers.answered(condition.kind, curve.trials, condition.pair)
        tint = colour(condition.pair[1] if condition.pair else condition.factor.modality)
        n = np.arange(1, len(levels) + 1)
        if len(levels) > 1 and np.median(np.abs(np.diff(levels))) < ADAPTIVE * np.ptp(levels):
            axes.plot(n, levels, color=PALE, linewidth=0.7)
        axes.scatter(n, levels, s=9, color=[tint if y else "white" for y in yes], edgecolor=tint, linewidth=0.7, zorder=3)
        if curve.fit is not None:
            name = "pss" if condition.pair else "threshold75"
            axes.axhspan(*np.clip(curve.intervals[name], *finite(levels)), color="#eeeeee", zorder=0)
            axes.plot(*running(curve, levels, yes, name), color=INK, linewidth=1)
        axes.set_title(label_of(curve.participant, curves), fontsize=7.5)
        axes.tick_params(labelsize=7)
    for axes in grid.flat[len(people):]:
        axes.set_visible(False)
    fig.supxlabel("answer", fontsize=8)
    fig.supylabel(people[0].condition.axis().replace(" = t", "\n= t") if columns < 3 or rows < 2 else people[0].condition.axis(), fontsize=8)
    stamp(fig, " and ".join(sorted({person.observer for person in people})))
    return fig
