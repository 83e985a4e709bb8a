"""Two senses degraded together: performance at each pair of levels, and the levels at which it reaches the margin.

The frontier: for each level of the first factor, the level of the second at which success or time is worse than undegraded by the margin. A
frontier that falls with a rising first level shows that the senses compensate for each other only in part; a constant one shows that they are
independent.
"""
import dataclasses

import numpy as np

from tactus.analysis import break_limits, limits, monotone_fit


@dataclasses.dataclass
class Frontier:
    """first, second: Factor; levels with 0 as undegraded; cells: [i][j] Cell or None; edge: [(level of first, Limit of second)]."""
    first: object
    second: object
    first_levels: list
    second_levels: list
    cells: list
    edge: list

    def grid(self, of_cell):
        """(i, j) array of of_cell(cell), NaN for a pair that was not played."""
        return np.array([[np.nan if cell is None else of_cell(cell) for cell in row] for row in self.cells])


def pairs_of(cells):
    """Pairs of factors that were played together, without removals."""
    return sorted({(d[0][0], d[1][0]) for d in cells if len(d) == 2 and not d[0][0].removal and not d[1][0].removal})


def frontier(cells, first, second, clustered, margins, observer, rng):
    together = {(d[0][1], d[1][1]): cell for d, cell in cells.items() if len(d) == 2 and (d[0][0], d[1][0]) == (first, second)}
    single = lambda factor, level: cells.get(((factor, level),) if level is not None else ())
    levels = [sorted({pair[i] for pair in together}, key=factor.severity) for i, factor in enumerate((first, second))]
    at = lambda a, b: together.get((a, b)) if a is not None and b is not None else single(first, a) if b is None else single(second, b)
    rows = [[at(a, b) for b in [None, *levels[1]]] for a in [None, *levels[0]]]
    baseline = cells[()]
    edge = [(0.0 if a is None else a, limit) for a, row in zip([None, *levels[0]], rows)
            for limit in [edge_of(row, baseline, second, levels[1], clustered, margins, observer, rng)] if limit]
    return Frontier(first, second, [0.0, *levels[0]], [0.0, *levels[1]], rows, edge)


def edge_of(row, baseline, second, levels, clustered, margins, observer, rng):
    """L_break of the second factor along one row of the grid, by success or by time; None: too few cells of the row were played."""
    played = [(second.severity(level), cell) for level, cell in zip(levels, row[1:]) if cell is not None]
    if row[0] is None or not played:
        return None
    cells, drawn = [(0.0, row[0]), *played], np.full(monotone_fit.DRAWS, np.nan)
    reference = None if row[0] is baseline else baseline
    for outcome in ("success", "time"):
        kept = [(s, c) for s, c in cells if outcome == "success" or c.times.identified]
        if len(kept) < 2 or kept[0][0] or (outcome == "time" and not baseline.times.identified):
            continue
        worse = break_limits.worsening([c for _, c in kept], np.array([s for s, _ in kept]), clustered, rng, outcome, reference)
        drawn = np.fmin(drawn, break_limits.crossing_of(worse, margins, outcome))
    return limits.from_draws("break", second, limits.EITHER, limits.middle(drawn), drawn, max(s for s, _ in played), observer, sum(c.n for _, c in played))
