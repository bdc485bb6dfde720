"""The order in which a pen draws strokes: always on to the nearest end of a stroke that is left."""

import math
from collections.abc import Iterator

import numpy as np

from molviz.arrays import Floats

ENDS_PER_CELL = 2.0
TINY = 1e-9  # the side of a cell where all ends coincide


def drawing_order(begin: Floats, end: Floats) -> Iterator[tuple[int, bool]]:
    """Yield every stroke once, and whether it is drawn from its end, starting from the origin.

    Greedy: each step goes to the nearest begin or end (n, 2) that is left. Ends are kept in a grid that is made
    anew, coarser, whenever half the strokes are drawn, so that time stays near linear in n.
    """
    ends = np.concatenate([begin, end])
    left = set(range(len(begin)))
    pen = (0.0, 0.0)
    renew_at = len(left)
    while left:
        if len(left) <= renew_at:
            grid, renew_at = _EndGrid(ends, left), len(left) // 2
        chosen = grid.nearest(pen)
        stroke, reverse = chosen % len(begin), chosen >= len(begin)
        left.remove(stroke)
        grid.remove(stroke)
        yield stroke, reverse
        pen = grid.place[stroke if reverse else stroke + len(begin)]


class _EndGrid:
    """The ends of the strokes that are left, by cell of a square grid."""

    def __init__(self, ends: Floats, left: set[int]) -> None:
        strokes = np.sort(np.fromiter(left, dtype=np.int64, count=len(left)))
        self.count = len(ends) // 2
        rows = np.concatenate([strokes, strokes + self.count])
        extent = float(np.max(np.ptp(ends[rows], axis=0)))
        self.side = max(extent / math.sqrt(len(rows) / ENDS_PER_CELL), TINY)
        self.low = (float(ends[rows, 0].min()), float(ends[rows, 1].min()))
        self.across = int(extent / self.side)
        self.place = {row: (x, y) for row, (x, y) in zip(rows.tolist(), ends[rows].tolist(), strict=True)}
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
        while ring <= self.across + 1 and (ring - 1) * self.side < best:
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
