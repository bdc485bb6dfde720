"""The order in which a pen draws strokes: always on to the nearest end of a stroke that is left."""

import math
from collections.abc import Iterator

import numpy as np

from molviz.arrays import Floats

ENDS_PER_CELL = 2.0


def drawing_order(begin: Floats, end: Floats) -> Iterator[tuple[int, bool]]:
    """Yield every stroke once, and whether it is drawn from its end, starting from the origin.

    Greedy: each step goes to the nearest begin or end (n, 2) that is left. Ends are kept in a grid that is made
    anew, coarser, whenever half the strokes are drawn, so that time stays near linear in n.
    """
    ends = np.concatenate([begin, end])
    left = set(range(len(begin)))
    pen = (0.0, 0.0)
    grid = _EndGrid(ends, left)
    size = len(left)
    while left:
        if len(left) < size // 2:
            grid, size = _EndGrid(ends, left), len(left)
        found = grid.nearest(pen)
        stroke, reverse = found % len(begin), found >= len(begin)
        left.remove(stroke)
        grid.remove(stroke)
        yield stroke, reverse
        pen = grid.place[stroke if reverse else stroke + len(begin)]


class _EndGrid:
    """The ends of the strokes that are left, by cell of a square grid."""

    def __init__(self, ends: Floats, left: set[int]) -> None:
        count = len(ends) // 2
        rows = np.fromiter(left, dtype=np.int64, count=len(left))
        rows.sort()
        rows = np.concatenate([rows, rows + count])
        extent = float(np.max(np.ptp(ends, axis=0))) if len(ends) else 0.0
        self.side = max(extent / math.sqrt(max(len(rows), 1) / ENDS_PER_CELL), 1e-9)
        self.low: tuple[float, float] = tuple(ends.min(axis=0).tolist()) if len(ends) else (0.0, 0.0)
        self.across = int(extent / self.side) + 1
        self.place: dict[int, tuple[float, float]] = dict(zip(rows.tolist(), map(tuple, ends[rows].tolist()), strict=True))
        self.count = count
        self.cells: dict[tuple[int, int], list[int]] = {}
        for row, place in self.place.items():
            self.cells.setdefault(self._cell(place), []).append(row)

    def _cell(self, place: tuple[float, float]) -> tuple[int, int]:
        return int((place[0] - self.low[0]) // self.side), int((place[1] - self.low[1]) // self.side)

    def remove(self, stroke: int) -> None:
        for row in (stroke, stroke + self.count):
            self.cells[self._cell(self.place[row])].remove(row)

    def nearest(self, pen: tuple[float, float]) -> int:
        """The end nearest to the pen; of equally near ones the lowest row."""
        best, best_row, ring = math.inf, -1, 0
        middle = self._clamped(self._cell(pen))
        while best_row < 0 or (ring - 1) * self.side < best:
            for cell in _ring(middle, ring):
                for row in self.cells.get(cell, ()):
                    gap = math.dist(pen, self.place[row])
                    if (gap, row) < (best, best_row):
                        best, best_row = gap, row
            ring += 1
        return best_row

    def _clamped(self, cell: tuple[int, int]) -> tuple[int, int]:
        return min(max(cell[0], 0), self.across), min(max(cell[1], 0), self.across)


def _ring(middle: tuple[int, int], ring: int) -> Iterator[tuple[int, int]]:
    """The cells at a distance of ``ring`` cells from the middle one."""
    x, y = middle
    if ring == 0:
        yield middle
        return
    for step in range(-ring, ring + 1):
        yield x + step, y - ring
        yield x + step, y + ring
    for step in range(1 - ring, ring):
        yield x - ring, y + step
        yield x + ring, y + step
