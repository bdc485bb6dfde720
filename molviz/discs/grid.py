"""The grid of Franklin's SPHERES (1980): which discs matter in which cell, and which cells are blocked.

A disc that covers a cell entirely blocks everything behind it there; what is left on a cell's list are the discs
whose perimeter may pass through it in front of the nearest blocking one. The grid is scaffolding: the visible arcs
do not depend on it. Nothing is sorted by depth; of discs with equal z the one with the lower row is nearer.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.rows import expand, offsets
from molviz.model.spheres import Spheres
from molviz.threads import in_threads

MARGIN = 1e-9  # of a cell: what rounding may do to a coordinate counted in cells, on grids up to 10⁵ × 10⁵
HALF_DIAGONAL = math.sqrt(0.5)
STRIP_CELLS = 1 << 15  # cells worked on at a time: few enough that a cell's number within them fits 16 bits
CELLS_PER_DISC = 8  # bounds the grid of discs strewn so thinly that the formula would leave nearly all cells empty
NOBODY = np.iinfo(np.int64).max


class Square(NamedTuple):
    """The part of the plane that the grid covers; every disc lies within it."""

    x: float
    y: float
    side: float


UNIT_SQUARE = Square(0.0, 0.0, 1.0)


class Grid(NamedTuple):
    """``across`` × ``across`` cells over a square, or the window of its rows ``bottom`` … ``top`` − 1.

    Cell number = row × across + column, from the lower left of the window.
    """

    square: Square
    across: int
    bottom: int = 0
    top: int | None = None  # all rows from the bottom

    @property
    def cell(self) -> float:
        """The side of a cell."""
        return self.square.side / self.across

    @property
    def rows(self) -> range:
        """The rows of the window."""
        return range(self.bottom, self.across if self.top is None else self.top)

    def row_at(self, y: Floats) -> Floats:
        """Return the number of the row that each point lies in, the nearest row of the window for points outside."""
        row = np.floor((y - self.square.y) / self.cell)
        return np.clip(row, self.rows.start, self.rows.stop - 1, out=row)

    def cell_at(self, x: Floats, y: Floats) -> Ints:
        """Return the number of the cell that each point lies in, the nearest cell of the window for points outside."""
        column = np.clip(np.floor((x - self.square.x) / self.cell), 0, self.across - 1)
        cell: Ints = ((self.row_at(y) - self.bottom) * self.across + column).astype(np.int64)
        return cell


class CellLists(NamedTuple):
    """For every cell its nearest blocking disc (``NOBODY`` for none) and ``item[start[c] : start[c + 1]]``."""

    blocker: Ints  # (cells,)
    start: Ints  # (cells + 1,)
    item: Ints  # (m,)


class _Rows(NamedTuple):
    """Discs in rows of cells: columns low … high − 1 may meet the disc, inner_low … inner_high − 1 lie inside."""

    disc: Ints
    row: Ints
    low: Ints
    inner_low: Ints
    inner_high: Ints
    high: Ints


def by_depth(spheres: Spheres) -> Spheres:
    """Return spheres in view coordinates, whose larger z is nearer, as discs, whose larger z is farther."""
    return Spheres(spheres.center * [1.0, 1.0, -1.0], spheres.radius)


def bounding_square(spheres: Spheres) -> Square:
    """Return the smallest square around all discs, from their lower left corner."""
    low, high = spheres.box()
    return Square(float(low[0]), float(low[1]), float(np.max((high - low)[:2])))


def on_perimeter(spheres: Spheres, disc: Ints, angle: Floats) -> tuple[Floats, Floats]:
    """Return x and y of the points of discs' perimeters at the given angles."""
    x = spheres.center[disc, 0] + spheres.radius[disc] * np.cos(angle)
    y = spheres.center[disc, 1] + spheres.radius[disc] * np.sin(angle)
    return x, y


def depth_complexity(radius: Floats, square: Square) -> float:
    """Return D = π Σ r² / area, the average number of discs over a point of the square."""
    return math.pi * float(np.sum((radius / square.side) ** 2))


def franklin_count(radius: Floats, square: Square) -> int:
    """Return the G of the paper's formula (section 5, step 2) for the root mean square radius.

    L = R (5.3 − 0.375 ln D) if D ≤ 2.4, else R (0.6 − 0.078 ln D); never fewer than one cell, never many times more
    cells than discs. The formula is his to D = 31 and is held at L = R / 10 where its logarithm would cross zero.
    """
    depth = depth_complexity(radius, square)
    size = math.sqrt(float(np.mean(radius**2)))
    share = 5.3 - 0.375 * math.log(depth) if depth <= 2.4 else max(0.6 - 0.078 * math.log(depth), 0.1)
    most = math.ceil(math.sqrt(CELLS_PER_DISC * len(radius)))
    return max(1, min(math.floor(square.side / (share * size)), most))


def nearer(spheres: Spheres, one: Ints, other: Ints) -> Bools:
    """Tell whether disc ``one`` lies in front of disc ``other``: smaller z, and of equal z the lower row."""
    z = spheres.center[:, 2]
    return np.asarray((z[one] < z[other]) | ((z[one] == z[other]) & (one < other)))


def cell_lists(spheres: Spheres, grid: Grid) -> CellLists:
    """Return the blocking disc and the list of every cell, in time linear in the discs' size counted in cells."""
    strips = in_threads(lambda strip: _strip(spheres, grid, *strip), _strips(spheres, grid))
    blocker, length, item = (np.concatenate(column) for column in zip(*strips, strict=True))
    return CellLists(blocker, np.concatenate([[0], np.cumsum(length)]), item)


def _strips(spheres: Spheres, grid: Grid) -> Iterator[tuple[int, int, Ints]]:
    """Cut the window into strips of whole rows; yield first row, row after the last, and the discs that reach it."""
    tall = max(1, STRIP_CELLS // grid.across)
    strips = -(-len(grid.rows) // tall)
    y, reach = (spheres.center[:, 1] - grid.square.y) / grid.cell - grid.bottom, spheres.radius / grid.cell + MARGIN
    first, last = (_clipped(np.floor(edge), len(grid.rows)) // tall for edge in (y - reach, y + reach))
    disc, strip = expand(first, last + 1)
    by_strip = np.argsort(strip.astype(np.uint16), kind="stable")
    start = offsets(strip, strips)
    for number in range(strips):
        reaching = disc[by_strip[start[number] : start[number + 1]]]
        bottom = grid.bottom + number * tall
        yield bottom, min(bottom + tall, grid.rows.stop), reaching


def _strip(spheres: Spheres, grid: Grid, bottom: int, top: int, disc: Ints) -> tuple[Ints, Ints, Ints]:
    """The blockers, list lengths and lists of the cells in rows bottom … top − 1."""
    rows = _spans(spheres, grid, bottom, top, disc)
    first_cell = (rows.row - bottom) * grid.across
    z = spheres.center[:, 2]
    cells = (top - bottom) * grid.across

    owner, cell = expand(first_cell + rows.inner_low, first_cell + rows.inner_high)
    blocker_z, blocker = foremost(z, rows.disc[owner], cell, cells)

    left, right = (
        expand(first_cell + rows.low, first_cell + rows.inner_low),
        expand(first_cell + rows.inner_high, first_cell + rows.high),
    )
    item = rows.disc[np.concatenate([left[0], right[0]])]
    cell = np.concatenate([left[1], right[1]])
    seen = np.flatnonzero(z[item] <= blocker_z[cell])
    item, cell = item[seen], cell[seen]
    seen = np.flatnonzero((z[item] < blocker_z[cell]) | (item < blocker[cell]))
    item, cell = item[seen], cell[seen]
    by_cell = np.argsort(cell.astype(np.uint32), kind="stable")
    return blocker, np.bincount(cell, minlength=cells), item[by_cell]


def _spans(spheres: Spheres, grid: Grid, bottom: int, top: int, disc: Ints) -> _Rows:
    """The columns of every row that a disc reaches, tested as in the paper (section 5, step 3b).

    A cell lies inside if its four corners do. It lies outside if it is outside the rectangle of cells around the
    disc, or its centre is R + L/√2 or more away; the corners are then outside too. Every other cell probably meets
    the perimeter; a few false positives only cost time.
    """
    x, y = ((spheres.center[disc, axis] - grid.square[axis]) / grid.cell for axis in (0, 1))
    radius = spheres.radius[disc] / grid.cell
    first, last = (_clipped(np.floor(edge), grid.across) for edge in (y - radius - MARGIN, y + radius + MARGIN))
    owner, row = expand(np.maximum(first, bottom), np.minimum(last + 1, top))
    x, y, radius = x[owner], y[owner] - row, radius[owner]

    half_inner = _half_chord(radius - MARGIN, np.maximum(np.abs(y), np.abs(y - 1.0)))
    half_outer = _half_chord(radius + HALF_DIAGONAL + MARGIN, y - 0.5)
    reach = np.minimum(radius + MARGIN, half_outer - 0.5)  # of the rectangle, and of centres within half_outer
    low = _clipped(np.floor(x - reach), grid.across)
    high = _clipped(np.floor(x + reach), grid.across) + 1
    inner_low = np.clip(np.ceil(x - half_inner).astype(np.int64), low, high)
    inner_high = np.clip(np.floor(x + half_inner).astype(np.int64), inner_low, high)
    return _Rows(disc[owner], row, low, inner_low, inner_high, high)


def _half_chord(radius: Floats, height: Floats) -> Floats:
    """√(r² − h²), and 0 where the line passes outside the circle."""
    return np.asarray(np.sqrt(np.maximum(radius * np.abs(radius) - height**2, 0.0)))


def _clipped(number: Floats, count: int) -> Ints:
    return np.clip(number, 0, count - 1).astype(np.int64)


def foremost(z: Floats, disc: Ints, place: Ints, places: int) -> tuple[Floats, Ints]:
    """Return the smallest z of the discs named for each place, ∞ for none, and the lowest row that has it."""
    smallest = np.full(places, np.inf)
    np.minimum.at(smallest, place, z[disc])
    equal = np.flatnonzero(z[disc] == smallest[place])
    lowest = np.full(places, NOBODY)
    np.minimum.at(lowest, place[equal], disc[equal])
    return smallest, lowest
