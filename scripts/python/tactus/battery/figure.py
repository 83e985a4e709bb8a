"""A figure of the limits of one operator: for each task and sense the median over the players and the range from 10 to 90 %."""
from tactus import palette
from tactus.battery import answers, conditions, limits

MARK = {answers.NAIVE: ("o", palette.LIMIT["break"]), answers.ADAPTED: ("s", palette.BLUE), "detected": ("|", palette.BLACK)}
END = {limits.BELOW: "<", limits.ABOVE: ">"}  # marks of limits outside the levels, which are drawn at the outermost level


def place(limit, levels):
    """The coordinate of a limit: of one outside the levels, that of the outermost level."""
    return {limits.BELOW: levels[0], limits.ABOVE: levels[-1]}.get(limit, limit)


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
            q10, median, q90 = (limits.at_quantile(each, curve.levels, share) for share in (0.1, 0.5, 0.9))
            mark, colour = MARK[name]
            axes.plot([place(limit, curve.levels) for limit in (q10, q90)], (row + offset, row + offset), color=colour, linewidth=1.4)
            axes.plot(place(median, curve.levels), row + offset, END.get(median, mark), color=colour, markersize=9 if mark == "|" and median not in END else 5, markerfacecolor="white" if median in END else colour)
    for name, (mark, colour) in MARK.items():
        axes.plot([], [], mark, color=colour, markersize=9 if mark == "|" else 5, label=name)
    axes.plot([], [], END[limits.ABOVE], color=palette.GREY, markerfacecolor="white", markersize=5, label="not reached")
    axes.plot([], [], END[limits.BELOW], color=palette.GREY, markerfacecolor="white", markersize=5, label="below the levels")
    levels = max((curve.levels for curve in mine), key=len)
    axes.set_xscale("log")
    axes.set_xticks(levels)
    axes.set_xticklabels([f"{level:g}" for level in levels])
    axes.minorticks_off()
    if levels[-1] < levels[0]:
        axes.invert_xaxis()
    axes.set_yticks(range(len(mine)))
    axes.set_yticklabels([f"{curve.task.replace('_', ' ')}, {curve.sense}" for curve in reversed(mine)])
    axes.set_xlabel(f"{operator}, {conditions.unit(operator)}: limit of {len(mine[0].undegraded)} simulated players, median and 10 to 90 %")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8)
    fig.savefig(path, metadata={"Date": None} if str(path).endswith(".svg") else None)
    pyplot.close(fig)
