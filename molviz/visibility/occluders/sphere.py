"""Spheres as occluders, in eye coordinates.

Each sphere has a *horizon* (the circle where it turns away from the eye), a *nearness* (by which spheres are ordered
from back to front, Halperin & Overmars Theorem 5.1) and an *occlusion*: the part beyond the plane of the horizon of the
cylinder or cone through it. A sphere hides a point exactly when the point lies in its ball or in its occlusion.
"""

from typing import NamedTuple, Protocol

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.geometry.circles import circles_about
from molviz.model.spheres import Spheres
from molviz.vectors import dot, length
from molviz.visibility.curves import Curves, horizons_of
from molviz.visibility.forms import Linear, Quadratic


class SphereOccluders(Protocol):
    """What the visibility algorithms ask of n spheres; functions on curves are those of ``forms``."""

    @property
    def spheres(self) -> Spheres:
        """The spheres, in eye coordinates."""

    def take(self, rows: Ints) -> "SphereOccluders":
        """Return the given spheres, in that order."""

    def horizons(self) -> Curves:
        """Return the n horizons, a × b towards the eye."""

    def nearness(self) -> Floats:
        """Return the order of the spheres (n,), larger is nearer."""

    def nearest_points(self) -> Floats:
        """Return how near the nearest points of the spheres (n,) lie, no less than ``surface`` anywhere."""

    def horizon_margin(self, horizons: Curves, own: Ints, other: Ints) -> Linear:
        """Return the function on horizon ``own`` (m,) that is positive where sphere ``other`` hides it."""

    def plane_margin(self, curves: Curves, curve: Ints, sphere: Ints) -> Linear:
        """Return the function on the curves that is positive beyond the plane of the sphere's horizon."""

    def cone(self, curves: Curves, curve: Ints, sphere: Ints) -> Quadratic:
        """Return the function on the curves that is negative inside the cylinder or cone through the horizon."""

    def surface(self, sphere: Ints, page: Floats) -> Floats:
        """Return how near the sphere's surface lies at page points (m, 2), comparable at one point; −∞ beside it."""

    def surface_bounds(self, sphere: Ints, low: Floats, side: float) -> tuple[Floats, Floats]:
        """Return bounds of ``surface`` over the square cells of the page whose lower left corners (m, 2) are given.

        The first is −∞ where the sphere does not cover all of the cell, the second where it misses it.
        """

    def horizon_angle(self, horizons: Curves, sphere: Ints, points: Floats) -> Floats:
        """Return the angle on the sphere's horizon at which the line of sight to each point (m, 3) touches it."""


def _angle_on(curves: Curves, curve: Ints, points: Floats) -> Floats:
    offset = points - curves.center.take(curve, axis=0)
    return np.arctan2(dot(offset, curves.b.take(curve, axis=0)), dot(offset, curves.a.take(curve, axis=0)))


class ParallelSpheres(NamedTuple):
    """The eye infinitely far up the z axis: horizons are great circles, occlusions half-cylinders."""

    spheres: Spheres

    def take(self, rows: Ints) -> "ParallelSpheres":
        """Return the given spheres, in that order."""
        return ParallelSpheres(self.spheres.take(rows))

    def horizons(self) -> Curves:
        """Return the great circles at the height of the centres."""
        number = np.arange(len(self.spheres.radius))
        up = np.tile([0.0, 0.0, 1.0], (len(number), 1))
        return horizons_of(circles_about(number, number, self.spheres.center, up, self.spheres.radius))

    def nearness(self) -> Floats:
        """Return z of the centres."""
        return np.asarray(self.spheres.center[:, 2])

    def nearest_points(self) -> Floats:
        """Return z of the tops."""
        return np.asarray(self.spheres.center[:, 2] + self.spheres.radius)

    def horizon_margin(self, horizons: Curves, own: Ints, other: Ints) -> Linear:
        """Inside one disc: of radius rk if k is nearer (its occlusion), else that of ball k cut at height zi."""
        center, radius = self.spheres
        toward = center.take(other, axis=0) - center.take(own, axis=0)
        below = np.minimum(toward[:, 2], 0.0)
        square = radius[other] ** 2 - below**2
        flat = toward[:, 0] ** 2 + toward[:, 1] ** 2
        toward[:, 2] = 0.0
        c = (square - flat - radius[own] ** 2) / 2
        return Linear(dot(horizons.a.take(own, axis=0), toward), dot(horizons.b.take(own, axis=0), toward), c)

    def plane_margin(self, curves: Curves, curve: Ints, sphere: Ints) -> Linear:
        """``z_k − p_z``."""
        c = self.spheres.center[sphere, 2] - curves.center[curve, 2]
        return Linear(-curves.a[curve, 2], -curves.b[curve, 2], c)

    def cone(self, curves: Curves, curve: Ints, sphere: Ints) -> Quadratic:
        """``|p⊥ − ck⊥|² − rk²``."""
        a, b = curves.a.take(curve, axis=0)[:, :2], curves.b.take(curve, axis=0)[:, :2]
        m = curves.center.take(curve, axis=0)[:, :2] - self.spheres.center.take(sphere, axis=0)[:, :2]
        c = dot(m, m) - self.spheres.radius[sphere] ** 2
        return Quadratic(dot(a, a), dot(a, b), dot(b, b), dot(a, m), dot(b, m), c)

    def surface(self, sphere: Ints, page: Floats) -> Floats:
        """``z_k + √(rk² − |p⊥ − ck⊥|²)``."""
        offset = page - self.spheres.center.take(sphere, axis=0)[:, :2]
        return self._height(sphere, self.spheres.radius[sphere] ** 2 - dot(offset, offset))

    def surface_bounds(self, sphere: Ints, low: Floats, side: float) -> tuple[Floats, Floats]:
        """The heights above the cell's farthest and nearest point from the centre: a hemisphere falls outwards."""
        offset = np.abs(low + side / 2 - self.spheres.center.take(sphere, axis=0)[:, :2])
        square = self.spheres.radius[sphere] ** 2
        return (
            self._height(sphere, square - np.sum((offset + side / 2) ** 2, axis=1)),
            self._height(sphere, square - np.sum(np.maximum(offset - side / 2, 0.0) ** 2, axis=1)),
        )

    def _height(self, sphere: Ints, square: Floats) -> Floats:
        with np.errstate(invalid="ignore"):
            return np.where(square >= 0, self.spheres.center[sphere, 2] + np.sqrt(square), -np.inf)

    def horizon_angle(self, horizons: Curves, sphere: Ints, points: Floats) -> Floats:
        """The angle below which the point lies."""
        return _angle_on(horizons, sphere, points)


class CentralSpheres(NamedTuple):
    """The eye at the origin, looking down −z at a page at ``distance``.

    D is the distance of a sphere's centre from the eye and L = √(D² − r²) that of its horizon, all of which lies
    equally far. Points of the sphere obey ``|p|² = 2 p·c − L²``; along one line of sight the product of the distances
    at which it enters and leaves the ball is L², so that −L orders spheres from back to front.
    """

    spheres: Spheres
    distance: float

    def take(self, rows: Ints) -> "CentralSpheres":
        """Return the given spheres, in that order."""
        return CentralSpheres(self.spheres.take(rows), self.distance)

    def _tangent(self) -> Floats:
        center, radius = self.spheres
        return np.asarray(np.sqrt(dot(center, center) - radius**2))

    def horizons(self) -> Curves:
        """Circles of radius r L / D about c L² / D²."""
        far = length(self.spheres.center)
        tangent, number = self._tangent(), np.arange(len(far))
        center = self.spheres.center * (tangent / far)[:, None] ** 2
        axis = -self.spheres.center / far[:, None]
        return horizons_of(circles_about(number, number, center, axis, self.spheres.radius * tangent / far))

    def nearness(self) -> Floats:
        """Return −L."""
        return -self._tangent()

    def nearest_points(self) -> Floats:
        """Return r − D."""
        return np.asarray(self.spheres.radius - length(self.spheres.center))

    def horizon_margin(self, horizons: Curves, own: Ints, other: Ints) -> Linear:
        """``p · ck − Li Lk`` where k is nearer (inside its cone), else ``p · ck − (Li² + Lk²)/2`` (inside its ball).

        Written with differences, as all terms but these are as large as the eye is far: with ``Δ = ck − ci`` and
        ``H = (Lk² − Li²)/2``, ``p · ck = Li² + p · Δ`` on horizon i, so the second is ``p · Δ − H``, of which the
        constant part is ``−Δ · (Δ/2 + ci ri²/Di²) + (rk² − ri²)/2``, and the first is greater by ``(Lk − Li)²/2``.
        """
        tangent, (centers, radii) = self._tangent(), self.spheres
        center, toward = centers[own], centers[other] - centers[own]
        square, other_square = radii[own] ** 2, radii[other] ** 2
        shift = toward / 2 + center * (square / dot(center, center))[:, None]
        ball = (other_square - square) / 2 - dot(toward, shift)
        half = (dot(toward, center + centers[other]) - (other_square - square)) / 2
        step = 2 * half / (tangent[own] + tangent[other])
        constant = ball + np.where(half < 0, step**2 / 2, 0.0)
        return Linear(dot(horizons.a.take(own, axis=0), toward), dot(horizons.b.take(own, axis=0), toward), constant)

    def plane_margin(self, curves: Curves, curve: Ints, sphere: Ints) -> Linear:
        """``p · ck − Lk²``."""
        c = self.spheres.center.take(sphere, axis=0)
        square = dot(c, c) - self.spheres.radius[sphere] ** 2
        m, a, b = (dot(column.take(curve, axis=0), c) for column in curves[3:])
        return Linear(a, b, m - square)

    def cone(self, curves: Curves, curve: Ints, sphere: Ints) -> Quadratic:
        """``|p|² Lk² − (p · ck)²``, as ``|(p − ck) × ck|² − rk² |p|²``, in which nothing large cancels."""
        c, square = self.spheres.center.take(sphere, axis=0), self.spheres.radius[sphere] ** 2
        parts = (curves.a.take(curve, axis=0), curves.b.take(curve, axis=0), curves.center.take(curve, axis=0))
        across = [np.cross(part, c) for part in (parts[0], parts[1], parts[2] - c)]

        def form(i: int, j: int) -> Floats:
            return np.asarray(dot(across[i], across[j]) - square * dot(parts[i], parts[j]))

        return Quadratic(form(0, 0), form(0, 1), form(1, 1), form(0, 2), form(1, 2), form(2, 2))

    def surface(self, sphere: Ints, page: Floats) -> Floats:
        """Minus the distance ``p·ĉ D − √(r² − D² sin²)`` at which the line of sight enters the ball."""
        ray = np.column_stack([page, np.full(len(page), -self.distance)])
        ray /= length(ray)[:, None]
        c = self.spheres.center.take(sphere, axis=0)
        along, beside = dot(ray, c), np.cross(ray, c)
        square = self.spheres.radius[sphere] ** 2 - dot(beside, beside)
        with np.errstate(invalid="ignore"):
            return np.where(square >= 0, np.sqrt(square) - along, -np.inf)

    def surface_bounds(self, sphere: Ints, low: Floats, side: float) -> tuple[Floats, Floats]:
        """The farthest of the four corners, as distance grows with the angle from the axis; and r − D."""
        corners = [self.surface(sphere, low + [x, y]) for x in (0.0, side) for y in (0.0, side)]
        return np.min(corners, axis=0), self.nearest_points()[sphere]

    def horizon_angle(self, horizons: Curves, sphere: Ints, points: Floats) -> Floats:
        """The angle at which the line through the eye and the point touches the sphere."""
        far = length(points)
        touching = points * (self._tangent()[sphere] / far)[:, None]
        return _angle_on(horizons, sphere, touching)
