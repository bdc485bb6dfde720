"""Sticks as occluders, in eye coordinates: cylinders between two balls, in which their end discs lie.

From outside, a cylinder's contour generator is a pair of lines. Between them lies a flat quadrilateral Q through the
inside of the stick, in the *silhouette plane*. A stick hides a point exactly when the point lies inside it, or behind
Q, or where one of its two balls hides it anyway; being behind Q is five linear conditions. A stick that is seen end on
has no silhouette, and the nearer ball hides all of it.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.model.spheres import Spheres
from molviz.model.sticks import Sticks
from molviz.vectors import dot
from molviz.visibility.curves import Curves
from molviz.visibility.forms import Linear

LINES = 2  # the first two conditions are those of the silhouette lines
JOINT = 1e-9  # of its radius, by which a ball may differ from its sticks to be a joint
END_ON = 1e-12  # of a stick's length: one that looks shorter is seen end on


class Ends(NamedTuple):
    """The 2k ends of k sticks, that at the first ball and that at the second of each in turn.

    A stick leaves its ball through a plane ``(p − c) · m = t``, c the ball's centre: the plane of the circle in which
    they meet, or, for a stick beside the line of centres, a plane that comes near to the space quartic they meet in.
    """

    sphere: Ints  # (2k,)
    outward: Floats  # (2k, 3) unit, along the axis and away from the ball
    offset: Floats  # (2k, 3) from the ball's centre to the axis
    reach: Floats  # (2k,) how far along the axis they meet
    m: Floats  # (2k, 3)
    t: Floats  # (2k,)
    joint: Bools  # (2k,) the ball is as wide as the stick, and all sticks of the ball are alike


class StickOccluders(NamedTuple):
    """k sticks with a silhouette; ``start`` and ``direction`` are those of the axis from ``first`` to ``second``."""

    row: Ints  # (k,) of the scene's sticks
    start: Floats  # (k, 3)
    direction: Floats  # (k, 3) unit
    length: Floats  # (k,)
    radius: Floats  # (k,)
    normals: Floats  # (k, 2, 3) unit, from the axis to the silhouette lines: right and left of the direction
    facing: Floats  # (k, 3) unit normal of the silhouette plane, towards the eye
    planes: Floats  # (k, 5, 3) a point p is behind Q where ``(p − start) · plane > at`` for all five: two lines,
    at: Floats  # (k, 5) the silhouette plane, two ends
    ends: Ends

    def take(self, rows: Ints) -> "StickOccluders":
        """Return the given sticks, in that order."""
        both = np.stack([2 * rows, 2 * rows + 1], axis=1).ravel()
        ends = Ends(*(column[both] for column in self.ends))  # type: ignore[arg-type]
        columns = (column[rows] for column in self[:-1])
        return StickOccluders(*columns, ends)  # type: ignore[call-arg, arg-type]

    def behind(self, curves: Curves, curve: Ints, stick: Ints, condition: int) -> Linear:
        """Return the function on the curves that is positive where one of the five conditions holds."""
        row = self.at.shape[1] * stick + condition
        plane, at = self.planes.reshape(-1, 3).take(row, axis=0), self.at.ravel().take(row)
        return plane_function(curves, curve, self.start.take(stick, axis=0), plane, at)

    def all_behind(self, curves: Curves, curve: Ints, stick: Ints) -> Linear:
        """Return the same for all five conditions, each a row of functions on the m curves: columns are (5, m)."""
        planes = np.ascontiguousarray(self.planes.take(stick, axis=0).transpose(2, 1, 0))  # x, y and z of the five
        center, a, b = (column.take(curve, axis=0) for column in curves[3:])
        m = center - self.start.take(stick, axis=0)
        on_a, on_b, on_m = (planes[0] * v[:, 0] + planes[1] * v[:, 1] + planes[2] * v[:, 2] for v in (a, b, m))
        return Linear(on_a, on_b, on_m - self.at.take(stick, axis=0).T)

    def hits(self, stick: Ints, origin: Floats, ray: Floats) -> tuple[Floats, Bools]:
        """Return how far along unit rays (m, 3) from points (m, 3) sticks are hit, and whether beyond their middles.

        Infinite where a ray misses the stick. With everything seen along the axis, ``|λ r − c|² = s²``.
        """
        u = self.direction.take(stick, axis=0)
        c = self.start.take(stick, axis=0) - origin
        r = ray - u * dot(ray, u)[:, None]
        flat = c - u * dot(c, u)[:, None]
        rr, rc = dot(r, r), dot(r, flat)
        with np.errstate(invalid="ignore", divide="ignore"):
            # |flat|² − (r · flat)²/r² is the square of the distance of ray and axis
            beside = flat - r * (rc / rr)[:, None]
            far = rc / rr - np.sqrt((self.radius[stick] ** 2 - dot(beside, beside)) / rr)
        along = dot(ray, u) * far - dot(c, u)
        hit = np.isfinite(far) & (along >= 0) & (along <= self.length[stick])
        return np.where(hit, far, np.inf), np.asarray(along > self.middle()[stick])

    def joins(self, first: Ints, second: Ints, count: int) -> Bools:
        """Return whether there is a stick between each pair (m,) of ``count`` spheres."""
        pair, joined = (np.minimum(*both) * count + np.maximum(*both)
                        for both in ((first, second), (self.ends.sphere[::2], self.ends.sphere[1::2])))  # fmt: skip
        return np.isin(pair, joined)

    def middle(self) -> Floats:
        """Return how far along (k,) the halves meet: infinitely far where a ball holds the middle."""
        reach = self.ends.reach.reshape(-1, 2) >= self.length[:, None] / 2
        return np.where(reach[:, 0], -np.inf, np.where(reach[:, 1], np.inf, self.length / 2))

    def line_angle(self, contour: Ints, points: Floats, central: bool) -> Floats:
        """Return the angle on silhouette line ``contour`` (two for each stick) that is seen where points (m, 3) are."""
        stick, side = contour >> 1, contour & 1
        u = self.direction[stick]
        toward = points - self.start[stick] - self.radius[stick, None] * self.normals[stick, side]
        sight = points if central else np.tile([0.0, 0.0, 1.0], (len(points), 1))
        # where the line meets the sight: toward − τ u − λ sight = 0, multiplied by the sight
        one, other = np.cross(sight, toward), np.cross(sight, u)
        share = dot(one, other) / dot(other, other) / self.length[stick] - 0.5
        return np.asarray(np.arccos(np.clip(np.where(side == 1, share, -share), -1.0, 1.0)))


def plane_function(curves: Curves, curve: Ints, origin: Floats, normal: Floats, at: Floats) -> Linear:
    """Return ``(p − origin) · normal − at`` on the curves."""
    center, a, b = (column.take(curve, axis=0) for column in curves[3:])
    return Linear(dot(a, normal), dot(b, normal), dot(center - origin, normal) - at)


def stick_occluders(spheres: Spheres, sticks: Sticks, central: bool) -> StickOccluders:
    """Return the sticks between spheres, all in eye coordinates, that have a silhouette and are not inside their balls.

    The offsets' parts along the lines of centres are left out.
    """
    between = spheres.center[sticks.second] - spheres.center[sticks.first]
    length = np.sqrt(dot(between, between))
    u = between / length[:, None]
    offset = sticks.offset - u * dot(sticks.offset, u)[:, None]
    ends = _ends(spheres, sticks, u, offset)
    outside = ends.reach.reshape(-1, 2).sum(axis=1) < length
    start = spheres.center[sticks.first] + offset
    toward, distance = _towards_eye(start, u, central)
    row = np.flatnonzero(outside & (distance > (sticks.radius if central else END_ON)))
    frame = _silhouette(start, u, toward, distance, sticks.radius, central)
    planes, at = _conditions(start, u, length, sticks.radius, *frame, central)
    columns = (start, u, length, sticks.radius, np.stack(frame[:2], axis=1), frame[2], planes, at)
    return StickOccluders(np.arange(len(length)), *columns, ends).take(row)


def _ends(spheres: Spheres, sticks: Sticks, u: Floats, offset: Floats) -> Ends:
    """``m = u + (o/τ) ô``, ``τ² = r² − o² − s²``: in it lie the points ``τ − (o s/τ) cos φ`` along the cylinder."""
    sphere = np.stack([sticks.first, sticks.second], axis=1).ravel()
    outward, offset = np.stack([u, -u], axis=1).reshape(-1, 3), np.repeat(offset, 2, axis=0)
    stick_radius, square = np.repeat(sticks.radius, 2), dot(offset, offset)
    radius = spheres.radius[sphere]
    joint = np.abs(radius - stick_radius) <= JOINT * radius
    reach = np.where(joint, 0.0, np.sqrt(np.maximum(radius**2 - square - stick_radius**2, 0.0)))
    aside = square > 0
    tilt = np.divide(1.0, reach, out=np.zeros_like(reach), where=aside & (reach > 0))
    m = outward + offset * tilt[:, None]
    return Ends(sphere, outward, offset, reach, m, reach + square * tilt, joint)


def _towards_eye(start: Floats, u: Floats, central: bool) -> tuple[Floats, Floats]:
    """Vectors from the axes towards the eye, at right angles to them, and how long they are."""
    toward = -start if central else np.tile([0.0, 0.0, 1.0], (len(start), 1))
    toward = toward - u * dot(toward, u)[:, None]
    return toward, np.sqrt(dot(toward, toward))


def _silhouette(
    start: Floats, u: Floats, toward: Floats, distance: Floats, radius: Floats, central: bool
) -> tuple[Floats, Floats, Floats]:
    """Normals of the lines on the right and left of the direction, and of the silhouette plane.

    ``n = (s/D) ŵ ± √(1 − s²/D²) ŵ × u`` with D ŵ from the axis to the eye; s/D is 0 where the eye is infinitely far.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        facing = toward / distance[:, None]
        share = radius / distance if central else np.zeros_like(radius)
        across = np.cross(facing, u) * np.sqrt(1.0 - share**2)[:, None]
    return facing * share[:, None] - across, facing * share[:, None] + across, facing


def _conditions(
    start: Floats, u: Floats, length: Floats, radius: Floats, right: Floats, left: Floats, facing: Floats, central: bool
) -> tuple[Floats, Floats]:
    """The five planes that bound what is behind Q, as normals (k, 5, 3) and offsets (k, 5) from the starts."""
    on_plane = radius * dot(right, facing)  # s²/D, or 0
    begin, end = (_end_plane(start, u, radius, right, left, at, central) for at in (np.zeros_like(length), length))
    planes = np.stack([-right, -left, -facing, begin, -end], axis=1)
    corner = radius[:, None] * right
    at = [-radius, -radius, -on_plane, dot(corner, begin), -dot(corner + length[:, None] * u, end)]
    return planes, np.stack(at, axis=1)


def _end_plane(
    start: Floats, u: Floats, radius: Floats, right: Floats, left: Floats, along: Floats, central: bool
) -> Floats:
    """Unit normals, in the sense of the axis, of the planes through the eye and a chord across Q."""
    one, other = (start + along[:, None] * u + radius[:, None] * normal for normal in (right, left))
    chord = other - one
    sight = one if central else np.tile([0.0, 0.0, -1.0], (len(start), 1))
    with np.errstate(invalid="ignore"):
        normal = np.cross(sight, chord)
        normal *= np.sign(dot(normal, u))[:, None] / np.sqrt(dot(normal, normal))[:, None]
    return np.asarray(normal)
