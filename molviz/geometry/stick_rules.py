"""What keeps sticks apart: they meet their own two balls and, outside of these, nothing.

Only there are all curves of a drawing conics. The rules, in their order, for the rods of bonds (one stick or several
parallel ones within a cylinder of radius ``reach``):

1. A ball is at least as wide as the rods in it.
2. Where a rod begins inside the ball of a bonded neighbour, as those of a ligand bound to a space-filling atom do, its
   ball grows until the rod leaves both balls at once, at most to its space-filling size.
3. A rod that passes through any other ball is thinned until it passes beside.
4. Two rods of a ball meet outside it where ``arcsin(s/r) + arcsin(s'/r) > angle``. Equal rods of a ball as wide as
   they are meet in a plane, and may, unless they do so beyond the middle of one of them: then the longer one is left
   out. Else the ball grows, to three of its widest rod at most; then both are thinned.
5. Rods that are thinned to less than a fifth, or that pass through a ball or another rod for all that, are left out.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.grid import intersecting_pairs
from molviz.geometry.rows import expand
from molviz.model.spheres import Spheres
from molviz.vectors import dot

APART = 1.02  # of the radius at which things would touch: room for what is drawn, and for rounding
GROWN = 3.0  # a ball for its rods is at most so many times as wide as they are: two equal ones may be 39° apart
THINNEST = 0.2  # of the radius a rod began with
FLAT = 1e-12  # 1 − cos θ of rods in one direction
NEVER = 1e-9  # ångström: atoms nearer than this have no direction between them
ROUNDING = 1e-9  # of a part of 1, that is 1


class Rods(NamedTuple):
    """m bonds to be drawn between balls."""

    first: Ints  # (m,)
    second: Ints  # (m,)
    radius: Floats  # (m,) ångström, of a single stick
    reach: Floats  # (m,) ångström, of the cylinder around all sticks of the bond
    order: Floats  # (m,) that is drawn
    part: Floats  # (m,) of the radius that was asked for

    def take(self, rows: Ints | Bools) -> "Rods":
        """Return the given rods."""
        sizes = (self.radius[rows], self.reach[rows], self.order[rows], self.part[rows])
        return Rods(self.first[rows], self.second[rows], *sizes)

    def thinned(self, factor: Floats) -> "Rods":
        """Return the rods with ``factor`` (m,) times their radii."""
        return self._replace(radius=factor * self.radius, reach=factor * self.reach, part=factor * self.part)

    def meetings(self) -> tuple[Ints, Ints, Ints]:
        """Return all pairs (p,) of rods that share a ball, and the ball."""
        ball = np.concatenate([self.first, self.second])
        order = np.argsort(ball, kind="stable")
        rod, ball = np.tile(np.arange(len(self.first)), 2)[order], ball[order]
        one, other = expand(np.arange(len(ball)) + 1, np.searchsorted(ball, ball, side="right"))
        return rod[one], rod[other], ball[one]

    def leave(self, radius: Floats) -> tuple[Floats, Floats]:
        """Return how far (m,), (m,) from the centres of their two balls, of the given radii, rods come out of them."""
        inside = [np.sqrt(np.maximum(radius[ball] ** 2 - self.reach**2, 0.0)) for ball in (self.first, self.second)]
        return inside[0], inside[1]


def settled(whole: Spheres, radius: Floats, rods: Rods) -> tuple[Floats, Rods, tuple[str, ...]]:
    """Return the radii (n,) of balls, and rods, after all rules; and what is odd. ``whole`` are space-filling balls."""
    center = whole.center
    rods = rods.take(lengths(center, rods.first, rods.second) > NEVER)
    radius = _grown_out(whole, _holding(radius, rods), rods)
    rods = seen_rods(center, radius, rods)
    rods = rods.thinned(_room(center, radius, rods))
    wide = rods.part >= THINNEST
    radius, rods = _joined(center, radius, rods.take(wide))
    rods = seen_rods(center, radius, rods)
    kept = (rods.part >= THINNEST) & ~_in_the_way(center, radius, rods) & ~_along_others(center, radius, rods)
    notes = _notes(int(np.sum(kept & (rods.part < 1.0))), int(np.sum(~wide) + np.sum(~kept)))
    return radius, rods.take(kept), notes


def _notes(thinned: int, left_out: int) -> tuple[str, ...]:
    notes = []
    if thinned:
        notes.append(f"sticks of {thinned} bonds are thinner than others, so that they meet nothing but their balls")
    if left_out:
        notes.append(f"sticks of {left_out} bonds are left out, as they would pass through other balls or sticks")
    return tuple(notes)


def lengths(center: Floats, first: Ints, second: Ints) -> Floats:
    """Return the distances (m,) of the centres of bonds."""
    return np.asarray(np.linalg.norm(center[second] - center[first], axis=1))


def seen_rods(center: Floats, radius: Floats, rods: Rods) -> Rods:
    """Return the rods of which anything lies outside the balls at their ends.

    Several sticks of one bond become a single one where a ball reaches the middle, and would cut their halves aslant.
    """
    length = lengths(center, rods.first, rods.second)
    meet = (rods.order != 1.0) & (2.0 * APART * np.maximum(radius[rods.first], radius[rods.second]) > length)
    rods = rods._replace(reach=np.where(meet, rods.radius, rods.reach), order=np.where(meet, 1.0, rods.order))
    near, far = rods.leave(radius)
    return rods.take(near + far < length)


# ---- rule 1 and 2


def _holding(radius: Floats, rods: Rods) -> Floats:
    """Return the radii of balls as wide as their rods."""
    held = radius.copy()
    for ball in (rods.first, rods.second):
        np.maximum.at(held, ball, rods.reach)
    return held


def _grown_out(whole: Spheres, radius: Floats, rods: Rods) -> Floats:
    """Return the radii of balls that rods leave outside the balls of bonded neighbours around them, where that can be.

    From the centre of a, along the unit vector u, a rod leaves the ball of k around it at the positive root of
    ``|c_a + t u − c_k| = r_k + reach``.
    """
    grown = radius.copy()
    one, other, ball = rods.meetings()
    for rod, neighbour in ((one, other), (other, one)):
        k, far = (rods.first[side] + rods.second[side] - ball for side in (neighbour, rod))
        u = (whole.center[far] - whole.center[ball]) / lengths(whole.center, ball, far)[:, None]
        apart, clear = whole.center[ball] - whole.center[k], APART * (radius[k] + rods.reach[rod])
        along, depth = dot(apart, u), clear**2 - dot(apart, apart)
        out = np.sqrt(np.maximum(along**2 + depth, 0.0)) - along
        needed = np.where(depth > 0, np.hypot(out, rods.reach[rod]), 0.0)
        np.maximum.at(grown, ball, np.where(needed <= whole.radius[ball], needed, 0.0))
    return grown


# ---- rule 3


def _room(center: Floats, radius: Floats, rods: Rods) -> Floats:
    """Return the part (m,) of its reach that each rod may have beside all balls but its own: 1, or less down to 0."""
    room = np.ones(len(rods.first))
    rod, ball = _rods_and_balls(center, radius, rods)
    begin, end = _visible_parts(center, radius, rods)
    gap = _point_distances(center[ball], begin[rod], end[rod])
    np.minimum.at(room, rod, np.maximum(gap / APART - radius[ball], 0.0) / rods.reach[rod])
    return _whole(room)


def _whole(part: Floats) -> Floats:
    return np.where(part > 1.0 - ROUNDING, 1.0, part)


def _rods_and_balls(center: Floats, radius: Floats, rods: Rods) -> tuple[Ints, Ints]:
    """Return pairs (p,) of rods and balls, not their own, that may meet: the balls near the middle of each rod."""
    if not len(rods.first):
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    around = _around(center, rods)
    low, high = around.box()
    wide = APART * radius
    balls = np.flatnonzero(((center + wide[:, None] > low) & (center - wide[:, None] < high)).all(axis=1))
    middles = np.concatenate([center[balls], around.center])
    first, second = intersecting_pairs(Spheres(middles, np.concatenate([wide[balls], around.radius])))
    mixed = (first < len(balls)) & (second >= len(balls))
    rod, ball = second[mixed] - len(balls), balls[first[mixed]]
    other = (ball != rods.first[rod]) & (ball != rods.second[rod])
    return rod[other], ball[other]


def _around(center: Floats, rods: Rods) -> Spheres:
    """Return spheres (m,) that hold the rods and what lies nearer to them than ``APART`` allows."""
    half = lengths(center, rods.first, rods.second) / 2.0
    return Spheres((center[rods.first] + center[rods.second]) / 2.0, APART * (half + rods.reach))


def _visible_parts(center: Floats, radius: Floats, rods: Rods) -> tuple[Floats, Floats]:
    """Return both ends (m, 3), (m, 3) of the axes of rods, less what lies in their own balls."""
    near, far = rods.leave(radius)
    axis = (center[rods.second] - center[rods.first]) / lengths(center, rods.first, rods.second)[:, None]
    return center[rods.first] + near[:, None] * axis, center[rods.second] - far[:, None] * axis


def _point_distances(point: Floats, begin: Floats, end: Floats) -> Floats:
    """Return the distances (p,) of points from segments."""
    along = end - begin
    t = np.clip(dot(point - begin, along) / dot(along, along), 0.0, 1.0)
    return np.asarray(np.linalg.norm(point - begin - t[:, None] * along, axis=1))


# ---- rule 4


def _joined(center: Floats, radius: Floats, rods: Rods) -> tuple[Floats, Rods]:
    """Return balls and rods such that the rods of a ball do not meet outside it, or meet in planes.

    Thinning a rod may end the likeness of rods at its other ball; so it goes on until nothing is thinned.
    """
    widest = np.zeros(len(radius))
    for end in (rods.first, rods.second):
        np.maximum.at(widest, end, rods.reach)
    limit = np.maximum(radius, GROWN * widest)
    while True:
        one, other, ball = rods.meetings()
        apart = ~_alike(radius, rods)[ball]
        one, other, ball = one[apart], other[apart], ball[apart]
        needed, factor = APART * _radius_apart(center, rods, one, other, ball), np.ones(len(rods.first))
        for rod in (one, other):
            np.minimum.at(factor, rod, _whole(limit[ball] / np.maximum(needed, limit[ball])))
        if (factor == 1.0).all():
            np.maximum.at(radius, ball, needed)
            return radius, rods
        rods = rods.thinned(factor)


def _alike(radius: Floats, rods: Rods) -> Bools:
    """Return the balls (n,) that are joints: as wide as all their rods, which are single sticks."""
    alike: Bools = np.ones(len(radius), dtype=bool)
    for ball in (rods.first, rods.second):
        alike[ball[(rods.reach != radius[ball]) | (rods.order != 1.0)]] = False
    return alike


def _radius_apart(center: Floats, rods: Rods, one: Ints, other: Ints, ball: Ints) -> Floats:
    """Return the radius (p,) of a ball outside which two of its rods do not meet.

    The inner lines of their outlines, in the plane of both axes at the angle θ, meet at the distance
    ``√(s² + s'² + 2ss' cos θ) / sin θ``, if they do so in front of the ball's centre; else the wider rod says it.
    """
    u, v = (_outwards(center, rods, rod, ball) for rod in (one, other))
    s, z = rods.reach[one], rods.reach[other]
    cos, sin = dot(u, v), np.linalg.norm(np.cross(u, v), axis=1)
    in_front = (s + z * cos > 0) & (z + s * cos > 0)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        meeting = np.sqrt(s**2 + z**2 + 2.0 * s * z * cos) / sin
    return np.where(in_front, meeting, np.maximum(s, z))


def _along_others(center: Floats, radius: Floats, rods: Rods) -> Bools:
    """Return the rods (m,) of joints that meet a shorter one beyond the middle of either, ``s cot (θ/2)`` far out."""
    wrong: Bools = np.zeros(len(rods.first), dtype=bool)
    one, other, ball = rods.meetings()
    alike = _alike(radius, rods)[ball]
    one, other, ball = one[alike], other[alike], ball[alike]
    u, v = (_outwards(center, rods, rod, ball) for rod in (one, other))
    length = lengths(center, rods.first, rods.second)
    cosine = np.clip(dot(u, v), -1.0, 1.0)
    shortest = np.minimum(length[one], length[other])
    far = APART * rods.reach[one] * np.sqrt((1.0 + cosine) / np.maximum(1.0 - cosine, FLAT)) > shortest / 2
    wrong[np.where(length[one] > length[other], one, other)[far]] = True
    return wrong


def _outwards(center: Floats, rods: Rods, rod: Ints, ball: Ints) -> Floats:
    """Return unit vectors (p, 3) along rods, away from their given balls."""
    far = rods.first[rod] + rods.second[rod] - ball
    return np.asarray((center[far] - center[ball]) / lengths(center, ball, far)[:, None])


# ---- rule 5


def _in_the_way(center: Floats, radius: Floats, rods: Rods) -> Bools:
    """Return the rods (m,) that meet a ball not their own, or another rod that has no ball in common and is shorter."""
    wrong = _room(center, radius, rods) < 1.0
    if not len(rods.first):
        return wrong
    one, other = intersecting_pairs(_around(center, rods))
    ends = [(rods.first[rod], rods.second[rod]) for rod in (one, other)]
    strange = np.all([a != b for a in ends[0] for b in ends[1]], axis=0)
    one, other = one[strange], other[strange]
    begin, end = _visible_parts(center, radius, rods)
    gap = _segment_distances(begin[one], end[one], begin[other], end[other])
    met = gap < APART * (rods.reach[one] + rods.reach[other])
    length = lengths(center, rods.first, rods.second)
    wrong[np.where(length[one] > length[other], one, other)[met]] = True
    return wrong


def _segment_distances(a: Floats, b: Floats, c: Floats, d: Floats) -> Floats:
    """Return the distances (p,) of segments from a to b and from c to d, each (p, 3).

    Where the lines come nearest to each other inside both, that is the distance of the lines; else an end is nearest.
    """
    ends = [_point_distances(a, c, d), _point_distances(b, c, d), _point_distances(c, a, b), _point_distances(d, a, b)]
    u, v, w = b - a, d - c, a - c
    uu, uv, vv, uw, vw = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (uv * vw - vv * uw) / (uu * vv - uv**2)
        t = (uu * vw - uv * uw) / (uu * vv - uv**2)
    crossing = np.linalg.norm(w + s[:, None] * u - t[:, None] * v, axis=1)
    inside = (s > 0) & (s < 1) & (t > 0) & (t < 1)
    return np.asarray(np.where(inside, crossing, np.min(ends, axis=0)))
