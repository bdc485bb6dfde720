"""Arcs on unit spheres: area and flux of the regions that they bound (Džurina & Plavka 2008).

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
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.boundary import Boundary
from molviz.geometry.circles import radical_planes
from molviz.geometry.planar_map import directed
from molviz.vectors import dot

CANDIDATES = 16  # poles to choose from: for a hundred rims the best is seldom within 1e-3 of one
GOLDEN = (1 + 5**0.5) / 2


class Rims(NamedTuple):
    """k arcs of rims of caps that are cut off numbered unit spheres; the region that is left is on their left."""

    sphere: Ints  # (k,)
    axis: Floats  # (k, 3) of the cap that is cut off
    cosine: Floats  # (k,) h
    sine: Floats  # (k,) s
    middle: Floats  # (k, 3) m
    half: Floats  # (k,) δ

    def take(self, rows: Ints | Bools) -> "Rims":
        """Return the given rows, in that order."""
        turned = (column[rows] for column in (self.axis, self.cosine, self.sine, self.middle, self.half))
        return Rims(self.sphere[rows], *turned)


def rims_of(boundary: Boundary) -> Rims:
    """Return the free arcs as seen from both their spheres: row 2k is arc k on its second, 2k + 1 on its first."""
    spheres, circles, arcs = boundary.spheres, boundary.circles, boundary.arcs
    axis, along = radical_planes(spheres, circles.first, circles.second)
    _, beyond = radical_planes(spheres, circles.second, circles.first)
    radius = np.linalg.norm(circles.a, axis=1)
    middle = circles.spoke(arcs.circle, arcs.start + arcs.sweep / 2) / radius[arcs.circle, None]
    sphere = directed(circles.second[arcs.circle], circles.first[arcs.circle])
    cosine = np.stack([beyond, along], axis=1)[arcs.circle].ravel() / spheres.radius[sphere]
    circle, away = np.repeat(arcs.circle, 2), np.tile([[-1.0], [1.0]], (len(arcs.circle), 1))
    sine = radius[circle] / spheres.radius[sphere]
    half = np.repeat(arcs.sweep / 2, 2)
    return Rims(sphere, away * axis[circle], cosine, sine, np.repeat(middle, 2, axis=0), half)


def twice_j1(rims: Rims, toward: Floats) -> Floats:
    """Return ``hΔψ − Δφ`` (k,) of each arc, run clockwise, for projections from −``toward`` (k, 3).

    Added up over the arcs that bound a region this is its area, less 4π if it contains the pole.
    """
    along, across = dot(rims.axis, toward), dot(rims.middle, toward)
    turn = np.arctan2(
        (rims.cosine + along) * np.sin(rims.half),
        (1 + rims.cosine * along) * np.cos(rims.half) + rims.sine * across,
    )
    return np.asarray(2 * (rims.cosine * rims.half - turn))


def unit_flux(rims: Rims) -> Floats:
    """Return ``s (h sin δ m − s δ k)`` (k, 3) of each arc; added up it is ``∫ n dA`` over the region."""
    by_middle = rims.sine * rims.cosine * np.sin(rims.half)
    by_axis = rims.sine**2 * rims.half
    return np.asarray(by_middle[:, None] * rims.middle - by_axis[:, None] * rims.axis)


def opposite_poles(rims: Rims) -> tuple[Ints, Floats]:
    """Return the spheres with arcs, (m,), and for each the candidate (m, 3) whose opposite is farthest from its rims.

    The rows of ``rims`` are ordered by sphere.
    """
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


def sums(owner: Ints, value: Floats, count: int) -> Floats:
    """Return the sums (count,) of the values (k,) of each owner."""
    return np.asarray(np.bincount(owner, value, count), dtype=np.float64)  # without rows bincount counts in integers


def totals(owner: Ints, vector: Floats, count: int) -> Floats:
    """Return the sums (count, 3) of the vectors (k, 3) of each owner."""
    return np.stack([sums(owner, vector[:, axis], count) for axis in range(3)], axis=1)
