"""The boundary of the union of balls (Halperin & Overmars 1994, section 4, steps 1 and 2).

A sphere's part of the boundary is what no neighbouring ball covers; it is bounded by arcs of creases, the circles in
which two spheres meet. A crease is cut by every third ball that meets both spheres.

Special position. Balls inside another (or equal to an earlier one) are left out, balls that barely touch are apart
(``TOUCH``). Where several circles of a sphere pass through one point, or touch, rounding makes or loses only arcs as
short as rounding, which no sum over arcs feels. What must be decided consistently are three spheres whose creases are
one circle (``COINCIDE``): they belong to a pencil, with their centres in a line, and only the two outermost reach the
boundary, so ball k covers the crease of i and j unless its centre lies between theirs.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Masks
from molviz.geometry.caps import BINS, Caps, OpenCreases, open_creases
from molviz.geometry.circles import CircleArcs, Circles, creases, radical_planes
from molviz.geometry.grid import Neighbours, neighbours
from molviz.geometry.intervals import TURN, Intervals, above, gaps
from molviz.geometry.rows import blocks, expand, offsets
from molviz.geometry.tolerances import COINCIDE, TOUCH
from molviz.model.spheres import Spheres
from molviz.threads import in_threads
from molviz.vectors import length

BLOCK_ENTRIES = 1 << 17  # entries (sphere, cap, cap) at a time: their temporaries stay in cache


class Boundary(NamedTuple):
    """The union boundary of ``spheres``: the creases with a free part, ordered by their spheres, and the free arcs."""

    spheres: Spheres
    neighbours: Neighbours  # the balls that meet each sphere
    crossing: Neighbours  # the balls that cover a cap of each sphere and lie in no other ball
    inside: Bools  # (n,) balls that lie in another, or equal an earlier one
    circles: Circles  # first < second
    arcs: CircleArcs  # free of all other balls, with the balls that they leave and enter


def union_boundary(spheres: Spheres, near: Neighbours | None = None) -> Boundary:
    """Return the free arcs of all creases of n spheres, linear in n for a hard sphere model (Theorem 4.1)."""
    near = neighbours(spheres) if near is None else near
    crossing, inside = _crossing(spheres, near)
    candidates = _candidates(spheres, crossing)
    circles, _ = creases(spheres, candidates.first, candidates.second)
    circles, arcs = _free_arcs(spheres, circles, candidates)
    return Boundary(spheres, near, crossing, inside, circles, arcs)


def free_spheres(boundary: Boundary) -> Bools:
    """Return (n,) whether a sphere is free all over: no sphere meets it, and it lies in no other ball."""
    return np.asarray((np.diff(boundary.crossing.start) == 0) & ~boundary.inside)


def _crossing(spheres: Spheres, near: Neighbours) -> tuple[Neighbours, Bools]:
    """The neighbours whose spheres meet in a circle, among balls that lie in no other; and which balls do."""
    count = len(spheres.radius)
    owner = np.repeat(np.arange(count), np.diff(near.start))
    distance, own, other = _distances(spheres, owner, near.item)
    slack = TOUCH * np.minimum(own, other)
    larger = (other > own) | ((other == own) & (near.item < owner))
    inside: Bools = np.zeros(count, dtype=bool)
    inside[owner[larger & (distance <= other - own + slack)]] = True
    kept = (distance < own + other - slack) & ~inside[owner] & ~inside[near.item]
    return Neighbours(offsets(owner[kept], count), near.item[kept]), inside


def _distances(spheres: Spheres, one: Ints, other: Ints) -> tuple[Floats, Floats, Floats]:
    """Distances of pairs of centres, and the radii of both."""
    distance = length(spheres.center[other] - spheres.center[one])
    return np.asarray(distance), spheres.radius[one], spheres.radius[other]


def _candidates(spheres: Spheres, crossing: Neighbours) -> OpenCreases:
    """The creases that may have a free part, of all spheres; crease numbers run through."""
    empty = np.empty(0, dtype=np.int64)
    lists = in_threads(lambda sphere: _of_block(_caps(spheres, crossing, sphere)), _blocks(crossing))
    parts = [part for block in lists for part in block]
    parts.append(OpenCreases(empty, empty, empty.astype(np.uint64), empty, empty))
    begin = np.cumsum([0] + [len(part.first) for part in parts])
    shifted = [part._replace(crease=part.crease + at) for part, at in zip(parts, begin, strict=False)]
    return _in_order(OpenCreases(*(np.concatenate(column) for column in zip(*shifted, strict=True))))


def _of_block(caps: Caps) -> list[OpenCreases]:
    """The same of some spheres; where one meets thousands of others, its rims are taken in turns."""
    count, width = caps.item.shape
    step = max(BLOCK_ENTRIES // (count * width), 1)
    return [open_creases(caps, slice(begin, min(begin + step, width))) for begin in range(0, width, step)]


def _in_order(creases: OpenCreases) -> OpenCreases:
    order = np.lexsort((creases.second, creases.first))
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    first, second, covered = creases.first[order], creases.second[order], creases.covered[order]
    return OpenCreases(first, second, covered, rank[creases.crease], creases.ball)


def _blocks(crossing: Neighbours) -> Iterator[Ints]:
    """Spheres with equally many neighbours side by side, so that little is padded."""
    count = np.diff(crossing.start)
    order = np.argsort(count, kind="stable")
    order = order[np.searchsorted(count[order], 1) :]
    for block in blocks(count[order] ** 2, BLOCK_ENTRIES):
        yield order[block]


def _caps(spheres: Spheres, crossing: Neighbours, sphere: Ints) -> Caps:
    """The caps of the given spheres; ``cos ω = t / ri``, the radical plane lying at t."""
    row, entry = expand(crossing.start[sphere], crossing.start[sphere + 1])
    place = entry - crossing.start[sphere][row]
    direction, along = radical_planes(spheres, sphere[row], crossing.item[entry])
    shape = len(sphere), int(place.max()) + 1
    item, axis, cosine = np.full(shape, -1), np.zeros((*shape, 3)), np.full(shape, 2.0)
    item[row, place] = crossing.item[entry]
    axis[row, place] = direction
    cosine[row, place] = along / spheres.radius[sphere[row]]
    largest = np.argsort(cosine, axis=1)
    rows = np.arange(len(sphere))[:, None]
    return Caps(sphere, item[rows, largest], axis[rows, largest], cosine[rows, largest])


def _free_arcs(spheres: Spheres, circles: Circles, candidates: OpenCreases) -> tuple[Circles, CircleArcs]:
    """The gaps that the balls leave of each circle, and the circles that have any."""
    middle, half = _crease_inside_ball(spheres, circles, candidates.crease, candidates.ball)
    real = half > 0
    known = _runs(candidates.covered)
    covered = Intervals(candidates.crease[real], (middle - half)[real], 2 * half[real])
    together = Intervals(*(np.concatenate(column) for column in zip(covered, known, strict=True)))
    free = gaps(together, len(circles.first))
    name = np.append(candidates.ball[real], np.full(len(known.circle) + 1, -1))  # row −1: no interval, no ball
    open_circles, number = np.unique(free.circle, return_inverse=True)
    arcs = CircleArcs(number, free.start, free.sweep, name[free.before], name[free.after])
    return circles.take(open_circles), arcs


def _runs(covered: Masks) -> Intervals:
    """The bins known to be covered, as intervals. Each ends inside a ball that reaches on: no gap begins at its end."""
    edge: Floats = np.linspace(0.0, TURN, BINS + 1)
    parts = [Intervals(np.empty(0, dtype=np.int64), np.empty(0), np.empty(0))]
    circle = np.flatnonzero(covered)
    rest = covered[circle]
    while len(circle):
        lowest = rest & (~rest + np.uint64(1))
        after = rest + lowest  # the carry runs through the lowest run of bits
        run = rest & ~after
        begin = _bit_number(lowest)
        end = _bit_number(run + lowest)
        parts.append(Intervals(circle, edge[begin], edge[end] - edge[begin]))
        rest = rest & after
        circle, rest = circle[rest != 0], rest[rest != 0]
    return Intervals(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _bit_number(power: Masks) -> Ints:
    """The exponents of powers of two; that of 2⁶⁴, which is 0 in 64 bits, is 64."""
    return np.where(power == 0, BINS, np.frexp(power.astype(np.float64))[1] - 1)


def inside_ball(spheres: Spheres, circles: Circles, circle: Ints, ball: Ints) -> tuple[Floats, Floats]:
    """Middle and half-width of the interval of each circle, on its first sphere, inside each ball."""
    offset = circles.center - spheres.center[circles.first]
    return above(*_half_space(spheres, circles, circle, ball, offset))


def _half_space(
    spheres: Spheres, circles: Circles, circle: Ints, ball: Ints, offset: Floats
) -> tuple[Floats, Floats, Floats]:
    """On sphere i, ``|p − ck|² < rk²`` is linear: ``2 (p − ci) · (ck − ci) > |ck − ci|² + ri² − rk²``."""
    own = circles.first[circle]
    toward = spheres.center[ball] - spheres.center[own]
    power = np.sum(toward**2, axis=1) + (spheres.radius[own] - spheres.radius[ball]) * (
        spheres.radius[own] + spheres.radius[ball]
    )
    rest = power / 2 - np.sum(offset[circle] * toward, axis=1)
    return np.sum(circles.a[circle] * toward, axis=1), np.sum(circles.b[circle] * toward, axis=1), rest


def _crease_inside_ball(spheres: Spheres, circles: Circles, circle: Ints, ball: Ints) -> tuple[Floats, Floats]:
    """The same for creases, with the tie rule for those that lie on the ball's sphere.

    A ball that is apart from one of the crease's spheres does not cut it: the third crease would be missing.
    """
    a, b, rest = _half_space(spheres, circles, circle, ball, _offset(spheres, circles))
    middle, half = above(a, b, rest)
    first, second = circles.first[circle], circles.second[circle]
    small = COINCIDE * spheres.radius[first] * _distances(spheres, first, ball)[0]
    same = np.flatnonzero((np.abs(rest) < small) & (np.hypot(a, b) < small))
    same = same[_on_sphere(spheres, second[same], ball[same], first[same])]
    same = same[_on_sphere(spheres, ball[same], first[same], second[same])]
    half[same] = np.where(_between(spheres, first[same], second[same], ball[same]), 0.0, np.pi)
    distance, own, other = _distances(spheres, second, ball)
    half[distance >= own + other - TOUCH * np.minimum(own, other)] = 0.0
    return middle, half


def _offset(spheres: Spheres, circles: Circles) -> Floats:
    """Centres of circles relative to those of their first spheres; their difference would lose digits far away."""
    axis, along = radical_planes(spheres, circles.first, circles.second)
    return axis * along[:, None]


def _on_sphere(spheres: Spheres, first: Ints, second: Ints, ball: Ints) -> Bools:
    """Whether two creases of the first sphere are one circle; of two nearly equal spheres and a third, not all are."""
    axis, along = radical_planes(spheres, first, second)
    distance, own, other = _distances(spheres, first, ball)
    toward = spheres.center[ball] - spheres.center[first]
    deep = np.sum(axis * toward, axis=1)
    aside = length(toward - axis * deep[:, None]) * np.sqrt(np.maximum(own**2 - along**2, 0.0))
    rest = (np.sum(toward**2, axis=1) + (own - other) * (own + other)) / 2 - deep * along
    small = COINCIDE * own * distance
    return np.asarray((np.abs(rest) < small) & (aside < small))


def _between(spheres: Spheres, first: Ints, second: Ints, ball: Ints) -> Bools:
    """Whether the centre of a ball of the pencil of two spheres lies between theirs."""
    to_first, to_second = (spheres.center[end] - spheres.center[ball] for end in (first, second))
    return np.asarray(np.sum(to_first * to_second, axis=1) < 0)
