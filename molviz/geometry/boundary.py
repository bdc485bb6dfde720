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
from molviz.geometry.rows import blocks
from molviz.geometry.tolerances import COINCIDE, TOUCH
from molviz.model.spheres import Spheres
from molviz.threads import in_threads
from molviz.vectors import length

BLOCK_ENTRIES = 1 << 20  # entries (sphere, cap, cap) at a time: their temporaries stay in cache
PART_ENTRIES = 1 << 22  # of the creases of one thread at a time: fewer are too many steps
BLOCK_PAIRS = 1 << 15  # entries (sphere, neighbour) at a time, likewise


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
    parts = in_threads(lambda sphere: _free_arcs(spheres, _candidates(spheres, crossing, sphere)), _parts(crossing))
    circles = Circles(*(np.concatenate(column) for column in zip(*(part[0] for part in parts), strict=True)))
    arcs = CircleArcs(*(np.concatenate(column) for column in zip(*(part[1] for part in parts), strict=True)))
    begin = np.cumsum([0] + [len(part.first) for part, _ in parts])
    arcs.circle[:] += np.repeat(begin[:-1], [len(part.circle) for _, part in parts])
    return Boundary(spheres, near, crossing, inside, *_in_order(circles, arcs))


def _in_order(circles: Circles, arcs: CircleArcs) -> tuple[Circles, CircleArcs]:
    """The circles in the order of their spheres, and their arcs numbered anew."""
    order = np.lexsort((circles.second, circles.first))
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    arcs = arcs._replace(circle=rank[arcs.circle])
    return circles.take(order), arcs.take(np.argsort(arcs.circle, kind="stable"))


def free_spheres(boundary: Boundary) -> Bools:
    """Return (n,) whether a sphere is free all over: no sphere meets it, and it lies in no other ball."""
    return np.asarray((np.diff(boundary.crossing.start) == 0) & ~boundary.inside)


def _crossing(spheres: Spheres, near: Neighbours) -> tuple[Neighbours, Bools]:
    """The neighbours whose spheres meet in a circle, among balls that lie in no other; and which balls do."""
    count = len(spheres.radius)
    inside: Bools = np.zeros(count, dtype=bool)
    found = in_threads(lambda block: _meeting(spheres, near, block), blocks(np.diff(near.start), BLOCK_PAIRS))
    for buried, _ in found:
        inside[buried] = True
    meets = np.concatenate([meets for _, meets in found] or [inside])
    if inside.any():
        meets &= ~inside[near.item] & np.repeat(~inside, np.diff(near.start))
    kept = np.cumsum(np.append(0, meets))[near.start]
    return Neighbours(kept, near.item if len(meets) == kept[-1] else near.item[meets]), inside


def _meeting(spheres: Spheres, near: Neighbours, block: slice) -> tuple[Ints, Bools]:
    """Which of a range of balls lie in a neighbour, and which of their rows of ``near`` meet by more than a touch."""
    begin = near.start[block.start : block.stop]
    owner = np.repeat(np.arange(block.start, block.stop), np.diff(near.start[block.start : block.stop + 1]))
    item = near.item[begin[0] : near.start[block.stop]]
    distance, own, other = _distances(spheres, owner, item)
    slack = TOUCH * np.minimum(own, other)
    larger = (other > own) | ((other == own) & (item < owner))
    return owner[larger & (distance <= other - own + slack)], distance < own + other - slack


def _distances(spheres: Spheres, one: Ints, other: Ints) -> tuple[Floats, Floats, Floats]:
    """Distances of pairs of centres, and the radii of both."""
    distance = length(spheres.center.take(other, axis=0) - spheres.center.take(one, axis=0))
    return distance, spheres.radius.take(one), spheres.radius.take(other)


def _parts(crossing: Neighbours) -> Iterator[Ints]:
    """Spheres with equally many neighbours side by side, so that little is padded; none at all are one part."""
    count = np.diff(crossing.start)
    order = np.argsort(count, kind="stable")
    order = order[np.searchsorted(count[order], 1) :]
    for part in blocks(count[order] ** 2, PART_ENTRIES):
        yield order[part]
    if len(order) == 0:
        yield order


def _candidates(spheres: Spheres, crossing: Neighbours, sphere: Ints) -> OpenCreases:
    """The creases of the given spheres that may have a free part; crease numbers run through."""
    empty = np.empty(0, dtype=np.int64)
    parts = [OpenCreases(empty, empty, empty.astype(np.uint64), empty, empty)]
    for block in blocks(np.diff(crossing.start)[sphere] ** 2, BLOCK_ENTRIES):
        parts += _of_block(_caps(spheres, crossing, sphere[block]))
    begin = np.cumsum([0] + [len(part.first) for part in parts])
    shifted = [part._replace(crease=part.crease + at) for part, at in zip(parts, begin, strict=False)]
    return OpenCreases(*(np.concatenate(column) for column in zip(*shifted, strict=True)))


def _of_block(caps: Caps) -> list[OpenCreases]:
    """The same of some spheres; where one meets thousands of others, its rims are taken in turns."""
    count, width = caps.item.shape
    step = max(BLOCK_ENTRIES // (count * width), 1)
    return [open_creases(caps, slice(begin, min(begin + step, width))) for begin in range(0, width, step)]


def _caps(spheres: Spheres, crossing: Neighbours, sphere: Ints) -> Caps:
    """The caps of the given spheres; ``cos ω = t / ri``, the radical plane lying at t."""
    start, many = crossing.start[sphere][:, None], np.diff(crossing.start)[sphere][:, None]
    place = np.arange(int(many.max()))
    real = place < many
    item = crossing.item.take(start + place * real)  # the first again for padding
    direction, along = radical_planes(spheres, np.repeat(sphere, len(place)), item.ravel())
    cosine = np.where(real, along.reshape(item.shape) / spheres.radius[sphere][:, None], 2.0)
    largest = np.argsort(cosine, axis=1)
    largest += np.arange(len(sphere))[:, None] * len(place)
    return Caps(sphere, np.where(real, item, -1).take(largest), direction.take(largest, axis=0), cosine.take(largest))


def _free_arcs(spheres: Spheres, candidates: OpenCreases) -> tuple[Circles, CircleArcs]:
    """The gaps that the balls leave of each crease, and the circles that have any."""
    circles, _ = creases(spheres, candidates.first, candidates.second)
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
    toward = spheres.center.take(ball, axis=0) - spheres.center.take(own, axis=0)
    power = np.sum(toward**2, axis=1) + (spheres.radius[own] - spheres.radius[ball]) * (
        spheres.radius[own] + spheres.radius[ball]
    )
    a, b, along = (np.sum(vector.take(circle, axis=0) * toward, axis=1) for vector in (circles.a, circles.b, offset))
    return a, b, power / 2 - along


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
