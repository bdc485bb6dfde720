"""The grid index: which spheres meet a point, a ball, or each other (Halperin & Overmars 1994, section 3).

Space is cut into cubes of side 2 r_max. Spheres are sorted once by the cube of their centre; a query then reads the
3 × 3 columns of three cubes around it, each of which is one contiguous range of the sorted order. Empty slabs of
cubes collapse to one, so that cube numbers stay small however far apart the spheres are.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.geometry.rows import blocks, expand, offsets
from molviz.model.spheres import Spheres

BLOCK_ROWS = 1 << 20  # candidate rows at a time: keeps memory flat and the columns in cache
COLUMNS = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
LATER_COLUMNS = [(0, 1), (1, -1), (1, 0), (1, 1)]  # half of them: each pair of columns once


class Neighbours(NamedTuple):
    """The spheres that intersect each sphere: ``item[start[i] : start[i + 1]]``, ascending."""

    start: Ints  # (n + 1,)
    item: Ints  # (m,)


class GridIndex(NamedTuple):
    """Spheres sorted by cube; ``key`` numbers the cubes so that cubes above each other in z are consecutive."""

    spheres: Spheres  # in sorted order
    row: Ints  # (n,) row of each sorted sphere in the caller's order
    key: Ints  # (n,) ascending
    slabs: tuple[Ints, Ints, Ints]  # occupied slabs of each axis, ascending
    slab_number: tuple[Ints, Ints, Ints]  # their numbers with empty slabs collapsed, from 1
    side: float


def grid_index(spheres: Spheres) -> GridIndex:
    """Return the index of n ≥ 1 spheres, in O(n log n) time and O(n) space (Theorem 3.1)."""
    side = 2.0 * float(spheres.radius.max())
    cell = np.floor(spheres.center / side)
    slabs = tuple(np.unique(cell[:, axis]) for axis in range(3))
    number = tuple(np.cumsum(np.append(1, np.minimum(np.diff(slab), 2))).astype(np.int64) for slab in slabs)
    x, y, z = (number[axis][np.searchsorted(slabs[axis], cell[:, axis])] for axis in range(3))
    key = _key(x, y, z, number)
    row = np.argsort(key, kind="stable")
    ordered = spheres.take(row)
    return GridIndex(ordered, row, key[row], slabs, number, side)  # type: ignore[arg-type]


def _key(x: Ints, y: Ints, z: Ints, number: tuple[Ints, ...]) -> Ints:
    return (x * int(number[1][-1] + 2) + y) * int(number[2][-1] + 2) + z


def intersecting_pairs(spheres: Spheres) -> tuple[Ints, Ints]:
    """Return all pairs i < j with |cj − ci| < ri + rj, each once, ordered by i then j."""
    if len(spheres.radius) < 2:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    index = grid_index(spheres)
    meetings = [_meeting(index, *rows) for rows in _candidate_pairs(index)]
    one, other = (index.row[np.concatenate(column)] for column in zip(*meetings, strict=True))
    first, second = np.minimum(one, other), np.maximum(one, other)
    order = np.argsort(first * len(spheres.radius) + second)
    return first[order], second[order]


def neighbours(spheres: Spheres) -> Neighbours:
    """Return for every sphere the spheres it intersects, in time linear in n for a hard sphere model."""
    first, second = intersecting_pairs(spheres)
    count = len(spheres.radius)
    owner, item = np.concatenate([first, second]), np.concatenate([second, first])
    order = np.argsort(owner * count + item)
    return Neighbours(offsets(owner, count), item[order])


def balls_met(index: GridIndex, center: Floats, radius: Floats) -> Neighbours:
    """Return for every query ball (m, 3), (m,) the spheres whose balls it meets; radius 0 asks for a point.

    Raises ``ValueError`` for a query ball larger than the largest sphere, as the index looks one cube far.
    """
    if np.any(radius > index.side / 2):
        raise ValueError("a query ball may not be larger than the largest sphere of the index")
    place, known = _cube(index, center)
    queries, items = [np.empty(0, dtype=np.int64)], [np.empty(0, dtype=np.int64)]
    for column in COLUMNS:
        query, item = expand(*_column_range(index, place, known, column))
        gap = np.sum((center[query] - index.spheres.center[item]) ** 2, axis=1)
        met = gap < (radius[query] + index.spheres.radius[item]) ** 2
        queries.append(query[met])
        items.append(index.row[item[met]])
    query, item = np.concatenate(queries), np.concatenate(items)
    order = np.lexsort((item, query))
    return Neighbours(offsets(query, len(radius)), item[order])


def _cube(index: GridIndex, center: Floats) -> tuple[Ints, Ints]:
    """Slab numbers (m, 3, 3) of the three slabs around each point on each axis, and whether each is occupied."""
    slab = np.floor(center / index.side)[:, :, None] + np.array([-1.0, 0.0, 1.0])
    number = np.empty(slab.shape, dtype=np.int64)
    known = np.empty(slab.shape, dtype=np.int64)
    for axis in range(3):
        place = np.minimum(np.searchsorted(index.slabs[axis], slab[:, axis]), len(index.slabs[axis]) - 1)
        known[:, axis] = index.slabs[axis][place] == slab[:, axis]
        number[:, axis] = index.slab_number[axis][place]
    return number, known


def _column_range(index: GridIndex, number: Ints, known: Ints, column: tuple[int, int]) -> tuple[Ints, Ints]:
    """The range of sorted spheres in the three cubes above (dx, dy) of each query; empty where the slab is."""
    dx, dy = column[0] + 1, column[1] + 1
    z_known = known[:, 2].astype(bool)
    lowest = np.min(np.where(z_known, number[:, 2], np.iinfo(np.int64).max >> 24), axis=1)
    highest = np.max(np.where(z_known, number[:, 2], 0), axis=1)
    key = [_key(number[:, 0, dx], number[:, 1, dy], z, index.slab_number) for z in (lowest, highest)]
    begin, end = np.searchsorted(index.key, key[0]), np.searchsorted(index.key, key[1], side="right")
    occupied = (known[:, 0, dx] & known[:, 1, dy]).astype(bool) & z_known.any(axis=1)
    return begin, np.where(occupied, end, begin)


def _candidate_pairs(index: GridIndex) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of sorted spheres in the same or adjacent cubes, each once, in blocks."""
    count = len(index.key)
    wide = index.slab_number[2][-1] + 2
    tall = (index.slab_number[1][-1] + 2) * wide
    everyone = np.arange(count)
    ranges = [(everyone + 1, np.searchsorted(index.key, index.key + 1, side="right"))]
    for dx, dy in LATER_COLUMNS:
        key = index.key + dx * tall + dy * wide
        ranges.append((np.searchsorted(index.key, key - 1), np.searchsorted(index.key, key + 1, side="right")))
    for begin, end in ranges:
        for block in blocks(np.maximum(end - begin, 0), BLOCK_ROWS):
            owner, item = expand(begin[block], end[block])
            yield owner + block.start, item


def _meeting(index: GridIndex, one: Ints, other: Ints) -> tuple[Ints, Ints]:
    x, y, z = (np.ascontiguousarray(column) for column in index.spheres.center.T)
    radius = index.spheres.radius
    gap = (x[one] - x[other]) ** 2 + (y[one] - y[other]) ** 2 + (z[one] - z[other]) ** 2
    meets = gap < (radius[one] + radius[other]) ** 2
    return one[meets], other[meets]
