"""Two senses degraded together: performance at each pair of levels, and the levels at which it reaches the margin.

The frontier: for each level of the first factor, the level of the second at which success or time is worse than undegraded by the margin. A
frontier that falls with a rising first level shows that the senses compensate for each other only in part; a constant one shows that they are
independent.
"""
import dataclasses

import numpy as np

from tactus.analysis import limits
from tactus.analysis.crossing import crossing


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


def frontier(cells, first, second, margins, observer):
    together = {(d[0][1], d[1][1]): cell for d, cell in cells.items() if len(d) == 2 and (d[0][0], d[1][0]) == (first, second)}
    single = lambda factor, level: cells.get(((factor, level),) if level is not None else ())
    levels = [sorted({pair[i] for pair in together}, key=factor.severity) for i, factor in enumerate((first, second))]
    at = lambda a, b: together.get((a, b)) if a is not None and b is not None else single(first, a) if b is None else single(second, b)
    rows = [[at(a, b) for b in [None, *levels[1]]] for a in [None, *levels[0]]]
    baseline = cells[()]
    edge = [(0.0 if a is None else a, limit) for a, row in zip([None, *levels[0]], rows)
            for limit in [edge_of(row, baseline, second, levels[1], margins, observer)] if limit]
    return Frontier(first, second, [0.0, *levels[0]], [0.0, *levels[1]], rows, edge)


def edge_of(row, baseline, second, levels, margins, observer):
    """L_break of the second factor along one row of the grid; None: too few cells of the row were played."""
    played = [(second.severity(level), cell) for level, cell in zip(levels, row[1:]) if cell is not None]
    if row[0] is None or not played:
        return None
    severities = np.array([s for s, _ in played])
    weights = np.array([cell.n for _, cell in played], dtype=float)

    def first_reached(of, of_baseline):
        """of: [(B, 2)] of the cells; the first is the one without the second factor."""
        found = []
        for worsening, margin in (([of_baseline[:, 0] - d[:, 0] for d in of], margins[0]), ([d[:, 1] / of_baseline[:, 1] - 1 for d in of], margins[1] - 1)):
            found.append(crossing(severities, np.stack(worsening[1:]), weights, margin, worsening[0]))
        return np.minimum(*found)

    mean = lambda cell: np.array([[cell.share, cell.mean_time_s]])
    mine = [row[0], *(cell for _, cell in played)]
    whole = ~np.isnan(np.stack([c.draws[:, 0] for c in [*mine, baseline]])).any(axis=0)
    point = first_reached([mean(c) for c in mine], mean(baseline))[0]
    draws = first_reached([c.draws[whole] for c in mine], baseline.draws[whole])
    return limits.from_draws("break", second, limits.EITHER, point, draws, float(severities.max()), observer, int(weights.sum()))
