"""The curves of sticks, and what their own solids hide of them.

A stick meets each of its balls in a *rim*, is cut across by *borders* and has two *lines* as its contour. Where sticks
as wide as their common ball (a *joint*) meet each other, they do so in the plane in which ``p · u`` of both is equal,
in an ellipse, the *elbow*: near a joint a point belongs to the stick with the largest ``p · u``, or to the ball if none
is positive. Every condition on these curves is linear.

Halves of sticks are solids of their own, numbered after the n spheres: n + 2 k + end for the halves of stick k.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.circles import perpendicular
from molviz.geometry.intervals import TURN, above
from molviz.geometry.rows import expand, offsets
from molviz.vectors import dot
from molviz.visibility.curves import BORDER, CREASE, LINE, SEAM, Curves
from molviz.visibility.forms import Linear
from molviz.visibility.named_arcs import Hidden
from molviz.visibility.names import BALL, OWN
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.occluders.stick import LINES, StickOccluders, plane_function


class Cuts(NamedTuple):
    """Where m borders cut sticks across, and the solids on both sides of each."""

    stick: Ints  # (m,)
    share: Floats  # (m,) of the axis, from its first end
    first: Ints  # (m,) towards the first end
    second: Ints  # (m,)


NO_CUTS = Cuts(np.empty(0, dtype=np.int64), np.empty(0), np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64))


class StickCurves(NamedTuple):
    """The curves of k sticks: rims (2k, one for each end), borders, elbows; then lines (2k, right and left of each)."""

    curves: Curves
    stick: Ints  # (m,) the stick of each, of an elbow that in ``second``
    other: Ints  # (m,) the other stick of an elbow, else −1
    end: Ints  # (m,) the end of a rim, or of both sticks of an elbow that in ``second``, else −1


def stick_curves(sticks: StickOccluders, cuts: Cuts, count: int) -> StickCurves:
    """Return the curves of sticks between ``count`` spheres."""
    one, other = _elbow_ends(sticks)
    number, ends = np.arange(len(sticks.length)), np.arange(2 * len(sticks.length))
    parts = [rims(sticks, count), borders(sticks, cuts), _elbows(sticks, one, other, count)]
    none, uncut = np.full(len(ends), -1), np.full(len(cuts.stick), -1)
    return StickCurves(
        parts[0].followed_by(parts[1]).followed_by(parts[2]).followed_by(lines(sticks, count)),
        np.concatenate([ends >> 1, cuts.stick, one >> 1, np.repeat(number, 2)]),
        np.concatenate([none, uncut, other >> 1, none]),
        np.concatenate([ends, uncut, one, none]),
    )


def rims(sticks: StickOccluders, count: int) -> Curves:
    """Return the curves in which the sticks leave their balls, a × b along their axes; seams at joints."""
    ends, end = sticks.ends, np.arange(len(sticks.ends.sphere))
    radius = np.repeat(sticks.radius, 2)
    size = np.sqrt(dot(ends.offset, ends.offset))
    aside = size > 0
    e, _ = perpendicular(ends.outward)
    e = np.where(aside[:, None], ends.offset / np.where(aside, size, 1.0)[:, None], e)
    f = np.cross(ends.outward, e)
    tilt = np.divide(size, ends.reach, out=np.zeros_like(size), where=aside)
    center = np.repeat(sticks.start, 2, axis=0)
    center[1::2] += sticks.direction * sticks.length[:, None]
    return Curves(
        np.where(ends.joint, SEAM, CREASE), ends.sphere, count + end,
        center + ends.outward * ends.reach[:, None],
        (e - ends.outward * tilt[:, None]) * radius[:, None], f * radius[:, None],
    )  # fmt: skip


def borders(sticks: StickOccluders, cuts: Cuts) -> Curves:
    """Return the circles that cut sticks across, a × b along their axes."""
    direction = sticks.direction[cuts.stick]
    e, f = perpendicular(direction)
    center = sticks.start[cuts.stick] + direction * (sticks.length[cuts.stick] * cuts.share)[:, None]
    radius = sticks.radius[cuts.stick, None]
    return Curves(np.full(len(cuts.stick), BORDER), cuts.first, cuts.second, center, e * radius, f * radius)


def halving(sticks: StickOccluders, count: int) -> Cuts:
    """Return the cuts at the middles of the sticks, but for those in a ball."""
    stick = np.flatnonzero(np.isfinite(sticks.middle()))
    return Cuts(stick, np.full(len(stick), 0.5), count + 2 * stick, count + 2 * stick + 1)


def lines(sticks: StickOccluders, count: int) -> Curves:
    """Return the silhouette lines, right and left of each stick in turn, with the stick on their left.

    ``p(θ) = middle + L u cos θ``: a line of length L is what lies between π/3 and 2π/3, from the half ``first`` to the
    half ``second``.
    """
    number = np.repeat(np.arange(len(sticks.length)), 2)
    side = np.arange(len(number)) & 1
    along = sticks.direction[number] * sticks.length[number, None]
    center = sticks.start[number] + along / 2
    center += sticks.normals.reshape(-1, 3) * sticks.radius[number, None]
    halves = count + 2 * number
    return Curves(
        np.full(len(number), LINE), halves + side, halves + 1 - side,
        center, np.where(side[:, None] == 1, along, -along), np.zeros_like(along),
    )  # fmt: skip


def _pairs_at_joints(sticks: StickOccluders) -> tuple[Ints, Ints]:
    """All pairs of ends (one, other) of two sticks that meet in a joint, both ways round, ordered by the first."""
    ends = np.flatnonzero(sticks.ends.joint)
    sphere = sticks.ends.sphere[ends]
    order = np.argsort(sphere, kind="stable")
    ends, sphere = ends[order], sphere[order]
    start = offsets(sphere, int(sphere.max(initial=-1)) + 1)
    row, entry = expand(start[sphere], start[sphere + 1])
    one, other = ends[row], ends[entry]
    apart = np.flatnonzero(one != other)
    apart = apart[np.lexsort((other[apart], one[apart]))]
    return one[apart], other[apart]


def _elbow_ends(sticks: StickOccluders) -> tuple[Ints, Ints]:
    one, other = _pairs_at_joints(sticks)
    return one[one > other], other[one > other]


def _elbows(sticks: StickOccluders, one: Ints, other: Ints, count: int) -> Curves:
    """The ellipses ``c + s (e + g u) cos t + s (f + h u) sin t``, ``g = e · w/(1 − u · w)`` and h likewise with f.

    In them sticks along u (``second``) and w (``first``) meet; a × b points along u − w.
    """
    u, w = sticks.ends.outward[one], sticks.ends.outward[other]
    e, f = perpendicular(u)
    difference = u - w
    share = dot(difference, difference) / 2  # 1 − u · w
    radius = sticks.radius[one >> 1][:, None]
    a, b = (x + u * (dot(x, w) / share)[:, None] for x in (e, f))
    center = sticks.start[one >> 1] + sticks.direction[one >> 1] * (sticks.length[one >> 1] * (one & 1))[:, None]
    return Curves(np.full(len(one), SEAM), count + other, count + one, center, a * radius, b * radius)


def farthest_reach(sticks: StickOccluders) -> Floats:
    """Return how far along the axis from each end (2k,) the rim and the elbows there reach.

    An elbow reaches to ``s cot(θ/2)``, θ the angle between both sticks.
    """
    ends, radius = sticks.ends, np.repeat(sticks.radius, 2)
    size = np.sqrt(dot(ends.offset, ends.offset))
    reach = ends.reach + radius * np.divide(size, ends.reach, out=np.zeros_like(size), where=size > 0)
    one, other = _pairs_at_joints(sticks)
    cosine = dot(ends.outward[one], ends.outward[other])
    np.maximum.at(reach, one, radius[one] * np.sqrt((1.0 + cosine) / (1.0 - cosine)))
    return reach


def hidden_of_own(sticks: StickOccluders, spheres: SphereOccluders, of: StickCurves, first_curve: int) -> list[Hidden]:
    """Return what their own sticks and balls hide of the curves, which are number ``first_curve`` onwards."""
    kind, number = of.curves.kind, np.arange(len(of.curves.kind))
    count = len(spheres.spheres.radius)
    rim = number[of.end >= 0][: len(sticks.ends.sphere)]
    elbow = np.flatnonzero(of.other >= 0)
    line = np.flatnonzero(kind == LINE)
    conic = np.flatnonzero(kind != LINE)
    sphere = sticks.ends.sphere[rim]
    behind = sticks.behind(of.curves, conic, of.stick[conic], LINES)
    behind_other = sticks.behind(of.curves, elbow, of.other[elbow], LINES)
    half = np.where(kind[conic] == BORDER, of.curves.first[conic], of.curves.second[conic])
    parts = [
        _where(spheres.plane_margin(of.curves, rim, sphere), rim, OWN, sphere),
        _where(behind, conic, OWN, half),
        _where(behind_other, elbow, OWN, of.curves.first[elbow]),
        *_at_joints(sticks, of, rim, elbow, line, count),
        _beyond_ends(sticks, of.curves, line, count),
    ]
    return [part._replace(curve=part.curve + first_curve) for part in parts]


def _where(margin: Linear, curve: Ints, reason: int, other: Ints) -> Hidden:
    """The intervals of the curves on which the function is positive."""
    middle, half = above(margin.a, margin.b, -margin.c)
    rows = np.flatnonzero(half > 0)
    name = other[rows]
    return Hidden(curve[rows], (middle - half)[rows], 2 * half[rows], np.full(len(rows), reason), name, name)


def _at_joints(
    sticks: StickOccluders, of: StickCurves, rim: Ints, elbow: Ints, line: Ints, count: int
) -> list[Hidden]:
    """What balls and other sticks of a joint hide: elbows where ``p · u`` is less than at the rims, and all where
    another's is larger."""
    pair, third = _pairs_at_joints(sticks)
    start = offsets(pair, len(rim))
    end = of.end[elbow]
    center, outward, reach = _centers(sticks), sticks.ends.outward, sticks.ends.reach
    parts = [
        _where(plane_function(of.curves, elbow, center[end], -outward[end], -reach[end]),
               elbow, BALL, sticks.ends.sphere[end]),
        _where(plane_function(of.curves, rim[pair], center[pair], outward[third], reach[pair]),
               rim[pair], BALL, count + third),
    ]  # fmt: skip
    row, entry = expand(start[end], start[end + 1])
    rows = np.flatnonzero(count + third[entry] != of.curves.first[elbow[row]])
    row, entry = row[rows], entry[rows]
    curves = [elbow[row]]
    for side in (0, 1):
        curves.append(line[2 * (pair >> 1) + side])
    curve = np.concatenate(curves)
    entry = np.concatenate([entry, np.arange(len(pair)), np.arange(len(pair))])
    toward = outward[third[entry]] - outward[pair[entry]]
    larger = plane_function(of.curves, curve, center[pair[entry]], toward, np.zeros(len(curve)))
    return [*parts, _where(larger, curve, BALL, count + third[entry])]


def _centers(sticks: StickOccluders) -> Floats:
    """The points (2k, 3) of the axes nearest the centres of the balls at their ends."""
    centers = np.repeat(sticks.start, 2, axis=0)
    centers[1::2] += sticks.direction * sticks.length[:, None]
    return centers


def _beyond_ends(sticks: StickOccluders, curves: Curves, line: Ints, count: int) -> Hidden:
    """The one interval of each line outside its middle third and inside its two balls.

    The line runs from the end in ``first``: it comes out of that ball and goes into that in ``second``.
    """
    angles, names = [], []
    for column, half_turn in ((curves.first, 0.0), (curves.second, 1.0)):
        end = column[line] - count
        origin = _centers(sticks)[end] - sticks.ends.offset[end]
        margin = plane_function(curves, line, origin, -sticks.ends.m[end], -sticks.ends.t[end])
        _, half = above(margin.a, margin.b, -margin.c)  # about 0 at the first end, about π at the second
        angles.append(np.where(half_turn == 0.0, half, np.pi - half))
        names.append(column[line])
    start, sweep = angles[1], TURN + angles[0] - angles[1]
    return Hidden(line, start, np.minimum(sweep, TURN), np.full(len(line), OWN), names[0], names[1])


def caps_on_horizons(
    sticks: StickOccluders, spheres: SphereOccluders, horizons: Curves, of: StickCurves, count: int
) -> Hidden:
    """Return what sticks hide of the horizons of their own balls, inside them; curves are numbered by sphere."""
    ends = sticks.ends
    end = np.arange(len(ends.sphere))
    straight = dot(ends.offset, ends.offset) == 0
    rows = np.flatnonzero(straight)
    center = spheres.spheres.center[ends.sphere[rows]]
    inside = _where(plane_function(horizons, ends.sphere[rows], center, ends.m[rows], ends.t[rows]),
                    ends.sphere[rows], BALL, count + rows)  # fmt: skip
    inside.reason[ends.joint[inside.leaves - count]] = OWN  # where the horizon leaves a joint's stick, its line begins
    beside = _as_their_rims(spheres, horizons, of.curves, end[~straight], ends.sphere[~straight], count)
    return Hidden(*(np.concatenate(column) for column in zip(inside, beside, strict=True)))


def _as_their_rims(
    spheres: SphereOccluders, horizons: Curves, curves: Curves, rim: Ints, sphere: Ints, count: int
) -> Hidden:
    """The same of sticks beside the line of centres: between the points where the rims sink below the horizons."""
    margin = spheres.plane_margin(curves, rim, sphere)
    middle, half = above(margin.a, margin.b, -margin.c)
    cuts: Bools = (half > 0) & (half < np.pi)
    rim, sphere, middle, half = rim[cuts], sphere[cuts], middle[cuts], half[cuts]
    first, last = (
        spheres.horizon_angle(horizons, sphere, curves.at(rim, angle)) for angle in (middle - half, middle + half)
    )
    name = count + rim
    return Hidden(sphere, first, np.mod(last - first, TURN), np.full(len(rim), BALL), name, name)
