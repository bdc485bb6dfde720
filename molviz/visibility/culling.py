"""Spheres that nobody can see, found before they cost anything (Franklin 1980, blocking cells).

The page is cut into square cells. Where a sphere covers a whole cell, everything farther away there is hidden; a
sphere is dropped when every cell it touches is blocked in front of it. No sphere that shows is ever dropped.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.rows import blocks, expand, lists_taken
from molviz.threads import in_threads
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.projection import Projection, images_of

MOST_CELLS = 2048  # per axis
BLOCK_ROWS = 1 << 15  # (sphere, cell) rows at a time: their columns stay in cache
GROUP = 32  # blocks at a time
CLUSTER = 16  # cells: some hundreds of atoms


class _Cells(NamedTuple):
    """The cells each sphere's bounding box touches: columns and rows from ``low`` to ``high``, inclusive."""

    origin: Floats  # (2,)
    side: float
    wide: int
    low: Ints  # (n, 2)
    high: Ints  # (n, 2)


class _Clusters(NamedTuple):
    """Spheres that lie together, the nearest clusters first."""

    sphere: Ints  # (n,) by cluster
    start: Ints  # (c + 1,) CSR offsets
    nearest: Floats  # (c,) how near the nearest point of any sphere is
    cells: _Cells  # (c,) that the bounding boxes touch


def possibly_visible(spheres: SphereOccluders, projection: Projection) -> Bools:
    """Return which of n spheres may be seen (n,), in time linear in n for atoms.

    The nearest come first: most clusters of spheres are hidden by what covers the page before them, and none of their
    spheres is looked at. What is left is asked again when all is known. No list of all spheres' cells is ever made.
    """
    cells = _cells(spheres, projection)
    clusters = _clusters(spheres, cells)
    cover = np.full((int(cells.high[:, 1].max()) + 1) * cells.wide, -np.inf)  # how near each cell is covered
    left: list[Ints] = []
    for group in _groups(cells, clusters, cover):
        for shown, cell, least in in_threads(lambda rows: _bounds(spheres, cells, rows, cover), group):
            left.append(shown)
            np.maximum.at(cover, cell, least)
    rows = np.concatenate(left)
    again = in_threads(lambda block: _bounds(spheres, cells, rows[block], cover)[0], _blocks(cells, rows))
    visible: Bools = np.zeros(len(cells.low), dtype=bool)
    visible[np.concatenate(again)] = True
    return visible


def _clusters(spheres: SphereOccluders, cells: _Cells) -> _Clusters:
    """The spheres with centres in one cube of space, ``CLUSTER`` cells wide, as a cluster."""
    center = spheres.spheres.center
    cube = np.floor((center - center.min(axis=0)) / (CLUSTER * cells.side)).astype(np.int64)
    wide = cube.max(axis=0) + 1
    key = (cube[:, 2] * wide[1] + cube[:, 1]) * wide[0] + cube[:, 0]
    order = np.argsort(key, kind="stable")
    start = np.flatnonzero(np.diff(key[order], prepend=-1))
    nearest = np.maximum.reduceat(spheres.nearest_points()[order], start)
    first = np.argsort(-nearest)
    low, high = np.minimum.reduceat(cells.low[order], start), np.maximum.reduceat(cells.high[order], start)
    place, offset = lists_taken(np.append(start, len(order)), first)
    return _Clusters(order[place], offset, nearest[first], cells._replace(low=low[first], high=high[first]))


def _groups(cells: _Cells, clusters: _Clusters, cover: Floats) -> Iterator[list[Ints]]:
    """The spheres of clusters that show, in groups of blocks that know of each other's cover only when all are done."""
    number = np.cumsum(np.append(0, _cell_counts(cells, clusters.sphere)))[clusters.start]
    for batch in blocks(np.diff(number), GROUP * BLOCK_ROWS):
        shown = _clusters_shown(clusters, np.arange(batch.start, batch.stop), cover)
        rows = clusters.sphere[lists_taken(clusters.start, shown)[0]]
        yield [rows[block] for block in _blocks(cells, rows)]


def _clusters_shown(clusters: _Clusters, rows: Ints, cover: Floats) -> Ints:
    """Those of the given clusters of which anything may lie before the cover of some cell."""

    def shown_in(block: slice) -> Ints:
        number, cell, _ = _rows(clusters.cells, rows[block])
        shows = np.repeat(clusters.nearest[rows[block]], number) > cover[cell]
        return rows[block][np.logical_or.reduceat(shows, np.cumsum(number) - number)]

    return np.concatenate(in_threads(shown_in, _blocks(clusters.cells, rows)))


def _bounds(spheres: SphereOccluders, cells: _Cells, rows: Ints, cover: Floats) -> tuple[Ints, Ints, Floats]:
    """Which of the given spheres show in one of their cells, and the cells that they cover nearer, and how near."""
    number, cell, low = _rows(cells, rows)
    least, most = spheres.surface_bounds(np.repeat(rows, number), low, cells.side)
    known = cover[cell]
    nearer = np.flatnonzero(least > known)
    shows = np.maximum.reduceat(most > known, np.cumsum(number) - number)
    return rows[shows], cell[nearer], least[nearer]


def _cells(spheres: SphereOccluders, projection: Projection) -> _Cells:
    """A grid by Franklin's formula for deep scenes, ``L = R (0.6 − 0.078 ln D)`` with depth D."""
    center, half = outlines(spheres, projection)
    low, high = (center - half).min(axis=0), (center + half).max(axis=0)
    radius = float(np.partition(half.ravel(), half.size // 2)[half.size // 2])  # np.median loads masked arrays
    depth = 4 * np.sum(half[:, 0] * half[:, 1]) / max(float(np.prod(high - low)), np.finfo(float).tiny)
    factor = float(np.clip(0.6 - 0.078 * np.log(max(depth, 1.0)), 0.2, 0.6))
    side = max(radius * factor, (high - low).max() / MOST_CELLS)
    first = np.floor((center - half - low) / side).astype(np.int64)
    last = np.floor((center + half - low) / side).astype(np.int64)
    return _Cells(low, side, int(last.max()) + 1, first, last)


def outlines(spheres: SphereOccluders, projection: Projection) -> tuple[Floats, Floats]:
    """Return centre and half-extent (n, 2) of the bounding box of each sphere's image."""
    if projection.keeps_circles:
        center, radius = spheres.spheres
        return center[:, :2], np.stack([radius, radius], axis=1)
    images = images_of(spheres.horizons(), projection)
    return images.c, images.half_extent()


def _blocks(cells: _Cells, rows: Ints) -> Iterator[slice]:
    """Spheres whose bounding boxes touch about as many cells together."""
    return blocks(_cell_counts(cells, rows), BLOCK_ROWS)


def _cell_counts(cells: _Cells, rows: Ints) -> Ints:
    return np.asarray(np.prod(cells.high[rows] - cells.low[rows] + 1, axis=1))


def _rows(cells: _Cells, rows: Ints) -> tuple[Ints, Ints, Floats]:
    """How many cells the bounding box of each sphere touches, and all of them, with their lower left corners."""
    low = cells.low.take(rows, axis=0)
    width, height = (cells.high.take(rows, axis=0) - low + 1).T
    sphere, place = expand(np.zeros_like(width), width * height)
    row, column = np.divmod(place, width[sphere])
    x, y = low[sphere, 0] + column, low[sphere, 1] + row
    return width * height, y * cells.wide + x, cells.origin + np.stack([x, y], axis=1) * cells.side
