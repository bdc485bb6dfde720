"""Circles in space, ``p(θ) = center + a cos θ + b sin θ`` with perpendicular a, b as long as the radius."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.model.spheres import Spheres
from molviz.vectors import length


class Circles(NamedTuple):
    """m circles on spheres; ``a × b`` points from the centre of ``first`` towards that of ``second``."""

    first: Ints  # (m,)
    second: Ints  # (m,)
    center: Floats  # (m, 3)
    a: Floats  # (m, 3)
    b: Floats  # (m, 3)

    def at(self, circle: Ints, angle: Floats) -> Floats:
        """Return the points (k, 3) at the given angles of the given circles."""
        return self.center[circle] + self.spoke(circle, angle)

    def spoke(self, circle: Ints, angle: Floats) -> Floats:
        """Return the same points relative to the circles' centres."""
        return self.a[circle] * np.cos(angle)[:, None] + self.b[circle] * np.sin(angle)[:, None]

    def take(self, rows: Ints) -> "Circles":
        """Return the given circles, in that order."""
        center, a, b = (vector.take(rows, axis=0) for vector in (self.center, self.a, self.b))
        return Circles(self.first[rows], self.second[rows], center, a, b)


class CircleArcs(NamedTuple):
    """k arcs of numbered circles, ordered by circle and start.

    ``before`` and ``after`` are the spheres at which an arc starts and ends, those that cover the circle there;
    −1 where it is a whole circle.
    """

    circle: Ints  # (k,)
    start: Floats  # (k,) radians in [0, 2π)
    sweep: Floats  # (k,) radians in (0, 2π]
    before: Ints  # (k,)
    after: Ints  # (k,)

    def take(self, rows: Ints | Bools) -> "CircleArcs":
        """Return the given rows, in that order."""
        return CircleArcs(self.circle[rows], self.start[rows], self.sweep[rows], self.before[rows], self.after[rows])


def perpendicular(axis: Floats) -> tuple[Floats, Floats]:
    """Return unit vectors e, f (m, 3) so that e, f and the given unit axes form right-handed frames.

    The frame of Duff et al. 2017, "Building an orthonormal basis, revisited": smooth but for one pole each.
    """
    x, y, z = axis.T
    sign = np.where(z >= 0, 1.0, -1.0)
    p = -1.0 / (sign + z)
    q = x * y * p
    e = np.stack([1.0 + sign * x * x * p, sign * q, -sign * x], axis=1)
    f = np.stack([q, sign + y * y * p, -y], axis=1)
    return e, f


def circles_about(first: Ints, second: Ints, center: Floats, axis: Floats, radius: Floats) -> Circles:
    """Return circles of the given centres (m, 3), unit axes (m, 3) and radii (m,)."""
    e, f = perpendicular(axis)
    return Circles(first, second, center, e * radius[:, None], f * radius[:, None])


def radical_planes(spheres: Spheres, first: Ints, second: Ints) -> tuple[Floats, Floats]:
    """Return the axis (m, 3) from ci to cj and ``t = (d² + ri² − rj²) / 2d``, how far along it the spheres meet."""
    between = spheres.center.take(second, axis=0) - spheres.center.take(first, axis=0)
    distance = length(between)
    own, other = spheres.radius.take(first), spheres.radius.take(second)
    return between / distance[:, None], (distance + (own - other) * (own + other) / distance) / 2


def creases(spheres: Spheres, first: Ints, second: Ints) -> tuple[Circles, Ints]:
    """Return the circles in which the given pairs of spheres meet, and the pairs' rows that do meet in one.

    Their radius is ``√(ri² − t²)``. Pairs that are nested or concentric have no circle.
    """
    distance = length(spheres.center.take(second, axis=0) - spheres.center.take(first, axis=0))
    own, other = spheres.radius[first], spheres.radius[second]
    rows = np.flatnonzero((distance > np.abs(own - other)) & (distance < own + other))
    axis, along = radical_planes(spheres, first[rows], second[rows])
    radius = np.sqrt(np.maximum((own[rows] - along) * (own[rows] + along), 0.0))
    center = spheres.center.take(first[rows], axis=0) + axis * along[:, None]
    return circles_about(first[rows], second[rows], center, axis, radius), rows
