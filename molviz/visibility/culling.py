"""Spheres that nobody can see, found before they cost anything (Franklin 1980, blocking cells).

The page is cut into square cells. Where a sphere covers a whole cell, everything farther away there is hidden; a
sphere is dropped when every cell it touches is blocked in front of it. No sphere that shows is ever dropped.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.geometry.rows import blocks, expand, lists_taken
from molviz.threads import in_threads
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.projection import Projection, images_of

MOST_CELLS = 2048  # per axis
BLOCK_ROWS = 1 << 15  # (sphere, cell) rows at a time: their columns stay in cache
GROUP = 32  # blocks at a time
CLUSTER = 16  # cells: from a dozen atoms of a virus to hundreds of a small protein

Part: TypeAlias = Callable[[], SphereOccluders]


class _Page(NamedTuple):
    """The grid of cells."""

    origin: Floats  # (2,)
    side: float
    wide: int
    tall: int


class _Outline(NamedTuple):
    """What of a part is known before its spheres are made again."""

    low: Floats  # (2,) corner of the bounding box on the page
    high: Floats  # (2,)
    half: Floats  # (n, 2) half-extent of each sphere
    nearest: float


class _Cells(NamedTuple):
    """The cells each sphere's bounding box touches: columns and rows from ``low`` to ``high``, inclusive."""

    page: _Page
    low: Ints  # (n, 2)
    high: Ints  # (n, 2)


class _Clusters(NamedTuple):
    """Spheres that lie together, the nearest clusters first."""

    sphere: Ints  # (n,) by cluster
    start: Ints  # (c + 1,) CSR offsets
    nearest: Floats  # (c,) how near the nearest point of any sphere is
    cells: _Cells  # (c,) that the bounding boxes touch


def possibly_visible(parts: Sequence[Part], projection: Projection) -> Ints:
    """Return which spheres may be seen, ascending, in time linear in their number for atoms.

    They are numbered through the ``parts``, of which none is kept. The nearest come first: most parts and clusters of
    spheres are hidden by what covers the page before them, and none of their spheres is looked at. What is left is
    asked again when all is known. No list of all spheres' cells is ever made.
    """
    outlines = [_outline(part(), projection) for part in parts]
    page, first = _page(outlines), np.cumsum([0, *(len(one.half) for one in outlines)])
    cover = np.full(page.tall * page.wide, -np.inf)  # how near each cell is covered
    left: list[tuple[Ints, SphereOccluders]] = []
    for number in np.argsort([-one.nearest for one in outlines]).tolist():
        if _part_shows(page, outlines[number], cover):
            spheres = parts[number]()
            rows = _not_yet_hidden(spheres, _cells(spheres, projection, page), cover)
            left.append((first[number] + rows, spheres.take(rows)))
    visible = [row[_shown(spheres, _cells(spheres, projection, page), cover)] for row, spheres in left]
    return np.sort(np.concatenate(visible))


def _not_yet_hidden(spheres: SphereOccluders, cells: _Cells, cover: Floats) -> Ints:
    """The spheres of a part that what was before them does not hide; the cover is theirs as well then."""
    clusters = _clusters(spheres, cells)
    left = [np.empty(0, dtype=np.int64)]
    for group in _groups(cells, clusters, cover):
        for shown, cell, least in in_threads(lambda rows: _bounds(spheres, cells, rows, cover), group):
            left.append(shown)
            np.maximum.at(cover, cell, least)
    return np.concatenate(left)


def _shown(spheres: SphereOccluders, cells: _Cells, cover: Floats) -> Ints:
    """The spheres that show when all that covers is known."""
    rows = np.arange(len(cells.low))
    shown = in_threads(lambda block: _bounds(spheres, cells, rows[block], cover)[0], _blocks(cells, rows))
    return np.concatenate([rows[:0], *shown])


def _part_shows(page: _Page, outline: _Outline, cover: Floats) -> bool:
    """Whether anything of a part may lie before the cover of some cell."""
    if not len(outline.half):
        return False
    (x0, y0), (x1, y1) = (_cell(page, corner).tolist() for corner in (outline.low, outline.high))
    return bool(np.any(cover.reshape(page.tall, page.wide)[y0 : y1 + 1, x0 : x1 + 1] < outline.nearest))


def _clusters(spheres: SphereOccluders, cells: _Cells) -> _Clusters:
    """The spheres with centres in one cube of space, ``CLUSTER`` cells wide, as a cluster."""
    center = spheres.spheres.center
    cube = np.floor((center - center.min(axis=0)) / (CLUSTER * cells.page.side)).astype(np.int64)
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
    least, most = spheres.surface_bounds(np.repeat(rows, number), low, cells.page.side)
    known = cover[cell]
    nearer = np.flatnonzero(least > known)
    shows = np.maximum.reduceat(most > known, np.cumsum(number) - number)
    return rows[shows], cell[nearer], least[nearer]


def _outline(spheres: SphereOccluders, projection: Projection) -> _Outline:
    center, half = outlines(spheres, projection)
    if not len(half):
        return _Outline(np.full(2, np.inf), np.full(2, -np.inf), half, -np.inf)
    nearest = float(spheres.nearest_points().max())
    return _Outline((center - half).min(axis=0), (center + half).max(axis=0), half, nearest)


def _page(parts: Sequence[_Outline]) -> _Page:
    """A grid by Franklin's formula for deep scenes, ``L = R (0.6 − 0.078 ln D)`` with depth D."""
    half = np.concatenate([part.half for part in parts])
    low, high = np.min([part.low for part in parts], axis=0), np.max([part.high for part in parts], axis=0)
    radius = float(np.partition(half.ravel(), half.size // 2)[half.size // 2])  # np.median loads masked arrays
    depth = 4 * np.sum(half[:, 0] * half[:, 1]) / max(float(np.prod(high - low)), np.finfo(float).tiny)
    factor = float(np.clip(0.6 - 0.078 * np.log(max(depth, 1.0)), 0.2, 0.6))
    page = _Page(low, max(radius * factor, (high - low).max() / MOST_CELLS), 0, 0)
    wide, tall = (_cell(page, high) + 1).tolist()
    return page._replace(wide=wide, tall=tall)


def _cell(page: _Page, points: Floats) -> Ints:
    """The columns and rows of cells (..., 2) in which points lie."""
    return np.asarray(np.floor((points - page.origin) / page.side).astype(np.int64))


def _cells(spheres: SphereOccluders, projection: Projection, page: _Page) -> _Cells:
    center, half = outlines(spheres, projection)
    return _Cells(page, _cell(page, center - half), _cell(page, center + half))


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
    page = cells.page
    return width * height, y * page.wide + x, page.origin + np.stack([x, y], axis=1) * page.side
