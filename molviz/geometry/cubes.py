"""Space in cubes, each with the balls that meet it: the index of Halperin & Overmars 1994, sections 2.4 and 3.

Cubes have side 2 r_max, so that a ball meets at most eight of them and, in a hard sphere model, a cube meets a bounded
number of balls. The cubes that any ball meets are sorted by x, y, z, each with its balls: O(n) space, O(n log n) time;
which balls a point is in, or a ball of at most r_max meets, takes O(log n) to find the cube and O(1) in it
(Theorem 3.1). For query balls the index holds the balls enlarged by the ``reach`` of the queries, so that only the
cube of a query's centre is read, not all eight that it meets.

*The decomposition of section 2.4.* The vertical decomposition of all n spheres may have Θ(n²) cells (Theorem 2.3).
Within the cubes, each of which is decomposed by itself, it has O(n) simple cells in all (Theorem 2.4). These cubes are
that decomposition: the cell of a point in its cube lies between the sphere next below and the sphere next above it, and
the order of the cube's balls along the point's vertical tells both in O(1), so that no wall is ever stored. Cubes above
each other are neighbours in the sorted order, those that no ball meets being left out: whoever climbs from cube to cube
passes O(n^⅓) of them in a globule, and all that are there, O(n), at worst.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.grid import Neighbours, collapsed, cube_key
from molviz.geometry.rows import blocks, expand, offsets
from molviz.model.spheres import Spheres

BLOCK_ROWS = 1 << 18  # queries, and candidates for their answers, at a time: keeps memory flat and columns in cache


class Cubes(NamedTuple):
    """The k cubes that balls meet; the balls of cube q are ``ball[start[q] : start[q + 1]]``, ascending."""

    side: float
    slabs: tuple[Floats, Floats, Floats]  # that balls meet, of each axis, ascending
    slab_number: tuple[Ints, Ints, Ints]  # their numbers with empty slabs collapsed, from 1
    key: Ints  # (k,) ascending; those of cubes above each other are consecutive
    start: Ints  # (k + 1,)
    ball: Ints  # rows


class Meetings(NamedTuple):
    """Queries and balls that may meet, ordered by both."""

    query: Ints  # (m,)
    ball: Ints  # (m,)
    gap: Floats  # (m,) squared distance of their centres


class BallIndex:
    """n ≥ 1 balls, ready for queries by points and balls of any radius.

    Cubes are made when the first query needs them: for points, and for balls of at most r_max, 2 r_max, 4 r_max …
    """

    def __init__(self, spheres: Spheres) -> None:
        self.spheres = spheres
        self._column = [np.ascontiguousarray(column) for column in spheres.center.T]
        self.largest = float(spheres.radius.max())
        self._cubes: dict[float, Cubes] = {}

    def cubes(self, reach: float = 0.0) -> Cubes:
        """Return the cubes for queries whose radius is at most ``reach``."""
        if reach not in self._cubes:
            self._cubes[reach] = cubes_of(self.spheres, reach)
        return self._cubes[reach]

    def balls_met(self, center: Floats, radius: Floats) -> Neighbours:
        """Return for every query ball (m, 3), (m,) the balls that it meets, ascending; radius 0 asks for a point."""
        queries, balls = [np.empty(0, dtype=np.int64)], [np.empty(0, dtype=np.int64)]
        for found in self.meetings(center, radius):
            met = found.gap < (radius[found.query] + self.spheres.radius[found.ball]) ** 2
            queries.append(found.query[met])
            balls.append(found.ball[met])
        query, ball = np.concatenate(queries), np.concatenate(balls)
        if len(self._levels(radius)) > 1:
            order = np.argsort(query, kind="stable")
            query, ball = query[order], ball[order]
        return Neighbours(offsets(query, len(radius)), ball)

    def meetings(self, center: Floats, radius: Floats) -> Iterator[Meetings]:
        """Return in blocks a superset of the query balls (m, 3), (m,) and balls that meet, reach by reach."""
        reach = self._reach(radius)
        for level in self._levels(radius):
            chosen = np.flatnonzero(reach == level)
            for begin in range(0, len(chosen), BLOCK_ROWS):
                query = chosen[begin : begin + BLOCK_ROWS]
                yield from self._near(self.cubes(level), center, query)

    def _levels(self, radius: Floats) -> list[float]:
        levels: list[float] = np.unique(self._reach(radius)).tolist()
        return levels

    def _reach(self, radius: Floats) -> Floats:
        """0 for points, else the least r_max 2^k, k ≥ 0, that is no less than each radius (m,)."""
        mantissa, exponent = np.frexp(radius / self.largest)
        doublings = np.maximum(exponent - (mantissa == 0.5), 0)
        return np.where(radius > 0, np.ldexp(self.largest, doublings), 0.0)

    def _near(self, cubes: Cubes, center: Floats, query: Ints) -> Iterator[Meetings]:
        cube, known = cube_at(cubes, center[query])
        begin, end = cubes.start[cube], np.where(known, cubes.start[cube + 1], 0)
        for block in blocks(np.maximum(end - begin, 0), BLOCK_ROWS):
            owner, entry = expand(begin[block], end[block])
            row, ball = query[block][owner], cubes.ball[entry]
            yield Meetings(row, ball, self.gap(center[query[block]], owner, ball))

    def gap(self, point: Floats, owner: Ints, ball: Ints, axes: int = 3) -> Floats:
        """Return squared distances (k,) of points, rows ``owner``, and centres of balls along the first ``axes``."""
        gap: Floats = np.zeros(len(owner))
        for axis in range(axes):
            along = point[:, axis].take(owner)
            along -= self._column[axis].take(ball)
            along *= along
            gap += along
        return gap


def cubes_of(spheres: Spheres, reach: float) -> Cubes:
    """Return the cubes that n ≥ 1 balls meet that are enlarged by ``reach``.

    Of cubes that only the box around a ball meets it is counted as well. Rounding loses none: the corners of the box
    are rounded as monotonously as the places of queries are.
    """
    side = 2.0 * max(float(spheres.radius.max()), reach)
    radius = (spheres.radius + reach)[:, None]
    low, high = np.floor((spheres.center - radius) / side), np.floor((spheres.center + radius) / side)
    slabs = tuple(_slabs(low[:, axis], high[:, axis]) for axis in range(3))
    number = tuple(map(collapsed, slabs))
    first, last = (
        np.stack([number[axis][np.searchsorted(slabs[axis], end[:, axis])] for axis in range(3)], axis=1)
        for end in (low, high)
    )
    size = last - first + 1
    ball, place = expand(np.zeros(len(size), dtype=np.int64), size.prod(axis=1))
    deep, wide = size[ball, 2], size[ball, 1] * size[ball, 2]
    x, y, z = first[ball, 0] + place // wide, first[ball, 1] + place % wide // deep, first[ball, 2] + place % deep
    key = cube_key(x, y, z, number)
    order = np.argsort(key, kind="stable")
    keys, start = np.unique(key[order], return_index=True)
    return Cubes(side, slabs, number, keys, np.append(start, len(key)), ball[order])  # type: ignore[arg-type]


def _slabs(low: Floats, high: Floats) -> Floats:
    """All slabs from ``low`` (n,) to ``high`` (n,) of each ball, each once, ascending."""
    ball, step = expand(np.zeros(len(low), dtype=np.int64), (high - low).astype(np.int64) + 1)
    return np.unique(low[ball] + step)


def cube_at(cubes: Cubes, point: Floats) -> tuple[Ints, Bools]:
    """Return for points (m, 3) the row of their cube and whether balls meet it; else some row that is there."""
    number, known = _slab_numbers(cubes, point)
    x, y, z = number
    key = cube_key(x, y, z, cubes.slab_number)
    row = np.minimum(np.searchsorted(cubes.key, key), len(cubes.key) - 1)
    return row, known.all(axis=0) & (cubes.key[row] == key)


def cubes_above(cubes: Cubes, point: Floats) -> tuple[Ints, Ints]:
    """Return for points (m, 3) the rows, from the first up to the second, of their cube and those straight above it.

    Only cubes that balls meet have rows; where there are none, both are the same.
    """
    number, known = _slab_numbers(cubes, point)
    x, y, z = number
    highest = cubes.slab_number[2][-1]
    above_all = ~known[2] & (point[:, 2] / cubes.side > cubes.slabs[2][-1])
    begin, end = (
        np.searchsorted(cubes.key, cube_key(x, y, level, cubes.slab_number))
        for level in (z + above_all, np.full_like(z, highest + 1))
    )
    return begin, np.where(known[0] & known[1], end, begin)


def slab_above(cubes: Cubes, row: Ints) -> Floats:
    """Return the slab in z (m,) of cubes: their points have that number of sides, or up to one more, as height."""
    number = cubes.key[row] % (cubes.slab_number[2][-1] + 2)
    return np.asarray(cubes.slabs[2][np.searchsorted(cubes.slab_number[2], number)])


def _slab_numbers(cubes: Cubes, point: Floats) -> tuple[list[Ints], Bools]:
    """The number (m,) of each point's slab on each axis, or of the next above it, and whether balls meet it (3, m)."""
    numbers, known = [], []
    for axis in range(3):
        slab = np.floor(point[:, axis] / cubes.side)
        place = np.minimum(np.searchsorted(cubes.slabs[axis], slab), len(cubes.slabs[axis]) - 1)
        known.append(cubes.slabs[axis][place] == slab)
        numbers.append(cubes.slab_number[axis][place])
    return numbers, np.stack(known)
