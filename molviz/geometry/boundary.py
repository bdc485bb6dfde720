"""The boundary of the union of balls (Halperin & Overmars 1994, section 4, steps 1 and 2).

A sphere's part of the boundary is what no neighbouring ball covers; it is bounded by arcs of creases, the circles in
which two spheres meet. A crease is cut by every third ball that meets both spheres.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.circles import Circles, creases
from molviz.geometry.grid import Neighbours, neighbours
from molviz.geometry.intervals import Intervals, above, gaps
from molviz.geometry.rows import blocks, expand
from molviz.model.spheres import Spheres

BLOCK_ENTRIES = 1 << 21  # entries (sphere, circle, neighbour) tested at a time


class FreeArcs(NamedTuple):
    """Arcs of circles outside all other balls, ordered by circle and start.

    ``before`` and ``after`` are the spheres whose balls the crease leaves where the arc starts and enters where it
    ends; −1 where the whole circle is free.
    """

    circle: Ints  # (k,)
    start: Floats  # (k,) radians in [0, 2π)
    sweep: Floats  # (k,) radians in (0, 2π]
    before: Ints  # (k,)
    after: Ints  # (k,)


class Boundary(NamedTuple):
    """The union boundary of ``spheres``: all creases that are not entirely covered, and their free arcs."""

    spheres: Spheres
    neighbours: Neighbours
    circles: Circles  # first < second
    arcs: FreeArcs


class _Caps(NamedTuple):
    """Neighbours of a block of spheres, padded to a rectangle: ball k covers ``x · axis > height`` of a unit sphere."""

    item: Ints  # (s, p) the neighbours, −1 for padding
    axis: Floats  # (s, p, 3)
    height: Floats  # (s, p) cosine of the cap's angle; ≤ −1 if the ball holds the sphere, ≥ 1 if it leaves it free


def union_boundary(spheres: Spheres, near: Neighbours | None = None) -> Boundary:
    """Return the free arcs of all creases of n spheres, linear in n for a hard sphere model (Theorem 4.1)."""
    near = neighbours(spheres) if near is None else near
    first, second, alive, cuts = _uncovered_pairs(spheres, near)
    circles, met = creases(spheres, first[alive], second[alive])
    number = np.full(len(first), -1)
    number[alive[met]] = np.arange(len(met))
    pair, ball = cuts
    ball, circle = ball[number[pair] >= 0], number[pair[number[pair] >= 0]]
    middle, half = inside_ball(spheres, circles, circle, ball)
    real = half > 0
    free = gaps(Intervals(circle[real], (middle - half)[real], 2 * half[real]), len(circles.first))
    name = np.append(ball[real], -1)  # row −1, no interval, becomes sphere −1
    arcs = FreeArcs(free.circle, free.start, free.sweep, name[free.before], name[free.after])
    return Boundary(spheres, near, circles, arcs)


def inside_ball(spheres: Spheres, circles: Circles, circle: Ints, ball: Ints) -> tuple[Floats, Floats]:
    """Middle and half-width of the interval of each circle inside each ball.

    On sphere i, ``|p − ck|² < rk²`` is linear: ``2 (p − ci) · (ck − ci) > |ck − ci|² + ri² − rk²``.
    """
    own = circles.first[circle]
    toward = spheres.center[ball] - spheres.center[own]
    power = np.sum(toward**2, axis=1) + spheres.radius[own] ** 2 - spheres.radius[ball] ** 2
    middle_part = np.sum((circles.center[circle] - spheres.center[own]) * toward, axis=1)
    along_a = np.sum(circles.a[circle] * toward, axis=1)
    along_b = np.sum(circles.b[circle] * toward, axis=1)
    return above(along_a, along_b, power / 2 - middle_part)


def _uncovered_pairs(spheres: Spheres, near: Neighbours) -> tuple[Ints, Ints, Ints, tuple[Ints, Ints]]:
    """All pairs i < j, the rows of those whose crease no third ball covers, and the (pair row, ball) that cut these."""
    owner = np.repeat(np.arange(len(near.start) - 1), np.diff(near.start))
    later = np.flatnonzero(near.item > owner)
    pair_of = np.full(len(near.item), -1)
    pair_of[later] = np.arange(len(later))
    alive: Bools = np.zeros(len(later), dtype=bool)
    pairs, balls = [np.empty(0, dtype=np.int64)], [np.empty(0, dtype=np.int64)]
    for sphere, caps in _blocks_of_caps(spheres, near):
        covered, cut = _tests(caps)
        row = near.start[sphere][:, None] + np.arange(caps.item.shape[1])
        wanted = (caps.item > sphere[:, None]) & (np.abs(caps.height) < 1) & ~covered.any(axis=2)
        block, circle, ball = np.nonzero(cut & wanted[:, :, None])
        pairs.append(pair_of[row[block, circle]])
        balls.append(caps.item[block, ball])
        alive[pair_of[row[wanted]]] = True
    return owner[later], near.item[later], np.flatnonzero(alive), (np.concatenate(pairs), np.concatenate(balls))


def _blocks_of_caps(spheres: Spheres, near: Neighbours) -> Iterator[tuple[Ints, _Caps]]:
    """Spheres with equally many neighbours side by side, so that little is padded."""
    count = np.diff(near.start)
    order = np.argsort(count, kind="stable")
    order = order[np.searchsorted(count[order], 1) :]
    for block in blocks(count[order] ** 2, BLOCK_ENTRIES):
        yield order[block], _caps(spheres, near, order[block])


def _caps(spheres: Spheres, near: Neighbours, sphere: Ints) -> _Caps:
    count = near.start[sphere + 1] - near.start[sphere]
    item = np.full((len(sphere), int(count.max())), -1)
    row, entry = expand(near.start[sphere], near.start[sphere + 1])
    item[row, entry - near.start[sphere][row]] = near.item[entry]
    toward = spheres.center[item] - spheres.center[sphere][:, None]
    distance = np.linalg.norm(toward, axis=2)
    own, other = spheres.radius[sphere][:, None], spheres.radius[item]
    with np.errstate(divide="ignore", invalid="ignore"):
        axis = np.nan_to_num(toward / distance[:, :, None])
        height = (distance**2 + own**2 - other**2) / (2 * distance * own)
    height = np.where(distance <= other - own, -2.0, np.where(distance <= own - other, 2.0, height))
    buried_twin = (distance == 0) & (own == other) & (item > sphere[:, None])
    height = np.where((item < 0) | buried_twin, 2.0, height)
    return _Caps(item, axis, height)


def _tests(caps: _Caps) -> tuple[Bools, Bools]:
    """Whether circle p of a sphere is (covered by, cut by) cap k: two arrays (s, p, k).

    On circle p, at angle arccos g between the axes, ``x · axis_k`` runs over ``c_p g ± s_p √(1 − g²)``; compared with
    c_k without a root: ``(c_k − c_p g)²`` against ``s_p² (1 − g²)``.
    """
    cosine = caps.axis @ caps.axis.transpose(0, 2, 1)
    rest = caps.height[:, None, :] - caps.height[:, :, None] * cosine
    reach = np.maximum(1 - caps.height**2, 0.0)[:, :, None] * np.maximum(1 - cosine**2, 0.0)
    itself = np.arange(caps.item.shape[1])
    rest[:, itself, itself] = 2.0
    cut = rest**2 < reach
    return (rest < 0) & ~cut, cut
