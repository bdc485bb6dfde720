"""Parallel and central projection: the few formulas in which they differ.

Everything is told in eye coordinates: view coordinates for a parallel projection along −z, and view coordinates with
the eye moved to the origin for a central one. Each projection defines for every sphere its *horizon* (the circle where
it turns away from the eye), its *nearness* (by which spheres are ordered from back to front, Halperin & Overmars
Theorem 5.1) and the *shadow* behind it: the part beyond the plane of the horizon of the cylinder or cone through it.
A sphere hides a point exactly when the point lies in its ball or in its shadow.
"""

from typing import NamedTuple, Protocol

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import PlaneArcs
from molviz.geometry.circles import Circles, circles_about
from molviz.model.spheres import Spheres
from molviz.vectors import dot
from molviz.visibility.view import View


class Linear(NamedTuple):
    """A function ``a cos θ + b sin θ + c`` on each of m circles."""

    a: Floats
    b: Floats
    c: Floats

    def at(self, angle: Floats) -> Floats:
        """Return the values at angles (m, …)."""
        a, b, c = (column.reshape(-1, *[1] * (angle.ndim - 1)) for column in self)
        return np.asarray(a * np.cos(angle) + b * np.sin(angle) + c)


class Quadratic(NamedTuple):
    """A function ``aa cos² θ + 2 ab cos θ sin θ + bb sin² θ + 2 a cos θ + 2 b sin θ + c`` on each of m circles."""

    aa: Floats
    ab: Floats
    bb: Floats
    a: Floats
    b: Floats
    c: Floats


class Projection(Protocol):
    """What the visibility algorithms ask of a projection; all points in eye coordinates."""

    def horizons(self, spheres: Spheres) -> Circles:
        """Return the n horizons, a × b towards the eye."""

    def nearness(self, spheres: Spheres) -> Floats:
        """Return the order of the spheres (n,), larger is nearer."""

    def horizon_margin(self, spheres: Spheres, horizons: Circles, own: Ints, other: Ints) -> Linear:
        """Return the function on horizon ``own`` (m,) that is positive where sphere ``other`` hides it."""

    def plane_margin(self, spheres: Spheres, circles: Circles, circle: Ints, sphere: Ints) -> Linear:
        """Return the function on the circles that is positive beyond the plane of the sphere's horizon."""

    def cone(self, spheres: Spheres, circles: Circles, circle: Ints, sphere: Ints) -> Quadratic:
        """Return the function on the circles that is negative inside the cylinder or cone through the horizon."""

    def surface(self, spheres: Spheres, sphere: Ints, page: Floats) -> Floats:
        """Return how near the sphere's surface lies at page points (m, 2), comparable at one point; −∞ beside it."""

    def surface_bounds(self, spheres: Spheres, sphere: Ints, low: Floats, side: float) -> tuple[Floats, Floats]:
        """Return bounds of ``surface`` over the square cells of the page whose lower left corners (m, 2) are given.

        The first is −∞ where the sphere does not cover all of the cell, the second where it misses it.
        """

    def page_points(self, points: Floats) -> Floats:
        """Return the images (m, 2) of points (m, 3)."""

    def page_arcs(self, circles: Circles, circle: Ints, start: Floats, sweep: Floats) -> PlaneArcs:
        """Return the images of arcs of circles."""

    def horizon_angle(self, spheres: Spheres, horizons: Circles, sphere: Ints, points: Floats) -> Floats:
        """Return the angle on the sphere's horizon at which the line of sight to each point (m, 3) touches it."""


def projection_of(view: View) -> Projection:
    """Return the projection that a view asks for."""
    return Parallel() if view.distance is None else Central(view.distance)


def images_of(circles: Circles, projection: Projection) -> PlaneArcs:
    """Return the images of whole circles (m,), as ellipses without a part of them named: their sweep is nought."""
    angle = np.zeros(len(circles.first))
    return projection.page_arcs(circles, np.arange(len(angle)), angle, angle)


def eye_coordinates(spheres: Spheres, view: View) -> Spheres:
    """Return the spheres in the coordinates that ``projection_of(view)`` works in."""
    seen = view.of(spheres)
    return seen if view.distance is None else Spheres(seen.center - [0.0, 0.0, view.distance], seen.radius)


def _angle_on(circles: Circles, circle: Ints, points: Floats) -> Floats:
    offset = points - circles.center[circle]
    return np.arctan2(dot(offset, circles.b[circle]), dot(offset, circles.a[circle]))


class Parallel:
    """The eye infinitely far up the z axis: horizons are great circles, shadows half-cylinders."""

    def horizons(self, spheres: Spheres) -> Circles:
        """Return the great circles at the height of the centres."""
        count = len(spheres.radius)
        up = np.tile([0.0, 0.0, 1.0], (count, 1))
        return circles_about(np.arange(count), np.full(count, -1), spheres.center, up, spheres.radius)

    def nearness(self, spheres: Spheres) -> Floats:
        """Return z of the centres."""
        return np.asarray(spheres.center[:, 2])

    def horizon_margin(self, spheres: Spheres, horizons: Circles, own: Ints, other: Ints) -> Linear:
        """Inside one disc: of radius rk if k is nearer (its shadow), else that of ball k cut at height zi."""
        toward = spheres.center[other] - spheres.center[own]
        below = np.minimum(toward[:, 2], 0.0)
        square = spheres.radius[other] ** 2 - below**2
        flat = toward[:, 0] ** 2 + toward[:, 1] ** 2
        toward[:, 2] = 0.0
        c = (square - flat - spheres.radius[own] ** 2) / 2
        return Linear(dot(horizons.a[own], toward), dot(horizons.b[own], toward), c)

    def plane_margin(self, spheres: Spheres, circles: Circles, circle: Ints, sphere: Ints) -> Linear:
        """``z_k − p_z``."""
        c = spheres.center[sphere, 2] - circles.center[circle, 2]
        return Linear(-circles.a[circle, 2], -circles.b[circle, 2], c)

    def cone(self, spheres: Spheres, circles: Circles, circle: Ints, sphere: Ints) -> Quadratic:
        """``|p⊥ − ck⊥|² − rk²``."""
        a, b = circles.a[circle, :2], circles.b[circle, :2]
        m = circles.center[circle, :2] - spheres.center[sphere, :2]
        return Quadratic(
            dot(a, a), dot(a, b), dot(b, b), dot(a, m), dot(b, m), dot(m, m) - spheres.radius[sphere] ** 2
        )

    def surface(self, spheres: Spheres, sphere: Ints, page: Floats) -> Floats:
        """``z_k + √(rk² − |p⊥ − ck⊥|²)``."""
        offset = page - spheres.center[sphere, :2]
        return self._height(spheres, sphere, spheres.radius[sphere] ** 2 - dot(offset, offset))

    def surface_bounds(self, spheres: Spheres, sphere: Ints, low: Floats, side: float) -> tuple[Floats, Floats]:
        """The heights above the cell's farthest and nearest point from the centre: a hemisphere falls outwards."""
        offset = np.abs(low + side / 2 - spheres.center[sphere, :2])
        square = spheres.radius[sphere] ** 2
        return (
            self._height(spheres, sphere, square - np.sum((offset + side / 2) ** 2, axis=1)),
            self._height(spheres, sphere, square - np.sum(np.maximum(offset - side / 2, 0.0) ** 2, axis=1)),
        )

    def _height(self, spheres: Spheres, sphere: Ints, square: Floats) -> Floats:
        with np.errstate(invalid="ignore"):
            return np.where(square >= 0, spheres.center[sphere, 2] + np.sqrt(square), -np.inf)

    def page_points(self, points: Floats) -> Floats:
        """Drop z."""
        return points[:, :2]

    def page_arcs(self, circles: Circles, circle: Ints, start: Floats, sweep: Floats) -> PlaneArcs:
        """Drop z."""
        center, a, b = (column[circle, :2] for column in (circles.center, circles.a, circles.b))
        return PlaneArcs(center, a, b, start, sweep)

    def horizon_angle(self, spheres: Spheres, horizons: Circles, sphere: Ints, points: Floats) -> Floats:
        """The angle below which the point lies."""
        return _angle_on(horizons, sphere, points)


class Central(NamedTuple):
    """The eye at the origin, looking down −z; the page lies at ``distance``, where lengths keep their size.

    D is the distance of a sphere's centre from the eye and L = √(D² − r²) that of its horizon, all of which lies
    equally far. Points of the sphere obey ``|p|² = 2 p·c − L²``; along one line of sight the product of the distances
    at which it enters and leaves the ball is L², so that −L orders spheres from back to front.
    """

    distance: float

    def _tangent(self, spheres: Spheres) -> Floats:
        return np.asarray(np.sqrt(dot(spheres.center, spheres.center) - spheres.radius**2))

    def horizons(self, spheres: Spheres) -> Circles:
        """Circles of radius r L / D about c L² / D²."""
        far = np.linalg.norm(spheres.center, axis=1)
        tangent = self._tangent(spheres)
        count = len(far)
        center = spheres.center * (tangent / far)[:, None] ** 2
        axis = -spheres.center / far[:, None]
        return circles_about(np.arange(count), np.full(count, -1), center, axis, spheres.radius * tangent / far)

    def nearness(self, spheres: Spheres) -> Floats:
        """Return −L."""
        return -self._tangent(spheres)

    def horizon_margin(self, spheres: Spheres, horizons: Circles, own: Ints, other: Ints) -> Linear:
        """``p · ck − Li Lk`` where k is nearer (inside its cone), else ``p · ck − (Li² + Lk²)/2`` (inside its ball).

        Written with differences, as all terms but these are as large as the eye is far: with ``Δ = ck − ci`` and
        ``H = (Lk² − Li²)/2``, ``p · ck = Li² + p · Δ`` on horizon i, so the second is ``p · Δ − H``, of which the
        constant part is ``−Δ · (Δ/2 + ci ri²/Di²) + (rk² − ri²)/2``, and the first is greater by ``(Lk − Li)²/2``.
        """
        tangent = self._tangent(spheres)
        center, toward = spheres.center[own], spheres.center[other] - spheres.center[own]
        square, other_square = spheres.radius[own] ** 2, spheres.radius[other] ** 2
        shift = toward / 2 + center * (square / dot(center, center))[:, None]
        ball = (other_square - square) / 2 - dot(toward, shift)
        half = (dot(toward, center + spheres.center[other]) - (other_square - square)) / 2
        step = 2 * half / (tangent[own] + tangent[other])
        constant = ball + np.where(half < 0, step**2 / 2, 0.0)
        return Linear(dot(horizons.a[own], toward), dot(horizons.b[own], toward), constant)

    def plane_margin(self, spheres: Spheres, circles: Circles, circle: Ints, sphere: Ints) -> Linear:
        """``p · ck − Lk²``."""
        c = spheres.center[sphere]
        square = dot(c, c) - spheres.radius[sphere] ** 2
        return Linear(
            dot(circles.a[circle], c), dot(circles.b[circle], c), dot(circles.center[circle], c) - square
        )

    def cone(self, spheres: Spheres, circles: Circles, circle: Ints, sphere: Ints) -> Quadratic:
        """``|p|² Lk² − (p · ck)²``, as ``|(p − ck) × ck|² − rk² |p|²``, in which nothing large cancels."""
        c, square = spheres.center[sphere], spheres.radius[sphere] ** 2
        parts = (circles.a[circle], circles.b[circle], circles.center[circle])
        across = [np.cross(part, c) for part in (parts[0], parts[1], parts[2] - c)]

        def form(i: int, j: int) -> Floats:
            return np.asarray(dot(across[i], across[j]) - square * dot(parts[i], parts[j]))

        return Quadratic(form(0, 0), form(0, 1), form(1, 1), form(0, 2), form(1, 2), form(2, 2))

    def surface(self, spheres: Spheres, sphere: Ints, page: Floats) -> Floats:
        """Minus the distance ``p·ĉ D − √(r² − D² sin²)`` at which the line of sight enters the ball."""
        ray = np.column_stack([page, np.full(len(page), -self.distance)])
        ray /= np.linalg.norm(ray, axis=1)[:, None]
        c = spheres.center[sphere]
        along, beside = dot(ray, c), np.cross(ray, c)
        square = spheres.radius[sphere] ** 2 - dot(beside, beside)
        with np.errstate(invalid="ignore"):
            return np.where(square >= 0, np.sqrt(square) - along, -np.inf)

    def surface_bounds(self, spheres: Spheres, sphere: Ints, low: Floats, side: float) -> tuple[Floats, Floats]:
        """The farthest of the four corners, as distance grows with the angle from the axis; and r − D."""
        corners = [self.surface(spheres, sphere, low + [x, y]) for x in (0.0, side) for y in (0.0, side)]
        far = np.linalg.norm(spheres.center, axis=1)
        return np.min(corners, axis=0), (spheres.radius - far)[sphere]

    def page_points(self, points: Floats) -> Floats:
        """``(x, y) · distance / −z``."""
        return np.asarray(points[:, :2] * (self.distance / -points[:, 2])[:, None])

    def page_arcs(self, circles: Circles, circle: Ints, start: Floats, sweep: Floats) -> PlaneArcs:
        """The image of a circle is an ellipse, run through at another pace.

        With τ measured from where the circle is deepest, depth is ``w (1 + e cos τ)`` and the image
        ``(X0 + X1 cos τ + X2 sin τ) / w (1 + e cos τ)``. The substitution of Kepler's anomalies,
        ``cos t = (cos τ + e)/(1 + e cos τ)``, makes it ``c + u cos t + v sin t``.
        """
        center, a, b = circles.center[circle], circles.a[circle], circles.b[circle]
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

    def horizon_angle(self, spheres: Spheres, horizons: Circles, sphere: Ints, points: Floats) -> Floats:
        """The angle at which the line through the eye and the point touches the sphere."""
        far = np.linalg.norm(points, axis=1)
        touching = points * (self._tangent(spheres)[sphere] / far)[:, None]
        return _angle_on(horizons, sphere, touching)


def _eccentric(angle: Floats, e: Floats) -> Floats:
    """t(τ) with ``cos t = (cos τ + e)/(1 + e cos τ)``, increasing and with t(τ + 2π) = t(τ) + 2π.

    ``tan(t/2) = √((1 − e)/(1 + e)) tan(τ/2)``, written as a small correction of τ.
    """
    beta = e / (1 + np.sqrt(1 - e**2))
    return np.asarray(angle - 2 * np.arctan2(beta * np.sin(angle), 1 + beta * np.cos(angle)))
