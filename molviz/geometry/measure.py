"""Exact area and volume of a union of balls by contour integrals (Džurina & Plavka 2008).

What the free part of a sphere has of area and flux, by the arcs that bound it, is derived in ``rims``.

*The volume.* The paper integrates the field (0, 0, z), for which the poles of all spheres must be in one direction and
J3 is needed. (In its equation (10) the terms ``(z + r) / 2`` should read ``(z + r) / 16r³``, and in the line of curve
integrals ``8r⁴ (z + r)``; the whole plane gives 4/3 πr³ with the weight 128r⁷, not 16r⁴.) The field x / 3 leaves each
sphere its own pole and needs J1 and J2 only: ``V = ⅓ Σ (r_i A_i + c_i · N_i)`` with ``N_i = r_i² ∫ n dA``.

*Derivatives.* Moving ball i changes the volume by N_i and the area through the creases: with β the angle between the
two normals at a crease and ν the direction on sphere i into the cap, ``∂A/∂c_i = −Σ ∫ (n tan(β / 2) + ν) dl``.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.boundary import BLOCK_PAIRS, Boundary, free_spheres, union_boundary
from molviz.geometry.rims import Rims, opposite_poles, rims_of, totals, twice_j1, unit_flux
from molviz.geometry.rows import blocks, expand
from molviz.geometry.slabs import slabs
from molviz.model.spheres import Spheres
from molviz.threads import in_threads
from molviz.vectors import dot, length


class Measure(NamedTuple):
    """Area and volume of a union of n balls, and how they change when a ball moves."""

    area: Floats  # (n,) Å², of each sphere outside all other balls
    volume: float  # Å³
    area_gradient: Floats  # (n, 3) Å, of the whole area by each centre
    volume_gradient: Floats  # (n, 3) Å², of the volume by each centre

    def __repr__(self) -> str:
        return f"<Measure of {len(self.area)} balls: area {self.area.sum():.3f} Å², volume {self.volume:.3f} Å³>"


def measure_spheres(spheres: Spheres) -> Measure:
    """Return the exact area and volume of the union of n balls (Džurina & Plavka 2008); see above.

    Equal, nested, tangent and coincident spheres are allowed; ``boundary`` says how they are decided. Spheres of
    which no arc is free are free where nothing touches them, and buried otherwise. Many balls are measured slab by
    slab, each together with all that its own can meet, which changes no digit.
    """
    count = len(spheres.radius)
    area, flux, gradient = np.zeros(count), np.zeros((count, 3)), np.zeros((count, 3))
    for rows, own in slabs(spheres):
        found = _of_boundary(union_boundary(spheres.take(rows)))
        for total, part in zip((area, flux, gradient), found, strict=True):
            total[rows[own]] = part[own]
    return Measure(area, _volume(spheres, area, flux), gradient, flux)


def _of_boundary(boundary: Boundary) -> tuple[Floats, Floats, Floats]:
    """Area (n,) and flux (n, 3) of each ball, and the gradient (n, 3) of the whole area by its centre."""
    spheres, sides = boundary.spheres, rims_of(boundary)
    order = np.argsort(sides.sphere, kind="stable")
    rims, fold = sides.take(order), np.repeat(_fold(boundary), 2)[order]
    area = spheres.radius**2 * _unit_area(boundary, rims)
    flux = spheres.radius[:, None] ** 2 * totals(rims.sphere, unit_flux(rims), len(area))
    return area, flux, _area_gradient(spheres, rims, fold)


def _fold(boundary: Boundary) -> Floats:
    """``tan(β / 2)`` of each arc's crease, (k,), β the angle between the two normals."""
    spheres, circle = boundary.spheres, boundary.arcs.circle
    first, second = boundary.circles.first[circle], boundary.circles.second[circle]
    own, other = spheres.radius[first], spheres.radius[second]
    square = np.sum((spheres.center[second] - spheres.center[first]) ** 2, axis=1)
    return np.asarray(np.sqrt((square - (own - other) ** 2) / ((own + other) ** 2 - square)))


def _unit_area(boundary: Boundary, rims: Rims) -> Floats:
    """``4π [the pole is free] + Σ 2 J1`` of each sphere; 4π or 0 for spheres without arcs."""
    count = len(boundary.spheres.radius)
    area = np.where(free_spheres(boundary), 4 * np.pi, 0.0)
    bounded, opposite = opposite_poles(rims)
    area[bounded[_free(boundary, bounded, -opposite)]] = 4 * np.pi
    toward = np.zeros((count, 3))
    toward[bounded] = opposite
    return area + np.bincount(rims.sphere, twice_j1(rims, toward[rims.sphere]), count)


def _free(boundary: Boundary, sphere: Ints, direction: Floats) -> Bools:
    """Whether the point of each given sphere in the given direction lies outside all other balls."""
    begin, end = boundary.crossing.start[sphere], boundary.crossing.start[sphere + 1]

    def free(block: slice) -> Bools:
        return _outside(boundary, sphere[block], direction[block], begin[block], end[block])

    return np.concatenate([np.empty(0, dtype=bool), *in_threads(free, blocks(end - begin, BLOCK_PAIRS))])


def _outside(boundary: Boundary, sphere: Ints, direction: Floats, begin: Ints, end: Ints) -> Bools:
    """The same of some spheres, whose neighbours have the rows ``begin`` to ``end``."""
    spheres = boundary.spheres
    point = spheres.center.take(sphere, axis=0) + spheres.radius[sphere][:, None] * direction
    row, entry = expand(begin, end)
    ball = boundary.crossing.item.take(entry)
    distance = length(point.take(row, axis=0) - spheres.center.take(ball, axis=0))
    covered = distance < spheres.radius.take(ball)
    return np.asarray(np.bincount(row[covered], minlength=len(sphere)) == 0)


def _volume(spheres: Spheres, area: Floats, flux: Floats) -> float:
    """``⅓ Σ (r_i A_i + c_i · N_i)``; the N_i add up to nothing, so any origin serves, and the middle best."""
    center = spheres.center - np.sum(spheres.center, axis=0) / max(len(area), 1)
    return float(np.sum(spheres.radius * area + dot(center, flux)) / 3)


def _area_gradient(spheres: Spheres, rims: Rims, fold: Floats) -> Floats:
    """Over an arc of length 2δρ: ``∫ n dl = 2ρ (δ h k + s sin δ m)``, ``∫ ν dl = 2ρ (δ s k − h sin δ m)``."""
    by_axis = rims.half * (fold * rims.cosine + rims.sine)
    by_middle = np.sin(rims.half) * (fold * rims.sine - rims.cosine)
    pull = by_axis[:, None] * rims.axis + by_middle[:, None] * rims.middle
    length = 2 * spheres.radius[rims.sphere] * rims.sine
    return totals(rims.sphere, -length[:, None] * pull, len(spheres.radius))
