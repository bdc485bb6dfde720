"""Exact area and volume of a union of balls by contour integrals (Džurina & Plavka 2008).

The free part H of a sphere is projected from a pole onto the tangent plane at the opposite point g (here g is a unit
vector and the sphere has radius 1; t, s are coordinates along two axes right-handed with g, ``w = t² + s² + 4``):

    n · g = 8 / w − 1,    dA = 16 / w² dt ds.

Green's theorem turns integrals over the image Ω into ``J_k = ∮ (t ds − s dt) / w^k`` with Ω on the left; as the curl
of ``(t ds − s dt) / w^k`` is ``2 (1 − k) / w^k + 8k / w^(k+1)``,

    area of H = 2 J1  (+ 4π if Ω contains the pole),    ∫_H n · g dA = 8 J2.

*The arcs.* Let an arc of the rim of a cap with axis k and angle ω bound H; h = cos ω, s = sin ω, γ = k · g. Its image
is an arc of a circle, in the paper's letters, with q = h + γ (the rim passes through the pole where q = 0),

    r0 = 2s / q,    t0² + s0² = 4 (1 − γ²) / q²,    A = 4 (1 + hγ) / q²,    D = A² − B² − C² = 16 / q²,
    r0² − A = −4h / q,    dφ = q dψ / (1 + n · g),    I1 = ∫ dφ / (A + B cos φ + C sin φ) = q Δψ / 4,

where φ is the angle on the image and ψ that on the rim. So the paper's ``J1 = Δφ / 2 + (r0² − A) / 2 · I1`` becomes

    2 J1 = Δφ − h Δψ,    tan(Δφ / 2) = q sin δ / ((1 + hγ) cos δ + s m · g),    δ = Δψ / 2,

with m the unit vector from the rim's centre to the middle of the arc: no quotient by q is left, and the arc tangent of
two arguments is right up to the whole circle. With H on the left a rim runs clockwise about its axis, so that arcs
count negative. The pole is put where |q| is large for all arcs of the sphere. The same substitutions make ``8 J2``
linear in g; as the pole may be put anywhere, it is the component along g of

    ∫_H n dA = Σ s (h sin δ m − s δ k).

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
from molviz.geometry.boundary import Boundary, union_boundary
from molviz.geometry.rows import expand
from molviz.model.spheres import Spheres
from molviz.vectors import dot, length

CANDIDATES = 16  # poles to choose from: for a hundred rims the best is seldom within 1e-3 of one
GOLDEN = (1 + 5**0.5) / 2


class Measure(NamedTuple):
    """Area and volume of a union of n balls, and how they change when a ball moves."""

    area: Floats  # (n,) Å², of each sphere outside all other balls
    volume: float  # Å³
    area_gradient: Floats  # (n, 3) Å, of the whole area by each centre
    volume_gradient: Floats  # (n, 3) Å², of the volume by each centre

    def __repr__(self) -> str:
        return f"<Measure of {len(self.area)} balls: area {self.area.sum():.3f} Å², volume {self.volume:.3f} Å³>"


class _Rims(NamedTuple):
    """Free arcs as seen from each of their two spheres, in the order of these: 2k rows, unit spheres."""

    sphere: Ints  # (2k,)
    axis: Floats  # (2k, 3) of the cap that is cut off
    cosine: Floats  # (2k,) h
    sine: Floats  # (2k,) s
    middle: Floats  # (2k, 3) m
    half: Floats  # (2k,) δ
    fold: Floats  # (2k,) tan(β / 2)


def measure_spheres(spheres: Spheres, boundary: Boundary | None = None) -> Measure:
    """Return the exact area and volume of the union of n balls (Džurina & Plavka 2008); see above.

    Equal, nested, tangent and coincident spheres are allowed; ``boundary`` says how they are decided. Spheres of
    which no arc is free are free where nothing touches them, and buried otherwise.
    """
    boundary = union_boundary(spheres) if boundary is None else boundary
    rims = _rims(boundary)
    area = spheres.radius**2 * _unit_area(boundary, rims)
    flux = spheres.radius[:, None] ** 2 * _unit_flux(rims, len(area))
    return Measure(area, _volume(spheres, area, flux), _area_gradient(spheres, rims), flux)


def _rims(boundary: Boundary) -> _Rims:
    spheres, circles, arcs = boundary.spheres, boundary.circles, boundary.arcs
    first, second = circles.first[arcs.circle], circles.second[arcs.circle]
    own, other = spheres.radius[first], spheres.radius[second]
    between = spheres.center[second] - spheres.center[first]
    distance = length(between)
    axis = between / distance[:, None]
    excess = (own - other) * (own + other) / distance
    radius = length(circles.a[arcs.circle])
    angle = arcs.start + arcs.sweep / 2
    middle = circles.spoke(arcs.circle, angle) / radius[:, None]
    fold = np.sqrt((distance**2 - (own - other) ** 2) / ((own + other) ** 2 - distance**2))
    sides = (
        _Rims(first, axis, (distance + excess) / (2 * own), radius / own, middle, arcs.sweep / 2, fold),
        _Rims(second, -axis, (distance - excess) / (2 * other), radius / other, middle, arcs.sweep / 2, fold),
    )
    order = np.argsort(np.concatenate([first, second]), kind="stable")
    return _Rims(*(np.concatenate(column)[order] for column in zip(*sides, strict=True)))


def _unit_area(boundary: Boundary, rims: _Rims) -> Floats:
    """``4π [the pole is free] + Σ 2 J1`` of each sphere; 4π or 0 for spheres without arcs."""
    count = len(boundary.spheres.radius)
    lonely = (np.diff(boundary.crossing.start) == 0) & ~boundary.inside
    area = np.where(lonely, 4 * np.pi, 0.0)
    bounded, opposite = _opposite_poles(rims)
    area[bounded[_free(boundary, bounded, -opposite)]] = 4 * np.pi
    toward = np.zeros((count, 3))
    toward[bounded] = opposite
    return area + np.bincount(rims.sphere, _twice_j1(rims, toward[rims.sphere]), count)


def _twice_j1(rims: _Rims, toward: Floats) -> Floats:
    """``hΔψ − Δφ`` of each arc, run clockwise, for projections from −``toward``."""
    along, across = dot(rims.axis, toward), dot(rims.middle, toward)
    turn = np.arctan2(
        (rims.cosine + along) * np.sin(rims.half),
        (1 + rims.cosine * along) * np.cos(rims.half) + rims.sine * across,
    )
    return np.asarray(2 * (rims.cosine * rims.half - turn))


def _opposite_poles(rims: _Rims) -> tuple[Ints, Floats]:
    """The spheres with arcs, (m,), and for each the candidate (m, 3) whose opposite is farthest from their rims."""
    sphere, first_row = np.unique(rims.sphere, return_index=True)
    best, chosen = np.full(len(sphere), -1.0), np.zeros((len(sphere), 3))
    if len(sphere) == 0:
        return sphere, chosen
    x, y, z = (np.ascontiguousarray(column) for column in rims.axis.T)
    for candidate in _spiral(CANDIDATES):
        distance = np.abs(rims.cosine + x * candidate[0] + y * candidate[1] + z * candidate[2])
        nearest = np.minimum.reduceat(distance, first_row)
        better = nearest > best
        best[better], chosen[better] = nearest[better], candidate
    return sphere, chosen


def _spiral(count: int) -> Floats:
    """Directions (count, 3) nearly evenly spread, and none in a plane in which crystals have their rims."""
    turn = np.arange(count) * 2 * np.pi / GOLDEN
    z = 1 - (2 * np.arange(count) + 1) / count
    across = np.sqrt(1 - z**2)
    return np.stack([across * np.cos(turn + 1), across * np.sin(turn + 1), z], axis=1)


def _free(boundary: Boundary, sphere: Ints, direction: Floats) -> Bools:
    """Whether the point of each given sphere in the given direction lies outside all other balls."""
    spheres, crossing = boundary.spheres, boundary.crossing
    point = spheres.center[sphere] + spheres.radius[sphere][:, None] * direction
    row, entry = expand(crossing.start[sphere], crossing.start[sphere + 1])
    ball = crossing.item[entry]
    covered = np.sum((point[row] - spheres.center[ball]) ** 2, axis=1) < spheres.radius[ball] ** 2
    return np.asarray(np.bincount(row[covered], minlength=len(sphere)) == 0)


def _unit_flux(rims: _Rims, count: int) -> Floats:
    """``Σ s (h sin δ m − s δ k)`` of each sphere."""
    by_middle = rims.sine * rims.cosine * np.sin(rims.half)
    by_axis = rims.sine**2 * rims.half
    return _total(rims.sphere, by_middle[:, None] * rims.middle - by_axis[:, None] * rims.axis, count)


def _volume(spheres: Spheres, area: Floats, flux: Floats) -> float:
    """``⅓ Σ (r_i A_i + c_i · N_i)``; the N_i add up to nothing, so any origin serves, and the middle best."""
    center = spheres.center - np.sum(spheres.center, axis=0) / max(len(area), 1)
    return float(np.sum(spheres.radius * area + dot(center, flux)) / 3)


def _area_gradient(spheres: Spheres, rims: _Rims) -> Floats:
    """Over an arc of length 2δρ: ``∫ n dl = 2ρ (δ h k + s sin δ m)``, ``∫ ν dl = 2ρ (δ s k − h sin δ m)``."""
    by_axis = rims.half * (rims.fold * rims.cosine + rims.sine)
    by_middle = np.sin(rims.half) * (rims.fold * rims.sine - rims.cosine)
    pull = by_axis[:, None] * rims.axis + by_middle[:, None] * rims.middle
    length = 2 * spheres.radius[rims.sphere] * rims.sine
    return _total(rims.sphere, -length[:, None] * pull, len(spheres.radius))


def _total(sphere: Ints, vector: Floats, count: int) -> Floats:
    return np.stack([np.bincount(sphere, vector[:, axis], count) for axis in range(3)], axis=1)
