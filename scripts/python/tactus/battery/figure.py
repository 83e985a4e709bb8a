"""A figure of the limits of one operator: for each task and sense the median over the players and the range from 10 to 90 %."""
from tactus import palette
from tactus.battery import answers, conditions, limits

MARK = {answers.NAIVE: ("o", palette.LIMIT["break"]), answers.ADAPTED: ("s", palette.BLUE), "detected": ("|", palette.BLACK)}
OUTSIDE = 1.6  # factor beyond the outermost level at which limits outside the levels are drawn


def place(limit, levels):
    """The coordinate of a limit, with those outside the levels beyond their ends."""
    if limit == limits.BELOW:
        return levels[0] / OUTSIDE if levels[-1] > levels[0] else levels[0] * OUTSIDE
    if limit == limits.ABOVE:
        return levels[-1] * OUTSIDE if levels[-1] > levels[0] else levels[-1] / OUTSIDE
    return limit


def draw(found, operator, path):
    """Writes an SVG or PNG of the curves.Curve of an operator."""
    from tactus.plotting import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    matplotlib.rcParams.update({"svg.hashsalt": "tactus", "font.family": "DejaVu Sans", "font.size": 8.5, "legend.frameon": False, "axes.spines.top": False, "axes.spines.right": False})
    mine = [curve for curve in found if curve.operator == operator]
    fig, axes = pyplot.subplots(figsize=(7.2, 0.8 + 0.42 * len(mine)), constrained_layout=True)
    for row, curve in enumerate(reversed(mine)):
        for offset, (name, each) in zip((0.2, 0, -0.2), ((answers.NAIVE, curve.limits(answers.NAIVE)), (answers.ADAPTED, curve.limits(answers.ADAPTED)), ("detected", curve.thresholds()))):
            if each is None:
                continue
            q10, median, q90 = (place(limits.at_quantile(each, curve.levels, share), curve.levels) for share in (0.1, 0.5, 0.9))
            mark, colour = MARK[name]
            axes.plot((q10, q90), (row + offset, row + offset), color=colour, linewidth=1.4)
            axes.plot(median, row + offset, mark, color=colour, markersize=5 if mark != "|" else 9, label=name if row == 0 else None)
    levels = max((curve.levels for curve in mine), key=len)
    axes.set_xscale("log")
    axes.set_xticks([place(limits.BELOW, levels), *levels, place(limits.ABOVE, levels)])
    ordered = [f"below {levels[0]:g}", *(f"{level:g}" for level in levels), "not reached"] if levels[-1] > levels[0] else [f"above {levels[0]:g}", *(f"{level:g}" for level in levels), "not reached"]
    axes.set_xticklabels(ordered, fontsize=7)
    axes.minorticks_off()
    if levels[-1] < levels[0]:
        axes.invert_xaxis()
    axes.set_yticks(range(len(mine)))
    axes.set_yticklabels([f"{curve.task.replace('_', ' ')}, {curve.sense}" for curve in reversed(mine)])
    axes.set_xlabel(f"{operator}, {conditions.unit(operator)}: limit of {len(mine[0].undegraded)} simulated players, median and 10 to 90 %")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8)
    fig.savefig(path, metadata={"Date": None} if str(path).endswith(".svg") else None)
    pyplot.close(fig)
