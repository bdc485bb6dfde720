"""Parallel and central projection: where the points and the curves of space lie on the page, and how near they are.

Points are told in eye coordinates: view coordinates for a parallel projection along −z, and view coordinates with the
eye moved to the origin for a central one. What hides what is the matter of ``occluders``.
"""

from typing import NamedTuple, Protocol

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import PlaneArcs
from molviz.model.spheres import Spheres
from molviz.vectors import dot, length
from molviz.visibility.curves import LINE, Curves


class Projection(Protocol):
    """What the visibility algorithms ask of a projection."""

    @property
    def keeps_circles(self) -> bool:
        """Whether the outline of every sphere is a circle."""

    def nearness(self, points: Floats) -> Floats:
        """Return how near points (m, 3) are to the eye, comparable along one line of sight."""

    def page_points(self, points: Floats) -> Floats:
        """Return the images (m, 2) of points (m, 3)."""

    def page_arcs(self, curves: Curves, curve: Ints, start: Floats, sweep: Floats) -> PlaneArcs:
        """Return the images of arcs of circles and ellipses."""

    def rays(self, page: Floats) -> tuple[Floats, Floats]:
        """Return where the lines of sight through page points (m, 2) begin, and their unit directions (m, 3).

        How far along it a point lies is minus its nearness.
        """

    def receded(self, spheres: Spheres, by: float) -> Spheres:
        """Return the spheres farther from the eye by a length, with the same images."""


class Parallel:
    """The eye infinitely far up the z axis."""

    keeps_circles = True

    def nearness(self, points: Floats) -> Floats:
        """Return z."""
        return np.asarray(points[:, 2])

    def page_points(self, points: Floats) -> Floats:
        """Drop z."""
        return points[:, :2]

    def page_arcs(self, curves: Curves, curve: Ints, start: Floats, sweep: Floats) -> PlaneArcs:
        """Drop z."""
        center, a, b = (column[curve, :2] for column in (curves.center, curves.a, curves.b))
        return PlaneArcs(center, a, b, start, sweep)

    def rays(self, page: Floats) -> tuple[Floats, Floats]:
        """Down the z axis, from z = 0."""
        level = np.zeros(len(page))
        return np.column_stack([page, level]), np.column_stack([0.0 * page, level - 1.0])

    def receded(self, spheres: Spheres, by: float) -> Spheres:
        """Lower z."""
        return Spheres(spheres.center - [0.0, 0.0, by], spheres.radius)


class Central(NamedTuple):
    """The eye at the origin, looking down −z; the page lies at ``distance``, where lengths keep their size."""

    distance: float

    @property
    def keeps_circles(self) -> bool:
        """Spheres beside the axis are seen as ellipses."""
        return False

    def nearness(self, points: Floats) -> Floats:
        """Return minus the distance from the eye."""
        return np.asarray(-length(points))

    def page_points(self, points: Floats) -> Floats:
        """``(x, y) · distance / −z``."""
        return np.asarray(points[:, :2] * (self.distance / -points[:, 2])[:, None])

    def page_arcs(self, curves: Curves, curve: Ints, start: Floats, sweep: Floats) -> PlaneArcs:
        """The image of a circle is an ellipse, run through at another pace.

        With τ measured from where the circle is deepest, depth is ``w (1 + e cos τ)`` and the image
        ``(X0 + X1 cos τ + X2 sin τ) / w (1 + e cos τ)``. The substitution of Kepler's anomalies,
        ``cos t = (cos τ + e)/(1 + e cos τ)``, makes it ``c + u cos t + v sin t``.
        """
        center, a, b = curves.center[curve], curves.a[curve], curves.b[curve]
        deepest = np.arctan2(-b[:, 2], -a[:, 2])
        cosine, sine = np.cos(deepest)[:, None], np.sin(deepest)[:, None]
        x1, x2 = a * cosine + b * sine, b * cosine - a * sine
        w, e = -center[:, 2], (x1[:, 2] / center[:, 2])[:, None]
        scale = (self.distance / w)[:, None]
        c = scale * (center - e * x1)[:, :2] / (1 - e**2)
        u = scale * (x1 - e * center)[:, :2] / (1 - e**2)
        v = scale * x2[:, :2] / np.sqrt(1 - e**2)
        first, last = (_eccentric(angle - deepest, e[:, 0]) for angle in (start, start + sweep))
        return PlaneArcs(c, u, v, first, last - first)

    def rays(self, page: Floats) -> tuple[Floats, Floats]:
        """From the eye."""
        ray = np.column_stack([page, np.full(len(page), -self.distance)])
        return np.zeros_like(ray), ray / np.linalg.norm(ray, axis=1)[:, None]

    def receded(self, spheres: Spheres, by: float) -> Spheres:
        """Scale about the eye."""
        factor = 1.0 + by / length(spheres.center)
        return Spheres(spheres.center * factor[:, None], spheres.radius * factor)


def _eccentric(angle: Floats, e: Floats) -> Floats:
    """t(τ) with ``cos t = (cos τ + e)/(1 + e cos τ)``, increasing and with t(τ + 2π) = t(τ) + 2π.

    ``tan(t/2) = √((1 − e)/(1 + e)) tan(τ/2)``, written as a small correction of τ.
    """
    beta = e / (1 + np.sqrt(1 - e**2))
    return np.asarray(angle - 2 * np.arctan2(beta * np.sin(angle), 1 + beta * np.cos(angle)))


def arcs_on_page(curves: Curves, curve: Ints, start: Floats, sweep: Floats, projection: Projection) -> PlaneArcs:
    """Return the images of arcs of curves; of a line ``c + u cos t``, all arcs of one with the same c and u.

    Where t is π/3 and 2π/3 are the images of the line's ends.
    """
    arcs = projection.page_arcs(curves, curve, start, sweep)
    rows = np.flatnonzero(curves.kind[curve] == LINE)
    if not len(rows):
        return arcs
    line = curve[rows]
    angles = (np.full(len(rows), np.pi / 3), np.full(len(rows), 2 * np.pi / 3), start[rows], (start + sweep)[rows])
    first, last, begin, end = (projection.page_points(curves.at(line, angle)) for angle in angles)
    c, u = (first + last) / 2, first - last
    begins, ends = (np.arccos(np.clip(dot(point - c, u) / dot(u, u), -1.0, 1.0)) for point in (begin, end))
    for column, values in zip(arcs, (c, u, np.zeros_like(u), begins, ends - begins), strict=True):
        column[rows] = values
    return arcs


def images_of(curves: Curves, projection: Projection) -> PlaneArcs:
    """Return the images of whole curves (m,), as ellipses without a part of them named: their sweep is nought."""
    angle = np.zeros(len(curves.first))
    return projection.page_arcs(curves, np.arange(len(angle)), angle, angle)
