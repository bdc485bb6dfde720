"""Scenes that are larger than memory, band by band: whole rows of cells with all that reaches the discs in them.

Every disc belongs to the band of its centre. Its arcs depend on the discs that share a cell with it only, so that the
band's window, wider by the largest disc on both sides, decides them alone: no seam has to be joined, and arcs and
counts are those of the whole.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from molviz.arrays import Bools, Ints
from molviz.discs.arcs import Work, arcs_on_lists
from molviz.discs.grid import MARGIN, Grid, cell_lists
from molviz.geometry.circles import CircleArcs
from molviz.model.spheres import Spheres

BAND_DISCS = 1 << 21  # that belong to a band: some 300 bytes each


Found: TypeAlias = tuple[CircleArcs, Work]
Each: TypeAlias = Callable[[Callable[["Band"], Found], Iterable["Band"]], Iterable[Found]]


class Band(NamedTuple):
    """Some discs of a scene, in its order, that decide the arcs of a band's own; and the rows that are its own."""

    spheres: Spheres  # (m,)
    disc: Ints  # (m,) rows of the scene
    own: Bools  # (m,)
    grid: Grid  # the window
    rows: range  # of cells


def visible_perimeters(spheres: Spheres, grid: Grid, each: Each = map) -> tuple[CircleArcs, Work]:
    """Return the visible arcs of n ≥ 1 discs' perimeters, ordered by disc, and the work it took.

    ``each`` does the bands in turn, as ``map`` does, or has others do them. An arc's ``before`` and ``after`` are the
    discs that hide the perimeter beyond its ends; angles run counter-clockwise from the x axis.
    """
    columns: list[list[Any]] = [[] for _ in CircleArcs._fields]
    works = []
    for arcs, work in each(arcs_of_band, bands(spheres, grid)):
        works.append(work)
        for column, part in zip(columns, arcs, strict=True):
            column.append(part)
    order = np.argsort(np.concatenate(columns[0]), kind="stable") if len(works) > 1 else None
    return CircleArcs(*(_joined(column, order) for column in columns)), Work(*map(sum, zip(*works, strict=True)))


def bands(spheres: Spheres, grid: Grid) -> Iterator[Band]:
    """Return the bands of a scene; one for all where the discs are few."""
    count = len(spheres.radius)
    if count <= BAND_DISCS:
        yield Band(spheres, np.arange(count), np.ones(count, dtype=bool), grid, grid.rows)
        return
    row = grid.row_at(spheres.center[:, 1]).astype(np.int32)
    until = np.cumsum(np.bincount(row, minlength=grid.across))
    cuts = np.searchsorted(until, np.arange(BAND_DISCS, count, BAND_DISCS)) + 1
    edges = np.unique([0, *cuts.tolist(), grid.across]).tolist()
    margin = math.ceil(float(spheres.radius.max()) / grid.cell + MARGIN) + 1
    for bottom, top in zip(edges, edges[1:], strict=False):
        disc = np.flatnonzero((row >= bottom - 2 * margin) & (row < top + 2 * margin))
        own = (row[disc] >= bottom) & (row[disc] < top)
        window = grid._replace(bottom=max(bottom - margin, 0), top=min(top + margin, grid.across))
        yield Band(spheres.take(disc), disc, own, window, range(bottom, top))


def arcs_of_band(band: Band) -> Found:
    """Return the visible arcs of a band's own discs, with the rows of the scene, and the work of its own cells."""
    lists = cell_lists(band.spheres, band.grid)
    first = (band.rows.start - band.grid.bottom) * band.grid.across
    cells = slice(first, first + len(band.rows) * band.grid.across)
    arcs, work = arcs_on_lists(band.spheres, band.grid, lists, band.own, cells)
    disc = np.append(band.disc, -1)  # row −1 stays −1
    return arcs._replace(circle=disc[arcs.circle], before=disc[arcs.before], after=disc[arcs.after]), work


def _joined(parts: list[Any], order: Ints | None) -> Any:
    """One column of all bands in that order; the parts are given up, as both together may not fit into memory."""
    column = np.concatenate(parts)
    parts.clear()
    return column if order is None else column.take(order)
