"""Spheres that nobody can see, found before they cost anything (Franklin 1980, blocking cells).

The page is cut into square cells. Where a sphere covers a whole cell, everything farther away there is hidden; a
sphere is dropped when every cell it touches is blocked in front of it. No sphere that shows is ever dropped.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, ShortInts
from molviz.geometry.rows import blocks, expand
from molviz.threads import in_threads
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.projection import Projection, images_of

MOST_CELLS = 2048  # per axis
BLOCK_ROWS = 1 << 15  # (sphere, cell) rows at a time: their columns stay in cache


class _Cells(NamedTuple):
    """The cells each sphere's bounding box touches: columns and rows from ``low`` to ``high``, inclusive."""

    origin: Floats  # (2,)
    side: float
    wide: int
    low: Ints  # (n, 2)
    high: Ints  # (n, 2)


def possibly_visible(spheres: SphereOccluders, projection: Projection) -> Bools:
    """Return which of n spheres may be seen (n,), in time linear in n for atoms."""
    cells = _cells(spheres, projection)
    count = int(cells.high[:, 1].max()) + 1
    nearest_cover = np.full(count * cells.wide, -np.inf)

    def bounds(block: slice) -> tuple[slice, ShortInts, Floats, ShortInts, Floats]:
        sphere, cell, low = _rows(cells, block)
        least, most = spheres.surface_bounds(sphere, low, cells.side)
        covering = np.flatnonzero(least > -np.inf)
        short = cell.astype(np.int32)  # all rows are kept: half the memory
        return block, short, most, short[covering], least[covering]

    touched = in_threads(bounds, _blocks(cells))
    for _, _, _, covered, least in touched:
        np.maximum.at(nearest_cover, covered, least)
    seen = [_seen(cells, block, most > nearest_cover[cell]) for block, cell, most, _, _ in touched]
    return np.concatenate(seen)


def _seen(cells: _Cells, block: slice, shows: Bools) -> Bools:
    """Which of some spheres show in one of their cells."""
    number = np.prod(cells.high[block] - cells.low[block] + 1, axis=1)
    return np.asarray(np.maximum.reduceat(shows, np.cumsum(number) - number))


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
    images = images_of(spheres.horizons(), projection)
    return images.c, images.half_extent()


def _blocks(cells: _Cells) -> Iterator[slice]:
    """Spheres whose bounding boxes touch about as many cells together."""
    return blocks(np.prod(cells.high - cells.low + 1, axis=1), BLOCK_ROWS)


def _rows(cells: _Cells, block: slice) -> tuple[Ints, Ints, Floats]:
    """All (sphere, cell) of the bounding boxes of some spheres, with the cells' lower left corners."""
    low = cells.low[block]
    width, height = (cells.high[block] - low + 1).T
    sphere, place = expand(np.zeros_like(width), width * height)
    row, column = np.divmod(place, width[sphere])
    x, y = low[sphere, 0] + column, low[sphere, 1] + row
    return sphere + block.start, y * cells.wide + x, cells.origin + np.stack([x, y], axis=1) * cells.side
