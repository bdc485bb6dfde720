"""The grid index: which spheres meet each other (Halperin & Overmars 1994, section 3); for other queries see ``cubes``.

Space is cut into cubes of side 2 r_max. Spheres are sorted once by the cube of their centre; those that may meet a
sphere are in the 3 × 3 columns of three cubes around it, each of which is one contiguous range of the sorted order.
Empty slabs of cubes collapse to one, so that cube numbers stay small however far apart the spheres are.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints, distinct
from molviz.geometry.rows import blocks, expand
from molviz.model.spheres import Spheres
from molviz.threads import in_threads

BLOCK_ROWS = 1 << 17  # candidate rows at a time: keeps memory flat and the columns in cache
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
    slab_number: tuple[Ints, Ints, Ints]  # of the occupied slabs of each axis, empty ones collapsed, from 1


def grid_index(spheres: Spheres) -> GridIndex:
    """Return the index of n ≥ 1 spheres, in O(n log n) time and O(n) space (Theorem 3.1)."""
    side = 2.0 * float(spheres.radius.max())
    cell = np.floor(spheres.center / side)
    slabs = tuple(distinct(cell[:, axis]) for axis in range(3))
    number = tuple(map(collapsed, slabs))
    x, y, z = (number[axis][np.searchsorted(slabs[axis], cell[:, axis])] for axis in range(3))
    key = cube_key(x, y, z, number)
    row = np.argsort(key, kind="stable")
    ordered = spheres.take(row)
    return GridIndex(ordered, row, key[row], number)  # type: ignore[arg-type]


def collapsed(slabs: Floats) -> Ints:
    """Return numbers from 1 of occupied slabs (k,), ascending, in which empty slabs between two count as one."""
    return np.cumsum(np.append(1, np.minimum(np.diff(slabs), 2))).astype(np.int64)


def cube_key(x: Ints, y: Ints, z: Ints, number: tuple[Ints, ...]) -> Ints:
    """Return keys (m,) of cubes by the numbers of their slabs; consecutive for cubes above each other."""
    return (x * int(number[1][-1] + 2) + y) * int(number[2][-1] + 2) + z


def intersecting_pairs(spheres: Spheres) -> tuple[Ints, Ints]:
    """Return all pairs i < j with |cj − ci| < ri + rj, each once, ordered by i then j."""
    one, other = meeting_pairs(spheres)
    first, second = np.minimum(one, other), np.maximum(one, other)
    order = np.argsort(first * len(spheres.radius) + second)
    return first[order], second[order]


def neighbours(spheres: Spheres) -> Neighbours:
    """Return for every sphere the spheres it intersects, in time linear in n for a hard sphere model."""
    return pairs_by_owner(*meeting_pairs(spheres), len(spheres.radius))


def pairs_by_owner(one: Ints, other: Ints, count: int) -> Neighbours:
    """Return the lists of ``count`` spheres that pairs (m,) of them, each once, make for both."""
    key = np.concatenate([one * count + other, other * count + one])
    key.sort()  # owner and item as one number: sorting numbers is many times faster than finding their order
    many = np.bincount(one, minlength=count) + np.bincount(other, minlength=count)
    key -= np.repeat(np.arange(count) * count, many)
    return Neighbours(np.concatenate([[0], np.cumsum(many)]), key)


def meeting_pairs(spheres: Spheres) -> tuple[Ints, Ints]:
    """Return all pairs of n spheres with |cj − ci| < ri + rj, each once, in the order in which the grid finds them."""
    if len(spheres.radius) < 2:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    index = grid_index(spheres)
    columns = (*np.ascontiguousarray(index.spheres.center.T), index.spheres.radius)
    candidates = list(_candidate_blocks(index))
    few = len(candidates) <= 1 + len(LATER_COLUMNS)  # a block for each range of columns: no work for threads
    pairs = (map if few else in_threads)(lambda block: _meeting(columns, *block), candidates)
    one, other = (index.row[np.concatenate(column)] for column in zip(*pairs, strict=True))
    return one, other


def _candidate_blocks(index: GridIndex) -> Iterator[tuple[int, Ints, Ints]]:
    """Pairs of sorted spheres in the same or adjacent cubes, each once, in blocks.

    A block is its first sphere, and for this and the next ones the range of spheres that each is a pair with.
    """
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
            yield block.start, begin[block], end[block]


def _meeting(columns: Sequence[Floats], first: int, begin: Ints, end: Ints) -> tuple[Ints, Ints]:
    owner, other = expand(begin, end)
    one = owner + first
    x, y, z, radius = columns
    gap = (x[one] - x[other]) ** 2 + (y[one] - y[other]) ** 2 + (z[one] - z[other]) ** 2
    meets = gap < (radius[one] + radius[other]) ** 2
    return one[meets], other[meets]
